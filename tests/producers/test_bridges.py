# SPDX-License-Identifier: Apache-2.0
"""Arguments of bridges to Gazebo as topics of ROS, as ``parameter_bridge.cpp`` reads them."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml
from launched_nodes import AT, launched, runs, started

from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.producers.launch.bridges import (
    Row,
    bridge_rows,
    bridged_by,
    is_bridge,
    refused_rows,
    told_rows,
)
from multibot_rewrite.spelling.records import Given, Run

BRIDGE = ("ros_gz_bridge", "parameter_bridge", "bridge")


def said(*arguments: str, program: tuple[str, ...] = BRIDGE, **more: object) -> list[str]:
    node = started(*program, arguments=arguments, **more)
    rows = bridge_rows(node, {"robot1"})
    return [f"{it.role} {it.kind} {it.name} {it.type}" for it in rows]


@pytest.mark.parametrize(
    ("row", "expected"),
    [
        ("/scan@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan", ["publishes topic /scan"]),
        ("/scan@sensor_msgs/LaserScan[ignition.msgs.LaserScan", ["publishes topic /scan"]),
        ("scan@sensor_msgs/msg/LaserScan]gz.msgs.LaserScan", ["subscribes topic scan"]),
        (
            "/scan@sensor_msgs/msg/LaserScan@gz.msgs.LaserScan",
            ["publishes topic /scan", "subscribes topic /scan"],
        ),
    ],
)
def test_a_row_is_a_topic_in_its_direction(row: str, expected: list[str]) -> None:
    assert said(row) == [f"{it} sensor_msgs/msg/LaserScan" for it in expected]


def test_a_row_of_a_service_serves_it() -> None:
    type_ = "ros_gz_interfaces/srv/ControlWorld"
    expected = [f"serves service /world/w/control {type_}"]
    assert said(f"/world/w/control@{type_}") == expected
    assert said(f"/world/w/control@{type_}@gz.msgs.WorldControl@gz.msgs.Boolean") == expected


def test_an_image_bridge_publishes_images() -> None:
    program = ("ros_gz_image", "image_bridge", "images")
    for words in (("/camera/image",), ("-v", "/camera/image", "/scan@a/msg/B[gz.C", "--once")):
        assert said(*words, program=program) == [
            "publishes topic /camera/image sensor_msgs/msg/Image"
        ]


def test_rows_of_arguments_as_a_file_has_them_and_those_that_end_the_bridge() -> None:
    """parameter_bridge.cpp: a topic needs its way, a service has none."""
    topics = ("/a@x/msg/B[gz.C", "/b@x/msg/B]gz.C", "c@x/B@gz.C")
    wrong = ("/d@x/msg/B", "/e@", "@x/msg/B[gz.C", "/f@x-y@z")
    it = running(arguments=(*topics, "/g@x/srv/S@gz.C", *wrong, "/g@x/srv/S", "--ros-args", "-v"))
    assert yaml.safe_load(told_rows(it)) == [
        {"topic_name": name, "ros_type_name": type_, "gz_type_name": "gz.C", "direction": way}
        for name, type_, way in (
            *(("/a", "x/msg/B", "GZ_TO_ROS"), ("/b", "x/msg/B", "ROS_TO_GZ")),
            ("c", "x/B", "BIDIRECTIONAL"),
        )
    ]
    assert [*refused_rows(it)] == [*wrong]
    other = it._replace(program="ros_gz_image/image_bridge")
    assert told_rows(other) == told_rows(running(arguments=wrong)) == ""
    assert [*refused_rows(other)] == []


@pytest.mark.parametrize(
    "word",
    ["", "scan", "@a/msg/B[c", "/scan@", "/scan@a/msg/B", "--x", "/a@b c[d", "@@@", "[", "]"],
)
def test_what_is_no_row_is_nothing(word: str) -> None:
    assert said(word) == []


def test_the_arguments_of_another_program_are_no_rows() -> None:
    assert said("/scan@a/msg/B[c", program=("acme", "parameter_bridge", "b")) == []


def test_a_topic_of_one_robots_model_is_known_by_its_rule() -> None:
    row = "/model/robot1/{}@nav_msgs/msg/Odometry[gz.msgs.Odometry"
    rules = (("/model/robot1/odometry", "odom"), ("/model/robot1/tf", "tf"))
    # What leads to this robot alone is not the name for any robot.
    rules += (("/model/robot1/own", "/robot1/own"),)
    found = said(*(row.format(it) for it in ("odometry", "tf", "own", "other")), remappings=rules)
    assert found == [f"publishes topic {it} nav_msgs/msg/Odometry" for it in ("odom", "/tf")]


def test_a_launched_bridge_has_the_topics_of_its_arguments() -> None:
    rows = ("/front@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan",)
    rules = (("/front", "scan"),)
    node = started(*BRIDGE, arguments=rows, remappings=rules, namespace="/robot1")
    found = runs(launched(node))["bridge"]
    assert [(it.name, it.remapped, it.role) for it in found.endpoints] == [
        ("/front", "scan", "publishes")
    ]
    assert not found.shared
    # Without rows it is the node of a file of rows.
    alone = runs(launched(started(*BRIDGE)))["bridge"].endpoints
    assert [(it.name, it.when) for it in alone] == [("/clock", "config_file names /clock")]


def test_a_bridge_of_images_is_known_by_its_arguments() -> None:
    node = started("ros_gz_image", "image_bridge", "images", arguments=("/camera/image",))
    found = launched(node)
    assert not [it for it in found.findings if it.code == "MF822"]
    (facts,) = (it for it in found.nodes if it.name == "images")
    assert [it.name for it in facts.endpoints] == ["/camera/image"]


CONFIG = """\
- {topic_name: both, ros_type_name: a/msg/B}
- {ros_topic_name: ros, gz_topic_name: gz, ros_type_name: a/msg/B, direction: GZ_TO_ROS}
- {ros_topic_name: only_ros, ros_type_name: a/msg/B, direction: ROS_TO_GZ}
- {gz_topic_name: only_gz, direction: BIDIRECTIONAL}
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
    ]
    for text in ("a: [", "text", "- text", ""):
        assert rows_of_text(text) == []


def rows_of_text(text: str) -> list[Row]:
    return list(bridged_by(running(texts=(text,))))


def running(program: str = "ros_gz_bridge/parameter_bridge", **more: object) -> Run:
    node = Run("", "b", "/", "b", (), program=program, place=AT)
    return node._replace(**more)  # type: ignore[arg-type]


def test_a_bridge_is_known_by_its_program() -> None:
    programs = ("ros_gz_bridge/parameter_bridge", "ros_ign_bridge/parameter_bridge")
    images = ("ros_gz_image/image_bridge", "ros_ign_image/image_bridge")
    assert all(is_bridge(running(it)) for it in (*programs, *images))
    assert not is_bridge(running("acme/bridge"))
    facts = NodeFacts("b", "acme", (), known="ros_gz_bridge")
    assert is_bridge(running("acme/bridge", fact=facts))
    assert list(bridged_by(running("acme/bridge", texts=(CONFIG,)))) == []
    rows = bridged_by(running(arguments=("/x@a/srv/B", "/y@a/msg/C@gz.C", "-v")))
    assert [(it.inside, it.end.kind, it.end.role) for it in rows] == [
        ("/x", "service", "serves"),
        ("/y", "topic", "publishes"),
        ("/y", "topic", "subscribes"),
    ]


def test_the_rows_of_the_file_that_a_parameter_names(tmp_path: Path) -> None:
    (tmp_path / "bridge.yaml").write_text(CONFIG)
    for name, count in (("bridge.yaml", 6), ("gone.yaml", 0)):
        given = Given(str(tmp_path / name), AT)
        assert len(list(bridged_by(running(values={"config_file": given})))) == count
