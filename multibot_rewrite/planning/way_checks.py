# SPDX-License-Identifier: Apache-2.0
"""What a remap table cannot do or does wrongly, by the rules that rcl has for each running node.

The first match counts: a node's own arguments come before those of its process."""

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from functools import cache
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding, declare
from multibot_rewrite.base.grouping import sets_by_key
from multibot_rewrite.base.naming import NAMESPACE, TF_TOPICS, Naming
from multibot_rewrite.base.rosnames import BoundNode, bind, resolve_bound
from multibot_rewrite.knowledge.controller_ways import ControllerWay, controller_way
from multibot_rewrite.knowledge.node_sets import every_release
from multibot_rewrite.knowledge.records import MANAGER, Endpoint, NodeFacts
from multibot_rewrite.planning.of_runs import expanded, name_made_of_other_end, parsed, target_of
from multibot_rewrite.planning.records import Names, Rule, Rules, Run, Table
from multibot_rewrite.planning.ways import Delivery, Key, deliveries, key_of, rules_by_taker
from multibot_rewrite.system.records import (
    ACTION,
    COMPONENT,
    PLUGIN,
    PUBLISHES,
    SERVICE,
    SPAWNER,
    TOPIC,
)


class _Standing(NamedTuple):
    """The rules by robot and taker, and those that hold for the whole process of the simulator."""

    rules: Mapping[Key, Rules]
    world: Rules
    nodes: Mapping[Key, Run]
    controllers: ControllerWay


def running_nodes(table: Table, left_out: Collection[str] = ()) -> Iterator[tuple[Delivery, Run]]:
    """Yield where each node's rules go, and the node with the rules it gets; not those ``left_out``."""
    meant = deliveries(table)
    given = [it for it in meant if it.way not in left_out]
    standing = _Standing(
        rules_by_taker(given),
        # The rules of the first plugin that starts ROS in the simulator.
        next((it.rules for it in given if it.node.process_wide), ()),
        {(it.node.robot, it.node.node): it.node for it in meant},
        controller_way(table.release),
    )
    # A component's first delivery is its own, the second that of its helper nodes.
    first = {key_of(it.node): it for it in reversed(meant)}
    yield from ((it, _with_rules_of_process(it, standing)) for it in reversed(first.values()))


def _with_rules_of_process(it: Delivery, standing: _Standing) -> Run:
    """Return the node with the rules that rcl has for it and its process."""
    node, own = it.node, standing.rules.get((it.node.robot, it.taker), ())
    if it.way == SPAWNER:
        # A tf listener that its code makes has the arguments of the manager's process alone.
        process = standing.rules.get((node.robot, MANAGER), standing.world)
        rules = (
            *(
                standing.rules.get((node.robot, MANAGER), ())
                if standing.controllers.forwarded
                else ()
            ),
            *own,
        )
        return _with_process_rules(node, rules, node.namespace, process)
    if it.way == PLUGIN:
        rules = wide = standing.world
        # A plugin's rules are its own; nodes without any have those of the first robot's plugin.
        if node.written and not node.process_wide:
            rules = own
        elif node.written and not standing.controllers.process_wide:
            rules = tuple(dict.fromkeys((*own, *wide)))
        given = own if standing.controllers.forwarded else ()
        handed_on = wide if standing.controllers.process_wide else given
        return _with_process_rules(node, rules, node.namespace, wide)._replace(handed_on=handed_on)
    taker = standing.nodes.get((node.robot, it.taker), node)
    container = standing.nodes.get((node.robot, taker.fact.container))
    if container is None:
        return _with_process_rules(node, own, taker.namespace, own)
    process = standing.rules.get((node.robot, container.node), ())
    # What a component makes has the arguments of the process as well, the component has not.
    rules = own if it.way == COMPONENT else (*own, *process)
    return _with_process_rules(node, rules, container.namespace, process)


def _with_process_rules(run: Run, rules: Rules, namespace: str, wide: Rules) -> Run:
    return run._replace(rules=rules, process_namespace=namespace, process_rules=wide)


def is_controller_topic(node: Run, endpoint: Endpoint) -> bool:
    """Return whether a plugin's end is a controller's topic, and not the controller manager's own."""
    return node.process_wide and endpoint.role in (PUBLISHES, "")


def bound_to(node: Run, rules: Iterable[Rule]) -> BoundNode:
    """Return the node under these rules."""
    return bind(node.name, node.namespace, parsed(rules))


# A second robot shows what rules for all of a process do.
ENOUGH = 2
NOT_TAKEN = declare(
    "MR105",
    "rule-not-taken",
    WARNING,
    formats=("remap-urdf",),
    options={"robots": ("robot1", "robot2"), "layout": "frames-per-robot"},
)


def not_taken(table: Table) -> Iterator[Finding]:
    """Report, once a node, names that it has because its rule does not reach it.

    They are names of the code or of another robot. What a plugin's controllers are known to publish
    is reported by the second reading of the description, if no node set names them."""
    of_manager = controller_way(table.release).of_manager
    robots = _robots_to_check(table)
    some = table._replace(runs=tuple(it for it in table.runs if it.robot in robots))
    names: dict[tuple[str, str], Names] = {}
    for run in some.runs:
        own = tuple(it for it in run.names if not (it[0].fixed or it[0].when))
        key = run.robot, run.full_name
        names[key] = (*names.get(key, ()), *own)

    @cache
    def owners() -> Mapping[str, set[str]]:
        """Return the robots that have each name."""
        return sets_by_key((name, run.robot) for run, _, name in table.ends)

    seen: Counter[str] = Counter()
    for it, running in running_nodes(some):
        # What descriptions decide, of all robots; of the node set's nodes, which all have alike, two.
        seen[it.node.node] += 1
        is_decided = it.node.fact.plugin or it.node.fact.is_controller
        if not is_decided and seen[it.node.node] > ENOUGH:
            continue
        if running.process_wide or running.rules != it.node.rules:
            own = names.get((running.robot, running.full_name), ())
            if running.process_wide and not of_manager:
                own = tuple(it for it in own if it[0].role != PUBLISHES)
            wrong = dict.fromkeys(_wrong_names(own, running, owners))
            if wrong:
                yield _finding_of_names(it, list(wrong), table.release)


def _robots_to_check(table: Table) -> set[str]:
    """Return robots whose descriptions matter, and the first with each of the node set's nodes."""
    first: dict[str, set[str]] = {}
    found = {""}
    for it in table.runs:
        robots = first.setdefault(it.node, set())
        if len(robots) < ENOUGH or it.fact.plugin or it.fact.is_controller:
            robots.add(it.robot)
            found.add(it.robot)
    return found


def _wrong_names(
    names: Names, running: Run, owners: Callable[[], Mapping[str, set[str]]]
) -> Iterator[str]:
    """Yield names that differ from the table: as in the code, or like something of a robot."""
    own, theirs, bare = (bound_to(running, it) for it in (running.rules, running.handed_on, ()))
    for end, name in names:
        kind = TOPIC if end.kind == ACTION else end.kind
        given = theirs if is_controller_topic(running, end) else own
        found = resolve_bound(end.name, kind, given)
        if found == name:
            continue
        is_bare = found == resolve_bound(end.name, kind, bare)
        if is_bare or running.robot not in owners().get(found, {running.robot}):
            yield end.name


def _finding_of_names(it: Delivery, kept: list[str], release: str) -> Finding:
    node, names = it.node, ", ".join(kept)
    message = f"on {release} no rule reaches it for {names}, though one is written"
    hint = f"give its rules to the process of {node.fact.host or node.name}"
    if node.process_wide and controller_way(release).spawner:
        message = f"on {release} its controllers do not get its rules for {names}"
        hint = "name their node set, and start each with its spawner's --controller-ros-args"
    elif it.way == PLUGIN:
        message = f"on {release} it gets the rules of the first robot alone, none for {names}"
        hint = "give each robot a namespace, with --topics namespace"
        if node.namespace != "/":
            hint = "write a relative target in the rule, which ends up in each robot's namespace"
    place = {"robot": node.robot, "node": node.node, "names": tuple(kept)}
    return NOT_TAKEN.finding(message, hint, **place)


# A stand-in for a second robot: names of a single robot cannot collide.
PROBE = "multibot_probe"
RUN_TIME = "the name is made at run time"

UNREACHABLE_NAME = declare("MR101", "no-rule-reaches-name", WARNING, formats=("remap",))


def unreachable(nodes: Sequence[NodeFacts], naming: Naming) -> Iterator[Finding]:
    """Report names that every robot would share and that no remap rule reaches."""
    for node in nodes:
        for endpoint in node.endpoints:
            reason = endpoint.fixed or (RUN_TIME if "<" in endpoint.name else "")
            # A relative name made at run time follows the namespace.
            if "<" in endpoint.name:
                is_shared = naming.topics != NAMESPACE or endpoint.name.startswith("/")
            else:
                is_shared = bool(target_of(endpoint.name, endpoint.kind, PROBE, naming))
            if reason and not endpoint.when and not endpoint.own and is_shared:
                message = f"no remap rule reaches {endpoint.kind} {endpoint.name}: {reason}"
                parameter = "" if "parameter" in reason else endpoint.parameter
                hint = f"set its parameter {parameter}" if parameter else ""
                yield UNREACHABLE_NAME.finding(message, hint, node=node.name)


RULE_WITHOUT_NAME = declare("MR103", "rule-matches-no-name", WARNING, formats=("remap-urdf",))
LATER_RULE = declare("MR104", "rule-after-first-match", ERROR, formats=("remap-urdf",))


class _Names(NamedTuple):
    """A node without its rules, and the full names that it asks for."""

    bare: BoundNode
    full: frozenset[tuple[str, str]]


def useless_rules(
    runs: Iterable[Run], release: str, controllers: Sequence[Run] | None = ()
) -> Iterator[Finding]:
    """Report rules that match no name of their node, and rules after one that matches first.

    ``controllers`` are those that a plugin hands its rules on to; None if they are not known. A
    description may serve robots with other controllers: a rule for one known in ``release`` is
    right."""
    others = [*map(_asked_names, controllers or ())]
    known = _names_of_managers(release)
    by_file = any(it.fact.origin.place.line for it in controllers or ())
    for run in runs:
        own, wide, node = _asked_names(run), run.process_wide, run.node
        asked = [own, *(others if wide else ())]
        robot = "" if run.robot == PROBE else run.robot
        seen: dict[tuple[str, str], str] = {}
        for left, target in run.rules:
            text, (whose, source) = f"{left}:={target}", _split_left_side(left)
            match = (whose, resolve_bound(source, TOPIC, own.bare))
            there, result = match in seen, resolve_bound(target, TOPIC, own.bare)
            if seen.setdefault(match, result) != result:
                message = f"{text} has no effect: an earlier rule matches first"
                yield LATER_RULE.finding(message, "remove it", robot=robot, node=node)
            elif there or (wide and (controllers is None or source.lstrip("/") in TF_TOPICS)):
                pass  # the rewrite itself writes those of tf
            elif wide and not whose and _is_for_controllers(source, known, by_file):
                pass
            elif not any(_rule_matches(left, it) for it in asked):
                message = f"{text} matches no name of this node"
                yield RULE_WITHOUT_NAME.finding(message, "remove it", robot=robot, node=node)


@cache
def _names_of_managers(release: str) -> frozenset[str]:
    """Return the topics in the code of controller managers and of controllers known in a release."""
    handed_on = controller_way(release).of_manager
    every = every_release().nodes.values()
    nodes = [it for it in every if it.name == MANAGER or (handed_on and it.host == MANAGER)]
    return frozenset(end.name for node in nodes for end in node.endpoints)


def _is_for_controllers(source: str, known: frozenset[str], by_file: bool) -> bool:
    """Return whether a rule's source is one of the ``known`` names of controllers, or NODE/NAME."""
    above, slash, _ = source.partition("/")
    below = "" if by_file or not slash or above == "~" else f"~{source[len(above) :]}"
    return source in known or below in known


def _asked_names(run: Run) -> _Names:
    """Return the full names that a node asks for without its rules."""
    bare = bind(run.name, run.namespace, ())
    # What is known of a controller manager only by its rules proves none of them.
    known = [it for it in run.fact.endpoints if it.role or not run.process_wide]
    asked = {
        (kind, name)
        for endpoint in known
        for kind, source in expanded(endpoint)
        for name in asked_for(source, endpoint, run.namespace)
    }
    full = {(kind, resolve_bound(name, kind, bare)) for kind, name in asked}
    if any(it.beside for it in known):
        bound = bind(run.name, run.namespace, parsed(run.rules))
        full |= {(it.kind, name_made_of_other_end(it, bound)) for it in known if it.beside}
    return _Names(bare, frozenset(full))


def asked_for(name: str, endpoint: Endpoint, namespace: str) -> tuple[str, ...]:
    """Return a name in a node's code, and if resolved there, that name in the parent namespace."""
    above = namespace.rpartition("/")[0]
    return (name, f"{above}/{name.lstrip('/')}") if endpoint.above and above else (name,)


def _rule_matches(left: str, names: _Names) -> bool:
    """Return whether the left side of a rule matches a name of its node."""
    whose, source = _split_left_side(left)
    if whose not in ("", names.bare.node):
        return False
    match = resolve_bound(source, TOPIC, names.bare)
    return not names.full.isdisjoint((kind, match) for kind in (TOPIC, SERVICE))


def _split_left_side(source: str) -> tuple[str, str]:
    """Return the node (or "") and the name in the left side of a rule."""
    whose, colon, name = source.rpartition(":")
    return (whose, name) if colon else ("", source)
