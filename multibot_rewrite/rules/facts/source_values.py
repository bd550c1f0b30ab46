# SPDX-License-Identifier: Apache-2.0
"""How a value was written before xacro expanded it, and whether a caller can set it for each robot."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Collection, Mapping
from typing import TYPE_CHECKING

from lxml.etree import _Element

from multibot_rewrite.base.lazy import IN_EXPRESSION, lazy_compile
from multibot_rewrite.base.model import Claim
from multibot_rewrite.description.steps.document import tag_end
from multibot_rewrite.rules.subject import Subject

if TYPE_CHECKING:
    from multibot_rewrite.description.sources.trace import WrittenAt

_ATTRIBUTE = lazy_compile(rb"\s([\w:.-]+)\s*=\s*(?:\"([^\"]*)\"|'([^']*)')")
# What is the same text for every caller.
_CONSTANT = lazy_compile(rb"\$\((?:find [^()]*|dirname|env [^()]*)\)|\$\$")
_EXPRESSION = lazy_compile(rf"\$\{{({IN_EXPRESSION})\}}".encode())
_LITERAL = lazy_compile(rb"'[^']*'|\"[^\"]*\"|&quot;.*?&quot;")
_NAME = lazy_compile(rb"[A-Za-z_]\w*")
_OF_ARGUMENT = lazy_compile(
    rb"<xacro:property\s+name=[\"'](\w+)[\"']\s+value=[\"'][^<\"']*\$\(arg "
)


def claim_is_fixed(subject: Subject, claim: Claim) -> bool:
    """Return whether a claimed value is the same for every robot, whatever xacro is given."""
    return is_fixed(subject, claim.start, claim.attribute)


def starts_of(subject: Subject, elements: Collection[_Element]) -> Mapping[_Element, int]:
    """Return by element where its tag starts."""
    wanted = set(elements)
    every = zip(subject.document.elements, subject.document.starts, strict=True)
    return {element: start for element, start in every if element in wanted} if wanted else {}


def is_fixed(subject: Subject, start: int, attribute: str, *, constants: bool = True) -> bool:
    """Return whether no caller of xacro can set another value; False where that is unknown.

    ``start`` is that of the element's tag; ``attribute`` is empty for text. With ``constants``
    $(find ...) and the like count as text."""
    if not subject.origins:
        return True
    origin = subject.origins.of(bisect_left(subject.document.starts, start))
    if origin is None:
        return False
    raw = _raw_value(subject.sources[origin.file], origin.start, attribute)
    if raw is not None and constants:
        raw = _CONSTANT.sub(b"", raw)
    for call in origin.calls:
        if raw is None or b"$" not in raw:
            break
        raw = _passed_value(raw, _attributes(subject.sources[call.file], call.start))
    return raw is not None and b"$" not in raw


def is_argument(sources: Mapping[str, bytes], origin: WrittenAt, attribute: str) -> bool:
    """Return whether a value comes in part from a caller of xacro, as $(arg ...)."""
    raw = _raw_value(sources[origin.file], origin.start, attribute) or b""
    for call in origin.calls:
        if b"$(arg" in raw:
            return True
        given = _attributes(sources[call.file], call.start)
        raw = b" ".join(given.get(name, b"${%s}" % name) for name in _names_in(raw))
    made = {it for text in sources.values() for it in _OF_ARGUMENT.findall(text)}
    return b"$(arg" in raw or not made.isdisjoint(_names_in(raw))


def _names_in(raw: bytes) -> list[bytes]:
    words = [_LITERAL.sub(b"", it) for it in _EXPRESSION.findall(raw)]
    return [name for word in words for name in _NAME.findall(word)]


def _raw_value(source: bytes, start: int, attribute: str) -> bytes | None:
    if attribute:
        return _attributes(source, start).get(attribute.encode())
    end = tag_end(source, start)
    return source[end : source.find(b"<", end)]


def _passed_value(raw: bytes, call: Mapping[bytes, bytes]) -> bytes | None:
    """Return what a macro's call passes for the names in ``raw``; None if it does not pass one."""
    if b"$(" in raw:
        return None
    names = _names_in(raw)
    if not names or any(name not in call for name in names):
        return None
    return _CONSTANT.sub(b"", b" ".join(call[name] for name in names))


def _attributes(source: bytes, start: int) -> dict[bytes, bytes]:
    tag = source[start : tag_end(source, start)]
    return {it[1]: it[2] if it[2] is not None else it[3] for it in _ATTRIBUTE.finditer(tag)}
