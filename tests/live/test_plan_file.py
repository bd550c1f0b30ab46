# SPDX-License-Identifier: Apache-2.0
"""What a plan can say besides names, as people write it: shared nodes, senders, QoS, alternatives."""

from __future__ import annotations

import pytest
from graph_calls import check, read_plan
from graph_cases import environment, qos

from multibot_rewrite.base.findings.finding import ERROR
from multibot_rewrite.base.model import InputError
from multibot_rewrite.system.records import End, Node, System

PLAN = """\
schema: 3
layout: both
shared_topics: [/map]
shared_frames: [map]
nodes:
- name: /map_server
  ends:
  - [publishes, topic, /map, nav_msgs/msg/OccupancyGrid, map]
- name: /fleet_manager
  ends:
  - [calls, service, /robot1/dock, std_srvs/srv/Trigger, /robot1/dock]
- name: /rviz2
robots:
- name: robot1
  tf_topic: /robot1/tf
  nodes:
  - name: /robot1/driver
    ends:
    - [subscribes, topic, /robot1/cmd_vel, geometry_msgs/msg/Twist, cmd_vel]
    - [serves, service, /robot1/dock, std_srvs/srv/Trigger, dock]
  - name: /robot1/amcl
    sure: {word: runs, instead: [/robot1/amcl, /robot1/slam_toolbox]}
  - name: /robot1/slam_toolbox
    sure: {word: runs, instead: [/robot1/amcl, /robot1/slam_toolbox]}
topics:
- {name: /robot1/cmd_vel, senders: [/robot1/mux, "/robot1/teleop_*"], one_sender: true}
- {name: /map, qos: {durability: transient_local, reliability: reliable}}
"""


def plan(text: str = PLAN) -> bytes:
    return text.encode()


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b"layout: a\n x: 1\n", "p.yaml:2:3: not valid YAML: "),
        (b"layout: \x07\n", "p.yaml: not valid YAML: unacceptable character #x0007: "),
        (b"layout: \xff\n", "p.yaml: not valid YAML: it is not UTF-8; "),
        (b'{"layout": 1,\n "a"}', "p.yaml:2:5: not valid JSON: Expecting ':' delimiter; "),
        (b'{"layout": "\xff"}', "p.yaml: not valid JSON: it is not UTF-8; "),
    ],
)
def test_what_cannot_be_read_is_told_where(data: bytes, said: str) -> None:
    with pytest.raises(InputError) as refused:
        read_plan(data, "p.yaml")
    assert str(refused.value).startswith(said)
    assert "\n" not in str(refused.value)


def graph(*ends: tuple[str, str, str, str], more: tuple[str, ...] = ()) -> System:
    """Endpoints as (node, role, name, type); ``more`` are nodes without one."""
    found = tuple(
        End(
            "service" if "/srv/" in type_ else "topic",
            role,
            name,
            type_,
            "",
            node,
            qos(reliability="RELIABLE", durability="TRANSIENT_LOCAL"),
            "",
        )
        for node, role, name, type_ in ends
    )
    names = dict.fromkeys((*(it.node for it in found), *more))
    return System(tuple(Node(it, "") for it in names), found, (), environment())


MAP = ("/map_server", "publishes", "/map", "nav_msgs/msg/OccupancyGrid")
DOCK = ("/fleet_manager", "calls", "/robot1/dock", "std_srvs/srv/Trigger")
DRIVER = (
    ("/robot1/driver", "subscribes", "/robot1/cmd_vel", "geometry_msgs/msg/Twist"),
    ("/robot1/driver", "serves", "/robot1/dock", "std_srvs/srv/Trigger"),
)
MUX = ("/robot1/mux", "publishes", "/robot1/cmd_vel", "geometry_msgs/msg/Twist")
RUNNING = (MAP, DOCK, *DRIVER)
NODES = ("/rviz2", "/robot1/amcl")


def codes(found: System) -> list[tuple[str, str]]:
    return [(it.code, it.node) for it in check(read_plan(plan(), "plan.yaml"), found)]


def test_a_shared_node_without_its_topic() -> None:
    wrong = ("/map_server", "publishes", "/robot1/map", "nav_msgs/msg/OccupancyGrid")
    assert ("MG102", "/map_server") in codes(graph(wrong, DOCK, *DRIVER, more=NODES))


def test_who_may_send() -> None:
    """Patterns count; a tool may not send where it is not named."""
    teleop = ("/robot1/teleop_keyboard", "publishes", "/robot1/cmd_vel", "geometry_msgs/msg/Twist")
    pub = ("/_ros2cli_77", "publishes", "/robot1/cmd_vel", "geometry_msgs/msg/Twist")
    assert codes(graph(*RUNNING, teleop, more=NODES)) == []
    assert codes(graph(*RUNNING, pub, more=NODES)) == [("MG121", "/_ros2cli_77")]
    both = codes(graph(*RUNNING, MUX, teleop, more=NODES))
    assert ("MG121", "/robot1/mux") in both
    # Of a sender that may send and one that may not, the second is too many.
    stray = ("/robot1/stray", "publishes", "/robot1/cmd_vel", "geometry_msgs/msg/Twist")
    found = check(read_plan(plan(), "p"), graph(*RUNNING, MUX, stray, more=NODES))
    (several,) = (it for it in found if it.node == "/robot1/stray")
    # The plan makes an error of what is a warning without one.
    assert (several.code, several.level) == ("MG312", ERROR)
    assert "topics: /robot1/cmd_vel: senders" in several.hint


@pytest.mark.parametrize(
    ("running", "code"),
    [
        ((), "MG101"),
        (("/robot1/amcl",), ""),
        (("/robot1/slam_toolbox",), ""),
        (("/robot1/amcl", "/robot1/slam_toolbox"), "MG125"),
    ],
)
def test_one_of_several_nodes(running: tuple[str, ...], code: str) -> None:
    found = check(read_plan(plan(), "p"), graph(*RUNNING, more=("/rviz2", *running)))
    assert [(it.code, it.robot) for it in found] == ([(code, "robot1")] if code else [])


@pytest.mark.parametrize(("node", "is_missed"), [("rviz2", False), ("camera", True)])
def test_an_optional_node_that_runs_outside_its_robot(node: str, is_missed: bool) -> None:
    """A window for all robots is not that of one of them without its namespace."""
    more = f"  - {{name: /robot1/{node}, sure: may}}\ntopics:"
    text = PLAN.replace("- name: /rviz2\n", "").replace("\ntopics:", f"\n{more}")
    found = check(read_plan(plan(text), "p"), graph(*RUNNING, more=(f"/{node}", "/robot1/amcl")))
    assert ["MG101"] * is_missed == [it.code for it in found]


def test_a_map_that_is_not_latched() -> None:
    found = graph(*RUNNING, more=NODES)
    ends = tuple(
        it._replace(qos=qos(reliability="RELIABLE", durability="VOLATILE"))
        if it.name == "/map"
        else it
        for it in found.ends
    )
    assert codes(found._replace(ends=ends)) == [("MG309", "/map_server")]


PATTERN = PLAN.replace(
    "  - name: /robot1/amcl\n",
    "  - name: /robot1/amcl\n    ends:\n"
    "    - [publishes, topic, /robot1/camera_*/image_raw, sensor_msgs/msg/Image, image_raw]\n",
).replace("- name: /rviz2", "- name: /rviz_*")
IMAGE = "sensor_msgs/msg/Image"


@pytest.mark.parametrize(
    ("topics", "found"),
    [
        (("/robot1/camera_left/image_raw",), []),
        (("/robot1/camera_left/image_raw", "/robot1/camera_right/image_raw"), []),
        ((), ["MG102"]),
        (("/robot1/camera_left/depth/image_raw",), ["MG102"]),
        (("/camera_left/image_raw",), ["MG320"]),
    ],
)
def test_names_that_are_made_at_run_time(topics: tuple[str, ...], found: list[str]) -> None:
    """A star stands for a part of one segment, in topics as in nodes; what fits is planned."""
    images = [("/robot1/amcl", "publishes", name, IMAGE) for name in topics]
    seen = graph(*RUNNING, *images, more=("/rviz_47", "/robot1/amcl"))
    findings = check(read_plan(plan(PATTERN), "plan.yaml"), seen)
    assert [it.code for it in findings] == found


def test_a_pattern_is_compared_by_its_type() -> None:
    wrong = ("/robot1/amcl", "publishes", "/robot1/camera_left/image_raw", "std_msgs/msg/String")
    seen = graph(*RUNNING, wrong, more=("/rviz_47",))
    (finding,) = check(read_plan(plan(PATTERN), "plan.yaml"), seen)
    assert (finding.code, finding.names) == ("MG306", ("/robot1/camera_left/image_raw",))


BRIDGED = PLAN.replace(
    "topics:\n",
    "topics:\n"
    "- {name: /robot1/scan, bridge: [publishes], type: sensor_msgs/msg/LaserScan}\n"
    "- {name: /robot1/imu, bridge: [publishes], type: sensor_msgs/msg/Imu}\n",
)


@pytest.mark.parametrize(
    ("type_", "found"),
    [("sensor_msgs/msg/LaserScan", []), ("sensor_msgs/msg/PointCloud2", ["MG126"])],
)
def test_a_bridge_that_carries_another_type(type_: str, found: list[str]) -> None:
    """Who reads the scan gets nothing, though a topic of that name is there."""
    rows = (("/robot1/scan", type_), ("/robot1/imu", "sensor_msgs/msg/Imu"))
    ends = (("/ros_gz_bridge", "publishes", name, one) for name, one in rows)
    seen = graph(*RUNNING, *ends, more=NODES)
    findings = check(read_plan(plan(BRIDGED), "plan.yaml"), seen)
    assert [it.code for it in findings] == found
