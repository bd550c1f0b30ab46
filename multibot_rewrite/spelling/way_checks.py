# SPDX-License-Identifier: Apache-2.0
"""The rules that rcl has for each node once it runs, from where they are written, and those that a
node needs and does not get there, by release.

The first match counts: a node's own arguments come before those of its process.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from functools import cache
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import WARNING, Finding, declare
from multibot_rewrite.base.grouping import sets_by_key
from multibot_rewrite.base.rosnames import BoundNode, bind, resolve_bound
from multibot_rewrite.knowledge.controller_ways import ControllerWay, controller_way
from multibot_rewrite.knowledge.records import MANAGER, Endpoint
from multibot_rewrite.spelling.of_runs import parsed
from multibot_rewrite.spelling.records import Names, Rule, Rules, Run, Table
from multibot_rewrite.spelling.ways import (
    COMPONENT,
    PLUGIN,
    SPAWNER,
    Delivery,
    Key,
    deliveries,
    key_of,
    rules_by_taker,
)
from multibot_rewrite.system.records import ACTION, PUBLISHES, TOPIC


class _Standing(NamedTuple):
    """The rules by robot and taker, and those that hold for the whole process of the simulator."""

    rules: Mapping[Key, Rules]
    world: Rules
    nodes: Mapping[Key, Run]
    controllers: ControllerWay


def running_nodes(table: Table, left_out: Collection[str] = ()) -> Iterator[tuple[Delivery, Run]]:
    """Yield where the rules of each node go, and the node with the rules that rcl has for it and
    its process; those at one of the ways ``left_out`` are missing."""
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
    yield from ((it, _running(it, standing)) for it in reversed(first.values()))


def _running(it: Delivery, standing: _Standing) -> Run:
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
        return _in_process(node, rules, node.namespace, process)
    if it.way == PLUGIN:
        rules = wide = standing.world
        # A plugin's rules are its own; nodes without any have those of the first robot's plugin.
        if node.written and not node.process_wide:
            rules = own
        elif node.written and not standing.controllers.process_wide:
            rules = tuple(dict.fromkeys((*own, *wide)))
        given = own if standing.controllers.forwarded else ()
        handed_on = wide if standing.controllers.process_wide else given
        return _in_process(node, rules, node.namespace, wide)._replace(handed_on=handed_on)
    taker = standing.nodes.get((node.robot, it.taker), node)
    container = standing.nodes.get((node.robot, taker.fact.container))
    if container is None:
        return _in_process(node, own, taker.namespace, own)
    process = standing.rules.get((node.robot, container.node), ())
    # What a component makes has the arguments of the process as well, the component has not.
    rules = own if it.way == COMPONENT else (*own, *process)
    return _in_process(node, rules, container.namespace, process)


def _in_process(run: Run, rules: Rules, namespace: str, wide: Rules) -> Run:
    return run._replace(rules=rules, process_namespace=namespace, process_rules=wide)


def is_stand_in(node: Run, endpoint: Endpoint) -> bool:
    """Return whether this is a topic of a controller of the plugin, and not of the controller
    manager itself. Those are what the plugin is known to publish, and without a role what its rules
    name."""
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
    """Report, once a node, names of the code or of another robot that a node has because its rule
    does not reach it. What a plugin's controllers are known to publish is reported by the second
    reading of the description, if no node set names them."""
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
        # What descriptions decide, of all robots; of the stack's nodes, which all have alike, two.
        seen[it.node.node] += 1
        is_decided = it.node.fact.plugin or it.node.fact.is_controller
        if not is_decided and seen[it.node.node] > ENOUGH:
            continue
        if running.process_wide or running.rules != it.node.rules:
            own = names.get((running.robot, running.full_name), ())
            if running.process_wide and not of_manager:
                own = tuple(it for it in own if it[0].role != PUBLISHES)
            wrong = dict.fromkeys(_wrong(own, running, owners))
            if wrong:
                yield _finding(it, list(wrong), table.release)


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


def _wrong(
    names: Names, running: Run, owners: Callable[[], Mapping[str, set[str]]]
) -> Iterator[str]:
    """Yield names that differ from the table: as in the code, or like something of a robot."""
    own, theirs, bare = (bound_to(running, it) for it in (running.rules, running.handed_on, ()))
    for end, name in names:
        kind = TOPIC if end.kind == ACTION else end.kind
        given = theirs if is_stand_in(running, end) else own
        found = resolve_bound(end.name, kind, given)
        if found == name:
            continue
        is_bare = found == resolve_bound(end.name, kind, bare)
        if is_bare or running.robot not in owners().get(found, {running.robot}):
            yield end.name


def _finding(it: Delivery, kept: list[str], release: str) -> Finding:
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
