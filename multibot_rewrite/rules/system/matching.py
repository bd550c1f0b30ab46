# SPDX-License-Identifier: Apache-2.0
"""Dangers of connections: both sides of a name are there and do not connect, by type or QoS."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence, Set
from functools import lru_cache
from math import inf
from typing import NamedTuple

from multibot_rewrite.base.conventions import EVERYBODYS, STAMP_SWITCHES, switch
from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, Finding, Setting
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.rules.declaration import last_place, see_all, system_rule
from multibot_rewrite.rules.system.causes import Cause, caused, plugin_of, to_set
from multibot_rewrite.system import words
from multibot_rewrite.system.index import TF, Ends, Index, at_work, nodes_of, once
from multibot_rewrite.system.records import SUBSCRIBES, TOPIC, ZENOH, End, Qos
from multibot_rewrite.system.words import DESCRIPTION, JOINTS, MAP, is_viewer, last_word

# The words of each policy, the weakest first; any other word does not say what is in force.
RELIABILITY = ("BEST_EFFORT", "RELIABLE")
DURABILITY = ("VOLATILE", "TRANSIENT_LOCAL")
LIVELINESS = ("AUTOMATIC", "MANUAL_BY_NODE", "MANUAL_BY_TOPIC")
# A valid type hash starts with the version of the hash.
HASH = "RIHS"
STAMPED = "Stamped"


@system_rule("MG306", "types-differ", ERROR, all_ends=True)
def types_differ(seen: Index) -> Iterator[Finding]:
    """Report ends of one topic with other types, unless one of the node's ends connects."""
    by_plan = planned_types(seen)
    for ends in seen.by_name.values():
        every = (*ends.publishers, *ends.subscribers, *ends.servers, *ends.clients)
        planned = by_plan.get((ends.kind, ends.name), frozenset())
        types = {(end.type, end.type_hash) for end in every}
        if len(types) == 1 and (not planned or every[0].type in planned):
            continue
        if planned and not planned >= {it for it, _ in types}:
            asked = (it for it in every if it.role != SUBSCRIBES or not seen.is_tool(it.node))
            if apart := _unconnected(asked, {(it, "") for it in planned}):
                yield from (
                    _planned_type_finding(seen, ends, own, planned) for own in apart.values()
                )
                continue
        givers, takers = ends[3:5] if ends.kind == TOPIC else ends[5:7]
        if len(types) < 2:
            continue
        # Of a side alone the first one counts.
        others = givers if takers else givers[:1]
        apart = _unconnected(takers or givers, _all_types(others))
        if takers and not apart:
            # Every reader hears somebody; a sender may be heard by nobody.
            others, apart = takers, _unconnected(givers, _all_types(takers))
        yield from (_type_finding(seen, ends, own, others) for own in apart.values())


@once
def planned_types(seen: Index) -> Mapping[tuple[str, str], Set[str]]:
    """Return the planned types of each name, where they are known."""
    found: dict[tuple[str, str], set[str]] = defaultdict(set)
    for end in seen.expected.by_key.values() if seen.expected else ():
        found[end.kind, end.name].update({*end.also, end.type} - {""})
    return found


def _type_finding(seen: Index, ends: Ends, own: Sequence[End], others: Sequence[End]) -> Finding:
    asked, given = dict(_all_types(own)), dict(_all_types(others))
    message, cause = _difference(ends.name, others[0].node, asked, given)
    stamped = _by_a_switch(asked.keys(), given.keys())
    both, node = (*others, *own), own[0].node
    other = _bare(seen).get((ends.kind, seen.plain(ends.name))) if stamped else None
    usual = f": one is stamped, and {other.name} is {other.type}" if other else ""
    switched = Cause(usual) if usual or not stamped else to_stamp(seen, both)
    level = WARNING if is_viewer(node) else ERROR
    if stale := _stale(seen, both):
        level, cause = NOTE, f"{cause}; {stale}: its type may be another one now"
    robot = seen.robot(node) or seen.robot(ends.name)
    return types_differ.finding(
        message, f"{cause}{switched.hint}{see_all(both)}", settings=switched.settings,
        level=level, robot=robot, node=node, names=(ends.name,), **last_place(both),
    )  # fmt: skip


@once
def _bare(seen: Index) -> Mapping[tuple[str, str], Ends]:
    """Return the robots' topics on which all is of one type without a stamp, by kind and plain name."""
    likes = (it for it in seen.topics if seen.robot(it.name) and it.publishers and it.subscribers)
    return {
        (it.kind, seen.plain(it.name)): it
        for it in likes
        if {x.type for x in (*it.publishers, *it.subscribers)} == {it.type.removesuffix(STAMPED)}
    }


def _stale(seen: Index, ends: Iterable[End]) -> str:
    """Return a note that an end's type is known of an earlier version of its node only; or ""."""
    from multibot_rewrite.knowledge.node_sets import older_node  # a fault alone needs it

    known = ((seen.node[it.node].known, it.type) for it in ends if it.node in seen.node)
    return next(filter(None, (older_node(it, seen.system.release, own) for it, own in known)), "")


def to_stamp(seen: Index, ends: Iterable[End]) -> Cause:
    """Return the parameters that stamp all velocities of a robot's Nav2; an empty cause for none."""
    bare = [it.node for it in ends if it.type and not it.type.endswith(STAMPED)]
    if not bare or not all(switch(STAMP_SWITCHES, it) for it in bare):
        return Cause("")
    mine = (it for it in seen.nodes if seen.robot(it) == seen.robot(bare[0]))
    nodes = [it for it in mine if switch(STAMP_SWITCHES, it)]
    cause = to_set(switch(STAMP_SWITCHES, bare[0]), "true", *nodes)
    return cause._replace(hint=f": {cause.hint} (from Jazzy on)")


def _planned_type_finding(
    seen: Index, ends: Ends, own: Sequence[End], planned: Set[str]
) -> Finding:
    node = own[0].node
    message, _ = _difference(
        ends.name, "the plan", dict(_all_types(own)), dict.fromkeys(planned, "")
    )
    plugin, place = plugin_of(seen.expected, node)
    which = f"another version or setting of {plugin or 'the node'}"
    switched = Cause("")
    if _by_a_switch({it for it, _ in _all_types(own)}, planned):
        switched = to_stamp(seen, own)
        which = f"velocities are stamped on one side{switched.hint}"
    at = f", see {place}" if place else ""
    cause = caused(f"{which}{at}? If this type is right, correct the plan", place)
    return types_differ.finding(
        message, **cause._replace(settings=switched.settings)._asdict(),
        robot=seen.robot(node) or seen.robot(ends.name),
        node=node if node in seen.nodes else "", names=(ends.name,),
    )  # fmt: skip


def _all_types(ends: Iterable[End]) -> set[tuple[str, str]]:
    """Return the types of some ends; empty if one of them is unknown."""
    known = [*ends]
    return {it for end in known for it in _types(end)} if all(end.type for end in known) else set()


def _unconnected(ends: Iterable[End], given: set[tuple[str, str]]) -> Mapping[str, Sequence[End]]:
    """Return by node the ends that connect with none of the types, if all its types are known."""
    by_node = lists_by_key((end.node, end) for end in (ends if given else ()))
    # Both sides have a version of a type; one without a hash may be any.
    return {
        node: own
        for node, own in by_node.items()
        if all(end.type for end in own)
        and not any(
            one == other and (hash_ == its or not (hash_ and its))
            for end in own
            for one, hash_ in _types(end)
            for other, its in given
        )
    }


def _types(end: End) -> Iterator[tuple[str, str]]:
    """Yield the type of an end with its hash, if that is valid, and the other possible types."""
    if end.type:
        yield end.type, end.type_hash if end.type_hash.startswith(HASH) else ""
    yield from ((it, "") for it in end.also)


def _difference(
    name: str, giver: str, asked: Mapping[str, str], given: Mapping[str, str]
) -> tuple[str, str]:
    """Return (how two sides' types, each with one hash, differ, what to do)."""
    wanted, there = (", ".join(sorted(it)) for it in (asked, given))
    if asked.keys() & given.keys():
        return (
            f"uses another version of {wanted} on {name} than {giver}",
            "their packages of messages were built from different versions: build both from one",
        )
    cause = "no message ever arrives; use the same type on both sides"
    return f"uses {name} as {wanted}, but {giver} has it as {there}", cause


def _by_a_switch(some: Set[str], others: Set[str]) -> bool:
    """Return whether one side is stamped and the other not."""
    return any({f"{it}{STAMPED}" for it in a} & b for a, b in ((some, others), (others, some)))


@system_rule("MG307", "qos-incompatible", ERROR)
def qos_never_meets(seen: Index) -> Iterator[Finding]:
    """Report each subscription and what it lacks; if several lack it of one publisher, that one.

    Zenoh connects any two (rmw_zenoh design.md)."""
    for (kind, name), ends in seen.by_name.items() if seen.system.environment.rmw != ZENOH else ():
        if kind != TOPIC or name in EVERYBODYS or not _refuses(ends):
            continue
        found: dict[tuple[object, ...], list[_Refused]] = defaultdict(list)
        for end in {(it.node, it.qos): it for it in ends.subscribers}.values():
            refused: dict[tuple[tuple[str, str], ...], list[End]] = defaultdict(list)
            for it in ends.publishers:
                if it.qos and end.qos and (conflicts := qos_conflicts(it.qos, end.qos)):
                    refused[conflicts].append(it)
            hears = sum(map(len, refused.values())) < len(ends.publishers)
            # One that lacks some of the transforms shows nothing where they are needed.
            if not (hears and is_viewer(end.node)) or end.type == TF:
                for conflicts, publishers in refused.items():
                    one = _Refused(end, nodes_of(publishers), conflicts, hears)
                    found[one[1:]].append(one)
        yield from (_qos_finding(seen, *them) for them in found.values())


def _refuses(ends: Ends) -> bool:
    """Return whether an offered QoS conflicts with a requested one."""
    offered = {it.qos for it in ends.publishers if it.qos}
    asked = {it.qos for it in ends.subscribers if it.qos} if offered else ()
    return any(qos_conflicts(one, other) for one in offered for other in asked)


class _Refused(NamedTuple):
    """A subscription, the nodes whose messages it never gets, and why; ``hears``: it gets others."""

    end: End
    senders: tuple[str, ...]
    conflicts: tuple[tuple[str, str], ...]
    hears: bool


def _qos_finding(seen: Index, first: _Refused, *more: _Refused) -> Finding:
    end, nodes, conflicts, hears = first
    offered = " and ".join(offer for offer, _ in conflicts)
    asked = " and ".join(request for _, request in conflicts)
    senders, readers = shorten(nodes), nodes_of(it.end for it in (first, *more))
    at_sender = len(readers) > 1 or last_word(end.name) == "tf_static"
    message = f"subscribes to {end.name} with {asked}, but {senders} offers {offered}"
    never = f"no message of {senders} ever arrives" if hears else "no message ever arrives"
    cause = f"{never}: let it ask for {offered}, or the publisher offer {asked}"
    if at_sender:
        ask = f"{shorten(readers)} ask{'s' * (len(readers) == 1)} for {asked}"
        message = f"offers {end.name} with {offered}, but {ask}"
        cause = f"{never}: let {senders} offer {asked}"
    level = WARNING if all(map(is_viewer, readers)) or (hears and end.type != TF) else ERROR
    robot = seen.robot(end.node) or seen.robot(end.name)
    node = nodes[0] if at_sender else end.node
    return qos_never_meets.finding(
        message, cause, level=level, robot=robot, node=node, names=(end.name,)
    )


@system_rule("MG309", "not-latched", ERROR)
def not_latched(seen: Index) -> Iterator[Finding]:
    """Report latched topics with a volatile sender or reader, or with another QoS than planned."""
    topics = seen.expected.system.topics if seen.expected else ()
    planned = {it.name: it.qos for it in topics if it.qos}
    for name, qos in planned.items():
        yield from _offered_otherwise(seen, name, qos)
    for ends in seen.by_name.values() if seen.system.environment.rmw != ZENOH else ():
        if ends.kind != TOPIC or ends.name in planned or not _is_latched(ends):
            continue
        yield from _misses_what_was_sent(seen, ends)
        if _with_durability(ends.subscribers, DURABILITY[1]):
            continue
        for node in nodes_of(_with_durability(ends.publishers, DURABILITY[0])):
            yield not_latched.finding(
                f"publishes {ends.name} with durability VOLATILE: who starts later never gets it",
                robot=seen.robot(ends.name) or seen.robot(node), node=node, names=(ends.name,),
                **_set_qos(node, ends.name, PUBLISHER, ("durability", DURABILITY[1]))._asdict(),
            )  # fmt: skip


def _offered_otherwise(seen: Index, name: str, qos: Iterable[tuple[str, str]]) -> Iterator[Finding]:
    """Report other QoS than planned, where known; a policy of unknown value counts as planned."""
    for end in seen.ends_at(TOPIC, name).publishers:
        offered = [(policy, word, getattr(end.qos, policy)) for policy, word in qos if end.qos]
        known = (it for it in offered if it[2] not in (it[1], "UNKNOWN", "SYSTEM_DEFAULT"))
        if different := [*known]:
            listed = ", ".join(f"{one} {it}, the plan has {word}" for one, word, it in different)
            yield not_latched.finding(
                f"{name} is published with {listed}",
                robot=seen.robot(name) or seen.robot(end.node), node=end.node, names=(name,),
                **_set_qos(end.node, name, PUBLISHER, *(it[:2] for it in different))._asdict(),
            )  # fmt: skip


PUBLISHER, SUBSCRIPTION = "publisher", "subscription"


def _set_qos(node: str, name: str, side: str, *policies: tuple[str, str]) -> Cause:
    """Return the parameters of a node that give its end of a topic these policies."""
    start = f"qos_overrides.{name}.{side}"
    settings = tuple(Setting(node, f"{start}.{one}", word.lower()) for one, word in policies)
    said = ", ".join(f"{it.name}: {it.value}" for it in settings)
    return Cause(f"set {said} in the parameters of {node}", settings=settings)


def _with_durability(ends: Iterable[End], word: str) -> list[End]:
    return [it for it in ends if it.qos and it.qos.durability == word]


def _misses_what_was_sent(seen: Index, ends: Ends) -> Iterator[Finding]:
    """Report who misses what is sent once; whoever makes a map of scans sends it again and again."""
    latched = nodes_of(_with_durability(ends.publishers, DURABILITY[1]))
    read = [it for node in latched for it in seen.by_node.get(node, ()) if it.role == SUBSCRIBES]
    again = {it.node for it in read if it.type != JOINTS and words.is_of_a_body(it.type)}
    once = [it for it in latched if it not in again]
    volatile = _with_durability(ends.subscribers, DURABILITY[0])
    seeing = [it for it in volatile if is_viewer(it.node) and not words.is_hidden(it.node)]
    own = (at_work(volatile), WARNING), (seeing if ends.type != TF else [], NOTE)
    for found, level in own if once and len(once) == len(ends.publishers) else ():
        if not found:
            continue
        readers = nodes_of(found)
        verb = "reads" if len(readers) == 1 else "read"
        yield not_latched.finding(
            f"{shorten(readers)} {verb} {ends.name} with durability VOLATILE, and {once[0]} sends it"
            " once: who starts later never gets it", level=level,
            robot=seen.robot(ends.name) or seen.robot(readers[0]),
            node=readers[0], names=(ends.name,), **_ask_latched(readers, ends.name)._asdict(),
        )  # fmt: skip


def _ask_latched(nodes: Sequence[str], name: str) -> Cause:
    """Return the parameter by which a costmap asks for what is sent once, else that of the QoS."""
    if is_viewer(nodes[0]):
        return Cause("set Durability Policy to Transient Local in its display")
    if all(last_word(it).endswith("costmap") for it in nodes):
        return to_set("static_layer.map_subscribe_transient_local", "true", *nodes)
    causes = [_set_qos(it, name, SUBSCRIPTION, ("durability", DURABILITY[1])) for it in nodes]
    hint = causes[0].hint.replace(nodes[0], shorten(nodes))
    return Cause(hint, settings=tuple(one for it in causes for one in it.settings))


def _is_latched(ends: Ends) -> bool:
    """Return whether a topic is latched, by type or by name: a map, a description, static tf."""
    words_ = ends.name.split("/")[-2:]
    return (ends.type == MAP and "map" in words_) or bool({*words_} & {DESCRIPTION, "tf_static"})


@lru_cache(maxsize=1024)
def qos_conflicts(offered: Qos, requested: Qos) -> tuple[tuple[str, str], ...]:
    """Return where two QoS do not connect by the rules of DDS, as (offered, requested) texts."""
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
        *(
            (_time_text(o, what), _time_text(r, what))
            for o, r, what in times
            if _seconds(o) > _seconds(r)
        ),
    )


def qos_words(end: End) -> list[str]:
    """Return the policies of an end's QoS that are not the usual ones; empty for an unknown QoS."""
    own = end.qos._asdict() if end.qos else {}
    policies = ("reliability", "durability", "deadline", "liveliness")
    told = (str(own.get(it, "")) for it in policies)
    return [it for it in told if it not in ("", "inf", "AUTOMATIC")]


def _is_weaker(offered: str, requested: str, order: Sequence[str]) -> bool:
    known = offered in order and requested in order
    return known and order.index(offered) < order.index(requested)


def _seconds(time: float) -> float:
    """Return a time in seconds; rmw writes no limit as 0."""
    return time if time > 0 else inf


def _time_text(time: float, what: str) -> str:
    return f"no {what[2:]}" if _seconds(time) == inf else f"{what} of {time:g} s"
