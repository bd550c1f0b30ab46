# SPDX-License-Identifier: Apache-2.0
"""Where findings are: ``lint/check.py`` gives a problem its file, line and column, in places of the
source that was read, through xacro, too."""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, Finding
from multibot_rewrite.base.model import Edit
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.lint.check import numbered, placed
from multibot_rewrite.lint.files.subjects import make_subject, read_subjects
from multibot_rewrite.lint.registry import RULES
from multibot_rewrite.rules.settings import Settings
from multibot_rewrite.rules.subject import Subject

TEXT = b"""<robot name="r" xmlns:x="u">
  <link name="a"/>
  <link  x:name = 'b' type="t"
    note="n" name="c">

    words
  </link>
</robot>
"""


@pytest.mark.parametrize(
    ("number", "attribute", "line", "column"),
    [
        (0, None, 1, 1), (0, "name", 1, 8), (1, None, 2, 3), (1, "name", 2, 9),
        (2, None, 3, 3), (2, "note", 4, 5), (2, "name", 4, 14), (2, "type", 3, 23),
        (2, "{u}name", 4, 14), (2, "x:name", 3, 10), (2, "", 6, 5), (0, "", 2, 3),
        # What is missing is told where it would stand.
        (2, "size", 3, 3),
    ],
)  # fmt: skip
def test_a_problem_is_where_it_stands_in_the_text(
    number: int, attribute: str | None, line: int, column: int
) -> None:
    subject = make_subject(read_document(TEXT, "r.urdf"), Settings())
    element = subject.document.elements[number]
    edits = (Edit(1, 2, b"x", None),)
    problem = Problem(element, "two \n words", attribute, "a hint", edits)
    found = placed(subject, numbered(subject, [problem]), problem, RULES["MB201"])
    level = RULES["MB201"].level
    expected = Finding("MB201", level, "two words", "a hint", "r.urdf", line, column)
    assert found == expected._replace(edits=edits)
    bare = placed(subject, {element: number}, problem._replace(hint=""), RULES["MB201"])
    assert bare.hint == RULES["MB201"].advice


XACRO = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="side" default="left"/>
  <xacro:macro name="wheel" params="name">
    <link name="${name}" own="1"/>
  </xacro:macro>
  <xacro:wheel name="$(arg side)"/>
  <xacro:wheel name="right"/>
  <link name="base"/>
</robot>
"""


def expanded(folder: Path) -> Subject:
    path = folder / "r.xacro"
    path.write_text(XACRO)
    *_, subject = read_subjects(str(path), path.read_bytes(), Settings())
    assert isinstance(subject, Subject)
    return subject


@pytest.mark.parametrize(
    ("link", "attribute", "line", "column", "call", "level"),
    [
        ("left", "name", 4, 11, 6, WARNING), ("right", "name", 4, 11, 7, ERROR),
        ("left", "own", 4, 26, 6, ERROR), ("left", None, 4, 5, 6, ERROR),
        ("base", "name", 8, 9, 0, ERROR),
    ],
)  # fmt: skip
def test_a_problem_of_an_expansion_is_in_the_source_with_its_calls(
    link: str, attribute: str | None, line: int, column: int, call: int, level: str, tmp_path: Path
) -> None:
    """An error in what an argument gives is a warning: another one may be passed."""
    subject, path = expanded(tmp_path), str(tmp_path / "r.xacro")
    element = next(it for it in subject.document.elements if it.get("name") == link)
    for given, told in ((ERROR, level), (NOTE, NOTE)):
        problem = Problem(
            element, "wrong", attribute, "hint", (Edit(1, 2, b"x", None),), level=given
        )
        found = placed(subject, numbered(subject, [problem]), problem, RULES["MB201"])
        calls = (f"{path}:{call}: wheel",) if call else ()
        assert found == Finding("MB201", told, "wrong", "hint", path, line, column, calls)
