# SPDX-License-Identifier: Apache-2.0
"""What is said of the words, programs and starts of a launch, and what is right and stays unsaid.

Sources: tf2_ros jazzy static_transform_broadcaster_program.cpp, nav2_lifecycle_manager, ros2_control
spawner.py.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml
from graph_examples import read_example
from launched_nodes import AT, started
from lxml import etree

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.description.sources.world_systems import needed_systems
from multibot_rewrite.knowledge.node_sets import built_in
from multibot_rewrite.knowledge.parameters import load_known_nodes
from multibot_rewrite.lint.launched import named_findings
from multibot_rewrite.producers.launch.launched import Launched
from multibot_rewrite.producers.launch.records import (
    LaunchedNode,
    LaunchGraph,
    LaunchNote,
    ParameterText,
)
from multibot_rewrite.producers.launch.running import Knowledge
from multibot_rewrite.producers.launch.snapshot import launched
from multibot_rewrite.rules.launch.judge import as_one_of_several, as_sure, judge_launch
from multibot_rewrite.rules.system.planned_nodes import missing_node, unplanned_node
from multibot_rewrite.rules.system.states import (
    interface_claimed_twice,
    interface_not_exported,
)
from multibot_rewrite.system.guess import guess_robots, whose_by_guess
from multibot_rewrite.system.index import index
from multibot_rewrite.system.ownership import whose_by_plan
from multibot_rewrite.system.records import Node, Place, Robot, System

START = (
    "start ros2_control_node there, load gz_ros2_control in the description, or name the launch file "
    "that starts it in addition to this one"
)
TF = ("tf2_ros", "static_transform_publisher", "s")
STATE = ("robot_state_publisher", "robot_state_publisher", "rsp")
MANAGER = ("controller_manager", "ros2_control_node", "controller_manager")
SPAWNER = ("controller_manager", "spawner", "spawner")
LIFECYCLE = ("nav2_lifecycle_manager", "lifecycle_manager", "manager")
AMCL = ("nav2_amcl", "amcl", "amcl")
UNKNOWN = started("acme", "driver", "driver")
FRAMES = ("--frame-id", "map", "--child-frame-id", "odom")
UPRIGHT = ("--qx", "0", "--qy", "0", "--qz", "0", "--qw")


@pytest.fixture(scope="module")
def known() -> Knowledge:
    return Knowledge(built_in("jazzy").nodes, load_known_nodes("", "jazzy"), "jazzy")


def with_values(values: dict[str, object]) -> tuple[ParameterText, ...]:
    return (ParameterText("", yaml.safe_dump({"/**": {"ros__parameters": values}})),)


def judged(known: Knowledge, code: str, *nodes: LaunchedNode, notes: object = ()) -> list[Finding]:
    graph = LaunchGraph(nodes, tuple(notes))  # type: ignore[arg-type]
    return [it for it in judge_launch(launched(graph, known)) if it.code == code]


def said(found: list[Finding]) -> list[str]:
    return [f"{it.message}; {it.hint}" for it in found]


@pytest.mark.parametrize(
    ("words", "texts"),
    [
        (("--yaw", "1.57", *FRAMES), []),
        (("--yaw", "6.29", *FRAMES), []),
        (
            ("--yaw", "-90", *FRAMES),
            ["/s: --yaw -90 is more than a turn in radians; degrees? write -1.571"],
        ),
        (("--x", "90", *FRAMES), []),
        (
            ("--frame-id", "odom", "--child-frame-id", "odom"),
            ["/s: sends a transform from odom to itself; name two different frames"],
        ),
        ((*UPRIGHT, "1", *FRAMES), []),
        ((*UPRIGHT, "0.95", *FRAMES), []),
        (
            (*UPRIGHT, "0", *FRAMES),
            ["/s: the quaternion 0 0 0 0 is no rotation; without a rotation write 0 0 0 1"],
        ),
        (("--qx", "0", "--qy", "0", *FRAMES), []),
        # In order: x, y, z, yaw, pitch, roll and the frames, or a quaternion and the frames.
        ("0 0 0 1 0 0 map odom", []),
        ("0 0 0 0 0 0 1 map odom", []),
        (
            "0 0 0 0 45 0 map odom",
            ["/s: --pitch 45 is more than a turn in radians; degrees? write 0.7854"],
        ),
        (
            "0 0 0 0 0 0 0 map odom",
            ["/s: the quaternion 0 0 0 0 is no rotation; without a rotation write 0 0 0 1"],
        ),
        (
            "map 0 0 0 0 0 0 odom",
            [
                "/s: map is in the place of --x; numbers come first, then the two frames;"
                " or use flags, as --frame-id"
            ],
        ),
        (("0", "map", "odom"), []),
    ],
)
def test_the_words_of_a_static_transform(
    words: tuple[str, ...] | str, texts: list[str], known: Knowledge
) -> None:
    given = tuple(words.split()) if isinstance(words, str) else words
    assert said(judged(known, "MG711", started(*TF, arguments=given))) == texts


@pytest.mark.parametrize(
    ("rule", "texts"),
    [
        ("joint_states", []),
        ("/joint_states", []),
        (
            "joint_stats",
            ["/rsp: the remap rule for joint_stats matches nothing; did you mean joint_states?"],
        ),
        ("wheel_positions", []),
        ("other:joint_stats", []),
        ("__node", []),
    ],
)
def test_a_remap_rule_for_a_name_that_is_nearly_there(
    rule: str, texts: list[str], known: Knowledge
) -> None:
    node = started(*STATE, remappings=((rule, "x"),))
    assert said(judged(known, "MR103", node)) == texts
    assert judged(known, "MR103", UNKNOWN._replace(remappings=((rule, "x"),))) == []


def test_a_rule_for_what_the_node_calls_so_already_is_no_slip(known: Knowledge) -> None:
    """A manager whose node_names have the robot's name needs no rule, and has one in a build."""
    manager = ("nav2_lifecycle_manager", "lifecycle_manager", "lifecycle_manager")
    values = with_values({"node_names": ["amcl_robot1"]})
    for target, count in (("amcl_robot1/change_state", 0), ("x", 1)):
        rules = (("amcl_robot/change_state", target),)
        node = started(*manager, parameters=values, remappings=rules)
        assert len(judged(known, "MR103", node)) == count


@pytest.mark.parametrize("rule", ["right/camera_info", "right/image_rect/zstd"])
def test_a_rule_for_what_parameters_switch_off_is_no_slip(rule: str, known: Knowledge) -> None:
    """rtabmap has it with subscribe_stereo."""
    names = ("rtabmap_slam", "rtabmap", "rtabmap")
    assert judged(known, "MR103", started(*names, remappings=((rule, "x"),))) == []


@pytest.mark.parametrize("rule", ["scan", "/scan", "~/change_state"])
def test_a_slash_before_a_name_or_a_rule_is_no_slip(rule: str, known: Knowledge) -> None:
    """slam_toolbox asks for /scan; launch files write both."""
    names = ("slam_toolbox", "async_slam_toolbox_node", "slam_toolbox")
    assert judged(known, "MR103", started(*names, remappings=((rule, "x"),))) == []


def test_files_that_are_not_there(known: Knowledge, tmp_path: Path) -> None:
    there, gone = tmp_path / "there.yaml", tmp_path / "gone.yaml"
    there.write_text("")
    elsewhere = tmp_path / "no" / "folder.yaml"
    for key in ("config_file", "yaml_filename"):
        for path, count in ((gone, 1), (there, 0), (elsewhere, 0), ("./gone.yaml", 0)):
            node = UNKNOWN._replace(parameters=with_values({key: str(path)}))
            assert len(judged(known, "MG713", node)) == count, (key, path)
            (*found,) = judged(known, "MG713", UNKNOWN._replace(arguments=("-d", str(path))))
            assert len(found) == count, path
    for flag, path, count in (("-file", gone, 1), ("-x", gone, 0), ("-d", "/tmp/gone.rviz", 0)):
        (*found,) = judged(known, "MG713", UNKNOWN._replace(arguments=(flag, str(path))))
        assert len(found) == count, (flag, path)
    twice = (*with_values({"config_file": str(gone)}),)
    (one,) = judged(known, "MG713", UNKNOWN._replace(parameters=twice, arguments=("-d", str(gone))))
    assert one.message == f"/driver is given {gone}, which is not there"
    notes = [
        LaunchNote(AT, "not there", True, str(gone)),
        LaunchNote(AT, "elsewhere", True, str(elsewhere)),
        LaunchNote(AT, "no file", True),
    ]
    found = judged(known, "MG713", UNKNOWN._replace(parameters=twice), notes=notes)
    assert [it.message for it in found] == ["not there"]


@pytest.mark.parametrize(
    ("package", "program", "text"),
    [
        ("nav2_amcl", "amcl", ""),
        (
            "nav2_amcl",
            "amcll",
            "package nav2_amcl has no program amcll; did you mean amcl?",
        ),
        # No slip: another package may have it.
        ("nav2_amcl", "map_server", ""),
        (
            "nav2_amlc",
            "amcl",
            "amcl is of the package nav2_amlc, which is not known; did you mean nav2_amcl?",
        ),
        ("nav2_amlc", "amclx", ""),
        # Another number is another package.
        ("nav3_amcl", "amcl", ""),
        ("acme_amcl", "amcl", ""),
        ("nav2_amcl", "nav2_amcl::AmclNod", ""),
        ("robot_state_publisher", "robot_state_publisher_node", ""),
        ("robot_state_publisher", "robot_state_publisher.py", ""),
        ("acme", "amcll", ""),
    ],
)
def test_a_program_that_a_package_has_not(
    package: str, program: str, text: str, known: Knowledge
) -> None:
    found = judged(known, "MG714", started(package, program, "x"))
    assert said(found) == ([text] if text else [])


def test_a_launch_that_ends_with_an_error(known: Knowledge) -> None:
    notes = [LaunchNote(AT, "boom", fails=True), LaunchNote(AT, "unread")]
    (found,) = judged(known, "MG721", UNKNOWN, notes=notes)
    assert found.message == "the launch ends here: boom"


def test_a_controller_of_two_spawners(known: Knowledge) -> None:
    later = AT._replace(line=20)
    one, two = (
        started(*SPAWNER, arguments=("arm", "gripper")),
        started(*SPAWNER, arguments=("arm",)),
    )
    manager = started(*MANAGER)
    (found,) = judged(known, "MG722", manager, one, two._replace(place=later))
    assert found.message == "/controller_manager gets arm from 2 spawners"
    assert found.line == 20
    assert judged(known, "MG722", manager, one) == []
    apart = two._replace(arguments=("arm", "-c", "/b/controller_manager"))
    assert judged(known, "MG722", manager, one, apart) == []


def described(text: str = "<robot name='r'><link name='a'/></robot>") -> LaunchedNode:
    return started(*STATE, parameters=with_values({"robot_description": text}))


CREATE = ("ros_gz_sim", "create", "create")
BESIDE = "name the launch file that starts it in addition to this one, if there is one"
UNSURE = "an unknown node may do it: see what is reported as incomplete"


def test_a_spawner_without_its_manager(known: Knowledge) -> None:
    spawner = started(*SPAWNER, arguments=("arm", "leg", "-c", "/b/controller_manager"))
    manager = started(*MANAGER, namespace="/b")
    assert judged(known, "MG723", spawner, manager) == []
    (alone,) = judged(known, "MG723", spawner)
    assert alone.message == "nothing starts /b/controller_manager: arm, leg will not be loaded"
    # The launch file may be one of several: it starts no robot.
    assert (alone.level, alone.hint) == ("inconclusive", BESIDE)
    (robot,) = judged(known, "MG723", spawner, described())
    assert (robot.level, robot.hint) == ("error", START)
    (near,) = judged(known, "MG723", spawner, started(*MANAGER), UNKNOWN)
    assert (near.level, near.hint) == ("error", "did you mean /controller_manager?")


@pytest.mark.parametrize(
    ("more", "notes", "level", "hint"),
    [
        # A node that is not known may have it.
        ((UNKNOWN,), (), "inconclusive", UNSURE),
        ((), (LaunchNote(AT, "not read"),), "inconclusive", UNSURE),
        ((), (LaunchNote(AT, "x", fails=True),), "error", START),
        # A plugin of a model that cannot be read may have it.
        ((started(*CREATE, arguments=("-topic", "/other")),), (), "inconclusive", BESIDE),
    ],
)
def test_a_manager_may_be_where_nobody_can_see(
    more: tuple[LaunchedNode, ...],
    notes: tuple[LaunchNote, ...],
    level: str,
    hint: str,
    known: Knowledge,
) -> None:
    spawner = started(*SPAWNER, arguments=("arm", "-c", "/b/controller_manager"))
    (found,) = judged(known, "MG723", spawner, described(), *more, notes=notes)
    assert (found.level, found.hint) == (level, hint)


@pytest.mark.parametrize(
    ("nodes", "said"),
    [
        ((described(),), []),
        # It is sent by none of them: another launch file may.
        ((), [("inconclusive", BESIDE)]),
        ((UNKNOWN,), []),
        (
            (described()._replace(namespace="/r"),),
            [("error", "did you mean /r/robot_description?")],
        ),
        (
            (described()._replace(namespace="/r"), UNKNOWN),
            [("error", "did you mean /r/robot_description?")],
        ),
    ],
)
def test_a_model_without_a_description(
    nodes: tuple[LaunchedNode, ...], said: list[tuple[str, str]], known: Knowledge
) -> None:
    create = started(*CREATE, arguments=("-name", "r", "-topic", "/robot_description"))
    found = judged(known, "MG724", create, *nodes)
    assert [(it.level, it.hint) for it in found] == said


def test_joints_without_a_description(known: Knowledge) -> None:
    joints = started("joint_state_publisher", "joint_state_publisher", "joints")
    (found,) = judged(known, "MG724", joints)
    assert (found.level, found.hint) == ("inconclusive", BESIDE)
    (other,) = judged(known, "MG724", joints, described()._replace(namespace="/r"))
    assert other.level == "error" and other.hint.startswith("start a robot_state_publisher there")
    assert judged(known, "MG724", joints, described()) == []


LEFT = "no node of its node set or file is started here: name the launch file that does, too"


@pytest.mark.parametrize(
    ("running", "levels"),
    [
        ((), {"amcl": "inconclusive", "map": "inconclusive", "own": "error"}),
        # It is started for another robot.
        (("/r2/amcl",), {"amcl": "error", "map": "inconclusive", "own": "error"}),
        (("/r2/map",), {"amcl": "inconclusive", "map": "error", "own": "error"}),
    ],
)
def test_a_node_set_may_be_in_another_launch_file(
    running: tuple[str, ...], levels: dict[str, str]
) -> None:
    origins = {"amcl": {"node_set": "nav2"}, "map": {"place": Place("nav2.yaml", 3)}, "own": {}}
    plan = System(
        tuple(Node(f"/{at}/{it}", **of) for it, of in origins.items() for at in ("r1", "r2"))  # type: ignore[arg-type]
    )
    seen = System(tuple(map(Node, running)))
    found = [missing_node.finding("x", "y", node=f"/r1/{it}") for it in origins]
    told = as_one_of_several(found, plan, seen)
    assert {it.node.removeprefix("/r1/"): it.level for it in told} == levels
    hints = {it.hint for it in as_one_of_several(found, plan, seen) if it.level == "inconclusive"}
    assert hints == {LEFT}
    other = unplanned_node.finding("x", "y", node="/r1/amcl")
    assert [*as_one_of_several([other], plan, seen)] == [other]


@pytest.mark.parametrize(("started", "level"), [("", "inconclusive"), ("/r2/arm", "error")])
def test_what_a_node_makes_for_itself_is_left_with_it(started: str, level: str) -> None:
    """The plan has no node set for it; of two makers the one with the longer name is meant."""
    nodes = (
        Node("/r1/arm", node_set="moveit"),
        Node("/r2/arm", node_set="moveit"),
        Node("/r1/arm_private_*"),
        Node("/r1/a", node_set="nav2"),
    )
    seen = System(tuple(map(Node, ("/r1/a", started))))
    found = missing_node.finding("x", "y", node="/r1/arm_private_*")
    (told,) = as_one_of_several([found], System(nodes), seen)
    assert told.level == level


def managed(*names: str, **values: object) -> LaunchedNode:
    given = {"autostart": True, "node_names": [*names], **values}
    return started(*LIFECYCLE, parameters=with_values(given))


def test_a_node_of_nav2_that_no_manager_knows(known: Knowledge) -> None:
    amcl = started(*AMCL)
    assert judged(known, "MG726", amcl, managed("amcl")) == []
    assert judged(known, "MG726", amcl) == []
    (found,) = judged(known, "MG726", amcl, managed())
    assert said([found]) == [
        "/amcl is in the list of no lifecycle manager; add it to node_names of /manager"
    ]
    alone = amcl._replace(parameters=with_values({"autostart_node": True}))
    assert judged(known, "MG726", alone, managed()) == []
    waiting = amcl._replace(parameters=with_values({"autostart_node": False}))
    assert len(judged(known, "MG726", waiting, managed())) == 1
    itself = started("slam_toolbox", "async_slam_toolbox_node", "slam_toolbox")
    assert judged(known, "MG726", itself, managed()) == []
    elsewhere = started(*AMCL, namespace="/b")
    assert len(judged(known, "MG726", elsewhere, managed("amcl"))) == 2
    unread = started(*LIFECYCLE, parameters=with_values({"node_names": "amcl"}))
    assert judged(known, "MG726", amcl, unread) == []


@pytest.mark.parametrize(
    ("node", "manager", "count"),
    [
        ({}, {}, 1),
        ({"use_lifecycle_manager": True}, {}, 0),
        ({"use_lifecycle_manager": False}, {}, 1),
        ({}, {"bond_timeout": 0.0}, 0),
        ({}, {"bond_timeout": 4.0}, 1),
    ],
)
def test_a_manager_that_waits_for_a_bond_that_is_not_kept(
    node: dict[str, object], manager: dict[str, object], count: int, known: Knowledge
) -> None:
    """slam_toolbox jazzy, slam_toolbox_common.cpp on_activate: createBond by a parameter alone."""
    mapper = started(
        *("slam_toolbox", "async_slam_toolbox_node", "slam_toolbox"), parameters=with_values(node)
    )
    amcl = started(*AMCL)
    found = judged(known, "MG726", amcl, mapper, managed("amcl", "slam_toolbox", **manager))
    waits = "/manager waits for a bond with /slam_toolbox, which keeps none"
    assert [it.message for it in found] == [waits] * count


def test_a_manager_that_waits_for_a_node_that_is_not_started(known: Knowledge) -> None:
    amcl = started(*AMCL)
    (slip,) = judged(known, "MG726", amcl, managed("amcl", "amc"))
    assert slip.message == "/manager waits for /amc, which the launch file does not start"
    assert slip.hint == "did you mean amcl?"
    (found,) = judged(known, "MG726", amcl, managed("amcl", "map_server"))
    assert found.hint == "start it, or leave it out"
    assert judged(known, "MG726", amcl, managed("amcl", "map_server"), UNKNOWN) == []


@pytest.mark.parametrize(
    ("values", "count"),
    [({"autostart": True}, 0), ({"autostart": False}, 1), ({}, 1), ({"autostart": "$(var x)"}, 0)],
)
def test_a_manager_that_activates_nothing_by_itself(
    values: dict[str, object], count: int, known: Knowledge
) -> None:
    given = with_values({"node_names": ["amcl"], **values})
    node = started(*LIFECYCLE, parameters=given)
    assert len(judged(known, "MG727", started(*AMCL), node)) == count
    assert judged(known, "MG727", started(*AMCL, parameters=given)) == []


LINK = (
    '<link name="a"><inertial><mass value="1"/>'
    '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>'
)
SHAPE = LINK.replace("</link>", "<visual><geometry>{}</geometry></visual></link>")
PLUGIN = (
    '<gazebo><plugin name="gz::sim::systems::{}" filename="gz-sim-{}-system">{}</plugin></gazebo>'
)
DRIVE, SYSTEM = (
    PLUGIN.format("DiffDrive", "diff-drive", "{}"),
    PLUGIN.format("Sensors", "sensors", ""),
)
SENSOR = '<gazebo reference="a"><sensor name="s" type="{}"/></gazebo>'
SLIDES = '<joint name="j" type="prismatic"><parent link="a"/><child link="b"/></joint>'
JOINED = '<joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint>'


@pytest.mark.parametrize(
    ("text", "sent", "spawned"),
    [
        (LINK, [], []),
        (SHAPE.format('<sphere radius="0,5"/>'), ["MB120 error"], ["MB120 error"]),
        (SHAPE.format('<cylinder radius="1"/>'), ["MB115 error"], ["MB115 error"]),
        (LINK + LINK, ["MB201 error"], ["MB201 error"]),
        # What only a simulator leaves out, or does not read.
        ('<link name="a"/>', [], ["MB610 error"]),
        (LINK + '<link name="b"/>' + JOINED, [], ["MB603 warning"]),
        (LINK + DRIVE.format("<wheel_diameter>1</wheel_diameter>"), [], ["MB163 warning"]),
        (LINK + DRIVE.format("<wheel_radius>1</wheel_radius>"), [], []),
        (LINK + LINK.replace('"a"', '"b"'), ["MB501 error"], ["MB501 error"]),
        (LINK + LINK.replace('"a"', '"b"') + SLIDES, ["MB509 error"], ["MB509 error"]),
        (LINK.replace('ixx="1"', 'ixx="-1"'), ["MB606 warning"], ["MB606 error"]),
        (LINK.replace('"a"', '"a::b"'), ["MB305 warning"], ["MB305 error"]),
        (LINK + SENSOR.format("no_lidar"), [], ["MB124 error"]),
        (LINK + SENSOR.format("gpu_lidar"), [], []),
        # A warning of the lint is no fault of a launch.
        (LINK + '<gazebo><mass value="1"/></gazebo>', [], []),
        (LINK + SYSTEM, [], []),
    ],
)  # fmt: skip
def test_what_is_wrong_with_a_description_that_is_sent_or_spawned(
    text: str, sent: list[str], spawned: list[str], known: Knowledge
) -> None:
    def told(*nodes: LaunchedNode) -> list[str]:
        found = named_findings(launched(LaunchGraph(nodes, ()), known))
        assert all((it.file, it.line, it.column) == (AT.file, AT.line, 1) for it in found)
        assert all(it.message.startswith("in the description (line 1): ") for it in found)
        return [f"{it.code} {it.level}" for it in found]

    robot = f'<robot name="r">{text}</robot>'
    create = ("ros_gz_sim", "create", "create")
    assert told(started(*STATE, parameters=with_values({"robot_description": robot}))) == sent
    assert told(started(*create, arguments=("-name", "r", "-string", robot))) == spawned


@pytest.mark.parametrize(
    ("texts", "expected"),
    [
        ([], {}),
        ([LINK], {"user-commands": "r0 is not spawned"}),
        ([LINK + SYSTEM], {"user-commands": "r0 is not spawned"}),
        (
            [LINK, LINK + DRIVE],
            {"user-commands": "r0 is not spawned", "physics": "r1 does not move"},
        ),
        (
            [LINK + SENSOR.format("gpu_lidar"), LINK + SENSOR.format("camera")],
            {"user-commands": "r0 is not spawned", "sensors": "s of r0 sends nothing"},
        ),
        (
            [LINK + SENSOR.format("imu") + SENSOR.format("contact")],
            {"user-commands": "r0 is not spawned", "imu": "s of r0 sends nothing"},
        ),
    ],
)
def test_what_a_world_needs_for_its_robots(texts: list[str], expected: dict[str, str]) -> None:
    """gz-sim8: user_commands spawns, physics moves, a sensor has its system."""
    roots = [etree.fromstring(f"<robot>{it}</robot>") for it in texts]
    found = needed_systems((f"r{at}", it) for at, it in enumerate(roots))
    assert dict(found) == expected


def test_a_row_with_a_name_that_ros_refuses_ends_its_node_alone(known: Knowledge) -> None:
    """rcl expands no {name}; a name begins with no digit (rcl expand_topic_name.c, rmw)."""
    lidar = f'<robot name="r">{LINK}{SENSOR.format("gpu_lidar")}</robot>'.replace("</sensor>", "")
    spawn = started("ros_gz_sim", "create", "create", arguments=("-name", "r", "-string", lidar))
    rows = [
        started(
            *("ros_gz_bridge", "parameter_bridge", f"bridge{at}"),
            arguments=(f"/{name}@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan",),
        )
        for at, name in enumerate(("{name}/scan", "1scan", "scan"))
    ]
    found = launched(LaunchGraph((spawn, *rows), ()), known)
    assert [it.name for it in found.system.ends if it.name.endswith("scan")] == ["/scan"]
    assert judge_launch(found) is not None


def test_a_system_of_the_world_is_loaded_again_with_a_second_model(known: Knowledge) -> None:
    robot = f'<robot name="r">{LINK}{SYSTEM}</robot>'
    spawn = [
        started("ros_gz_sim", "create", name, arguments=("-name", name, "-string", robot))
        for name in ("r1", "r2")
    ]
    found = named_findings(launched(LaunchGraph(tuple(spawn), ()), known))
    assert {it.code for it in found} == {"MB416"}


SENT = "running: transform {} on /tf by /a\n"
LOOSE, BODY = SENT.format("map -> odom"), SENT.format("base_link -> laser")
POSED = LOOSE.replace("/a", "/start_pose") + "running: /start_pose publishes /x\n"
MISSPELLED = SENT.format("odom -> base_lnk") + SENT.format("base_link -> front")
WHOLE = SENT.format("odom -> base_link")
STATES = BODY.replace("/a", "/robot_state_publisher")
MOVED = f"<robot name='r'>{LINK}{{}}</robot>"
GZ_DRIVE = """<gazebo><plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
<left_joint>l</left_joint><right_joint>r</right_joint><topic>cmd_vel{}</topic></plugin></gazebo>"""
CLASSIC_DRIVE = (
    """<gazebo><plugin name="drive" filename="libgazebo_ros_planar_move.so"/></gazebo>"""
)
JOINTS = """<gazebo><plugin filename="gz-sim-joint-state-publisher-system"
name="gz::sim::systems::JointStatePublisher"/></gazebo>"""
ODD_PLUGIN = "<gazebo><plugin name='p' filename='p'/></gazebo>"


@pytest.mark.parametrize(
    ("lines", "spawned", "becomes"),
    [
        (LOOSE + BODY, "", "warning"),
        (LOOSE + BODY, MOVED.format("<!-- <plugin/> -->"), "warning"),
        (LOOSE + BODY, "<robot", "warning"),
        (LOOSE + BODY, MOVED.format(GZ_DRIVE.format("")), "error"),
        (LOOSE + BODY, MOVED.format(CLASSIC_DRIVE), "error"),
        # A build that places the robot starts nothing that localizes it.
        (POSED + BODY, MOVED.format(CLASSIC_DRIVE), "warning"),
        (POSED.replace("start", "other") + BODY, MOVED.format(CLASSIC_DRIVE), "error"),
        # A sensor or what tells the joints moves nothing, and what is not known may send the odometry.
        (LOOSE + BODY, MOVED.format(JOINTS), "warning"),
        (LOOSE + BODY, MOVED.format(ODD_PLUGIN), "warning"),
        # Somebody may bring it to tf: a filter, a relay.
        (
            LOOSE + BODY + SENT.format("odom -> base_link").replace("/tf", "/sim/tf"),
            MOVED.format(GZ_DRIVE.format("")),
            "warning",
        ),
        (MISSPELLED, "", "error"),
        # Nothing is spawned: the driver of a real robot may place its base.
        (LOOSE + STATES, "", "note"),
        (LOOSE + STATES, MOVED.format(JOINTS), "warning"),
        (MISSPELLED + STATES, "", "error"),
        (WHOLE + BODY, MOVED.format(GZ_DRIVE.format("")), "warning"),
        (WHOLE + BODY + SENT.format("tool -> tip"), "", "warning"),
    ],
)
def test_how_sure_it_is_that_a_launch_file_leaves_a_tree_in_pieces(
    lines: str, spawned: str, becomes: str, known: Knowledge
) -> None:
    """Of a robot that nothing moves a driver may send the odometry; other pieces may be meant."""
    _, graph = read_example(lines)
    seen = index(graph, whose_by_guess(guess_robots(graph)))
    found = Finding("MG406", "error", "m", names=("odom", "base_link"))
    made = _launch_of(spawned, known)
    assert as_sure(found, made, seen).level == becomes
    assert as_sure(found._replace(level="note"), made, seen).level == "note"


def _launch_of(text: str, known: Knowledge) -> Launched:
    spawn = started("ros_gz_sim", "create", "create", arguments=("-name", "r", "-string", text))
    return launched(LaunchGraph((spawn,) if text else (), ()), known)


def test_a_velocity_behind_the_name_of_its_robot_moves_it_as_well(known: Knowledge) -> None:
    """In a fleet whose names all have the robot's behind them: cmd_vel/r1."""
    lines = "".join(
        f"running: transform {edge} on /tf/{robot} by /rsp_{robot}\n"
        for robot in ("r1", "r2")
        for edge in (f"map -> odom/{robot}", f"base_link/{robot} -> laser/{robot}")
    )
    _, graph = read_example(lines)
    plan = System(
        nodes=tuple(Node(f"/rsp_{it}", robot=it) for it in ("r1", "r2")),
        robots=tuple(
            Robot(it, (f"odom/{it}", f"base_link/{it}"), f"/tf/{it}") for it in ("r1", "r2")
        ),
    )
    seen = index(graph, whose_by_plan(plan))
    found = Finding("MG406", "error", "m", robot="r1", names=("odom/r1", "base_link/r1"))
    made = _launch_of(MOVED.format(GZ_DRIVE.format("/r1")), known)
    assert as_sure(found, made, seen).level == "error"


@pytest.mark.parametrize(
    ("code", "level", "becomes"),
    [
        (interface_not_exported.code, "warning", "error"), ("MG601", "warning", "warning"),
        (interface_claimed_twice.code, "warning", "error"), ("MG601", "error", "error"),
        (interface_not_exported.code, "note", "note"),
    ],
)  # fmt: skip
def test_a_claim_that_nothing_meets_is_an_error_where_all_is_known(
    code: str, level: str, becomes: str
) -> None:
    nothing: Any = None
    assert as_sure(Finding(code, level, "m"), nothing, nothing).level == becomes


STAYS = "<robot_namespace>"


def of_file(text: str) -> tuple[ParameterText, ...]:
    return (ParameterText("/ws/own.yaml", text, "/ws/own.yaml"),)


@pytest.mark.parametrize(
    ("more", "left", "line"),
    [
        ({"parameters": of_file(f"amcl:\n  ros__parameters: {{map_topic: {STAYS}/m}}\n")}, STAYS, 2),
        ({"parameters": of_file(f"{STAYS}/amcl:\n  ros__parameters: {{max_beams: 9}}\n")}, STAYS, 1),
        ({"parameters": of_file(f"amcl:\n  ros__parameters:\n    joints: [a, {STAYS}b]\n")}, STAYS, 3),
        ({"parameters": of_file("amcl:\n  ros__parameters: {odom_frame_id: $(var ns)/odom}\n")},
         "$(var ns)", 2),
        ({"parameters": of_file("amcl:\n  ros__parameters: {odom_frame_id: '${robot}_odom'}\n")},
         "${robot}", 2),
        ({"remappings": (("scan", f"/{STAYS}/scan"),)}, STAYS, AT.line),
        ({"arguments": ("--ros-args", "-r", f"__ns:=/{STAYS}")}, STAYS, AT.line),
        ({"parameters": with_values({"odom_frame_id": "<prefix>odom"})}, "<prefix>", AT.line),
        ({"parameters": with_values({"robot_description": "<robot name='r'><link name='a'/></robot>"})},
         "", 0),
        ({"parameters": with_values({"note": "give <name> to each", "map_topic": "a<b"})}, "", 0),
    ],
)  # fmt: skip
def test_a_placeholder_that_a_node_gets_as_it_is(
    more: dict[str, Any], left: str, line: int, known: Knowledge
) -> None:
    """launch_ros parameter_descriptions.py fills in nothing without allow_substs."""
    found = judged(known, "MB105", started("nav2_amcl", "amcl", "amcl", **more))
    assert [(it.level, it.line) for it in found] == ([("error", line)] if left else [])
    assert all(left in it.message for it in found)


@pytest.mark.parametrize(
    ("node", "sections", "said_of_it"),
    [
        (AMCL, ("amlc", "foo"), ["write /amcl: amlc is nearly its name"]),
        (AMCL, ("foo",), ["write /amcl: it has foo"]),
        (AMCL, ("foo", "/**"), []),
        (AMCL, ("amcl", "foo"), []),
        # Of a program that nobody knows only the launch file says the name.
        (("acme", "driver", "lidar"), ("foo",), ["write /lidar: it has foo"]),
        (("acme", "driver", ""), ("foo",), []),
        # A node that runs inside it is meant.
        (("nav2_controller", "controller_server", "controller_server"),
         ("local_costmap/local_costmap",), []),
    ],
)  # fmt: skip
def test_a_file_of_which_nothing_matches(
    known: Knowledge, node: tuple[str, str, str], sections: tuple[str, ...], said_of_it: list[str]
) -> None:
    text = yaml.safe_dump({it: {"ros__parameters": {"a": 1}} for it in sections})
    found = judged(known, "MB244", started(*node, parameters=of_file(text)))
    assert [it.hint for it in found] == said_of_it
    # Without a name that is nearly the node's, its nodes may be started elsewhere.
    assert [it.level for it in found] == [
        "error" if "nearly" in it.hint else "warning" for it in found
    ]
    assert all(it.file == "/ws/own.yaml" for it in found)


@pytest.mark.parametrize(
    ("section", "node", "hint"),
    [
        ("planer_server", "planner_server", "write /planner_server:"),
        ("Planner_Server", "planner_server", "write /planner_server:"),
        # Another known node, another side, another number, and one that has its section.
        ("map_saver", "map_server", ""),
        ("front_left_motor_controller", "front_right_motor_controller", ""),
        ("driver_2", "driver_1", ""),
        ("amlc", "amcl", ""),
    ],
)
def test_a_section_whose_name_is_nearly_a_node_s(
    section: str, node: str, hint: str, known: Knowledge
) -> None:
    text = yaml.safe_dump({it: {"ros__parameters": {"a": 1}} for it in ("amcl", section)})
    given = {"parameters": of_file(text)}
    nodes = started("nav2_amcl", "amcl", "amcl", **given), started("acme", "it", node, **given)
    assert [it.hint for it in judged(known, "MB244", *nodes)] == [hint] * bool(hint)


@pytest.mark.parametrize(
    ("section", "told"),
    # launch_ros to_parameters_list.py joins a section to a component as rclcpp does, since 0.19.10
    # (Humble), 0.26.8 (Jazzy) and 0.28.2 (Kilted).
    [("amcl", True), ("/*/other", True), ("/*/amcl", False), ("/r1/**", False), ("/*", True)],
)
def test_a_section_for_a_component(section: str, told: bool, known: Knowledge) -> None:
    text = yaml.safe_dump({section: {"ros__parameters": {"a": 1}}})
    own = {"namespace": "/r1", "container": "/box", "parameters": of_file(text)}
    found = judged(known, "MB244", started("nav2_amcl", "nav2_amcl::AmclNode", "amcl", **own))
    assert len(found) == told
