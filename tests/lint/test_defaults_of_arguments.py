# SPDX-License-Identifier: Apache-2.0
"""Arguments that several files of one xacro declare. Expectation: xacro __init__.py, ``xacro:arg``: a
name that is in the one table of arguments keeps its value."""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite.lint.check import lint_file
from multibot_rewrite.rules.settings import EVERY_FILE, ArgumentSet, Settings

NS = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
ONE, TWO = '<xacro:arg name="n" default="1"/>', '<xacro:arg name="n" default="2"/>'
BOTH = '<xacro:include filename="a.xacro"/><xacro:include filename="b.xacro"/>'
INSIDE = '<xacro:include filename="b.xacro"/>'


@pytest.mark.parametrize(
    ("top", "first", "second", "found"),
    [
        (BOTH, ONE, TWO, 1),
        (BOTH, ONE, ONE, 0),
        (BOTH, TWO, "", 0),
        # Who includes a file may set what it has.
        (ONE + BOTH, "", TWO, 0),
        (ONE + BOTH, ONE, TWO, 0),
        ('<xacro:include filename="a.xacro"/>', ONE + INSIDE, TWO, 0),
        (BOTH, ONE, f'<xacro:macro name="m">{TWO}</xacro:macro>', 0),
        (BOTH, ONE, f'<xacro:if value="0">{TWO}</xacro:if>', 0),
        (BOTH, ONE, '<xacro:arg name="n" default="$(find x)"/>', 0),
        (BOTH, ONE + ONE.replace('"n"', '"m"'), TWO + TWO.replace('"n"', '"m"'), 2),
    ],
)
def test_the_first_default_counts_for_all_files(
    top: str, first: str, second: str, found: int, tmp_path: Path
) -> None:
    path = tmp_path / "r.urdf.xacro"
    path.write_text(f'<robot name="r" {NS}>{top}<link name="l"/></robot>')
    for name, text in (("a", first), ("b", second)):
        (tmp_path / f"{name}.xacro").write_text(f"<robot {NS}>{text}</robot>")
    said = lint_file(str(path), Settings(select=("MB147",)))
    assert len(said) == found
    assert all("of b.xacro is '1', as a.xacro has it, and not '2'" in it.message for it in said)


@pytest.mark.parametrize(("given", "found"), [("q", 1), ("n", 0)])
def test_a_default_of_what_is_given_does_not_count(given: str, found: int, tmp_path: Path) -> None:
    (tmp_path / "a.xacro").write_text(f"<robot {NS}>{ONE}</robot>")
    (tmp_path / "b.xacro").write_text(f"<robot {NS}>{TWO}</robot>")
    path = tmp_path / "r.urdf.xacro"
    path.write_text(f'<robot name="r" {NS}>{BOTH}<link name="l$(arg needed)"/></robot>')
    own = ArgumentSet(EVERY_FILE, (("needed", "x"), (given, "3")))
    said = lint_file(str(path), Settings(select=("MB147",), arguments=(own,)))
    assert [it.code for it in said].count("MB147") == found
