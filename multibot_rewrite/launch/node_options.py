"""The options of launch_ros's Node and ComposableNode for a node of a robot."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from multibot_rewrite.fleets.scripts import LoadedRobot


def node_options(
    robot: LoadedRobot, name: str, files: list[str], options: Mapping[str, Any]
) -> dict[str, Any]:
    """``options`` with those of the node, or of a controller's spawner; raises UsageError.

    Given remappings come first and given parameters last, since rcl applies the first rule that
    matches and the last value.
    """
    if robot.table.is_controller(name):
        made = robot.spawner(name, *files)
        return {**options, **made, "arguments": [*made["arguments"], *options.get("arguments", ())]}
    return {
        **options,
        "name": robot.table.name(name),
        "namespace": robot.table.namespace(name),
        "remappings": [*(options.get("remappings") or ()), *robot.table.for_node(name)],
        "parameters": [*files, *(options.get("parameters") or ())],
    }
