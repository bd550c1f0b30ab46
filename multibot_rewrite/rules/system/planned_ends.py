# SPDX-License-Identifier: Apache-2.0
"""Rule about the names of planned nodes: which one lacks, and what it has in their place or besides."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence, Set

from multibot_rewrite.base.conventions import EVERYBODYS
from multibot_rewrite.base.findings.finding import ERROR, Finding, Remap, Rule
from multibot_rewrite.base.nearest import MISTYPED, nearest
from multibot_rewrite.base.wording import SEVERAL, only, shorten, unique
from multibot_rewrite.rules.declaration import planned_rule
from multibot_rewrite.rules.system.causes import (
    DOES,
    TO_DO,
    Cause,
    caused,
    how_to_pass,
    how_to_remap,
    letters,
    names_without_rules,
    plugin_of,
    remap_rule,
    use_absolute,
    why_not_remapped,
)
from multibot_rewrite.rules.system.commands import (
    command_for_several_robots,
    command_from_another_robot,
)
from multibot_rewrite.rules.system.names import service_of_two_nodes
from multibot_rewrite.rules.system.sharing import data_of_another_robot, topic_of_several_robots
from multibot_rewrite.system.index import TF, EndKey, Index, ends_of, once
from multibot_rewrite.system.ownership import NameOwnership
from multibot_rewrite.system.records import PUBLISHES, RUNS, SERVES, SERVICE, SUBSCRIBES, TOPIC, End
from multibot_rewrite.system.tf_copies import copying_nodes
from multibot_rewrite.system.words import in_namespaces_above, is_order

# With more names than these, some name is always similar.
MOST_CANDIDATES = 50


@once
def missing(plan: Index, seen: Index) -> Mapping[EndKey, End]:
    """Return the planned ends that are missing, without optional ones."""
    there = seen.by_key
    return {key: end for key, end in plan.sure.by_key.items() if key not in there}


@once
def unplanned_ends(plan: Index, seen: Index) -> Mapping[str, Sequence[End]]:
    """Return by node the ends that are not planned, each once, without hidden ones."""
    found: dict[str, list[End]] = defaultdict(list)
    known = set(plan.by_key)
    for end in seen.sure.system.ends:
        key = (end.node, end.kind, end.role, end.name)
        # A node may subscribe to a topic more than once.
        if key not in known and "/_" not in end.name:
            known.add(key)
            found[end.node].append(end)
    return found


@once
def unplanned_nodes(plan: Index, seen: Index) -> Sequence[str]:
    """Return the nodes that are not planned, without tools, which come and go."""
    return [node for node in _not_in_plan(plan, seen) if not seen.is_tool(node)]


@once
def _not_in_plan(plan: Index, seen: Index) -> Set[str]:
    known = plan.robot_of.keys() | set(plan.own[""])
    return dict.fromkeys(node for node in seen.nodes if node not in known).keys()


@once
def matches(plan: Index, seen: Index) -> Mapping[str, str]:
    """Return for each missing node the running node that it probably is."""
    gone = {node: robot for node, robot in plan.robot_of.items() if node not in seen.nodes}
    return probable_matches(
        gone, _not_in_plan(plan, seen), unplanned_nodes(plan, seen), plan.of_names
    )


def probable_matches(
    missing: Mapping[str, str],
    others: Collection[str],
    unplanned: Iterable[str],
    ownership: NameOwnership,
) -> dict[str, str]:
    """Return missing node -> the running node that it probably is, for nodes that have one.

    ``others`` are all running nodes that are not in the plan, ``unplanned`` those of them that are
    no tools: only these are compared by similar name."""
    by_robot: dict[str, list[str]] = defaultdict(list)
    for node in unplanned if missing else ():
        by_robot[ownership.robot(node)].append(node)
    spaces = {letters(node.split("/")[1]): node.split("/")[1] for node in by_robot.get("", ())}
    found: dict[str, str] = {}
    for node, robot in missing.items():
        plain = ownership.without_robot(node, robot)
        space = spaces.get(letters(robot), robot)
        likely = (plain, f"/{plain.rpartition('/')[2]}", f"/{space}{plain}")
        own = {ownership.without_robot(it, robot): it for it in by_robot.get(robot, ())}
        there = next((it for it in likely if it in others), "")
        if match := there or own.get(similar(plain, own), ""):
            found[node] = match
    return found


def similar(name: str, known: Collection[str]) -> str:
    """Return the known name that extends ``name``, is its beginning or is nearly the same; or ""."""
    if len(known) > MOST_CANDIDATES:
        return ""
    extended = [other for other in known if other.startswith(name) or name.startswith(other)]
    if extended:
        return min(extended, key=lambda other: abs(len(other) - len(name)))
    return nearest(name, known, MISTYPED)


@planned_rule("MG102", "missing-endpoint", ERROR, absence=True, drawn="missing", nodes=False)
def missing_endpoint(plan: Index, seen: Index) -> Iterator[Finding]:
    """Report what a running node lacks of its planned ends, and what it has in their place."""
    if not seen.nodes:
        yield from _faults_of_recording(plan, seen)
        return
    taken = set()
    for planned in {it[:1] + it[3:]: end for it, end in missing(plan, seen).items()}.values():
        # Of two nodes with one name, rcl shows the services of only one.
        times = seen.nodes.get(planned.node, 0)
        if not times or (times > 1 and planned.kind != TOPIC):
            continue
        used = _used_instead(plan, seen, planned)
        # Without one that is called so, the only one of its type is what the hint names.
        alike = [] if used else _same_type_names(plan, seen, planned)
        instead = used or only(alike)
        taken.add((planned.node, instead))
        end = next((it for it in ends_of(seen, used) if it.node == planned.node), planned)
        robot = plan.robot_of.get(planned.node, "")
        rule = _broken_rule(plan, end, robot) or missing_endpoint
        yield rule.finding(
            f"should {TO_DO[planned.role]} {planned.kind} {planned.name}, but does not",
            **_with_tools(plan, seen, robot, _why_missing(plan, seen, planned, used))._asdict(),
            robot=robot, node=planned.node, names=(planned.name, *[instead] * bool(instead)),
        )  # fmt: skip
    for node, robot in plan.robot_of.items():
        for end in {it.name: it for it in unplanned_ends(plan, seen).get(node, ())}.values():
            wrong = _broken_rule(plan, end, robot)
            if wrong and (node, end.name) not in taken:
                other = plan.robot(end.name)
                # As far as they are there.
                users = {seen.robot(it.node) for it in ends_of(seen, end.name)} - {""}
                why = ", and is not in shared_topics: robots that do the same use one topic"
                why = f": {len(users)} robots use it" if len(users) > 1 else why
                no_name = f"uses {end.name}, which is not a name of {robot}{why}"
                of_another = f"{DOES[end.role]} {end.name}, a name of {other}"
                yield wrong.finding(
                    of_another if other else no_name,
                    **_why_besides(plan, end, other)._asdict(),
                    robot=robot, node=node, names=(end.name,),
                )  # fmt: skip
    yield from _planned_for_several(plan, seen)


def _planned_for_several(plan: Index, seen: Index) -> Iterator[Finding]:
    """Yield names that the plan has for several robots, because no remap rule changes them."""
    users: dict[str, list[End]] = defaultdict(list)
    relays, there, robot_of = copying_nodes(plan.system), seen.by_key, plan.robot_of
    of_one = plan.of_names.exact
    for key in plan.by_key:
        if key[3] in of_one or key[0] not in robot_of or key[0] in relays:
            continue
        if (end := there.get(key)) and end.sure == RUNS:
            users[key[3]].append(end)
    for name, ends in users.items():
        robots = unique(plan.robot_of[it.node] for it in ends)
        rule = _sharing_rule(plan, ends[0]) if len(robots) > 1 and not plan.robot(name) else None
        if rule:
            yield rule.finding(
                f"uses {name}, which the plan has for several robots: {shorten(robots, SEVERAL)}",
                "no remap rule changes it: set the node's parameter, or add it to shared_topics",
                robot=robots[0], node=ends[0].node, names=(name,),
            )  # fmt: skip


def _broken_rule(plan: Index, end: End, robot: str) -> Rule | None:
    """Return the rule that an unplanned end of a robot's node breaks towards other robots, or None."""
    other = plan.robot(end.name)
    planned = (end.node, end.kind, end.role, end.name) in plan.by_key
    if planned or not robot or other == robot:
        return None
    if not other or end.name in plan.system.shared_topics or end.type == TF:
        return _sharing_rule(plan, end)
    return data_of_another_robot if end.role == SUBSCRIBES else command_from_another_robot


def _sharing_rule(plan: Index, end: End) -> Rule | None:
    """Return the rule that sharing a name with other robots breaks; None if it is meant."""
    if end.name in plan.system.shared_topics or end.name in EVERYBODYS or end.type == TF:
        return None
    if end.kind != TOPIC:
        return service_of_two_nodes
    return command_for_several_robots if is_order(end.name, end.type) else topic_of_several_robots


def _why_besides(plan: Index, end: End, other: str) -> Cause:
    """Return why a node has an end of no robot or of another one, and what to do."""
    node, name = end.node, end.name
    robot, (plugin, place) = plan.robot_of[node], plugin_of(plan, node)
    if other:
        return Cause(f"correct the remap rule or parameter of {robot} that names {other}")
    if plugin:
        return caused(f"{plugin} has no namespace or remap rule for it, see {place}", place)
    word = plan.of_names.tag(robot)
    target = f"{name}/{word}" if plan.of_names.robot_is_last else f"/{word}{name}"
    rule = how_to_pass(plan, node, f"{name}:={target}")
    hint = f"an absolute name in its code or parameters; pass {rule}"
    return Cause(hint, remaps=(Remap(node, name, target),))


def _why_missing(plan: Index, seen: Index, planned: End, used: str) -> Cause:
    """Return the likely cause why a planned name, such as /robot1/cmd_vel, never appears."""
    if not used:
        managed = (planned.node, SERVICE, SERVES, f"{planned.node}/get_state") in plan.by_key
        state = f"; is it configured? ros2 lifecycle get {planned.node}" if managed else ""
        same = _same_type_names(plan, seen, planned)
        # Of text and numbers are many things.
        if len(same) == 1 or (same and "std_" not in planned.type):
            return Cause(
                f"it {DOES[planned.role]} {shorten(same)} of that type: is that meant?{state}"
            )
        return Cause(f"it has no similar name; is it switched off by a parameter?{state}")
    instead = f"it {DOES[planned.role]} {used} instead"
    if used in names_without_rules(plan, planned):
        why = why_not_remapped(plan, planned)
        remaps = (Remap(planned.node, used, planned.name),) if remap_rule(planned) else ()
        hint = f"{instead}: {why.hint}{how_to_remap(plan, planned)}"
        return why._replace(hint=hint, remaps=remaps)
    cause = _why_remapped(plan, planned, used, instead)
    types = (it.type for it in _unplanned(plan, seen, planned) if it.name == used)
    alike = all(it in ("", planned.type) for it in types) or not planned.type
    return cause._replace(remaps=(Remap(planned.node, used, planned.name),) if alike else ())


def _with_tools(plan: Index, seen: Index, robot: str, cause: Cause) -> Cause:
    """Return a cause whose rules are also for the robot's tools, such as RViz, which no plan has."""
    for rule in cause.remaps:
        users = unique(it.node for it in ends_of(seen, rule.old) if seen.is_tool(it.node))
        tools = [it for it in users if it not in plan.node and seen.robot(it) == robot]
        if tools:
            rules = (*cause.remaps, *(rule._replace(node=it) for it in tools))
            return cause._replace(hint=f"{cause.hint}; {shorten(tools)} too", remaps=rules)
    return cause


def _why_remapped(plan: Index, planned: End, used: str, instead: str) -> Cause:
    """Return why an endpoint has a name that comes from a rule or parameter."""
    if not plan.robot(planned.name):
        _, place = plugin_of(plan, planned.node)
        why = f": a rule remaps it, but the plan has one {planned.name} for all robots"
        return caused(f"{instead}{why}{f', see {place}' if place else ''}", place)
    if planned.name in in_namespaces_above(planned.node, used):
        return Cause(f"{instead}: {use_absolute(planned.name)}")
    other = plan.robot(used)
    if other and other != plan.robot_of.get(planned.node, other):
        wrong = f"a name of {other}: a remap rule or parameter names the wrong robot"
        return Cause(f"{instead}, {wrong}")
    return Cause(f"{instead}: is the name misspelled in a remap rule or parameter?")


def _used_instead(plan: Index, seen: Index, planned: End) -> str:
    """Return the name that a node probably uses in place of a planned one; empty for none."""
    unplanned = [it.name for it in _unplanned(plan, seen, planned)]
    likely = [name for name in names_without_rules(plan, planned) if name in unplanned]
    # A relative name that was resolved below the node's own namespace.
    likely += [it for it in unplanned if planned.name in in_namespaces_above(planned.node, it)]
    if likely:
        return likely[0]
    # A node for all robots has names of several: which robot's is in the name itself.
    ownership = plan.of_names
    robot = plan.robot_of.get(planned.node) or ownership.robot(planned.name)
    plain = {
        ownership.without_robot(name, ownership.robot(name) or robot): name for name in unplanned
    }
    wanted = ownership.without_robot(planned.name, robot)
    near = plain.get(wanted, "") or plain.get(similar(wanted, plain), "")
    if near or planned.node in plan.robot_of:
        return near
    return similar(planned.name, unplanned)


def _same_type_names(plan: Index, seen: Index, planned: End) -> list[str]:
    """Return the unplanned names that the node has with the planned type."""
    return [it.name for it in _unplanned(plan, seen, planned) if it.type == planned.type != ""]


def _unplanned(plan: Index, seen: Index, planned: End) -> list[End]:
    """Return the unplanned ends that a node has in the role of a planned one."""
    node, kind, role = planned.node, planned.kind, planned.role
    return [
        it
        for it in seen.by_node.get(node, ())
        if (it.kind, it.role) == (kind, role) and (node, kind, role, it.name) not in plan.by_key
    ]


def _faults_of_recording(plan: Index, seen: Index) -> Iterator[Finding]:
    """Report topics of a recording that only some robots have, or that are of no robot."""
    there = {name: ends for (kind, name), ends in seen.by_name.items() if kind == TOPIC}
    for names in _planned_topics(plan.sure, PUBLISHES).values():
        others = [name for name in names.values() if name in there]
        for robot, name in names.items() if others else ():
            if name not in there:
                message = f"{name} is not there, {shorten(others, SEVERAL)} is"
                cause = "did its node run, in its robot's namespace, and was the topic recorded?"
                yield missing_endpoint.finding(message, cause, robot=robot, names=(name,))
    planned, every = (
        {name for *_, name in plan.by_key},
        _planned_topics(plan, PUBLISHES, SUBSCRIBES),
    )
    for name in [it for it in there if it not in planned and not plan.robot(it)]:
        segments = name.strip("/").split("/")
        likely = {"/" + "/".join(it) for it in (segments, segments[1:], segments[:-1])}
        meant = [own for plain in likely for own in every.get(plain, {}).values()]
        rule = _broken_rule(plan, there[name].publishers[0], plan.robots[0]) if meant else None
        if rule:
            message = f"{name} is of no robot; planned: {shorten(meant, SEVERAL)}"
            cause = "start its node in its robot's namespace, with the rules of multibot plan"
            yield rule.finding(message, cause, names=(name,))


def _planned_topics(plan: Index, *roles: str) -> Mapping[str, Mapping[str, str]]:
    """Return, by name without the robot, each robot's planned topic with such a role, and its tf."""
    named = [name for _, kind, role, name in plan.by_key if kind == TOPIC and role in roles]
    trees = [it.tf_topic for it in plan.system.robots if it.frames]
    found: dict[str, dict[str, str]] = defaultdict(dict)
    for name in (*named, *trees):
        robot = plan.robot(name)
        if robot and name not in plan.system.shared_topics and name not in EVERYBODYS:
            found[plan.of_names.without_robot(name, robot)][robot] = name
    return found
