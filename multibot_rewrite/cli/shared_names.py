# SPDX-License-Identifier: Apache-2.0
"""Names given with ``--shared`` that change nothing: mistyped, or without the slash of a topic."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import Any

from multibot_rewrite.base.conventions import SHARED_TOPICS, WORLD_FRAMES
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.nearest import did_you_mean
from multibot_rewrite.cli.usage import policy
from multibot_rewrite.description.sources.included_by import data_of_file

TOPICS, FRAMES = "shared_topics", "shared_frames"
USUAL: Mapping[str, tuple[str, ...]] = {TOPICS: SHARED_TOPICS, FRAMES: WORLD_FRAMES}
# Makes the result with another naming policy; equal results are equal in texts and findings.
Make = Callable[[Mapping[str, Any]], object]


def check_shared(
    options: argparse.Namespace,
    result: object,
    make: Make,
    names: Mapping[str, Collection[str]],
    files: Sequence[str] = (),
) -> None:
    """Raise UsageError for a name of ``--shared`` without which the input gives the same result.

    ``names`` are the frames and topics of the input by ``FRAMES`` and ``TOPICS``, as far as they are
    known; where they are not, a name that is in the text of one of the ``files`` may be one. What is
    shared by default may be named again.
    """
    given: dict[str, Any] = {**policy(options)}
    for word in dict.fromkeys(options.shared):
        kind = TOPICS if word.startswith("/") else FRAMES
        if word in USUAL[kind] or word.strip("/") in names.get(kind, ()):
            continue
        without = [
            it for it in options.shared if it.startswith("/") == (kind == TOPICS) and it != word
        ]
        if make({**given, kind: without}) == result:
            hint = _hint(word, given, make, result, names)
            if not hint and any(word.strip("/").encode() in data_of_file(it) for it in files):
                continue
            what = "topic" if kind == TOPICS else "frame"
            raise UsageError(f"--shared {word}: the input has no {what} {word!r}{hint}")


def _hint(
    word: str,
    given: Mapping[str, Any],
    make: Make,
    result: object,
    names: Mapping[str, Collection[str]],
) -> str:
    """Return what was probably meant: the same name of the other kind, or one that is like it."""
    kind, other = (TOPICS, FRAMES) if word.startswith("/") else (FRAMES, TOPICS)
    bare = word.strip("/")
    spelled = bare if other == FRAMES else f"/{bare}"
    as_other = {**given, other: [*given.get(other, USUAL[other]), spelled]}
    if bare in names.get(other, ()) or make(as_other) != result:
        slash = "topics are written with a slash" if other == TOPICS else "frames have no slash"
        return f"; {slash}: --shared {spelled}"
    slashed = "/" if kind == TOPICS else ""
    near = did_you_mean(word, sorted(f"{slashed}{it}" for it in names.get(kind, ())))
    return f"; {near}" if near else ""
