# SPDX-License-Identifier: Apache-2.0
"""A launched static_transform_publisher -> the node with the transform that it sends."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise

from multibot_rewrite.knowledge.records import FrameParameter, NodeFacts, SentTransform

STATIC = "static_transform_publisher"
_PARENT, _CHILD = "frame_id", "child_frame_id"
_FLAGS = {"--frame-id": _PARENT, "--child-frame-id": _CHILD}


def with_static_transform(node: NodeFacts, words: Sequence[str]) -> NodeFacts:
    """The node with the frames of its arguments, and of its parameters where these name none.

    Another node stays as it is, and so does one of which a frame is not known.
    """
    if node.known != STATIC:
        return node
    named = _named(words)
    frames = tuple(_framed(it, named) for it in node.frames)
    known = {it.parameter for it in frames if it.given and it.default}
    sends = (SentTransform(_PARENT, _CHILD),) if {_PARENT, _CHILD} <= known else ()
    return node._replace(frames=frames, sends=sends)


def _named(words: Sequence[str]) -> Mapping[str, str]:
    """Flags, or the last two words (tf2_ros jazzy, static_transform_broadcaster_program.cpp)."""
    flags = {flag: word for flag, word in pairwise(words) if flag.startswith("--")}
    if flags:
        return {_FLAGS[flag]: word for flag, word in flags.items() if flag in _FLAGS}
    return dict(zip((_PARENT, _CHILD), words[-2:], strict=True)) if len(words) in (8, 9) else {}


def _framed(frame: FrameParameter, named: Mapping[str, str]) -> FrameParameter:
    """tf2 leaves out a slash in front of a frame (buffer_core.cpp, stripSlash)."""
    name = named.get(frame.parameter) or frame.default
    given = frame.given or bool(named.get(frame.parameter))
    return frame._replace(default=name.lstrip("/") if given else name, given=given)
