# SPDX-License-Identifier: Apache-2.0
"""Two arms that are joined, against the vendors' own descriptions of two arms.

With MULTIBOT_SOURCES=FOLDER, which has the checkouts; skipped without. What differs is listed here, and
in docs/contributing/measurements.md why.
"""

from __future__ import annotations

import pytest
from joined_duals import every
from vendor_sources import WITHOUT, sources_folder

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sources_folder() is None, reason=WITHOUT),
]
# Elements that are the same, of how many; what differs.
EXPECTED = {
    "UR, my_dual_robot_cell": (
        (60, 62),
        {"ros2_control name: alice -> alice_alice", "ros2_control name: bob -> bob_bob"},
    ),
    "xArm, dual_xarm_device": (
        (52, 78),
        {
            "<material>: 8 -> 4",
            *(
                f"material name: {side}_{colour} -> {colour}"
                for side, colours in (
                    ("L", ("White", "Silver", "Black", "Red")),
                    ("R", ("White", "Silver")),
                )
                for colour in colours
            ),
            "ros2_control name: UFRobotSystem -> L_UFRobotSystem",
            "ros2_control name: UFRobotSystem -> R_UFRobotSystem",
        },
    ),
    "Kinova, kortex_dual_robots": (
        (75, 77),
        {
            f"param text: {(joint := 'robotiq_85_left_knuckle_joint')} -> {side}_{joint}"
            for side in ("left", "right")
        }
        | {f"param text: {side}_ -> " for side in ("left", "right")},
    ),
    "KUKA, dual_arm_template": ((43, 43), set()),
    "LBR, lbr_dual_arm": (
        (68, 71),
        {
            "<joint>: 2 -> 4",
            "<link>: 0 -> 2",
            "<gazebo>: 1 -> 0",
            "joint lbr_one_base_joint: 3 elements -> 4",
            "joint name: lbr_two_base_joint -> lbr_one_floating_joint",
            "child link: lbr_two_link_0 -> lbr_one_link_0",
            "parent link: base_link -> lbr_one_floating_link",
        },
    ),
    "Franka, fr3_duo": (
        (57, 61),
        {
            f"joint name: {side}_fr3v2_{side}_base_joint -> {side}_fr3v2_base_joint"
            for side in ("left", "right")
        }
        | {f"joint name: {side}_base_joint -> {side}_mount" for side in ("left", "right")},
    ),
}


def test_two_joined_arms_are_what_their_vendor_has() -> None:
    found = {name: it for name, it in every() if not it.refused}
    assert found, "no vendor's packages are below the folder"
    for name, it in found.items():
        counts, others = EXPECTED[name]
        assert (it.same, it.many) == counts, name
        assert set(it.others) == others, name


def test_a_vendors_description_that_cannot_be_expanded_is_known() -> None:
    refused = {name: it.refused for name, it in every() if it.refused}
    assert refused in ({}, {"Kinova, kortex_dual_robots": 'error: Invalid parameter "sim"'})
