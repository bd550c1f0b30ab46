# SPDX-License-Identifier: Apache-2.0
"""Nodes are asked for state, parameters and controllers; what they answer is in the records.

The services here answer from a table, with the fields of lifecycle_msgs, rcl_interfaces and
controller_manager_msgs.
"""

from __future__ import annotations

import threading
from array import array
from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import pytest

from multibot_rewrite.producers.ros import ask, ros
from multibot_rewrite.producers.ros.assemble import ReceivedTransform
from multibot_rewrite.producers.ros.look import complete_view
from multibot_rewrite.producers.ros.observe import _ChangeTimes, _pause_after
from multibot_rewrite.producers.ros.request import Request
from multibot_rewrite.producers.ros.tf_subscriptions import TfSubscriptions
from multibot_rewrite.system.parameters import (
    GET_PARAMETERS,
    GET_STATE,
    LIST_CONTROLLERS,
    LIST_PARAMETERS,
    Answer,
    Question,
)
from multibot_rewrite.system.records import (
    ACTION,
    PUBLISHES,
    SERVES,
    TOPIC,
    Controller,
    End,
    Parameter,
    Qos,
)

STATE = Question("/a", "/a/get_state", GET_STATE)
RATES = Question("/a", "/a/get_parameters", GET_PARAMETERS, ("rate", "use_sim_time"))
LISTED = Question("/m", "/m/list_controllers", LIST_CONTROLLERS)


def value(type_: int = 0, **fields: Any) -> Any:
    return SimpleNamespace(type=type_, **fields)


ANSWERS: dict[str, Any] = {
    "/a/get_state": SimpleNamespace(current_state=SimpleNamespace(label="active")),
    "/a/get_parameters": SimpleNamespace(
        values=[value(3, double_value=5.0), value(1, bool_value=True)]
    ),
    "/m/list_controllers": SimpleNamespace(
        controller=[SimpleNamespace(name="arm", state="active", claimed_interfaces=["j/position"])]
    ),
}


class Asker:
    """The asking node; ``deaf`` are services that nobody serves."""

    def __init__(self, answers: dict[str, Any], deaf: Sequence[str] = ()) -> None:
        self.answers, self.deaf = answers, deaf
        self.asked: list[tuple[str, Any]] = []
        self.made: list[str] = []
        self.destroyed: list[Any] = []

    def create_client(self, class_: Any, service: str) -> Any:
        self.made.append(service)

        def call(request: Any) -> Any:
            self.asked.append((service, getattr(request, "names", None)))
            answer = self.answers[service]
            found = answer(request) if callable(answer) else answer
            return SimpleNamespace(done=lambda: True, result=lambda: found)

        return SimpleNamespace(service_is_ready=lambda: service not in self.deaf, call_async=call)

    def destroy_client(self, client: Any) -> None:
        self.destroyed.append(client)


@pytest.fixture(autouse=True)
def without_waiting(monkeypatch: pytest.MonkeyPatch) -> None:
    """Types of ``missing/...`` are not installed."""
    class_ = SimpleNamespace(Request=SimpleNamespace)
    monkeypatch.setattr(ros, "spin", lambda session, seconds: None)
    monkeypatch.setattr(
        ros, "message_class", lambda type_: (None if type_.startswith("missing") else class_, "")
    )


def answers(node: Asker, *asked: Question, seconds: float = 5.0) -> tuple[Answer, ...]:
    session: Any = None
    return ask.ask_nodes(session, node, asked, seconds, threading.Event())


def test_what_nodes_answer_is_in_the_records_by_their_names() -> None:
    node = Asker(ANSWERS)
    assert answers(node, LISTED, STATE, RATES) == (
        Answer(
            "/a",
            "active",
            (Parameter("/a", "rate", "5.0"), Parameter("/a", "use_sim_time", "true")),
        ),
        Answer("/m", controllers=(Controller("/m", "arm", "active", ("j/position",)),)),
    )
    assert dict(node.asked) == {
        "/a/get_state": None,
        "/a/get_parameters": ["rate", "use_sim_time"],
        "/m/list_controllers": None,
    }
    assert len(node.destroyed) == len(node.made) == 3


def test_who_serves_nothing_or_has_no_type_here_is_not_waited_for_for_ever() -> None:
    deaf = Asker(ANSWERS, ["/a/get_state"])
    missing = STATE._replace(type="missing/srv/X")
    assert answers(deaf, STATE, LISTED, seconds=0.02)[0].node == "/m"
    assert answers(Asker(ANSWERS), missing) == ()


def test_a_node_that_lacks_a_parameter_is_asked_for_halves() -> None:
    """rclcpp gives no value at all where one parameter is not declared."""

    def some(request: Any) -> Any:
        known = request.names == ["rate"]
        return SimpleNamespace(values=[value(2, integer_value=7)] if known else [])

    node = Asker({"/a/get_parameters": some})
    (found,) = answers(node, RATES._replace(parameters=("rate", "x", "y")))
    assert found.parameters == (Parameter("/a", "rate", "7"),)
    assert [names for _, names in node.asked] == [
        ["rate", "x", "y"],
        ["rate"],
        ["x", "y"],
        ["x"],
        ["y"],
    ]
    assert node.made == ["/a/get_parameters"]


def test_what_a_node_lists_is_asked_of_it_but_for_secrets() -> None:
    names = [
        "rate",
        "qos_overrides./tf.publisher.depth",
        "wifi_password",
        "api.key",
        "use_sim_time",
    ]
    node = Asker(
        {**ANSWERS, "/a/list_parameters": SimpleNamespace(result=SimpleNamespace(names=names))}
    )
    (found,) = answers(node, Question("/a", "/a/list_parameters", LIST_PARAMETERS))
    assert [it.name for it in found.parameters] == ["rate", "use_sim_time"]
    assert node.asked[-1] == ("/a/get_parameters", ["rate", "use_sim_time"])


@pytest.mark.parametrize(
    ("answer", "text"),
    [
        (value(1, bool_value=False), "false"),
        (value(2, integer_value=3), "3"),
        (value(3, double_value=0.5), "0.5"),
        (value(4, string_value="x"), '"x"'),
        (value(6, bool_array_value=(True,)), "[true]"),
        (value(7, integer_array_value=array("q", (1, 2))), "[1, 2]"),
        (value(8, double_array_value=array("d", (0.5,))), "[0.5]"),
        (value(9, string_array_value=("a",)), '["a"]'),
        # Not set, and bytes.
        (value(0), None),
        (value(5, byte_array_value=(b"a",)), None),
    ],
)
def test_a_value_has_the_field_of_its_type(answer: Any, text: str | None) -> None:
    """rcl_interfaces/msg/ParameterType."""
    node = Asker({"/a/get_parameters": SimpleNamespace(values=[answer])})
    (found,) = answers(node, RATES._replace(parameters=("rate",)))
    assert found.parameters == ((Parameter("/a", "rate", text),) if text else ())


# Transforms that are received while a graph is looked at.

INF = float("inf")
QOS = Qos("KEEP_LAST", 1, "RELIABLE", "VOLATILE", INF, INF, "AUTOMATIC", INF)
LATCHED = QOS._replace(durability="TRANSIENT_LOCAL")
TF, SINGLE = "tf2_msgs/msg/TFMessage", "geometry_msgs/msg/TransformStamped"


def tf_end(name: str, type_: str = TF, qos: Qos | None = QOS) -> End:
    return End(TOPIC, PUBLISHES, name, type_, "", "/n", qos, "")


def stamped(child: str, x: float = 0.0) -> Any:
    at = SimpleNamespace(x=x, y=0.0, z=0.0)
    turn = SimpleNamespace(x=0.0, y=0.0, z=0.0, w=1.0)
    return SimpleNamespace(
        header=SimpleNamespace(frame_id="base", stamp=1.0),
        child_frame_id=child,
        transform=SimpleNamespace(translation=at, rotation=turn),
    )


class Ears:
    def __init__(self, broken: str = "") -> None:
        self.broken = broken
        self.heard: dict[tuple[str, bool], Any] = {}
        self.ended: list[str] = []
        self.it = TfSubscriptions(self.subscribe)

    def subscribe(self, topic: str, type_: str, latched: bool, callback: Any) -> Any:
        if topic == self.broken:
            return "no module named tf2_msgs"
        self.heard[topic, latched] = callback
        return lambda: self.ended.append(topic)


def test_every_tf_topic_that_is_published_is_listened_to_while_it_is() -> None:
    ears = Ears()
    ends = [tf_end("/tf"), tf_end("/tf_static", qos=LATCHED), tf_end("/x", "a/msg/B")]
    unknown = [tf_end("/unknown", qos=None), tf_end("/read")._replace(role="subscribes")]
    ears.it.update([*ends, *unknown, tf_end("/one", SINGLE)], False)
    assert set(ears.heard) == {("/tf", False), ("/tf_static", True)}
    ears.it.update([*ends, tf_end("/one", SINGLE)], True)
    assert set(ears.heard) == {("/tf", False), ("/tf_static", True), ("/one", False)}
    ears.heard["/tf", False](SimpleNamespace(transforms=[stamped("a")]), 1)
    ears.heard["/one", False](stamped("b"), None)
    assert ears.it.transforms() == (
        ReceivedTransform("/one", False, "base", "b"),
        ReceivedTransform("/tf", False, "base", "a"),
    )
    ears.it.update(ends[1:], True)
    assert sorted(ears.ended) == ["/one", "/tf"]
    assert ears.it.transforms() == ()


def test_what_two_latched_senders_have_otherwise_is_nowhere() -> None:
    ears = Ears()
    ears.it.update([tf_end("/tf_static", qos=LATCHED), tf_end("/tf")], False)
    static, moving = ears.heard["/tf_static", True], ears.heard["/tf", False]
    static(SimpleNamespace(transforms=[stamped("a", 1.0)]), b"one")
    assert [it.transform[0] for it in ears.it.edges(())] == [1.0]
    static(SimpleNamespace(transforms=[stamped("a", 2.0)]), b"two")
    assert [(it.transform, it.several) for it in ears.it.edges(())] == [((), True)]
    for x in (1.0, 2.0):
        moving(SimpleNamespace(transforms=[stamped("b", x)]), int(x))
    assert next(ears.it.edges(())).transform[0] == 2.0


def test_a_sender_that_is_started_again_is_no_second_one() -> None:
    """Each numbers its messages from 1; what is latched is heard again from all who still send."""
    ears = Ears()

    def heard(*processes: str) -> set[str]:
        end = tf_end("/tf_static", qos=LATCHED)
        ears.it.update([end._replace(process=it) for it in processes], False)
        for _ in processes:
            ears.heard["/tf_static", True](SimpleNamespace(transforms=[stamped("a")]), 1)
        return {it.topic for it in ears.it.edges(()) if it.several}

    assert (heard("first"), heard("second"), heard("third")) == (set(), set(), set())
    assert ears.ended == ["/tf_static", "/tf_static"]
    assert heard("third", "fourth") == {"/tf_static"}


def test_a_topic_that_cannot_be_read_is_told_with_the_reason() -> None:
    ears = Ears("/tf")
    ears.it.update([tf_end("/tf")], False)
    (caveat,) = ears.it.caveats()
    assert (caveat.code, caveat.incomplete) == ("frames-not-read", False)
    assert caveat.message == "the frames on /tf were not read: no module named tf2_msgs"
    assert list(Ears().it.caveats()) == []


def test_a_topic_that_is_read_as_another_type_ends_no_look() -> None:
    """rcl refuses a second type of one topic in one process."""
    rclpy = pytest.importorskip("rclpy.impl.implementation_singleton").rclpy_implementation

    def refuse(*_: object, **__: object) -> None:
        raise rclpy.RCLError("called for existing topic name with incompatible type")

    node: Any = SimpleNamespace(create_subscription=refuse)
    assert ros.subscribe(node, object, "/tf", False, lambda *_: None) is None


def test_a_silent_topic_is_waited_for_longer() -> None:
    ears = Ears()
    assert not ears.it.keep_waiting(100.0, 100.0)
    ears.it.update([tf_end("/tf")], False)
    assert ears.it.keep_waiting(0.0, 100.0)
    assert not ears.it.keep_waiting(100.0, 0.0)
    ears.heard["/tf", False](SimpleNamespace(transforms=[stamped("a")]), 1)
    assert not ears.it.keep_waiting(0.0, 100.0)
    assert ears.it.keep_waiting(100.0, 0.0)


# When a graph last changed.


def test_the_time_of_the_last_change_of_all_and_of_what_is_expected() -> None:
    times, request = _ChangeTimes(), Request(9.0, expected=("/n",))
    mine, other = tf_end("/tf"), tf_end("/x")._replace(node="/other")
    assert times.update(1.0, (["/n"], [mine]), request) == (1.0, 1.0)
    assert times.update(2.0, (["/n"], [mine]), request) == (1.0, 1.0)
    assert times.update(3.0, (["/n"], [mine, other]), request) == (3.0, 1.0)
    assert times.update(4.0, (["/n"], [other]), request) == (4.0, 4.0)


@pytest.mark.parametrize(("took", "pause"), [(0.0, 0.1), (0.02, 0.2), (1.0, 1.0)])
def test_a_pause_is_as_long_as_a_poll_took_and_never_too_long(took: float, pause: float) -> None:
    assert _pause_after(took, 10) == pytest.approx(pause)


def test_a_view_with_a_node_without_ends_is_taken_again(monkeypatch: pytest.MonkeyPatch) -> None:
    from multibot_rewrite.producers.ros import look

    views = [
        (["/n", "/m"], [tf_end("/tf")]),
        (["/n"], [tf_end("/tf"), tf_end("/x")._replace(node="/_NODE_NAME_UNKNOWN_")]),
        (["/n"], [tf_end("/tf")]),
        (["/n", "/bare"], [tf_end("/tf"), tf_end("/y")._replace(node="/bare")]),
        (["/never"], []),
    ]
    taken = iter(views)
    monkeypatch.setattr(look, "view", lambda session, cache: next(taken))
    # A participant has announced itself, and the message that names its node comes later.
    monkeypatch.setattr(look.queries, "without_nodes", lambda node, ends: not ends[1:])
    stop = SimpleNamespace(wait=lambda seconds: False)
    session: Any = SimpleNamespace(request=Request(9.0), now=lambda: 0.0, stop=stop, node=None)
    assert complete_view(session, {}) == views[3]
    late = SimpleNamespace(request=Request(9.0), now=lambda: 9.5, stop=stop, node=None)
    assert complete_view(late, {}) == views[4]  # type: ignore[arg-type]


def test_the_ends_of_a_process_are_those_of_all_its_nodes(monkeypatch: pytest.MonkeyPatch) -> None:
    """The first node is asked for all of them; one that leaves the graph meanwhile has none."""
    from multibot_rewrite.producers.ros import look

    class Gone(Exception):
        pass

    def there(it: str, name: str, space: str) -> list[tuple[str, list[str]]]:
        if name == "gone":
            raise Gone
        return [(f"{space}/{name}/{it}", ["t"])]

    def nothing(*_: object) -> list[tuple[str, list[str]]]:
        return []

    queries = {
        f"get_{it}_names_and_types_by_node": nothing for it in ("publisher", "subscriber", "client")
    }
    first = SimpleNamespace(
        get_fully_qualified_name=lambda: "/r/a",
        get_service_names_and_types_by_node=lambda *who: there("s", *who),
        **queries,
    )
    others = [
        SimpleNamespace(get_fully_qualified_name=lambda it=it: it) for it in ("/r/b", "/r/gone")
    ]
    monkeypatch.setattr(look.ros, "node_gone_error", lambda: Gone)
    monkeypatch.setattr(look.ros, "action_servers", lambda node, *who: there("act", *who))
    monkeypatch.setattr(look.ros, "action_clients", nothing)
    monkeypatch.setattr(
        look,
        "_ALL_QUERIES",
        (*look.queries.NODE_QUERIES, (ACTION, SERVES, look.ros.action_servers)),
    )
    session: Any = SimpleNamespace(executor=SimpleNamespace(get_nodes=lambda: [first, *others]))
    assert look.own_ends(session) == [
        ("/r/a", "serves", "/r/a/act"),
        ("/r/a", "serves", "/r/a/s"),
        ("/r/b", "serves", "/r/b/act"),
        ("/r/b", "serves", "/r/b/s"),
    ]
    none: Any = SimpleNamespace(executor=SimpleNamespace(get_nodes=list))
    assert look.own_ends(none) == []
