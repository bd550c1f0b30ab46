# SPDX-License-Identifier: Apache-2.0
"""What is latched is read: descriptions that are empty, another robot's, of other frames or joints."""

from __future__ import annotations

import struct
from collections.abc import Callable

import pytest
from graph_examples import read_system

from multibot_rewrite.producers.ros.headers import DescriptionSamples, described
from multibot_rewrite.rules.check import judge
from multibot_rewrite.system.domains import named, side_by_side, space_of
from multibot_rewrite.system.json import from_json, to_json
from multibot_rewrite.system.merging import Look, merged
from multibot_rewrite.system.records import (
    PUBLISHES,
    SUBSCRIBES,
    TOPIC,
    Description,
    End,
    Environment,
    Qos,
    System,
)

URDF = (
    '<robot name="r"><link name="base"/><link name="arm"/><joint name="a" type="revolute"/>'
    '<joint name="b" type="fixed"/></robot>'
)


@pytest.mark.parametrize(
    ("text", "links", "joints"),
    [
        (URDF, ("base", "arm"), ("a",)),
        (f"<?xml version='1.0' encoding='utf-8'?>{URDF}", ("base", "arm"), ("a",)),
        ("", (), ()),
        ("  ", (), ()),
        ("ros2 param get failed", (), ()),
        ("<robot", (), ()),
        ('<sdf version="1.9"><model name="m"/></sdf>', (), ()),
        ('<!DOCTYPE r [<!ENTITY x SYSTEM "file:///etc/passwd">]><robot><link name="&x;"/></robot>',
         (), ()),
    ],
)  # fmt: skip
def test_what_a_description_names(
    text: str, links: tuple[str, ...], joints: tuple[str, ...]
) -> None:
    assert described("/d", text) == Description("/d", links, joints)


def test_each_topic_of_a_description_is_read_once() -> None:
    asked: list[tuple[str, bool]] = []
    receive: dict[str, Callable[[bytes], None]] = {}
    ended: list[str] = []

    def subscribe(
        name: str, type_: str, latched: bool, callback: Callable[[bytes], None]
    ) -> object:
        asked.append((name, latched))
        receive[name] = callback
        return lambda: ended.append(name)

    def end(name: str, role: str = PUBLISHES, durability: str = "", type_: str = "String") -> End:
        inf = float("inf")
        qos = Qos("UNKNOWN", 0, "RELIABLE", durability, inf, inf, "AUTOMATIC", inf)
        return End(
            TOPIC, role, name, f"std_msgs/msg/{type_}", node="/n", qos=qos if durability else None
        )

    samples = DescriptionSamples(subscribe)  # type: ignore[arg-type]
    ends = [
        end("/a/robot_description"),
        end("/b/robot_description", durability="TRANSIENT_LOCAL"),
        end("/c/robot_description", durability="VOLATILE"),
        end("/d/robot_description", SUBSCRIBES),
        end("/e/robot_description_semantic"),
        end("/f/description", type_="Bool"),
    ]
    for _ in range(2):
        samples.update(ends)
    assert asked == [
        ("/a/robot_description", True),
        ("/b/robot_description", True),
        ("/c/robot_description", False),
    ]
    body = URDF.encode() + b"\0"
    receive["/b/robot_description"](b"\0\1\0\0" + struct.pack("<I", len(body)) + body)
    receive["/a/robot_description"](b"cut")
    assert ended == ["/b/robot_description"]
    assert samples.found() == (Description("/b/robot_description", ("base", "arm"), ("a",)),)


def test_a_file_and_several_looks_keep_it() -> None:
    one = System(
        environment=Environment(), descriptions=(Description("/a/robot_description", ("x",)),)
    )
    assert from_json(to_json(one), "a.json") == one
    other = one._replace(descriptions=(Description("/b/robot_description", (), ("j",)),))
    both = (*one.descriptions, *other.descriptions)
    assert merged([Look("a", one), Look("b", other)]).descriptions == both
    assert side_by_side({1: one, 2: other}).descriptions == both
    (it,) = named(one, 3).descriptions
    assert it.topic == f"{space_of(3)}/a/robot_description"


ROBOT = [
    "/{0}/rsp publishes /{0}/robot_description std_msgs/msg/String",
    "/{0}/jsb publishes /{0}/joint_states sensor_msgs/msg/JointState",
    "/{0}/rsp publishes /tf_static tf2_msgs/msg/TFMessage",
    "transform {0}/base -> {0}/arm on /tf_static by /robot1/rsp, /robot2/rsp",
]


@pytest.mark.parametrize(
    ("links", "joints", "told"),
    [
        ("links robot1/base, robot1/arm; joints a, b", "a", ""),
        # robot_state_publisher may put a prefix in front; one link fits anything.
        ("links base, arm", "", ""),
        ("links world", "", ""),
        ("no links", "", "is empty, or no URDF"),
        ("links robot2/base, robot2/arm", "", "has the links of robot2"),
        (
            "links chassis, mast",
            "",
            "no link of /robot1/robot_description (chassis, mast) is a frame",
        ),
        ("links base, arm; joints a, b", "robot1_a", "has the joints a, b, and /robot1/jsb sends"),
        # Of several joints some may be another node's.
        ("links base, arm; joints a, b", "b", ""),
    ],
)
def test_a_description_fits_its_robot(links: str, joints: str, told: str) -> None:
    lines = [it.format(robot) for robot in ("robot1", "robot2") for it in ROBOT]
    lines.append(f"description on /robot1/robot_description: {links}")
    lines += [f"joints {joints} on /robot1/joint_states"] if joints else []
    found = judge(read_system("\n".join(f"running: {it}" for it in lines)))
    assert [(it.code, it.level, it.robot, it.node) for it in found] == (
        [("MG420", "error", "robot1", "/robot1/rsp")] if told else []
    )
    assert all(told in it.message for it in found)


@pytest.mark.parametrize(
    ("links", "heard", "level", "reader"),
    [
        # robot_state_publisher.cpp sends a moving joint when its state comes.
        ("base, arm, hand", "a", "warning", ""),
        ("base, arm, tool, hand", "a", "warning", ""),
        ("robot1/base, robot1/arm, robot1/hand", "a", "warning", ""),
        (
            "base, arm, hand",
            "a",
            "error",
            "/robot1/move_group",
        ),
        # A mimic joint has no state of its own, and its link is sent.
        ("base, arm", "a", "", ""),
        ("base, arm, hand", "a b", "", ""),
        ("base, arm, hand", "", "", ""),
    ],
)
def test_a_joint_whose_state_nobody_sends(links: str, heard: str, level: str, reader: str) -> None:
    lines = [it.format(robot) for robot in ("robot1", "robot2") for it in ROBOT]
    lines.append(f"description on /robot1/robot_description: links {links}; joints a, b")
    lines.append("transform robot1/tip -> robot1/tool on /tf_static by /robot1/rsp")
    lines += [f"joints {it} on /robot1/joint_states" for it in heard.split()]
    lines += [
        f"{it} subscribes /robot1/joint_states sensor_msgs/msg/JointState" for it in reader.split()
    ]
    found = judge(read_system("\n".join(f"running: {it}" for it in lines)))
    assert [(it.code, it.level, it.node) for it in found] == (
        [("MG420", level, "/robot1/rsp")] if level else []
    )
    lost = ", ".join(links.split(", ")[2:])
    said = f"no state of b on /robot1/joint_states, so no transform leads to {lost}"
    assert all(said in it.message for it in found)


@pytest.mark.parametrize(
    ("links", "more", "level"),
    [
        ("base, arm, hand", "", "warning"),
        ("base, arm, hand", "/robot1/move_group subscribes", "error"),
        ("base, arm", "", ""),
        ("base, arm, hand", "/robot1/jsp publishes", ""),
    ],
)
def test_joints_of_which_nobody_sends_a_state(links: str, more: str, level: str) -> None:
    joints = "/robot1/joint_states sensor_msgs/msg/JointState"
    lines = [it.format("robot1") for it in ROBOT if "jsb" not in it]
    lines.append(f"description on /robot1/robot_description: links {links}; joints a, b")
    lines += [f"/robot1/rsp subscribes {joints}", *[f"{more} {joints}"] * bool(more)]
    found = judge(read_system("\n".join(f"running: {it}" for it in lines)))
    assert [(it.code, it.level) for it in found] == [("MG420", level)] * bool(level)


@pytest.mark.parametrize(
    ("heard", "wrong"), [(["head"], False), (["head", "a"], False), (["head", "neck"], True)]
)
def test_several_who_send_joints_have_them_together(heard: list[str], wrong: bool) -> None:
    """One that sends none of the description's is healthy where another does, or was not heard."""
    lines = [it.format("robot1") for it in ROBOT]
    lines += [
        "/robot1/more publishes /robot1/joint_states sensor_msgs/msg/JointState",
        "description on /robot1/robot_description: links robot1/base, robot1/arm; joints a, b",
        *(f"joints {it} on /robot1/joint_states" for it in heard),
    ]
    found = judge(read_system("\n".join(f"running: {it}" for it in lines)))
    assert [it.code for it in found] == ["MG420"] * wrong
    assert all("/robot1/jsb, /robot1/more sends head, neck" in it.message for it in found)
