# SPDX-License-Identifier: Apache-2.0
"""Frames of nodes: those of the robot in the place of usual ones that it has not."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from multibot_rewrite.base.conventions import BODY_FRAMES
from multibot_rewrite.fleet.robots.member import Member
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.spelling.transforms import edges_in
from multibot_rewrite.system.records import Edge

ODOM = "odom"
Frames = Mapping[str, str]
NO_FRAMES: Frames = {}


def fitting_frames(member: Member, nodes: Iterable[NodeFacts], sent: Sequence[Edge]) -> Frames:
    """Return the usual frames that nothing of the robot has, each with the frame that its drive has in
    that place."""
    placed = next((it for it in sent if it.child in BODY_FRAMES or it.parent == ODOM), None)
    if placed is None:
        return NO_FRAMES
    links = {it.get("name", "") for it in member.source.root.iter("link", "frame")}
    given = {frame.default for it in nodes for frame in it.frames if frame.given}
    has = links | given | {frame for it in sent for frame in it[:2]}
    wanted = {**dict.fromkeys(BODY_FRAMES, placed.child), ODOM: placed.parent}
    return {name: it for name, it in wanted.items() if name not in has}


def with_frames(node: NodeFacts, fits: Frames) -> NodeFacts:
    """Return the node with frames that the robot has, where no file sets them."""
    frames = (
        it if it.given else it._replace(default=fits.get(it.default, it.default))
        for it in node.frames
    )
    return node._replace(frames=tuple(frames)) if fits else node


def changed_frames(
    nodes: Iterable[NodeFacts], before: Iterable[NodeFacts]
) -> Mapping[tuple[str, str], str]:
    """Return the frames of nodes that are others than ``before``, where no file sets them: by the
    node's last name and the parameter."""
    old = {(node.name, it.parameter): it.default for node in before for it in node.frames}
    return {
        (node.kind.rpartition("/")[2], it.parameter): it.default
        for node in nodes
        for it in node.frames
        if not it.given and old.get((node.name, it.parameter), it.default) != it.default
    }


def root_link(member: Member) -> str:
    """Return the link that no joint holds, where another usual one of the body is below it; empty for
    none."""
    children = {it.child for it in edges_in(member.source.root)}
    roots = [
        name
        for it in member.source.root.iterfind("link")
        if (name := it.get("name", "")) not in children
    ]
    return roots[0] if len(roots) == 1 and not children.isdisjoint(BODY_FRAMES) else ""


def with_root(node: NodeFacts, root: str) -> NodeFacts:
    """Return the node with the root of the description as the frame that it places: a link that a
    joint holds has a parent already."""
    placed = {it.child for it in node.sends}
    frames = (
        it._replace(default=root) if it.parameter in placed and it.default in BODY_FRAMES else it
        for it in node.frames
    )
    return node._replace(frames=tuple(frames)) if root else node
