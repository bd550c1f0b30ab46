# SPDX-License-Identifier: Apache-2.0
"""What the stub nodes of a rehearsal open, without rclpy: each call of ``ros`` is kept as a row."""

from __future__ import annotations

import json
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import SimpleNamespace
from typing import Any

import pytest

from multibot_rewrite.knowledge.records import Endpoint
from multibot_rewrite.live import stub_nodes
from multibot_rewrite.live.rehearsal import Stub, played, to_order
from multibot_rewrite.system.records import (
    ACTION,
    CALLS,
    PUBLISHES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    edge_of,
)

TF, STAMPED = "tf2_msgs/msg/TFMessage", "geometry_msgs/msg/TransformStamped"
EMPTY, EMPTY_SERVICE = "std_msgs/msg/Empty", "std_srvs/srv/Empty"
NAVIGATE = "nav2_msgs/action/NavigateToPose"
Row = tuple[object, ...]
# The words of the process of a stub.
PROCESS = ("--ros-args", "-r", "__ns:=/box", "-r", "m:=n")


class Transform:
    def __init__(self, child_frame_id: str) -> None:
        self.child_frame_id = child_frame_id
        self.header = SimpleNamespace(frame_id="", stamp=SimpleNamespace())

    def __str__(self) -> str:
        return f"{self.header.frame_id}>{self.child_frame_id}"


class Transforms:
    def __init__(self, transforms: list[Transform]) -> None:
        self.transforms = transforms

    def __str__(self) -> str:
        return " ".join(map(str, self.transforms))


class Ros:
    """Stands for the module that imports rclpy; of a type that is ``absent`` there is no class."""

    def __init__(self, *absent: str) -> None:
        self.absent, self.rows = absent, list[Row]()
        # What was told of itself.
        self.ends, self.frames = list[list[str]](), list[str]()

    @contextmanager
    def opened(self) -> Iterator[str]:
        yield "session"

    def add_node(self, session: Any, name: str, arguments: Any = ()) -> Any:
        self.rows.append(("node", name, *arguments))
        kinds = {"create_service": "serves", "create_client": "calls"}
        made = {key: self._row(name, kind) for key, kind in kinds.items()}
        asked = {"get_name": lambda: name, "get_fully_qualified_name": lambda: f"/ns/{name}"}
        return SimpleNamespace(name=name, resolve_topic_name="/ruled/{}".format, **asked, **made)

    def _row(self, node: str, kind: str) -> Any:
        return lambda type_, name, *_: self.rows.append((node, kind, name, type_))

    def message_class(self, type_: str) -> tuple[Any, str]:
        if type_ in self.absent:
            return None, "not installed"
        return {TF: Transforms, STAMPED: Transform}.get(type_, type_), ""

    def publish(self, node: Any, type_: Any, topic: str, latched: bool) -> Any:
        self.rows.append((node.name, "publishes", topic, type_, latched))
        sent = lambda message: self.rows.append(("sent", topic, str(message)))  # noqa: E731
        return SimpleNamespace(publish=sent)

    def own_ends(self, session: str) -> list[Row]:
        made = [it for it in self.rows if it[0] not in ("node", "sent")]
        return [it[:3] for it in made if session == "session"]

    def kept(self, kind: str) -> Any:
        return lambda node, type_, name: self.rows.append((node.name, kind, name, type_))


def rows(monkeypatch: pytest.MonkeyPatch, ros: Ros, *stubs: Stub, turns: int = 0) -> list[Row]:
    """Return what is done until so many turns of the loop are over; first of all what is told back."""
    monkeypatch.setattr(stub_nodes, "ros", ros)
    monkeypatch.setattr(stub_nodes, "own_ends", ros.own_ends)
    usual = stub_nodes._CREATORS
    own = {
        (False, SUBSCRIBES): ros.kept("subscribes"),
        (True, SERVES): ros.kept("serves action"),
        (True, CALLS): ros.kept("calls action"),
    }
    monkeypatch.setattr(stub_nodes, "_CREATORS", {**usual, **own})
    stub_nodes._installed_class.cache_clear()
    waited: list[float] = []

    class Stop(threading.Event):
        def wait(self, timeout: float | None = None) -> bool:
            waited.append(timeout or 0)
            return len(waited) > turns

    told: list[bytes] = []
    order = json.dumps(to_order(stubs))
    assert stub_nodes.main(order, Stop(), told.append) == 0
    stub_nodes._installed_class.cache_clear()
    replaced, ros.ends, ros.frames = json.loads(told[0])
    return [("replaced", replaced), *ros.rows]


def stub(*endpoints: Endpoint, edges: Any = ()) -> Stub:
    run = played("a", endpoints, arguments=("-r", "x:=y"))
    return run._replace(process_namespace="/box", process_rules=(("m", "n"),)), edges


@pytest.mark.parametrize(
    ("kind", "role", "type_", "made"),
    [
        (TOPIC, PUBLISHES, EMPTY, ("a", "publishes", "t", EMPTY, False)),
        (TOPIC, SUBSCRIBES, EMPTY, ("a", "subscribes", "t", EMPTY)),
        (SERVICE, SERVES, EMPTY_SERVICE, ("a", "serves", "t", EMPTY_SERVICE)),
        (SERVICE, CALLS, EMPTY_SERVICE, ("a", "calls", "t", EMPTY_SERVICE)),
        (ACTION, SERVES, NAVIGATE, ("a", "serves action", "t", NAVIGATE)),
        (ACTION, CALLS, NAVIGATE, ("a", "calls action", "t", NAVIGATE)),
    ],
)
def test_an_endpoint_is_opened_as_it_is(
    kind: str, role: str, type_: str, made: Row, monkeypatch: pytest.MonkeyPatch
) -> None:
    node = stub(Endpoint(kind, role, "t", type_))
    found = rows(monkeypatch, Ros(), node)
    assert found == [("replaced", {}), ("node", "a", "-r", "x:=y"), made]


@pytest.mark.parametrize(
    ("kind", "type_", "used", "replaced"),
    [
        (TOPIC, "acme/msg/A", EMPTY, {"acme/msg/A": EMPTY}),
        (SERVICE, "acme/srv/A", EMPTY_SERVICE, {"acme/srv/A": EMPTY_SERVICE}),
        # Nobody knows its type: nothing is replaced.
        (TOPIC, "", EMPTY, {}),
    ],
)
def test_a_type_that_is_not_installed_is_replaced_and_told(
    kind: str, type_: str, used: str, replaced: object, monkeypatch: pytest.MonkeyPatch
) -> None:
    role = SUBSCRIBES if kind == TOPIC else CALLS
    found = rows(monkeypatch, Ros(type_), stub(Endpoint(kind, role, "t", type_)))
    assert found[0] == ("replaced", replaced) and found[-1] == ("a", role, "t", used)


def test_an_action_without_its_type_is_its_services_and_topics(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    found = rows(monkeypatch, Ros(NAVIGATE), stub(Endpoint(ACTION, SERVES, "go", NAVIGATE)))
    assert found[0] == ("replaced", {NAVIGATE: EMPTY})
    assert {(it[1], it[2]) for it in found[2:]} == {
        ("serves", "go/_action/send_goal"),
        ("serves", "go/_action/cancel_goal"),
        ("serves", "go/_action/get_result"),
        ("publishes", "go/_action/feedback"),
        ("publishes", "go/_action/status"),
    }


def test_what_a_helper_node_has_is_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    """One helper of each name: its words are those of the process, its names below its maker's."""
    node = stub(
        Endpoint(TOPIC, SUBSCRIBES, "tf", EMPTY, helper=True),
        Endpoint(TOPIC, SUBSCRIBES, "tf_static", EMPTY, helper=True),
        Endpoint(TOPIC, SUBSCRIBES, "~/scene", EMPTY, helper=True, by="_private_*"),
    )
    _, first, listener, *found = rows(monkeypatch, Ros(), node)
    assert first[:2] == ("node", "a") and listener[2:] == PROCESS
    assert str(listener[1]).startswith("transform_listener_impl_")
    assert [it[2] for it in found if it[0] == listener[1]] == ["tf", "tf_static"]
    (private,) = [it for it in found if it[0] == "node"]
    assert str(private[1]).startswith("a_private_") and "*" not in str(private[1])
    assert found[-1] == (private[1], "subscribes", "/ns/a/scene", EMPTY)


def test_a_camera_info_is_next_to_the_image_after_all_rules(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    info = Endpoint(TOPIC, PUBLISHES, "out/camera_info", EMPTY, beside="image_raw")
    assert rows(monkeypatch, Ros(), stub(info))[-1][2] == "/ruled/camera_info"


@pytest.mark.parametrize(
    ("topic", "absent", "sent"),
    [
        ("/tf", "", ["odom>base_link base_link>wheel"]),
        ("/tf", TF, ["odom>base_link", "base_link>wheel"]),
        ("/r/tf_static", "", ["base_link>scan"]),
        ("/other", "", ["odom>base_link base_link>wheel"]),
    ],
)
def test_transforms_are_sent_once_or_again_and_again(
    topic: str, absent: str, sent: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    edges = (
        edge_of("odom", "base_link", False),
        edge_of("base_link", "wheel", False),
        edge_of("base_link", "scan", True),
    )
    node = stub(Endpoint(TOPIC, PUBLISHES, topic, TF), edges=edges)
    static = topic.endswith("tf_static")
    ros = Ros(absent)
    found = rows(monkeypatch, ros, node, turns=2)
    assert found[2][-1] is static
    assert ros.ends == [["a", "publishes", topic]]
    assert ros.frames == (["scan"] if static else ["base_link", "wheel"])
    assert [it[2] for it in found if it[0] == "sent"] == (sent if static else sent * 2)
