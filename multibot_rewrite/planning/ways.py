# SPDX-License-Identifier: Apache-2.0
"""Where each node's remap rules are written, by release (deliveries), and what is started with them.

A node takes rules from its own process, from the node whose process it is in, from the container
that loads it, from its spawner, or from its plugin's tag. Sources: ros2_control
``controller_manager.cpp`` (``determine_controller_node_options``) and ``spawner.py``; rclcpp
``rclcpp_components/src/component_manager.cpp`` (``create_node_options``: no global arguments);
navigation2 ``nav2_costmap_2d/src/costmap_2d_ros.cpp``; gz_ros2_control ``gz_ros2_control_plugin.cpp``.
"""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple, TypeAlias

from multibot_rewrite.base.releases import has_release
from multibot_rewrite.knowledge.controller_ways import controller_way
from multibot_rewrite.knowledge.records import MANAGER
from multibot_rewrite.planning.of_runs import expanded
from multibot_rewrite.planning.records import Rule, Rules, Run, Table
from multibot_rewrite.system.records import COMPONENT, HOST, PLUGIN, PROCESS, SPAWNER

# A costmap has the remap rules of the component that makes it (navigation2 4cade8d2f, 1.5.0).
COSTMAP_HAS_RULES_OF_ITS_PARENT = "lyrical+"


class Delivery(NamedTuple):
    """Rules for a node, as they are written: left and right sides.

    ``taker`` is the node that is started with them, by its name in the node set: the node itself, its
    host or its container; for a plugin the node that the plugin is known by.
    """

    node: Run
    way: str
    taker: str
    rules: Rules


# A robot and a node's name in its node set.
Key: TypeAlias = tuple[str, str]
Nodes: TypeAlias = Mapping[Key, Run]
Sources: TypeAlias = Mapping[str, frozenset[str]]


def key_of(run: Run) -> Key:
    """Return a node's robot, and its name in its node set."""
    return run.robot, run.node


def deliveries(table: Table) -> tuple[Delivery, ...]:
    """Return where each node's rules are written; several nodes' rules are in that order."""
    nodes = merged(table.runs)
    known = {(it.robot, it.node): it for it in nodes}
    # By the full name of a node: what helper nodes of it use.
    helpers: dict[str, frozenset[str]] = {}
    for run in table.runs:
        asked = {name for end, _ in run.names if end.helper for _, name in expanded(end)}
        helpers[run.full_name] = helpers.get(run.full_name, frozenset()) | asked
    return tuple(it for node in nodes for it in _deliveries_of(node, known, table.release, helpers))


def rules_by_taker(given: Iterable[Delivery]) -> dict[Key, Rules]:
    """Return the rules by robot and taker; those for hosted nodes name them, so they come first."""
    found: dict[Key, dict[Rule, None]] = {}
    for it in sorted(given, key=lambda it: it.way != HOST):
        if it.way != PLUGIN or it.node.written:
            found.setdefault((it.node.robot, it.taker), {}).update(dict.fromkeys(it.rules))
    return {key: tuple(rules) for key, rules in found.items()}


def merged(nodes: Iterable[Run]) -> tuple[Run, ...]:
    """Return the nodes, each once: one of a description and a node set is that of the description."""
    found: dict[tuple[str, str], Run] = {}
    for node in nodes:
        key = (node.robot, node.full_name)
        before = found.setdefault(key, node)
        if node.written and not before.written:
            found[key] = node._replace(node=before.node)
    return tuple(found.values())


def way_of(node: Run, known: Nodes, release: str) -> str:
    """Return how a node gets its rules: PROCESS, HOST, COMPONENT, SPAWNER or PLUGIN."""
    if node.fact.plugin:
        return PLUGIN
    host = known.get((node.robot, node.fact.host))
    if node.fact.is_controller:
        if controller_way(release).spawner:
            return SPAWNER
        return PLUGIN if host and host.fact.plugin else HOST
    if host:
        return HOST
    return COMPONENT if (node.robot, node.fact.container) in known else PROCESS


def taker_of(node: Run, known: Nodes, release: str) -> str:
    """Return the node that is started with the rules of this one."""
    host = known.get((node.robot, node.fact.host))
    if way_of(node, known, release) not in (HOST, PLUGIN) or not node.fact.host:
        return node.node
    parent = has_release(COSTMAP_HAS_RULES_OF_ITS_PARENT, release)
    if host and way_of(host, known, release) == COMPONENT and not parent:
        return host.fact.container
    return node.fact.host


def _deliveries_of(node: Run, known: Nodes, release: str, helpers: Sources) -> Iterator[Delivery]:
    """Yield where the rules of a node are written, and those of its helper nodes."""
    way, taker = way_of(node, known, release), taker_of(node, known, release)
    lead = f"{node.name}:" if way == HOST else ""
    yield Delivery(
        node, way, taker, tuple((f"{lead}{source}", target) for source, target in node.rules)
    )
    # A helper node has the rules of its process alone, and not by the name of the node it helps.
    # Its process is that of its host, or the container of either.
    host = known.get((node.robot, node.fact.host), node)
    process = known.get((node.robot, host.fact.container), host)
    asked = helpers.get(node.full_name, frozenset())
    asked -= {source for source, _ in process.rules}
    rules = tuple(it for it in node.rules if it[0] in asked)
    if rules and process is not node:
        yield Delivery(node, HOST, process.node, rules)


# The package and the program that load a controller.
SPAWN = ("controller_manager", "spawner")
STARTED = (PROCESS, COMPONENT, SPAWNER)


class Started(NamedTuple):
    """Something that is started for a node, and all rules it takes, also those of nodes in it.

    ``way`` is one of ``STARTED``; ``manager`` is the name of a controller's manager.
    """

    node: Run
    way: str
    rules: Rules
    manager: str = MANAGER


def started(table: Table) -> Iterator[Started]:
    """Yield what is started for a table's nodes, but not those in another's process or plugin."""
    given = deliveries(table)
    rules = rules_by_taker(given)
    controllers = (it.node for it in given if it.node.fact.is_controller)
    # The node that a node set has for the spawner of a controller is that spawner.
    spawners = {(it.robot, f"spawner_{it.node}") for it in controllers}
    # A node's first delivery is its own, another one that of its helper nodes.
    first = {key_of(it.node): it for it in reversed(given)}
    for it in given:
        node, own = it.node, rules.get((it.node.robot, it.taker), ())
        if node.fact.is_controller and first[key_of(node)] is not it:
            continue
        if node.fact.is_controller:
            taken = own if it.way == SPAWNER else ()
            yield Started(node, SPAWNER, taken, node.host_name or MANAGER)
        elif it.way in STARTED and (node.robot, node.node) not in spawners:
            yield Started(node, it.way, own)


def arguments(it: Started) -> list[str]:
    """Return the arguments of ``ros2 run``, ``ros2 component load`` or a spawner; may be empty."""
    if it.way == SPAWNER:
        return [*spawner_arguments(it), *ros_arguments(it.node.namespace, "", ())]
    if it.way == COMPONENT:
        rules = (word for source, target in it.rules for word in ("-r", f"{source}:={target}"))
        return ["-n", it.node.name, "--node-namespace", it.node.namespace, *rules]
    return ros_arguments(it.node.namespace, it.node.other_name, it.rules)


def launch_arguments(it: Started) -> dict[str, Any]:
    """Return the keywords of launch_ros's Node, of ComposableNode for a component."""
    if it.way == SPAWNER:
        package, executable = SPAWN
        program = {"package": package, "executable": executable}
        return {**program, "namespace": it.node.namespace, "arguments": spawner_arguments(it)}
    return {"namespace": it.node.namespace, "name": it.node.name, "remappings": list(it.rules)}


def spawner_arguments(it: Started) -> list[str]:
    """Return the arguments of the spawner, without ROS's own.

    The rules are one value: the spawner splits it at blanks, in all releases that have the option.
    """
    manager = ["-c", it.manager] if it.manager != MANAGER else []
    rules = " ".join(f"-r {source}:={target}" for source, target in it.rules)
    return [it.node.name, *manager, *(["--controller-ros-args", rules] if rules else [])]


def ros_arguments(namespace: str, name: str, rules: Iterable[Rule]) -> list[str]:
    """Return ``--ros-args`` with namespace, name (empty: that in the code) and rules; may be empty."""
    placed = [f"__ns:={namespace}"] if namespace != "/" else []
    named = [f"__node:={name}"] if name else []
    words = [*placed, *named, *(f"{source}:={target}" for source, target in rules)]
    given = [text for word in words for text in ("-r", word)]
    return ["--ros-args", *given] if given else []
