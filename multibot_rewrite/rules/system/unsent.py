"""Dangers of what is not there: an end whose node's code or parameters name it, and nothing sends."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping

from multibot_rewrite.base.conventions import chooses, is_from_outside
from multibot_rewrite.base.findings.finding import ERROR, NOTE, Finding
from multibot_rewrite.base.nearest import nearest
from multibot_rewrite.base.wording import shorten, unique
from multibot_rewrite.rules.declaration import system_rule
from multibot_rewrite.rules.places import where
from multibot_rewrite.system.index import Ends, Index, once
from multibot_rewrite.system.records import ACTION, CALLS, RUNS, SUBSCRIBES, TOPIC, End
from multibot_rewrite.system.tool_nodes import is_viewer, last_word

# The server of an action sends its status.
_STATUS = "/_action/status"
# Of such a type are many topics that have nothing to do with each other.
_PLAIN_TYPES = "std_"
_LISTED = 8


@system_rule(
    "MG316",
    "nothing-known-sends",
    NOTE,
    absence=True,
    what="Nodes read topics, or call services, that no known node sends or serves.",
    why="If nothing else does, these nodes wait for ever.",
    fix="Nothing, if a driver that the fleet does not name sends them; else name its node or stack.",
    bad="running: /robot1/amcl subscribes /robot1/scan sensor_msgs/msg/LaserScan as scan\n",
    good="""\
running: /robot1/amcl subscribes /robot1/scan sensor_msgs/msg/LaserScan as scan
running: /robot1/lidar publishes /robot1/scan sensor_msgs/msg/LaserScan
""",
)
def nothing_known_sends(seen: Index) -> Iterator[Finding]:
    """All names of a robot are one finding; without those that others have under another name."""
    left = [it for it in open_ends(seen) if not meant(seen, it)]
    for robot in unique(seen.robot(it.node) for it in left):
        names = unique(sorted(it.name for it in left if seen.robot(it.node) == robot))
        listed = shorten(names, _LISTED)
        hint = "name a stack or nodes that do, if no driver of its own does"
        yield nothing_known_sends.finding(
            f"no known node sends {listed}", hint, robot=robot, names=names
        )


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


def is_needed(end: End) -> bool:
    """Must something of the robot give it, as far as is known? What chooses seldom has all inputs."""
    by_code = end.role in (SUBSCRIBES, CALLS) and end.code_name and end.sure == RUNS
    outside = is_from_outside(end.name) or is_from_outside(end.code_name)
    idle = is_viewer(end.node) or (end.role == SUBSCRIBES and chooses(end.node))
    return bool(by_code) and not outside and not idle


def _is_status(seen: Index, kind: str, name: str) -> bool:
    served = seen.by_name.get((ACTION, name.removesuffix(_STATUS)))
    return kind == TOPIC and name.endswith(_STATUS) and served is not None and bool(served.servers)


def meant(seen: Index, end: End) -> Ends | None:
    """What may be meant by an end: what is sent of the same type, with the same last word or the likest
    name; nothing for one of which it is not known what the code calls it."""
    if not is_needed(end) or not end.type:
        return None
    given = _given(seen)
    own = {"", seen.robot(end.node)}
    same = {at: it for one in own for at, it in given.get((end.kind, end.type, one), ())}
    alike = {same[at].name: same[at] for at in sorted(same) if _may_be(seen, same[at], end)}
    if end.type.startswith(_PLAIN_TYPES):
        # What their names in the code have in common counts, not the robot's namespace.
        words = {last_word(one.code_name): it for it in alike.values() for one in _givers(it)}
        return words.get(nearest(last_word(end.code_name), words))
    last = [name for name in alike if name.endswith(f"/{last_word(end.name)}")]
    return alike.get(nearest(end.name, last or alike, alike=0.0))


@once
def _given(seen: Index) -> Mapping[tuple[str, str, str], list[tuple[int, Ends]]]:
    """What is sent or served, by its kind, its type and the robot that does, each with its place among
    all: a look at all names for each end takes the square of the robots."""
    found: dict[tuple[str, str, str], list[tuple[int, Ends]]] = defaultdict(list)
    for at, it in enumerate(seen.by_name.values()):
        for robot in {seen.robot(one.node) for one in _givers(it)}:
            found[it.kind, it.type, robot].append((at, it))
    return found


def _may_be(seen: Index, ends: Ends, end: End) -> bool:
    """Does another node of the same robot, or of none, send it, and is it not read already?"""
    if any(it.node == end.node for it in (*ends.subscribers, *ends.clients)):
        return False
    own = ("", seen.robot(end.node))
    return any(it.node != end.node and seen.robot(it.node) in own for it in _givers(ends))


def _givers(ends: Ends) -> Iterable[End]:
    return (*ends.publishers, *ends.servers)
