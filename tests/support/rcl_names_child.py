# SPDX-License-Identifier: Apache-2.0
"""Answers questions about names with the real rcl: JSON lines in, JSON lines out, ends with stdin.

Run by ``test_rcl_agreement`` in a process of its own; it needs rclpy and an RMW.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import rclpy
from rclpy.context import Context
from rclpy.exceptions import NameValidationException
from rclpy.expand_topic_name import expand_topic_name
from rclpy.impl.implementation_singleton import rclpy_implementation as rcl
from rclpy.node import Node
from rclpy.utilities import remove_ros_args

# What rclpy.validate_*_name call; those keep the place to themselves.
CHECKS: dict[str, Callable[[str], object]] = {
    "topic": rcl.rclpy_get_validation_error_for_topic_name,
    "full": rcl.rclpy_get_validation_error_for_full_topic_name,
    "namespace": rcl.rclpy_get_validation_error_for_namespace,
    "node": rcl.rclpy_get_validation_error_for_node_name,
}
# Everything rclpy raises for a name or rule it will not have (RCLError is a RuntimeError).
REFUSALS = (NameValidationException, RuntimeError, ValueError)


def arguments(rules: list[str]) -> list[str]:
    """``rules`` as ROS arguments."""
    return ["--ros-args", *(word for rule in rules for word in ("-r", rule))]


def answer(case: dict[str, Any]) -> object:
    """Return what rcl says to one case; a check answers with reason and byte, or None for no fault."""
    kind = case["ask"]
    if kind == "check":
        return CHECKS[case["what"]](case["name"])
    if kind == "expand":
        return refused_or(lambda: expand_topic_name(case["name"], case["node"], case["namespace"]))
    if kind == "parse":
        return refused_or(lambda: remove_ros_args(arguments([case["rule"]])) == [])
    return refused_or(lambda: started(case))


def refused_or(ask: Callable[[], object]) -> object:
    """Return the answer, or None for a refusal."""
    try:
        return ask()
    except REFUSALS:
        return None


def started(case: dict[str, Any]) -> list[object]:
    """Return a node's full name under its rules, and where each of its names leads."""
    with context(case["process_rules"]) as own:
        node = rclpy.create_node(
            case["node"],
            context=own,
            namespace=case["namespace"],
            cli_args=arguments(case["node_rules"]),
            use_global_arguments=case["use_process_rules"],
            start_parameter_services=False,
            enable_rosout=False,
        )
        try:
            return [node.get_fully_qualified_name(), *(led(node, *name) for name in case["names"])]
        finally:
            node.destroy_node()


def led(node: Node, kind: str, name: str) -> object:
    """Where one name leads."""
    resolve = node.resolve_service_name if kind == "service" else node.resolve_topic_name
    return refused_or(lambda: resolve(name))


@contextmanager
def context(rules: list[str]) -> Iterator[Context]:
    """Yield a context of its own with the process's rules."""
    own = Context()
    rclpy.init(args=arguments(rules), context=own)
    try:
        yield own
    finally:
        rclpy.shutdown(context=own)


if __name__ == "__main__":
    # Fast DDS logs to stdout: the answers get a way out of their own.
    out = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    for line in sys.stdin:
        print(json.dumps(answer(json.loads(line))), file=out, flush=True)
