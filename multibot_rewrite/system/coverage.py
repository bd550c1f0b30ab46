# SPDX-License-Identifier: Apache-2.0
"""How much of what exists a system has, which every verdict reports."""

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from multibot_rewrite.base.conventions import OF_EVERY_NODE
from multibot_rewrite.base.wording import SEVERAL, plural, shorten
from multibot_rewrite.system.ownership import name_ownership
from multibot_rewrite.system.records import (
    NOT_KNOWN_PROCESS,
    NOT_READ,
    NOWHERE,
    RUNS,
    Node,
    System,
    answering,
    doubts,
)
from multibot_rewrite.system.words import is_tool

# How nodes came into the graph that a plan is compared with.
LAUNCHED, SEEN = "launched", "seen"


class Covered(NamedTuple):
    """The nodes of a robot, or with an empty name those for all robots, as counts.

    Of ``known`` ones it is known what they do, of ``partly`` many of these not all. ``seen`` are in
    the graph; ``silent`` ones of these were asked for their state and did not answer."""

    robot: str
    nodes: int
    known: int
    seen: int
    silent: int
    partly: int = 0

    @property
    def unknown(self) -> int:
        """The number of nodes of which only the name is known: they are started as they are."""
        return self.nodes - self.known


class Coverage(NamedTuple):
    """How much a system holds of each robot, and of the nodes for all robots.

    With ``told`` it says what nodes do; a graph that was only seen does not. ``compared`` is
    ``LAUNCHED`` or ``SEEN`` where a plan was compared with a graph. ``incomplete`` counts the reasons
    why something may be missing in the view, ``unread`` the parts of launch files of which the plan has
    no nodes, ``processes`` those that are no nodes: of each only the command is known.
    """

    robots: tuple[Covered, ...]
    told: bool = True
    compared: str = ""
    incomplete: int = 0
    unread: int = 0
    processes: int = 0

    @property
    def total(self) -> Covered:
        """The counts of all robots together."""
        columns = zip(*(it[1:] for it in self.robots), strict=True)
        return Covered("", *map(sum, columns)) if self.robots else Covered("", 0, 0, 0, 0)

    @property
    def is_whole(self) -> bool:
        """Return whether all is read, all nodes are known and have answered, and any was seen."""
        total, lost = self.total, self.compared and not self.total.seen
        left = total.unknown or total.partly or self.unread or self.processes
        return not (left or total.silent or lost)

    @property
    def in_words(self) -> str:
        """The coverage as ``2 robots, 15 nodes each: 12 known, 3 started as they are``."""
        robots, total = [it for it in self.robots if it.robot], self.total
        counts = sorted({it.nodes for it in robots if total.nodes})
        shared = total.nodes - sum(it.nodes for it in robots)
        head = [plural(len(robots), "robot")] if robots else []
        if any(counts):
            least = f"{counts[0]} to " if len(counts) > 1 else ""
            head.append(f"{least}{plural(counts[-1], 'node')}{' each' * (len(robots) > 1)}")
        if shared:
            head.append(f"{shared} for all" if robots else plural(shared, "node"))
        details = ", ".join(_details_in_words(self)) if total.nodes else ""
        return f"{', '.join(head)}{': ' * bool(details)}{details}"

    def as_value(self) -> Mapping[str, object]:
        """Return the coverage as JSON has it; null for what is not said."""
        rows = [{"robot": it.robot, **_row_as_value(self, it)} for it in self.robots]
        more = {"unread": self.unread, "processes": self.processes}
        total = {**_row_as_value(self, self.total), "incomplete": self.incomplete, **more}
        return {**total, "robots": rows, "text": self.in_words}


def coverage(system: System, graph: System | None = None) -> Coverage:
    """Return how much a system has of its nodes, and how much of that is in a graph."""
    told = bool(system.layout) or _is_launched(system)
    compared = "" if graph is None else LAUNCHED if _is_launched(graph) else SEEN
    ends = {it.node for it in system.ends if it.name not in OF_EVERY_NODE}
    there = {it.name for it in graph.nodes} if graph else set()
    answers = answering(graph) if graph and compared == SEEN else ()
    nodes: dict[str, list[Node]] = {it.name: [] for it in system.robots}
    owned = name_ownership(system)
    # A name that is made at run time is that of a node's helper.
    for it in {it.name: it for it in system.nodes if "*" not in it.name}.values():
        # What only may run is none that is missed.
        expected = not compared or it.sure == RUNS or it.name in there
        if expected and not is_tool(owned.without_robot(it.name, it.robot)):
            nodes.setdefault(it.robot, []).append(it)
    rows = []
    for robot, own in nodes.items():
        named = (it.known or it.node_set or it.plugin != NOWHERE or it.name in ends for it in own)
        known = sum(not told or bool(it) for it in named)
        seen = there.intersection(it.name for it in own)
        silent = len(seen.difference(answers)) if answers else 0
        partly = sum(bool(it.untold) for it in own)
        rows.append(Covered(robot, len(own), known, len(seen), silent, partly))
    unread = sum(it.code == NOT_READ for it in system.gaps)
    processes = sum(it.code == NOT_KNOWN_PROCESS for it in system.gaps)
    more = len(doubts(graph or system)), unread, processes
    return Coverage(tuple(rows), told, compared, *more)


def _is_launched(system: System) -> bool:
    """Return whether the system was read from a launch file."""
    return not system.layout and any(it.place != NOWHERE for it in system.nodes)


def _details_in_words(held: Coverage) -> Iterator[str]:
    """Yield how many nodes are known, seen and silent, in words."""
    total = held.total
    if held.told and not total.unknown:
        yield "all known" + f" ({total.partly} in part)" * bool(total.partly)
    elif held.told:
        alike = len({it[1:3] for it in held.robots}) == 1
        shown = held.robots[0] if alike else total
        whose = (f"{it.robot or 'for all'} {it.unknown}" for it in held.robots if it.unknown)
        where = "" if alike else f" ({shorten(whose, SEVERAL)})"
        verb = "it is" if shown.unknown == 1 else "they are"
        known = f"{shown.known} known" + f" ({shown.partly} in part)" * bool(shown.partly)
        yield f"{known}, {shown.unknown} started as {verb}{where}"
    if held.compared:
        count = "all" if total.seen == total.nodes else f"{total.seen} of {total.nodes}"
        yield f"{count} {held.compared}"
    if total.silent:
        yield f"{total.silent} silent"
    if held.processes:
        verb = "it is" if held.processes == 1 else "they are"
        yield f"{plural(held.processes, 'other process')} started as {verb}"
    if held.unread:
        yield f"{plural(held.unread, 'part')} of launch files not read"


def _row_as_value(held: Coverage, row: Covered) -> Mapping[str, object]:
    told, compared, asked = held.told, bool(held.compared), held.compared == SEEN
    return {
        "nodes": row.nodes,
        "known": row.known if told else None,
        "in_part": row.partly if told else None,
        "as_they_are": row.unknown if told else None,
        "seen": row.seen if compared else None,
        "silent": row.silent if asked else None,
    }
