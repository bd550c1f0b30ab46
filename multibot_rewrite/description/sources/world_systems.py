# SPDX-License-Identifier: Apache-2.0
"""Systems of the whole world that a description loads, set aside: they stay in the text as comments,
and the world loads them, once.

Why: gz-sim makes one object for each <plugin> that it meets (src/SystemManager.cc), so a second robot
with the Sensors system crashes it (gz-sensors issue 497).
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.base.model import Edit, InputError
from multibot_rewrite.description.checks.hazards import system_key, world_systems
from multibot_rewrite.description.rewriters.tree import Tree
from multibot_rewrite.description.steps.apply import cut
from multibot_rewrite.description.steps.collect import collect
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.description.steps.spans import Spans

_OPEN, _CLOSE = b"<!-- left to the world ", b" -->"
_ASIDE = re.compile(_OPEN + rb"(<plugin\b.*?>)" + _CLOSE, re.DOTALL)


def set_aside(source: bytes, file: str, tree: Tree) -> tuple[bytes, tuple[str, ...]]:
    """The description with its systems of the world as comments, and their libraries. One that holds a
    comment stays, and is found to be loaded with every robot. Raises InputError."""
    if b"<plugin" not in source:
        return source, ()
    document = read_document(source, file)
    own = [it.element for it in world_systems(collect(document, tree))]
    spans = Spans(document)
    found = [it for it in own if b"--" not in spans.text_of(it)]
    return b"".join(cut(source, sorted(_edits(spans, found)))), tuple(map(system_key, found))


def _edits(spans: Spans, elements: list[_Element]) -> Iterator[Edit]:
    for start, end in map(spans.of, elements):
        yield Edit(start, start, _OPEN, None)
        yield Edit(end, end, _CLOSE, None)


def put_back(source: bytes, file: str, tree: Tree) -> bytes:
    """The inverse, proved by doing it again; raises InputError where that makes another text."""
    whole = _ASIDE.sub(rb"\1", source)
    if set_aside(whole, file, tree)[0] != source:
        what = "a comment 'left to the world' is not what --world-systems leave writes"
        raise InputError(f"{file}: {what}: leave out that option, or take back what was edited")
    return whole
