"""What a robot's nodes are started with: processes, components and the spawners of controllers."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.knowledge.records import MANAGER
from multibot_rewrite.spelling.records import NodeTable, Table
from multibot_rewrite.spelling.ways import (
    COMPONENT,
    PROCESS,
    SPAWNER,
    Pair,
    deliveries,
    rules_by_taker,
)

# The package and the program that load a controller.
SPAWN = ("controller_manager", "spawner")
STARTED = (PROCESS, COMPONENT, SPAWNER)


class Started(NamedTuple):
    """Something that is started for a node, and all rules it takes, also those of nodes in it.

    ``way`` is one of ``STARTED``; ``manager`` is the name of a controller's manager.
    """

    node: NodeTable
    way: str
    rules: tuple[Pair, ...]
    manager: str = MANAGER


def started(table: Table) -> Iterator[Started]:
    """What is started for the nodes of a table; a node in another's process or plugin is not.

    A controller is always started by a spawner, also where that takes no rules.
    """
    given = deliveries(table)
    rules = rules_by_taker(given)
    names = {it.node.robot: it.node.name for it in given if it.node.node == MANAGER}
    controllers = (it.node for it in given if it.node.home.is_controller)
    # The node that a stack has for the spawner of a controller is that spawner.
    spawners = {(it.robot, f"spawner_{it.node}") for it in controllers}
    # A node's first delivery is its own, another one that of its helper nodes.
    first = {it.node: it for it in reversed(given)}
    for it in given:
        node, own = it.node, rules.get((it.node.robot, it.taker), ())
        if node.home.is_controller and first[node] is not it:
            continue
        if node.home.is_controller:
            taken = own if it.way == SPAWNER else ()
            yield Started(node, SPAWNER, taken, names.get(node.robot, MANAGER))
        elif it.way in STARTED and (node.robot, node.node) not in spawners:
            yield Started(node, it.way, own)


def arguments(it: Started) -> list[str]:
    """What follows ``ros2 run PACKAGE EXECUTABLE``, the spawner of a controller,
    or ``ros2 component load CONTAINER PACKAGE PLUGIN``; empty if nothing is needed."""
    if it.way == SPAWNER:
        return [*spawner_arguments(it), *ros_arguments(it.node.namespace, "", ())]
    if it.way == COMPONENT:
        rules = (word for source, target in it.rules for word in ("-r", f"{source}:={target}"))
        return ["-n", it.node.name, "--node-namespace", it.node.namespace, *rules]
    return ros_arguments(it.node.namespace, it.node.other_name, it.rules)


def launch_arguments(it: Started) -> dict[str, Any]:
    """The keywords of launch_ros's Node, of ComposableNode for a component."""
    if it.way == SPAWNER:
        package, executable = SPAWN
        program = {"package": package, "executable": executable}
        return {**program, "namespace": it.node.namespace, "arguments": spawner_arguments(it)}
    return {"namespace": it.node.namespace, "name": it.node.name, "remappings": list(it.rules)}


def spawner_arguments(it: Started) -> list[str]:
    """What follows the spawner besides ROS's own arguments.

    The rules are one value: the spawner splits it at blanks, in all releases that have the option.
    """
    manager = ["-c", it.manager] if it.manager != MANAGER else []
    rules = " ".join(f"-r {source}:={target}" for source, target in it.rules)
    return [it.node.name, *manager, *(["--controller-ros-args", rules] if rules else [])]


def ros_arguments(namespace: str, name: str, rules: Iterable[Pair]) -> list[str]:
    """``--ros-args`` with namespace, name (empty for that in the code) and rules; may be empty."""
    placed = [f"__ns:={namespace}"] if namespace != "/" else []
    named = [f"__node:={name}"] if name else []
    words = [*placed, *named, *(f"{source}:={target}" for source, target in rules)]
    given = [text for word in words for text in ("-r", word)]
    return ["--ros-args", *given] if given else []
