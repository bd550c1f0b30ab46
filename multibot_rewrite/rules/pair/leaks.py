# SPDX-License-Identifier: Apache-2.0
"""Rules about names of the wrong robot: those that belong to no robot, and another robot's."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping, Sequence

from multibot_rewrite.base.conventions import EVERYBODYS
from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.findings.rule import Rule
from multibot_rewrite.base.wording import SEVERAL, shorten
from multibot_rewrite.rules.declaration import found_by_plan
from multibot_rewrite.rules.pair.causes import (
    DOES,
    Cause,
    caused,
    how_to_pass,
    names_without_rules,
    plugin_of,
    why_not_remapped,
)
from multibot_rewrite.rules.pair.meeting import missing, unplanned_ends
from multibot_rewrite.rules.system.commands import (
    command_for_several_robots,
    command_from_another_robot,
)
from multibot_rewrite.rules.system.names import service_of_two_nodes
from multibot_rewrite.rules.system.sharing import data_of_another_robot, topic_of_several_robots
from multibot_rewrite.system.index import TF, Index, ends_of
from multibot_rewrite.system.records import SUBSCRIBES, TOPIC, End
from multibot_rewrite.system.tf_copies import copying_nodes
from multibot_rewrite.system.words import is_order


@found_by_plan(
    topic_of_several_robots, command_for_several_robots, service_of_two_nodes, nodes=False
)
def name_of_no_robot(plan: Index, seen: Index) -> Iterator[Finding]:
    """A robot's node uses a name of no robot that is not shared: all robots meet at such a name."""
    yield from _unplanned_leaks(plan, seen)
    yield from _planned_leaks(plan, seen)
    yield from _unsent_leaks(plan, seen)


def _unplanned_leaks(plan: Index, seen: Index) -> Iterator[Finding]:
    shared = {*plan.system.shared_topics, *EVERYBODYS}
    not_remapped, unplanned = _missing_by_name_without_rules(plan, seen), unplanned_ends(plan, seen)
    for node, robot in plan.robot_of.items():
        for end in {it.name: it for it in unplanned.get(node, ())}.values():
            name = end.name
            # Whose tf is where is a rule of its own.
            if name in shared or plan.robot(name) or end.type == TF:
                continue
            cause = _why_leaked(plan, node, name, not_remapped.get((node, name)))
            message = f"uses {name}, which is not a name of {robot}{_how_many(seen, name)}"
            rule = _rule_of(seen, end.kind, name, end.type)
            yield rule.finding(message, **cause._asdict(), robot=robot, node=node, names=(name,))


def _rule_of(seen: Index, kind: str, name: str, type_: str) -> Rule:
    """What it is to use a name together with other robots."""
    if kind != TOPIC:
        return service_of_two_nodes
    return command_for_several_robots if is_order(name, type_) else topic_of_several_robots


def _how_many(seen: Index, name: str) -> str:
    """How many robots use the name, as far as they are there."""
    robots = {seen.robot(it.node) for it in ends_of(seen, name)} - {""}
    if len(robots) > 1:
        return f": {len(robots)} robots use it"
    return ", and is not in shared_topics: robots that do the same use one topic"


def _missing_by_name_without_rules(plan: Index, seen: Index) -> dict[tuple[str, str], End]:
    """The planned endpoints that are missing, by node and the name they have without a rule."""
    return {
        (planned.node, name): planned
        for planned in missing(plan, seen).values()
        if planned.node in plan.robot_of
        for name in names_without_rules(plan, planned)
    }


def _why_leaked(plan: Index, node: str, name: str, planned: End | None) -> Cause:
    if planned:
        return why_not_remapped(plan, planned)
    plugin, place = plugin_of(plan, node)
    if plugin:
        return caused(f"{plugin} has no namespace or remap rule for it, see {place}", place)
    robot = plan.robot_of[node]
    target = f"{name}/{robot}" if plan.of_names.robot_is_last else f"/{robot}{name}"
    rule = how_to_pass(plan, node, f"{name}:={target}")
    return Cause(f"an absolute name in its code or parameters; pass {rule}")


def _planned_leaks(plan: Index, seen: Index) -> Iterator[Finding]:
    """A name that the plan itself has for several robots, because no remap rule changes it."""
    shared = {*plan.system.shared_topics, *EVERYBODYS, *_shared_tf(plan)}
    nodes: dict[str, dict[str, None]] = defaultdict(dict)
    relays = copying_nodes(plan.system)
    for key in plan.by_key:
        node, _, _, name = key
        if name in plan.of_names.exact or name in shared or node not in plan.robot_of:
            continue
        if not plan.robot(name) and key in seen.by_key and node not in relays:
            nodes[name][node] = None
    for name, users in nodes.items():
        robots = dict.fromkeys(plan.robot_of[node] for node in users)
        for node in users if len(robots) > 1 else ():
            listed = shorten(robots, SEVERAL)
            message = f"uses {name}, which the plan has for several robots: {listed}"
            cause = "no remap rule changes it: set the node's parameter, or add it to shared_topics"
            (kind, type_), *_ = ((it.kind, it.type) for it in ends_of(seen, name))
            yield _rule_of(seen, kind, name, type_).finding(
                message, cause, robot=plan.robot_of[node], node=node, names=(name,)
            )


def _unsent_leaks(plan: Index, seen: Index) -> Iterator[Finding]:
    """Where it is not known which nodes run: a name that each robot has with its own in it."""
    shared = {*plan.system.shared_topics, *EVERYBODYS, *(name for *_, name in plan.by_key)}
    names = _names_of_robots(plan) if not seen.nodes else {}
    for ends in seen.by_name.values() if names else ():
        if ends.name in shared or plan.robot(ends.name) or ends.type == TF:
            continue
        segments = ends.name.strip("/").split("/")
        likely = {"/" + "/".join(it) for it in (segments, segments[1:], segments[:-1])}
        meant = [name for plain in likely for name in names.get(plain, ())]
        if meant:
            message = f"{ends.name} is of no robot; planned: {shorten(meant, SEVERAL)}"
            cause = "start its node in its robot's namespace, with the rules of multibot plan"
            rule = _rule_of(seen, ends.kind, ends.name, ends.type)
            yield rule.finding(message, cause, names=(ends.name,))


def _names_of_robots(plan: Index) -> Mapping[str, Sequence[str]]:
    """The planned topics of robots by the name without the robot's."""
    found: dict[str, list[str]] = defaultdict(list)
    for name in dict.fromkeys(name for _, kind, _, name in plan.by_key if kind == TOPIC):
        robot = plan.robot(name)
        if robot:
            found[plan.of_names.without_robot(name, robot)].append(name)
    return found


def _shared_tf(plan: Index) -> set[str]:
    """The tf topics that robots share in their layout."""
    times = Counter(robot.tf_topic for robot in plan.system.robots)
    return {f"{tf}{end}" for tf, count in times.items() if count > 1 for end in ("", "_static")}


@found_by_plan(command_from_another_robot, data_of_another_robot)
def name_of_another_robot(plan: Index, seen: Index) -> Iterator[Finding]:
    """Of planned nodes; names that are in the plan are meant."""
    unplanned = unplanned_ends(plan, seen)
    for node, robot in plan.robot_of.items():
        for end in unplanned.get(node, ()):
            other = plan.robot(end.name)
            # Whose tf is where is a rule of its own.
            if other and other != robot and end.type != TF:
                reads = end.role == SUBSCRIBES
                rule = data_of_another_robot if reads else command_from_another_robot
                message = f"{DOES[end.role]} {end.name}, a name of {other}"
                cause = f"a remap rule or parameter of {robot} names {other}"
                yield rule.finding(message, cause, robot=robot, node=node, names=(end.name,))
