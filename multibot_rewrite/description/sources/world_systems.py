# SPDX-License-Identifier: Apache-2.0
"""Moves systems of the whole world out of a description: they stay as comments.

Why: gz-sim makes one object for each <plugin> that it meets (src/SystemManager.cc), so a second
robot with the Sensors system crashes it (gz-sensors issue 497)."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import NOTE, Finding
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import Edit, InputError
from multibot_rewrite.description.checks.hazards import LEFT, WORLD, system_key, world_systems
from multibot_rewrite.description.checks.problem import Problem, to_findings
from multibot_rewrite.description.rewriters.tree import Tree, library_and_class, library_key
from multibot_rewrite.description.steps.apply import Spans, cut
from multibot_rewrite.description.steps.collect import collect
from multibot_rewrite.description.steps.document import Document, read_document
from multibot_rewrite.knowledge.worlds import DRIVES, SYSTEMS

_OPEN, _CLOSE = b"<!-- left to the world ", b" -->"
_ASIDE = lazy_compile(_OPEN + rb"(<plugin\b(?:[^-]|-(?!-))*?>)" + _CLOSE)
_TAGS = lazy_compile(rb"<plugin\b[^<]*")
_SAID = lazy_compile(rb"""\b(filename|name)\s*=\s*(["'])(.*?)\2""", re.DOTALL)
# A comment cannot hold two dashes, as the begin of another one.
_DASHES, _WRITTEN = b"--", b"-&#45;"
Systems = tuple[tuple[str, str], ...]


def set_aside(source: bytes, file: str, tree: Tree) -> tuple[bytes, Systems]:
    """Return the description with world systems as comments, and their texts. Raises InputError."""
    if not any(_may_load(it, tree) for it in {*_TAGS.findall(source)}):
        return source, ()
    document = read_document(source, file)
    spans = Spans(document)
    own = [it.element for it in world_systems(collect(document, tree))]
    found = {spans.of(it): (system_key(it), spans.text_of(it)) for it in own}
    left = {at: it for at, it in found.items() if _WRITTEN not in it[1]}
    edits = sorted(
        Edit(*at, _OPEN + text.replace(_DASHES, _WRITTEN) + _CLOSE, None)
        for at, (_, text) in left.items()
    )
    names = tuple((key, " ".join(text.decode().split())) for key, text in left.values())
    return b"".join(cut(source, edits)), names


def _may_load(tag: bytes, tree: Tree) -> bool:
    """Return whether a plugin may be a system of the world: by its name, or with an entity."""
    said = {
        name.decode(): value.decode("utf-8", "replace") for name, _, value in _SAID.findall(tag)
    }
    keys = library_and_class(said.get("filename", ""), said.get("name", ""))
    known = (it for key in keys for it in tree.definitions.find("plugin", key))
    return b"&" in tag or any(WORLD in it.opens for it in known)


def left_to_world(document: Document, left: Systems) -> Iterator[Finding]:
    """Yield a note of the systems the world has to load; raises InputError for a second one."""
    # Undoing the rewrite would remove a comment that the source has already.
    if len(_ASIDE.findall(document.source)) != len(left):
        what = "a comment 'left to the world' is that of an earlier rewrite"
        raise InputError(f"{document.file}: {what}: take that back by --undo")
    if left:
        names, texts = (sorted({*it}) for it in zip(*left, strict=True))
        message = f"the world has to load {', '.join(names)}, which no robot loads any more"
        hint = f"write into its <world>: {' '.join(texts)}"
        problem = Problem(document.root, message, hint=hint, code=LEFT)
        yield from to_findings(document, [problem], NOTE, of_file=True)


def put_back(source: bytes, file: str, tree: Tree) -> bytes:
    """Return the description with its world systems, verified; raises InputError if edited."""
    whole = _ASIDE.sub(lambda it: it[1].replace(_WRITTEN, _DASHES), source)
    if whole != source and set_aside(whole, file, tree)[0] != source:
        what = "a comment 'left to the world' is not what a rewrite writes"
        raise InputError(f"{file}: {what}: take back what was edited")
    return whole


def needed_systems(models: Iterable[tuple[str, _Element]]) -> Iterator[tuple[str, str]]:
    """Yield (system, reason) for each system that a Gazebo world needs for these models."""
    # Source: user_commands of gz-sim8 spawns entities.
    every = list(models)
    if every:
        yield "user-commands", f"{every[0][0]} is not spawned"
    libraries = [
        (name, library_key(one.get("filename", "")))
        for name, root in every
        for one in root.iter("plugin")
    ]
    if moved := next((name for name, it in libraries if it in DRIVES), ""):
        yield "physics", f"{moved} does not move"
    first: dict[str, str] = {}
    for name, root in every:
        for sensor in root.iter("sensor"):
            system, _ = SYSTEMS.get(sensor.get("type", ""), ("", ""))
            if system:
                first.setdefault(system, f"{sensor.get('name')} of {name} sends nothing")
    yield from first.items()
