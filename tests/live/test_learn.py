# SPDX-License-Identifier: Apache-2.0
"""``multibot snapshot --output-kind nodes``: a graph becomes facts, whose tables serve the code."""

from __future__ import annotations

import random
from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from pathlib import Path

import pytest
from hypothesis import given, strategies as st
from named_ends import named_ends
from paths import FIXTURES

from multibot_rewrite.base.model import ProofError, UsageError
from multibot_rewrite.base.naming import Naming, make_naming
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.base.rosnames import bind, expand, resolve_bound
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.fleet.fleet import NO_STATE_PUBLISHER
from multibot_rewrite.knowledge.node_library import NodeLibrary, nodes_of_set
from multibot_rewrite.knowledge.node_sets import built_in, user_library
from multibot_rewrite.knowledge.records import MANAGER, TRANSPORTS, Endpoint, NodeFacts
from multibot_rewrite.live.learning.choosing import choose_nodes
from multibot_rewrite.live.learning.learn import LearnedNode, learn
from multibot_rewrite.live.learning.nodes_file import to_yaml
from multibot_rewrite.planning.of_runs import expanded, parsed
from multibot_rewrite.planning.records import Table
from multibot_rewrite.planning.table import build_table
from multibot_rewrite.system.json import to_json
from multibot_rewrite.system.records import (
    ACTION,
    CALLS,
    PUBLISHES,
    QUIET,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    Caveat,
    End,
    Environment,
    Node,
    System,
)
from multibot_rewrite.system.words import is_tool

LAYOUTS = ("L1", "L2", "L3", "L4")
ROBOTS = ("robot1", "robot2")
# The parts without the nodes: nobody described these.
UNKNOWN = NodeLibrary(built_in(NEWEST_LTS).parts, {}, {})
TEXT, IMAGE, TRIGGER = "std_msgs/msg/String", "sensor_msgs/msg/Image", "std_srvs/srv/Trigger"
FETCH = "acme_msgs/action/Fetch"
EVERY_NODE = tuple(end for end in built_in(NEWEST_LTS).parts["every_node"] if end.name != "/clock")


# Node, kind, role and name.
Led = tuple[str, str, str, str]


# ---------------------------------------------------------------- what a graph shows of a node


def environment(*caveats: Caveat) -> Environment:
    return Environment(0, "LOCALHOST", (), "rmw_fastrtps_cpp", "", False, 4, QUIET, 3.5, caveats)


def graph(*nodes: NodeFacts, base: str = "", process: str = "") -> System:
    """Return the view of nodes without any rule below ``base``, in one process or in several."""
    found = [(node, *placed(node, base)) for node in nodes]
    seen = [Node(f"{space.rstrip('/')}/{own}", process or node.name) for node, space, own in found]
    ends = [end for one in found for end in shown(*one)]
    return System(tuple(seen), tuple(ends), (), environment())


def placed(node: NodeFacts, base: str) -> tuple[str, str]:
    """Namespace and own name."""
    above, _, own = node.name.rpartition("/")
    return f"{base}/{above}".rstrip("/") or "/", own


def shown(node: NodeFacts, space: str, own: str) -> Iterator[End]:
    for end in node.endpoints:
        full = expand(end.name, space, own)
        for kind, role, name, type_ in parts_of(end._replace(name=full)):
            yield End(kind, role, name, type_, "", f"{space.rstrip('/')}/{own}", None, "")


def parts_of(end: Endpoint) -> Iterator[tuple[str, str, str, str]]:
    """Yield an endpoint as the middleware has it, and the record of the action."""
    yield end.kind, end.role, end.name, end.type
    topic = PUBLISHES if end.role in (SERVES, PUBLISHES) else SUBSCRIBES
    if end.kind == ACTION:
        hidden = f"{end.name}/_action"
        yield SERVICE, end.role, f"{hidden}/send_goal", f"{end.type}_SendGoal"
        yield SERVICE, end.role, f"{hidden}/get_result", f"{end.type}_GetResult"
        yield SERVICE, end.role, f"{hidden}/cancel_goal", "action_msgs/srv/CancelGoal"
        yield TOPIC, topic, f"{hidden}/feedback", f"{end.type}_FeedbackMessage"
        yield TOPIC, topic, f"{hidden}/status", "action_msgs/msg/GoalStatusArray"
    if end.transport:
        for transport in TRANSPORTS:
            name = f"{end.name}/{transport}"
            yield TOPIC, topic, name, "sensor_msgs/msg/CompressedImage"


def learned(
    seen: System, *names: str, base: str = "/", library: NodeLibrary = UNKNOWN
) -> tuple[LearnedNode, ...]:
    """Return what is learned, verified to survive the file."""
    found = learn(seen, choose_nodes(seen, names, base), base, library)
    assert to_yaml(found, "mine", library)
    return found


def one(seen: System, *names: str, base: str = "/", library: NodeLibrary = UNKNOWN) -> LearnedNode:
    (found,) = learned(seen, *names, base=base, library=library)
    return found


def node(*ends: Endpoint, name: str = "driver") -> NodeFacts:
    return NodeFacts(name, "", ends)


def publishes(name: str, type_: str = TEXT, **more: object) -> Endpoint:
    return Endpoint(TOPIC, PUBLISHES, name, type_)._replace(**more)  # type: ignore[arg-type]


def subscribes(name: str, type_: str = TEXT) -> Endpoint:
    return Endpoint(TOPIC, SUBSCRIBES, name, type_)


def spelled(found: LearnedNode) -> list[tuple[str, str]]:
    return [(end.role, end.name) for end in found.own]


def with_end(seen: System, *ends: tuple[str, str, str, str, str]) -> System:
    """With more endpoints: node, kind, role, name, type."""
    more = tuple(End(k, r, name, type_, "", who, None, "") for who, k, r, name, type_ in ends)
    return seen._replace(ends=(*seen.ends, *more))


# ---------------------------------------------------------------- the tables serve the code


def bare(node: NodeFacts) -> NodeFacts:
    """Return the node as its code is: without what a launch file changes, each graph name once."""
    # That a node itself asks above its namespace, or beside an image, is seen in no graph.
    plain = [end for end in node.endpoints if "<" not in end.name]
    ends = [end._replace(remapped="", fixed="", above="", beside="") for end in plain]
    inner = {(kind, name) for end in ends for kind, name in list(expanded(end))[1:]}
    kept = dict.fromkeys(end for end in ends if (end.kind, end.name) not in inner)
    return node._replace(shared=False, endpoints=tuple(kept))


def said(table: Table) -> set[Led]:
    """Where the table says that names lead."""
    return {(n.node, n.endpoint.kind, n.endpoint.role, n.name) for n in named_ends(table)}


def led(nodes: Iterable[NodeFacts], table: Table) -> set[Led]:
    """Where the graph names of the code lead under the table's rules."""
    found = set()
    facts = {node.name: node for node in nodes}
    for one in (one for one in table.runs if one.robot):
        bound = bind(one.name, one.namespace, parsed(one.rules))
        for end in facts[one.node].endpoints:
            for kind, name in expanded(end):
                full = f"{one.namespace.rstrip('/')}/{one.name}"
                found.add((full, kind, end.role, resolve_bound(name, kind, bound)))
    return found


def assert_served(
    nodes: Sequence[NodeFacts], base: str, library: NodeLibrary, naming: Naming
) -> None:
    """Learned from one robot without rules, the table is that of the facts, and its rules serve."""
    seen = graph(*nodes, base=base)
    names = [node.name for node in seen.nodes]
    found = learned(seen, *names, base=base or "/", library=library)
    real = build_table(ROBOTS, nodes, naming, release=NEWEST_LTS)
    table = build_table(ROBOTS, [node.facts for node in found], naming, release=NEWEST_LTS)
    assert said(table) == said(real)
    assert led(nodes, table) == led(nodes, real)
    assert set(table.problems) <= set(real.problems)


# It subscribes to `tf` of its namespace; whether its code or a rule has that name cannot be seen.
BOTH_TREES = "tf_namespace_bridge"


@cache
def node_sets() -> dict[str, list[NodeFacts]]:
    """Every node set and node that is known, as its code is; one node set only leaves a node out."""
    library = built_in(NEWEST_LTS)
    names = sorted({*library.node_sets, *library.nodes} - {NO_STATE_PUBLISHER, BOTH_TREES})
    return {name: [*map(bare, _with_managers(nodes_of_set(library, name)))] for name in names}


def _with_managers(nodes: Sequence[NodeFacts]) -> Iterator[NodeFacts]:
    """Without what is called of a manager that is not among them: no graph shows that it is a node."""
    runs = {it.name for it in nodes}
    for node in nodes:
        ends = (it for it in node.endpoints if MANAGER in runs or f"{MANAGER}/" not in it.name)
        yield node._replace(endpoints=tuple(ends))


@pytest.mark.sample(8)
@pytest.mark.slow
@pytest.mark.parametrize("affix", ["postfix", "prefix"])
@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("base", ["", pytest.param("/old", marks=pytest.mark.deep)])
def test_every_known_node_set_is_learned_as_it_is_described(
    base: str, layout: str, affix: str
) -> None:
    naming = make_naming(layout, affix)
    for nodes in node_sets().values():
        assert_served(nodes, base, built_in(NEWEST_LTS), naming)


# Written without ``~`` below the node's own name, which only who knows the code can tell.
LITERAL = {"nav2_slam", "nav2_slam_composed", "slam_toolbox"}


@pytest.mark.sample(8)
@pytest.mark.slow
@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("base", ["", pytest.param("/old", marks=pytest.mark.deep)])
def test_every_node_set_is_learned_where_nothing_is_known(base: str, layout: str) -> None:
    for name, nodes in node_sets().items():
        if name not in LITERAL or layout != "L4":
            # Nor can it be seen that the code of a node places it.
            seen = [node._replace(apart=False) for node in nodes]
            assert_served(seen, base, UNKNOWN, make_naming(layout))


TOKENS = st.sampled_from(["scan", "cmd_vel", "image", "goal", "tf", "clock", "a1"])
PATHS = st.lists(TOKENS, min_size=1, max_size=3).map("/".join)
# A relative name of a shared topic looks as an absolute one does, in the root.
SHARED = {"tf", "clock"}


@st.composite
def endpoints(draw: st.DrawFn) -> Endpoint:
    lead = draw(st.sampled_from(["", "/", "~/"]))
    path = draw(PATHS.filter(lambda path: lead or path not in SHARED))
    kind = draw(st.sampled_from([TOPIC, SERVICE, ACTION]))
    role = draw(st.sampled_from([PUBLISHES, SUBSCRIBES] if kind == TOPIC else [SERVES, CALLS]))
    image = kind == TOPIC and draw(st.booleans())
    type_ = {TOPIC: IMAGE if image else TEXT, SERVICE: TRIGGER, ACTION: FETCH}[kind]
    return Endpoint(kind, role, f"{lead}{path}", type_, transport=image and draw(st.booleans()))


NAMES = st.sampled_from(["driver", "planner", "lower/costmap", "lower/deep/eye"])


@st.composite
def robots(draw: st.DrawFn) -> list[NodeFacts]:
    names = draw(st.lists(NAMES, min_size=1, max_size=4, unique=True))
    ends = st.lists(endpoints(), max_size=6, unique_by=lambda end: (end.role, end.name.strip("~/")))
    return [bare(NodeFacts(name, "", tuple(draw(ends)))) for name in names]


@pytest.mark.slow
@given(
    nodes=robots(),
    base=st.sampled_from(["", "/old", "/fleet/old"]),
    layout=st.sampled_from(LAYOUTS),
    affix=st.sampled_from(["postfix", "prefix"]),
)
def test_any_robot_is_learned_as_it_is(
    nodes: list[NodeFacts], base: str, layout: str, affix: str
) -> None:
    assert_served(nodes, base, UNKNOWN, make_naming(layout, affix))


@pytest.mark.slow
@given(nodes=robots(), seed=st.integers())
def test_the_file_does_not_depend_on_the_order_of_the_snapshot(
    nodes: list[NodeFacts], seed: int
) -> None:
    seen = graph(*nodes)
    mixed = random.Random(seed)
    other = seen._replace(
        nodes=tuple(mixed.sample(seen.nodes, len(seen.nodes))),
        ends=tuple(mixed.sample(seen.ends, len(seen.ends))),
    )
    texts = {to_yaml(learned(it), "mine", UNKNOWN) for it in (seen, other)}
    assert len(texts) == 1


# ---------------------------------------------------------------- spelling


def test_two_names_with_the_same_name_in_code_become_one() -> None:
    seen = graph(node(name="eye/camera"), base="/old")
    who = "/old/eye/camera"
    seen = with_end(
        seen, (who, TOPIC, SUBSCRIBES, "/old/x", TEXT), (who, TOPIC, SUBSCRIBES, "/x", IMAGE)
    )
    (end,) = one(seen, base="/old").own
    assert (end.name, end.type, end.also) == ("/x", IMAGE, (TEXT,))
    assert end.note == "also seen as /x"


# ---------------------------------------------------------------- what is one thing


def test_who_listens_to_an_action_is_no_client_of_it() -> None:
    """rcl lists everybody who subscribes to the feedback among the clients."""
    whole = graph(node(Endpoint(ACTION, CALLS, "fetch", FETCH)))
    seen = whole._replace(ends=tuple(e for e in whole.ends if e.kind != SERVICE))
    found = one(seen)
    assert [(end.kind, end.name) for end in found.own] == [
        (TOPIC, "/fetch/_action/feedback"), (TOPIC, "/fetch/_action/status"),
    ]  # fmt: skip


def test_an_action_and_a_service_of_one_name_become_one() -> None:
    own = node(
        Endpoint(ACTION, SERVES, "fetch", FETCH), Endpoint(SERVICE, SERVES, "fetch", TRIGGER)
    )
    (end,) = one(graph(own)).own
    assert (end.kind, end.note) == (ACTION, "there is a service with this name too")


def test_what_every_node_has_is_a_part_where_it_is_whole() -> None:
    clock = Endpoint(TOPIC, SUBSCRIBES, "/clock", "rosgraph_msgs/msg/Clock")
    description = Endpoint(
        SERVICE, SERVES, "~/get_type_description", "type_description_interfaces/srv/X"
    )
    found = one(graph(node(*EVERY_NODE, clock, description, publishes("x"))))
    assert (found.parts, spelled(found)) == (("every_node",), [(PUBLISHES, "/x")])
    # rclpy does not listen to /parameter_events.
    some = [end for end in EVERY_NODE if end.role != SUBSCRIBES]
    found = one(graph(node(*some, clock, description, publishes("x"))))
    assert (found.parts, spelled(found)) == ((), [(PUBLISHES, "/x"), (SUBSCRIBES, "/clock")])
    assert found.own[1].when == "run: simulated"


# ---------------------------------------------------------------- helper nodes

LISTENER = NodeFacts(
    "transform_listener_impl_55d0c0ffee",
    "",
    (*built_in(NEWEST_LTS).parts["tf_listener"], *EVERY_NODE),
)


def test_a_hidden_node_has_no_helper() -> None:
    found = one(graph(node(publishes("x")), node(name="_hidden"), LISTENER, process="p"))
    assert (found.parts, found.remarks) == (("tf_helper",), ())


# ---------------------------------------------------------------- which nodes


# What people run beside a robot: no part of it, whatever namespace it runs in.
BESIDE = [
    "rosbridge_websocket", "rosapi", "tf2_echo", "teleop_twist_keyboard", "joy_node", "gazebo",
    "ros_gz_bridge", "spawner_arm_controller", "static_transform_publisher_x7", "my_container",
]  # fmt: skip


@pytest.mark.parametrize("tool", BESIDE)
def test_what_the_check_ignores_is_not_learned_unless_asked_for_by_name(tool: str) -> None:
    seen = graph(node(name="driver"), node(name=f"r1/{tool}"))
    assert is_tool(f"/r1/{tool}")
    assert choose_nodes(seen, (), "/") == ("/driver",)
    assert choose_nodes(seen, (f"/r1/{tool}",), "/") == (f"/r1/{tool}",)


@pytest.mark.parametrize(
    ("names", "namespace", "said"),
    [
        (["/drivr"], "/", "/drivr: no node has this name; running are /driver"),
        (["/zzz"], "/", "/zzz: no node has this name; running are /driver, /r1/planner"),
        (["/driver"], "/r1", "/driver: it is not below --namespace /r1"),
        ([], "/r2", "there is no node to learn below /r2; running are"),
        ([], "/r 2", "namespace '/r 2': character 3, ' ', is not a letter"),
        (["/twin"], "/", "/twin: 2 nodes have this name; stop all but one"),
        ([], "/", "/twin: 2 nodes have this name"),
    ],
)
def test_nodes_that_cannot_be_learned(names: list[str], namespace: str, said: str) -> None:
    seen = graph(*(node(name=name) for name in ("driver", "r1/planner", "twin", "twin")))
    with pytest.raises(UsageError) as caught:
        choose_nodes(seen, names, namespace)
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("end", "said"),
    [
        ((TOPIC, PUBLISHES, "/a b", TEXT), "topic name '/a b' in the graph: character 3"),
        (
            (SERVICE, PUBLISHES, "/x", TRIGGER),
            "/driver publishes the service /x, which is impossible",
        ),
        ((TOPIC, SERVES, "/x", TEXT), "/driver serves the topic /x, which is impossible"),
    ],
)
def test_an_endpoint_that_no_node_can_have(end: tuple[str, str, str, str], said: str) -> None:
    seen = with_end(graph(node()), ("/driver", *end))
    with pytest.raises(UsageError) as caught:
        learn(seen, ["/driver"], "/", UNKNOWN)
    assert said in str(caught.value)


# ---------------------------------------------------------------- the file


def test_a_file_that_reads_otherwise_is_not_written() -> None:
    found = one(graph(node(publishes("x"))))
    (end,) = found.own
    for wrong in (end._replace(name="/y"), end._replace(type="no type")):
        with pytest.raises(ProofError, match="the learned nodes"):
            to_yaml([found._replace(own=(wrong,))], "mine", UNKNOWN)


# ---------------------------------------------------------------- the command


@pytest.fixture
def shot(tmp_path: Path) -> Path:
    """Return a snapshot of two nodes nobody described, and of a tool."""
    driver = node(
        publishes("odom"), subscribes("/cmd_vel"), Endpoint(ACTION, SERVES, "dock", FETCH)
    )
    eye = node(publishes("~/image", IMAGE, transport=True), *EVERY_NODE, name="eye")
    path = tmp_path / "graph.json"
    path.write_bytes(to_json(graph(driver, eye, node(name="rviz2"))))
    return path


@pytest.mark.more
def test_what_is_learned_gives_the_whole_table(
    shot: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mine = str(tmp_path / "mine.yaml")
    assert (
        main(
            [
                "snapshot",
                "--output-kind",
                "nodes",
                "--from",
                str(shot),
                "--node-set",
                "mine",
                "-o",
                mine,
            ]
        )
        == 0
    )
    note = "left out as tools: /rviz2; to learn one give its name to --node"
    said = f"multibot: note: {note}\nmultibot: 2 nodes learned as node set mine (ROS 2 lyrical)\n"
    assert capsys.readouterr() == ("", said)
    names = [node.name for node in nodes_of_set(user_library(mine, NEWEST_LTS), "mine")]
    assert names == ["driver", "eye"]
    rover = str(FIXTURES / "robots" / "rover.urdf")
    fleet = [rover, "robot1", "robot2", "--nodes", mine, "--node-set", "mine", "--layout"]
    assert main(["plan", "--output-kind=table", *fleet, "frames-per-robot"]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    for rule in ("/cmd_vel -> cmd_vel", "/dock/_action/feedback -> dock/_action/feedback"):
        assert out.count(rule) == len(ROBOTS)


def test_an_incomplete_view_is_written_and_reported(
    shot: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    seen = graph(node(publishes("odom")))
    caveat = Caveat("not-settled", True, "it still changed")
    shot.write_bytes(to_json(seen._replace(environment=environment(caveat))))
    mine = tmp_path / "mine.yaml"
    assert main(["snapshot", "--output-kind", "nodes", "--from", str(shot), "-o", str(mine)]) == 3
    assert "multibot: incomplete: it still changed\n" in capsys.readouterr().err
    assert "/odom" in mine.read_text()


def test_helpers_without_a_node_are_reported(
    shot: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shot.write_bytes(to_json(graph(node(), LISTENER)))
    assert main(["snapshot", "--output-kind", "nodes", "--from", str(shot)]) == 0
    assert "they are left out: /transform_listener_impl_55d0c0ffee" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--node", "driver"], "'driver' is not a full name, give for example /driver"),
        (["--node", "/drivr"], "/drivr: no node has this name; running are /driver"),
        (["--namespace", "old"], "'old' is not a full name"),
        (["--namespace", "/a-b"], "namespace '/a-b': character 3, '-', is not a letter"),
        (["--namespace", "/none"], "there is no node to learn below /none"),
        (["--node-set", ""], "'' is not a name of a node set, give one word"),
        (["--node-set", "a\nb"], "is not a name of a node set, give one word"),
        (["--timeout", "5"], "--timeout is for the live graph, leave out --from"),
        (["--domain", "5"], "--domain is for the live graph, leave out --from"),
        (["--node"], "argument --node: expected one argument"),
        (["--node", "/driver", "/eye"], "unexpected /eye; a list is written A,B"),
        (["-o", "/dev/null/mine.yaml"], "/dev/null is a file; name another folder"),
    ],
)
def test_wrong_use_is_one_line(
    shot: Path, words: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    try:
        code: object = main(["snapshot", "--output-kind", "nodes", "--from", str(shot), *words])
    except SystemExit as end:
        code = end.code
    out, err = capsys.readouterr()
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert said in err


@pytest.mark.parametrize("data", [b"", b"{}", b"[1]", b'{"schema": 1}', b"\xff"])
def test_what_is_no_snapshot_is_one_line(
    shot: Path, data: bytes, capsys: pytest.CaptureFixture[str]
) -> None:
    shot.write_bytes(data)
    assert main(["snapshot", "--output-kind", "nodes", "--from", str(shot)]) == 2
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert err.startswith(f"multibot: {shot}")


# ---------------------------------------------------------------- the file


def test_what_a_node_that_stands_apart_writes_without_a_slash_is_known() -> None:
    written = (publishes("image"), publishes("/whole"), publishes("~/own"))
    known = NodeFacts("eye", "eyes", (*written, publishes("<name>/x")), apart=True)
    library = UNKNOWN._replace(nodes={"eye": known})
    found = one(graph(node(*written, name="eye")), library=library)
    assert spelled(found) == [(PUBLISHES, "/whole"), (PUBLISHES, "image"), (PUBLISHES, "~/own")]
    assert found.remarks == ("known as eye of eyes; as described there",)
    assert found.facts.apart
    more = one(graph(node(*written[1:], publishes("/more"), name="eye")), library=library)
    assert more.remarks == (
        "known as eye of eyes; additional: publishes /more; not seen: publishes image",
    )


FILE = """
nodes:
  # {remark}
  #   {rest}
  lower/driver:
    note: seen as /r/lower/driver
    apart: true
    with: [bond]
    publishes:
      odom: nav_msgs/msg/Odometry
      /two: {{type: std_msgs/msg/String, also: [std_msgs/msg/Empty], note: 'x: y'}}
    serves:
      ~/reset: std_srvs/srv/Trigger

  other:
    note: seen as /other

node_sets:
  mine:
    about: Learned from a running graph
    nodes:
      - lower/driver
      - other
"""


def test_the_file_of_two_nodes() -> None:
    own = (
        publishes("odom", "nav_msgs/msg/Odometry"),
        publishes("/two", also=("std_msgs/msg/Empty",), note="x: y"),
        Endpoint(SERVICE, SERVES, "~/reset", TRIGGER),
    )
    ends = (*own, *UNKNOWN.parts["bond"])
    facts = NodeFacts("lower/driver", "", ends, note="seen as /r/lower/driver", apart=True)
    first = LearnedNode("/r/lower/driver", facts, own, ("bond",), ("word " * 20 + "end",))
    second = LearnedNode("/other", NodeFacts("other", "", (), note="seen as /other"), (), (), ())
    text = to_yaml([first, second], "mine", UNKNOWN)
    head, _, rest = text.partition("# Of: /r/lower/driver /other\n")
    words = ["word"] * 19
    assert rest == FILE.format(remark=" ".join(words), rest="word end")
    assert head.count("\n") == 6 and all(it.startswith("#") for it in head.splitlines())
    assert head.startswith(
        "# Nodes as they were seen in a running graph, written by multibot snapshot"
    )
    lost = first._replace(own=own[:1])
    with pytest.raises(
        ProofError, match=r"^the learned nodes are read back differently: lower/driver$"
    ):
        to_yaml([lost, second], "mine", UNKNOWN)
