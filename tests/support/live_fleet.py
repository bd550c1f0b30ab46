# SPDX-License-Identifier: Apache-2.0
"""Live nodes for tests: a process of rclpy nodes that ends cleanly when its standard input closes.

Run as ``python live_fleet.py SPEC``; SPEC is JSON, a list of nodes: {"name", "namespace", and lists
"publishers", "subscriptions", "services", "clients", "actions" of [name, type, QoS words],
"frames" of [topic, static or not, [parent, child], ...], "headers" of [topic, type, frame, QoS words]:
messages that it sends, ten a second or, latched, one; an image has a megabyte; odometry has its two
frames as "odom base_link"}. "bare": a node without
what every node brings, as far as rclpy lets it. "alone": a DDS participant of its own, as if in a
process of its own. "arguments": what a command line tells the node. "parameters": those that it
declares, "changed" those that it gets when its process is sent SIGUSR1. "state": what it answers to
GetState. "wait": seconds until the next node is made.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

from waiting import PATIENCE

READY, CLOCK = "ready", "rosgraph_msgs/msg/Clock"
_MODULES = {
    "TFMessage": "tf2_msgs.msg",
    "Trigger": "std_srvs.srv",
    "LookupTransform": "tf2_msgs.action",
}


def environ(domain: int) -> dict[str, str]:
    """Return the environment of nodes that meet on this machine in ``domain`` only."""
    kept = {k: v for k, v in os.environ.items() if not k.startswith(("ROS_", "RMW_", "FASTRTPS_"))}
    return {**kept, "ROS_DOMAIN_ID": str(domain), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}


@contextmanager
def running(
    domain: int, *specs: list[dict[str, Any]], inside: Sequence[str] = (), **more: str
) -> Iterator[list[subprocess.Popen[str]]]:
    """One process a spec; they are up inside the block and ended after it, each cleanly.

    ``inside`` is put before their command lines, ``more`` into their environment.
    """
    with ExitStack() as stack:
        env = {**environ(domain), **more}
        children = [stack.enter_context(_child(spec, env, inside)) for spec in specs]
        for child in children:
            assert child.stdout is not None
            assert child.stdout.readline().strip() == READY
        yield children


@contextmanager
def _child(
    spec: list[dict[str, Any]], env: Mapping[str, str], inside: Sequence[str]
) -> Iterator[subprocess.Popen[str]]:
    command = [*inside, sys.executable, str(Path(__file__)), json.dumps(spec)]
    pipe = subprocess.PIPE
    child = subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True, env=env)
    assert child.stdin is not None and child.stdout is not None
    try:
        yield child
    finally:
        child.stdin.close()
        try:
            child.wait(PATIENCE)
        finally:
            child.kill()
            child.wait()
            child.stdout.close()


def main(spec: str) -> None:
    """Start the nodes, say so, hold them until standard input closes."""
    import rclpy
    from rclpy.executors import SingleThreadedExecutor

    # A terminal's Ctrl-C ends the test, which then closes the input.
    rclpy.init(args=[], signal_handler_options=rclpy.signals.SignalHandlerOptions.NO)
    executor = SingleThreadedExecutor()
    specs = json.loads(spec)
    nodes = []
    for one in specs:
        nodes.append(_node(one, executor))
        time.sleep(one.get("wait", 0))
    # Nobody is answered; a large fleet that spins would keep the machine busy.
    busy = ("frames", "headers", "parameters", "state")
    sends = any(one.get(key) for one in specs for key in busy)
    sends = sends or any(it[1] == CLOCK for one in specs for it in one.get("publishers", ()))
    print(READY, flush=True)
    stop = _input_closed()
    while not stop.done():
        executor.spin_once(timeout_sec=0.05) if sends else time.sleep(0.05)
    for node in nodes:
        node.destroy_node()
    for context in {node.context for node in nodes}:
        context.try_shutdown()


def _input_closed() -> Any:
    from concurrent.futures import ThreadPoolExecutor

    return ThreadPoolExecutor(1).submit(sys.stdin.read)


def _node(spec: Mapping[str, Any], executor: Any) -> Any:
    from rclpy.node import Node

    node = Node(
        spec["name"],
        context=_context() if spec.get("alone") else None,
        cli_args=spec.get("arguments"),
        namespace=spec.get("namespace", ""),
        start_parameter_services=not spec.get("bare"),
        enable_rosout=not spec.get("bare"),
    )
    if spec.get("bare"):
        node.destroy_publisher(node._parameter_event_publisher)
    if not spec.get("alone"):
        executor.add_node(node)
    for name, value in spec.get("parameters", {}).items():
        node.declare_parameter(name, value)
    if spec.get("changed"):
        signal.signal(signal.SIGUSR1, lambda *_: _change(node, spec["changed"]))
    for name, type_, *words in spec.get("publishers", ()):
        publisher = node.create_publisher(_type(type_), name, _qos(words))
        _run_clock(node, publisher, type_)
    for name, type_, *words in spec.get("subscriptions", ()):
        node.create_subscription(_type(type_), name, lambda _: None, _qos(words))
    for name, type_ in spec.get("services", ()):
        node.create_service(_type(type_), name, lambda _, answer: answer)
    for name, type_ in spec.get("clients", ()):
        node.create_client(_type(type_), name)
    for name, type_ in spec.get("actions", ()):
        _action(node, _type(type_), name)
    if spec.get("state"):
        _answer_state(node, spec["state"])
    for topic, static, *edges in spec.get("frames", ()):
        _send_frames(node, topic, static, edges)
    for header in spec.get("headers", ()):
        _send_header(node, *header)
    return node


def _run_clock(node: Any, publisher: Any, type_: str) -> None:
    """Publish the time of a simulation that has run for a while, if the publisher is a clock."""
    if type_ != CLOCK:
        return
    message = _type(CLOCK)()

    def tick() -> None:
        message.clock.sec += 1
        publisher.publish(message)

    node.create_timer(0.1, tick)


def _change(node: Any, values: Mapping[str, Any]) -> None:
    from rclpy.parameter import Parameter

    node.set_parameters([Parameter(name, value=value) for name, value in values.items()])


def _context() -> Any:
    import rclpy
    from rclpy.signals import SignalHandlerOptions

    context = rclpy.Context()
    rclpy.init(args=[], context=context, signal_handler_options=SignalHandlerOptions.NO)
    return context


def _action(node: Any, type_: Any, name: str) -> None:
    from rclpy.action import ActionServer

    ActionServer(node, type_, name, lambda goal: type_.Result())


def _answer_state(node: Any, label: str) -> None:
    """As a managed node does."""
    from lifecycle_msgs.srv import GetState

    def answer(_: Any, response: Any) -> Any:
        response.current_state.label = label
        return response

    node.create_service(GetState, "~/get_state", answer)


def _send_frames(node: Any, topic: str, static: bool, edges: list[list[str]]) -> None:
    """Edges as [parent, child]; static ones once and kept, the others ten times a second."""
    from geometry_msgs.msg import TransformStamped

    type_ = _type("TFMessage")
    message = type_()
    for parent, child in edges:
        transform = TransformStamped(child_frame_id=child)
        transform.header.frame_id = parent
        transform.transform.translation.x = 1.5
        message.transforms.append(transform)
    publisher = node.create_publisher(type_, topic, _qos(["latched"] if static else []))

    def publish() -> None:
        now = node.get_clock().now().to_msg()
        for transform in message.transforms:
            transform.header.stamp = now
        publisher.publish(message)

    if static:
        publish()
    else:
        node.create_timer(0.1, publish)


def _send_header(node: Any, topic: str, type_: str, frame: str, *words: str) -> None:
    message = _type(type_)()
    message.header.frame_id, _, child = frame.partition(" ")
    if hasattr(message, "encoding"):
        message.data = bytes(1 << 20)
    if child:
        message.child_frame_id = child
        message.pose.pose.orientation.w = 1.0
    publisher = node.create_publisher(type(message), topic, _qos(list(words)))

    def publish() -> None:
        message.header.stamp = node.get_clock().now().to_msg()
        publisher.publish(message)

    if "latched" in words:
        publish()
    else:
        node.create_timer(0.1, publish)


def _type(word: str) -> Any:
    from importlib import import_module

    module, _, name = word.replace("/", ".").rpartition(".")
    return getattr(import_module(module or _MODULES.get(word, "std_msgs.msg")), name)


def _qos(words: list[str]) -> Any:
    from rclpy.duration import Duration
    from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

    qos = QoSProfile(depth=10)
    if "best_effort" in words:
        qos.reliability = ReliabilityPolicy.BEST_EFFORT
    if "latched" in words:
        qos.durability = DurabilityPolicy.TRANSIENT_LOCAL
    if "deadline" in words:
        qos.deadline = Duration(seconds=0.5)
    return qos


if __name__ == "__main__":
    main(sys.argv[1])
