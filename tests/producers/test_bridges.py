# SPDX-License-Identifier: Apache-2.0
"""Arguments of bridges to Gazebo as topics of ROS, as ``parameter_bridge.cpp`` reads them."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml
from launched_nodes import AT, launched, started

from multibot_rewrite.planning.records import Run
from multibot_rewrite.producers.ends import bridge_rows as rows_of_file
from multibot_rewrite.producers.launch.bridges import (
    BridgedDomains,
    Row,
    bridge_rows,
    bridged_by,
    bridged_domains,
    refused_rows,
    rows_in_arguments,
)
from multibot_rewrite.related_files.yaml_text import read_yaml
from multibot_rewrite.system.records import PUBLISHES, SUBSCRIBES

BRIDGE = ("ros_gz_bridge", "parameter_bridge", "bridge")


def said(*arguments: str, program: tuple[str, ...] = BRIDGE, **more: object) -> list[str]:
    node = started(*program, arguments=arguments, **more)
    rows = bridge_rows(node, {"robot1"})
    return [f"{it.role} {it.kind} {it.name} {it.type}" for it in rows]


def test_rows_of_arguments_as_a_file_has_them_and_those_that_end_the_bridge() -> None:
    """parameter_bridge.cpp: a topic needs its way, a service has none."""
    topics = ("/a@x/msg/B[gz.C", "/b@x/msg/B]gz.C", "c@x/B@gz.C")
    wrong = ("/d@x/msg/B", "/e@", "@x/msg/B[gz.C", "/f@x-y@z")
    it = running(arguments=(*topics, "/g@x/srv/S@gz.C", *wrong, "/g@x/srv/S", "--ros-args", "-v"))
    assert yaml.safe_load(rows_in_arguments(it)) == [
        {"topic_name": name, "ros_type_name": type_, "gz_type_name": "gz.C", "direction": way}
        for name, type_, way in (
            *(("/a", "x/msg/B", "GZ_TO_ROS"), ("/b", "x/msg/B", "ROS_TO_GZ")),
            ("c", "x/B", "BIDIRECTIONAL"),
        )
    ]
    assert [*refused_rows(it)] == [*wrong]
    other = it._replace(program="ros_gz_image/image_bridge")
    assert rows_in_arguments(other) == rows_in_arguments(running(arguments=wrong)) == ""
    assert [*refused_rows(other)] == []
    # The text of an object (f"{LaunchConfiguration(...)}/image") is no topic, and rcl refuses it.
    images = running(arguments=("<a.B object at 0x7f>/image", "cam/image"))
    assert [it.end.name for it in bridged_by(images._replace(program=other.program))] == [
        "cam/image"
    ]


def test_a_topic_of_one_robots_model_is_known_by_its_rule() -> None:
    row = "/model/robot1/{}@nav_msgs/msg/Odometry[gz.msgs.Odometry"
    rules = (("/model/robot1/odometry", "odom"), ("/model/robot1/tf", "tf"))
    # What leads to this robot alone is not the name for any robot.
    rules += (("/model/robot1/own", "/robot1/own"),)
    found = said(*(row.format(it) for it in ("odometry", "tf", "own", "other")), remappings=rules)
    assert found == [f"publishes topic {it} nav_msgs/msg/Odometry" for it in ("odom", "/tf")]


CONFIG = """\
- {topic_name: both, ros_type_name: a/msg/B}
- {ros_topic_name: ros, gz_topic_name: gz, ros_type_name: a/msg/B, direction: GZ_TO_ROS}
- {ros_topic_name: only_ros, ros_type_name: a/msg/B, direction: ROS_TO_GZ}
- {gz_topic_name: only_gz, direction: BIDIRECTIONAL}
- {ros_topic_name: of_humble, ign_topic_name: ign, direction: ROS_TO_IGN}
- {ros_type_name: a/msg/B}
"""


def test_a_row_of_a_file_has_a_name_on_either_side() -> None:
    """ros_gz_bridge bridge_config.cpp: one name stands for both; without a direction both ways.
    gz-transport TopicUtils.cc: a name without a slash is below /."""
    found = [(it.inside, it.end.role, it.end.name) for it in rows_of_text(CONFIG)]
    assert found == [
        ("/both", "publishes", "both"),
        ("/both", "subscribes", "both"),
        ("/gz", "publishes", "ros"),
        ("/only_ros", "subscribes", "only_ros"),
        ("/only_gz", "publishes", "only_gz"),
        ("/only_gz", "subscribes", "only_gz"),
        ("/ign", "subscribes", "of_humble"),
    ]
    last = [*rows_of_file(read_yaml(CONFIG.encode(), ""))][-1]
    assert (last.inside, last.end.role, last.end.name) == ("ign", "subscribes", "/of_humble")
    for text in ("a: [", "text", "- text", ""):
        assert rows_of_text(text) == []


def rows_of_text(text: str) -> list[Row]:
    return list(bridged_by(running(texts=(text,))))


def running(program: str = "ros_gz_bridge/parameter_bridge", **more: object) -> Run:
    node = Run("", "b", "/", "b", (), program=program, place=AT)
    return node._replace(**more)  # type: ignore[arg-type]


# Spawners that ask for a controller manager that nothing starts.

MANAGER = started("controller_manager", "ros2_control_node", namespace="/robot1")


@pytest.mark.parametrize(
    ("words", "asked"),
    [
        # As Husarion's ROSbot has it: the namespace is there twice.
        (("-n", "robot1", "-c", "robot1/controller_manager"), "/robot1/robot1/controller_manager"),
        (("-n", "robot1", "-c", "controller_manager"), ""),
        (("-c", "/robot1/controller_manager"), ""),
        (("-c", "/robot1/manager"), "/robot1/manager"),
        ((), "/controller_manager"),
    ],
)
def test_a_spawner_asks_for_a_manager_that_runs(words: tuple[str, ...], asked: str) -> None:
    spawner = started("controller_manager", "spawner", arguments=("drive", "lift", *words))
    found = launched(MANAGER, spawner)
    said = [it.message for it in found.findings if it.code == "MG723"]
    text = f"the spawner of drive, lift asks for {asked}, which nothing starts"
    assert said == ([text] if asked else [])
    assert {it.manager for it in found.spawned.values()} == {"/robot1/controller_manager"}
    assert {"drive", "lift"} == set(found.spawned)


# What a launched domain_bridge has in each domain.
#
# Expectations: ros2/domain_bridge c2523e1, process_cmd_line_arguments.hpp,
# parse_domain_bridge_yaml_config.cpp and domain_bridge.cpp (get_node_for_domain, bridge_topic,
# add_bridges).
FILE = """\
name: bridge
from_domain: 2
to_domain: 3
topics:
  chatter: {type: std_msgs/msg/String}
  /back: {type: std_msgs/msg/String, reversed: true, remap: /forth}
  other: {type: std_msgs/msg/String, from_domain: 4, to_domain: 5, bidirectional: true}
"""


def bridged(*arguments: str, program: str = "domain_bridge/domain_bridge") -> BridgedDomains:
    run = Run("", "n", "/r", "n", (), program=program, arguments=arguments, place=AT)
    return bridged_domains([run])


def ends(found: BridgedDomains) -> set[tuple[str, str, str]]:
    return {(it.node, it.role, it.name) for it in found.ends}


@pytest.fixture
def file(tmp_path: Path) -> str:
    path = tmp_path / "bridge.yaml"
    path.write_text(FILE)
    return str(path)


def test_each_topic_is_read_in_one_domain_and_sent_in_the_other(file: str) -> None:
    found = bridged(file, "--wait-for-subscription", "true")
    assert ends(found) == {
        ("/bridge_2", SUBSCRIBES, "/chatter"),
        ("/bridge_3", PUBLISHES, "/chatter"),
        ("/bridge_3", SUBSCRIBES, "/back"),
        ("/bridge_2", PUBLISHES, "/forth"),
        ("/bridge_4", SUBSCRIBES, "/other"),
        ("/bridge_5", PUBLISHES, "/other"),
        ("/bridge_5", SUBSCRIBES, "/other"),
        ("/bridge_4", PUBLISHES, "/other"),
    }
    assert [it.name for it in found.nodes] == [f"/bridge_{it}" for it in (2, 3, 4, 5)]
    assert {it.type for it in found.ends} == {"std_msgs/msg/String"}
    assert found.notes == ()


def test_options_hold_for_all_topics(file: str) -> None:
    found = bridged("--from", "7", file, "--to", "8")
    assert {it.name for it in found.nodes} == {"/bridge_7", "/bridge_8"}
    assert ("/bridge_8", SUBSCRIBES, "/back") in ends(found)


@pytest.mark.parametrize(
    "row",
    [
        "{type: a/msg/B, from_domain: 2}",
        "{type: a/msg/B, from_domain: 2, to_domain: 2}",
        "{type: a/msg/B, from_domain: two, to_domain: 3}",
        "[]",
    ],
)
def test_what_is_not_bridged_makes_no_node(row: str, tmp_path: Path) -> None:
    path = tmp_path / "bridge.yaml"
    path.write_text(f"topics: {{/x: {row}}}\n")
    assert bridged(str(path)) == BridgedDomains((), (), ())
