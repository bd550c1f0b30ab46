# SPDX-License-Identifier: Apache-2.0
"""``fleet.launch.py`` as a reviewer reads it: ament_flake8, ament_pep257, and a person.

Source: ament_lint, ament_flake8/configuration/ament_flake8.ini, ament_pep257/main.py (D213 is on).
"""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest
from built_launch import built
from paths import ROOT

from multibot_rewrite.cli.multibot import main

IGNORED = "D100,D101,D102,D103,D104,D105,D106,D107,D203,D212,D404"
FLAKE8 = (
    *("flake8", "--isolated", f"--extend-ignore=B902,C816,{IGNORED},I202"),
    *("--import-order-style=google", "--max-line-length=99", "--inline-quotes=single"),
)
TOOLS = {"flake8": FLAKE8, "pydocstyle": ("pydocstyle", f"--ignore={IGNORED}")}
KINDS = ("gz", "classic", "kinds", "real", "ten")
EXAMPLES = ("two_robots_nav2", "two_arms_moveit", "mixed_fleet")
pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def texts(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Return the launch file of each kind of fleet, and those of three examples."""
    folders = {it: built(tmp_path_factory.mktemp(it), it, "both") for it in KINDS}
    for name in EXAMPLES:
        folders[name] = tmp_path_factory.mktemp(name) / "out"
        fleet = ROOT / "examples" / name / "fleet.yaml"
        assert main(["build", str(fleet), "-o", str(folders[name]), "-q"]) == 0
    return {it: (folder / "fleet.launch.py").read_text() for it, folder in folders.items()}


def test_lines_are_short_and_clean(texts: dict[str, str]) -> None:
    for kind, text in texts.items():
        lines = text.splitlines()
        assert max(map(len, lines)) <= 99, kind
        assert [it for it in lines if it != it.rstrip() or "\t" in it] == []
        assert text.endswith("\n") and not text.endswith("\n\n")


def test_quotes_are_single_but_where_one_is_inside(texts: dict[str, str]) -> None:
    for text in texts.values():
        tree = ast.parse(text)
        docs = {ast.get_docstring(it, clean=False) for it in ast.walk(tree) if _has_docs(it)}
        strings = (it for it in ast.walk(tree) if isinstance(it, ast.Constant))
        plain = [it for it in strings if isinstance(it.value, str) and it.value not in docs]
        lines = [it.encode() for it in text.split("\n")]
        quotes = [lines[it.lineno - 1][it.col_offset :].lstrip(b"f")[:1] for it in plain]
        odd = [it.value for it, quote in zip(plain, quotes, strict=True) if quote == b'"']
        assert [it for it in odd if "'" not in it] == []


def test_docstrings_are_as_pep257_says(texts: dict[str, str]) -> None:
    for text in texts.values():
        tree = ast.parse(text)
        head = ast.get_docstring(tree, clean=False) or ""
        # Its summary is on the second line, with a full stop and a blank line behind it.
        assert re.match(r"\n[A-Z][^\n]*\.\n\n", head), head
        functions = [it for it in ast.walk(tree) if isinstance(it, ast.FunctionDef)]
        said = {it.name: ast.get_docstring(it) or "" for it in functions if it.name != "change"}
        assert [
            it for it in said.values() if not re.fullmatch(r"(Return|Start) [^\n]*\.", it)
        ] == []
        whole, started = said["generate_launch_description"], text.rpartition("    return ")[2]
        assert ("simulator" in whole) == ("IncludeLaunchDescription(" in started)
        assert ("windows" in whole) == ("LaunchConfiguration('rviz')" in started)


def test_imports_are_in_order(texts: dict[str, str]) -> None:
    for text in texts.values():
        made = [it for it in ast.parse(text).body if isinstance(it, ast.ImportFrom)]
        standard = [it.module for it in made if it.module in ("functools", "pathlib")]
        others = [it.module for it in made if it.module not in standard]
        assert [it.module for it in made] == [*sorted(standard), *sorted(others)]
        for it in made:
            names = [name.name for name in it.names]
            assert names == sorted(names, key=str.casefold)


def test_ros_arguments_are_options_of_launch_ros(texts: dict[str, str]) -> None:
    for text in texts.values():
        code = text.split('"""', 2)[2]
        assert "--ros-args" not in code and "__node:=" not in code and "'-r'" not in code


def test_what_is_not_started_has_a_reason_and_a_remedy(texts: dict[str, str]) -> None:
    for text in texts.values():
        for it in re.findall(r"# Not started: (\w+) \((.*?)\)\n(?! *# )", text, re.DOTALL):
            assert re.search(r"add|start|declare|say|write|include|with", it[1]), it


def test_ten_robots_are_hardly_longer_than_two(texts: dict[str, str]) -> None:
    two, ten = (len(texts[it].splitlines()) for it in ("classic", "ten"))
    assert ten - two <= 10


@pytest.mark.parametrize("tool", TOOLS)
def test_what_ament_lint_says(tool: str, texts: dict[str, str], tmp_path: Path) -> None:
    if find_spec(tool) is None:
        pytest.skip(f"{tool} is not here")
    for kind, text in texts.items():
        (tmp_path / f"{kind}.launch.py").write_text(text)
    files = map(str, tmp_path.glob("*.py"))
    command = [sys.executable, "-m", *TOOLS[tool], *files]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (0, "")


def _has_docs(node: ast.AST) -> bool:
    return isinstance(node, ast.Module | ast.FunctionDef)
