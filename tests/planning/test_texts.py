# SPDX-License-Identifier: Apache-2.0
"""What a small table and a small plan look like, to the letter, in every form."""

from __future__ import annotations

import json

from paths import fixture_text

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.knowledge.records import Endpoint, NodeFacts
from multibot_rewrite.planning.enclaves import Profile, enclave_of, profiles, to_policy
from multibot_rewrite.planning.records import Run, Table
from multibot_rewrite.planning.table_formats import FORMS, given_to
from multibot_rewrite.planning.ways import deliveries
from multibot_rewrite.system.records import (
    ACTION,
    CALLS,
    PUBLISHES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    End,
    Node,
    Robot,
    System,
)


def node(name: str, *rules: str, robot: str = "a", **home: str) -> Run:
    own = tuple((old, new) for old, _, new in (rule.partition(":=") for rule in rules))
    space = f"/{robot}" if robot else "/"
    fact = NodeFacts(name, "acme", (), **home)  # type: ignore[arg-type]
    return Run(robot, name, space, name, own, fact, written="plugin" in home)


TABLE = Table(
    "tf-per-robot",
    (
        node("map_server", robot=""),
        node("driver", "/tf:=tf", "/<x>:=x")._replace(
            names=((Endpoint(TOPIC, PUBLISHES, "/tf"), "/a/tf"),)
        ),
        node("helper", "/scan:=scan", host="driver"),
        node("box"),
        node("server", "/map:=map", container="box"),
        node("arm", "/joints:=joints", host="controller_manager"),
        node("gz", "/odom:=odom", plugin="gz_ros2_control-system"),
    ),
    (Finding("MR101", "warning", "no rule", "set it", robot="a", node="driver"),),
    "jazzy",
)


def test_the_arguments_of_what_is_started() -> None:
    assert FORMS["ros-args"](TABLE) == (
        "# ROS 2 jazzy\n"
        "# all robots: map_server\n"
        "(no rule)\n"
        "# a: driver\n"
        "--ros-args -r __ns:=/a -r helper:/scan:=scan -r /tf:=tf -r '/<x>:=x'\n"
        "# a: box\n"
        "--ros-args -r __ns:=/a\n"
        "# a: server (component)\n"
        "-n server --node-namespace /a -r /map:=map\n"
        "# a: arm (spawner)\n"
        "arm --controller-ros-args '-r /joints:=joints' --ros-args -r __ns:=/a\n"
    )


def test_the_data_of_a_table() -> None:
    data = json.loads(FORMS["json"](TABLE))
    assert list(data) == ["layout", "distro", "robots", "names", "problems"]
    assert (data["layout"], data["distro"]) == ("tf-per-robot", "jazzy")
    assert {
        robot: {name: (it["way"], it["at"], it["remappings"]) for name, it in nodes.items()}
        for robot, nodes in data["robots"].items()
    } == {
        "all robots": {"map_server": ("process", "map_server", [])},
        "a": {
            "driver": (
                "process",
                "driver",
                [["helper:/scan", "scan"], ["/tf", "tf"], ["/<x>", "x"]],
            ),
            "helper": ("host", "driver", [["helper:/scan", "scan"]]),
            "box": ("process", "box", []),
            "server": ("component", "server", [["/map", "map"]]),
            "arm": ("spawner", "arm", [["/joints", "joints"]]),
            "gz": ("plugin", "gz", [["/odom", "odom"]]),
        },
    }
    assert data["robots"]["a"]["box"] == {
        "namespace": "/a",
        "name": "box",
        "way": "process",
        "at": "box",
        "remappings": [],
    }
    assert data["names"] == [
        {
            "robot": "a",
            "node": "/a/driver",
            "kind": "topic",
            "role": "publishes",
            "asked": "/tf",
            "name": "/a/tf",
        }
    ]
    assert data["problems"] == [
        {
            "code": "MR101",
            "level": "warning",
            "robot": "a",
            "node": "driver",
            "message": "no rule",
            "hint": "set it",
        }
    ]


def test_where_rules_stand_in_words_for_people() -> None:
    assert {it.node.node: given_to(it) for it in deliveries(TABLE)} == {
        "map_server": "its process",
        "driver": "its process",
        "helper": "process of driver",
        "box": "its process",
        "server": "component",
        "arm": "its spawner",
        "gz": "its plugin",
    }


def end(node: str, kind: str, role: str, name: str) -> End:
    return End(kind, role, name, "", "", node, None, "")


PLAN = System(
    nodes=(Node("/a/nav/driver", robot="a"), Node("/map_server")),
    ends=(
        end("/a/nav/driver", TOPIC, PUBLISHES, "/a/<x>"),
        end("/a/nav/driver", TOPIC, SUBSCRIBES, "/a/cmd_vel"),
        end("/a/nav/driver", SERVICE, SERVES, "/a/reset"),
        end("/a/nav/driver", SERVICE, CALLS, "/map"),
        end("/a/nav/driver", ACTION, SERVES, "/a/go"),
        end("/map_server", ACTION, CALLS, "/a/go"),
    ),
    robots=(Robot("a", tf_topic="/a/tf"),),
)
PROFILE = fixture_text("texts_profile.txt")


def test_a_policy_of_sros2_to_the_letter() -> None:
    """sros2 policy.xsd; what every node needs is in its test/policies/common/node.xml."""
    text = to_policy(PLAN)
    assert text.startswith('<?xml version="1.0" encoding="UTF-8"?>\n<!-- Who may do what')
    assert PROFILE in text
    assert (
        '<policy version="0.2.0">\n  <enclaves>\n    <enclave path="/a">\n      <profiles>\n'
        in text
    )
    listener = (
        '        <profile ns="/a" node="*">\n          <topics subscribe="ALLOW">\n'
        "            <topic>/a/tf</topic>\n            <topic>/a/tf_static</topic>\n"
        "          </topics>\n        </profile>\n      </profiles>\n    </enclave>\n"
    )
    assert listener in text
    assert '    <enclave path="/shared">\n' in text
    assert '        <profile ns="/" node="map_server">\n' in text
    assert '<actions call="ALLOW">\n            <action>/a/go</action>\n' in text
    assert text.endswith("    </enclave>\n  </enclaves>\n</policy>\n")


def test_a_tool_may_read_all_and_sends_what_no_planned_node_does() -> None:
    more = (end("/a/nav/driver", TOPIC, SUBSCRIBES, "/a/goal"),)
    found = profiles(PLAN, more)
    assert list(found) == [enclave_of("a"), "/shared", "/tools"]
    assert found["/tools"][0] == Profile(
        "/tools",
        (
            (TOPIC, SUBSCRIBES, "/*"),
            (SERVICE, CALLS, "/*"),
            (ACTION, CALLS, "/*"),
            (TOPIC, PUBLISHES, "/a/cmd_vel"),
            (TOPIC, PUBLISHES, "/a/goal"),
        ),
    )
    assert (TOPIC, SUBSCRIBES, "/a/goal") in found["/a"][0].allowed
    assert "/shared" not in profiles(PLAN._replace(nodes=PLAN.nodes[:1]))
