# SPDX-License-Identifier: Apache-2.0
"""Robots, nodes and a naming policy -> the remap table: each node's rules and resolved names.

A rule is made only for a name that would otherwise be the same for every robot. The table is checked
by resolving every name with its rules as rcl does (``rosnames``), not by trusting the rules.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TypeAlias

from multibot_rewrite.base.gc_pause import gc_paused
from multibot_rewrite.base.naming import NAMESPACE, Naming
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.base.rosnames import RemapRule, bind, expand, parse_remap, resolve_bound
from multibot_rewrite.description.readback.nodes import ReadNode
from multibot_rewrite.description.readback.reading import Reading
from multibot_rewrite.knowledge.controller_ways import controller_way
from multibot_rewrite.knowledge.records import Endpoint, FrameParameter, NodeFacts, SentTransform
from multibot_rewrite.spelling.records import EndpointName, Home, NodeRule, NodeTable, Pairs, Table
from multibot_rewrite.spelling.table_checks import (
    PROBE,
    asked_for,
    unreachable,
    useless_rules,
)
from multibot_rewrite.spelling.targets import expanded, placed, target_of
from multibot_rewrite.spelling.way_checks import NOT_TAKEN, is_stand_in, not_taken
from multibot_rewrite.system.records import ACTION, TOPIC

SAME = "all robots would share this name otherwise"
TOGETHER = "all robots share this name; each would have its own otherwise"
NOTHING: Mapping[str, Pairs] = {}
# The full name of a robot's node, by its name in the stack.
Places: TypeAlias = Mapping[str, str]
NOWHERE: Places = {}


def build_table(
    robots: Sequence[str],
    nodes: Sequence[NodeFacts],
    naming: Naming,
    plugins: Mapping[str, Pairs] = NOTHING,
    *,
    release: str,
) -> Table:
    """The remap table of a fleet with its problems; nodes for all robots are in it once.

    ``nodes`` run once for each robot; ``plugins`` are those of each robot's rewritten description.
    """
    with gc_paused():
        made = _build(robots, nodes, naming, plugins, release)
        return made._replace(problems=(*made.problems, *not_taken(made)))


def _build(
    robots: Sequence[str],
    nodes: Sequence[NodeFacts],
    naming: Naming,
    plugins: Mapping[str, Pairs],
    release: str,
) -> Table:
    shared = [(node, node_table("", node, naming)) for node in nodes if node.shared]
    # Made once: another robot's table differs only in the robot's name.
    others, once = places_of(PROBE, nodes, naming), frozenset(node.name for node, _ in shared)
    own = [
        (node, node_table(PROBE, node, naming, others, once)) for node in nodes if not node.shared
    ]
    meant = list(names_of(own))
    apart = {robot: _without_stand_ins(pairs, nodes) for robot, pairs in plugins.items()}
    names = {robot: [*_renamed(meant, robot), *names_of(apart.get(robot, ()))] for robot in robots}
    problems = [
        *unreachable([node for node, _ in own], naming),
        *useless_rules(own, release),
    ]
    for robot in robots:
        controllers = _given_by_plugins(own, robot, release)
        problems += useless_rules(plugins.get(robot, ()), release, controllers)
    kept = [*names_of(shared), *(name for robot in robots for name in names[robot])]
    tables = [table for _, table in shared]
    for robot in robots:
        tables += [*_copies(own, robot), *(table for _, table in plugins.get(robot, ()))]
    return Table(naming.layout.name, tuple(tables), tuple(kept), tuple(problems), release)


def _given_by_plugins(own: Pairs, robot: str, release: str) -> Pairs | None:
    """The controllers that get the rules of their plugin; None where no stack names them."""
    if not controller_way(release).of_manager:
        return ()
    found = [pair for pair in own if pair[0].is_controller]
    facts = [node for node, _ in found]
    return list(zip(facts, _copies(found, robot), strict=True)) or None


def _without_stand_ins(pairs: Pairs, nodes: Iterable[NodeFacts]) -> Pairs:
    """The plugins of a description, without what their controllers publish if a stack names those."""
    if not any(node.is_controller for node in nodes):
        return pairs
    return [(_without_controllers(facts, table), table) for facts, table in pairs]


def _without_controllers(facts: NodeFacts, table: NodeTable) -> NodeFacts:
    kept = (it for it in facts.endpoints if not is_stand_in(table, it))
    return facts._replace(endpoints=tuple(kept))


def joined(table: Table, other: Table) -> Table:
    """Two tables of different robots as one; nodes for all robots are in it once."""
    names = tuple(dict.fromkeys((*table.names, *other.names)))
    nodes = tuple(dict.fromkeys((*table.nodes, *other.nodes)))
    made = Table(table.layout, nodes, names, (), table.release)
    # The first robot of all is another one than the first of each.
    each = (it for it in (*table.problems, *other.problems) if it.code != NOT_TAKEN.code)
    return made._replace(problems=tuple(dict.fromkeys((*each, *not_taken(made)))))


def _renamed(names: Sequence[EndpointName], robot: str) -> list[EndpointName]:
    """The probe's names, renamed for another robot."""
    nodes = {node: node.replace(PROBE, robot) for node in {it.node for it in names}}
    return [
        EndpointName(robot, nodes[node], endpoint, name.replace(PROBE, robot))
        for _, node, endpoint, name in names
    ]


def _copies(pairs: Pairs, robot: str) -> Iterator[NodeTable]:
    """The probe's nodes, renamed for another robot."""
    for _, (_, node, namespace, name, rules, home) in pairs:
        own = tuple(
            NodeRule(
                robot,
                node,
                rule.source.replace(PROBE, robot),
                rule.target.replace(PROBE, robot),
                rule.kind,
                rule.why,
            )
            for rule in rules
        )
        places = (it.replace(PROBE, robot) for it in (namespace, name, home.host_name))
        above, called, host_name = places
        yield NodeTable(robot, node, above, called, own, home._replace(host_name=host_name))


def node_table(
    robot: str,
    node: NodeFacts,
    naming: Naming,
    others: Places = NOWHERE,
    once: frozenset[str] = frozenset(),
) -> NodeTable:
    """Namespace, name and rules of one robot's node; a node for all robots stays as it is.

    ``others`` are the places of the robot's nodes: a name below one of them is renamed with it.
    ``once`` are the nodes for all robots: a name below one of them is that node's own.
    """
    if node.shared:
        above, _, own = node.name.strip("/").rpartition("/")
        return NodeTable("", node.name, f"/{above}", own, ())
    namespace, name = placed(robot, node.name, naming, node.apart)
    place = _Place(robot, naming, namespace, _root(namespace, robot, node, naming), others, once)
    rules: dict[str, NodeRule] = {}
    for endpoint in (it for it in node.endpoints if not it.fixed):
        for source, target, moved in _targets(endpoint, place):
            why = f"{SAME}; the stack calls it {moved}" if moved else SAME
            why = TOGETHER if target == f"/{source}" else why
            match = expand(source, namespace, name)
            rules.setdefault(match, NodeRule(robot, node.name, source, target, "", why))
    host_name = others.get(node.host, node.host).rpartition("/")[2]
    home = Home(node.host, node.container, node.plugin, host_name=host_name)
    home = home._replace(apart=node.apart, of_hardware=node.of_hardware)
    return NodeTable(robot, node.name, namespace, name, tuple(rules.values()), home)


class _Place(NamedTuple):
    """Where a node runs; ``root`` is what a relative target needs before it, since it would stay in the
    node's own namespace."""

    robot: str
    naming: Naming
    namespace: str
    root: str
    others: Places
    once: frozenset[str]


def _targets(endpoint: Endpoint, place: _Place) -> Iterator[tuple[str, str, str]]:
    """The names of an endpoint that need a rule, its target, and what the stack calls them if that is
    another name."""
    robot, naming, namespace, root, others, once = place
    meant = expanded(endpoint._replace(name=endpoint.remapped or endpoint.name))
    for (kind, source), (_, wanted) in zip(expanded(endpoint), meant, strict=True):
        moved = wanted if wanted != source else ""
        if wanted.partition("/")[0] in once:
            target = f"/{wanted}" if naming.topics == NAMESPACE else moved
        else:
            target = _below(wanted, naming, others)
            target = target or _renamed_target(wanted, kind, place) or moved
            target = target or _shared(wanted, place)
        if target:
            yield source, f"{'' if target[0] == '/' else root}{target}", moved
        # What a node joins with the namespace above is no name of its own namespace.
        for joined in asked_for(source, endpoint, namespace)[1:]:
            if naming.topics != NAMESPACE:
                above = target_of(wanted, kind, robot, naming) or target
                yield from [(joined, f"/{above.lstrip('/')}", moved)] * bool(target)
            elif (target or wanted).startswith("/") and joined != (target or wanted):
                yield joined, target or wanted, moved


def _renamed_target(name: str, kind: str, place: _Place) -> str:
    """Return the target with the robot's name; of a name below the node's own place that of the whole
    name, as other nodes have it."""
    if not _is_below_root(name, place):
        return target_of(name, kind, place.robot, place.naming)
    found = target_of(f"{place.root[1:]}{name}", kind, place.robot, place.naming)
    return found and f"/{found}"


def _shared(name: str, place: _Place) -> str:
    """A name that all robots share, for a node that would look for it in its robot's namespace."""
    return name if _is_below_root(name, place) else ""


def _is_below_root(name: str, place: _Place) -> bool:
    return bool(place.root) and place.naming.topics != NAMESPACE and name[0] not in "~/"


def _root(namespace: str, robot: str, node: NodeFacts, naming: Naming) -> str:
    if naming.topics == NAMESPACE:
        return f"/{robot}/" if namespace.count("/") > 1 else ""
    above = node.name.strip("/").rpartition("/")[0]
    return f"/{above}/".replace("//", "/") if node.apart else ""


def places_of(robot: str, nodes: Iterable[NodeFacts], naming: Naming) -> Places:
    """Return the full names of a robot's nodes, by their names in the stack, and of the hosts of
    those: the controller manager may be made by what is not in the stack."""
    own = [it for it in nodes if not it.shared]
    found = {it.host: placed(robot, it.host, naming) for it in own if it.host}
    found |= {it.name: placed(robot, it.name, naming, it.apart) for it in own}
    return {node: f"{above.rstrip('/')}/{name}" for node, (above, name) in found.items()}


def _below(name: str, naming: Naming, others: Places) -> str:
    """The target for a name below another node of the robot, such as a private service of it, if that
    node is renamed; else empty."""
    head, slash, rest = name.strip("/").partition("/")
    place = others.get(head, "")
    if naming.topics == NAMESPACE or not slash or not place:
        return ""
    relative = not name.startswith("/") and place.count("/") == 1
    return f"{place.lstrip('/') if relative else place}/{rest}"


def parsed(rules: Iterable[NodeRule]) -> tuple[RemapRule, ...]:
    """The rules as rcl reads them."""
    found = (parse_remap(f"{rule.source}:={rule.target}") for rule in rules)
    return tuple(rule for rule in found if rule is not None)


def names_of(pairs: Pairs) -> Iterator[EndpointName]:
    """The resolved names of these nodes."""
    for node, table in pairs:
        bound = bind(table.name, table.namespace, parsed(table.rules))
        bare = bind(table.name, table.namespace, ())
        root = table.namespace.rstrip("/")
        for endpoint in (it for it in node.endpoints if "<" not in it.name):
            kind = TOPIC if endpoint.kind == ACTION else endpoint.kind
            found = resolve_bound(endpoint.name, kind, bare if endpoint.fixed else bound)
            yield EndpointName(table.robot, f"{root}/{table.name}", endpoint, found)


def plugin_nodes(reading: Reading, robot: str) -> Iterator[tuple[NodeFacts, NodeTable]]:
    """Each ROS 2 plugin of ``robot``'s rewritten description: its endpoints, its names and rules."""
    for node in reading.nodes:
        rules = tuple(_rules(node, robot))
        section = node.section
        home = Home("", "", section.names[0], written=True, process_wide=section.process_wide)
        yield _facts(node), NodeTable(robot, node.name, node.namespace, node.name, rules, home)


def _facts(node: ReadNode) -> NodeFacts:
    endpoints = (
        Endpoint(it.kind, it.role, it.name, it.type, parameter=it.parameter, when=it.off)
        for it in node.endpoints
    )
    frames = tuple(FrameParameter(*frame) for frame in node.frames)
    package = node.section.names[0]
    sends = tuple(SentTransform(*it) for it in node.sends)
    return NodeFacts(node.name, package, tuple(endpoints), frames=frames, sends=sends)


def _rules(node: ReadNode, robot: str) -> Iterator[NodeRule]:
    for rule, line, _ in node.rules:
        why = f"in the description, line {line}"
        lead = f"{rule.node}:" if rule.node else ""
        yield NodeRule(robot, node.name, f"{lead}{rule.source}", rule.target, "", why)
