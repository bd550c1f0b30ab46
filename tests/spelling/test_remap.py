# SPDX-License-Identifier: Apache-2.0
"""The remap table: which rules a fleet's nodes need, where their names lead, and in what form."""

from __future__ import annotations

import ast
import json
import re
import shlex

import pytest
import yaml
from lxml import etree
from paths import FIXTURES

from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.description.library import rewrite_all
from multibot_rewrite.description.readback.reading import Reading, read
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.fleet.checks.meeting import robots_meet
from multibot_rewrite.knowledge.records import Endpoint, NodeFacts
from multibot_rewrite.spelling.records import Run, Table
from multibot_rewrite.spelling.table import build_table, plugin_nodes
from multibot_rewrite.spelling.table_formats import FORMS, as_data
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
LAYOUTS = ("L1", "L2", "L3", "L4")
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
STUBBORN = NodeFacts(
    "stubborn",
    "stubborn",
    (
        Endpoint(
            TOPIC, PUBLISHES, "/fixed", parameter="topic", fixed="the name is made at run time"
        ),
    ),
)
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


def leads(found: Table, robot: str, node: str) -> dict[str, str]:
    """Asked name -> fully qualified name."""
    runs = (it for it in found.runs if it.robot == robot and it.full_name.endswith(node))
    return {end.name: name for run in runs for end, name in run.names}


# ---------------------------------------------------------------- what is needed


@pytest.mark.parametrize(
    ("layout", "wanted"),
    [
        pytest.param("L1", {"/tf": "tf", "/tf_static": "tf_static"}, id="tf-per-robot"),
        pytest.param("L2", {}, id="frames-per-robot"),
        pytest.param("L3", {"/tf": "tf", "/tf_static": "tf_static"}, id="both"),
        pytest.param(
            "L4",
            {
                "/tf": "/tf/robot1",
                "/tf_static": "/tf_static/robot1",
                "robot_description": "robot_description/robot1",
                "joint_states": "joint_states/robot1",
            },
            id="postfix",
        ),
    ],
)
def test_rules_of_a_state_publisher(layout: str, wanted: dict[str, str]) -> None:
    assert rules(table(layout), "robot1", "robot_state_publisher") == wanted


def test_an_absolute_name_becomes_relative_below_a_namespace() -> None:
    found = table("L2")
    assert rules(found, "robot2", "driver") == {"/cmd_vel": "cmd_vel"}
    assert leads(found, "robot2", "driver") == {
        "/cmd_vel": "/robot2/cmd_vel",
        "image_raw": "/robot2/image_raw",
        "reset": "/robot2/reset",
        "~/get_parameters": "/robot2/driver/get_parameters",
        "navigate": "/robot2/navigate",
        "/clock": "/clock",
    }


def test_without_a_namespace_every_name_has_a_rule_and_actions_have_six() -> None:
    found = rules(table("L4"), "robot1", "driver")
    assert found["/cmd_vel"] == "/cmd_vel/robot1"
    assert found["reset"] == "reset/robot1"
    assert found["navigate"] == "navigate/robot1"
    parts = ("send_goal", "cancel_goal", "get_result", "feedback", "status")
    assert {f"navigate/_action/{part}" for part in parts} <= set(found)
    assert {f"image_raw/{kind}" for kind in ("compressed", "theora")} <= set(found)
    assert "/clock" not in found
    assert "~/get_parameters" not in found


def test_a_node_without_a_namespace_gets_a_name_of_its_own() -> None:
    (node,) = (n for n in table("L4").runs if (n.robot, n.node) == ("robot2", "driver"))
    assert (node.namespace, node.name) == ("/", "driver_robot2")
    assert leads(table("L4"), "robot2", "driver_robot2")["~/get_parameters"] == (
        "/driver_robot2/get_parameters"
    )


def test_below_a_namespace_of_its_own_a_target_is_absolute() -> None:
    found = table("L1")
    assert rules(found, "robot1", COSTMAP.name) == {"/map": "/robot1/map"}
    assert leads(found, "robot1", COSTMAP.name) == {
        "/map": "/robot1/map",
        "costmap": "/robot1/local_costmap/costmap",
    }


def test_a_shared_node_may_have_a_namespace() -> None:
    maps = NodeFacts("maps/server", "x", (Endpoint(TOPIC, PUBLISHES, "map"),), shared=True)
    found = build_table(ROBOTS, (maps,), make_naming("both"), release=NEWEST_LTS)
    (node,) = found.runs
    assert (node.namespace, node.name) == ("/maps", "server")
    assert [name for _, _, name in found.ends] == ["/maps/map"]


def test_a_shared_node_runs_once_as_it_is() -> None:
    (node,) = (n for n in table("L2").runs if n.node == "bridge")
    assert node[:5] == ("", "bridge", "/", "bridge", ())


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("affix", ["prefix", "postfix"])
def test_robots_meet_in_shared_names_only(layout: str, affix: str) -> None:
    found = table(layout, affix=affix)
    assert not [*robots_meet(found, (), make_naming(layout))]
    ours, theirs = ({name for run, _, name in found.ends if run.robot == robot} for robot in ROBOTS)
    shared = {"/clock", "/rosout"} | ({"/tf", "/tf_static"} if layout == "L2" else set())
    assert ours & theirs == shared


# ---------------------------------------------------------------- what is wrong


def test_what_no_rule_reaches_is_said_and_gets_no_rule() -> None:
    found = table("L2", (STUBBORN,))
    assert rules(found, "robot1", "stubborn") == {}
    assert [(p.code, p.node, p.hint) for p in found.problems] == [
        ("MR101", "stubborn", "set its parameter topic")
    ]


def test_what_the_stack_renames_itself_is_led_where_the_stack_wants_it() -> None:
    endpoint = Endpoint(TOPIC, PUBLISHES, "cmd_vel", remapped="cmd_vel_nav")
    nodes = (NodeFacts("controller_server", "nav2_controller", (endpoint,)),)
    wanted = {"L2": "/robot1/cmd_vel_nav", "L4": "/cmd_vel_nav/robot1"}
    for layout, name in wanted.items():
        found = leads(table(layout, nodes), "robot1", "")
        assert found == {"cmd_vel": name}


def test_a_private_service_of_another_node_follows_that_node() -> None:
    manager = NodeFacts("manager", "manager", (Endpoint(SERVICE, CALLS, "driver/get_parameters"),))
    found = table("L4", (DRIVER, manager))
    assert leads(found, "robot1", "manager_robot1") == {
        "driver/get_parameters": "/driver_robot1/get_parameters"
    }
    served = leads(found, "robot1", "driver_robot1")["~/get_parameters"]
    assert served == "/driver_robot1/get_parameters"


def test_a_topic_and_a_service_of_one_name_share_a_rule() -> None:
    ends = (Endpoint(TOPIC, SUBSCRIBES, "set_pose"), Endpoint(SERVICE, SERVES, "/set_pose"))
    found = table("L4", (NodeFacts("ekf", "robot_localization", ends),))
    assert rules(found, "robot1", "ekf") == {"set_pose": "set_pose/robot1"}
    assert found.problems == ()


def plugin(*given: tuple[str, str]) -> dict[str, list[Run]]:
    """A plugin with /scan in each robot's description, with these rules."""
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


def test_one_robot_alone_has_no_other_in_its_table() -> None:
    found = build_table(["robot1"], (DRIVER,), make_naming("L2"), release=NEWEST_LTS)
    assert {run.robot for run in found.runs} == {"robot1"}


# ---------------------------------------------------------------- from a description

ODOM, TF = "publish_odom", "publish_odom_tf or publish_wheel_tf"


def reading(data: bytes) -> Reading:
    return read(data, "rover", builtin_tree((), NEWEST_LTS).vocabulary)


def test_plugins_of_a_rewritten_description_keep_robots_apart() -> None:
    source = (FIXTURES / "robots" / "rover.urdf").read_bytes()
    for layout in LAYOUTS:
        plugins = {}
        for one in rewrite_all(source, ROBOTS, layout=layout):
            plugins[one.robot] = list(plugin_nodes(reading(one.data), one.robot))
        found = build_table(ROBOTS, (), make_naming(layout), plugins, release=NEWEST_LTS)
        assert not [*found.problems, *robots_meet(found, (), make_naming(layout))], layout
        drive = [
            name for run, end, name in found.ends if (run.robot, end.name) == ("robot1", "cmd_vel")
        ]
        assert drive == ["/cmd_vel/robot1" if layout == "L4" else "/robot1/cmd_vel"], layout


# ---------------------------------------------------------------- the forms


def test_ros_args_are_what_rcl_reads() -> None:
    text = FORMS["ros-args"](table("L1"))
    (line,) = re.findall(r"^# robot1: robot_state_publisher\n(.*)$", text, re.MULTILINE)
    assert shlex.split(line) == [
        "--ros-args", "-r", "__ns:=/robot1", "-r", "/tf:=tf", "-r", "/tf_static:=tf_static",
    ]  # fmt: skip
    assert "__node:=driver_robot2" in FORMS["ros-args"](table("L4"))


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


def test_a_shared_node_keeps_its_namespace_and_name_to_the_letter() -> None:
    node = NodeFacts("/fleet/x_mux", "twist_mux", (), shared=True)
    (found, *_) = table("L1", (node,)).runs
    assert found[:5] == ("", "/fleet/x_mux", "/fleet", "x_mux", ())


def test_the_data_of_a_table_names_its_layout_and_each_robot() -> None:
    found = as_data(table("L4"))
    assert found["layout"] == "postfix"
    assert set(found["robots"]) >= {"robot1", "robot2"}  # type: ignore[call-overload]


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
