"""Robots, nodes and a naming policy -> the remap table: each node's rules and resolved names.

A rule is made only for a name that would otherwise be the same for every robot. The table is checked
by resolving every name with its rules as rcl does (``rosnames``), not by trusting the rules.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from multibot_rewrite.gc_pause import gc_paused
from multibot_rewrite.model import ERROR, WARNING
from multibot_rewrite.naming import NAMESPACE, Naming, spelled
from multibot_rewrite.remap.records import (
    ACTION,
    SERVICE,
    TOPIC,
    Endpoint,
    NodeFacts,
    NodeRule,
    NodeTable,
    Problem,
    ResolvedName,
    Table,
)
from multibot_rewrite.rosnames import RemapRule, bind, expand, parse_remap, resolve_bound

# What an action is made of (rcl_action names.c): three services and two topics.
ACTION_PARTS = (
    ("_action/send_goal", SERVICE),
    ("_action/cancel_goal", SERVICE),
    ("_action/get_result", SERVICE),
    ("_action/feedback", TOPIC),
    ("_action/status", TOPIC),
)
# Topics that image_transport's plugins derive from a base name.
TRANSPORTS = ("compressed", "compressedDepth", "theora", "zstd")
# A stand-in for a second robot: names of a single robot cannot collide.
PROBE = "multibot_probe"
RUN_TIME = "the name is made at run time"
SAME = "all robots would share this name otherwise"
Pairs = Sequence[tuple[NodeFacts, NodeTable]]
NOTHING: Mapping[str, Pairs] = {}


def build_table(
    robots: Sequence[str],
    nodes: Sequence[NodeFacts],
    naming: Naming,
    plugins: Mapping[str, Pairs] = NOTHING,
) -> Table:
    """The remap table of a fleet with its problems; nodes for all robots are in it once.

    ``nodes`` run once for each robot; ``plugins`` are those of each robot's rewritten description.
    """
    with gc_paused():
        return _build(robots, nodes, naming, plugins)


def _build(
    robots: Sequence[str], nodes: Sequence[NodeFacts], naming: Naming, plugins: Mapping[str, Pairs]
) -> Table:
    shared = [(node, node_table("", node, naming)) for node in nodes if node.shared]
    # Made once: another robot's table differs only in the robot's name.
    others = frozenset(node.name for node in nodes if not node.shared)
    own = [(node, node_table(PROBE, node, naming, others)) for node in nodes if not node.shared]
    meant = list(names_of(own))
    names = {
        robot: [*_renamed(meant, robot), *names_of(plugins.get(robot, ()))]
        for robot in ([*robots, PROBE] if len(robots) == 1 else robots)
    }
    problems = [
        *_unreachable([node for node, _ in own], naming),
        *_useless_rules(own),
        *_collisions(names, naming),
    ]
    problems += [found for robot in robots for found in _useless_rules(plugins.get(robot, ()))]
    kept = [*names_of(shared), *(name for robot in robots for name in names[robot])]
    tables = [table for _, table in shared]
    for robot in robots:
        tables += [*_copies(own, robot), *(table for _, table in plugins.get(robot, ()))]
    return Table(naming.layout.name, tuple(tables), tuple(kept), tuple(problems))


def joined(table: Table, other: Table, naming: Naming) -> Table:
    """Two tables of different robots as one; nodes for all robots are in it once."""
    names = tuple(dict.fromkeys((*table.names, *other.names)))
    by_robot: dict[str, list[ResolvedName]] = {}
    for name in names:
        if name.robot:
            by_robot.setdefault(name.robot, []).append(name)
    known = {(it.code, it.message) for it in (*table.problems, *other.problems)}
    met = (it for it in _collisions(by_robot, naming) if (it.code, it.message) not in known)
    problems = tuple(dict.fromkeys((*table.problems, *other.problems, *met)))
    return Table(table.layout, tuple(dict.fromkeys((*table.nodes, *other.nodes))), names, problems)


def _renamed(names: Iterable[ResolvedName], robot: str) -> list[ResolvedName]:
    """The probe's names, renamed for another robot."""
    return [
        ResolvedName(robot, node.replace(PROBE, robot), endpoint, name.replace(PROBE, robot))
        for _, node, endpoint, name in names
    ]


def _copies(pairs: Pairs, robot: str) -> Iterator[NodeTable]:
    """The probe's nodes, renamed for another robot."""
    for _, (_, node, namespace, name, rules) in pairs:
        own = tuple(
            NodeRule(
                robot, node, rule.source, rule.target.replace(PROBE, robot), rule.kind, rule.why
            )
            for rule in rules
        )
        yield NodeTable(
            robot, node, namespace.replace(PROBE, robot), name.replace(PROBE, robot), own
        )


def node_table(
    robot: str, node: NodeFacts, naming: Naming, others: frozenset[str] = frozenset()
) -> NodeTable:
    """Namespace, name and rules of one robot's node; a node for all robots stays as it is.

    ``others`` are the robot's nodes: a name below one of them is renamed with it.
    """
    if node.shared:
        return NodeTable("", node.name, "/", node.name, ())
    namespace, name = placed(robot, node.name, naming)
    # In a node's own namespace a relative target would stay below it.
    root = f"/{robot}/" if namespace.count("/") > 1 else ""
    rules: dict[str, NodeRule] = {}
    for endpoint in (it for it in node.endpoints if not it.fixed):
        meant = expanded(endpoint._replace(name=endpoint.remapped or endpoint.name))
        for (kind, source), (_, wanted) in zip(expanded(endpoint), meant, strict=True):
            moved = wanted if wanted != source else ""
            target = _below(wanted, robot, naming, others)
            target = target or target_of(wanted, kind, robot, naming) or moved
            if target:
                target = f"{root}{target}" if root and naming.topics == NAMESPACE else target
                why = f"{SAME}; the stack calls it {wanted}" if moved else SAME
                match = expand(source, namespace, name)
                rules.setdefault(match, NodeRule(robot, node.name, source, target, "", why))
    return NodeTable(robot, node.name, namespace, name, tuple(rules.values()))


def placed(robot: str, node: str, naming: Naming) -> tuple[str, str]:
    """The namespace and name that a robot's node runs under."""
    # A costmap is a node in its own namespace, whatever its robot.
    above, _, name = node.strip("/").rpartition("/")
    if naming.topics == NAMESPACE:
        return "/" + "/".join(filter(None, [robot, above])), name
    return f"/{above}", spelled(naming, robot, "node", name)


def expanded(endpoint: Endpoint) -> Iterator[tuple[str, str]]:
    """The names that rcl sees for an endpoint, with their kinds: an action is services and topics.

    A name in ``<>`` is made at run time, so it yields none.
    """
    name = endpoint.name
    if "<" in name:
        return
    if endpoint.kind != ACTION:
        yield endpoint.kind, name
    else:
        yield TOPIC, name
        yield from ((kind, f"{name}/{part}") for part, kind in ACTION_PARTS)
    if endpoint.transport:
        yield from ((TOPIC, f"{name}/{transport}") for transport in TRANSPORTS)


def target_of(name: str, kind: str, robot: str, naming: Naming) -> str:
    """The target of the rule for ``name``; empty if no rule is needed.

    With namespaces targets are relative, so the rule is the same for every robot.
    """
    bare = name.strip("/")
    if name.startswith("~") or bare in naming.shared_topics:
        return ""
    if naming.topics == NAMESPACE:
        return bare if name.startswith("/") else ""
    base, rest = _family(name)
    target = spelled(naming, robot, SERVICE if kind == SERVICE and not rest else TOPIC, base)
    return target + rest if target != base else ""


def _family(name: str) -> tuple[str, str]:
    """The name that is renamed, and the rest below it: an action's parts and an image's
    transports are found from the one name alone."""
    base, action, part = name.partition("/_action/")
    if action:
        return base, action + part
    base, _, last = name.rpartition("/")
    return (base, f"/{last}") if base and last in TRANSPORTS else (name, "")


def _below(name: str, robot: str, naming: Naming, nodes: frozenset[str]) -> str:
    """The target for a name below another node of the robot, such as a private service of it, if that
    node is renamed; else empty."""
    head, slash, rest = name.strip("/").partition("/")
    if naming.topics == NAMESPACE or not slash or head not in nodes:
        return ""
    lead = "/" if name.startswith("/") else ""
    return f"{lead}{placed(robot, head, naming)[1]}/{rest}"


def parsed(rules: Iterable[NodeRule]) -> tuple[RemapRule, ...]:
    """The rules as rcl reads them."""
    found = (parse_remap(f"{rule.source}:={rule.target}") for rule in rules)
    return tuple(rule for rule in found if rule is not None)


def names_of(pairs: Pairs) -> Iterator[ResolvedName]:
    """The resolved names of these nodes."""
    for node, table in pairs:
        bound = bind(table.name, table.namespace, parsed(table.rules))
        bare = bind(table.name, table.namespace, ())
        root = table.namespace.rstrip("/")
        for endpoint in (it for it in node.endpoints if "<" not in it.name):
            kind = TOPIC if endpoint.kind == ACTION else endpoint.kind
            found = resolve_bound(endpoint.name, kind, bare if endpoint.fixed else bound)
            yield ResolvedName(table.robot, f"{root}/{table.name}", endpoint, found)


def _unreachable(nodes: Sequence[NodeFacts], naming: Naming) -> Iterator[Problem]:
    """Names that every robot would share and that no remap rule reaches."""
    for node in nodes:
        for endpoint in node.endpoints:
            reason = endpoint.fixed or (RUN_TIME if "<" in endpoint.name else "")
            if reason and not endpoint.when and _needed(endpoint, naming):
                message = f"no remap rule reaches {endpoint.kind} {endpoint.name}: {reason}"
                parameter = "" if "parameter" in reason else endpoint.parameter
                hint = f"set its parameter {parameter}" if parameter else ""
                yield Problem("MR101", WARNING, "", node.name, message, hint)


def _needed(endpoint: Endpoint, naming: Naming) -> bool:
    """Would all robots share this name? A relative name made at run time follows the namespace."""
    if "<" in endpoint.name:
        return naming.topics != NAMESPACE or endpoint.name.startswith("/")
    return bool(target_of(endpoint.name, endpoint.kind, PROBE, naming))


def _collisions(names: dict[str, list[ResolvedName]], naming: Naming) -> Iterator[Problem]:
    """Names that two robots would have though they are not shared."""
    first: dict[tuple[str, str], ResolvedName] = {}
    reported = set()
    shared = {f"/{topic}" for topic in naming.shared_topics}
    for name in (name for found in names.values() for name in found):
        key = ("" if name.endpoint.kind != SERVICE else SERVICE, name.name)
        other = first.setdefault(key, name)
        if (
            other.robot == name.robot
            or name.name in shared
            or name.endpoint.fixed
            or key in reported
        ):
            continue
        reported.add(key)
        message = f"two robots would share {name.name}: {other.node} and {name.node} use it"
        hint = "remap it for each robot, or allow it with --shared-topics"
        yield Problem("MR102", ERROR, other.robot, name.node, message, hint)


def _useless_rules(pairs: Pairs) -> Iterator[Problem]:
    """Rules that match no name of their node, and rules after one that matches first."""
    for node, table in pairs:
        bare = bind(table.name, table.namespace, ())
        robot = "" if table.robot == PROBE else table.robot
        asked = {pair for endpoint in node.endpoints for pair in expanded(endpoint)}
        full = {(kind, resolve_bound(name, kind, bare)) for kind, name in asked}
        seen: set[str] = set()
        for rule in table.rules:
            match = resolve_bound(rule.source, rule.kind or TOPIC, bare)
            kinds = (rule.kind,) if rule.kind else (TOPIC, SERVICE)
            text = f"{rule.source}:={rule.target}"
            if match in seen:
                message = f"{text} has no effect: an earlier rule matches first"
                yield Problem("MR104", ERROR, robot, node.name, message, "remove it")
            elif full.isdisjoint((kind, match) for kind in kinds):
                message = f"{text} matches no name of this node"
                yield Problem("MR103", WARNING, robot, node.name, message, "remove it")
            seen.add(match)
