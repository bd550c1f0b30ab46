"""Dangers of connections: both sides of a name are there and do not connect, by type or QoS."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from multibot_rewrite.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.graph.wording import shorten
from multibot_rewrite.rules.declaration import danger_rule
from multibot_rewrite.rules.index import Ends, Index, is_viewer, nodes_of
from multibot_rewrite.rules.pair.type_and_qos import STAMPED, qos_conflicts
from multibot_rewrite.rules.places import see, where
from multibot_rewrite.system.conventions import EVERYBODYS
from multibot_rewrite.system.records import TOPIC, ZENOH, End


@danger_rule(
    "MG306",
    "types-differ",
    ERROR,
    planned="MG106",
    what="Both sides of a topic, service or action have different types, or two versions of one type.",
    why="No message arrives, and there is no error message.",
    fix="Use the same type on both sides; for velocities set `enable_stamped_cmd_vel`,"
    " `use_stamped_vel` or `stamped` alike on both.",
    bad="""\
running: /robot1/planner publishes /robot1/cmd_vel geometry_msgs/msg/TwistStamped
running: /robot1/driver subscribes /robot1/cmd_vel geometry_msgs/msg/Twist
""",
    good="""\
running: /robot1/planner publishes /robot1/cmd_vel geometry_msgs/msg/Twist
running: /robot1/driver subscribes /robot1/cmd_vel geometry_msgs/msg/Twist
""",
    line=2,
)
def types_differ(seen: Index) -> Iterator[Finding]:
    """Where one of a node's ends has the type of the other side, it connects."""
    for ends in seen.names.values():
        givers, takers = (ends.publishers, ends.subscribers)
        if ends.kind != TOPIC:
            givers, takers = ends.servers, ends.clients
        if len({(end.type, end.type_hash) for end in (*givers, *takers)}) < 2:
            continue
        given = {it for end in givers for it in _types(end)}
        for node in nodes_of(takers) if given and all(end.type for end in givers) else ():
            own = [end for end in takers if end.node == node]
            asked = {it for end in own for it in _types(end)}
            if not all(end.type for end in own) or _meet(asked, given):
                continue
            message, cause = _difference(ends.name, nodes_of(givers)[0], dict(asked), dict(given))
            level = WARNING if is_viewer(node) else ERROR
            robot = seen.robot(node) or seen.robot(ends.name)
            both = (*givers, *own)
            yield types_differ.finding(
                message, cause + see(both),
                level=level, robot=robot, node=node, names=(ends.name,), **where(both),
            )  # fmt: skip


def _types(end: End) -> Iterator[tuple[str, str]]:
    """The type of an end with its hash, and the others that it may have."""
    if end.type:
        yield end.type, end.type_hash
    yield from ((it, "") for it in end.also)


def _meet(asked: Iterable[tuple[str, str]], given: set[tuple[str, str]]) -> bool:
    """Have both sides a version of a type? One without a hash may be any."""
    return any(
        one == other and (hash_ == its or not (hash_ and its))
        for one, hash_ in asked
        for other, its in given
    )


def _difference(
    name: str, giver: str, asked: Mapping[str, str], given: Mapping[str, str]
) -> tuple[str, str]:
    """What is different, and what to do; of each type one hash."""
    wanted, there = (", ".join(sorted(it)) for it in (asked, given))
    if asked.keys() & given.keys():
        return (
            f"uses another version of {wanted} on {name} than {giver}",
            "their packages of messages were built from different versions: build both from one",
        )
    cause = "no message ever arrives; use the same type on both sides"
    if {it + STAMPED for it in asked} & given.keys() or {
        it + STAMPED for it in given
    } & asked.keys():
        cause += ": enable_stamped_cmd_vel, use_stamped_vel or stamped is set on one side"
    return f"uses {name} as {wanted}, but {giver} has it as {there}", cause


@danger_rule(
    "MG307",
    "qos-never-meets",
    ERROR,
    planned="MG107",
    what="A subscriber asks for a QoS that no publisher of the topic offers.",
    why="No message ever arrives; there is at most a line in the log.",
    fix="Let the subscriber ask for less (best effort, volatile), or the publishers offer more.",
    bad="""\
running: /robot1/lidar publishes /robot1/scan sensor_msgs/msg/LaserScan best_effort volatile
running: /robot1/amcl subscribes /robot1/scan sensor_msgs/msg/LaserScan reliable volatile
""",
    good="""\
running: /robot1/lidar publishes /robot1/scan sensor_msgs/msg/LaserScan best_effort volatile
running: /robot1/amcl subscribes /robot1/scan sensor_msgs/msg/LaserScan best_effort volatile
""",
    line=2,
)
def qos_never_meets(seen: Index) -> Iterator[Finding]:
    """A subscriber that hears at least one of several publishers is left alone; Zenoh connects all."""
    for (kind, name), ends in seen.names.items() if seen.system.environment.rmw != ZENOH else ():
        if kind != TOPIC or name in EVERYBODYS or not ends.publishers:
            continue
        for end in ends.subscribers:
            conflicts = _with_all(end, ends)
            if conflicts:
                yield _never_meets(seen, end, ends.publishers, conflicts)


def _with_all(end: End, ends: Ends) -> tuple[tuple[str, str], ...]:
    """Where a subscriber's QoS conflicts, if it does with every publisher; else nothing."""
    found = [qos_conflicts(it.qos, end.qos) if it.qos and end.qos else () for it in ends.publishers]
    return found[0] if all(found) else ()


def _never_meets(
    seen: Index,
    end: End,
    publishers: Iterable[End],
    conflicts: tuple[tuple[str, str], ...],
) -> Finding:
    offered = " and ".join(offer for offer, _ in conflicts)
    asked = " and ".join(request for _, request in conflicts)
    senders = shorten(nodes_of(publishers))
    message = f"subscribes to {end.name} with {asked}, but {senders} offers {offered}"
    cause = f"no message ever arrives: let it ask for {offered}, or the publisher offer {asked}"
    level = WARNING if is_viewer(end.node) else ERROR
    robot = seen.robot(end.node) or seen.robot(end.name)
    return qos_never_meets.finding(
        message, cause, level=level, robot=robot, node=end.node, names=(end.name,)
    )
