# SPDX-License-Identifier: Apache-2.0
"""The pure half of a snapshot: the file, the environment, how answers of the graph fit together."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any, NamedTuple

import pytest
from hypothesis import given, strategies as st
from paths import ROOT

from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.base.wording import SEVERAL, shorten
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.producers.ros import child
from multibot_rewrite.producers.ros.assemble import (
    LastChange,
    ObservationClock,
    cut_short,
    endpoints_with_process,
    nodes_with_process,
    not_heard,
    processes_by_node,
    so_far,
    topics_to_query,
    why_settled,
)
from multibot_rewrite.producers.ros.queries import TopicQueries, with_topic_details
from multibot_rewrite.producers.ros.request import Request, from_text, to_text
from multibot_rewrite.producers.ros.tf_subscriptions import TfSubscriptions
from multibot_rewrite.system.environment import (
    settings,
)
from multibot_rewrite.system.json import from_json, to_json
from multibot_rewrite.system.records import (
    EXPECTED,
    MAY,
    QUIET,
    RUNS,
    TIMEOUT,
    Caveat,
    Edge,
    End,
    Environment,
    Node,
    Qos,
    System,
    incomplete,
)

QOS = Qos("UNKNOWN", 0, "RELIABLE", "VOLATILE", math.inf, 10.0, "AUTOMATIC", math.inf)
HARMLESS = Caveat("frames-not-read", False, "tf2_msgs is not there")
AROUND = Environment(
    7, "LOCALHOST", ("10.0.0.1",), "rmw_fastrtps_cpp", "", False, 2, QUIET, 3.61, (HARMLESS,)
)


def end(node: str, name: str, role: str = "publishes", **more: Any) -> End:
    kind = {"publishes": "topic", "subscribes": "topic"}.get(role, "service")
    type_ = "std_msgs/msg/String"
    return End(kind, role, name, type_, "", node, None, "")._replace(**more)


SNAPSHOT = System(
    (Node("/robot1/amcl", "01aa"), Node("/robot1/amcl", "01bb")),
    (
        end("/robot1/amcl", "/robot1/scan", "subscribes", qos=QOS, process="01aa"),
        end("/robot1/amcl", "/robot1/amcl/get_state", "serves"),
        end("/robot1/amcl", "/robot1/go", "serves", kind="action"),
    ),
    (
        Edge("base_link/ä", "odom", "/robot1/tf", False, ("/robot1/amcl",)),
        Edge("imu", "base_link", "/robot1/tf", True, (), False, (0.5, -1, 2e-9, 0, 0, 0, 1)),
    ),
    AROUND,
)


# --- the file


def test_a_snapshot_survives_the_file() -> None:
    assert from_json(to_json(SNAPSHOT), "graph.json") == SNAPSHOT


TEXT = st.text(st.characters(codec="utf-8"), max_size=8)
NAME = TEXT.map("/{}".format)
SURE = st.sampled_from([RUNS, MAY])
TIME = st.floats(0, 1e6) | st.just(math.inf)


@pytest.mark.slow
@given(
    st.builds(Node, NAME, TEXT, sure=SURE),
    st.builds(Qos, TEXT, st.integers(), TEXT, TEXT, TIME, TIME, TEXT, TIME),
    st.builds(
        Edge,
        *(TEXT, TEXT, NAME, st.booleans(), st.lists(NAME).map(tuple), st.booleans()),
        st.just(()) | st.tuples(*[st.floats(-1e3, 1e3)] * 7),
        sure=SURE,
    ),
    st.builds(Caveat, TEXT, st.booleans(), TEXT),
)
def test_any_snapshot_survives_the_file(node: Node, qos: Qos, frame: Edge, caveat: Caveat) -> None:
    ends = (end(node.name, "/x", qos=qos, process=node.process),)
    any_ = System((node, node), ends, (frame,), AROUND._replace(caveats=(caveat,)))
    assert from_json(to_json(any_), "graph.json") == any_


def changed(*path: str | int, to: Any = ...) -> bytes:
    """Return the snapshot's JSON with the value at ``path`` replaced, or taken out."""
    value = json.loads(to_json(SNAPSHOT))
    inner = value
    for key in path[:-1]:
        inner = inner[key]
    if to is ...:
        del inner[path[-1]]
    else:
        inner[path[-1]] = to
    return json.dumps(value).encode()


# The keys of a node, wherever it stands.
NODE_OBJECT = {"name": "/a", "process": ""}


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"{", "g.json:1:2: not valid JSON"),
        (b"\xff", "g.json: not valid JSON: it is not UTF-8; use"),
        (b"[" * 100_000, "g.json:1:1: not valid JSON: it is nested deeper than 100 levels"),
        (b"[]", "g.json: no plan or snapshot, but []; use the file that"),
        (changed("schema"), "g.json: schema: expected 3, not null; write it again with"),
        (changed("schema", to=4), "g.json: schema: expected 3, not 4"),
        (changed("schema", to=True), "g.json: schema: expected 3, not true"),
        (changed("nodes", to={}), "g.json: nodes: expected a list, not {}"),
        (changed("nodes", 1, to="x"), 'g.json: nodes[1]: expected an object, not "x"'),
        (changed("nodes", 1, "name"), "g.json: nodes[1].name: missing"),
        (changed("nodes", 0, "name", to="a"), "nodes[0].name: expected a full name that starts"),
        (changed("nodes", 0, "pid", to=3), "g.json: nodes[0].pid: unknown key"),
        (changed("ends", 0, "kind", to="topik"), "one of topic, service, action, not"),
        (changed("ends", 0, "role", to=None), "ends[0].role: expected one of publishes"),
        (changed("ends", 0, "qos", "depth", to="1"), "qos.depth: expected a whole number"),
        (changed("ends", 0, "qos", "depth", to=True), "qos.depth: expected a whole number"),
        (changed("ends", 0, "qos", "deadline", to="x"), "deadline: expected a number or null"),
        (
            changed("ends", 0, "qos", "deadline", to=10**400),
            "a number of 401 characters",
        ),
        (b"[" + b"1" * 5000 + b"]", "g.json:1:2: not valid JSON: a number of 5,000"),
        (changed("ends", 0, "qos", "deadline", to=math.nan), "deadline: expected a number"),
        (changed("edges", 0, "static", to=1), "edges[0].static: expected true or false, not 1"),
        (changed("edges", 0, "publishers", 0, to=1), "edges[0].publishers[0]: expected text"),
        (
            changed("edges", 1, "transform", to=[1, 2, 3]),
            "edges[1].transform: expected 7 numbers",
        ),
        (
            changed("edges", 1, "transform", to=[None] * 6),
            "edges[1].transform: expected 7 numbers",
        ),
        (changed("edges", 1, "transform", 0, to=1e200), "edges[1].transform: expected 7 numbers"),
        (changed("edges", 1, "transform", 3, to="x"), "transform[3]: expected a number"),
        (changed("ends", 0, to=NODE_OBJECT), "g.json: ends[0].kind: missing"),
        (
            changed("edges", 0, to=NODE_OBJECT),
            "g.json: edges[0].name: unknown key; the keys are child",
        ),
        (changed("environment", to=NODE_OBJECT), "g.json: environment.name: unknown key"),
        (changed("environment", to=None), "g.json: environment: expected an object"),
        (changed("environment", "settled", to="yes"), "expected one of expected, quiet, timeout"),
        (changed("environment", "caveats", 0, "code"), "environment.caveats[0].code: missing"),
    ],
)
def test_a_wrong_file_is_reported_with_its_key(data: bytes, message: str) -> None:
    with pytest.raises(InputError) as error:
        from_json(data, "g.json")
    assert str(error.value).startswith("g.json")
    assert message in str(error.value)
    assert "\n" not in str(error.value)


# --- the environment


@pytest.mark.parametrize("word", ["abc", "-1", "1.5", "233", "0x", "08", "7 ", "99999999999"])
def test_a_wrong_domain_is_reported_before_rcl_exits(word: str) -> None:
    with pytest.raises(UsageError, match=r"ROS_DOMAIN_ID.*give 0 to 232"):
        settings({"ROS_DOMAIN_ID": word})


# --- is the view whole?


def test_every_caveat_is_documented() -> None:
    root = ROOT
    rooms = ("system", "live", *(f"producers/{it}" for it in ("bags", "ros", "rosgraph", "zenoh")))
    files = (it for room in rooms for it in (root / "multibot_rewrite" / room).rglob("*.py"))
    source = "".join(it.read_text() for it in files)
    page = (root / "docs/snapshot.md").read_text().partition("## Limitations")[2]
    assert set(
        re.findall(
            r'(?:Caveat\(\s*|(?:BUSY_MACHINE|WAITED_FOR|SILENT|WITHOUT_READERS) = )"([\w-]+)"',
            source,
        )
    ) == set(re.findall(r"`([a-z]+-[\w-]+)`", page))


def test_a_long_list_is_cut() -> None:
    assert shorten(["a", "b"], SEVERAL) == "a, b"
    assert shorten(list("abcdefgh"), SEVERAL) == "a, b, c, d, e and 3 more"


# --- when to stop, what to ask, how it fits together


def test_what_is_seen_so_far_is_said_with_its_namespaces() -> None:
    assert so_far([]) == "0 nodes so far"
    assert so_far(["/a"]) == "1 node so far"
    assert so_far(["/r2/x/a", "/b", "/r1/a", "/r1/b"]) == "4 nodes in r1, r2 so far"


def test_what_the_timeout_left_out_is_named() -> None:
    """A topic that one node publishes and nobody reads is not asked for; nor is a service."""
    said = "the timeout was over before the QoS of all topics was read"
    ends = [end("/a", "/x"), end("/b", "/x", "subscribes"), end("/a", "/one")]
    ends.append(end("/a", "/s", "serves"))
    (found,) = cut_short(["/a", "/b"], ends)
    assert found == Caveat("cut-short", True, f"{said} (/x); give a longer --timeout")
    (known,) = cut_short(["/a", "/b"], [it._replace(qos=QOS) for it in ends])
    assert known == Caveat("cut-short", True, f"{said}; give a longer --timeout")
    said = "the timeout was over before messages could come"
    assert [*not_heard(["/tf"]), *not_heard([])] == [
        Caveat("cut-short", True, f"{said} on /tf; give a longer --timeout"),
        Caveat("cut-short", True, f"{said}; give a longer --timeout"),
    ]


@pytest.mark.parametrize(
    ("now", "changed_", "complete", "why"),
    [
        (0.8, (0.7, 0.2), True, EXPECTED),
        (0.8, (0.7, 0.4), True, ""),
        (0.7, (0.2, 0.1), False, ""),
        (3.4, (0.0, 0.0), False, ""),
        (3.5, (0.0, 0.0), False, QUIET),
        (5.0, (2.0, 0.0), False, ""),
        (9.0, (8.0, 0.0), False, TIMEOUT),
        (9.0, (5.5, 0.0), False, QUIET),
    ],
)
def test_when_the_observation_ends(
    now: float, changed_: tuple[float, float], complete: bool, why: str
) -> None:
    assert why_settled(now, LastChange(*changed_), complete, 9.0) == why


@pytest.mark.parametrize(
    ("expected", "met", "of"),
    [
        (("/a",), True, [True, False]),
        (("/a", "/b"), True, [True, True]),
        (("/a", "/c"), False, [True, False]),
        (("/a", "/one"), True, [True, False]),
        (("/a", "/two"), True, [True, True]),
        (("/two",), True, [False, True]),
        ((), False, [False, False]),
    ],
)
def test_what_is_expected_is_there(expected: tuple[str, ...], met: bool, of: list[bool]) -> None:
    ends = [end("/a", "/one"), end("/b", "/two")]
    asked = Request(9.0, expected)
    assert asked.is_met(ends) == met
    assert [asked.expects(it) for it in ends] == of


TOPICS = {
    "/both": ["std_msgs/msg/String"],
    "/one": ["std_msgs/msg/String"],
    "/nobody": ["std_msgs/msg/String"],
    "/robot1/tf": ["tf2_msgs/msg/TFMessage"],
    "/robot1/amcl_pose": ["geometry_msgs/msg/PoseWithCovarianceStamped"],
    "/robot1/map": ["nav_msgs/msg/OccupancyGrid"],
    "/rosout": ["rcl_interfaces/msg/Log"],
}
ENDS = [
    end("/a", "/both"),
    end("/b", "/both", "subscribes"),
    *(
        end("/a", name)
        for name in ("/one", "/robot1/tf", "/robot1/amcl_pose", "/robot1/map", "/rosout")
    ),
]


def test_two_nodes_of_one_name_hide_topics_so_all_are_queried() -> None:
    assert topics_to_query(["/a", "/a", "/b"], ENDS, TOPICS, []) == sorted(TOPICS)


def test_nodes_of_one_name_are_spread_over_its_processes() -> None:
    groups = processes_by_node([end("/a", "/x", process="1"), end("/a", "/x", process="2")])
    assert nodes_with_process(["/a", "/b", "/a"], groups) == [
        Node("/a", "1"),
        Node("/a", "2"),
        Node("/b", ""),
    ]
    # Both in one process: that is where they are.
    assert nodes_with_process(["/a", "/a"], {"/a": ["1"]}) == [Node("/a", "1")] * 2


def test_an_endpoint_gets_its_nodes_process_only_beyond_doubt() -> None:
    ends = [end("/a", "/x"), end("/b", "/x"), end("/b", "/y", process="2")]
    placed = endpoints_with_process(ends, {"/a": ["1"], "/b": ["1", "2"]})
    assert [(it.node, it.name, it.process) for it in placed] == [
        ("/a", "/x", "1"),
        ("/b", "/x", ""),
        ("/b", "/y", "2"),
    ]


def test_a_transform_has_the_numbers_that_came_last() -> None:
    session = TfSubscriptions(
        lambda _topic, _type, _latched, callback: calls.append(callback) or bool
    )
    calls: list[Any] = []
    qos = QOS._replace(durability="VOLATILE")
    ends = [end("/a", "/tf", type="tf2_msgs/msg/TFMessage", qos=qos)]
    session.update(ends, False)
    for x in (1.0, 2.123456789123):
        calls[0](SimpleNamespace(transforms=[stamped("odom", "base", x)]), None)
    for name, x in {"imu": math.nan, "gps": math.inf, "lost": -1e13}.items():
        calls[0](SimpleNamespace(transforms=[stamped("base", name, x)]), None)
    found = session.edges(ends)
    assert {it.child: it.transform for it in found} == {
        "base": (2.123456789, 0, 0, 0, 0, 0, 1),
        **dict.fromkeys(("imu", "gps", "lost"), (math.inf, 0, 0, 0, 0, 0, 1)),
    }


def stamped(parent: str, child: str, x: float) -> SimpleNamespace:
    """Return a transform as a message has it."""
    at = SimpleNamespace(x=x, y=0.0, z=0.0)
    turn = SimpleNamespace(x=0.0, y=0.0, z=0.0, w=1.0)
    return SimpleNamespace(
        header=SimpleNamespace(frame_id=parent, stamp=0.0), child_frame_id=child,
        transform=SimpleNamespace(translation=at, rotation=turn),
    )  # fmt: skip


def test_a_request_survives_the_command_line() -> None:
    request = Request(2.5, ("/a", "/x"))
    assert from_text(to_text(request)) == request


# --- the command, as far as it goes without ROS


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--domain", "233"], "'233' is not a domain, give 0 to 232"),
        (["--timeout", "0"], "'0' is not a time"),
        (["--timeout", "nan"], "'nan' is not a time"),
        (["--expect", "drive"], "'drive' is not a full name, give for example /drive"),
    ],
)
def test_a_wrong_option_is_one_line(
    arguments: list[str], message: str, capfd: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as end_:
        main(["snapshot", *arguments])
    assert end_.value.code == 2
    assert message in capfd.readouterr().err


def test_a_wrong_domain_of_the_environment_is_one_line(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "300")
    file = tmp_path / "graph.json"
    assert main(["snapshot", "-o", str(file)]) == 2
    (line,) = capfd.readouterr().err.splitlines()
    assert "ROS_DOMAIN_ID=300 is too high" in line
    assert not file.exists()


# --- a machine that is busy, a look that has no more time


def late_by(*seconds: float) -> ObservationClock:
    """Return the clock after polls of a tenth of a second that came so much later than planned."""
    clock = ObservationClock()
    for late in seconds:
        clock = clock.after(clock.last + 0.1 + late, 0.1)
    return clock


def test_a_look_that_is_late_again_and_again_is_starved() -> None:
    (caveat,) = late_by(*[0.3] * 40).starved()
    assert (caveat.code, caveat.incomplete) == ("busy-machine", True)
    assert "75% of its time" in caveat.message
    assert not [*late_by(*[0.05] * 40).starved()]
    # A laptop that was closed is no busy machine.
    assert not [*late_by(60.0, *[0.0] * 40).starved()]


class Rows(NamedTuple):
    """What rclpy tells of a topic's publishers and subscriptions: nothing; ``asked`` counts."""

    asked: list[str]

    def get_topic_names_and_types(self) -> list[tuple[str, list[str]]]:
        return [(f"/t{at}", ["std_msgs/msg/String"]) for at in range(9)]

    def get_fully_qualified_name(self) -> str:
        return "/look"

    def get_publishers_info_by_topic(self, topic: str) -> list[object]:
        self.asked.append(topic)
        return []

    def get_subscriptions_info_by_topic(self, topic: str) -> list[object]:
        return []


def test_slow_queries_end_with_the_time() -> None:
    node = Rows([])
    found = [end("/a", f"/t{at}", role) for at in range(9) for role in ("publishes", "subscribes")]
    asked = TopicQueries((), {}, lambda: len(node.asked) >= 4)
    left = with_topic_details(node, ["/a"], found, asked)
    assert node.asked == ["/t0", "/t1", "/t2", "/t3"]
    # What was not asked is as it was known before.
    assert {it.name for it in left} == {f"/t{at}" for at in range(4, 9)}


TWINS = SNAPSHOT._replace(nodes=(Node("/a", "p"), Node("/a", "q")))


@pytest.mark.parametrize(("took", "looks"), [(5.0, [15.0, 10.0]), (8.0, [15.0]), (16.0, [15.0])])
def test_a_second_look_has_the_time_that_is_left(
    took: float, looks: list[float], monkeypatch: pytest.MonkeyPatch
) -> None:
    now, asked = [0.0], []

    def look(request: Request, environ: object, tell: object) -> System:
        asked.append(request.timeout)
        now[0] += took
        return TWINS._replace(environment=AROUND._replace(seconds=took, caveats=()))

    monkeypatch.setattr(child, "_observe_once", look)
    monkeypatch.setattr(child.time, "monotonic", lambda: now[0])
    seen = child.observe(Request(15.0), {})
    assert asked == looks
    assert [it.code for it in incomplete(seen)] == ["no-second-look"] * (len(looks) == 1)


@pytest.mark.parametrize(("first", "looks"), [((), 2), ((Node("/a", "p"),), 1)])
def test_an_empty_view_is_looked_at_again(
    first: tuple[Node, ...], looks: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    around = AROUND._replace(seconds=3.0, caveats=())
    full = SNAPSHOT._replace(nodes=(Node("/a", "p"),), ends=(), environment=around)
    views = [full, full._replace(nodes=first)]
    monkeypatch.setattr(child, "_observe_once", lambda *_: views.pop())
    assert child.observe(Request(15.0), {}).nodes == full.nodes
    assert len(views) == 2 - looks


def test_nothing_is_planned_by_a_graph_without_nodes(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = str(tmp_path / "graph.json")
    Path(file).write_bytes(to_json(System(environment=Environment(settled="quiet"))))
    assert main(["check", file, "--from", file]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert f"{file}: no node ran when this snapshot was taken; take one" in line
