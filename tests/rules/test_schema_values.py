# SPDX-License-Identifier: Apache-2.0
"""What readers make of a value: libsdformat (src/Param.cc), urdfdom (urdf_parser.h), srdfdom."""

from __future__ import annotations

import pytest

from multibot_rewrite.rules.schema.sdf_values import misread, number_in
from multibot_rewrite.rules.schema.sections import wrong_numbers
from multibot_rewrite.rules.schema.srdf import ELEMENTS, numbers_in
from multibot_rewrite.rules.schema.versions import (
    RVIZ,
    highest_version,
    is_known,
    read_version,
    reader_of,
)

NO_NUMBER, LARGE = ("is not a number", True), ("is too large a number", True)
BELOW = ("is below 0, and is read as a number above 4 billion", False)
NEITHER = "is neither true nor false"
OUTSIDE = ("has a number outside of 0 to 1", True)


@pytest.mark.parametrize(
    ("type_", "text", "wrong"),
    [
        ("double", "1.5", None),
        ("double", "-.5e3", None),
        ("double", "INF", None),
        # stod reads them, too.
        ("double", "0x1F", None),
        ("double", "true", None),
        ("double", "", None),
        ("double", "abc", NO_NUMBER),
        ("double", "1.5m", ("is read as 1.5", False)),
        ("double", "1,5", ("is read as 1", False)),
        ("double", "1e999", LARGE),
        ("float", "x", NO_NUMBER),
        ("int", "3", None),
        ("int", "3.0", None),
        ("int", "3.", None),
        ("int", "3.5", ("is read as 3", False)),
        ("int", "1" * 20, None),
        ("int", "1" * 21, LARGE),
        ("integer", "x", NO_NUMBER),
        ("unsigned_int", "3", None),
        ("unsigned_int", "-1", None),
        ("unsigned_int", "-2", BELOW),
        ("bool", "TRUE", None),
        ("bool", "0", None),
        ("bool", "yes", (NEITHER, True)),
        ("boolean", "2", (NEITHER, True)),
        ("truth", "No", None),
        ("truth", "on", (NEITHER, False)),
        ("vector2d", "1 2", None),
        ("vector2d", "1", ("is not 2 numbers", True)),
        ("vector3", "1 2 3", None),
        ("vector3", "1 2 3 x", None),
        ("vector3", "1 2 3x", None),
        ("vector3", "1 2x 3", ("is not 3 numbers", True)),
        ("vector3", "1 x 3", ("is not 3 numbers", True)),
        ("vector", "1 2", ("is not 3 numbers", True)),
        ("pose", "0 0 0 0 0 0", None),
        ("pose", "0 0 0", ("has 3 numbers of 6", True)),
        ("pose", "0 0 0 0 0 x", ("is not 6 numbers", True)),
        ("quat_xyzw", "0 0 0 0 0 0 1", None),
        ("quat_xyzw", "0 0 0 0 0 0", ("has 6 numbers of 7", True)),
        ("color", "0 .5 1", None),
        ("color", "0 .5 1 1", None),
        ("color", "0 .5", ("is not three or four numbers", True)),
        ("color", "0 .5 1 1 1", ("is not three or four numbers", True)),
        ("color", "0 x 1", ("is not three or four numbers", True)),
        ("color", "0 0 1.1", OUTSIDE),
        ("color", "0 0 -1", OUTSIDE),
        ("string", "x", None),
    ],
)
def test_what_libsdformat_makes_of_a_text(
    type_: str, text: str, wrong: tuple[str, bool] | None
) -> None:
    assert misread(type_, text) == wrong


@pytest.mark.parametrize(
    ("text", "number"), [("1.5m", 1.5), ("-2", -2.0), ("x", None), ("0x10", None), ("", None)]
)
def test_the_number_that_a_text_begins_with(text: str, number: float | None) -> None:
    assert number_in(text) == number


@pytest.mark.parametrize(
    ("text", "version"),
    [
        ("1.0", (1, 0)),
        ("1.2", (1, 2)),
        ("2.13", (2, 13)),
        # strtol takes white space and a sign.
        (" +1. 1", (1, 1)),
        ("1.-0", (1, 0)),
        ("1.-1", None),
        ("1.0.", (1, 0)),
        ("1.0.0", None),
        ("1", None),
        ("1.", None),
        ("", None),
        ("1.x", None),
    ],
)
def test_the_version_that_urdfdom_reads(text: str, version: tuple[int, int] | None) -> None:
    assert read_version(text) == version
    assert is_known(text) == (version in [(1, 0), (1, 1), (1, 2)])


VALUE = "value"
SPACES, POINT = "separate numbers by spaces, not commas", "use a decimal point"
UNIT = "leave the unit out: lengths are metres, angles radians, masses kilograms"
FINITE = (VALUE, ", which is not finite", "write a large number, or leave it out")


@pytest.mark.parametrize(
    ("kind", "value", "wrong"),
    [
        ("number", "1", ("", "", "")),
        ("number", "", (VALUE, ", which is not a number", "")),
        ("number", "x", (VALUE, "", "")),
        ("number", "1,5", (VALUE, "", POINT)),
        ("number", "5kg", (VALUE, "", UNIT)),
        ("number", "${m}", (VALUE, "", "expand it with xacro first")),
        ("number", "inf", FINITE),
        ("number", "1e999", FINITE),
        ("number", "1 ", (VALUE, ", with a space after it", "delete the space")),
        ("number", "1 2", (VALUE, ": 2 numbers of 1", "")),
        ("numbers", "1", (VALUE, ": 1 number of 3", "")),
        ("numbers", "1 2 3 ", ("", "", "")),
        ("numbers", "1, 2, 3", (VALUE, ": '1,' is not a number", SPACES)),
        ("numbers", "1 2 3m", (VALUE, ": '3m' is not a number", UNIT)),
        ("rgba", "0 0 0 1", ("", "", "")),
        ("rgba", "0 0 0 255", (VALUE, ": outside of 0 to 1", "divide by 255")),
        ("rgba", "0 0 -1 1", (VALUE, ": outside of 0 to 1", "")),
        ("unsigned", "0", ("", "", "")),
        ("unsigned", "-1", ("range", ", which is below 0", "")),
        ("positive", "0", ("range", ", which is not above 0", "")),
        ("positives", "1 1 0", ("range", ", which is not above 0", "")),
        ("positives", "1 1 1", ("", "", "")),
        ("quaternion", "0 0 1", (VALUE, ": 3 numbers of 4", "")),
    ],
)
def test_what_is_wrong_with_numbers(kind: str, value: str, wrong: tuple[str, str, str]) -> None:
    assert wrong_numbers(value, kind) == wrong


@pytest.mark.parametrize(
    ("text", "numbers"),
    [("1 -2.5", [1.0, -2.5]), ("", None), ("x", None), ("1 nan", None), ("1 inf", None)],
)
def test_numbers_of_a_state(text: str, numbers: list[float] | None) -> None:
    assert numbers_in(text) == numbers


def test_what_reads_a_description_in_a_release() -> None:
    assert [highest_version(it) for it in ("jazzy", "lyrical")] == [(1, 0), (1, 2)]
    assert str(reader_of("humble", RVIZ)) == "RViz 11.2.28 of humble"


def test_what_srdfdom_reads_of_each_element() -> None:
    """srdfdom model.cpp: element: needed attributes, others, children."""
    rows = """\
        group: name, , link joint passive_joint chain group
        group/link: name, ,
        group/joint: name, ,
        group/passive_joint: name, ,
        group/chain: base_link tip_link, ,
        group/group: name, ,
        group_state: name group, , joint
        group_state/joint: name value, ,
        end_effector: name group parent_link, parent_group,
        virtual_joint: name child_link parent_frame type, ,
        passive_joint: name, ,
        disable_collisions: link1 link2, reason,
        enable_collisions: link1 link2, reason,
        disable_default_collisions: link, ,
        link_sphere_approximation: link, , sphere
        link_sphere_approximation/sphere: center radius, ,
        joint_property: joint_name property_name value, ,
    """
    pairs = (row.strip().partition(": ") for row in rows.strip().splitlines())
    assert {name: tuple(tuple(it.split()) for it in row.split(",")) for name, _, row in pairs} == (
        ELEMENTS
    )
