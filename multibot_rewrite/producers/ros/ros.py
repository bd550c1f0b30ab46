# SPDX-License-Identifier: Apache-2.0
"""The only module that imports rclpy, with the functions that the others need.

It runs in child processes (``live.observe``, ``live.stub_nodes``), since rcl may end its process.
"""

import re
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, NamedTuple, cast

if TYPE_CHECKING:
    from rclpy.context import Context
    from rclpy.executors import SingleThreadedExecutor
    from rclpy.node import Node

_BROKEN = (ImportError, AttributeError, OSError)
# The functions of a message type in C that rclpy asks its class for.
_SUPPORT = (
    "type_support", "create_ros_message", "convert_from_py", "convert_to_py", "destroy_ros_message",
)  # fmt: skip
# In the Python source of a message type.
_FIRST_FIELD = re.compile(r"_fields_and_field_types\b[^={]*=\s*\{\s*'\w+':\s*'([^']+)'")


class Session(NamedTuple):
    """An own rclpy context, without arguments or remap rules from the process's command line."""

    context: "Context"
    executor: "SingleThreadedExecutor"


def missing() -> str:
    """Return why rclpy cannot be imported, or an empty string."""
    # Every message type imports this package. Its generator needs lark and does without it.
    sys.modules.setdefault("rosidl_generator_py.generate_py_impl", cast(ModuleType, None))
    try:
        import rclpy  # noqa: F401
    except (ImportError, OSError) as error:  # OSError: a shared library that does not load
        return f"{type(error).__name__}: {error}"
    return ""


@contextmanager
def opened() -> Iterator[Session]:
    """Yield a session; at the end of the block its nodes leave the graph at once."""
    import rclpy
    from rclpy.context import Context
    from rclpy.executors import SingleThreadedExecutor
    from rclpy.signals import SignalHandlerOptions

    context = Context()
    rclpy.init(args=[], context=context, signal_handler_options=SignalHandlerOptions.NO)
    executor = SingleThreadedExecutor(context=context)
    try:
        yield Session(context, executor)
    finally:
        nodes = executor.get_nodes()
        executor.shutdown()
        for node in nodes:
            node.destroy_node()
        context.try_shutdown()


def add_node(
    session: Session, name: str, namespace: str = "/", arguments: Sequence[str] = ()
) -> "Node":
    """Add a node without services; ``arguments`` are those of its command line."""
    from rclpy.node import Node
    from rclpy.parameter import Parameter

    node = Node(
        name,
        context=session.context,
        namespace=namespace,
        cli_args=list(arguments),
        use_global_arguments=False,
        start_parameter_services=False,
        enable_rosout=False,
        # Its types need numpy, which takes longer to import than all of rclpy.
        parameter_overrides=[Parameter("start_type_description_service", value=False)],
    )
    session.executor.add_node(node)
    return node


def spin(session: Session, seconds: float) -> None:
    """Run callbacks for ``seconds``."""
    end = time.monotonic() + seconds
    while (left := end - time.monotonic()) > 0:
        session.executor.spin_once(timeout_sec=left)


def node_gone_error() -> type[Exception]:
    """Return the exception for a query about a node that is not in the graph."""
    from rclpy.node import NodeNameNonExistentError

    error: type[Exception] = NodeNameNonExistentError
    return error


def action_servers(node: "Node", name: str, namespace: str) -> Any:
    """Return names and types of the actions that a node serves."""
    return _actions(node, node.handle.get_action_server_names_and_types_by_node, name, namespace)


def action_clients(node: "Node", name: str, namespace: str) -> Any:
    """Return names and types of the actions that a node calls."""
    return _actions(node, node.handle.get_action_client_names_and_types_by_node, name, namespace)


# rclpy.action.graph asks the same, and imports all of rclpy.action, which needs numpy.
def _actions(node: "Node", query: Callable[..., Any], name: str, namespace: str) -> Any:
    """Return a query's answer about actions; raises ``node_gone_error`` if the node left the graph."""
    from rclpy.impl.implementation_singleton import rclpy_implementation

    try:
        with node.handle:
            return query(name, namespace)
    except rclpy_implementation.RCLError as error:
        if (name, namespace) in node.get_node_names_and_namespaces():
            raise
        raise node_gone_error()(f"{namespace.rstrip('/')}/{name} left the graph") from error


def message_class(type_: str) -> tuple[Any, str]:
    """Return the class of a type such as ``std_msgs/msg/String``, or None and why there is none."""
    from rclpy.exceptions import NoTypeSupportImportedException
    from rosidl_generator_py.import_type_support_impl import UnsupportedTypeSupport

    package, kind, name = type_.split("/")
    try:
        found = getattr(import_module(f"{package}.{kind}"), name)
        # A type whose support library is missing fails only where it is used.
        from rclpy.type_support import check_for_type_support

        check_for_type_support(found.Impl.FeedbackMessage if kind == "action" else found)
    except (*_BROKEN, NoTypeSupportImportedException, UnsupportedTypeSupport) as error:
        return None, str(error)
    return found, ""


def raw_message_class(type_: str) -> tuple[Any, str]:
    """Return a class with C type support (Python's loads numpy), or None and why there is none."""
    from rosidl_generator_py import import_type_support
    from rosidl_generator_py.import_type_support_impl import UnsupportedTypeSupport

    package, kind, name = type_.split("/")
    try:
        import_module(package)
        module = import_type_support(package)
        # As rosidl_generator_py calls the parts of a type: ``tf_message`` for TFMessage.
        ending = f"{kind}__{kind}__{_file_name(name)}"
        parts = {f"_{it.upper()}": getattr(module, f"{it}_{ending}") for it in _SUPPORT}
    except (*_BROKEN, UnsupportedTypeSupport) as error:
        return None, str(error)
    # Where rclpy looks for it.
    return type(type_, (type,), parts)(name, (), {}), ""


def _file_name(name: str) -> str:
    """Return a type's file name, as rosidl_pycommon (convert_camel_case_to_lower_case_underscore)."""
    parted = re.sub("(.)([A-Z][a-z]+)", r"\1_\2", name)
    return re.sub("([a-z0-9])([A-Z])", r"\1_\2", parted).lower()


def begins_with_header(type_: str) -> bool:
    """Return whether an installed message type begins with a header, by its source alone."""
    package, kind, name = type_.split("/")
    spec = find_spec(package)
    folders = (spec and spec.submodule_search_locations) or ()
    for folder in folders:
        with suppress(OSError):
            text = Path(folder, kind, f"_{_file_name(name)}.py").read_text(encoding="utf-8")
            first = _FIRST_FIELD.search(text)
            return first is not None and first[1] == "std_msgs/Header"
    return False


def subscribe(
    node: "Node",
    type_: Any,
    topic: str,
    latched: bool,
    callback: Callable[[bytes, int | None], None],
    depth: int = 0,
) -> Callable[[], None] | None:
    """Subscribe to serialized messages; return what ends it, None for a topic of another type already.

    ``depth`` of them wait to be received, by default as many as a listener to tf keeps. With
    ``latched`` earlier messages are received too.

    The callback gets a message and its number, by which its publisher counts; None if that is unknown.
    """
    from rclpy.impl.implementation_singleton import rclpy_implementation

    def numbered(message: bytes, info: Any) -> None:
        name = "publication_sequence_number"
        # A dictionary in Jazzy.
        number = info.get(name) if isinstance(info, dict) else getattr(info, name, None)
        callback(message, number)

    # Best effort works with reliable publishers too, but latched samples need a reliable reader.
    qos = _qos(latched, latched)
    qos.depth = depth or qos.depth
    with suppress(rclpy_implementation.RCLError):
        subscription = node.create_subscription(type_, topic, numbered, qos, raw=True)
        return lambda: node.destroy_subscription(subscription)
    return None


def receive(node: "Node") -> None:
    """Hand out what the subscriptions of a node have received.

    An executor waits for all of them anew for each message: a millisecond and more in a fleet.
    """
    for subscription in list(node.subscriptions):
        for message, info in _messages_of(subscription):
            subscription.callback(message, info)


def _messages_of(subscription: Any) -> Iterator[tuple[bytes, Any]]:
    """Yield the messages of a subscription, until there is none, or a callback has ended it."""
    from rclpy.impl.implementation_singleton import rclpy_implementation

    with suppress(rclpy_implementation.InvalidHandle):
        while taken := _next_message(subscription):
            yield taken


def _next_message(subscription: Any) -> tuple[bytes, Any] | None:
    with subscription.handle:
        taken: tuple[bytes, Any] | None
        taken = subscription.handle.take_message(subscription.msg_type, subscription.raw)
    return taken


def publish(node: "Node", type_: Any, topic: str, latched: bool) -> Any:
    """Return a reliable publisher; with ``latched`` later subscribers receive its messages too."""
    return node.create_publisher(type_, topic, _qos(latched, True))


def subscribe_and_drop(node: "Node", type_: Any, topic: str) -> None:
    """Subscribe with the usual QoS and ignore the messages."""
    node.create_subscription(type_, topic, lambda _: None, _qos(False, True))


def serve_action(node: "Node", type_: Any, name: str) -> None:
    """Make an action server whose goals never succeed."""
    from rclpy.action import ActionServer

    ActionServer(node, type_, name, lambda goal: type_.Result())


def call_action(node: "Node", type_: Any, name: str) -> None:
    """Make a client of an action."""
    from rclpy.action import ActionClient

    ActionClient(node, type_, name)


def _qos(latched: bool, reliable: bool) -> Any:
    from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

    durability = DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE
    reliability = ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT
    # A stand-in without tf2_msgs sends each fixed transform in a message of its own.
    depth = 1000 if latched else 100
    return QoSProfile(depth=depth, durability=durability, reliability=reliability)


def middleware() -> str:
    """Return the name of the RMW in use."""
    from rclpy.utilities import get_rmw_implementation_identifier

    return str(get_rmw_implementation_identifier())
