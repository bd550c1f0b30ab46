# SPDX-License-Identifier: Apache-2.0
"""Reads parameter files with the real rcl: JSON lines in, JSON lines out, ends with stdin.

Run by ``test_params_rcl`` in a process of its own; it needs rclpy and an RMW.
"""

from __future__ import annotations

import json
import os
import sys
from typing import Any

import rclpy
from rclpy.context import Context


def parameters(case: dict[str, Any]) -> list[dict[str, Any]] | None:
    """Return what each node (namespace, name) gets of the file; None where rcl refuses it."""
    own = Context()
    try:
        rclpy.init(args=["--ros-args", "--params-file", case["file"]], context=own)
    except Exception:
        return None
    try:
        return [of_node(own, *node) for node in case["nodes"]]
    finally:
        rclpy.shutdown(context=own)


def of_node(context: Context, namespace: str, name: str) -> dict[str, Any]:
    """Return the parameters that a node of this name starts with."""
    node = rclpy.create_node(
        name,
        namespace=namespace,
        context=context,
        automatically_declare_parameters_from_overrides=True,
        start_parameter_services=False,
        enable_rosout=False,
    )
    try:
        found = {key: it.value for key, it in node.get_parameters_by_prefix("").items()}
        return {key: plain(value) for key, value in found.items()}
    finally:
        node.destroy_node()


def plain(value: Any) -> Any:
    """Return a value as JSON has it."""
    if isinstance(value, str | bytes | bool | int | float) or value is None:
        return value if not isinstance(value, bytes) else list(value)
    return list(value)


if __name__ == "__main__":
    # Fast DDS logs to stdout: the answers get a way out of their own.
    out = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    for line in sys.stdin:
        print(json.dumps(parameters(json.loads(line))), file=out, flush=True)
