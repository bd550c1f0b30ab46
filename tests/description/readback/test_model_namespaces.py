# SPDX-License-Identifier: Apache-2.0
"""What Gazebo makes of the namespaces of models, and that two robots of such a model do not meet.

Expected names are those of gz-sim's scopedNamespace (its Util_TEST.cc) and DiffDrive.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import pytest
from description_calls import BELOW, LAYOUTS, TOPIC, load_definitions, make_naming, meetings, read

from multibot_rewrite import rewrite, rewrite_all

DRIVE = '<plugin filename="gz-sim-diff-drive-system" name="d"><topic>{}</topic></plugin>'
RELEASED = ("humble", "jazzy", "kilted", "lyrical")
MAIN = "rolling"


def model(attributes: str, inside: str = DRIVE.format("cmd_vel")) -> str:
    link = '<link name="base"/>'
    return f'<sdf version="1.12"><model name="rover"{attributes}>{link}{inside}</model></sdf>'


def topics(text: bytes, release: str, path: str = "topic") -> list[str]:
    found = read(text, "m.sdf", load_definitions((), release)).names
    return [it.name for it in found if it.kind in (TOPIC, BELOW) and it.path == path]


def arm(namespace: str) -> str:
    inner = f'<link name="hand"/>{DRIVE.format("turn")}'
    return f'<model name="arm" namespace="{namespace}">{inner}</model>'


def included(namespace: str) -> str:
    """Return a model that is included, with a plugin for it."""
    return f"<include><uri>x</uri><name>hand</name>{namespace}{DRIVE.format('turn')}</include>"


@pytest.mark.parametrize(
    ("attributes", "inside", "name"),
    [
        ("", DRIVE.format("cmd_vel"), "/cmd_vel"),
        (' namespace="robot"', DRIVE.format("cmd_vel"), "/robot/cmd_vel"),
        (' namespace=" robot/"', DRIVE.format("cmd_vel"), "/robot/cmd_vel"),
        (' namespace="//robot//"', DRIVE.format("cmd_vel"), "/robot/cmd_vel"),
        (' namespace="robot"', DRIVE.format("/cmd_vel"), "/cmd_vel"),
        (' namespace=""', DRIVE.format("cmd_vel"), "/cmd_vel"),
        (' namespace="/"', DRIVE.format("cmd_vel"), "/cmd_vel"),
        (' namespace="robot"', arm("left"), "/robot/left/turn"),
        (' namespace="robot"', arm("/left"), "/left/turn"),
        (' namespace="robot"', arm("/"), "/turn"),
        (' namespace="robot"', arm(""), "/robot/turn"),
        (' namespace="robot"', arm("{name}_{name}"), "/robot/arm_arm/turn"),
        ("", arm("left"), "/left/turn"),
        (' namespace="robot"', included("<namespace> {name}/x </namespace>"), "/robot/hand/x/turn"),
        (' namespace="robot"', included(""), "/robot/turn"),
    ],
)
def test_the_namespaces_around_a_plugin_are_joined(attributes: str, inside: str, name: str) -> None:
    assert topics(model(attributes, inside).encode(), MAIN) == [name]


@pytest.mark.parametrize("release", RELEASED)
def test_gazebo_of_a_release_knows_no_namespace(release: str) -> None:
    assert topics(model(' namespace="robot"').encode(), release) == ["/cmd_vel"]


def written(source: str, layout: str, release: str) -> Iterator[tuple[str, bytes]]:
    for it in rewrite_all(source, ["robot1", "robot2"], layout=layout, distro=release):
        yield it.robot, it.data


SOURCES = [
    model(' namespace="robot"'),
    model(' namespace="/robot"'),
    model(' namespace="{name}"'),
    model(' namespace="robot"', arm("left")),
    model(' namespace="robot"', arm("/left")),
    model("", arm("left")),
    model(' namespace="robot"', DRIVE.format("/cmd_vel")),
]


@pytest.mark.sample(2)
@pytest.mark.parametrize("layout", [it.name for it in LAYOUTS])
@pytest.mark.parametrize("release", [*RELEASED, MAIN])
@pytest.mark.parametrize("source", SOURCES)
def test_two_robots_do_not_meet(source: str, release: str, layout: str) -> None:
    definitions = load_definitions((), release)
    texts = dict(written(source, layout, release))
    readings = {robot: read(text, robot, definitions) for robot, text in texts.items()}
    named = {robot: it.names for robot, it in readings.items()}
    assert [it.name.name for it in meetings(named, make_naming(layout))] == []
    assert all(len(readings[a].names) == len(readings[b].names) for a, b in combinations(texts, 2))
    named_twice = [
        (robot, name)
        for robot, text in texts.items()
        for name in topics(text, release)
        if name.split("/").count(robot) != 1
    ]
    assert named_twice == []


def test_what_cannot_be_each_robots_own_is_said() -> None:
    """The root as a namespace, and a nested model that keeps its name: their topics are for all."""
    for source in (model(' namespace="/"', DRIVE.format("")), model("", arm("{name}"))):
        found = rewrite(source, "robot1", layout="tf-per-robot", distro=MAIN)
        assert "MG320" in {it.code for it in found.findings}
        assert any("topic" in reason for reason in found.not_verified)


def test_below_a_root_namespace_a_topic_is_each_robots_own() -> None:
    (name,) = topics(
        rewrite(model(' namespace="robot"', arm("/")), "robot1", distro=MAIN).data, MAIN
    )
    assert name == "/turn/robot1"
