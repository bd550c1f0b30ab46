"""Rules about both sides of a name: do they use the same type, and does their QoS match."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from functools import lru_cache
from math import inf

from multibot_rewrite.findings.finding import ERROR, Finding
from multibot_rewrite.graph.wording import shorten
from multibot_rewrite.rules.declaration import graph_rule
from multibot_rewrite.rules.pair.causes import DOES, caused, plugin_of
from multibot_rewrite.rules.pair.comparison import View
from multibot_rewrite.system.records import PUBLISHES, SUBSCRIBES, TOPIC, ZENOH, End, Qos

# The words of each policy, the weakest first; any other word does not say what is in force.
RELIABILITY = ("BEST_EFFORT", "RELIABLE")
DURABILITY = ("VOLATILE", "TRANSIENT_LOCAL")
LIVELINESS = ("AUTOMATIC", "MANUAL_BY_NODE", "MANUAL_BY_TOPIC")
# A valid type hash starts with the version of the hash.
HASH = "RIHS"
STAMPED = "Stamped"


@graph_rule(
    "MG106",
    "type-mismatch",
    ERROR,
    all_ends=True,
    what="A topic, service or action has two types, two versions of one type, or another type than"
    " in the plan.",
    why="No message arrives, and there is no error message.",
    fix="Use the same type on both sides (stamped or not), and build both against one version. If"
    " the running type is right, correct the plan.",
    bad="""\
as planned: /robot1/planner publishes /robot1/cmd_vel geometry_msgs/msg/TwistStamped
as planned: /robot1/driver subscribes /robot1/cmd_vel geometry_msgs/msg/Twist
""",
    good="""\
as planned: /robot1/planner publishes /robot1/cmd_vel geometry_msgs/msg/Twist
as planned: /robot1/driver subscribes /robot1/cmd_vel geometry_msgs/msg/Twist
""",
    line=2,
)
def type_mismatch(view: View) -> Iterator[Finding]:
    """Each name once: between its two sides, else between graph and plan."""
    reported = set()
    for name, endpoints in view.by_name.items():
        for ends in () if _same_type(endpoints) else _by_kind(endpoints):
            conflict = _several_types(view, name, ends) or _several_versions(view, name, ends)
            if conflict:
                reported.add(name)
                yield conflict
    for key, planned in view.planned.items():
        seen, type_ = view.types.get(key, ""), planned.type
        if seen in ("", type_) or not type_ or seen in planned.also or planned.name in reported:
            continue
        yield _not_as_planned(view, planned, seen)


def _same_type(ends: Sequence[End]) -> bool:
    """The usual case, checked first because it is fast."""
    first = (ends[0].type, ends[0].type_hash, ends[0].kind)
    return all((end.type, end.type_hash, end.kind) == first for end in ends)


def _by_kind(ends: Sequence[End]) -> Iterable[Sequence[End]]:
    """A topic and a service may have the same name."""
    if len({end.kind for end in ends}) == 1:
        return (ends,)
    kinds: dict[str, list[End]] = defaultdict(list)
    for end in ends:
        kinds[end.kind].append(end)
    return kinds.values()


def _several_types(view: View, name: str, ends: Sequence[End]) -> Finding | None:
    types = Counter(end.type for end in ends if end.type)
    if len(types) < 2:
        return None
    by_type = {type_: [end for end in ends if end.type == type_] for type_ in types}
    planned = {type_ for end in ends for type_ in _planned_types(view, end)}
    # The finding is about the side that differs from the plan, else about the smaller one.
    order = sorted(by_type, key=lambda type_: (type_ in planned, types[type_], type_))
    parts = [f"{_who(by_type[type_])} {type_}" for type_ in order]
    message = f"{ends[0].kind} {name} has {len(types)} types: {', '.join(parts)}"
    cause = "no message ever arrives; use the same type on both sides"
    if any(f"{type_}{STAMPED}" in types for type_ in types):
        cause += ": enable_stamped_cmd_vel, use_stamped_vel or stamped is set on one side only"
    return _finding(view, by_type[order[0]][0], message, cause)


def _planned_types(view: View, end: End) -> tuple[str, ...]:
    planned = view.planned.get((end.node, end.kind, end.role, end.name))
    return (planned.type, *planned.also) if planned else ()


def _several_versions(view: View, name: str, ends: Sequence[End]) -> Finding | None:
    """One type in two versions: the names match, the messages do not."""
    by_hash: dict[str, list[End]] = defaultdict(list)
    for end in ends:
        if end.type_hash.startswith(HASH):
            by_hash[end.type_hash].append(end)
    if len(by_hash) < 2:
        return None
    rarest = min(by_hash.values(), key=len)
    type_ = rarest[0].type
    parts = [f"{_who(own)} {hash_[:16]}" for hash_, own in by_hash.items()]
    message = f"{ends[0].kind} {name} has {len(by_hash)} versions of {type_}: {', '.join(parts)}"
    package = type_.partition("/")[0]
    cause = (
        f"the nodes were built against different versions of {package}; build both against the same"
    )
    return _finding(view, rarest[0], message, cause)


def _who(ends: Sequence[End]) -> str:
    more = len({end.node for end in ends}) - 1
    others = f" (and {more} more)" if more else ""
    return f"{ends[0].node}{others} {DOES[ends[0].role]}"


def _finding(view: View, end: End, message: str, cause: str) -> Finding:
    robot = view.robot_of.get(end.node) or view.ownership.robot(end.name)
    return type_mismatch.finding(message, cause, robot=robot, node=end.node, names=(end.name,))


def _not_as_planned(view: View, planned: End, seen: str) -> Finding:
    what = f"{DOES[planned.role]} {planned.kind} {planned.name}"
    message = f"{what} with type {seen}, but the plan has {planned.type}"
    plugin, place = plugin_of(view, planned.node)
    which = f"another version or setting of {plugin or 'the node'}"
    see = f", see {place}" if place else ""
    cause = caused(f"{which}{see}? If this type is right, correct the plan", place)
    return type_mismatch.finding(
        message,
        **cause._asdict(),
        robot=view.robot_of.get(planned.node, ""),
        node=planned.node,
        names=(planned.name,),
    )


@graph_rule(
    "MG107",
    "qos-mismatch",
    ERROR,
    what="A publisher offers less QoS than a subscription requests: reliability, durability,"
    " deadline, liveliness or lease.",
    why="DDS does not connect them: both are in the graph, and no message arrives.",
    fix="Let the publisher offer more, or the subscription request less.",
    bad="""\
as planned: /robot1/camera publishes /robot1/image sensor_msgs/msg/Image best_effort
as planned: /robot1/viewer subscribes /robot1/image sensor_msgs/msg/Image reliable
""",
    good="""\
as planned: /robot1/camera publishes /robot1/image sensor_msgs/msg/Image best_effort
as planned: /robot1/viewer subscribes /robot1/image sensor_msgs/msg/Image best_effort
""",
    line=2,
)
def qos_mismatch(view: View) -> Iterator[Finding]:
    """One finding for each subscription. Zenoh connects any two (rmw_zenoh design.md)."""
    for name, ends in view.by_name.items() if view.graph.environment.rmw != ZENOH else ():
        # The same QoS on both sides always connects.
        if all(end.qos == ends[0].qos for end in ends):
            continue
        publishers = _by_qos(ends, PUBLISHES)
        subscribers = _by_qos(ends, SUBSCRIBES) if publishers else {}
        for requested, nodes in subscribers.items():
            for offered, senders in publishers.items():
                conflicts = qos_conflicts(offered, requested)
                for node in nodes if conflicts else ():
                    yield _qos_finding(view, name, senders, node, conflicts)


def _by_qos(ends: Iterable[End], role: str) -> dict[Qos, list[str]]:
    """The nodes on one side of a topic by their QoS, where it is known."""
    found: dict[Qos, dict[str, None]] = {}
    for end in ends:
        if end.role == role and end.kind == TOPIC and end.qos is not None:
            found.setdefault(end.qos, {})[end.node] = None
    return {qos: list(nodes) for qos, nodes in found.items()}


def _qos_finding(
    view: View,
    name: str,
    publishers: Sequence[str],
    subscriber: str,
    conflicts: tuple[tuple[str, str], ...],
) -> Finding:
    offered = " and ".join(offer for offer, _ in conflicts)
    requested = " and ".join(request for _, request in conflicts)
    more = f" (and {len(publishers) - 1} more)" if len(publishers) > 1 else ""
    message = (
        f"QoS on {name} is incompatible: {publishers[0]}{more} offers {offered},"
        f" {subscriber} requests {requested}"
    )
    cause = (
        f"no message ever arrives; let {shorten(publishers)} offer {requested}, or {subscriber}"
        f" request {offered}"
    )
    robot = view.robot_of.get(subscriber) or view.ownership.robot(subscriber)
    return qos_mismatch.finding(message, cause, robot=robot, node=subscriber, names=(name,))


@lru_cache(maxsize=1024)
def qos_conflicts(offered: Qos, requested: Qos) -> tuple[tuple[str, str], ...]:
    """Where two QoS do not connect by the rules of DDS: (offered, requested) for each policy.

    A policy that is unknown or the system's default is no conflict.
    """
    words = (
        (offered.reliability, requested.reliability, RELIABILITY),
        (offered.durability, requested.durability, DURABILITY),
        (offered.liveliness, requested.liveliness, LIVELINESS),
    )
    times = (
        (offered.deadline, requested.deadline, "a deadline"),
        (offered.liveliness_lease_duration, requested.liveliness_lease_duration, "a lease"),
    )
    return (
        *((o, r) for o, r, order in words if _is_weaker(o, r, order)),
        *((_time(o, what), _time(r, what)) for o, r, what in times if _seconds(o) > _seconds(r)),
    )


def _is_weaker(offered: str, requested: str, order: Sequence[str]) -> bool:
    known = offered in order and requested in order
    return known and order.index(offered) < order.index(requested)


def _seconds(time: float) -> float:
    """rmw writes no limit as 0."""
    return time if time > 0 else inf


def _time(time: float, what: str) -> str:
    return f"no {what[2:]}" if _seconds(time) == inf else f"{what} of {time:g} s"
