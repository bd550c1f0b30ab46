# SPDX-License-Identifier: Apache-2.0
"""``urdf-lint:`` comments of a file: what they suppress, and in which part of the file.

<!-- urdf-lint: ignore MB401, MB402 - a reason -->
<!-- urdf-lint: ignore-file MB401: a reason -->
"""

import re
from bisect import bisect_left
from collections.abc import Iterator, Mapping, Sequence
from itertools import accumulate
from typing import NamedTuple

from multibot_rewrite.base.findings.codes import names_to_codes
from multibot_rewrite.base.lazy import ATTRIBUTES, SILENT, lazy_compile
from multibot_rewrite.base.nearest import nearest
from multibot_rewrite.lint.registry import RULES
from multibot_rewrite.rules.settings import MARK

IGNORE, IGNORE_FILE = "ignore", "ignore-file"
# No comment can suppress these: a file was not checked, or a comment is wrong.
ALWAYS_REPORTED = frozenset(
    {"MB001", "MB002", "MB003", "MB004", "MB101", "MB102", "MB103", "MB145", "MB119"}
)
_OPEN, _EMPTY, _CLOSE, _COMMENT, _OTHER = range(5)
_PART = lazy_compile(SILENT + rb"|</?([^\s/<>!?\"']+)(?=[\s/>])" + ATTRIBUTES + rb">")
_DIRECTIVE = lazy_compile(rb"<!--\s*urdf-lint\s*(?:(:)\s*)?(?=\S)([^\s:]*)(|[\s:].*)-->", re.DOTALL)
# A dash or a colon with spaces around it, so that MB401-MB405 and MB401:MB402 are errors.
_REASON = lazy_compile(rb"(?::|(?<=\s)(?:-|\xe2\x80\x93|\xe2\x80\x94))(?=\s|$)")
_WORD = lazy_compile(rb"[^\s,]+")
_LINE_END = lazy_compile(rb"[^\S\n]*(?:\n|\Z)")
_LIKE_A_CODE = lazy_compile(r"[A-Za-z]{1,3}-?\d+")
# What only some expansions of a xacro file hold.
_SOMETIMES = frozenset({b"xacro:macro", b"xacro:if", b"xacro:unless"})
_HOW = "write urdf-lint: ignore CODE, CODE - reason"


class TagPart(NamedTuple):
    """A tag, comment or the like by byte offsets; ``name`` is that of an element's first tag."""

    kind: int
    start: int
    end: int
    name: bytes = b""


class DirectiveFault(NamedTuple):
    """What is wrong with a comment, at a byte offset."""

    start: int
    message: str
    hint: str = _HOW


class CodeName(NamedTuple):
    """A rule's code in a comment, and its place."""

    text: str
    start: int
    end: int


class Directive(NamedTuple):
    """A comment from ``start`` to ``end``, and the lines it is on as byte offsets.

    ``element`` is the span of the element below it, if any. ``sometimes``: only some expansions
    of the file have what it is about. ``idle``: there is no element that a finding could be at.
    """

    start: int
    end: int
    word: str
    codes: tuple[CodeName, ...]
    faults: tuple[DirectiveFault, ...]
    lines: tuple[int, int]
    element: tuple[int, int] | None = None
    sometimes: bool = False
    idle: bool = False


def read_directives(source: bytes) -> list[Directive]:
    """Return the ``urdf-lint:`` comments of a file, in order."""
    parts = list(_parts(source))
    ends = _element_ends(parts)
    spans = ((parts[at], end) for at, end in ends.items())
    sometimes = sorted((it.start, end) for it, end in spans if it.name in _SOMETIMES)
    # Their starts in order, and how far those up to each one go.
    reached = ([it[0] for it in sometimes], [*accumulate((it[1] for it in sometimes), max)])
    tags = [it for it in parts if it.kind in (_OPEN, _EMPTY)]
    below = _elements_below(source, parts, ends)
    found, before, last = [], _OTHER, 0
    for part, element in zip(parts, below, strict=True):
        if part.kind == _COMMENT and (it := _directive(source, part)):
            alone = it.word == IGNORE and _has_its_lines(source, part, last)
            it = _checked_place(it._replace(element=element if alone else None), tags)
            idle = it.word == IGNORE and _is_idle(it, tags, before)
            found.append(it._replace(sometimes=_overlaps(it, reached), idle=idle))
        before, last = part.kind if part.kind != _COMMENT else before, part.end
    return found


def _parts(source: bytes) -> Iterator[TagPart]:
    """Yield the tags, comments and other markup of a file."""
    for found in _PART.finditer(source):
        start, end, name = found.start(), found.end(), found[1]
        if name is None:
            kind = _COMMENT if source.startswith(b"<!--", start) else _OTHER
            yield TagPart(kind, start, end)
        elif source.startswith(b"</", start):
            yield TagPart(_CLOSE, start, end)
        else:
            yield TagPart(_EMPTY if source[end - 2 : end] == b"/>" else _OPEN, start, end, name)


def _element_ends(parts: Sequence[TagPart]) -> dict[int, int]:
    """Return by the number of an element's first tag the offset where the element ends."""
    ends: dict[int, int] = {}
    opened: list[int] = []
    for at, part in enumerate(parts):
        if part.kind == _OPEN:
            opened.append(at)
        elif part.kind == _EMPTY:
            ends[at] = part.end
        elif part.kind == _CLOSE and opened:
            ends[opened.pop()] = part.end
    return ends


def _directive(source: bytes, part: TagPart) -> Directive | None:
    """Return the comment for the lint that a part of a file is, or None."""
    comment = _DIRECTIVE.fullmatch(source, part.start, part.end)
    if comment is None:
        return None
    word = comment[2].decode("utf-8", "replace")
    if not comment[1] and word not in (IGNORE, IGNORE_FILE):
        return None  # text about the lint
    codes, faults = _codes(source, comment)
    if not comment[1]:
        faults = [DirectiveFault(part.start, f"there is no colon after {MARK.decode()!r}")]
    elif word not in (IGNORE, IGNORE_FILE):
        near = nearest(word.lower(), (IGNORE, IGNORE_FILE))
        hint = f"did you mean {near!r}?" if near else _HOW
        what = f"unknown word {word!r}" if word else "the comment is empty"
        faults = [DirectiveFault(part.start, what, hint)]
    codes = [] if faults and faults[0].start == part.start else codes
    end = source.find(b"\n", part.end)
    lines = source.rfind(b"\n", 0, part.start) + 1, (len(source) if end < 0 else end)
    return Directive(part.start, part.end, word, tuple(codes), tuple(faults), lines)


def _codes(source: bytes, comment: re.Match[bytes]) -> tuple[list[CodeName], list[DirectiveFault]]:
    """Return the valid codes, and what is wrong with the others."""
    reason = _REASON.search(source, comment.start(3), comment.end(3))
    end = reason.start() if reason else comment.end(3)
    codes: list[CodeName] = []
    faults: list[DirectiveFault] = []
    for found in _WORD.finditer(source, comment.start(3), end):
        text = found[0].decode("utf-8", "replace")
        if fault := _code_fault(text, found.start()):
            faults.append(fault)
        else:
            codes.append(CodeName(text, *found.span()))
        if not _LIKE_A_CODE.fullmatch(text):
            break  # a reason without a dash is one fault
    if not codes and not faults:
        faults.append(DirectiveFault(comment.start(), "there is no code in it"))
    return codes, faults


def _code_fault(text: str, start: int) -> DirectiveFault | None:
    """Return why a comment cannot suppress a code, or None."""
    if text in ALWAYS_REPORTED:
        return DirectiveFault(start, f"no comment can suppress {text}", "remove it")
    if text in RULES:
        return None
    if code := names_to_codes(RULES).get(text):
        return DirectiveFault(start, f"{text!r} is a rule's name, not its code", f"write {code}")
    if not _LIKE_A_CODE.fullmatch(text):
        return DirectiveFault(
            start, f"{text!r} is not a code", "put a dash before a reason: CODE - reason"
        )
    if any(code.startswith(text.upper()) for code in RULES) and text.upper() not in RULES:
        return DirectiveFault(start, f"{text!r} is not a whole code", "write whole codes")
    near = nearest(text.upper(), RULES)
    return DirectiveFault(
        start, f"no rule has the code {text!r}", f"did you mean {near}?" if near else _HOW
    )


def _elements_below(
    source: bytes, parts: Sequence[TagPart], ends: Mapping[int, int]
) -> list[tuple[int, int] | None]:
    """Return for each part the element that comes next, with nothing but comments in between."""
    below: list[tuple[int, int] | None] = [None] * len(parts)
    for at in range(len(parts) - 2, -1, -1):
        part = parts[at + 1]
        if part.kind in (_CLOSE, _OTHER) or source[parts[at].end : part.start].strip():
            continue
        element = part.start, ends.get(at + 1, part.end)
        below[at] = below[at + 1] if part.kind == _COMMENT else element
    return below


def _has_its_lines(source: bytes, comment: TagPart, last: int) -> bool:
    """Return whether a comment is alone on its lines; ``last`` is the end of the part before it."""
    before = source[last : comment.start].rpartition(b"\n")
    begins = not before[2].strip() and (bool(before[1]) or last == 0)
    return begins and _LINE_END.match(source, comment.end) is not None


def _checked_place(it: Directive, tags: Sequence[TagPart]) -> Directive:
    """Return the comment; an ignore-file below the root's first child gets a fault and no codes."""
    if it.word != IGNORE_FILE or len(tags) < 2 or it.start < tags[1].start:
        return it
    late = DirectiveFault(
        it.start, f"{IGNORE_FILE} is after the first element", "move it to the top"
    )
    return it._replace(codes=(), faults=(*it.faults, late))


def _is_idle(it: Directive, tags: Sequence[TagPart], before: int) -> bool:
    """Return whether no element is below the comment, and no tag or text on its lines."""
    last = bisect_left(tags, it.lines[1], key=lambda tag: tag.start) - 1
    on_the_lines = last >= 0 and tags[last].end > it.lines[0]
    return not it.element and not on_the_lines and before != _OPEN


def _overlaps(it: Directive, reached: tuple[list[int], list[int]]) -> bool:
    """Return whether what the comment is about is in one of the spans, at least in part."""
    starts, ends = reached
    if it.word == IGNORE_FILE:
        return bool(starts)
    begin, end = it.element or (it.start, it.end)
    before = bisect_left(starts, end)
    return before > 0 and ends[before - 1] > begin
