# SPDX-License-Identifier: Apache-2.0
"""Shared set-up: repeatable property tests, and loud skips where test data is not there."""

from __future__ import annotations

import gc
import os
import random
import re
import signal
import sys
from collections import Counter
from collections.abc import Collection, Iterator, Mapping
from functools import partial
from importlib.util import find_spec
from inspect import isfunction
from pathlib import Path

import pytest
import tf2_build
import yaml
from hypothesis import HealthCheck, Phase, settings
from paths import CORPUS
from real_robots import WHEELS, corpus_files, wheel_files

REAL, TESTS = "real launch", Path(__file__).parent
# Files of tests that need more than an Ubuntu has: readers of what is written.
READERS = {
    "cli/test_findings.py": ("junitparser",),
    "lint/test_lint_formats.py": ("junitparser", "markdown_it", "sarif_pydantic"),
    "lint/test_lint_hooks.py": ("junitparser",),
    "lint/test_lint_lsp.py": ("pygls",),
}
UNREAD = [path for path, needs in READERS.items() if not all(map(find_spec, needs))]
collect_ignore = [*UNREAD]


def pytest_report_header() -> str:
    """Return the files that are left out."""
    return f"left out, no readers: {', '.join(UNREAD)}" if UNREAD else ""


settings.register_profile(
    "repeatable",
    max_examples=25,
    derandomize=True,
    deadline=None,
    phases=(Phase.explicit, Phase.generate, Phase.shrink),
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("repeatable")
# What tests read of YAML is read by libyaml: ten times sooner.
yaml.safe_load = partial(yaml.load, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))
# Thousands of tests and the syntax trees of the package live to the end: without this every second
# of four goes into looking through them for what could be thrown away.
gc.set_threshold(1_000_000, 50, 100)
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
FEW = 3
# So many at most are in the usual run.
MANY = 12


# What -m asks of the fast run, and of the usual one, and the marks that leave a test out.
LEFT_OUT = {
    "not live and not slow": {"live", "slow", "more", "deep"},
    "not deep": {"deep"},
}
MARKED = re.compile(r"^pytestmark = \[?\s*((?:pytest\.mark\.\w+,?\s*)+)", re.MULTILINE)


def _left_out(config: pytest.Config) -> set[str]:
    """Return the marks of tests that are not even made: two of three are in no fast run."""
    return set() if _names_tests(config) else LEFT_OUT.get(config.option.markexpr, set())


def _names_tests(config: pytest.Config) -> bool:
    """Who names tests gets all of their rows."""
    return bool(config.option.keyword) or any("::" in it for it in config.args)


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the option for the number by which fleets are drawn."""
    about = "draw fleets by this number; fresh: by one that is drawn and printed"
    parser.addoption("--drawn-seed", metavar="N", default="", help=about)


def pytest_configure(config: pytest.Config) -> None:
    """Leave out files whose mark leaves all of them out; draw a fresh seed once, before there
    are processes of xdist."""
    if config.option.drawn_seed == "fresh":
        config.option.drawn_seed = str(random.randrange(10**6))
    without = _left_out(config)
    for path in TESTS.rglob("test_*.py") if without else ():
        found = MARKED.search(path.read_text())
        if found and without & set(re.findall(r"\w+", found[1])):
            collect_ignore.append(str(path.relative_to(TESTS)))


@pytest.hookimpl(tryfirst=True)
def pytest_pycollect_makeitem(collector: pytest.Collector, obj: object) -> list[pytest.Item] | None:
    """Nothing of a function that is left out."""
    marks = getattr(obj, "pytestmark", ()) if isfunction(obj) else ()
    return [] if _left_out(collector.config) & {it.name for it in marks} else None


@pytest.hookimpl(hookwrapper=True)
def pytest_generate_tests(metafunc: pytest.Metafunc) -> Iterator[None]:
    """Of the many rows of a test a few are in the fast run, spread evenly: the others are ``more``. In
    the usual run are up to MANY, of those with ``sample(m)`` the first of every m.
    """
    yield
    config, rows = metafunc.config, metafunc._calls
    if _names_tests(config) and config.option.markexpr in LEFT_OUT:
        return
    without = _left_out(config)
    marks = {it.name: it for it in metafunc.definition.iter_markers()}
    for at, row in enumerate(rows):
        row.marks.extend(_marks_of_row(at, len(rows), marks, {it.name for it in row.marks}))
    rows[:] = [it for it in rows if without.isdisjoint(m.name for m in it.marks)] or rows[:1]


def _marks_of_row(
    at: int, count: int, marks: Mapping[str, pytest.Mark], own: Collection[str]
) -> Iterator[pytest.Mark]:
    sample, named = marks.get("sample"), {*marks, *own}
    if not at % -(-count // (1 if sample else FEW)):
        return
    if named.isdisjoint(("slow", "live", "deep")):
        yield pytest.mark.more.mark
        yield pytest.mark.slow.mark
    if at % (sample.args[0] if sample else -(-count // MANY)):
        yield pytest.mark.deep.mark
        yield pytest.mark.slow.mark


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark deep tests as slow: ``-m "not slow"`` replaces the usual ``-m "not deep"``."""
    for item in items:
        if {"more", "deep"} & {it.name for it in item.iter_markers()}:
            item.add_marker("slow")
    # Before others sort and mark thousands of tests that nobody asked for.
    config.pluginmanager.getplugin("mark").pytest_collection_modifyitems(items, config)


def pytest_collection_finish() -> None:
    """Take what was collected out of the garbage collector's rounds."""
    gc.collect()
    gc.freeze()


# By so many bytes a process grows before it is looked for what may be thrown away.
GROWTH = 200_000_000
SIZE = pytest.StashKey[int]()


@pytest.hookimpl(trylast=True)
def pytest_runtest_teardown(item: pytest.Item) -> None:
    """Collect circular garbage, such as large files in the frames of an error, once it is much:
    by the thresholds above it would stay for thousands of tests."""
    stash = item.config.stash
    if _size() > stash.setdefault(SIZE, _size()) + GROWTH:
        gc.collect()
        stash[SIZE] = _size()


def _size() -> int:
    """Return the bytes of memory that this process has; 0 where the system does not tell."""
    told = Path("/proc/self/statm")
    pages = int(told.read_text().split()[1]) if told.exists() else 0
    return pages * os.sysconf("SC_PAGE_SIZE")


# Files whose tests build fleets for minutes.
BUILDING_FILES = ("test_drawn_fleets.py", "test_cells_of_node_sets.py")
# Files whose tests start nodes.
LIVE_FILES = (
    *("test_live_", "rcl", "test_docs", "test_examples", "test_recipes", "test_scripts"),
    *("test_tutorials", "test_walk"),
)
# Files whose tests look at the syntax trees of all sources, which are made once.
SOURCES_FILES = (
    *("test_architecture", "test_bounded", "test_conventions", "test_dependencies", "test_layers"),
    *("test_plain_words", "test_record.", "test_releases_are_passed", "test_sentences"),
)


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: object) -> object:
    """With ``-n 3`` the tests of a file stay together, all files with nodes: two of them at once would
    meet in a domain, and those that need the same that costs much. Of files that build for minutes each
    test is by itself."""
    from xdist.scheduler import LoadFileScheduling

    class Scheduling(LoadFileScheduling):
        def _split_scope(self, nodeid: str) -> str:
            file = nodeid.partition("::")[0]
            if file.endswith(BUILDING_FILES):
                return nodeid
            groups = {"live": LIVE_FILES, "sources": SOURCES_FILES}
            found = (it for it, words in groups.items() if any(word in file for word in words))
            return next(found, file)

    return Scheduling(config, log)


@pytest.fixture(autouse=True, scope="session")
def no_release(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Test facts of the package alone: not of the machine's ROS, nor of a user's cache."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("cache")))
        patch.delenv("ROS_DISTRO", raising=False)
        yield


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return an empty folder, which is the working directory."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture(scope="session")
def corpus() -> dict[str, Path]:
    """Return the real files beside the repository, by their relative path."""
    files = corpus_files()
    if not files:
        pytest.skip(f"no corpus of real robot files: looked for {CORPUS / 'urdf'}/**/*.urdf")
    return files


@pytest.fixture(scope="session")
def wheels() -> dict[str, Path]:
    """Return the files of the installed description wheels, by distribution and path."""
    files = wheel_files()
    if not files:
        pytest.skip(f"no description wheel installed: pip install {' '.join(WHEELS)}")
    return files


@pytest.fixture(scope="session")
def tf2(pytestconfig: pytest.Config) -> dict[str, str]:
    """Return what makes tf2_msgs importable in children; empty where it cannot be had."""
    if find_spec("tf2_msgs") or tf2_build.missing():
        return {}
    return tf2_build.build(pytestconfig.cache.mkdir("tf2_msgs"))


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """By which seed fleets were drawn, and which tests were skipped for want of the real launch."""
    if seed := terminalreporter.config.option.drawn_seed:
        terminalreporter.write_line(f"fleets are drawn by --drawn-seed {seed}")
    skipped = terminalreporter.stats.get("skipped", ())
    files = Counter(it.nodeid.partition("::")[0] for it in skipped if REAL in str(it.longrepr))
    if files:
        listed = ", ".join(f"{file} ({count})" for file, count in sorted(files.items()))
        needed = f"{files.total()} tests need the {REAL}, which is not here"
        terminalreporter.write_line(f"{needed}: {listed}")
