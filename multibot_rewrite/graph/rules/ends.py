"""Rules about the two ends of a name: the same type, and a QoS that connects."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from functools import lru_cache
from math import inf

from multibot_rewrite.graph.expectation import Wanted
from multibot_rewrite.graph.rules.causes import some
from multibot_rewrite.graph.rules.comparison import GraphFinding, View
from multibot_rewrite.graph.snapshot import GraphEndpoint, Qos
from multibot_rewrite.model import ERROR
from multibot_rewrite.remap.records import PUBLISHES, SUBSCRIBES, TOPIC

# What a policy offers, the least first; every other word says nothing of what is in force.
RELIABILITY = ("BEST_EFFORT", "RELIABLE")
DURABILITY = ("VOLATILE", "TRANSIENT_LOCAL")
LIVELINESS = ("AUTOMATIC", "MANUAL_BY_NODE", "MANUAL_BY_TOPIC")
# A type hash that means something; the version of the hash comes first.
HASH = "RIHS"
STAMPED = "Stamped"


def type_clashes(view: View) -> Iterator[GraphFinding]:
    """A topic, service or action with more than one type, or with another one than planned."""
    told = set()
    for name, there in view.by_name.items():
        for ends in () if _alike(there) else _by_kind(there):
            clash = _types(view, name, ends) or _versions(view, name, ends)
            if clash:
                told.add(name)
                yield clash
    for end, wanted in view.planned.items():
        seen, type_ = view.types.get(end, ""), wanted.type
        if seen in ("", type_) or not type_ or seen in wanted.also or wanted.name in told:
            continue
        yield _not_as_planned(view, wanted, seen)


def _alike(ends: Sequence[GraphEndpoint]) -> bool:
    """The usual case, seen at a glance."""
    first = (ends[0].type, ends[0].type_hash, ends[0].kind)
    return all((end.type, end.type_hash, end.kind) == first for end in ends)


def _by_kind(ends: Sequence[GraphEndpoint]) -> Iterable[Sequence[GraphEndpoint]]:
    """A topic and a service may have one name."""
    if len({end.kind for end in ends}) == 1:
        return (ends,)
    kinds: dict[str, list[GraphEndpoint]] = defaultdict(list)
    for end in ends:
        kinds[end.kind].append(end)
    return kinds.values()


def _types(view: View, name: str, ends: Sequence[GraphEndpoint]) -> GraphFinding | None:
    types = Counter(end.type for end in ends if end.type)
    if len(types) < 2:
        return None
    of = {type_: [end for end in ends if end.type == type_] for type_ in types}
    planned = {t for end in ends for t in _planned_types(view, end)}
    # At fault is who differs from the plan, else who is alone.
    order = sorted(of, key=lambda type_: (type_ in planned, types[type_], type_))
    parts = [f"{_who(of[type_])} {type_}" for type_ in order]
    message = f"{ends[0].kind} {name} has {len(types)} types: {', '.join(parts)}"
    cause = "no message ever arrives; make both the same"
    if any(f"{type_}{STAMPED}" in types for type_ in types):
        cause += ": enable_stamped_cmd_vel, use_stamped_vel or stamped is set on one side only"
    return _finding(view, of[order[0]][0], message, cause)


def _planned_types(view: View, end: GraphEndpoint) -> tuple[str, ...]:
    wanted = view.planned.get((end.node, end.kind, end.role, end.name))
    return (wanted.type, *wanted.also) if wanted else ()


def _versions(view: View, name: str, ends: Sequence[GraphEndpoint]) -> GraphFinding | None:
    """One type in two versions: the names match, the messages do not."""
    of: dict[str, list[GraphEndpoint]] = defaultdict(list)
    for end in ends:
        if end.type_hash.startswith(HASH):
            of[end.type_hash].append(end)
    if len(of) < 2:
        return None
    rarest = min(of.values(), key=len)
    type_ = rarest[0].type
    parts = [f"{_who(there)} {hash_[:16]}" for hash_, there in of.items()]
    message = f"{ends[0].kind} {name} has {len(of)} versions of {type_}: {', '.join(parts)}"
    package = type_.partition("/")[0]
    cause = f"they were built against different versions of {package}: build both against one"
    return _finding(view, rarest[0], message, cause)


def _who(ends: Sequence[GraphEndpoint]) -> str:
    more = len({end.node for end in ends}) - 1
    others = f" (and {more} more)" if more else ""
    return f"{ends[0].node}{others} {ends[0].role}"


def _finding(view: View, end: GraphEndpoint, message: str, cause: str) -> GraphFinding:
    robot = view.robot_of.get(end.node) or view.owners.of(end.name)
    return GraphFinding("MG106", ERROR, robot, end.node, message, cause, (end.name,))


def _not_as_planned(view: View, wanted: Wanted, seen: str) -> GraphFinding:
    message = f"it {wanted.role} {wanted.kind} {wanted.name} as {seen}, planned is {wanted.type}"
    cause = "another version or setting of the node? if it is right, put it in the plan"
    robot = view.robot_of.get(wanted.node, "")
    return GraphFinding("MG106", ERROR, robot, wanted.node, message, cause, (wanted.name,))


def qos_clashes(view: View) -> Iterator[GraphFinding]:
    """A publisher that offers less than a subscription asks for: no message ever arrives."""
    for name, ends in view.by_name.items():
        # An offer meets the same demand.
        if all(end.qos == ends[0].qos for end in ends):
            continue
        givers = _by_qos(ends, PUBLISHES)
        takers = _by_qos(ends, SUBSCRIBES) if givers else {}
        for asked, nodes in takers.items():
            for offered, from_ in givers.items():
                lacks = lacking(offered, asked)
                for node in nodes if lacks else ():
                    yield _unmet(view, name, from_, node, lacks)


def _by_qos(ends: Iterable[GraphEndpoint], role: str) -> dict[Qos, list[str]]:
    """The nodes of a topic's one side by their QoS, where it is known."""
    found: dict[Qos, dict[str, None]] = {}
    for end in ends:
        if end.role == role and end.kind == TOPIC and end.qos is not None:
            found.setdefault(end.qos, {})[end.node] = None
    return {qos: list(nodes) for qos, nodes in found.items()}


def _unmet(
    view: View, name: str, givers: Sequence[str], taker: str, lacks: tuple[tuple[str, str], ...]
) -> GraphFinding:
    offered = " and ".join(offer for offer, _ in lacks)
    asked = " and ".join(ask for _, ask in lacks)
    more = f" (as {len(givers) - 1} more)" if len(givers) > 1 else ""
    message = f"{name}: {givers[0]}{more} offers {offered}, {taker} wants {asked}"
    cause = (
        f"no message ever arrives: let {some(givers)} offer {asked}, or {taker} ask for {offered}"
    )
    robot = view.robot_of.get(taker) or view.owners.of(taker)
    return GraphFinding("MG107", ERROR, robot, taker, message, cause, (name,))


@lru_cache(maxsize=1024)
def lacking(offered: Qos, asked: Qos) -> tuple[tuple[str, str], ...]:
    """What is offered and what is asked for, policy by policy, where they cannot connect (the
    request-offered rules of DDS). What is unknown or the system's choice is no clash."""
    words = (
        (offered.reliability, asked.reliability, RELIABILITY),
        (offered.durability, asked.durability, DURABILITY),
        (offered.liveliness, asked.liveliness, LIVELINESS),
    )
    times = (
        (offered.deadline, asked.deadline, "a deadline"),
        (offered.liveliness_lease_duration, asked.liveliness_lease_duration, "a lease"),
    )
    return (
        *((o, a) for o, a, order in words if _below(o, a, order)),
        *((_time(o, what), _time(a, what)) for o, a, what in times if _seconds(o) > _seconds(a)),
    )


def _below(offered: str, asked: str, order: Sequence[str]) -> bool:
    known = offered in order and asked in order
    return known and order.index(offered) < order.index(asked)


def _seconds(time: float) -> float:
    """Nothing and less is no limit, as rmw writes it."""
    return time if time > 0 else inf


def _time(time: float, what: str) -> str:
    return f"no {what[2:]}" if _seconds(time) == inf else f"{what} of {time:g} s"
