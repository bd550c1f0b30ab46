# SPDX-License-Identifier: Apache-2.0
"""What the package imports is what package.xml and pyproject.toml ask for; each Python is named."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from typing import Any

import pytest
from parsed import FIRST, parsed, sources
from paths import ROOT

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

TOML: dict[str, Any] = tomllib.loads((ROOT / "pyproject.toml").read_text())
PROJECT = TOML["project"]
MANIFEST = ET.parse(ROOT / "package.xml").getroot()
# The Python of Ubuntu 26.04 (Lyrical).
LAST = (3, 14)
# Name on PyPI -> in package.xml. tomli has no key of rosdep: that of Ubuntu 22.04 is another. Nor has
# jsonschema-rs: jsonschema alone does its work there.
KEYS = {
    "lxml": "python3-lxml",
    "PyYAML": "python3-yaml",
    "rich": "python3-rich",
    "jsonschema": "python3-jsonschema",
    "jsonschema-rs": None,
    "xacro": "xacro",
    "tomli": None,
}
# Module -> its package in package.xml, where that is another word.
MODULES = {
    "lxml": "python3-lxml",
    "yaml": "python3-yaml",
    "rich": "python3-rich",
    "jsonschema": "python3-jsonschema",
}
# Modules that the package goes without, or that no key of rosdep is for.
UNASKED = {
    *("tomli", "tomllib", "tree_sitter", "tree_sitter_cpp", "zenoh", "rosbags", "jsonschema_rs"),
    *("yourdfpy", "trimesh", "numpy"),  # the extra view
    *("lsprotocol", "pygls"),  # the extra lsp
}
# What the tests import before anything else.
OF_TESTS = {"python3-hypothesis", "python3-numpy", "python3-pytest", "python3-setuptools"}
# The versions of Ubuntu 22.04, which is the oldest.
OLDEST = {"lxml": "4.8", "xacro": "2.0", "PyYAML": "5.4", "rich": "11", "jsonschema": "3.2"}


def wanted(kind: str) -> set[str]:
    return {it.text or "" for it in MANIFEST.iter(kind)}


def imported(tree: ast.Module) -> Iterator[str]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (it.name.partition(".")[0] for it in node.names)
        elif isinstance(node, ast.ImportFrom) and not node.level:
            yield (node.module or "").partition(".")[0]


def test_every_dependency_of_pip_is_one_of_ros() -> None:
    names = {re.split(r"[><=; ]", it)[0] for it in PROJECT["dependencies"]}
    assert names == KEYS.keys()
    assert {key for key in KEYS.values() if key} <= wanted("exec_depend")


@pytest.mark.slow
def test_every_import_is_a_dependency_of_ros() -> None:
    found = {name for tree in sources().values() for name in imported(tree)}
    others = found - sys.stdlib_module_names - {"multibot_rewrite"} - UNASKED
    assert {MODULES.get(it, it) for it in others} - wanted("exec_depend") == set()


def test_the_tests_ask_for_what_they_start_with() -> None:
    assert wanted("test_depend") == OF_TESTS


def test_the_oldest_versions_are_those_that_are_tried() -> None:
    lowest = dict(re.findall(r"^(\w+)>=([\d.]+)", "\n".join(PROJECT["dependencies"]), re.MULTILINE))
    assert lowest == {**OLDEST, "tomli": "1.1"}
    assert "tomli>=1.1; python_version < '3.11'" in PROJECT["dependencies"]


def test_humble_alone_has_a_package_that_reads_toml() -> None:
    """It is needed to build the package, too, where what is only for its run is not installed."""
    found = {it.text: it.get("condition") for it in MANIFEST.iter("depend")}
    assert found == {"python3-toml": "$ROS_DISTRO == humble"}


def test_the_pythons_are_named_alike_everywhere() -> None:
    minors = range(FIRST[1], LAST[1] + 1)
    named = [it for it in PROJECT["classifiers"] if re.search(r":: 3\.\d+$", it)]
    assert named == [f"Programming Language :: Python :: 3.{minor}" for minor in minors]
    assert PROJECT["requires-python"] == f">=3.{FIRST[1]}"
    assert TOML["tool"]["ruff"]["target-version"] == f"py3{FIRST[1]}"
    guide = (ROOT / "CONTRIBUTING.md").read_text()
    assert f"Python 3.{FIRST[1]} to 3.{LAST[1]}" in guide


@pytest.mark.slow
def test_the_first_python_reads_every_file() -> None:
    assert sources()
    for path in (ROOT / "tests").rglob("*.py"):
        parsed(path)


@pytest.mark.deep
def test_mypy_finds_nothing_for_the_last_python(pytestconfig: pytest.Config) -> None:
    """It knows until which Python a name of the standard library is there; see the test of style for
    the first."""
    kept = pytestconfig.cache.mkdir("mypy")
    about = ["--python-version", "{}.{}".format(*LAST), "--cache-dir", str(kept)]
    command = [sys.executable, "-m", "mypy", *about]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_releases_of_ubuntu_get_what_the_manifest_names() -> None:
    """The script takes the packages from package.xml; one with a condition is ROS's."""
    script = (ROOT / "tests" / "in_ubuntu.sh").read_text()
    (pattern,) = re.findall(r"sed -n 's/(.*)/\\1/p'", script)
    posix = pattern.replace(r"\(", "(").replace(r"\)", ")")
    found = set(re.findall(posix, (ROOT / "package.xml").read_text()))
    ours = wanted("exec_depend") | wanted("test_depend")
    assert found == {it for it in ours if it.startswith("python3-")}
