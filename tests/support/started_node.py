# SPDX-License-Identifier: Apache-2.0
"""What a Python program opens under the real rclpy: ``started_node.py FILE FUNCTION [ROS ARGUMENTS]``.

Its function is run until it spins; then the endpoints of its nodes are printed as JSON.
"""

from __future__ import annotations

import importlib.util
import json
import sys
from pathlib import Path
from typing import Any

import rclpy
from rclpy.executors import SingleThreadedExecutor

ASKED = {
    "publishes": "get_publisher_names_and_types_by_node",
    "subscribes": "get_subscriber_names_and_types_by_node",
    "serves": "get_service_names_and_types_by_node",
    "calls": "get_client_names_and_types_by_node",
}


def told(*nodes: Any) -> None:
    found = []
    for node in nodes:
        name, space = node.get_name(), node.get_namespace()
        for role, method in ASKED.items():
            for end, types in getattr(node, method)(name, space):
                found.append([node.get_fully_qualified_name(), role, end, *types])
    print(json.dumps(found))
    sys.stdout.flush()
    rclpy.try_shutdown()
    sys.exit(0)


def main() -> None:
    file, function, *_ = sys.argv[1:]
    rclpy.spin = lambda node, executor=None: told(node)
    SingleThreadedExecutor.spin = lambda self: told(*self.get_nodes())
    package = Path(file).parent
    sys.path.insert(0, str(package.parent))
    module = importlib.import_module(f"{package.name}.{Path(file).stem}")
    getattr(module, function)()


if __name__ == "__main__":
    main()
