# SPDX-License-Identifier: Apache-2.0
"""A system compared with an earlier snapshot: ends, transforms, frames of messages, parameters."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

from multibot_rewrite.base.conventions import (
    CLOCK,
    EVERYBODYS,
    OF_EVERY_NODE,
    chooses,
    is_from_outside,
)
from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.grouping import lists_by_key, sets_by_key
from multibot_rewrite.base.wording import only, shorten
from multibot_rewrite.rules.declaration import planned_rule
from multibot_rewrite.rules.system.causes import DOES
from multibot_rewrite.rules.system.matching import qos_words
from multibot_rewrite.rules.system.names import server_names_miss
from multibot_rewrite.rules.system.planned_nodes import missing_node, missing_robot, unplanned_node
from multibot_rewrite.system import words
from multibot_rewrite.system.index import TF, Index, at_work
from multibot_rewrite.system.records import (
    ACTION,
    CALLS,
    PUBLISHES,
    SERVES,
    SIM_TIME,
    Edge,
    End,
    System,
)

# In metres and parts of a quaternion.
_SAME = 1e-3
_MEANT = "is it meant? Then take a new snapshot"


# Parent, child and topic.
_Place = tuple[str, str, str]


class _Change(NamedTuple):
    """What differs at a node, or a topic of messages, with the names that it is about."""

    node: str
    what: str
    names: tuple[str, ...]
    level: str = WARNING
    topic: str = ""


@planned_rule("MG130", "changed-since", WARNING, absence=True)
def changed_since(plan: Index, seen: Index) -> Iterator[Finding]:
    """Report each change; what another finding is about is left to that one (``untold``)."""
    before = seen.known.before
    for it in _changes(before, seen) if before else ():
        names = it.node, *it.names, it.topic
        robot = next(filter(None, map(seen.robot, names)), "")
        yield changed_since.finding(
            it.what, _MEANT, level=it.level, robot=robot, node=it.node, names=it.names
        )


def untold(found: Iterable[Finding]) -> list[Finding]:
    """Return the findings without changes that others explain, at the level of errors about them."""
    every = [*found]
    errors = {
        name
        for it in every
        if it.code == changed_since.code and it.level == ERROR
        for name in it.names
    }
    every = [
        it._replace(level=ERROR) if it.level == WARNING and errors & {*it.names} else it
        for it in every
    ]
    # Who gave it says more than who lacks it, unless there is a remedy.
    every = [it for it in every if it.code != server_names_miss.code or not errors >= {*it.names}]
    others = [it for it in every if it.code != changed_since.code]
    names = {name for it in others for name in it.names}
    came = (missing_node.code, unplanned_node.code)
    nodes = {it.node for it in others if it.code in came}
    robots = {it.robot for it in others if it.code == missing_robot.code}
    return [
        it
        for it in every
        if it.code != changed_since.code
        or (
            not (names & {*it.names} or it.robot in robots)
            and (it.level == ERROR or it.node not in nodes)
        )
    ]


def _changes(before: System, seen: Index) -> Iterator[_Change]:
    old, new = _by_key(before.ends), _by_key(seen.system.ends)
    nodes = {it.name for it in before.nodes}
    for key, end in new.items():
        tool, did_not = seen.is_tool(end.node), f"{DOES[end.role]} {end.name}, and did not"
        if key in old:
            was, now = (" ".join((it.type, *qos_words(it))) for it in (old[key], end))
            if was != now and not tool:
                what = f"{DOES[end.role]} {end.name} as {now}, and did as {was}"
                yield _Change(end.node, what, (end.name,))
        elif heeded := _obeyed_by(seen, end):
            yield _Change(end.node, f"{did_not}; {heeded}", (end.name,), ERROR)
        elif end.role == PUBLISHES and (user := _user(seen, end)):
            yield _Change(end.node, f"{did_not}; {user} reads it", (end.name,))
        elif end.node in nodes and not tool:
            yield _Change(end.node, did_not, (end.name,))
    # What the robots' own nodes gave is in the plan that is made of the earlier snapshot.
    lost = (it for it in old.values() if seen.is_tool(it.node))
    missed = ((it.node, (it.name, user)) for it in lost if (user := _lost_by(seen, it)))
    for node, pairs in lists_by_key(missed).items():
        names = tuple(dict(pairs))
        what = f"no longer gives {shorten(names)}, which {pairs[0][1]} uses"
        yield _Change(node, what, names, ERROR)
    yield from _changed_transforms(before, seen)
    yield from _changed_frames(before, seen)
    yield from _changed_parameters(before, seen)


def _by_key(ends: Iterable[End]) -> Mapping[tuple[str, str, str, str], End]:
    """Return the ends by key, without those of every node, of tf and hidden ones."""
    return {
        (it.node, it.kind, it.role, it.name): it
        for it in ends
        if it.name not in OF_EVERY_NODE
        and "/_" not in it.name
        and it.type != TF
        and not it.type.startswith(words.OF_EVERY_NODE)
    }


def _obeyed_by(seen: Index, end: End) -> str:
    """Return who obeys a new sender, or takes its data for those of another; empty for nobody."""
    ends = seen.ends_at(end.kind, end.name)
    readers, others = (
        [it.node for it in at_work(own) if it.node != end.node]
        for own in ((*ends.subscribers, *ends.servers), ends.publishers)
    )
    if end.role not in (PUBLISHES, CALLS) or not readers:
        return ""
    if end.kind == ACTION or end.name in seen.orders:
        return f"{readers[0]} obeys it"
    twice = others and words.kind_of_data(end.name, end.type)
    return f"{readers[0]} reads it, and {others[0]} sends it as well" if twice else ""


def _lost_by(seen: Index, end: End) -> str:
    """Return who still uses what a tool gave, such as a bridge, and nothing gives now; or ""."""
    ends = seen.ends_at(end.kind, end.name)
    by_hand = is_from_outside(end.name) or end.name in {*seen.orders, *EVERYBODYS}
    return "" if by_hand or ends.publishers or ends.servers else _user(seen, end)


def _user(seen: Index, end: End) -> str:
    """Return a node that uses what an end gives, no tool and none that chooses; empty for none."""
    ends = seen.ends_at(end.kind, end.name)
    given = {PUBLISHES: ends.subscribers, SERVES: ends.clients}.get(end.role, ())
    nodes = (it.node for it in at_work(given))
    return next((it for it in nodes if not (seen.is_tool(it) or chooses(it))), "")


def _sender(seen: Index, edge: Edge) -> str:
    """Return the transform's sender: the robot's node on its topic, or the only one; else ""."""
    robot = seen.frame_robot(edge.child) or seen.robot(edge.topic)
    own = [it for it in edge.publishers if seen.robot(it) == robot]
    return only(own) or only(edge.publishers)


def _changed_transforms(before: System, seen: Index) -> Iterator[_Change]:
    """Yield changed transforms, if tf was read both times; not those of a node that is gone."""
    old, new = _edges_by_place(before.edges), _edges_by_place(seen.system.edges)
    if not (old and new):
        return
    above = {(child, topic): parent for parent, child, topic in new}
    gone: dict[tuple[str, str, str], list[_Place]] = defaultdict(list)
    for place, edge in old.items():
        parent, child, topic = place
        if place not in new and {*edge.publishers} <= {*seen.nodes}:
            level = ERROR if edge.static else WARNING
            gone[_sender(seen, edge), topic, level].append(place)
        elif place in new and _is_moved(edge, new[place]):
            sent = f"the transform {parent} -> {child} on {topic}"
            yield _Change("", f"{sent} is elsewhere than it was", (child,), topic=topic)
    for (node, topic, level), places in gone.items():
        pairs = shorten([f"{parent} -> {child}" for parent, child, _ in places])
        moved = [f"{it[1]} is below {above[it[1:]]}" for it in places if it[1:] in above]
        what = f"the transform {pairs} on {topic} is gone"
        if len(places) > 1:
            what = f"the transforms {pairs} on {topic} are gone"
        what += f": {shorten(moved)}" if moved else ""
        yield _Change(node, what, tuple(child for _, child, _ in places), level, topic)
    known = {(child, topic) for _, child, topic in old}
    fresh = (it for it in new if it not in old and it[1:] not in known)
    for topic, places in lists_by_key((it[2], it) for it in fresh).items():
        listed = shorten(f"{parent} -> {child}" for parent, child, _ in places)
        senders = [it for place in places for it in new[place].publishers]
        yield _Change(
            senders[0] if len({*senders}) == 1 else "",
            f"{listed} on {topic} was not there",
            tuple(child for _, child, _ in places),
            topic=topic,
        )


def _edges_by_place(edges: Iterable[Edge]) -> Mapping[_Place, Edge]:
    return {
        (it.parent.removeprefix("/"), it.child.removeprefix("/"), it.topic): it
        for it in edges
        if "/_" not in it.topic
    }


def _is_moved(old: Edge, new: Edge) -> bool:
    fixed = old.static and new.static and old.transform and new.transform
    both = zip(old.transform, new.transform, strict=True) if fixed else ()
    return any(abs(it - was) > _SAME for was, it in both)


def _changed_frames(before: System, seen: Index) -> Iterator[_Change]:
    """Yield changes of what messages name, for topics with messages both times."""
    old, new = (sets_by_key(_names_in_messages(it)) for it in (before, seen.system))
    for topic, names in new.items():
        if topic in old and names != old[topic]:
            both = (old[topic] - names, names - old[topic])
            was, now = (shorten(sorted(it)) or "nothing else" for it in both)
            yield _Change("", f"messages on {topic} are of {now}, and were of {was}", (topic,))


def _names_in_messages(system: System) -> Iterator[tuple[str, str]]:
    """Yield (topic, frames and joints that its messages name); descriptions, too."""
    for it in system.heard:
        yield it.topic, " -> ".join(filter(None, (it.frame, it.child))) or shorten(it.joints)
    yield from ((it.topic, name) for it in system.descriptions for name in (*it.links, *it.joints))


def _changed_parameters(before: System, seen: Index) -> Iterator[_Change]:
    was = {(it.node, it.name): it.value for it in before.parameters}
    changed: dict[str, list[str]] = defaultdict(list)
    for it in seen.system.parameters:
        old = was.get((it.node, it.name), it.value)
        if old != it.value and not seen.is_tool(it.node):
            changed[it.node].append(f"{it.name} is {it.value}, and was {old}")
    for node, own in changed.items():
        timed = any(it.startswith(f"{SIM_TIME} ") for it in own)
        yield _Change(node, shorten(own), (CLOCK,) * timed)
