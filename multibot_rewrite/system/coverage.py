# SPDX-License-Identifier: Apache-2.0
"""How much of what is there a system holds: what every verdict says beside it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from multibot_rewrite.base.conventions import OF_EVERY_NODE
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.base.wording import SEVERAL, plural, shorten
from multibot_rewrite.system.records import NOWHERE, Node, System, answering, doubts
from multibot_rewrite.system.tool_nodes import is_tool

# How nodes came into the graph that a plan is compared with.
LAUNCHED, SEEN = "launched", "seen"


class Covered(NamedTuple):
    """The nodes of a robot (or those for all robots, with an empty name): how many there are, of how
    many it is ``known`` what they do, how many are in the graph (``seen``), and how many of these
    were ``silent``: asked for their state, and no answer came."""

    robot: str
    nodes: int
    known: int
    seen: int
    silent: int

    @property
    def unknown(self) -> int:
        """The number of nodes of which only the name is known: they are started as they are."""
        return self.nodes - self.known


class Coverage(NamedTuple):
    """How much a system holds of each robot, and of the nodes for all robots.

    With ``told`` it says what nodes do; a graph that was only seen does not. ``compared`` is
    ``LAUNCHED`` or ``SEEN`` where a plan was compared with a graph. ``incomplete`` counts the reasons
    why something may be missing in the view.
    """

    robots: tuple[Covered, ...]
    told: bool = True
    compared: str = ""
    incomplete: int = 0

    @property
    def total(self) -> Covered:
        """The sums over all robots."""
        columns = zip(*(row[1:] for row in (*self.robots, _NOTHING)), strict=True)
        return Covered("", *map(sum, columns))

    @property
    def is_whole(self) -> bool:
        """Are all nodes known, did all answer that were asked, and was any of them seen?"""
        total = self.total
        unseen = self.compared and total.nodes and not total.seen
        return not (total.unknown or total.silent or unseen)


_NOTHING = Covered("", 0, 0, 0, 0)


def coverage(system: System, graph: System | None = None) -> Coverage:
    """Return how much a system holds, and how much of it is in a graph that it is compared with."""
    told = bool(system.layout) or _is_launched(system)
    ends = {it.node for it in system.ends if it.name not in OF_EVERY_NODE}
    compared = "" if graph is None else LAUNCHED if _is_launched(graph) else SEEN
    there = {it.name for it in graph.nodes} if graph else set()
    answers = answering(graph) if graph and compared == SEEN else ()
    nodes: dict[str, list[Node]] = {it.name: [] for it in system.robots}
    for node in {it.name: it for it in system.nodes if _is_counted(it)}.values():
        nodes.setdefault(node.robot, []).append(node)
    rows = []
    for robot, own in nodes.items():
        known = sum(not told or _is_known(it) or it.name in ends for it in own)
        seen = there.intersection(it.name for it in own)
        silent = len(seen.difference(answers)) if answers else 0
        rows.append(Covered(robot, len(own), known, len(seen), silent))
    view = system if graph is None else graph
    return Coverage(tuple(rows), told, compared, len(doubts(view)))


def _is_counted(node: Node) -> bool:
    """Is it a node of the robots, with a name that is known before it runs?"""
    return "*" not in node.name and not is_tool(node.name)


def _is_known(node: Node) -> bool:
    return bool(node.known or node.stack or node.plugin != NOWHERE)


def _is_launched(system: System) -> bool:
    """Was the system read from a launch file?"""
    return not system.layout and any(it.place != NOWHERE for it in system.nodes)


def in_words(held: Coverage) -> str:
    """Return the coverage as ``2 robots, 15 nodes each: 12 known, 3 started as they are``."""
    head = ", ".join(_counted(held))
    details = ", ".join(_details(held)) if held.total.nodes else ""
    return f"{head}: {details}" if details else head


def _counted(held: Coverage) -> Iterator[str]:
    robots = [it for it in held.robots if it.robot]
    shared = sum(it.nodes for it in held.robots if not it.robot)
    if robots:
        yield plural(len(robots), "robot")
    counts = sorted({it.nodes for it in robots})
    if any(counts):
        least = f"{counts[0]} to " if len(counts) > 1 else ""
        yield f"{least}{plural(counts[-1], 'node')}{' each' * (len(robots) > 1)}"
    if shared:
        yield f"{shared} for all" if robots else plural(shared, "node")


def _details(held: Coverage) -> Iterator[str]:
    total = held.total
    robots = [it for it in held.robots if it.robot]
    alike = len({it[1:3] for it in robots}) == 1
    if held.told and not total.unknown:
        yield "all known"
    elif held.told and alike and total.nodes == robots[0].nodes * len(robots):
        yield f"{robots[0].known} known, {_as_they_are(robots[0].unknown)}"
    elif held.told:
        whose = (f"{it.robot or 'for all'} {it.unknown}" for it in held.robots if it.unknown)
        where = f" ({shorten(whose, SEVERAL)})" if robots else ""
        yield f"{total.known} known, {_as_they_are(total.unknown)}{where}"
    if held.compared:
        all_seen = total.seen == total.nodes
        yield f"{'all' if all_seen else f'{total.seen} of {total.nodes}'} {held.compared}"
    if total.silent:
        yield f"{total.silent} silent"


def _as_they_are(count: int) -> str:
    return f"{count} started as {'it is' if count == 1 else 'they are'}"


def as_value(held: Coverage) -> Mapping[str, object]:
    """Return the coverage as JSON has it; null for what is not said."""
    return {
        **_row(held, held.total),
        "incomplete": held.incomplete,
        "robots": [{"robot": it.robot, **_row(held, it)} for it in held.robots],
        "text": in_words(held),
    }


def _row(held: Coverage, row: Covered) -> Mapping[str, object]:
    return {
        "nodes": row.nodes,
        "known": row.known if held.told else None,
        "as_they_are": row.unknown if held.told else None,
        "seen": row.seen if held.compared else None,
        "silent": row.silent if held.compared == SEEN else None,
    }
