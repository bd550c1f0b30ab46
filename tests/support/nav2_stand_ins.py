# SPDX-License-Identifier: Apache-2.0
"""Stands for the programs of a launch: nodes with the command lines that launch gave them.

A child process: its order, one line of JSON, are processes (``nav2_cells``). The real rcl reads each
command line and parameter file; a node's topics are those of its facts, under the names that its
parameters give. Sends which types replace others, and runs until its input is closed.
"""

from __future__ import annotations

import json
import sys
import threading
from typing import Any
from xml.etree import ElementTree

import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter

from multibot_rewrite.knowledge.records import Endpoint
from multibot_rewrite.live import stub_nodes
from multibot_rewrite.live.rehearsal import TF, substitute_type
from multibot_rewrite.producers.ros.request import Send, run_worker
from multibot_rewrite.system.records import TOPIC, edge_of

SECONDS = 0.1
# What code adds to the name that a parameter gives, for a second topic (costmap_subscriber.cpp,
# slam_toolbox_common.cpp).
ADDED = ("_updates", "_metadata")


def main(order: str, stop: threading.Event, send: Send) -> int:
    """Run the processes of the order until ``stop``."""
    replaced: dict[str, str] = {}
    made = [it for process in json.loads(order) for it in started(process, replaced)]
    send(json.dumps(replaced).encode())
    while not stop.wait(SECONDS):
        for publish in made:
            publish()
    return 0


def started(process: dict[str, Any], replaced: dict[str, str]) -> list[Any]:
    """Return the nodes of one process, spinning; what they publish again and again."""
    context = Context()
    rclpy.init(args=[process["program"], *process["words"]], context=context)
    executor = SingleThreadedExecutor(context=context)
    session = stub_nodes.ros.Session(context, executor)
    stubs = stub_nodes._Stubs(session, replaced)
    made = []
    above = ""
    for one in process["nodes"]:
        node = created(context, one, above)
        above = above if one["below"] else node.get_namespace()
        executor.add_node(node)
        made += endpoints(stubs, node, one)
    threading.Thread(target=executor.spin, daemon=True).start()
    return made


def created(context: Context, one: dict[str, Any], above: str) -> Any:
    """Return a node as its code makes it: in a namespace below that of its host, if it has a host."""
    own = [*one["words"]]
    if one["below"]:
        space = f"{above.rstrip('/')}/{one['below']}"
        own += ["-r", f"__ns:={space}", "-r", f"__node:={one['name']}"]
    return Node(
        one["name"],
        context=context,
        cli_args=["--ros-args", *own] if own else [],
        parameter_overrides=[Parameter(name, value=value) for name, value in one["parameters"]],
        automatically_declare_parameters_from_overrides=True,
        enable_rosout=False,
    )


def endpoints(stubs: Any, node: Any, one: dict[str, Any]) -> list[Any]:
    """Its topics, services and actions, under the names that its parameters give."""

    def value(name: str, default: Any = None) -> Any:
        return node.get_parameter(name).value if node.has_parameter(name) else default

    edges = [
        edge_of(value(*parent), value(*child), False) for parent, child in one["sends"]
    ] + list(described(value("robot_description", "")))
    made: list[Any] = []
    helpers: dict[str, Any] = {}
    for kind, role, name, type_, parameter, helped, by, above in one["endpoints"]:
        named = str(value(parameter, name)) if parameter else name
        if parameter:
            named += next((it for it in ADDED if name.endswith(it) and named != name), "")
        if parameter and above and (not named.startswith("/") or value(parameter) is None):
            # The code joins the namespace above with a relative name, and with its default.
            named = f"{node.get_namespace().rpartition('/')[0]}/{named.strip('/')}"
        if helped and by not in helpers:
            helpers[by] = helper_of(stubs.session, node, by)
        owner = helpers[by] if helped else node
        end = Endpoint(kind, role, named, type_)
        made += stub_nodes._create_endpoint(stubs, owner, end, edges)
    if one["name"] == "tf_namespace_bridge":
        for topic in ("tf", "tf_static"):
            relay(node, topic, f"/{topic}", stubs.replaced, node.get_namespace().strip("/") + "/")
    if value("input_topic"):
        relay(node, value("input_topic"), value("output_topic"), stubs.replaced)
    for managed in value("node_names", []) if one["manager"] else []:
        for service, type_ in (("change_state", "ChangeState"), ("get_state", "GetState")):
            end = Endpoint(
                "service", "calls", f"{managed}/{service}", f"lifecycle_msgs/srv/{type_}"
            )
            made += stub_nodes._create_endpoint(stubs, node, end, ())
    return made


def relay(node: Any, source: str, target: str, replaced: dict[str, str], prefix: str = "") -> None:
    """As topic_tools does: what comes goes out, with the same QoS; or with a prefix, as
    tf_namespace_bridge does."""

    def passed_on(message: Any) -> None:
        # A transform alone stands for tf2_msgs where that is not installed.
        for it in getattr(message, "transforms", (message,)):
            it.header.frame_id = f"{prefix}{it.header.frame_id}"
            it.child_frame_id = f"{prefix}{it.child_frame_id}"
        publisher.publish(message)

    type_ = stub_nodes._installed_class(TF)
    if type_ is None:
        replaced[TF] = substitute_type(TOPIC, TF)
        type_ = stub_nodes._installed_class(replaced[TF])
    latched = "tf_static" in source
    publisher = stub_nodes.ros.publish(node, type_, target, latched)
    node.create_subscription(type_, source, passed_on, stub_nodes.ros._qos(latched, True))


def helper_of(session: Any, node: Any, by: str) -> Any:
    """Return a node that another one makes: it has the words of the process and a name of its own."""
    own = f"{id(node):x}"
    name = node.get_name() + by.replace("*", own) if by else f"transform_listener_impl_{own}"
    words = ["--ros-args", "-r", f"__node:={name}"]
    helper = Node("helper", context=session.context, cli_args=words, enable_rosout=False)
    session.executor.add_node(helper)
    return helper


def described(text: str) -> Any:
    """Yield the transforms of a description, as robot_state_publisher sends them."""
    for joint in ElementTree.fromstring(text).iter("joint") if text else ():
        ends = [joint.find(it) for it in ("parent", "child")]
        if all(it is not None for it in ends):
            parent, child = (it.get("link") for it in ends)
            yield edge_of(parent, child, joint.get("type") == "fixed")


if __name__ == "__main__":
    sys.exit(run_worker(main))
