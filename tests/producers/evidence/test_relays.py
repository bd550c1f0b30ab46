# SPDX-License-Identifier: Apache-2.0
"""A relay between a robot and its computer: what it carries is what its lists of names and types say.

Expected from create3_republisher republisher.cpp: pairs of name and type; the robot has the names below
robot_namespace, this node below its own namespace; messages are carried as they are.
"""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml
from fleet_folder import built_fleet
from plans import ends_of

from multibot_rewrite.checks.build import Outputs

REPUBLISHER = """\
/**:
  create3_repub:
    ros__parameters:
      robot_namespace: /_do_not_use
      robot_publishers: ["odom", "nav_msgs/msg/Odometry", "tf", "tf2_msgs/msg/TFMessage"]
      robot_subscriptions: ["cmd_vel", "geometry_msgs/msg/Twist"]
      robot_services: ["e_stop", "irobot_create_msgs/srv/EStop"]
      robot_actions: ["dock", "irobot_create_msgs/action/Dock"]
"""


def made(folder: Path, layout: str, params: str = REPUBLISHER) -> Outputs:
    (folder / "p.yaml").write_text(params)
    (folder / "r.urdf").write_text('<robot name="r"><link name="base_link"/></robot>')
    (folder / "fleet.yaml").write_text(
        f"layout: {layout}\naffix: prefix\ndescription: r.urdf\nnode_sets: create3_repub\n"
        "robots: [{name: robot1}, {name: robot2}]\nrelated_files: {params: p.yaml}\n"
    )
    return built_fleet(folder / "fleet.yaml")


def text(outputs: Outputs, path: str) -> str:
    return next(it.data.decode() for it in outputs.files if it.path == path)


def test_a_relay_has_the_topics_of_its_lists_with_their_types(tmp_path: Path) -> None:
    outputs = made(tmp_path, "tf-per-robot")
    ends = ends_of(outputs.planned, "/robot2/create3_repub")
    assert {(it.role, it.kind, it.name, it.type) for it in ends} == {
        ("publishes", "topic", "/robot2/odom", "nav_msgs/msg/Odometry"),
        ("publishes", "topic", "/robot2/tf", "tf2_msgs/msg/TFMessage"),
        ("subscribes", "topic", "/robot2/cmd_vel", "geometry_msgs/msg/Twist"),
        ("serves", "service", "/robot2/e_stop", "irobot_create_msgs/srv/EStop"),
        ("serves", "action", "/robot2/dock", "irobot_create_msgs/action/Dock"),
    }
    params = yaml.safe_load(text(outputs, "robot2/p.yaml"))
    (section,) = (it["create3_repub"]["ros__parameters"] for it in params.values())
    # Two relays of one robot namespace would both drive one robot.
    assert section["robot_namespace"] == "/robot2/_do_not_use"
    assert section["robot_publishers"][:2] == ["odom", "nav_msgs/msg/Odometry"]


def test_without_lists_it_carries_nothing(tmp_path: Path) -> None:
    empty = "create3_repub: {ros__parameters: {robot_namespace: /own}}\n"
    plan = made(tmp_path, "tf-per-robot", empty).planned
    assert ends_of(plan, "/robot1/create3_repub") == []


def test_in_one_tf_its_tf_is_that_of_all(tmp_path: Path) -> None:
    plan = made(tmp_path, "frames-per-robot").planned
    assert "/tf" in {it.name for it in ends_of(plan, "/robot1/create3_repub")}


@pytest.mark.parametrize("wrong", ['["odom"]', '["odom", "tf", "tf2_msgs/msg/TFMessage"]'])
def test_a_name_without_a_type_has_none(wrong: str, tmp_path: Path) -> None:
    params = REPUBLISHER.replace(
        '["odom", "nav_msgs/msg/Odometry", "tf", "tf2_msgs/msg/TFMessage"]', wrong
    )
    ends = ends_of(made(tmp_path, "tf-per-robot", params).planned, "/robot1/create3_repub")
    assert {it.name: it.type for it in ends}["/robot1/odom"] == ""
