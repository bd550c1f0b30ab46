# SPDX-License-Identifier: Apache-2.0
"""Dangers of sharing: a topic of several robots, two senders of a map, one device, port or file."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence

from multibot_rewrite.base.conventions import ROWS
from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, Finding, Remap
from multibot_rewrite.base.wording import and_then, shorten
from multibot_rewrite.rules import declaration
from multibot_rewrite.rules.declaration import last_place, see_all, system_rule
from multibot_rewrite.rules.system.causes import Cause, names_another
from multibot_rewrite.system import words
from multibot_rewrite.system.index import NO_NAMESPACE, Ends, Index, at_work, nodes_of, robots_of
from multibot_rewrite.system.records import COMPUTER, PUBLISHES, SUBSCRIBES, TOPIC, Address, End
from multibot_rewrite.system.words import is_viewer, last_word


def own_names(seen: Index, ends: Ends, robots: Sequence[str]) -> Cause:
    """Return how each robot gets a topic of its own in place of one that they share."""
    outside = [] if NO_NAMESPACE in robots else outsiders(seen, ends.publishers)
    if outside:
        one = "start one" if len(outside) == 1 else "start them"
        return Cause(f"{shorten(outside)} sends it to all robots: {one} for each, in its namespace")
    users = nodes_of((*ends.publishers, *ends.subscribers))
    owner, plain = seen.robot(ends.name), seen.plain(ends.name)
    spaces = {it: _space(seen, it) for it in users if seen.robot(it) not in ("", owner)}
    remaps = [Remap(it, ends.name, f"{space}{plain}") for it, space in spaces.items() if space]
    if owner:
        return names_another(and_then(robots_of(seen, spaces)), owner, remaps)
    readers = [] if NO_NAMESPACE in robots else outsiders(seen, ends.subscribers)
    own = "each robot needs its own: write a relative name in the code or parameters of these nodes"
    if readers:
        return Cause(f"{own}; then {shorten(readers)} has to read those of all robots")
    rule = f"{ends.name}:={ends.name.strip('/')} in its robot's namespace"
    # Relative to the namespace of the node.
    if below := next(
        (it for it in remaps if it.new != f"{it.node.rpartition('/')[0]}{plain}"), None
    ):
        rule = f"with its robot's name, such as {below.old}:={below.new}"
    return Cause(
        f"{own}; or give each that uses it the rule {rule} (--ros-args -r, remappings= in the launch"
        " file)",
        remaps=tuple(remaps),
    )


def _space(seen: Index, node: str) -> str:
    """Return the namespace of a node's robot: a costmap has one of its own below it."""
    words_ = node.split("/")
    above = ("/".join(words_[:at]) for at in range(2, len(words_)))
    return next((it for it in above if seen.robot(f"{it}/x") == seen.robot(node)), "")


def outsiders(seen: Index, ends: Iterable[End]) -> list[str]:
    """Return the nodes that have these ends and belong to no robot."""
    return [it for it in nodes_of(at_work(ends)) if not seen.robot(it) and not is_viewer(it)]


@system_rule("MG320", "topic-of-several-robots", ERROR, drawn="leak", meant=(PUBLISHES, SUBSCRIBES))
def topic_of_several_robots(seen: Index) -> Iterator[Finding]:
    """Yield topics of one robot that several publish or read; reports and orders of fleets are fine."""
    for ends in seen.topics:
        plain, owner = seen.plain(ends.name), seen.robot(ends.name)
        # Who sends commands to another robot is a rule of its own.
        orders = words.moves(plain, ends.type) and bool(owner)
        sent = len(ends.publishers) > 1 and words.is_of_one_robot(plain, ends.type) and not orders
        # Of a topic without a robot's name; that of a robot is for those who follow it.
        read = words.is_of_a_body(ends.type) and not owner
        alone = read and len(robots_of(seen, nodes_of(ends.publishers))) < 2
        for side, do, asked in (
            (ends.publishers, "publish on", sent),
            (ends.subscribers, "all read", alone),
        ):
            nodes = nodes_of(at_work(side)) if asked else ()
            robots = robots_of(seen, nodes)
            if len(robots) > 1:
                yield topic_of_several_robots.finding(
                    f"{and_then(robots)} {do} {ends.name}: {shorten(nodes)}",
                    **own_names(seen, ends, robots)._asdict(), node=nodes[0], names=(ends.name,),
                )  # fmt: skip


@system_rule("MG321", "data-of-another-robot", ERROR, drawn="cross-talk", meant=(SUBSCRIBES,))
def data_of_another_robot(seen: Index) -> Iterator[Finding]:
    """Yield nodes that read another robot's data and not their own robot's; both is meant."""
    # What each robot publishes, by the name without the robot's.
    own = {
        (robot, seen.plain(ends.name)): ends
        for ends in seen.topics
        if ends.publishers and (robot := seen.robot(ends.name))
    }
    for (owner, plain), ends in own.items():
        sensors = words.is_of_one_robot(plain, ends.type)
        for end in at_work(ends.subscribers) if sensors else ():
            robot = seen.robot(end.node)
            mine = own.get((robot, plain))
            if robot in ("", owner) or mine is None or end.node in nodes_of(mine.subscribers):
                continue
            message = (
                f"subscribes to {ends.name} of {owner}, but {robot} has {mine.name}, which it does"
                " not read"
            )
            own_rule = [Remap(end.node, ends.name, mine.name)] if mine.type == ends.type else []
            yield data_of_another_robot.finding(
                message, **names_another(robot, owner, own_rule)._asdict(),
                robot=robot, node=end.node, names=(ends.name, mine.name),
            )  # fmt: skip


@system_rule("MG323", "two-maps", ERROR, meant=(PUBLISHES,))
def two_maps(seen: Index) -> Iterator[Finding]:
    """Report map topics with several publishers, unless they are of several robots."""
    for ends in seen.topics:
        nodes = nodes_of(ends.publishers) if ends.type == words.MAP else ()
        if len(nodes) < 2 or len(robots_of(seen, nodes)) > 1:
            continue
        message = f"{and_then(nodes)} both publish the map {ends.name}"
        cause = "map_server and SLAM, or the map servers of two robots: start one, or remap one"
        yield two_maps.finding(
            message, cause, robot=seen.robot(ends.name), node=nodes[0], names=(ends.name,)
        )


@system_rule("MG324", "joint-states-twice", WARNING, meant=(PUBLISHES,))
def joint_states_twice(seen: Index) -> Iterator[Finding]:
    """Report a second sender of joints that makes them up; several drivers with parts are usual."""
    for ends in seen.topics:
        nodes: Sequence[str] = nodes_of(ends.publishers) if ends.type == words.JOINTS else ()
        made_up = [node for node in nodes if last_word(node).startswith("joint_state_publisher")]
        if made_up and len(nodes) > 1 and len(robots_of(seen, nodes)) < 2:
            other = next((node for node in nodes if node not in made_up), nodes[1])
            message = f"publishes on {ends.name} as {other} does"
            cause = "joint_state_publisher is for a robot without hardware or simulator: stop it"
            yield joint_states_twice.finding(
                message, cause, level=ERROR if is_planned_with(seen, ends.name) else WARNING,
                robot=seen.robot(ends.name), node=made_up[0], names=(ends.name,),
            )  # fmt: skip


def is_planned_with(seen: Index, topic: str) -> bool:
    """Return whether joint states come to MoveIt."""
    # It plans as if an unknown joint were at its default (planning_scene_monitor.cpp).""
    readers = nodes_of(seen.ends_at(TOPIC, topic).subscribers)
    return any(last_word(it).startswith("move_group") for it in readers)


@system_rule("MG325", "sensor-twice", ERROR, meant=(PUBLISHES,))
def sensor_twice(seen: Index) -> Iterator[Finding]:
    """Yield sensor topics with two publishers, other than played bags, relays and bridges."""
    for ends in seen.topics:
        described = last_word(ends.name) == words.DESCRIPTION
        if len(ends.publishers) < 2 or not (described or words.is_of_one_sensor(ends.type)):
            continue
        nodes = [it for it in nodes_of(at_work(ends.publishers)) if not _passes_on(seen, it, ends)]
        played = any(last_word(node).startswith(words.PLAYER) for node in nodes)
        if len(nodes) < 2 or played or len(robots_of(seen, nodes)) > 1:
            continue
        yield sensor_twice.finding(
            f"{and_then(nodes)} both publish {ends.name}",
            "give each its own topic, or stop one",
            level=ERROR if ends.type == words.ODOMETRY else WARNING,
            robot=seen.robot(ends.name),
            node=nodes[0],
            names=(ends.name,),
        )


def _passes_on(seen: Index, node: str, ends: Ends) -> bool:
    """Return whether a node reads what it sends or such data; a filter makes odometry from odometry."""
    read = (it for it in seen.by_node.get(node, ()) if it.role == SUBSCRIBES)
    passed = ends.type != words.ODOMETRY
    return any(it.name == ends.name or (passed and it.type == ends.type) for it in read)


_ADVICE = {kind: said for (kind,), said in ROWS["addresses"]}


def _one_device(seen: Index) -> Iterator[Finding]:
    """Report all devices that two nodes of two robots share, by kind, at the second one."""
    first: dict[tuple[str, str, str], Address] = {}
    met: dict[tuple[str, str, str], list[tuple[Address, Address]]] = defaultdict(list)
    for it in seen.system.addresses:
        other = first.setdefault((it.kind, it.name, it.value), it)
        if seen.robot(it.node) != seen.robot(other.node):
            met[it.kind, it.node, other.node].append((other, it))
    for (kind, node, other_node), pairs in met.items():
        given = ", ".join(f"{it.name} {it.value}" for _, it in pairs)
        yield one_device.finding(
            f"has the same as {other_node}: {given}", _ADVICE[kind] + see_all(pairs[0]),
            level=NOTE if kind == COMPUTER else WARNING,
            robot=seen.robot(node), node=node, names=(other_node,), **last_place(pairs[0]),
        )  # fmt: skip


one_device = declaration.ONE_DEVICE._replace(check=_one_device)
