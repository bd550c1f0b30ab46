"""The rules that rcl has for each node once it runs, from where they stand: deliveries -> rules.

The first match counts: a node's own arguments come before those of its process.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.base.rosnames import BoundNode, bind, parse_remap
from multibot_rewrite.knowledge.controller_ways import ControllerWay, controller_way
from multibot_rewrite.knowledge.records import MANAGER, Endpoint
from multibot_rewrite.spelling.records import NodeTable, Table
from multibot_rewrite.spelling.ways import (
    COMPONENT,
    PLUGIN,
    SPAWNER,
    Delivery,
    Key,
    Pair,
    deliveries,
    rules_by_taker,
)
from multibot_rewrite.system.records import PUBLISHES


class RunningNode(NamedTuple):
    """A node as it is started: the rules that it has, and the namespace and rules that its process
    has, which are those of a helper node in it. ``handed_on`` are the rules of controllers that it
    loads and that no stack names."""

    node: NodeTable
    way: str
    rules: tuple[Pair, ...]
    process_namespace: str
    process_rules: tuple[Pair, ...]
    handed_on: tuple[Pair, ...] = ()


class _Standing(NamedTuple):
    """The rules by robot and taker, and those that hold for the whole process of the simulator."""

    rules: Mapping[Key, tuple[Pair, ...]]
    world: tuple[Pair, ...]
    nodes: Mapping[Key, NodeTable]
    controllers: ControllerWay


def running_nodes(table: Table, left_out: Collection[str] = ()) -> Iterator[RunningNode]:
    """Every node with its rules; those that stand at one of the ways ``left_out`` are missing."""
    meant = deliveries(table)
    given = [it for it in meant if it.way not in left_out]
    standing = _Standing(
        rules_by_taker(given),
        _of_simulator(given),
        {(it.node.robot, it.node.node): it.node for it in meant},
        controller_way(table.release),
    )
    # A component's first delivery is its own, the second that of its helper nodes.
    first = {it.node: it for it in reversed(meant)}
    yield from (_running(it, standing) for it in reversed(first.values()))


def _of_simulator(given: Iterable[Delivery]) -> tuple[Pair, ...]:
    """The rules of the first plugin that starts ROS in the simulator."""
    return next((it.rules for it in given if it.node.home.process_wide), ())


def _running(it: Delivery, standing: _Standing) -> RunningNode:
    node, own = it.node, standing.rules.get((it.node.robot, it.taker), ())
    if it.way == SPAWNER:
        # A tf listener that its code makes has the arguments of the manager's process alone.
        process = standing.rules.get((node.robot, MANAGER), standing.world)
        rules = (*_forwarded(node, standing), *own)
        return RunningNode(node, it.way, rules, node.namespace, process)
    if it.way == PLUGIN:
        rules, wide = _of_plugin(node, own, standing), standing.world
        given = own if standing.controllers.forwarded else ()
        handed_on = wide if standing.controllers.process_wide else given
        return RunningNode(node, it.way, rules, node.namespace, wide, handed_on)
    taker = standing.nodes.get((node.robot, it.taker), node)
    container = standing.nodes.get((node.robot, taker.home.container))
    if container is None:
        return RunningNode(node, it.way, own, taker.namespace, own)
    process = standing.rules.get((node.robot, container.node), ())
    # What a component makes has the arguments of the process as well, the component has not.
    rules = own if it.way == COMPONENT else (*own, *process)
    return RunningNode(node, it.way, rules, container.namespace, process)


def _forwarded(node: NodeTable, standing: _Standing) -> tuple[Pair, ...]:
    return standing.rules.get((node.robot, MANAGER), ()) if standing.controllers.forwarded else ()


def _of_plugin(node: NodeTable, own: tuple[Pair, ...], standing: _Standing) -> tuple[Pair, ...]:
    """A plugin's rules are its own; nodes without any have those of the first robot's plugin."""
    if node.home.written and not node.home.process_wide:
        return own
    if not node.home.written or standing.controllers.process_wide:
        return standing.world
    return tuple(dict.fromkeys((*own, *standing.world)))


def is_stand_in(node: NodeTable, endpoint: Endpoint) -> bool:
    """Is this a topic of a controller of the plugin, and not of the controller manager itself?

    Those are what the plugin is known to publish, and without a role what its rules name.
    """
    return node.home.process_wide and endpoint.role in (PUBLISHES, "")


def bound_to(node: NodeTable, rules: Iterable[Pair]) -> BoundNode:
    """The node under these rules."""
    found = (parse_remap(f"{source}:={target}") for source, target in rules)
    return bind(node.name, node.namespace, filter(None, found))
