# SPDX-License-Identifier: Apache-2.0
"""Which of the nodes on a tf topic can have sent a transform, by what they do: a transform does not say
who sent it."""

from __future__ import annotations

from collections.abc import Sequence

from multibot_rewrite.base.conventions import SENT_FRAMES, WORLD_FRAMES
from multibot_rewrite.system import words
from multibot_rewrite.system.index import Index
from multibot_rewrite.system.records import SUBSCRIBES, Edge
from multibot_rewrite.system.tool_nodes import last_word

_STATE_PUBLISHER, _STATIC = "robot_state_publisher", "static_transform_publisher"
# Of one transform.
_TWO = 2


def who_can_send(seen: Index, nodes: Sequence[str], edges: Sequence[Edge]) -> Sequence[str]:
    """The nodes that can send one of these; all, where fewer than two would be left."""
    found = [node for node in nodes if any(_can_send(seen, node, it) for it in edges)]
    return found if len(found) >= _TWO else nodes


def _can_send(seen: Index, node: str, edge: Edge) -> bool:
    """A description has no odometry, amcl (it reads a start pose) sends map -> odom alone, a drive
    nothing below the map."""
    above, word = seen.plain_frame(edge.parent), last_word(node)
    if word.startswith(_STATE_PUBLISHER):
        return above not in SENT_FRAMES
    if word.startswith(_STATIC):
        return edge.static
    read = [it for it in seen.by_node.get(node, ()) if it.role == SUBSCRIBES]
    if any(words.is_start_pose(seen.plain(it.name), it.type) for it in read):
        return above in WORLD_FRAMES
    drives = any(words.moves(it.name, it.type) for it in read)
    return not (drives and above in WORLD_FRAMES)
