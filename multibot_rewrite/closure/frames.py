"""Who sends the transform from the odometry to the robot, when all that could are switched off."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from multibot_rewrite.closure.gap import Gap
from multibot_rewrite.evidence.filling import filled
from multibot_rewrite.evidence.records import GivenNode, Place
from multibot_rewrite.remap.conditions import parse_condition
from multibot_rewrite.remap.records import NodeFacts

FRAME = "frame"


def frame_gaps(
    given: Sequence[GivenNode], known: Mapping[str, NodeFacts], sent: Iterable[str]
) -> Iterator[Gap]:
    """Frames that nodes of a robot could send, and none does. ``sent`` are those that are sent."""
    there = set(sent)
    for it in given:
        node = known.get(it.known)
        if node is None or not node.sends:
            continue
        runs = filled(node, it)
        frames = {frame.parameter: frame.default for frame in runs.frames}
        left = [send for send in node.sends if send.child not in {one.child for one in runs.sends}]
        for send in left:
            child, switch = frames[send.child], _switch(send.condition, it)
            if switch and not runs.sends and child not in there:
                there.add(child)
                yield Gap(FRAME, child, it.name, (FRAME, it.known, send.child), switch)


def _switch(condition: str, given: GivenNode) -> Place | None:
    """Where the parameter is that switches it off."""
    for it in parse_condition(condition):
        if it.parameter in given.values:
            return given.values[it.parameter].place
    return None
