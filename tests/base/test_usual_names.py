# SPDX-License-Identifier: Apache-2.0
"""What is everybody's by convention, as the sources that ``conventions`` names have it."""

from __future__ import annotations

import pytest

from multibot_rewrite.base import conventions
from multibot_rewrite.base.conventions import (
    chooses,
    is_from_outside,
    team,
)


def test_topics_that_robots_share() -> None:
    """rclcpp: every node logs, sends parameter events and reads the clock with use_sim_time."""
    every = ("/clock", "/rosout", "/parameter_events", "/diagnostics", "/diagnostics_agg", "/bond")
    # slam_toolbox for several robots: each reads the scans of all.
    assert (*every, "/localized_scan") == conventions.EVERYBODYS
    assert conventions.SENT_BY_EVERY_NODE == ("/rosout", "/parameter_events")
    assert conventions.READ_BY_EVERY_NODE == ("/clock", "/parameter_events")
    assert conventions.OF_EVERY_NODE == ("/clock", "/rosout", "/parameter_events")
    assert conventions.SENT_BY_ANY_NODE == ("/rosout", "/parameter_events", "/diagnostics")
    assert every[:4] == conventions.SHARED_TOPICS
    assert conventions.CLOCK == "/clock"


def test_frames_of_the_world_and_of_a_robot() -> None:
    """REP 105 and REP 120."""
    assert conventions.WORLD_FRAMES == ("map", "world", "earth", "utm")
    assert conventions.BODY_FRAMES == ("base_footprint", "base_link")
    sent = ("map", "world", "earth", "utm", "local_enu", "odom", "odom_combined")
    assert sent == conventions.SENT_FRAMES
    assert conventions.USUAL_FRAMES == ("map", "odom", "base_footprint", "base_link")


@pytest.mark.parametrize(
    "name",
    [
        "cmd_vel", "cmd_vel_unstamped", "cmd_vel_teleop", "initialpose", "goal_pose", "goal_update",
        "clicked_point", "set_pose", "joy", "speed_limit", "preempt_teleop", "manual_control",
        "reference", "commands", "joint_trajectory", "trajectory", "external_wrench", "feedback",
        "set_feedback", "trajectory_execution_event", "enable_freedrive_mode", "script_command",
        "equilibrium_pose", "speed_scaling_input", "footprint", "delta_twist_cmds",
        "delta_joint_cmds", "pose_target_cmds", "planning_scene", "planning_scene_world",
        "collision_object", "attached_collision_object", "clock", "diagnostics",
        "parameter_events",
    ],
)  # fmt: skip
def test_what_a_person_or_a_scene_sends(name: str) -> None:
    assert is_from_outside(f"/r/{name}") and is_from_outside(name)
    assert not is_from_outside(f"/{name}/x")


@pytest.mark.parametrize(
    ("node", "of"),
    [
        *((f"/r/{it}_r", "Nav2") for it in (
            "controller_server", "behavior_server", "recoveries_server", "velocity_smoother",
            "collision_monitor", "docking_server", "following_server", "bt_navigator", "route_server",
            "planner_server", "waypoint_follower", "lifecycle_manager", "local_costmap",
        )),
        *((f"/a{it}", "MoveIt") for it in ("move_group", "servo_node", "moveit_simple")),
        ("/nav2/driver", "/nav2/driver"), ("/move_group/driver", "/move_group/driver"),
    ],
)  # fmt: skip
def test_nodes_that_take_turns_are_one_team(node: str, of: str) -> None:
    assert team(node) == of


@pytest.mark.parametrize(
    ("node", "it_does"),
    [
        *((f"/r/{it}", True) for it in (
            "twist_mux", "cmd_prioritizer", "arbiter", "vel_selector", "switcher", "twist_manager",
        )),
        ("/mux/driver", False), ("/driver", False),
    ],
)  # fmt: skip
def test_a_node_that_chooses_between_senders(node: str, it_does: bool) -> None:
    assert chooses(node) is it_does
