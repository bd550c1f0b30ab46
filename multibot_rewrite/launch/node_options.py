# SPDX-License-Identifier: Apache-2.0
"""The options of launch_ros's Node and ComposableNode for a node of a robot."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.fleet.robots.loaded_robot import LoadedRobot

# The fleet decides these; a launch file that sets them would contradict it.
FROM_THE_FLEET = ("name", "namespace")


def check_options(word: str, options: Mapping[str, Any]) -> None:
    """Raises UsageError for options that the fleet decides."""
    for it in FROM_THE_FLEET:
        if it in options:
            first = f'write {word}("amcl") with the name in its stack, and ' if it == "name" else ""
            raise UsageError(f"{word}: {it} comes from the fleet file; {first}remove {it}=")


def node_options(
    robot: LoadedRobot, name: str, files: list[str], options: Mapping[str, Any]
) -> dict[str, Any]:
    """``options`` with those of the node, or of a controller's spawner; raises UsageError.

    Given remappings come first and given parameters last, since rcl applies the first rule that
    matches and the last value.
    """
    if robot.table.is_controller(name):
        made = robot.spawner(name, *files)
        return {**options, **made, "arguments": [*made["arguments"], *listed(options, "arguments")]}
    return {
        **options,
        "name": robot.table.name(name),
        "namespace": robot.table.namespace(name),
        "remappings": [*listed(options, "remappings"), *robot.table.for_node(name)],
        "parameters": [*files, *listed(options, "parameters")],
    }


def with_program(
    robot: LoadedRobot, name: str, options: Mapping[str, Any], component: bool = False
) -> dict[str, Any]:
    """The options, with the program that the node's stack says where they say none; raises UsageError
    where neither does. ``component``: it is loaded into a container."""
    word = "plugin" if component else "executable"
    if word in options:
        return dict(options)
    program = robot.program(name)
    if program is None or not getattr(program, word):
        raise UsageError(f"no stack says what runs {name}; write package= and {word}=")
    made = {"package": program.package, word: getattr(program, word), **options}
    arguments = [] if component else [*program.words, *listed(options, "arguments")]
    return {**made, "arguments": arguments} if arguments else made


def listed(options: Mapping[str, Any], word: str) -> list[Any]:
    """An option that is a list; empty where it is not given."""
    return [*(options.get(word) or ())]
