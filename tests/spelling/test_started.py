# SPDX-License-Identifier: Apache-2.0
"""What is started for the nodes of a table: processes, components, spawners, and their arguments."""

from __future__ import annotations

import argparse
import json
import re
import shlex

import pytest
from paths import ROBOTS

from multibot_rewrite.base.naming import Policy
from multibot_rewrite.fleet.fleet import make_fleet
from multibot_rewrite.spelling.records import Table
from multibot_rewrite.spelling.table_formats import FORMS
from multibot_rewrite.spelling.ways import arguments, launch_arguments, started

GZ = str(ROBOTS / "rover_gz.urdf")


def table(release: str, *stacks: str, layout: str = "tf-per-robot") -> Table:
    policy: Policy = {"layout": layout}
    return make_fleet(GZ, ["robot1", "robot2"], stacks, policy, release=release).table


def lines(made: Table) -> dict[str, list[str]]:
    """The lines of robot1 in the form of ros2 run, by node."""
    text = FORMS["ros-args"](made)
    found = re.findall(r"^# robot1: (\S+)(?: \((\w+)\))?\n(.*)$", text, re.MULTILINE)
    return {node: [way, *shlex.split(line)] for node, way, line in found}


def as_the_spawner_reads(words: list[str]) -> tuple[list[str], str, list[str]]:
    """Names, manager and the controller's arguments (spawner.py of ros2_control 4.46.0 and 6.8.0)."""
    own = words[: words.index("--ros-args")] if "--ros-args" in words else words
    parser = argparse.ArgumentParser()
    parser.add_argument("controller_names", nargs="*")
    parser.add_argument("-c", "--controller-manager", default="controller_manager")
    parser.add_argument("-p", "--param-file", action="append")
    parser.add_argument("--load-only", action="store_true")
    parser.add_argument("--inactive", action="store_true")
    parser.add_argument("-u", "--unload-on-kill", action="store_true")
    parser.add_argument("--controller-ros-args", action="append")
    found = parser.parse_args(own)
    given = [word for text in found.controller_ros_args or () for word in text.split()]
    return found.controller_names, found.controller_manager, given


@pytest.mark.parametrize(
    ("release", "rules"),
    [("humble", []), ("jazzy", ["-r", "/tf:=tf"]), ("lyrical", ["-r", "/tf:=tf"])],
)
def test_the_spawner_reads_the_rules_of_its_controller(release: str, rules: list[str]) -> None:
    way, *words = lines(table(release, "gz_ros2_control"))["diff_drive_controller"]
    assert way == "spawner"
    assert as_the_spawner_reads(words) == (["diff_drive_controller"], "controller_manager", rules)
    assert words[-3:] == ["--ros-args", "-r", "__ns:=/robot1"]


def test_without_a_namespace_it_is_told_the_name_of_its_manager() -> None:
    _, *words = lines(table("lyrical", "ros2_control", layout="postfix"))["diff_drive_controller"]
    names, manager, rules = as_the_spawner_reads(words)
    assert names == ["diff_drive_controller_robot1"]
    assert manager == "controller_manager_robot1"
    assert rules == ["-r", "/tf:=/tf/robot1"]


def test_nothing_is_started_for_what_a_plugin_or_another_process_has() -> None:
    found = lines(table("lyrical", "gz_ros2_control", "nav2"))
    assert found["robot_state_publisher"][0] == ""
    inside = {"controller_manager", "gz_ros_control", "local_costmap/local_costmap"}
    assert inside.isdisjoint(found)
    # The spawner of the stack is that of the line for its controller.
    assert "spawner_joint_state_broadcaster" not in found
    assert "joint_state_broadcaster" in found


def test_a_host_is_started_with_the_rules_of_its_nodes_first() -> None:
    words = lines(table("lyrical", "nav2"))["controller_server"]
    rules = [it for it in words if ":=" in it and not it.startswith("__")]
    assert rules[0].startswith("local_costmap:")
    assert not rules[-1].startswith("local_costmap:")


@pytest.mark.parametrize("release", ["humble", "lyrical"])
def test_a_launch_file_gives_a_spawner_the_rules_of_its_controller(release: str) -> None:
    given = {
        it.node.node: launch_arguments(it)
        for it in started(table(release, "gz_ros2_control"))
        if it.node.robot == "robot2"
    }
    spawner = given["diff_drive_controller"]
    assert spawner["namespace"] == "/robot2"
    rules = ["--controller-ros-args", "-r /tf:=tf"] if release == "lyrical" else []
    assert spawner["arguments"] == ["diff_drive_controller", *rules]


@pytest.mark.more
def test_the_data_says_where_each_rule_stands() -> None:
    found = json.loads(FORMS["json"](table("lyrical", "gz_ros2_control", "nav2")))
    assert found["distro"] == "lyrical"
    own = found["robots"]["robot1"]
    ways = {node: (it["way"], it["at"]) for node, it in own.items()}
    assert ways["controller_manager"] == ("plugin", "controller_manager")
    assert ways["diff_drive_controller"] == ("spawner", "diff_drive_controller")
    assert ways["local_costmap/local_costmap"] == ("host", "controller_server")
    assert ways["amcl"] == ("process", "amcl")
    assert own["diff_drive_controller"]["remappings"] == [["/tf", "tf"]]


@pytest.mark.more
def test_a_component_is_loaded_with_its_name_namespace_and_rules() -> None:
    found = {
        it.node.node: arguments(it)
        for it in started(table("lyrical", "nav2_composed"))
        if it.node.robot == "robot1"
    }
    assert found["amcl"][:4] == ["-n", "amcl", "--node-namespace", "/robot1"]
    assert found["amcl"][4:] == ["-r", "/tf:=tf", "-r", "/tf_static:=tf_static"]
    assert found["nav2_container"][:3] == ["--ros-args", "-r", "__ns:=/robot1"]
