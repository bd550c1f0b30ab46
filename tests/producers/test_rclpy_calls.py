# SPDX-License-Identifier: Apache-2.0
"""What rclpy is asked for, with a stand-in of its modules: the names and arguments are those of rclpy
(node.py, context.py, executors.py, qos.py, type_support.py) and of rosidl_generator_py."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest

from multibot_rewrite.producers.ros import ros


class RCLError(Exception):
    """Of rclpy's implementation in C++."""


class InvalidHandle(Exception):
    """The same."""


class NodeNameNonExistentError(Exception):
    """Of rclpy.node."""


class UnsupportedTypeSupport(Exception):
    """Of rosidl_generator_py."""


class NoTypeSupportImportedException(Exception):
    """Of rclpy.exceptions."""


Install = Callable[..., ModuleType]


@pytest.fixture
def install(monkeypatch: pytest.MonkeyPatch) -> Install:
    """Return a function that puts a module where ``import`` finds it."""

    def installed(name: str, **members: Any) -> ModuleType:
        module = ModuleType(name)
        vars(module).update(members)
        monkeypatch.setitem(sys.modules, name, module)
        return module

    for name in ("rclpy", "rclpy.impl", "rosidl_generator_py"):
        installed(name)
    implementation = SimpleNamespace(RCLError=RCLError, InvalidHandle=InvalidHandle)
    installed("rclpy.impl.implementation_singleton", rclpy_implementation=implementation)
    installed("rclpy.node", NodeNameNonExistentError=NodeNameNonExistentError)
    installed("rclpy.exceptions", NoTypeSupportImportedException=NoTypeSupportImportedException)
    installed(
        "rosidl_generator_py.import_type_support_impl",
        UnsupportedTypeSupport=UnsupportedTypeSupport,
    )
    installed(
        "rclpy.qos", QoSProfile=SimpleNamespace,
        DurabilityPolicy=SimpleNamespace(TRANSIENT_LOCAL="kept", VOLATILE="volatile"),
        ReliabilityPolicy=SimpleNamespace(RELIABLE="reliable", BEST_EFFORT="best effort"),
    )  # fmt: skip
    return installed


def test_why_rclpy_is_missing(install: Install, monkeypatch: pytest.MonkeyPatch) -> None:
    """Message types do without the generator, which needs lark."""
    generator = "rosidl_generator_py.generate_py_impl"
    monkeypatch.setitem(sys.modules, generator, None)
    assert ros.missing() == ""
    monkeypatch.setitem(sys.modules, "rclpy", None)
    assert ros.missing() == "ModuleNotFoundError: import of rclpy halted; None in sys.modules"
    monkeypatch.delitem(sys.modules, generator)
    ros.missing()
    assert sys.modules[generator] is None
    own = install(generator)
    ros.missing()
    assert sys.modules[generator] is own


def test_a_session_is_its_own_and_its_nodes_leave_the_graph(install: Install) -> None:
    done: list[Any] = []
    nodes = [SimpleNamespace(destroy_node=lambda it=it: done.append(it)) for it in ("a", "b")]
    context = SimpleNamespace(try_shutdown=lambda: done.append("context"))
    executor = SimpleNamespace(get_nodes=lambda: nodes, shutdown=lambda: done.append("executor"))
    vars(sys.modules["rclpy"])["init"] = lambda **given: done.append(given)
    install("rclpy.context", Context=lambda: context)
    install(
        "rclpy.executors", SingleThreadedExecutor=lambda context: done.append(context) or executor
    )
    install("rclpy.signals", SignalHandlerOptions=SimpleNamespace(NO="no signals"))
    with pytest.raises(KeyError), ros.opened() as session:
        assert session == (context, executor)
        given = {"args": [], "context": context, "signal_handler_options": "no signals"}
        assert done == [given, context]
        done.clear()
        raise KeyError
    assert done == ["executor", "a", "b", "context"]


def test_a_node_has_no_services_and_no_arguments_but_its_own(install: Install) -> None:
    added: list[Any] = []
    install("rclpy.node", Node=lambda name, **given: (name, given))
    install("rclpy.parameter", Parameter=lambda name, value: (name, value))
    session: Any = SimpleNamespace(context="c", executor=SimpleNamespace(add_node=added.append))
    given = {
        "context": "c", "namespace": "/r", "cli_args": ["--ros-args"],
        "use_global_arguments": False, "start_parameter_services": False, "enable_rosout": False,
        "parameter_overrides": [("start_type_description_service", False)],
    }  # fmt: skip
    made = ("n", given)
    assert ros.add_node(session, "n", "/r", ("--ros-args",)) == made
    other: Any = ros.add_node(session, "m")
    assert (other[1]["namespace"], other[1]["cli_args"]) == ("/", [])
    assert added == [made, other]


def test_callbacks_run_until_the_time_is_over(monkeypatch: pytest.MonkeyPatch) -> None:
    now, waited = [10.0], []

    def spin_once(timeout_sec: float) -> None:
        waited.append(timeout_sec)
        now[0] += 0.75

    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    session: Any = SimpleNamespace(executor=SimpleNamespace(spin_once=spin_once))
    ros.spin(session, 1.5)
    assert waited == [1.5, 0.75]


@pytest.mark.usefixtures("install")
@pytest.mark.parametrize("there", [True, False])
def test_a_node_that_left_is_told_from_another_error(there: bool) -> None:
    class Handle(nullcontext[None]):
        def get_action_server_names_and_types_by_node(self, name: str, space: str) -> Any:
            return [(f"{space}/{name}/go", ["a/action/Go"])]

        def get_action_client_names_and_types_by_node(self, name: str, space: str) -> Any:
            raise RCLError("no")

    names = [("n", "/r")] if there else [("n", "/s"), ("m", "/r")]
    node: Any = SimpleNamespace(handle=Handle(), get_node_names_and_namespaces=lambda: names)
    assert ros.action_servers(node, "n", "/r") == [("/r/n/go", ["a/action/Go"])]
    with pytest.raises(RCLError if there else NodeNameNonExistentError) as raised:
        ros.action_clients(node, "n", "/r")
    assert str(raised.value) == ("no" if there else "/r/n left the graph")


def test_the_class_of_a_type_is_one_whose_support_is_there(install: Install) -> None:
    """Of an action the support of its feedback message is asked for."""
    checked: list[Any] = []

    def check(type_: Any) -> None:
        checked.append(type_)
        if type_ == "broken":
            raise UnsupportedTypeSupport("no library")

    install("rclpy.type_support", check_for_type_support=check)
    go = SimpleNamespace(Impl=SimpleNamespace(FeedbackMessage="feedback"))
    install("acme")
    install("acme.msg", A="class A", B="broken")
    install("acme.action", Go=go)
    assert ros.message_class("acme/msg/A") == ("class A", "")
    assert ros.message_class("acme/action/Go") == (go, "")
    assert ros.message_class("acme/msg/B") == (None, "no library")
    assert checked == ["class A", "feedback", "broken"]
    assert ros.message_class("acme/msg/C") == (None, "module 'acme.msg' has no attribute 'C'")
    assert ros.message_class("acme/srv/C") == (
        None, "No module named 'acme.srv'; 'acme' is not a package",
    )  # fmt: skip


def test_the_class_of_a_serialized_message_is_its_support_in_c(install: Install) -> None:
    parts = ("type_support", "create_ros_message", "convert_from_py", "convert_to_py",
             "destroy_ros_message")  # fmt: skip
    support = SimpleNamespace(**{f"{it}_msg__msg__tf_message": it for it in parts})
    vars(sys.modules["rosidl_generator_py"])["import_type_support"] = {"acme": support}.__getitem__
    install("acme")
    class_, why = ros.raw_message_class("acme/msg/TFMessage")
    assert (why, class_.__name__) == ("", "TFMessage")
    names = ("_TYPE_SUPPORT", "_CREATE_ROS_MESSAGE", "_CONVERT_FROM_PY", "_CONVERT_TO_PY",
             "_DESTROY_ROS_MESSAGE")  # fmt: skip
    assert [getattr(type(class_), it) for it in names] == [*parts]
    none, why = ros.raw_message_class("acme/msg/Other")
    assert none is None and why.endswith("has no attribute 'type_support_msg__msg__other'")
    assert ros.raw_message_class("no_such/msg/A") == (None, "No module named 'no_such'")


@pytest.mark.parametrize(
    ("fields", "found"),
    [
        ("'header': 'std_msgs/Header',\n 'x': 'double'", True),
        ("'x': 'double', 'header': 'std_msgs/Header'", False),
        ("'header': 'std_msgs/Headers'", False), ("", False),
    ],
)  # fmt: skip
def test_a_header_is_the_first_field_in_the_source_of_a_type(
    fields: str, found: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "acme_msgs" / "msg").mkdir(parents=True)
    (tmp_path / "acme_msgs" / "__init__.py").write_text("raise SystemExit")
    source = f"class A:\n    _fields_and_field_types: dict = {{\n {fields}\n    }}\n"
    (tmp_path / "acme_msgs" / "msg" / "_two_words.py").write_text(source)
    monkeypatch.syspath_prepend(tmp_path)
    assert ros.begins_with_header("acme_msgs/msg/TwoWords") is found
    assert ros.begins_with_header("acme_msgs/msg/Other") is False
    assert ros.begins_with_header("no_such_msgs/msg/TwoWords") is False


class Node:
    """A node of rclpy that has one subscription at most."""

    def __init__(self) -> None:
        self.made: list[Any] = []
        self.ended: list[Any] = []

    def create_subscription(self, *given: Any, **more: Any) -> str:
        if self.made:
            raise RCLError("another type")
        self.made.append((*given, more))
        return "subscription"

    def create_publisher(self, *given: Any) -> Any:
        return given

    def destroy_subscription(self, subscription: Any) -> None:
        self.ended.append(subscription)


def qos(depth: int, durability: str, reliability: str) -> SimpleNamespace:
    return SimpleNamespace(depth=depth, durability=durability, reliability=reliability)


@pytest.mark.usefixtures("install")
@pytest.mark.parametrize(
    ("latched", "depth", "profile"),
    [
        (False, 0, qos(100, "volatile", "best effort")), (True, 0, qos(1000, "kept", "reliable")),
        (False, 1, qos(1, "volatile", "best effort")),
    ],
)  # fmt: skip
def test_a_subscription_to_serialized_messages(
    latched: bool, depth: int, profile: SimpleNamespace
) -> None:
    """The number of a message is in a dictionary in Jazzy, and an attribute later."""
    node, heard = Node(), []
    asked: Any = node
    end = ros.subscribe(asked, "type", "/tf", latched, lambda *it: heard.append(it), depth)
    ((type_, topic, call, given, more),) = node.made
    assert (type_, topic, given, more) == ("type", "/tf", profile, {"raw": True})
    for info in (
        {"publication_sequence_number": 3}, {}, SimpleNamespace(publication_sequence_number=4), None,
    ):  # fmt: skip
        call(b"m", info)
    assert heard == [(b"m", 3), (b"m", None), (b"m", 4), (b"m", None)]
    assert ros.subscribe(asked, "other", "/tf", latched, lambda *_: None, depth) is None
    assert end is not None
    end()
    assert node.ended == ["subscription"]


@pytest.mark.usefixtures("install")
def test_a_node_that_stands_in_is_reliable_and_drops_what_it_gets() -> None:
    node: Any = Node()
    kept, usual = qos(1000, "kept", "reliable"), qos(100, "volatile", "reliable")
    assert ros.publish(node, "type", "/map", True) == ("type", "/map", kept)
    assert ros.publish(node, "type", "/scan", False) == ("type", "/scan", usual)
    ros.subscribe_and_drop(node, "type", "/scan")
    ((type_, topic, call, profile, more),) = node.made
    assert (type_, topic, call("m"), profile, more) == ("type", "/scan", None, usual, {})


@pytest.mark.usefixtures("install")
def test_all_that_was_received_is_handed_out() -> None:
    """A callback may end its subscription: its handle is no longer valid then."""
    heard: list[Any] = []

    class Handle(nullcontext[None]):
        def __init__(self, *messages: Any) -> None:
            super().__init__()
            self.messages = [*messages]

        def take_message(self, type_: str, raw: bool) -> Any:
            assert (type_, raw) == ("type", True)
            if not self.messages:
                return None
            found = self.messages.pop(0)
            if found == "ended":
                raise InvalidHandle
            return found

    def subscription(*messages: Any) -> Any:
        return SimpleNamespace(
            handle=Handle(*messages), msg_type="type", raw=True,
            callback=lambda *it: heard.append(it),
        )  # fmt: skip

    first = subscription((b"1", "i"), "ended", (b"2", "i"))
    node: Any = SimpleNamespace(subscriptions=iter([first, subscription((b"3", "i"), (b"4", "i"))]))
    ros.receive(node)
    assert heard == [(b"1", "i"), (b"3", "i"), (b"4", "i")]


def test_actions_are_served_and_called(install: Install) -> None:
    made: list[Any] = []
    install(
        "rclpy.action",
        ActionServer=lambda *given: made.append(given), ActionClient=lambda *given: made.append(given),
    )  # fmt: skip
    node: Any = "node"
    type_ = SimpleNamespace(Result=lambda: "no result")
    ros.serve_action(node, type_, "go")
    ros.call_action(node, type_, "come")
    (*served, answer), called = made
    assert (served, answer("goal"), called) == (
        ["node", type_, "go"], "no result", ("node", type_, "come"),
    )  # fmt: skip


def test_the_middleware_has_its_name_from_rclpy(install: Install) -> None:
    install("rclpy.utilities", get_rmw_implementation_identifier=lambda: "rmw_x")
    assert ros.middleware() == "rmw_x"
