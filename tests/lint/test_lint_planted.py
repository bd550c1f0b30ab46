# SPDX-License-Identifier: Apache-2.0
"""Defects of the kinds other linters were measured with, one a file: each is found at its line.

What follows from a defect (renaming a link leaves its joint without a child) is reported
as well, and nothing else.
"""

from __future__ import annotations

import pytest
from paths import FIXTURES

from multibot_rewrite.base.findings.finding import NOTE
from multibot_rewrite.lint.check import lint_file
from multibot_rewrite.rules.settings import Settings

PLANTED = FIXTURES / "lint" / "planted"
# File -> (code, line) of the defect, then of what follows from it.
FOUND = {
    "bad_joint_type": [("MB124", 66)],
    "bad_mass_number": [("MB120", 9)],
    "cycle": [("MB503", 66), ("MB505", 40)],
    "double_colon": [("MB305", 24)],
    "duplicate_joint": [("MB201", 80)],
    "duplicate_link": [("MB201", 51), ("MB202", 83)],
    "empty_name": [("MB302", 40), ("MB202", 76)],
    "gazebo_reference": [("MB202", 110)],
    "inertia_not_positive": [("MB606", 27)],
    "inverted_limits": [("MB511", 71)],
    "mimic_itself": [("MB526", 86)],
    "mimic_unknown": [("MB211", 86)],
    "missing_limit": [("MB509", 66)],
    "missing_mesh": [("MB701", 31)],
    "negative_mass": [("MB125", 26)],
    "not_well_formed": [("MB101", 17)],
    "plugin_frame": [("MB217", 114)],
    "plugin_joint": [("MB211", 120)],
    "ros2_control_joint": [("MB211", 101)],
    "transmission_joint": [("MB211", 90)],
    "two_parents": [("MB504", 83), ("MB501", 51)],
    "two_roots": [("MB501", 7)],
    "undefined_material": [("MB131", 16)],
    "unknown_attribute": [("MB110", 67)],
    "unknown_child": [("MB202", 83)],
    "unknown_element": [("MB110", 25)],
    "unknown_parent": [("MB202", 68)],
    "zero_axis": [("MB519", 84)],
}


def test_there_are_28_defects_and_a_robot_without() -> None:
    names = {path.stem for path in PLANTED.glob("*.urdf")}
    assert names == {*FOUND, "healthy"}
    assert len(FOUND) == 28


@pytest.mark.sample(1)
@pytest.mark.parametrize("name", [*FOUND, "healthy"])
def test_a_defect_is_found_at_its_line_and_nothing_else(name: str) -> None:
    found = lint_file(str(PLANTED / f"{name}.urdf"), Settings())
    reported = sorted((it.code, it.line) for it in found if it.level != NOTE)
    assert reported == sorted(FOUND.get(name, []))
