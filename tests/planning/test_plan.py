# SPDX-License-Identifier: Apache-2.0
"""The plan that follows from a table: which nodes and ends it has, and which of them may be missing."""

from __future__ import annotations

import json

import pytest
from paths import ROBOTS

from multibot_rewrite.base.naming import Policy, make_naming
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.checks.judged_plan import make_fleet
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.description.steps.collect import collect
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.knowledge.node_sets import built_in
from multibot_rewrite.knowledge.records import (
    Endpoint,
    FrameParameter,
    NodeFacts,
    SentTransform,
    Untold,
)
from multibot_rewrite.planning.of_runs import target_of
from multibot_rewrite.planning.planned_system import expect
from multibot_rewrite.planning.records import Table
from multibot_rewrite.planning.table import build_table
from multibot_rewrite.planning.table_formats import FORMS
from multibot_rewrite.planning.transforms import (
    edges_in,
    edges_of,
    links_of,
    sent_by,
    with_odometry,
)
from multibot_rewrite.planning.ways import arguments, started
from multibot_rewrite.system.records import (
    PUBLISHES,
    RUNS,
    SERVICE,
    TOPIC,
    Origin,
    Place,
    Sure,
    System,
    edge_of,
    origin_of,
)

SCAN = Endpoint(TOPIC, PUBLISHES, "scan", "a/msg/Scan", also=("a/msg/Old",))
MAYBE = Endpoint(TOPIC, PUBLISHES, "maybe", when="x: true")


def plan(layout: str = "L1", *facts: NodeFacts, **more: object) -> System:
    naming = make_naming(layout)
    table = build_table(["a"], facts, naming, release=NEWEST_LTS)
    return expect(table, naming, {"a": ["base"]}, **more)  # type: ignore[arg-type]


def test_an_end_that_surely_is_there_stands_for_those_that_may_be() -> None:
    """A node opens a name under several conditions: one that holds always says more than the others."""
    own = Endpoint(TOPIC, PUBLISHES, "scan", when="x: true"), SCAN, MAYBE, MAYBE._replace(when="y")
    found = plan("L1", NodeFacts("driver", "acme", own)).ends
    assert [(it.name, it.sure) for it in found] == [
        ("/a/scan", RUNS),
        ("/a/maybe", Sure("may", "x: true")),
    ]


@pytest.mark.parametrize(
    ("text", "origin"),
    [
        ("node set nav2", Origin("nav2")),
        ("a.yaml:3", Origin(place=Place("a.yaml", 3))),
        ("./node set of mine.yaml:3", Origin(place=Place("./node set of mine.yaml", 3))),
        ("", Origin()),
    ],
)
def test_what_names_a_node(text: str, origin: Origin) -> None:
    assert origin_of(text) == origin
    assert str(origin) == text


@pytest.mark.parametrize(
    ("layout", "kind", "name", "target"),
    [
        ("L1", TOPIC, "~/x", ""),
        ("L1", TOPIC, "/scan", "scan"),
        ("L1", TOPIC, "scan", ""),
        ("L1", TOPIC, "/clock", ""),
        ("L1", TOPIC, "clock", "/clock"),
        ("L4", TOPIC, "clock", ""),
        ("L1", TOPIC, "clock/compressed", "/clock/compressed"),
        ("L4", SERVICE, "/clock/_action/send_goal", ""),
        ("L4", TOPIC, "/scan", "/scan/a"),
        ("L4", SERVICE, "reset", "reset/a"),
        ("L4", TOPIC, "eye/compressed", "eye/a/compressed"),
        ("L4", TOPIC, "compressed", "compressed/a"),
        ("L4", SERVICE, "go/_action/send_goal", "go/a/_action/send_goal"),
        ("L2", TOPIC, "/tf", ""),
    ],
)
def test_the_target_of_a_rule(layout: str, kind: str, name: str, target: str) -> None:
    assert target_of(name, kind, "a", make_naming(layout)) == target


@pytest.mark.parametrize("end", ["", "/compressed", "/_action/send_goal"])
def test_the_parts_of_what_is_shared_are_shared(end: str) -> None:
    """An action's parts and an image's transports are found from the one name alone."""
    naming = make_naming("both")._replace(shared_topics=frozenset({"above"}))
    assert target_of(f"above{end}", "topic", "a", naming) == f"/above{end}"
    assert target_of(f"/above{end}", "topic", "a", naming) == ""
    assert target_of(f"/below{end}", "topic", "a", naming) == f"below{end}"


XML = """<robot name="r"><link name="a/base"/><link name="a/wheel"/><link name="a/lidar"/>
<joint name="j" type="continuous"><parent link="a/base"/><child link="a/wheel"/></joint>
<joint name="k" type="fixed"><parent link="a/base"/><child link="a/lidar"/></joint>
<joint name="broken" type="fixed"><parent link="a/base"/></joint></robot>"""
SDF = """<sdf version="1.9"><model name="m"><link name="base"/><frame name="f" attached_to="g"/>
<frame name="g" attached_to="base"/><frame name="loop" attached_to="loop"/><frame name="free"/>
<joint name="j" type="fixed"><parent> f </parent><child>tip</child></joint>
<joint name="k" type="revolute"><parent>loop</parent><child>free</child></joint></model></sdf>"""
STATE = NodeFacts("robot_state_publisher", "robot_state_publisher", ())
ODOMETRY = NodeFacts(
    "drive",
    "acme",
    (Endpoint(TOPIC, PUBLISHES, "/tf"),),
    frames=(FrameParameter("odom", "odom"), FrameParameter("base", "base_link")),
    sends=(SentTransform("odom", "base"),),
)
TREE = [edge_of("a/base", "a/wheel"), edge_of("a/base", "a/lidar", True)]


def inventory_of(text: str):
    return collect(read_document(text.encode(), "r"), builtin_tree((), NEWEST_LTS))


def test_transforms_of_a_description() -> None:
    assert list(edges_in(read_document(XML.encode(), "r").root)) == TREE
    assert list(edges_in(read_document(SDF.encode(), "r").root)) == [
        edge_of("base", "tip", True),
        edge_of("loop", "free"),
    ]


LOOPED = """<robot name="r"><link name="base"/><link name="left"/><link name="right"/><link name="rod"/>
<joint name="a" type="fixed"><parent link="base"/><child link="left"/></joint>
<joint name="b" type="fixed"><parent link="base"/><child link="right"/></joint>
<joint name="d" type="fixed"><parent link="left"/><child link="rod"/></joint>
<joint name="c" type="fixed"><parent link="right"/><child link="rod"/></joint>
<gazebo><link name="buckle"/>
<joint name="e" type="ball"><parent>left</parent><child>buckle</child></joint>
<joint name="f" type="ball"><parent>right</parent><child>buckle</child></joint>
</gazebo></robot>"""


def test_each_link_has_one_parent_in_tf_and_what_is_for_gazebo_none() -> None:
    """urdfdom_headers model.h initTree: a joint is a link's parent after those before it by name, and
    parser model.cpp reads the joints of the robot alone."""
    inventory = inventory_of(LOOPED)
    assert list(edges_in(inventory.document.root)) == [
        edge_of("base", "left", True),
        edge_of("base", "right", True),
        edge_of("left", "rod", True),
    ]
    links = links_of(inventory, make_naming("L1"), "a")
    assert links == ["base", "left", "right", "rod"]


def test_a_static_transform_may_have_the_robots_name_already() -> None:
    static = ODOMETRY._replace(
        endpoints=(Endpoint(TOPIC, PUBLISHES, "/tf_static"),),
        frames=(FrameParameter("p", "a/base", given=True), FrameParameter("c", "tip", given=True)),
        sends=(SentTransform("p", "c"),),
    )
    (edge,) = edges_of("a", inventory_of(XML), (static,), (), make_naming("L2", affix="prefix"))[
        "a", "drive"
    ]
    assert edge == edge_of("a/base", "a/tip", True)
    both = static._replace(endpoints=(*static.endpoints, *ODOMETRY.endpoints))
    (edge,) = edges_of("a", inventory_of(XML), (both,), (), make_naming("L2", affix="prefix"))[
        "a", "drive"
    ]
    assert edge == edge_of("a/a/base", "a/tip")


@pytest.mark.parametrize(
    ("frames", "condition", "root", "edges"),
    [
        ("odom base", "", "", [("odom", "base")]),
        ("/odom /base", "", "", [("odom", "base")]),
        ("odom base", "", "root", [("odom", "root")]),
        ("odom base given", "", "root", [("odom", "base")]),
        ("map my_odom", "", "", [("map", "my_odom")]),
        ("x x", "", "", []),
        ("x <id>", "", "", []),
        ("x base", "parent = y", "", []),
        ("x base", "parent = x", "", [("x", "base")]),
    ],
)
def test_the_transform_that_parameters_name(
    frames: str, condition: str, root: str, edges: list[tuple[str, str]]
) -> None:
    parent, child, *given = frames.split()
    values = (FrameParameter("parent", parent), FrameParameter("child", child, given=bool(given)))
    node = NodeFacts(
        "n", "p", (), frames=values, sends=(SentTransform("parent", "child", condition),)
    )
    assert list(sent_by(node, root)) == [edge_of(*it) for it in edges]


def test_frames_that_code_makes_have_the_robots_name_where_what_they_are_made_of_has_it() -> None:
    """mavros uas_tf.cpp and realsense tfs.cpp: static, and not below the root of the description."""
    library = built_in(NEWEST_LTS).nodes
    naming = make_naming("L2", affix="prefix", shared_frames=("map",))
    facts = [STATE, library["mavros_node"], library["camera"]]
    edges = edges_of("a", inventory_of(XML), facts, (), naming)
    assert edges["a", "mavros_node"] == [
        edge_of("map", "map_ned", True),
        edge_of("a/odom", "a/odom_ned", True),
        edge_of("a/base_link", "a/base_link_frd", True),
    ]
    assert edges["a", "camera"] == [
        edge_of("a/camera_link", f"a/camera_{it}_frame", True) for it in ("depth", "color")
    ]


def test_odometry_that_no_node_is_known_to_send_is_added() -> None:
    naming = make_naming("L2", affix="prefix")
    state, ekf = ("a", "robot_state_publisher"), ("a", "amcl")
    edges = {state: TREE, ekf: [edge_of("map", "a/odom")], ("b", "x"): [edge_of("q", "r")]}
    added, text = with_odometry(edges, "a", naming)
    assert text == "a/odom -> a/base"
    assert added == {**edges, state: [*TREE, edge_of("a/odom", "a/base")]}
    closed = {**edges, ("a", "drive"): [edge_of("a/odom", "a/base")]}
    assert with_odometry(closed, "a", naming) == (closed, "")
    fixed = {state: [edge_of("world", "a/base")], ekf: edges[ekf]}
    assert with_odometry(fixed, "a", naming) == (fixed, "")
    two = {**edges, ("a", "x"): [edge_of("map", "a/other")]}
    assert with_odometry(two, "a", naming) == (two, "")


# Frames of a plan that no description declares: what messages, plugins and parameters may name.


def others(layout: str, *defaults: str) -> set[str]:
    """Of robot1, which has base_link alone and a node with frames that are called so by default."""
    naming = make_naming(layout)
    frames = tuple(FrameParameter(f"f{at}", default=it) for at, it in enumerate(defaults))
    facts = [NodeFacts("scanner", "acme", (), frames=frames)]
    table = build_table(["robot1"], facts, naming, release=NEWEST_LTS)
    (robot,) = expect(table, naming, {"robot1": ["base_link"]}).robots
    return {*robot.other_frames}


@pytest.mark.parametrize(
    ("default", "planned"),
    [
        ("laser", True),
        # tf2 takes no slash in front.
        ("/laser", True),
        # It is that of another parameter, or there is none.
        ("<laser>", False),
        ("", False),
    ],
)
def test_a_default_frame_of_a_node_may_come(default: str, planned: bool) -> None:
    assert others("tf-per-robot", default) - others("tf-per-robot") == (
        {"laser"} if planned else set()
    )
    assert others("postfix", default) - others("postfix") == (
        {"laser/robot1"} if planned else set()
    )


# What is started for the nodes of a table: processes, components, spawners, and their arguments.
GZ = str(ROBOTS / "rover_gz.urdf")


def table(release: str, *node_sets: str, layout: str = "tf-per-robot") -> Table:
    policy: Policy = {"layout": layout}
    return make_fleet(GZ, ["robot1", "robot2"], node_sets, policy, release=release).table


@pytest.mark.more
def test_the_data_says_where_each_rule_stands() -> None:
    found = json.loads(FORMS["json"](table("lyrical", "gz_ros2_control", "nav2")))
    assert found["distro"] == "lyrical"
    own = found["robots"]["robot1"]
    ways = {node: (it["way"], it["at"]) for node, it in own.items()}
    assert ways["controller_manager"] == ("plugin", "controller_manager")
    assert ways["diff_drive_controller"] == ("spawner", "diff_drive_controller")
    assert ways["local_costmap/local_costmap"] == ("host", "controller_server")
    assert ways["amcl"] == ("process", "amcl")
    assert own["diff_drive_controller"]["remappings"] == [["/tf", "tf"]]


@pytest.mark.more
def test_a_component_is_loaded_with_its_name_namespace_and_rules() -> None:
    found = {
        it.node.node: arguments(it)
        for it in started(table("lyrical", "nav2_composed"))
        if it.node.robot == "robot1"
    }
    assert found["amcl"][:4] == ["-n", "amcl", "--node-namespace", "/robot1"]
    assert found["amcl"][4:] == ["-r", "/tf:=tf", "-r", "/tf_static:=tf_static"]
    assert found["nav2_container"][:3] == ["--ros-args", "-r", "__ns:=/robot1"]


def test_a_node_says_what_its_source_leaves_open() -> None:
    naming = make_naming(layout="both")
    facts = [NodeFacts("n", "acme", (), untold=(Untold("a name of a topic"),))]
    table = build_table(["robot1"], facts, naming, release=NEWEST_LTS)
    (node,) = expect(table, naming, {"robot1": ["base_link"]}).nodes
    assert node.untold == ("a name of a topic",)
