# SPDX-License-Identifier: Apache-2.0
"""Faults made by chance: one place of a right output, or one edit of a right plan, is wrong."""

from __future__ import annotations

import random
import re
from collections.abc import Callable, Iterator

from lxml import etree

from multibot_rewrite.base.model import Edit
from multibot_rewrite.description.steps.apply import Template, cut, fill

# What a text is made of; the first that fits.
TOKENS = {
    "marker": rb"<!-- multibot [^>]*-->",
    "comment": rb"<!--.*?-->|<\?.*?\?>|<!\[CDATA\[.*?\]\]>",
    "end tag": rb"</[^>]*>",
    "tag": rb"<[^\s/>]+",
    "value": rb"\"[^\"]*\"|'[^']*'",
    "attribute": rb"[^\s=<>\"'/]+(?=\s*=\s*[\"'])",
    "bracket": rb"/?>",
    "equals": rb"=",
    "space": rb"\s+",
    "text": rb"[^<\s]+",
}
_TOKEN = re.compile(
    b"|".join(b"(?P<%s>%s)" % (kind.replace(" ", "_").encode(), it) for kind, it in TOKENS.items()),
    re.DOTALL,
)
Change = Callable[[random.Random, bytes, list[bytes]], bytes]


def flipped(chance: random.Random, token: bytes, alike: list[bytes]) -> bytes:
    """One bit the other way."""
    at = chance.randrange(len(token))
    return token[:at] + bytes([token[at] ^ 1 << chance.randrange(7)]) + token[at + 1 :]


def shortened(chance: random.Random, token: bytes, alike: list[bytes]) -> bytes:
    """Return the text with a byte less."""
    at = chance.randrange(len(token))
    return token[:at] + token[at + 1 :]


def lengthened(chance: random.Random, token: bytes, alike: list[bytes]) -> bytes:
    """Return the text with a byte twice."""
    at = chance.randrange(len(token))
    return token[: at + 1] + token[at:]


def doubled(chance: random.Random, token: bytes, alike: list[bytes]) -> bytes:
    """All of it twice."""
    return token * 2


def lost(chance: random.Random, token: bytes, alike: list[bytes]) -> bytes:
    """Nothing of it."""
    return b""


def exchanged(chance: random.Random, token: bytes, alike: list[bytes]) -> bytes:
    """Another one of its sort."""
    return chance.choice(alike)


CHANGES: tuple[Change, ...] = (flipped, shortened, lengthened, doubled, lost, exchanged)


def wrong_texts(text: bytes, chance: random.Random, times: int) -> Iterator[tuple[str, bytes]]:
    """Texts with one token changed: of each sort that there is, so many; with what was done."""
    tokens = list(_TOKEN.finditer(text))
    for kind in sorted({it.lastgroup or "" for it in tokens}):
        mine = [it for it in tokens if it.lastgroup == kind]
        alike = sorted({it[0] for it in mine})
        for _ in range(times):
            token, change = chance.choice(mine), chance.choice(CHANGES)
            new = change(chance, token[0], alike)
            if new != token[0]:
                about = f"{kind} {token[0]!r} at {token.start()} {change.__name__}: {new!r}"
                yield about, text[: token.start()] + new + text[token.end() :]


def wrong_edits(edit: Edit) -> Iterator[tuple[str, list[Edit]]]:
    """Yield what may come of one edit."""
    start, end, before, after = edit
    yield "lost", []
    yield "twice", [edit, edit]
    yield "later", [edit._replace(start=start + 1, end=end + 1)]
    yield "earlier", [edit._replace(start=start - 1, end=end - 1)]
    yield "without what is before", [edit._replace(before=b"")]
    yield "takes a byte before", [edit._replace(start=start - 1)]
    yield "takes a byte behind", [edit._replace(end=end + 1)]
    if after is not None:
        yield "without the name", [edit._replace(after=None)]
        yield "name as it is", [Edit(start, end, before + b"robot1" + after, None)]
        yield "another robot's name", [Edit(start, end, before + b"robot2" + after, None)]
        yield "halves swapped", [Edit(start, end, after, before)]
        other = before.translate(_OTHER), after.translate(_OTHER)
        yield "another separator", [Edit(start, end, *other)]


_OTHER = bytes.maketrans(b"/_", b"_/")


def wrong_plans(template: Template) -> Iterator[tuple[str, Template]]:
    """Yield the template with one edit wrong, for each of them; with what was done."""
    edits, source = template.plan.edits, template.inventory.document.source
    right = texts(template)
    for number, edit in enumerate(edits):
        for about, instead in wrong_edits(edit):
            new = [*edits[:number], *instead, *edits[number + 1 :]]
            new.sort(key=lambda it: it.start)
            wrong = template._replace(
                plan=template.plan._replace(edits=new), pieces=cut(source, new)
            )
            # An edit may be at another place and come to the same.
            if any(not is_same(*pair) for pair in zip(texts(wrong), right, strict=True)):
                yield f"edit {number} at {edit.start} {about}", wrong


def is_same(wrong: bytes, right: bytes) -> bool:
    """Do two texts say the same, in whatever order, words in comments and white space aside?"""
    if wrong == right:
        return True
    try:
        return sorted(_said(wrong)) == sorted(_said(right))
    except etree.XMLSyntaxError:
        return False


def _said(text: bytes) -> list[tuple[str, list[tuple[str, str]], str]]:
    root = etree.fromstring(text, etree.XMLParser(remove_comments=True, remove_pis=True))
    return [
        (it.tag, sorted(it.attrib.items()), " ".join(it.xpath("text()")).strip())
        for it in root.iter()
    ]


def texts(template: Template) -> list[bytes]:
    """Return what two robots would get."""
    return [fill(template.pieces, robot) for robot in ("robot1", "other")]
