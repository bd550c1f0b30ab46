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
    named = frames_in(words)
    frames = tuple(_framed(it, named) for it in node.frames)
    known = {it.parameter for it in frames if it.given and it.default}
    sends = (SentTransform(_PARENT, _CHILD),) if {_PARENT, _CHILD} <= known else ()
    return node._replace(frames=frames, sends=sends)


def frames_in(words: Sequence[str]) -> Mapping[str, str]:
    """Return the frames in the words of a static_transform_publisher, by their parameters: behind
    flags, or the last two (tf2_ros jazzy, static_transform_broadcaster_program.cpp)."""
    flags = {flag: word for flag, word in pairwise(words) if flag.startswith("--")}
    if flags:
        return {_FLAGS[flag]: word for flag, word in flags.items() if flag in _FLAGS}
    return dict(zip((_PARENT, _CHILD), words[-2:], strict=True)) if len(words) in (8, 9) else {}


def with_frames(words: Sequence[str], frames: Mapping[str, str]) -> tuple[str, ...]:
    """Return the words with other frames."""
    named = frames_in(words)
    if not any(word.startswith("--") for word in words):
        return (
            (*words[:-2], *(frames.get(it, named[it]) for it in (_PARENT, _CHILD)))
            if named
            else (*words,)
        )
    flags = ("", *words[:-1])
    return tuple(
        frames.get(_FLAGS.get(flag, ""), it) for flag, it in zip(flags, words, strict=True)
    )


def _framed(frame: FrameParameter, named: Mapping[str, str]) -> FrameParameter:
    """tf2 leaves out a slash in front of a frame (buffer_core.cpp, stripSlash)."""
    name = named.get(frame.parameter) or frame.default
    given = frame.given or bool(named.get(frame.parameter))
    return frame._replace(default=name.lstrip("/") if given else name, given=given)
