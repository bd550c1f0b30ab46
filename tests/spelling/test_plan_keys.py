# SPDX-License-Identifier: Apache-2.0
"""A plan as a file: every key is written, comes back, and is refused where it is wrong."""

from __future__ import annotations

from copy import deepcopy
from typing import Any

import pytest
import yaml

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import InputError
from multibot_rewrite.spelling.plan import robot_words, vacuous
from multibot_rewrite.spelling.plan_file import (
    HEAD,
    is_fleet,
    is_json,
    is_plan,
    read_plan,
    to_json,
    to_yaml,
)
from multibot_rewrite.spelling.plan_value import from_value, value_of
from multibot_rewrite.system.records import (
    MAY,
    PUBLISHES,
    RUNS,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    Edge,
    End,
    Node,
    Parameter,
    Place,
    Robot,
    System,
    Topic,
)

STRING = "std_msgs/msg/String"
EITHER = ("/r1/drive", "/r1/spare")
PLAN = System(
    nodes=(
        Node(
            "/r1/drive",
            robot="r1",
            lifecycle="active",
            host="pc",
            way="plugin",
            taker="/r1/gz",
            sure=RUNS._replace(instead=EITHER),
            place=Place("a.yaml", 3),
            plugin=Place("r.urdf", 7),
        ),
        Node("/r1/arm", robot="r1", sure=MAY, stack="nav2", way="spawner"),
        Node("/r1/spare", robot="r1", sure=MAY._replace(instead=EITHER)),
        Node("/map_server"),
    ),
    ends=(
        End(SERVICE, SERVES, "/map", "", "", "/map_server", None, "", "/map"),
        End(TOPIC, PUBLISHES, "/r1/x", STRING, "", "/r1/drive", None, "", "x", ("a/msg/B",)),
    ),
    edges=(
        Edge("base", "odom", "", False, ("/r1/drive",)),
        Edge("lidar", "base", "", False, ("/r1/drive",)),
    ),
    parameters=(Parameter("/r1/drive", "use_sim_time", "false"),),
    robots=(Robot("r1", ("b1/base",), "/r1/tf", ("b1/gps",), "b1"),),
    topics=(
        Topic("/r1/x", ("/r1/d*",), True, (("durability", "VOLATILE"),), (PUBLISHES,), STRING),
    ),
    layout="tf-per-robot",
    release="jazzy",
    shared_topics=("/clock",),
    shared_frames=("map",),
    ignored_nodes=("helper*",),
    gaps=(
        Finding("MG102", "warning", "nothing sends", "start it", "a.yaml", 3, 5),
        Finding("MG103", "error", "shared", ""),
    ),
)
VALUE: dict[str, Any] = {
    "distro": "jazzy",
    "layout": "tf-per-robot",
    "shared_nodes": {"/map_server": [["serves", "service", "/map", "", "/map"]]},
    "shared_topics": ["/clock"],
    "shared_frames": ["map"],
    "ignored_nodes": ["helper*"],
    "robots": {
        "r1": {
            "tf": "/r1/tf",
            "frames": ["b1/base"],
            "other_frames": ["b1/gps"],
            "optional": ["/r1/arm", "/r1/spare"],
            "spelled": "b1",
            "nodes": {
                "/r1/drive": [["publishes", "topic", "/r1/x", f"{STRING} | a/msg/B", "x"]],
                "/r1/arm": [],
                "/r1/spare": [],
            },
        }
    },
    "topics": {
        "/r1/x": {
            "senders": ["/r1/d*"],
            "one_sender": True,
            "qos": {"durability": "VOLATILE"},
            "bridge": ["publishes"],
            "type": STRING,
        }
    },
    "one_of": [["/r1/drive", "/r1/spare"]],
    "states": {
        "/r1/drive": {"lifecycle": "active", "host": "pc", "parameters": {"use_sim_time": False}}
    },
    "sources": {"/r1/drive": "r.urdf:7"},
    "from": {"/r1/drive": "a.yaml:3", "/r1/arm": "stack nav2"},
    "ways": {"/r1/drive": "plugin /r1/gz", "/r1/arm": "spawner"},
    "sends": {"/r1/drive": "odom -> base, base -> lidar"},
    "open": [
        {
            "code": "MG102",
            "level": "warning",
            "at": "a.yaml:3:5",
            "message": "nothing sends",
            "hint": "start it",
        },
        {"code": "MG103", "level": "error", "at": "", "message": "shared", "hint": ""},
    ],
}


def test_every_key_of_a_plan_is_written_and_comes_back() -> None:
    text = to_yaml(PLAN)
    assert text.startswith(HEAD)
    assert yaml.safe_load(text) == yaml.safe_load(to_json(PLAN)) == VALUE
    assert list(yaml.safe_load(text)) == list(VALUE)
    assert list(VALUE["robots"]["r1"]) == list(yaml.safe_load(text)["robots"]["r1"])
    for data in (text, to_json(PLAN)):
        assert read_plan(data.encode(), "plan") == PLAN


def test_what_is_empty_is_not_written() -> None:
    bare = System(nodes=(Node("/a/x", robot="a"),), robots=(Robot("a"),), layout="both")
    assert yaml.safe_load(to_yaml(bare)) == {
        "layout": "both",
        "shared_nodes": {},
        "shared_topics": [],
        "shared_frames": [],
        "ignored_nodes": [],
        "robots": {"a": {"tf": "/tf", "frames": [], "nodes": {"/a/x": []}}},
    }


def test_the_text_has_a_row_a_line_and_quotes_where_yaml_would_take_it_otherwise() -> None:
    body = to_yaml(PLAN).removeprefix(HEAD)
    assert (
        "      /r1/drive:\n      - [publishes, topic, /r1/x, std_msgs/msg/String | a/msg/B, x]\n"
        in body
    )
    assert "      /r1/arm: []\n" in body
    assert 'ignored_nodes: ["helper*"]\n' in body
    assert "    one_sender: true\n" in body
    assert "  /r1/drive: a.yaml:3\n" in body
    no = System(nodes=(Node("/no", robot="no"),), robots=(Robot("no"), Robot("a: b")), layout="x")
    assert '  "no":\n' in to_yaml(no)
    assert '  "a: b":\n' in to_yaml(no)


def test_json_has_a_robot_a_line() -> None:
    lines = to_json(PLAN).splitlines()
    assert lines[0] == "{"
    assert lines[-4:-2] == [' "robots": {', next(it for it in lines if it.startswith('  "r1": {'))]
    assert lines[-2:] == [" }", "}"]


def without(*path: str) -> dict[str, Any]:
    return changed(path, None, drop=True)


def changed(path: tuple[Any, ...], value: object, drop: bool = False) -> dict[str, Any]:
    """The plan's value with another one at the path."""
    at = copy = deepcopy(VALUE)
    for key in path[:-1]:
        at = at[key]
    at.pop(path[-1]) if drop else at.__setitem__(path[-1], value)
    return copy


ROW = ("shared_nodes", "/map_server", 0)
R1 = ("robots", "r1")


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ([], "the plan is not a mapping"),
        (without("layout"), "the plan: key 'layout' is missing; the keys are layout, shared_nodes"),
        (changed(("lay",), 1), "the plan: unknown key 'lay'; the keys are layout"),
        (changed(("robots",), []), "robots is not a mapping"),
        (changed(("robots",), {}), "no robot is planned, so every graph would be as planned"),
        (without(*R1, "tf"), "robots.r1: key 'tf' is missing"),
        (changed((*R1, "x"), 1), "robots.r1: unknown key 'x'"),
        (changed((*R1, "tf"), "tf"), "robots.r1.tf: 'tf' is not a full name"),
        (changed((*R1, "frames"), "map"), "robots.r1.frames is not a list of names"),
        (changed((*R1, "other_frames"), [1]), "robots.r1.other_frames is not a list of names"),
        (changed((*R1, "optional"), ["/x", 1]), "robots.r1.optional is not a list of names"),
        (changed((*R1, "spelled"), 1), "robots.r1.spelled: write one word"),
        (changed((*R1, "nodes"), {"x": []}), "robots.r1.nodes: 'x' is not a full name"),
        (changed((*R1, "nodes"), {"/x": 1}), "robots.r1.nodes./x is not a list; write []"),
        (changed(("shared_nodes",), {"x": []}), "shared_nodes: 'x' is not a full name"),
        (changed(ROW, ["serves", "service", "/m", ""]), "/map_server[0]: write [role, kind, name"),
        (changed(ROW, ["serves", "service", "/m", "", 1]), "write [role, kind, name, type"),
        (changed(ROW, ["serve", "service", "/m", "", ""]), "'serve', 'service': write a role (pub"),
        (changed(ROW, ["serves", "node", "/m", "", ""]), "'serves', 'node': write a role"),
        (changed(ROW, ["serves", "service", "m", "", ""]), "'m' is not a full name"),
        (changed(("shared_topics",), "/clock"), "shared_topics is not a list of names"),
        (changed(("shared_frames",), [1]), "shared_frames is not a list of names"),
        (changed(("ignored_nodes",), "x"), "ignored_nodes is not a list of names"),
        (changed(("distro",), "jazy"), "distro: "),
        (changed(("topics", "x"), {}), "topics: 'x' is not a full name"),
        (changed(("topics", "/y"), []), "topics./y is not a mapping"),
        (changed(("topics", "/y"), {"sender": []}), "topics./y: "),
        (changed(("topics", "/y"), {"senders": "x"}), "topics./y.senders is not a list"),
        (changed(("topics", "/y"), {"one_sender": 1}), "topics./y.one_sender: write true or false"),
        (changed(("topics", "/y"), {"qos": []}), "topics./y.qos: write words, as"),
        (changed(("topics", "/y"), {"qos": {"durability": 1}}), "topics./y.qos: write words"),
        (
            changed(("topics", "/y"), {"qos": {"durability": "volatile", "history": 1}}),
            "topics./y.qos: write words, as {durability: transient_local}",
        ),
        (changed(("topics", "/y"), {"qos": {"depth": "x"}}), "topics./y.qos: "),
        (changed(("topics", "/y"), {"bridge": []}), "topics./y.bridge: write [publishes], [sub"),
        (changed(("topics", "/y"), {"type": 1}), "topics./y.type: write a type, as sensor_msgs"),
        (changed(("one_of",), {}), "one_of is not a list; write [[NODE, NODE]]"),
        (changed(("one_of",), ["/x"]), "one_of[0] is not a list of names"),
        (changed(("one_of",), [["x"]]), "one_of[0]: 'x' is not a full name"),
        (changed(("one_of",), [["/x"], ["/y", "/x"]]), "one_of[1]: /x is in one_of[0] too; join"),
        (changed(("states",), [1]), "states is not a mapping with names as keys"),
        (changed(("states", "x"), {}), "states.x: 'x' is not a full name"),
        (changed(("states", "/x"), {"life": 1}), "states./x: "),
        (changed(("states", "/x"), {"lifecycle": "on"}), "states./x: lifecycle: "),
        (changed(("states", "/x"), {"host": 1}), "states./x: host: write a word in quotes"),
        (changed(("states", "/x"), {"parameters": [1]}), "states./x.parameters is not a mapping"),
        (
            changed(("states", "/x"), {"parameters": {"a": {}}}),
            "states./x.parameters.a: write a text, a number, true or false, or a list of one",
        ),
        (changed(("states", "/x"), {"parameters": {"a": [None]}}), "states./x.parameters.a: write"),
        (changed(("from", "/x"), 1), "from./x: write a text"),
        (changed(("sends", "/x"), "a, b -> c"), "sends./x: write parent -> child, not 'a, b -> c'"),
        (changed(("open",), {}), "open is not a list; leave it out"),
        (changed(("open", 0), []), "open[0]: write a mapping of code, level, at, message, hint"),
        (changed(("open", 1, "hint"), 1), "open[1]: write texts"),
        (changed(("open", 0, "level"), "bad"), "open[0]: 'bad' is not one of"),
        (changed(("open", 0, "at"), "a.yaml"), "open[0]: at: write file:line, or nothing"),
    ],
)
def test_what_is_wrong_in_a_plan_is_said_with_its_place(value: object, message: str) -> None:
    with pytest.raises(InputError) as raised:
        from_value(value, "p.yaml")
    assert str(raised.value).startswith("p.yaml: ")
    assert message in str(raised.value)


@pytest.mark.parametrize("state", ["unconfigured", "inactive", "active", "finalized"])
def test_a_state_of_a_life_cycle_is_a_primary_one(state: str) -> None:
    """lifecycle_msgs/msg/State."""
    plan = from_value(changed(("states", "/x"), {"lifecycle": state}), "p")
    assert plan.nodes[-1] == Node("/x", lifecycle=state, sure=MAY)


@pytest.mark.parametrize("way", [[PUBLISHES], [SUBSCRIBES], [PUBLISHES, SUBSCRIBES]])
def test_a_bridge_goes_one_way_or_both(way: list[str]) -> None:
    plan = from_value(changed(("topics",), {"/y": {"bridge": way}}), "p")
    assert plan.topics == (Topic("/y", bridge=tuple(way)),)


@pytest.mark.parametrize("policy", ["history", "reliability", "durability", "liveliness"])
def test_a_policy_is_written_in_small_letters(policy: str) -> None:
    plan = from_value(changed(("topics",), {"/y": {"qos": {policy: "volatile"}}}), "p")
    assert plan.topics == (Topic("/y", qos=((policy, "VOLATILE"),)),)


def test_a_node_that_only_another_key_names_may_run_and_is_of_its_namespace() -> None:
    plan = from_value(changed(("one_of",), [["/r1/drive", "/r1/new", "/new"]]), "p")
    assert [(it.name, it.robot, it.sure.word) for it in plan.nodes[-2:]] == [
        ("/r1/new", "r1", "may"),
        ("/new", "", "may"),
    ]


def test_shared_nodes_may_be_names_alone() -> None:
    for names in (["/map_server"], {"/map_server": None}):
        plan = from_value(changed(("shared_nodes",), names), "p")
        assert [it.name for it in plan.nodes if not it.robot] == ["/map_server"]
    assert all(it.robot for it in from_value(changed(("shared_nodes",), None), "p").nodes)


def test_keys_that_may_be_left_out() -> None:
    value = {key: VALUE[key] for key in ("layout", "shared_topics", "shared_frames")}
    value |= {
        "shared_nodes": [],
        "robots": {"a": {"tf": "/tf", "frames": [], "nodes": {"/x": None}}},
    }
    plan = from_value(value, "p")
    assert plan == System(
        nodes=(Node("/x", robot="a"),),
        robots=(Robot("a"),),
        layout="tf-per-robot",
        shared_topics=("/clock",),
        shared_frames=("map",),
    )
    assert value_of(plan).get("distro") is None


def test_a_parameter_that_a_file_sets_is_not_the_plans_own() -> None:
    by_file = Parameter("/r1/drive", "rate", "5", Place("p.yaml", 2))
    value = value_of(PLAN._replace(parameters=(*PLAN.parameters, by_file)))
    assert value["states"] == VALUE["states"]


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"{\n x", "p:2:2: not valid JSON: "),
        (b"layout: [", "p:1:10: not valid YAML: "),
        (b'{"a": "\xff"}', "p: not valid JSON: "),
        (b"layout: \xff", "p: not valid YAML: "),
    ],
)
def test_a_file_that_cannot_be_read(data: bytes, message: str) -> None:
    with pytest.raises(InputError) as raised:
        read_plan(data, "p")
    assert message in str(raised.value)
    assert str(raised.value).endswith("use the file that multibot plan wrote")


def test_a_file_is_told_by_its_first_words() -> None:
    assert is_json(b"\xef\xbb\xbf \n{") and not is_json(b"layout: {}")
    assert is_plan(b"# x\nlayout: both\n") and is_plan(b'{\n "layout": "both"')
    assert not is_plan(b"robots: []\nx-layout: both\n")
    for fleet in (
        b"robots:\n- name: a",
        b"robots: [a]",
        b"robots: # x\n\n# y\n  - a",
        b"include: a",
    ):
        assert is_fleet(fleet)
    for other in (b"robots:\n  a: {}", b"x: [a]", b"  include: a"):
        assert not is_fleet(other)


def test_a_plan_that_tests_nothing_says_so() -> None:
    def idle(*nodes: Node) -> str:
        return vacuous(System(nodes=nodes, robots=(Robot("a"), Robot("b"))))

    assert vacuous(System()) == "no robot is planned"
    assert idle() == "a, b have no node that must run"
    assert idle(Node("/a/x", robot="a"), Node("/b/x", robot="b", sure=MAY)) == (
        "b has no node that must run"
    )
    either = MAY._replace(instead=("/b/x", "/b/y"))
    assert idle(Node("/a/x", robot="a"), Node("/b/x", robot="b", sure=either)) == ""


def test_words_that_stand_for_a_robot() -> None:
    assert robot_words(PLAN) == {"r1": "r1", "b1": "r1"}
    assert robot_words(System(robots=(Robot("a"),))) == {"a": "a"}
