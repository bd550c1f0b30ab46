"""Frames that nodes of a robot read by their files, and nothing of it sends."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from multibot_rewrite.base.conventions import USUAL_FRAMES
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.producers.evidence.records import GivenNode
from multibot_rewrite.rules.closure.gap import Gap
from multibot_rewrite.system.records import NOWHERE, OFF, Edge, Place

READ = "read frame"


def unsent_gaps(
    edges: Sequence[Edge], given: Sequence[GivenNode], known: Mapping[str, NodeFacts]
) -> Iterator[Gap]:
    """Usual frames that nodes read by their files, while others send transforms without them: the first
    reader of each. ``near`` is a transform that is sent.

    Nothing is said where no file has a node that sends any: a driver that nobody names may.
    """
    sent = [it for it in edges if it.sure != OFF]
    there = {frame for it in sent for frame in (it.parent, it.child)}
    sections = {f"/{it.name}" for it in given}
    by_file = (it for it in sent if it.place != NOWHERE and it.publishers[0] in sections)
    first = next(by_file, None)
    for node in given if first else ():
        for parameter, frame, place in _read_frames(node, known.get(node.known)):
            if frame in USUAL_FRAMES and frame not in there and first:
                there.add(frame)
                near = f"{first.publishers[0]} sends {first.parent} -> {first.child}"
                key = (READ, node.known, parameter)
                yield Gap(READ, frame, node.name, key, place, near, first.place)


def _read_frames(given: GivenNode, node: NodeFacts | None) -> Iterator[tuple[str, str, Place]]:
    """Parameters of frames that a node does not send itself, with what a file sets them to."""
    own = {name for it in node.sends for name in it[:2]} if node else set()
    for it in node.frames if node else ():
        found = given.values.get(it.parameter)
        if found and it.parameter not in own and isinstance(found.value, str):
            yield it.parameter, found.value.lstrip("/"), found.place
