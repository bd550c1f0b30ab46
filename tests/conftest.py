"""Shared set-up: repeatable property tests, and loud skips where test data is not there."""

from __future__ import annotations

import gc
import os
import signal
import sys
from collections import Counter
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path

import pytest
import tf2_build
from hypothesis import HealthCheck, Phase, settings
from paths import CORPUS
from real_robots import WHEELS, corpus_files, wheel_files

REAL = "real launch"
# Files of tests that need more than an Ubuntu has: readers of what is written.
READERS = {
    "cli/test_findings.py": ("junitparser",),
    "lint/test_lint_formats.py": ("junitparser", "markdown_it", "sarif_pydantic"),
    "lint/test_lint_hooks.py": ("junitparser",),
}
collect_ignore = [path for path, needs in READERS.items() if not all(map(find_spec, needs))]


def pytest_report_header() -> str:
    """The files that are left out."""
    return f"left out, no readers: {', '.join(collect_ignore)}" if collect_ignore else ""


settings.register_profile(
    "repeatable",
    max_examples=40,
    derandomize=True,
    deadline=None,
    phases=(Phase.explicit, Phase.generate, Phase.shrink),
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("repeatable")
# Thousands of tests and the syntax trees of the package live to the end: without this every second
# of four goes into looking through them for what could be thrown away.
gc.set_threshold(100_000, 50, 100)
# Hundreds of processes import the package: each would compile it anew where no compiled files may be
# beside the sources. They are kept with those of pytest's cache instead.
COMPILED = Path(__file__).parents[1] / ".pytest_cache" / "compiled"
if sys.dont_write_bytecode:
    sys.dont_write_bytecode, sys.pycache_prefix = False, str(COMPILED)
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
    os.environ["PYTHONPYCACHEPREFIX"] = str(COMPILED)
# A shell that starts the tests with & has it ignored, and so would every process that they interrupt.
signal.signal(signal.SIGINT, signal.default_int_handler)


# So many rows of a test are in the fast run; of one with ``sample``, whose rows cost more, one.
FEW = 4
# So many at most are in the usual run.
MANY = 20


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """What is deep is slow: ``-m "not slow"`` takes the place of the usual ``-m "not deep"``.

    Of the many rows of a test a few are in the fast run, spread evenly: the others are ``more``. In
    the usual run are up to MANY, of those with ``sample(m)`` the first of every m.
    """
    names = [item.nodeid.partition("[")[0] for item in items]
    rows, seen = Counter(names), Counter[str]()
    for item, name in zip(items, names, strict=True):
        marks, at = {it.name: it for it in item.iter_markers()}, seen[name]
        seen[name] += 1
        sample = marks.get("sample")
        left_out = at % -(-rows[name] // (1 if sample else FEW))
        more = left_out and marks.keys().isdisjoint(("slow", "live", "deep"))
        usual = sample.args[0] if sample else -(-rows[name] // MANY)
        deep = left_out and at % usual
        slow = more or deep or {"more", "deep"} & marks.keys()
        for mark, has in (("more", more), ("deep", deep), ("slow", slow)):
            if has:
                item.add_marker(mark)
    # Before others sort and mark thousands of tests that nobody asked for.
    config.pluginmanager.getplugin("mark").pytest_collection_modifyitems(items, config)


def pytest_collection_finish() -> None:
    """What was collected is looked through no more."""
    gc.collect()
    gc.freeze()


# Files whose tests start nodes.
LIVE_FILES = (
    *("test_live_", "rcl", "test_docs", "test_examples", "test_recipes", "test_scripts"),
    *("test_tutorials", "test_walk"),
)


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: object) -> object:
    """With ``-n 3`` the tests of a file stay together, and all files with nodes: two of them at once
    would meet in a domain."""
    from xdist.scheduler import LoadFileScheduling

    class Scheduling(LoadFileScheduling):
        def _split_scope(self, nodeid: str) -> str:
            file = nodeid.partition("::")[0]
            return "live" if any(word in file for word in LIVE_FILES) else file

    return Scheduling(config, log)


@pytest.fixture(autouse=True, scope="session")
def no_release(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """The facts that are tested are not those of the machine's ROS, nor what a user's cache keeps."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("cache")))
        patch.delenv("ROS_DISTRO", raising=False)
        yield


@pytest.fixture(scope="session")
def corpus() -> dict[str, Path]:
    """The real files beside the repository, by their relative path."""
    files = corpus_files()
    if not files:
        pytest.skip(f"no corpus of real robot files: looked for {CORPUS / 'urdf'}/**/*.urdf")
    return files


@pytest.fixture(scope="session")
def wheels() -> dict[str, Path]:
    """The files of the installed description wheels, by distribution and path."""
    files = wheel_files()
    if not files:
        pytest.skip(f"no description wheel installed: pip install {' '.join(WHEELS)}")
    return files


@pytest.fixture(scope="session")
def tf2(pytestconfig: pytest.Config) -> dict[str, str]:
    """What makes tf2_msgs importable in children; empty where it cannot be had."""
    if find_spec("tf2_msgs") or tf2_build.missing():
        return {}
    return tf2_build.build(pytestconfig.cache.mkdir("tf2_msgs"))


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Which tests were skipped for want of the real launch."""
    skipped = terminalreporter.stats.get("skipped", ())
    files = Counter(it.nodeid.partition("::")[0] for it in skipped if REAL in str(it.longrepr))
    if files:
        listed = ", ".join(f"{file} ({count})" for file, count in sorted(files.items()))
        needed = f"{files.total()} tests need the {REAL}, which is not here"
        terminalreporter.write_line(f"{needed}: {listed}")
