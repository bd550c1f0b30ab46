# SPDX-License-Identifier: Apache-2.0
"""Dangers of what is not there: an end whose node's code or parameters name it, and nothing sends."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence, Set

from multibot_rewrite.base.findings.finding import ERROR, NOTE, Finding
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.rules.declaration import system_rule, where
from multibot_rewrite.rules.system.instead import is_needed, meant
from multibot_rewrite.rules.system.likes import nodes_of_each
from multibot_rewrite.rules.system.names import server_names_miss, topic_names_miss
from multibot_rewrite.system.index import Index, ends_of, once
from multibot_rewrite.system.records import ACTION, PUBLISHES, SERVES, TOPIC, End

# The server of an action sends its status.
_STATUS = "/_action/status"
_LISTED = 8
_GIVES = (PUBLISHES, SERVES)
_MISSES = (topic_names_miss, server_names_miss)


@system_rule("MG316", "nothing-known-sends", NOTE, absence=True)
def nothing_known_sends(seen: Index) -> Iterator[Finding]:
    """All names of a robot are one finding; without those that others have under another name."""
    left = [it for it in open_ends(seen) if not meant(seen, it)]
    left = _without_missed(seen, left) if left else left
    by_robot: dict[str, set[str]] = defaultdict(set)
    for it in left:
        by_robot[seen.robot(it.node)].add(it.name)
    for robot, names in by_robot.items():
        yield from _told(seen, robot, sorted(names))


def _told(seen: Index, robot: str, names: Sequence[str]) -> Iterator[Finding]:
    """That another robot has it from a node of the same system is not for a driver outside of it."""
    elsewhere: dict[str, str] = {}
    for plain in map(seen.plain, names) if robot else ():
        given = (it for it in _given(seen).get(plain, ()) if _of_its_kind(seen, it, robot))
        if other := next(given, ""):
            elsewhere[plain] = other
    lacked = tuple(it for it in names if seen.plain(it) in elsewhere)
    rest = tuple(it for it in names if it not in lacked)
    if lacked:
        others = shorten([elsewhere[seen.plain(it)] for it in lacked], _LISTED)
        message = f"no node sends {shorten(lacked, _LISTED)}, and one sends {others}"
        hint = "start what sends it for the other robot"
        yield nothing_known_sends.finding(
            message, hint, level=ERROR, robot=robot, names=tuple(lacked)
        )
    if rest:
        hint = "name a stack or nodes that do, if no driver of its own does"
        message = f"no known node sends {shorten(rest, _LISTED)}"
        yield nothing_known_sends.finding(message, hint, robot=robot, names=tuple(rest))


def _of_its_kind(seen: Index, name: str, robot: str) -> bool:
    """Is a name of another robot that runs nothing which the robot has not, but for its sender, and of
    which the nodes that both have send the same frames?"""
    other, nodes = seen.robot(name), nodes_of_each(seen)
    theirs, own = _frames(seen).get(other, {}), _frames(seen).get(robot, {})
    both = theirs.keys() & own.keys()
    senders = {seen.plain(it.node) for it in ends_of(seen, name) if it.role in _GIVES}
    more = nodes.get(other, {}).keys() - nodes.get(robot, {}).keys()
    is_alike = more <= senders and all(theirs[it] == own[it] for it in both)
    return other not in ("", robot) and is_alike


@once
def _frames(seen: Index) -> Mapping[str, Mapping[str, Set[str]]]:
    """The frames that each node of each robot sends, without the robot's name."""
    found: dict[str, dict[str, set[str]]] = defaultdict(lambda: defaultdict(set))
    for it in seen.sent:
        found[seen.robot(it.node)][seen.plain(it.node)].add(seen.plain_frame(it.child))
    return found


@once
def _given(seen: Index) -> Mapping[str, Sequence[str]]:
    """What is sent or served by its name without a robot's, the last one first."""
    found: dict[str, list[str]] = defaultdict(list)
    for (_, name), ends in reversed([*seen.by_name.items()]):
        if ends.publishers or ends.servers:
            found[seen.plain(name)].append(name)
    return found


def _without_missed(seen: Index, ends: Iterable[End]) -> list[End]:
    """The ends without those that are a finding with the other side's name."""
    missed = {it.names[0] for rule in _MISSES if rule.check for it in rule.check(seen)}
    return [it for it in ends if it.name not in missed]


def no_longer_sent(end: End) -> Finding:
    """The finding about one end that nothing sends any more."""
    does, gives = ("subscribes to", "publishes") if end.kind == TOPIC else ("calls", "serves")
    message = f"{does} {end.name}, which no node {gives} any more"
    return nothing_known_sends.finding(
        message, level=ERROR, node=end.node, names=(end.name,), **where([end])
    )


def open_ends(seen: Index) -> list[End]:
    """What nodes surely need by their code, and nothing gives."""
    return [
        end
        for (kind, name), ends in seen.by_name.items()
        if not (ends.publishers or ends.servers) and not _is_status(seen, kind, name)
        for end in (*ends.subscribers, *ends.clients)
        if is_needed(end)
    ]


def _is_status(seen: Index, kind: str, name: str) -> bool:
    served = seen.by_name.get((ACTION, name.removesuffix(_STATUS)))
    return kind == TOPIC and name.endswith(_STATUS) and served is not None and bool(served.servers)
