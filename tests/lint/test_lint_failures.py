# SPDX-License-Identifier: Apache-2.0
"""What is said of files that no rule can check: the whole finding, from the reader's message."""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, Finding
from multibot_rewrite.lint.failures import breakdown, failure, lost, too_long
from multibot_rewrite.rules.settings import Settings

MADE = "a template, in which another program fills in what is missing"
LACKS = "a.xacro:3: xacro failed: unknown macro name: xacro:arm; is it included?"


@pytest.mark.parametrize(
    ("path", "message", "expected"),
    [
        ("a.urdf", "a.urdf: No such file or directory; look",
         Finding("MB102", ERROR, "No such file or directory", "look", "a.urdf", 1, 1)),
        ("a.urdf", "a.urdf: it cannot be read; x", ("MB102", ERROR)),
        ("a.urdf", "a.urdf: Is a directory",
         Finding("MB102", ERROR, "Is a directory", "", "a.urdf", 1, 1)),
        ("a.urdf", "a.urdf: Permission denied", ("MB102", ERROR)),
        ("a.xacro", "a.xacro: xacro failed at 2: package 'b' is not found; x", ("MB119", NOTE)),
        ("a.xacro", "a.xacro:4: xacro failed: Undefined substitution argument c; x",
         ("MB145", NOTE)),
        ("a.xacro", "b.xacro:3:7: xacro failed: no; give it; one",
         Finding("MB103", ERROR, "xacro failed: no; give it", "one", "b.xacro", 3, 7)),
        ("a.urdf", "a.urdf: xacro failed: no", ("MB103", WARNING)),
        ("a.xacro", LACKS, ("MB103", WARNING)),
        ("a.xacro", "a.xacro: xacro failed: name 'b' is not defined", ("MB103", WARNING)),
        ("a.xacro", "a.xacro: xacro failed: has no key", ("MB103", WARNING)),
        ("a.urdf", "a.urdf:2: a template, in which another program fills in {{ a }}; lint",
         ("MB105", NOTE)),
        ("a.urdf", "a.urdf (expanded):2:5: it is not well-formed; see",
         Finding("MB101", ERROR, "it is not well-formed", "see", "a.urdf", 2, 5)),
        ("a.urdf", "a.urdf: elements of ROS 1", ("MB101", WARNING)),
        ("a.sdf", "a.sdf: the root element is <gazebo>", ("MB101", NOTE)),
        ("a.urdf", "a.urdf: DOCTYPE and entities are refused", ("MB101", WARNING)),
        ("a.urdf", "a.urdf: the encoding is latin1", ("MB101", WARNING)),
        ("a.sdf", "a.sdf: the text is not UTF-8", ("MB101", WARNING)),
        ("a.world", "a.world: the text is not UTF-8", ("MB101", WARNING)),
        ("a.urdf", "a.urdf: the text is not UTF-8", ("MB101", ERROR)),
    ],
)  # fmt: skip
def test_the_finding_of_a_file_that_cannot_be_read(
    path: str, message: str, expected: Finding | tuple[str, str]
) -> None:
    found = failure(path, message, Settings())
    assert (found if isinstance(expected, Finding) else (found.code, found.level)) == expected


@pytest.mark.parametrize(
    ("ending", "is_template"),
    [*((it, True) for it in ("in", "jinja", "jinja2", "j2", "erb", "em")), ("xml", False)],
)
def test_a_file_that_another_program_fills_in_is_told_by_its_name(
    ending: str, is_template: bool
) -> None:
    """CMake, Jinja, Ruby and empy."""
    path = f"a.urdf.{ending}"
    found = failure(path, f"{path}:2: it is not well-formed; see", Settings())
    hint = "lint what it makes"
    wrong = Finding("MB101", ERROR, "it is not well-formed", "see", path, 2, 1)
    assert found == (Finding("MB105", NOTE, MADE, hint, path, 1, 1) if is_template else wrong)


@pytest.mark.parametrize(
    ("made", "level"),
    [
        ('<xacro:macro name="arm">', NOTE), ("<xacro:property x='1' name='arm'>", NOTE),
        ('<xacro:arg name="arm">', NOTE), ('<xacro:macro name="arms">', WARNING),
        ('<xacro:arm name="arm">', WARNING), ("", WARNING),
    ],
)  # fmt: skip
def test_a_macro_of_another_file_of_the_folder_may_be_meant(
    made: str, level: str, tmp_path: Path
) -> None:
    path = str(tmp_path / "a.xacro")
    (tmp_path / "a.xacro").write_text('<xacro:macro name="arm">')
    (tmp_path / "b.xacro").write_text(made)
    assert failure(path, LACKS, Settings()).level == level


def test_a_lint_that_stops_says_why() -> None:
    def stopped(code: str, message: str, hint: str, file: str = "a.xacro") -> Finding:
        return Finding(code, ERROR, message, hint, file, 1, 1)

    bug, memory = (
        "this is a bug in urdf-lint",
        "too little memory may be the reason: lint fewer files",
    )
    endless = "does a macro call itself?"
    assert breakdown("a.xacro", MemoryError()) == stopped(
        "MB001", "there is not enough memory for it", endless
    )
    assert breakdown("a.xacro", ValueError("a\n b")) == stopped(
        "MB001", "the lint crashed: ValueError: a b", bug
    )
    killed, ended = lost("a.xacro", 9), lost("a.xacro", 0)
    assert killed == stopped(
        "MB001", "the process that linted it ended by SIGKILL", f"{memory} at a time"
    )
    assert ended.message == "the process that linted it ended before it was done"
    said = "it took more than 1.5 s, the rest was not checked"
    assert too_long("a.xacro", 1.5) == stopped("MB004", said, endless)
    assert too_long("a.urdf", 1.5) == stopped("MB004", said, "", "a.urdf")
