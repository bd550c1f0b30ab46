# SPDX-License-Identifier: Apache-2.0
"""The plan that follows from a table: which nodes and ends it has, and which of them may be missing."""

from __future__ import annotations

import pytest
from plans import planned_end

from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.description.steps.collect import collect
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.knowledge.records import (
    Endpoint,
    FrameParameter,
    NodeFacts,
    SentTransform,
)
from multibot_rewrite.knowledge.stacks import built_in
from multibot_rewrite.rules.check import check
from multibot_rewrite.spelling.of_runs import expanded, placed, target_of
from multibot_rewrite.spelling.plan import expect, named_frames, tf_topic
from multibot_rewrite.spelling.records import Run
from multibot_rewrite.spelling.table import build_table
from multibot_rewrite.spelling.transforms import (
    edges_in,
    edges_of,
    frames_of,
    links_of,
    sent_by,
    state_publisher_of,
    with_odometry,
)
from multibot_rewrite.system.records import (
    ACTION,
    MAY,
    PUBLISHES,
    RUNS,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    Origin,
    Place,
    Sure,
    System,
    edge_of,
    origin_of,
)

SCAN = Endpoint(TOPIC, PUBLISHES, "scan", "a/msg/Scan", also=("a/msg/Old",))
TF = Endpoint(TOPIC, SUBSCRIBES, "/tf", helper=True)
OWN = Endpoint(TOPIC, SUBSCRIBES, "/own", by="_private_*")
MAYBE = Endpoint(TOPIC, PUBLISHES, "maybe", when="x: true")
ROSOUT = Endpoint(TOPIC, PUBLISHES, "/rosout")
RULE = Endpoint(TOPIC, "", "only_a_rule")
DRIVER = NodeFacts("driver", "acme", (SCAN, TF, OWN, MAYBE, ROSOUT, RULE))
SPARE = NodeFacts("spare", "acme", (SCAN, OWN._replace(by="_spare_*")), when="spare: true")
BY_WHEN = NodeFacts("b", "acme", (OWN._replace(by="_when_*", when="x: true"),))
MAPS = NodeFacts("map_server", "nav2", (OWN._replace(by="_made_*"),), shared=True)


def plan(layout: str = "L1", *facts: NodeFacts, **more: object) -> System:
    naming = make_naming(layout)
    table = build_table(["a"], facts, naming, release=NEWEST_LTS)
    return expect(table, naming, {"a": ["base"]}, **more)  # type: ignore[arg-type]


def test_ends_are_planned_those_under_a_condition_as_what_may_be_there() -> None:
    maybe = planned_end("/a/driver", TOPIC, PUBLISHES, "/a/maybe", "", "maybe")
    assert plan("L1", DRIVER).ends == (
        planned_end("/a/driver", TOPIC, PUBLISHES, "/a/scan", "a/msg/Scan", "scan", ("a/msg/Old",)),
        planned_end("/a/driver_private_*", TOPIC, SUBSCRIBES, "/a/own", "", "/own"),
        maybe._replace(sure=Sure("may", "x: true")),
    )


def test_an_end_that_surely_is_there_stands_for_those_that_may_be() -> None:
    """A node opens a name under several conditions: one that holds always says more than the others."""
    own = Endpoint(TOPIC, PUBLISHES, "scan", when="x: true"), SCAN, MAYBE, MAYBE._replace(when="y")
    found = plan("L1", NodeFacts("driver", "acme", own)).ends
    assert [(it.name, it.sure) for it in found] == [
        ("/a/scan", RUNS),
        ("/a/maybe", Sure("may", "x: true")),
    ]


@pytest.mark.parametrize("there", [True, False])
def test_an_end_that_may_be_there_is_neither_missed_nor_unplanned(there: bool) -> None:
    """``/fixed`` has no robot's name: of a node that is not planned to have it, that is a finding."""
    fixed = Endpoint(TOPIC, PUBLISHES, "/fixed", "a/msg/B", fixed="its code", when="x: true")
    planned = plan("L1", NodeFacts("driver", "acme", (SCAN, fixed)))
    ends = tuple(it._replace(sure=RUNS) for it in planned.ends if there or it.sure == RUNS)
    graph = System(planned.nodes, ends, robots=planned.robots)
    assert [str(it) for it in check(planned, graph) if it.level != "note"] == []
    unplanned = planned._replace(ends=tuple(it for it in planned.ends if it.sure == RUNS))
    assert bool(check(unplanned, graph)) is there


def test_nodes_are_planned_with_those_that_they_make() -> None:
    found = plan("L1", DRIVER, SPARE, BY_WHEN, MAPS)
    assert [(it.name, it.robot, it.sure) for it in found.nodes] == [
        ("/a/driver", "a", RUNS),
        ("/a/spare", "a", MAY),
        ("/a/b", "a", RUNS),
        ("/a/driver_private_*", "a", RUNS),
        ("/a/spare_spare_*", "a", MAY),
        ("/a/b_when_*", "a", MAY),
        ("/map_server", "", RUNS),
    ]
    # What a node of all robots makes comes and goes.
    assert found.ignored_nodes == ("/map_server_made_*",)


def test_the_plan_of_a_layout_has_its_words() -> None:
    found = plan("L1", DRIVER)
    assert (found.layout, found.shared_frames) == ("tf-per-robot", ("earth", "map", "utm", "world"))
    assert "/clock" in found.shared_topics
    assert list(found.shared_topics) == sorted(found.shared_topics)


def test_a_robot_may_have_another_name_in_its_frames() -> None:
    (robot,) = plan("L2", DRIVER, words={"a": "b"}, named={"a": ["x", "base"]}).robots
    assert (robot.name, robot.tag, robot.frames, robot.tf_topic) == ("a", "b", ("base",), "/tf")
    assert robot.other_frames[0] == "x"
    assert "odom/b" in robot.other_frames
    assert plan("L2", DRIVER, words={"a": "a"}).robots[0].tag == ""


def test_a_node_says_where_its_rules_stand() -> None:
    naming = make_naming("L1")
    hosted = NodeFacts("hosted", "acme", (Endpoint(TOPIC, PUBLISHES, "/x"),), host="driver")
    gz = Run("a", "gz", "/a", "gz", (), NodeFacts("gz", "p", (), plugin="p"), written=True)
    gz = gz._replace(place=Place("r.urdf", 7))
    facts = (
        DRIVER,
        hosted,
        NodeFacts("box", "acme", ()),
        NodeFacts("c", "acme", (), container="box"),
    )
    plugins = {"a": [gz]}
    table = build_table(["a"], facts, naming, plugins, release=NEWEST_LTS)
    found = expect(table, naming, {"a": []}, maybe_real=["a"])
    assert {it.name: (it.way, it.taker) for it in found.nodes if it.way} == {
        "/a/hosted": ("host", "/a/driver"),
        "/a/c": ("component", ""),
    }
    (made,) = (it for it in found.nodes if it.name == "/a/gz")
    assert (made.sure, made.plugin) == (MAY, Place("r.urdf", 7))
    real = expect(table, naming, {"a": []})
    assert [it.sure for it in real.nodes if it.name == "/a/gz"] == [RUNS]


@pytest.mark.parametrize(
    ("text", "origin"),
    [
        ("stack nav2", Origin("nav2")),
        ("a.yaml:3", Origin(place=Place("a.yaml", 3))),
        ("./stack of mine.yaml:3", Origin(place=Place("./stack of mine.yaml", 3))),
        ("", Origin()),
    ],
)
def test_what_names_a_node(text: str, origin: Origin) -> None:
    assert origin_of(text) == origin
    assert str(origin) == text


def test_a_file_that_is_called_like_a_stack_is_a_place() -> None:
    text = str(Origin(place=Place("stack of mine.yaml", 3)))
    assert origin_of(text).place == Place("./stack of mine.yaml", 3)


@pytest.mark.parametrize(
    ("layout", "topic"), [("L1", "/a/tf"), ("L2", "/tf"), ("L3", "/a/tf"), ("L4", "/tf/a")]
)
def test_the_tf_topic_of_a_layout(layout: str, topic: str) -> None:
    assert tf_topic("a", make_naming(layout)) == topic


def test_frames_that_a_description_names_in_its_plugins() -> None:
    text = """<robot name="r"><link name="base"/><gazebo>
<plugin name="odom" filename="libgazebo_ros_p3d.so"><frame_name> world </frame_name>
<body_name>base</body_name></plugin>
<plugin name="d" filename="gz-sim-diff-drive-system"><frame_id>odom</frame_id>
<odom_topic>o</odom_topic><child_frame_id>base</child_frame_id></plugin></gazebo></robot>"""
    inventory = collect(read_document(text.encode(), "r"), builtin_tree((), NEWEST_LTS))
    assert named_frames(inventory) == ("world", "odom", "base")


@pytest.mark.parametrize(
    ("layout", "node", "apart", "place"),
    [
        ("L1", "amcl", False, ("/a", "amcl")),
        ("L1", "map/map", False, ("/a/map", "map")),
        ("L4", "amcl", False, ("/", "amcl_a")),
        ("L4", "map/map", False, ("/map", "map_a")),
        ("L4", "map/map", True, ("/a/map", "map")),
        ("L4", "/amcl/", True, ("/a", "amcl")),
    ],
)
def test_a_node_is_placed(layout: str, node: str, apart: bool, place: tuple[str, str]) -> None:
    assert placed("a", node, make_naming(layout), apart) == place


def test_an_action_is_three_services_and_three_topics() -> None:
    """rcl_action names.c; image_transport's siblings are topics."""
    assert list(expanded(Endpoint(ACTION, "", "go"))) == [
        (TOPIC, "go"),
        (SERVICE, "go/_action/send_goal"),
        (SERVICE, "go/_action/cancel_goal"),
        (SERVICE, "go/_action/get_result"),
        (TOPIC, "go/_action/feedback"),
        (TOPIC, "go/_action/status"),
    ]
    assert list(expanded(Endpoint(TOPIC, "", "eye", transport=True))) == [
        (TOPIC, "eye"),
        *((TOPIC, f"eye/{it}") for it in ("compressed", "compressedDepth", "theora", "zstd")),
    ]
    assert list(expanded(Endpoint(TOPIC, "", "<x>/eye"))) == []


@pytest.mark.parametrize(
    ("layout", "kind", "name", "target"),
    [
        ("L1", TOPIC, "~/x", ""),
        ("L1", TOPIC, "/scan", "scan"),
        ("L1", TOPIC, "scan", ""),
        ("L1", TOPIC, "/clock", ""),
        ("L1", TOPIC, "clock", "/clock"),
        ("L4", TOPIC, "clock", ""),
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


def test_who_sends_which_transform() -> None:
    dock = STATE._replace(name="dock_publisher")
    naming = make_naming("L2", affix="prefix")
    plugin = ODOMETRY._replace(name="gz")
    found = edges_of("a", inventory_of(XML), (ODOMETRY, STATE, dock), (plugin,), naming)
    assert found == {
        ("a", "gz"): [edge_of("odom", "base_link")],
        ("a", "drive"): [edge_of("a/odom", "a/base")],
        ("a", "robot_state_publisher"): TREE,
        ("a", "dock_publisher"): [],
    }
    plain = {("link", "odom"): "my_odom"}
    (edge,) = edges_of("a", inventory_of(XML), (ODOMETRY,), (), naming, plain=plain)["a", "drive"]
    assert edge.parent == "my_odom"


def test_frames_have_the_word_that_stands_for_the_robot() -> None:
    """``frame_prefix`` of robot_state_publisher is that word, not the namespace."""
    naming, inventory = make_naming("frame-prefix"), inventory_of(XML.replace("a/", ""))
    tree = [("base", "wheel", False), ("base", "lidar", True)]
    for word, lead in (("", "a"), ("b", "b")):
        found = edges_of("a", inventory, (ODOMETRY, STATE), (), naming, word)
        assert found["a", "drive"] == [edge_of(f"{lead}/odom", f"{lead}/base")]
        sent = [edge_of(f"{lead}/{one}", f"{lead}/{two}", it) for one, two, it in tree]
        assert found["a", "robot_state_publisher"] == sent


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
    ("names", "found"),
    [
        (["robot_state_publisher", "dock"], "robot_state_publisher"),
        (["dock", "robot_state_publisher"], "robot_state_publisher"),
        (["dock", "other"], "dock"),
        ([], ""),
    ],
)
def test_which_node_sends_the_description(names: list[str], found: str) -> None:
    nodes = [NodeFacts("driver", "acme", ()), *(STATE._replace(name=it) for it in names)]
    assert state_publisher_of(nodes) == found


@pytest.mark.parametrize(
    ("frames", "condition", "root", "edges"),
    [
        ("odom base", "", "", [("odom", "base")]),
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


def test_odometry_keeps_its_frame_and_no_parent_is_no_transform() -> None:
    values = (FrameParameter("map", "map"), FrameParameter("odom_frame", "odom"))
    node = NodeFacts("n", "p", (), frames=values, sends=(SentTransform("map", "odom_frame"),))
    assert list(sent_by(node, "root")) == [edge_of("map", "odom")]
    empty = node._replace(frames=(values[0]._replace(default=""), values[1]))
    assert list(sent_by(empty, "root")) == []


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


def test_the_frames_of_a_robot() -> None:
    naming = make_naming("L2", affix="prefix")
    sent = [edge_of("map", "a/odom"), edge_of("a/odom", "a/base")]
    found = frames_of(inventory_of(XML), sent, naming, "a")
    assert found == ("a/base", "a/wheel", "a/lidar", "a/odom")
    assert frames_of(inventory_of(SDF), [], naming, "a") == ("base",)
