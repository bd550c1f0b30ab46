"""Topics that are read and services that are called, against what the same robot sends and serves."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from multibot_rewrite.closure.gap import Gap
from multibot_rewrite.nearest import nearest
from multibot_rewrite.record import NamedTuple
from multibot_rewrite.system.conventions import is_from_outside
from multibot_rewrite.system.records import (
    ACTION,
    CALLS,
    PUBLISHES,
    SERVES,
    SUBSCRIBES,
    TOPIC,
    Place,
)

TYPE, STATUS = "type", "/_action/status"
GIVES, NEEDS = (PUBLISHES, SERVES), (SUBSCRIBES, CALLS)


class End(NamedTuple):
    """An end of a topic, service or action in the running system.

    ``role`` is empty where it is not known which end. ``type`` may be empty. ``code_name`` is the name
    in the node's code, ``owner`` the node's name without a robot. ``sure`` is false for an end that is
    there on a condition only. ``also`` are other types that it may have. ``place`` is where a file
    names it, ``at`` where the node is declared.
    """

    node: str
    kind: str
    role: str
    name: str
    type: str
    code_name: str
    owner: str
    place: Place | None = None
    sure: bool = True
    also: tuple[str, ...] = ()
    at: Place | None = None

    @property
    def key(self) -> tuple[str, ...]:
        """The same before and after a rewrite."""
        return self.kind, self.role, self.owner, self.code_name


def topic_gaps(ends: Sequence[End], more: Iterable[End] = ()) -> Iterator[Gap]:
    """What the nodes of a robot need and nothing sends. ``more`` are ends of nodes for all robots."""
    given = [it for it in ends if it.role in GIVES]
    # What a node reads already is not what it misses.
    read = {(it.node, it.name) for it in ends if it.role in NEEDS}
    for it in _needed(ends, more, sent=False):
        near = _near(it, [other for other in given if (it.node, other.name) not in read])
        where = (near.place or near.at) if near else None
        name = near.name if near else ""
        yield Gap(it.kind, it.name, it.node, it.key, it.place, name, where, it.at)


def type_gaps(ends: Sequence[End], more: Iterable[End] = ()) -> Iterator[Gap]:
    """What is sent under the name that a node needs, and of other types alone: the two never meet."""
    given: dict[tuple[str, str], list[End]] = {}
    for it in (*ends, *more):
        if it.role not in NEEDS:
            given.setdefault((it.kind, it.name), []).append(it)
    for it in ends:
        others = given.get((it.kind, it.name), ())
        if it.role not in NEEDS or not it.sure or not it.type or not others:
            continue
        sent = {type_ for other in others for type_ in (other.type, *other.also)}
        if "" not in sent and sent.isdisjoint((it.type, *it.also)):
            first = others[0]
            what = f"{it.name} as {it.type}"
            near = f"{first.node} sends {first.type}"
            yield Gap(TYPE, what, it.node, it.key, it.place, near, first.place or first.at, it.at)


def closed(ends: Sequence[End], more: Iterable[End] = ()) -> set[tuple[str, ...]]:
    """The keys of what the nodes of a robot need and something sends."""
    return {it.key for it in _needed(ends, more, sent=True)}


def _needed(ends: Sequence[End], more: Iterable[End], sent: bool) -> Iterator[End]:
    given = {(it.kind, it.name) for it in (*ends, *more) if it.role not in NEEDS}
    # The server of an action sends its status.
    given |= {(TOPIC, f"{name}{STATUS}") for kind, name in given if kind == ACTION}
    for it in ends:
        needed = it.role in NEEDS and it.sure and not _is_from_outside(it)
        if needed and ((it.kind, it.name) in given) is sent:
            yield it


def _is_from_outside(end: End) -> bool:
    return is_from_outside(end.name) or is_from_outside(end.code_name)


def _near(end: End, given: Iterable[End]) -> End | None:
    """What may be meant: another one of the same type, with the same last word or the likest name."""
    others = (it for it in given if it.kind == end.kind and it.node != end.node)
    alike = [it for it in others if end.type and it.type == end.type]
    if end.type.startswith("std_"):
        # Many topics that have nothing to do with each other are of these types: what their names
        # in the code have in common counts, not the robot's namespace.
        words = {it.code_name.rpartition("/")[2]: it for it in alike}
        return words.get(nearest(end.code_name.rpartition("/")[2], words))
    names = {it.name: it for it in alike}
    last = [name for name in names if name.endswith("/" + end.name.rpartition("/")[2])]
    return names.get(nearest(end.name, last or names, alike=0.0))
