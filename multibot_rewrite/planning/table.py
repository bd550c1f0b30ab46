# SPDX-License-Identifier: Apache-2.0
"""Robots, nodes and a naming policy -> the remap table: each node's rules and resolved names.

A rule is made only for a name that would otherwise be the same for every robot. The table is checked
by resolving every name with its rules as rcl does (``rosnames``), not by trusting the rules.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple, TypeAlias

from multibot_rewrite.base.lazy import gc_paused
from multibot_rewrite.base.naming import NAMESPACE, Naming, affix, spelled
from multibot_rewrite.base.rosnames import bind, expand
from multibot_rewrite.description.readback.nodes import ReadNode
from multibot_rewrite.description.readback.reading import Reading
from multibot_rewrite.knowledge.controller_ways import controller_way
from multibot_rewrite.knowledge.records import (
    MANAGER,
    Endpoint,
    FrameParameter,
    NodeFacts,
    SentTransform,
)
from multibot_rewrite.planning.of_runs import (
    asked_alone,
    expanded,
    name_made_of_other_end,
    parsed,
    placed,
    target_of,
    with_names,
)
from multibot_rewrite.planning.records import Rule, Run, Table
from multibot_rewrite.planning.way_checks import (
    NOT_TAKEN,
    PROBE,
    asked_for,
    is_controller_topic,
    not_taken,
    unreachable,
    useless_rules,
)

NOTHING: Mapping[str, Sequence[Run]] = {}
# The full name of a robot's node, by its name in the node set.
Places: TypeAlias = Mapping[str, str]
NOWHERE: Places = {}


def build_table(
    robots: Sequence[str],
    nodes: Sequence[NodeFacts],
    naming: Naming,
    plugins: Mapping[str, Sequence[Run]] = NOTHING,
    given: Iterable[Run] = (),
    *,
    release: str,
) -> Table:
    """Return the remap table of a fleet with its problems; nodes for all robots are in it once.

    ``nodes`` run once for each robot, with the parameters that are ``given``; ``plugins`` are those of
    each robot's rewritten description.
    """
    with gc_paused():
        # Made once: the run of another robot differs only in the robot's name.
        first = robots[0] if robots else ""
        heads = _prefixes_of_plugins(first, plugins.get(first, ()), naming)
        others = {**heads, **places_of(PROBE, nodes, naming)}
        once = frozenset(it.name for it in nodes if it.shared)
        # What the robot's own files set for a node, and where.
        sections = {it.node: it for it in given}
        own = []
        for run in (run_of(PROBE, it, naming, others, once) for it in nodes if not it.shared):
            found = sections.get(run.node) or sections.get(run.code_name)
            own.append(run._replace(values=found.values, place=found.place) if found else run)
        problems = [*unreachable([it.fact for it in own], naming), *useless_rules(own, release)]
        runs = [run_of("", it, naming) for it in nodes if it.shared]
        is_named = any(it.is_controller for it in nodes)
        for robot in robots:
            copies = [_renamed_copy(it, robot) for it in own]
            # The controllers that get the rules of their plugin; None where no node set names them.
            controllers = [it for it in copies if it.fact.is_controller] or None
            if not controller_way(release).of_manager:
                controllers = []
            problems += useless_rules(plugins.get(robot, ()), release, controllers)
            runs += copies
            managers = [it for it in copies if it.fact.kind == MANAGER and not it.fact.plugin]
            for run in plugins.get(robot, ()):
                if run.fact.of_hardware:
                    runs += [_component_node(it, run) for it in managers[:1]]
                    continue
                # What their controllers publish is the controllers' own, if a node set names those.
                ends = run.fact.endpoints
                kept = tuple(it for it in ends if not (is_named and is_controller_topic(run, it)))
                runs.append(with_names(run._replace(fact=run.fact._replace(endpoints=kept))))
        made = Table(naming.layout.name, tuple(runs), tuple(problems), release)
        return made._replace(problems=(*made.problems, *not_taken(made)))


def _component_node(manager: Run, component: Run) -> Run:
    """Return the node of a hardware component where its controller manager makes it."""
    fact = component.fact._replace(host=manager.node, when=component.fact.when or manager.fact.when)
    home = manager.namespace
    return with_names(
        component._replace(
            namespace=home, fact=fact, host_name=manager.name, place=fact.origin.place
        )
    )


def joined(table: Table, other: Table) -> Table:
    """Return two tables of different robots as one; nodes for all robots are in it once."""
    # Two descriptions may differ in what they say of a node for all robots. A robot's node may have
    # facts from its node set and from the plugin that makes it.
    runs: dict[object, Run] = {}
    for at, it in enumerate((*table.runs, *other.runs)):
        runs.setdefault(at if it.robot else (it.node, it.full_name, it.rules), it)
    made = Table(table.layout, tuple(runs.values()), (), table.release)
    # The first robot of all is another one than the first of each.
    each = (it for it in (*table.problems, *other.problems) if it.code != NOT_TAKEN.code)
    return made._replace(problems=tuple(dict.fromkeys((*each, *not_taken(made)))))


def _renamed_copy(run: Run, robot: str) -> Run:
    """Return the probe's node, renamed for another robot."""
    return run._replace(
        robot=robot,
        namespace=run.namespace.replace(PROBE, robot),
        name=run.name.replace(PROBE, robot),
        host_name=run.host_name.replace(PROBE, robot),
        rules=tuple(
            (old.replace(PROBE, robot), new.replace(PROBE, robot)) for old, new in run.rules
        ),
        names=tuple((end, name.replace(PROBE, robot)) for end, name in run.names),
    )


def run_of(
    robot: str,
    node: NodeFacts,
    naming: Naming,
    others: Places = NOWHERE,
    once: frozenset[str] = frozenset(),
) -> Run:
    """Return one robot's node with its names and rules; a node for all robots stays as it is.

    A name below a node of ``others`` (their places) is renamed with it; ``once`` are nodes for all
    robots."""
    if node.shared:
        above, _, own = node.name.strip("/").rpartition("/")
        return with_names(Run("", node.name, f"/{above}", own, (), node))
    namespace, name = placed(robot, node.name, naming, node.apart)
    place = _Place(robot, naming, namespace, _root(namespace, robot, node, naming), others, once)
    rules: dict[str, Rule] = {}
    named = [it for it in node.endpoints if not it.fixed]
    for endpoint in sorted(named, key=lambda it: bool(it.beside)):
        asked = _end_as_asked(endpoint, node, (name, namespace, rules.values()))
        for source, target in _targets(asked, place):
            rules.setdefault(expand(source, namespace, name), (source, target))
    made = Run(robot, node.name, namespace, name, tuple(rules.values()), node)
    host_name = others.get(node.host, node.host).rpartition("/")[2]
    return with_names(made._replace(host_name=host_name))


def _end_as_asked(
    endpoint: Endpoint, node: NodeFacts, at: tuple[str, str, Iterable[Rule]]
) -> Endpoint:
    """Return the endpoint under the name that its node asks for; it may be made of another end's."""
    if not endpoint.beside:
        return endpoint
    name, namespace, rules = at
    asked = name_made_of_other_end(endpoint, bind(name, namespace, parsed(rules)))
    name = asked.removeprefix(f"{namespace.rstrip('/')}/")
    return endpoint._replace(name=name, remapped=endpoint.remapped or asked_alone(node, endpoint))


class _Place(NamedTuple):
    """Where a node runs; ``root`` is what a relative target needs to leave the node's own namespace."""

    robot: str
    naming: Naming
    namespace: str
    root: str
    others: Places
    once: frozenset[str]


def _targets(endpoint: Endpoint, place: _Place) -> Iterator[Rule]:
    """Yield the rules that an endpoint needs."""
    robot, naming, namespace, root, others, once = place
    meant = expanded(endpoint._replace(name=endpoint.remapped or endpoint.name))
    for (kind, source), (_, wanted) in zip(expanded(endpoint), meant, strict=True):
        moved = wanted if wanted != source else ""
        if wanted.partition("/")[0] in once:
            target = f"/{wanted}" if naming.topics == NAMESPACE else moved
        else:
            # A name below the node's own place is renamed as the whole name, as other nodes have it;
            # one that all robots share would be looked for in the robot's namespace.
            is_below = bool(root) and naming.topics != NAMESPACE and wanted[0] not in "~/"
            lead = root if is_below else ""
            renamed = target_of(f"{lead[1:]}{wanted}", kind, robot, naming)
            renamed = renamed and f"/{renamed}" if is_below else renamed
            target = _target_below_node(wanted, naming, others) or renamed or moved
            target = target or (wanted if is_below else "")
        if target:
            yield source, f"{'' if target[0] == '/' else root}{target}"
        # What a node joins with the namespace above is no name of its own namespace.
        for joined in asked_for(source, endpoint, namespace)[1:]:
            if naming.topics != NAMESPACE:
                above = target_of(wanted, kind, robot, naming) or target or wanted
                is_led = target or wanted.startswith("/")
                yield from [(joined, f"/{above.lstrip('/')}")] * bool(is_led)
            elif (target or wanted).startswith("/") and joined != (target or wanted):
                yield joined, target or wanted


def _root(namespace: str, robot: str, node: NodeFacts, naming: Naming) -> str:
    """Return what a relative target needs in front to leave the node's own namespace; may be empty."""
    if naming.topics == NAMESPACE:
        return f"/{robot}/" if namespace.count("/") > 1 else ""
    above = node.name.strip("/").rpartition("/")[0]
    return f"/{above}/".replace("//", "/") if node.apart else ""


def places_of(robot: str, nodes: Iterable[NodeFacts], naming: Naming) -> Places:
    """Return by name in the node set the full name of a robot's node, and of its host."""
    own = [it for it in nodes if not it.shared]
    found = {it.host: placed(robot, it.host, naming) for it in own if it.host}
    found |= {it.name: placed(robot, it.name, naming, it.apart) for it in own}
    return {node: f"{above.rstrip('/')}/{name}" for node, (above, name) in found.items()}


def _prefixes_of_plugins(robot: str, runs: Iterable[Run], naming: Naming) -> Places:
    """Return the node or camera that plugins' topics begin with, by that of a robot alone."""
    found: dict[str, str] = {}
    for end, name in (one for run in runs for one in with_names(run).names):
        head, _, rest = end.name.partition("/")
        kind = "node" if head == "~" else "stem"
        above, _, word = name.removesuffix(f"/{rest}").rpartition("/")
        there = affix(naming, kind, "x") if rest and name.endswith(f"/{rest}") else None
        mark = there.spell("", robot) if there else ""
        bare = word.removesuffix(mark).removeprefix(mark)
        if naming.topics != NAMESPACE and bare not in ("", word) and head in ("~", word):
            found[f"{above[1:]}/{bare}/".lstrip("/")] = (
                f"{above}/{spelled(naming, PROBE, kind, bare)}/"
            )
    return found


def _target_below_node(name: str, naming: Naming, others: Places) -> str:
    """Return the target of a name below another, renamed node or a plugin's topic; empty for none."""
    bare = name.strip("/")
    head = next((it for it in others if it[-1:] == "/" and bare.startswith(it)), "")
    head, slash, rest = (head[:-1], "/", bare[len(head) :]) if head else bare.partition("/")
    place = others.get(f"{head}/", others.get(head, "")).rstrip("/")
    if naming.topics == NAMESPACE or not slash or not place:
        return ""
    relative = not name.startswith("/") and place.count("/") == 1
    return f"{place.lstrip('/') if relative else place}/{rest}"


def plugin_nodes(reading: Reading, robot: str) -> Iterator[Run]:
    """Yield each ROS 2 plugin of ``robot``'s rewritten description: what is known of it, its rules."""
    for node in reading.nodes:
        own = (robot, node.name, node.namespace, node.name, tuple(_rules(node)))
        yield Run(*own, _facts(node), written=True, process_wide=node.section.process_wide)


def _facts(node: ReadNode) -> NodeFacts:
    """Return what is known of a plugin's node by its description."""
    endpoints = (
        Endpoint(it.kind, it.role, it.code_name, it.type, parameter=it.parameter, when=it.off)
        for it in node.endpoints
    )
    frames = tuple(FrameParameter(*frame) for frame in node.frames)
    package = node.section.names[0]
    sends = tuple(SentTransform(*it) for it in node.sends)
    return NodeFacts(
        node.name, package, tuple(endpoints), frames=frames, sends=sends, plugin=package
    )


def _rules(node: ReadNode) -> Iterator[Rule]:
    """Yield (left side, right side) of each remap rule of a node."""
    for rule in (it.rule for it in node.rules):
        yield f"{rule.node}:{rule.source}" if rule.node else rule.source, rule.target
