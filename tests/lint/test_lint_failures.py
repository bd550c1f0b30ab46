# SPDX-License-Identifier: Apache-2.0
"""What is said of files that no rule can check: the whole finding, from the reader's message."""

from __future__ import annotations

from pathlib import Path

import pytest
from lint_calls import Settings, lint_data

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, Finding
from multibot_rewrite.base.model import (
    FOR_OLD_GAZEBO,
    FOR_ROS_1,
    NO_ARGUMENT,
    NO_PACKAGE,
    NOT_DEFINED,
    NOT_UTF8,
    REFUSED,
    TEMPLATE,
    UNREADABLE,
    XACRO_FAILED,
    InputError,
)
from multibot_rewrite.lint.failures import breakdown, failure, lost, too_long

LACKS = InputError(
    "a.xacro:3: xacro failed: unknown macro name: xacro:arm; is it included?", NOT_DEFINED, "arm"
)


# Code and level of what is said of a file that its reader refuses so.
REFUSALS = {
    "MB102 error": [
        InputError("a.urdf: it cannot be read; x", UNREADABLE),
        InputError("a.urdf: Permission denied", UNREADABLE),
    ],
    "MB119 note": [
        InputError("a.xacro: xacro failed at 2: package 'b' is not found; x", NO_PACKAGE)
    ],
    "MB145 note": [
        InputError("a.xacro:4: xacro failed: Undefined substitution argument c; x", NO_ARGUMENT)
    ],
    "MB103 warning": [
        InputError("a.urdf: xacro failed: no", XACRO_FAILED),
        LACKS,
        InputError("a.xacro: xacro failed: name 'b' is not defined", NOT_DEFINED, "b"),
        InputError("a.xacro: xacro failed: has no key", NOT_DEFINED),
    ],
    "MB105 note": [
        InputError(
            "a.urdf:2: a template, in which another program fills in {{ a }}; lint", TEMPLATE
        )
    ],
    "MB101 warning": [
        InputError("a.urdf: elements of ROS 1", FOR_ROS_1),
        InputError("a.urdf: DOCTYPE and entities are refused", REFUSED),
        InputError("a.urdf: the encoding is latin1", REFUSED),
        InputError("a.sdf: the text is not UTF-8", NOT_UTF8),
        InputError("a.world: the text is not UTF-8", NOT_UTF8),
    ],
    "MB101 note": [InputError("a.sdf: the root element is <gazebo>", FOR_OLD_GAZEBO)],
    "MB101 error": [InputError("a.urdf: the text is not UTF-8", NOT_UTF8)],
}


@pytest.mark.parametrize(
    ("path", "error", "expected"),
    [
        (
            "a.urdf",
            InputError("a.urdf: No such file or directory; look", UNREADABLE),
            Finding("MB102", ERROR, "No such file or directory", "look", "a.urdf", 1, 1),
        ),
        (
            "a.urdf",
            InputError("a.urdf: Is a directory", UNREADABLE),
            Finding("MB102", ERROR, "Is a directory", "", "a.urdf", 1, 1),
        ),
        (
            "a.xacro",
            InputError("b.xacro:3:7: xacro failed: no; give it; one", XACRO_FAILED),
            Finding("MB103", ERROR, "xacro failed: no; give it", "one", "b.xacro", 3, 7),
        ),
        (
            "a.urdf",
            InputError("a.urdf (expanded):2:5: it is not well-formed; see"),
            Finding("MB101", ERROR, "it is not well-formed", "see", "a.urdf", 2, 5),
        ),
    ],
)
def test_the_finding_of_a_file_that_cannot_be_read(
    path: str, error: InputError, expected: Finding
) -> None:
    assert failure(path, error, Settings()) == expected


@pytest.mark.parametrize(
    ("said", "error"), [(said, error) for said in REFUSALS for error in REFUSALS[said]]
)
def test_what_is_said_of_a_file_that_cannot_be_read(said: str, error: InputError) -> None:
    found = failure(str(error).partition(":")[0], error, Settings())
    assert f"{found.code} {found.level}" == said


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


XACRO = '<robot name="a" xmlns:xacro="http://www.ros.org/wiki/xacro">{}</robot>'


@pytest.mark.parametrize(
    ("path", "text", "expected"),
    [
        ("a.xacro", XACRO.format("<xacro:include filename='no.xacro'/>"), ("MB102", ERROR)),
        ("a.xacro", XACRO.format("<xacro:arm/>"), ("MB103", WARNING)),
        ("a.xacro", XACRO.format("<link name='${b}'/>"), ("MB103", WARNING)),
        ("a.xacro", XACRO.format("<link name='${1/0}'/>"), ("MB103", ERROR)),
        ("a.xacro", XACRO.format("<link name='$(arg c)'/>"), ("MB145", NOTE)),
        ("a.xacro", XACRO.format("<link name='$(find own_thing)'/>"), ("MB119", NOTE)),
        ("a.urdf", '<robot name="{{ a }}"/>', ("MB105", NOTE)),
        ("a.sdf", '<gazebo version="1.0"/>', ("MB101", NOTE)),
        ("a.urdf", '<!DOCTYPE a><robot name="a"/>', ("MB101", WARNING)),
        (
            "a.urdf",
            '<?xml version="1.0" encoding="latin1"?><robot name="\xe9"/>',
            ("MB101", WARNING),
        ),
        (
            "a.rviz",
            "Visualization Manager:\n  Displays:\n    - Class: rviz/Grid\n",
            ("MB101", WARNING),
        ),
        ("a.yaml", "a: &b {ros__parameters: {c: 1}}\n", ("MB101", ERROR)),
        ("a.urdf", "<robot", ("MB101", ERROR)),
    ],
)
def test_a_reader_gives_the_cause_that_decides(
    path: str, text: str, expected: tuple[str, str], tmp_path: Path
) -> None:
    """The levels are those of xacro and Gazebo: what they read all the same is no error."""
    found = lint_data(str(tmp_path / path), text.encode("latin1"), Settings())
    assert [(it.code, it.level) for it in found if it.code[:4] in ("MB10", "MB11", "MB14")][:1] == [
        expected
    ]
