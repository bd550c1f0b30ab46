# SPDX-License-Identifier: Apache-2.0
"""What an extra brings is asked for by name, in one line, by every command that needs it."""

from __future__ import annotations

import importlib.metadata
import re
import sys
from importlib.metadata import Distribution, PackageNotFoundError
from pathlib import Path

import pytest
from paths import FIXTURES, ROOT

from multibot_rewrite.cli.declared.commands import COMMANDS
from multibot_rewrite.cli.multibot import main

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
# What only extras bring, and where it is imported: here, or in a child process.
HERE = ("yourdfpy", "rosbags", "rosbags.rosbag2", "zenoh")
IN_CHILDREN = ("rclpy", "zenoh")
FLEET = str(ROOT / "examples" / "namespace_and_prefix" / "fleet.yaml")
PLAN = str(FIXTURES / "graphs" / "plan.yaml")
ROUTER = ("--from", "tcp/localhost:7447")
NEEDS = [
    (("rehearse", FLEET), "ros"),
    (("rehearse", FLEET, "--report", "r.html"), "ros"),
    (("check", FLEET), "ros"),
    (("check", PLAN, "--watch"), "ros"),
    (("check",), "ros"),
    (("snapshot", "-o", "graph.json"), "ros"),
    (("snapshot", "--output-kind", "nodes", "-o", "nodes.yaml"), "ros"),
    (("check", PLAN, *ROUTER), "zenoh"),
    (("check", *ROUTER), "zenoh"),
    (("snapshot", *ROUTER), "zenoh"),
    (("snapshot", "--output-kind", "nodes", *ROUTER), "zenoh"),
    (("check", PLAN, "--from", "."), "bags"),
    (("check", "--from", "."), "bags"),
    (("view", FLEET, "-o", "view.html"), "view"),
]
LARGEST, LARGEST_VIEW = 70_000_000, 110_000_000


@pytest.fixture
def bare(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a working folder of somebody who has no extra."""
    modules = tmp_path / "none"
    modules.mkdir()
    for name in IN_CHILDREN:
        (modules / f"{name}.py").write_text("raise ModuleNotFoundError(f'No module {__name__}')\n")
    for name in HERE:
        monkeypatch.setitem(sys.modules, name, None)
    monkeypatch.setenv("PYTHONPATH", str(modules), prepend=":")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.more
@pytest.mark.sample(1)
@pytest.mark.parametrize(("words", "extra"), NEEDS)
def test_a_missing_extra_is_one_line_with_what_installs_it(
    words: tuple[str, ...], extra: str, bare: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(list(words)) == 4
    said = capsys.readouterr()
    (line,) = said.err.splitlines()
    assert f"pip install 'multibot_rewrite[{extra}]'" in line
    assert (said.out, [it.name for it in bare.iterdir()]) == ("", ["none"])


def test_every_extra_that_is_asked_for_is_there() -> None:
    files = (ROOT / "multibot_rewrite").rglob("*.py")
    asked = {
        it for path in files for it in re.findall(r"multibot_rewrite\[(\w+)\]", path.read_text())
    }
    assert asked == {"ros", "zenoh", "bags", "view", "sources", "lsp"}
    assert asked <= PROJECT["optional-dependencies"].keys()


def test_the_exit_code_is_in_the_help() -> None:
    words = {"ros": "rclpy", "zenoh": "zenoh", "bags": "rosbags", "view": "yourdfpy"}
    for (name, *_), extra in NEEDS:
        (said,) = re.findall(r"\b4 ([^;.]*)", str(COMMANDS[name].exit_codes))
        assert words[extra] in said, name


def brought(name: str, seen: dict[str, Distribution]) -> None:
    """Add a distribution to ``seen`` with all that it needs, without extras."""
    found = importlib.metadata.distribution(name)
    seen[found.name.lower()] = found
    for line in found.requires or ():
        wanted, _, marker = line.partition(";")
        (need,) = re.findall(r"^[\w.-]+", wanted)
        if "extra" not in marker and need.lower().replace("_", "-") not in seen:
            try:
                brought(need, seen)
            except PackageNotFoundError:
                assert marker, line


def size(found: Distribution) -> int:
    paths = (Path(str(it.locate())) for it in found.files or ())
    return sum(it.stat().st_size for it in paths if it.is_file())


@pytest.mark.more
def test_what_pip_installs_is_small() -> None:
    """A rewrite in a container or a CI job pays for all of it: the package and what it needs."""
    seen: dict[str, Distribution] = {}
    for line in PROJECT["dependencies"]:
        (name,) = re.findall(r"^[\w.-]+", line)
        if "python_version" in line:
            continue
        try:
            brought(name, seen)
        except PackageNotFoundError:
            pytest.skip(f"{name} was not installed by pip")
    assert {"lxml", "pyyaml", "rich", "jsonschema", "xacro"} <= seen.keys()
    assert not seen.keys() & {"numpy", "scipy", "trimesh", "yourdfpy", "rclpy"}
    files = (it for it in (ROOT / "multibot_rewrite").rglob("*") if it.is_file())
    assert sum(map(size, seen.values())) + sum(it.stat().st_size for it in files) < LARGEST


@pytest.mark.more
def test_the_view_brings_little() -> None:
    """What reads URDFs and meshes, as docs/compatibility.md has it without what else trimesh can do."""
    pytest.importorskip("trimesh", reason="no trimesh: pip install '.[view]'")
    seen: dict[str, Distribution] = {}
    for line in PROJECT["optional-dependencies"]["view"]:
        brought(re.findall(r"^[\w.-]+", line)[0], seen)
    assert "scipy" not in seen
    del seen["lxml"]  # the package needs it itself
    assert 50_000_000 < sum(map(size, seen.values())) < LARGEST_VIEW
