# SPDX-License-Identifier: Apache-2.0
"""The remap table: which rules a fleet's nodes need, where their names lead, and in what form."""

from __future__ import annotations

import ast
import json

import pytest
import yaml
from lxml import etree
from paths import FIXTURES

from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.checks.meeting import robots_meet
from multibot_rewrite.description.readback.reading import Reading, read
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.knowledge.records import Endpoint, NodeFacts
from multibot_rewrite.planning.records import Run, Table
from multibot_rewrite.planning.table import build_table, plugin_nodes
from multibot_rewrite.planning.table_formats import FORMS, as_data
from multibot_rewrite.system.records import (
    ACTION,
    CALLS,
    PUBLISHES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
)

ROBOTS = ("robot1", "robot2")
PUBLISHER = NodeFacts(
    "robot_state_publisher",
    "robot_state_publisher",
    (
        Endpoint(TOPIC, PUBLISHES, "/tf"),
        Endpoint(TOPIC, PUBLISHES, "/tf_static"),
        Endpoint(TOPIC, PUBLISHES, "robot_description"),
        Endpoint(TOPIC, SUBSCRIBES, "joint_states"),
        Endpoint(TOPIC, PUBLISHES, "/rosout"),
    ),
)
DRIVER = NodeFacts(
    "driver",
    "driver",
    (
        Endpoint(TOPIC, SUBSCRIBES, "/cmd_vel"),
        Endpoint(TOPIC, PUBLISHES, "image_raw", transport=True),
        Endpoint(SERVICE, SERVES, "reset"),
        Endpoint(SERVICE, SERVES, "~/get_parameters"),
        Endpoint(ACTION, CALLS, "navigate"),
        Endpoint(TOPIC, SUBSCRIBES, "/clock"),
    ),
)
COSTMAP = NodeFacts(
    "local_costmap/local_costmap",
    "nav2_costmap_2d",
    (Endpoint(TOPIC, SUBSCRIBES, "/map"), Endpoint(TOPIC, PUBLISHES, "costmap")),
)
BRIDGE = NodeFacts("bridge", "ros_gz_bridge", (Endpoint(TOPIC, PUBLISHES, "/scan"),), shared=True)
NODES = (PUBLISHER, DRIVER, COSTMAP, BRIDGE)


def table(layout: str, nodes: tuple[NodeFacts, ...] = NODES, **policy: str) -> Table:
    return build_table(ROBOTS, nodes, make_naming(layout, **policy), release=NEWEST_LTS)


def rules(found: Table, robot: str, node: str) -> dict[str, str]:
    return {
        source: target
        for one in found.runs
        if (one.robot, one.node) == (robot, node)
        for source, target in one.rules
    }


# ---------------------------------------------------------------- what is needed


# ---------------------------------------------------------------- what is wrong


def plugin(*given: tuple[str, str]) -> dict[str, list[Run]]:
    """Return a plugin with /scan in each robot's description, with these rules."""
    facts = NodeFacts("lidar", "lidar", (Endpoint(TOPIC, PUBLISHES, "/scan"),))
    return {
        robot: [
            Run(
                robot,
                "lidar",
                f"/{robot}",
                "lidar",
                tuple((a, b.replace("ROBOT", robot)) for a, b in given),
                facts,
            )
        ]
        for robot in ROBOTS
    }


@pytest.mark.parametrize(
    ("given", "codes"),
    [
        pytest.param([("/scan", "scan")], [], id="right"),
        pytest.param([], ["MG320"], id="no-rule"),
        pytest.param([("/scan", "/all/scan")], ["MG320"], id="joins-two-robots"),
        pytest.param([("/scna", "x"), ("/scan", "scan")], ["MR103"] * 2, id="matches-nothing"),
        pytest.param([("/scan", "scan"), ("/scan", "x")], ["MR104"] * 2, id="shadowed"),
    ],
)
def test_rules_that_do_harm_or_nothing(given: list[tuple[str, str]], codes: list[str]) -> None:
    naming = make_naming("L2")
    found = build_table(ROBOTS, (), naming, plugin(*given), release=NEWEST_LTS)
    every = (*found.problems, *robots_meet(found, (), naming))
    assert [problem.code for problem in every] == codes


# ---------------------------------------------------------------- from a description

ODOM, TF = "publish_odom", "publish_odom_tf or publish_wheel_tf"


def reading(data: bytes) -> Reading:
    return read(data, "rover", builtin_tree((), NEWEST_LTS).definitions)


# ---------------------------------------------------------------- the forms


def test_launch_form_is_plain_python() -> None:
    text = FORMS["launch"](table("L1")).partition("NODES = ")[2]
    nodes = ast.literal_eval(text)
    assert nodes["robot2"]["robot_state_publisher"] == {
        "namespace": "/robot2",
        "name": "robot_state_publisher",
        "remappings": [("/tf", "tf"), ("/tf_static", "tf_static")],
    }


def test_yaml_and_json_are_the_same_data() -> None:
    found = table("L4")
    assert json.loads(FORMS["json"](found)) == json.loads(json.dumps(as_data(found)))
    assert yaml.safe_load(FORMS["yaml"](found)) == json.loads(FORMS["json"](found))


def test_gazebo_form_is_xml_a_plugin_takes() -> None:
    blocks = etree.fromstring(f"<all>{FORMS['gazebo'](table('L1'))}</all>")
    block = blocks.find("ros")
    assert block is not None
    assert (block.findtext("namespace"), block.findtext("remapping")) == ("/robot1", "/tf:=tf")


@pytest.mark.parametrize(
    ("parameters", "off", "sends"),
    [
        pytest.param("", {"odom": ODOM, "/tf": TF}, False, id="nothing is said"),
        pytest.param("<publish_odom_tf>true</publish_odom_tf>", {"odom": ODOM}, True, id="tf"),
        pytest.param("<publish_odom>1</publish_odom>", {"/tf": TF}, False, id="odometry"),
        pytest.param(
            "<publish_odom>false</publish_odom><publish_wheel_tf>true</publish_wheel_tf>",
            {"odom": ODOM},
            False,
            id="only the wheels' tf",
        ),
    ],
)
def test_a_plugin_without_what_its_parameters_switch_off(
    parameters: str, off: dict[str, str], sends: bool
) -> None:
    text = (
        (FIXTURES / "robots" / "rover.urdf")
        .read_text()
        .replace("<publish_odom>true</publish_odom>", "")
    )
    text = text.replace("<publish_odom_tf>true</publish_odom_tf>", parameters)
    found = plugin_nodes(reading(text.encode()), "r")
    drive = next(it.fact for it in found if it.name == "diff_drive")
    conditions = {it.name: it.when for it in drive.endpoints if it.when}
    assert conditions == off
    assert bool(drive.sends) == sends
