# SPDX-License-Identifier: Apache-2.0
"""Descriptions that a launch file puts into a simulator, and what systems and plugins in them send."""

from __future__ import annotations

from pathlib import Path

import pytest
from launched_nodes import AT, launched, runs, started

from multibot_rewrite.planning.transforms import sent_by
from multibot_rewrite.producers.launch.models import (
    Models,
    Published,
    models_of,
    sent_by_plugins,
    sent_in_simulator,
)
from multibot_rewrite.producers.launch.records import LaunchedNode, ParameterText
from multibot_rewrite.system.records import Edge, edge_of

ROBOT = '<robot name="r"><link name="base"/><gazebo>{}</gazebo></robot>'
OWN = "<robot_base_frame>b</robot_base_frame>"


def plugin(file: str, inside: str = "", name: str = "p") -> str:
    return ROBOT.format(f'<plugin filename="{file}" name="{name}">{inside}</plugin>')


def create(*words: str, **parameters: object) -> LaunchedNode:
    values = "".join(f"    {name}: {it}\n" for name, it in parameters.items())
    texts = (ParameterText("", f"/**:\n  ros__parameters:\n{values}"),) if values else ()
    return started("ros_gz_sim", "create", "c", arguments=words, parameters=texts)


def spawned(text: str, *words: str, name: str = "bot") -> Models:
    return models_of([create("-string", text, "-name", name, *words)], (), "jazzy")


# gz-sim src/systems: the frames are below the name of the model where none are given, the topic of
# OdometryPublisher ends otherwise than that of the drives.
@pytest.mark.parametrize(
    ("system", "inside", "topic", "parent", "child"),
    [
        *((f"gz-sim-{it}-system", "", "/model/bot/tf", "bot/odom", "bot/base")
          for it in ("diff-drive", "ackermann-steering", "mecanum-drive")),
        ("libignition-gazebo-diff-drive-system.so", "", "/model/bot/tf", "bot/odom", "bot/base"),
        ("gz-sim-odometry-publisher-system", "",
         "/model/bot/pose", "bot/odom", "bot/base_footprint"),
        ("gz-sim-odometry-publisher-system", f"<odom_frame>o</odom_frame>{OWN}",
         "/model/bot/pose", "o", "b"),
        ("gz-sim-diff-drive-system",
         "<frame_id>o</frame_id><child_frame_id>b</child_frame_id><tf_topic>/t</tf_topic>",
         "/t", "o", "b"),
    ],
)  # fmt: skip
def test_a_system_sends_the_transform_of_its_odometry(
    system: str, inside: str, topic: str, parent: str, child: str
) -> None:
    text = plugin(system, inside)
    assert sent_in_simulator(spawned(text).found) == {topic: [edge_of(parent, child)]}
    only_published = models_of((), (Published(text, "/robot_description", AT),), "jazzy")
    assert sent_in_simulator(only_published.found) == {}


@pytest.mark.parametrize(
    ("library", "inside", "edges"),
    [
        ("diff_drive", "<publish_wheel_tf>true</publish_wheel_tf>", []),
        ("diff_drive", "<publish_wheel_tf>1</publish_wheel_tf><publish_odom_tf>0</publish_odom_tf>",
         []),
        ("ackermann_drive", "<publish_wheel_tf>true</publish_wheel_tf>", []),
        ("ackermann_drive", "<publish_odom>true</publish_odom>", []),
        ("ackermann_drive",
         "<publish_wheel_tf>1</publish_wheel_tf><publish_odom_tf>1</publish_odom_tf>",
         [("odom", "base_footprint")]),
        # Its transform of odometry has no switch of its own: gazebo_ros_tricycle_drive.cpp:483.
        ("tricycle_drive", "<publish_wheel_tf>true</publish_wheel_tf>", []),
        ("tricycle_drive", "<publish_odom>true</publish_odom>", [("odom", "base_link")]),
        # On by default: gazebo_ros_planar_move.cpp:182.
        ("planar_move", "", [("odom", "base_footprint")]),
        ("planar_move", "<publish_odom_tf>false</publish_odom_tf>", []),
        # A link may be called as the frame of odometry, and no link as that of the base.
        ("planar_move", "<odometry_frame>wheel</odometry_frame>", [("wheel", "base_footprint")]),
        ("planar_move",
         "<odometry_frame>base</odometry_frame><robot_base_frame>wheel</robot_base_frame>",
         [("base", "wheel")]),
        ("joint_state_publisher", "", []),
    ],
)  # fmt: skip
def test_a_drive_of_classic_with_transforms_of_wheels_sends_odometry_by_its_own_switch(
    library: str, inside: str, edges: list[tuple[str, str]]
) -> None:
    """gazebo_ros_pkgs ros2: PublishWheelsTf sends the wheels below their links, PublishOdometryTf
    odometry; each has its own switch."""
    robot = plugin(f"libgazebo_ros_{library}.so", inside, "drive")
    links = (
        '<link name="base"/><link name="wheel"/><joint name="j" type="fixed"><parent link="base"/>'
    )
    robot = robot.replace("<gazebo>", f'{links}<child link="wheel"/></joint><gazebo>', 1)
    sent = sent_by_plugins(spawned(robot).found)
    assert sent == ({"/drive": [("/tf", edge_of(*it)) for it in edges]} if edges else {})


# ---------------------------------------------------------------- what spawns which


def read_as(*nodes: LaunchedNode, published: tuple[Published, ...] = ()) -> list[tuple[str, ...]]:
    found = models_of(nodes, published, "jazzy")
    lost = [("lost", it.name) for it in found.lost]
    return [*lost, *((it.name, it.text, "spawned" * it.spawned) for it in found.found)]


def test_the_model_that_a_spawner_is_told(tmp_path: Path) -> None:
    """ros_gz_sim create.cpp: words, or parameters with the same names."""
    text = ROBOT.format("")
    (tmp_path / "r.urdf").write_text(text)
    told = ("bot", text, "spawned")
    assert read_as(create("-file", str(tmp_path / "r.urdf"), "-name", "bot")) == [told]
    assert read_as(create("-string", text, "-entity", "bot")) == [told]
    assert read_as(create(file=f"'{tmp_path}/r.urdf'", name="bot", world="''")) == [told]
    assert read_as(create("-file", "/gone.urdf")) == [("lost", "c")]
    assert read_as(create("-string", "no XML")) == [("lost", "c")]
    assert read_as(create()) == [("lost", "c")]
    assert read_as(started("acme", "create", arguments=("-string", text))) == []


def test_classic_gives_plugins_the_namespace_of_the_spawner() -> None:
    """gazebo_ros_factory.cpp, AddNamespace: in place of their own; the text stays as it is."""
    mine = "<ros><namespace>/mine</namespace></ros>"
    drive = "<publish_odom_tf>true</publish_odom_tf>"
    for inside in (drive, f"{drive}{mine}", f"{drive}<ros/>"):
        text = plugin("libgazebo_ros_diff_drive.so", inside, "drive")
        (model,) = spawned(text, "-robot_namespace", "/bot").found
        assert [*sent_by_plugins([model])] == ["/bot/drive"]
        assert model.text == text
    assert spawned("<no", "-robot_namespace", "/bot").found == ()


# What a launched static_transform_publisher sends, in a plan and in what a launch would run.

ZEROS = ("0",) * 6


def sends(
    *words: str, executable: str = "static_transform_publisher", text: str = ""
) -> list[Edge]:
    parameters = (ParameterText("", text),) if text else ()
    node = started("tf2_ros", executable, "placed", arguments=words, parameters=parameters)
    return [*sent_by(runs(launched(node))["placed"], "base_link")]


def test_a_frame_below_itself_is_sent_by_nobody() -> None:
    assert sends(*ZEROS, "odom", "/odom") == []
