# SPDX-License-Identifier: Apache-2.0
"""Small questions that are asked of the records of a system."""

from __future__ import annotations

import json
from importlib.resources import files
from typing import Any

import pytest
from graph_cases import CASES
from jsonschema import Draft202012Validator
from paths import ROOT

from multibot_rewrite import system_of_description
from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import Edit, InputError
from multibot_rewrite.system import records
from multibot_rewrite.system.environment import machines, why_not_seen
from multibot_rewrite.system.json import from_json, to_json
from multibot_rewrite.system.merging import Look, merged
from multibot_rewrite.system.parameters import (
    Answer,
    Question,
    questions,
    with_answers,
)
from multibot_rewrite.system.record_values import FARTHEST, WrongValue, read_transform, shown
from multibot_rewrite.system.records import (
    MAY,
    NOWHERE,
    PUBLISHES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    Controller,
    Edge,
    End,
    Environment,
    Heard,
    Node,
    Parameter,
    Place,
    Robot,
    System,
    doubts,
    place_of,
)
from multibot_rewrite.system.tf_copies import without_bridged


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("", NOWHERE),
        ("a.yaml", Place("a.yaml")),
        ("a.yaml:3", Place("a.yaml", 3)),
        ("a.yaml:3:7", Place("a.yaml", 3, 7)),
        ("C:a.yaml:3", Place("C:a.yaml", 3)),
        (":3", Place(":3")),
        (":3:7", Place(":3", 7)),
        ("a:123456789", Place("a", 123456789)),
        ("a:1234567890", Place("a:1234567890")),
        ("a:²", Place("a:²")),
    ],
)
def test_a_place_is_read_as_it_is_written(text: str, place: Place) -> None:
    assert place_of(text) == place
    assert str(place) == text


def test_who_was_asked_and_did_not_answer_is_named() -> None:
    """That of a node of which the life cycle alone was asked may not be installed here."""
    system = System(nodes=tuple(map(Node, ("/a", "/b", "/c"))))
    asked = [Question(it, f"{it}/get_parameters", GET_PARAMETERS) for it in ("/a", "/b")]
    asked += [Question("/c", "/c/get_state", GET_STATE)]
    (silent,) = doubts(with_answers(system, [Answer("/b")], asked))
    assert silent.message.startswith("/a did not answer --state within 5 s")
    assert not doubts(with_answers(system, [Answer("/a"), Answer("/b")], asked))


GET_STATE, GET_PARAMETERS = "lifecycle_msgs/srv/GetState", "rcl_interfaces/srv/GetParameters"
LIST = "controller_manager_msgs/srv/ListControllers"


def service(node: str, name: str, type_: str, role: str = SERVES, kind: str = SERVICE) -> End:
    return End(kind, role, name, type_, "", node, None, "")


def test_who_is_asked_for_what() -> None:
    """lifecycle_node_interface_impl.cpp, rclcpp parameter_service.cpp, controller_manager.cpp."""
    graph = System(
        nodes=(Node("/a"), Node("/m"), Node("/twice"), Node("/twice")),
        ends=(
            service("/a", "/a/get_state", GET_STATE),
            service("/a", "/a/get_parameters", GET_PARAMETERS),
            service("/m", "/m/list_controllers", LIST),
            # Another's, another role, another type, one of two.
            service("/a", "/m/get_state", GET_STATE),
            service("/a", "/a/get_state", GET_STATE, role="calls"),
            service("/a", "/a/get_state", GET_STATE, kind=TOPIC),
            service("/a", "/a/set", "std_srvs/srv/SetBool"),
            service("/twice", "/twice/get_state", GET_STATE),
        ),
    )
    assert list(questions(graph, {"/a": ["rate"]})) == [
        Question("/a", "/a/get_state", GET_STATE),
        Question("/a", "/a/get_parameters", GET_PARAMETERS, ("rate", "use_sim_time")),
        Question("/m", "/m/list_controllers", LIST),
    ]
    assert next(q for q in questions(graph) if q.parameters).parameters == ("use_sim_time",)


ONE, TWO = "010f1111aaaaaaaa", "010f2222bbbbbbbb"


def seen(*processes: str, **around: Any) -> System:
    nodes = (Node(f"/n{at}", it) for at, it in enumerate(processes))
    return System(nodes=tuple(nodes), environment=Environment(**{"range": "SUBNET", **around}))


STARTED = "is the robot started, and with this ROS_DOMAIN_ID?"


@pytest.mark.parametrize(
    ("graph", "said"),
    [
        (
            seen(rmw="rmw_zenoh_cpp", discovery_server="tcp/h:7447"),
            "is it started, in this domain, and connected to the router at tcp/h:7447?",
        ),
        (
            seen(discovery_server="h:1"),
            "is it started, and does it use the discovery server h:1?",
        ),
        (
            seen(range="LOCALHOST"),
            f"{STARTED} Only this machine is checked: range LOCALHOST, no ROS_STATIC_PEERS",
        ),
        (seen(range="LOCALHOST", static_peers=("h",)), STARTED),
        (seen(ONE, TWO), f"{STARTED} 2 machines are seen"),
        (seen(), STARTED),
    ],
)
def test_why_a_robot_is_not_seen(graph: System, said: str) -> None:
    assert why_not_seen(graph, "robot1", machines(graph)) == said


def test_what_a_bridge_copies_to_tf_is_left_out() -> None:
    """tf_namespace_bridge: the namespace is put in front of both frames."""
    names = [(SUBSCRIBES, "/a/tf"), (PUBLISHES, "/tf")]
    ends = (End(TOPIC, role, name, "", "", "/a/bridge", None, "") for role, name in names)
    plan = System(
        nodes=(Node("/a/bridge", robot="a"),),
        ends=tuple(ends),
        robots=(Robot("a", tf_topic="/a/tf"), Robot("b", tf_topic="/b/tf")),
        shared_frames=("map",),
    )
    own = Edge("base", "odom", "/a/tf_static", False, ())
    copied = Edge("a/base", "a/odom", "/tf", False, ())
    world = Edge("a/map", "map", "/tf_static", True, ())
    other = Edge("b/base", "b/odom", "/tf", False, ())
    elsewhere = Edge("a/base", "a/odom", "/b/tf", False, ())
    edges = (own, copied, world, other, elsewhere)
    assert without_bridged(plan, edges) == (own, other, elsewhere)
    assert without_bridged(plan._replace(ends=()), edges) == edges


def test_a_long_value_is_cut_in_a_message() -> None:
    assert shown("x" * 38) == f'"{"x" * 38}"'
    assert shown("x" * 39) == f'"{"x" * 38}…'


@pytest.mark.parametrize("count", [0, 7])
def test_a_transform_has_seven_numbers_that_a_robot_reaches(count: int) -> None:
    assert read_transform([1] * count) == (1.0,) * count
    assert read_transform([None] * count) == (float("inf"),) * count
    for wrong in ([1] * 6, [FARTHEST] * 7, [-FARTHEST] * 7, ["x"] * 7):
        with pytest.raises(WrongValue):
            read_transform(wrong)


def test_looks_are_merged_in_order_and_named_up_to_four() -> None:
    controllers = (Controller("/m", "b", "active"), Controller("/m", "a", "active"))
    parameters = (Parameter("/m", "y", "1"), Parameter("/m", "x", "2"))
    look = System(controllers=controllers, parameters=parameters)
    for count, names in ((4, "a, b, c, d"), (5, "a, b, c, d and 1 more")):
        found = merged([Look(name, look) for name in "abcde"[:count]])
        assert [it.name for it in found.controllers] == ["a", "b"]
        assert [it.name for it in found.parameters] == ["x", "y"]
        said = found.environment.caveats[0].message
        assert said == f"made of {count} snapshots: {names}"


def test_the_words_of_the_records() -> None:
    """Files of earlier versions have them."""
    assert records.KINDS == ("topic", "service", "action")
    assert records.ROLES == ("publishes", "subscribes", "serves", "calls")
    parts = (records.COMMAND, records.STATE, records.JOINT, records.EXPORTS, records.CLAIMS)
    assert parts == ("command", "state", "joint", "exports", "claims")
    held = (records.DEVICE, records.CALIBRATION, records.COMPUTER, records.OWN)
    assert held == ("device", "calibration", "computer", "own")
    ends = (records.EXPECTED, records.QUIET, records.TIMEOUT, records.CHANGING)
    assert ends == ("expected", "quiet", "timeout", "changing")
    sure = (records.RUNS, records.MAY, records.UNKNOWN, records.OFF)
    assert [it.word for it in sure] == ["runs", "may", "unknown", "off"]
    assert (records.ZENOH, records.SIM_TIME) == ("rmw_zenoh_cpp", "use_sim_time")
    assert records.Environment() == (0, "", (), "", "", False, 0, "expected", 0.0, ())


# The file of a system: its published schema, and what older versions wrote.
TEXT = files("multibot_rewrite.system").joinpath("system.schema.json").read_text()


VALID = Draft202012Validator(json.loads(TEXT))


ALL = System(
    nodes=(Node("/r1/amcl", robot="r1", lifecycle="active", sure=MAY._replace(why="slam: false")),),
    heard=(Heard("/scan", "laser"),),
    parameters=(Parameter("/r1/amcl", "use_sim_time", "true"),),
    controllers=(Controller("/r1/controller_manager", "arm", "active", ("j1/position",)),),
    robots=(Robot("r1", ("r1/base_link",), "/r1/tf"),),
    # A plan: who sends a transform, not on which topic, and what is open.
    edges=(Edge("r1/base_link", "r1/odom", "", False, ("/r1/ekf",)),),
    gaps=(Finding("MG102", "warning", "nothing sends /scan", "start a driver", "a.yaml", 3, 1),),
)


@pytest.mark.sample(1)
@pytest.mark.parametrize("path", [f"{it.stem}.json" for it in CASES])
def test_what_is_written_is_valid(path: str) -> None:
    VALID.validate(json.loads((ROOT / path).read_bytes()))


def test_what_fixes_a_file_is_not_in_the_file_of_a_system() -> None:
    fixed = ALL.gaps[0]._replace(edits=(Edit(0, 1, b"a", b"b"),))
    assert to_json(ALL._replace(gaps=(fixed,))) == to_json(ALL)
    told = {"code": "MG102", "level": "warning", "message": "m", "edits": [[0, 1, "a", "b"]]}
    wrong = {**json.loads(to_json(ALL)), "gaps": [told]}
    assert not VALID.is_valid(wrong)
    with pytest.raises(InputError, match=r"g: gaps\[0\].edits: not a key of a file; leave it out"):
        from_json(json.dumps(wrong).encode(), "g")


def test_every_kind_of_record_is_valid_and_comes_back() -> None:
    VALID.validate(json.loads(to_json(ALL)))
    assert from_json(to_json(ALL), "g") == ALL


@pytest.mark.more
def test_a_plan_is_written_as_any_system() -> None:
    robots, policy = ["robot1", "robot2"], {"layout": "both"}
    rover = ROOT / "fixtures" / "robots" / "rover.urdf"
    plan = system_of_description(rover, robots, node_sets=["nav2"], policy=policy)
    assert any(not it.topic for it in plan.edges)
    VALID.validate(json.loads(to_json(plan)))
    assert from_json(to_json(plan), "plan") == plan


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("gaps", [{"code": "MG102", "level": "bad", "message": "m"}]),
        ("edges", [{"child": "a", "parent": "b", "topic": "tf", "static": True, "publishers": []}]),
        ("nodes", [{"name": "amcl"}]),
        ("nodes", [{"name": "/amcl", "pid": 3}]),
        ("nodes", [{"name": "/amcl", "sure": {"word": "perhaps"}}]),
        ("parameters", [{"node": "/amcl", "name": "rate", "value": 5}]),
        ("controllers", [{"manager": "/manager", "name": "arm"}]),
        ("ends", [{"kind": "topic"}]),
        ("endpoints", []),
        ("schema", 1),
    ],
)
def test_the_schema_refuses_what_the_reader_refuses(key: str, value: Any) -> None:
    wrong = {**json.loads(to_json(ALL)), key: value}
    assert not VALID.is_valid(wrong)
    with pytest.raises(InputError):
        from_json(json.dumps(wrong).encode(), "g")


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        ("nodes", 1, "nodes: expected a list, not 1"),
        ("nodes", [{"name": 7}], "nodes[0].name: expected a full name that starts with /, not 7"),
        ("nodes", [{"name": "/a"}, {"name": "a"}],
         'nodes[1].name: expected a full name that starts with /, not "a"'),
        ("nodes", [{"name": "/a", "process": 7}], "nodes[0].process: expected text, not 7"),
        ("environment", {"domain": True}, "environment.domain: expected a whole number, not true"),
        ("environment", {"super_client": 1}, "environment.super_client: expected true or false, not 1"),
        ("environment", {"seconds": "é"}, 'environment.seconds: expected a number or null, not "é"'),
        ("environment", {"seconds": True}, "environment.seconds: expected a number or null, not true"),
        ("environment", {"seconds": 1e301}, "environment.seconds: expected a number or null, not 1e+3"),
        ("edges", [{"child": "a", "parent": "b", "topic": "/tf", "static": True, "publishers": [],
                    "transform": [1]}],
         "edges[0].transform: expected 7 numbers: x, y, z and a quaternion x, y, z, w, not [1]"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_said_with_its_keys(key: str, value: Any, said: str) -> None:
    with pytest.raises(InputError) as refused:
        from_json(json.dumps({**json.loads(to_json(ALL)), key: value}).encode(), "g")
    assert str(refused.value).startswith(f"g: {said}")
