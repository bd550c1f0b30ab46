"""Where inside a value the names are: one function per ``form=`` word of the vocabulary.

A form maps a value to its parts. Because a part is a position and not a new text, lists, scopes
and remap rules need no writer of their own.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from typing import NamedTuple

from multibot_rewrite.model import Claim
from multibot_rewrite.rosnames import parse_remap

Declared = Mapping[str, Mapping[str, Claim]]
Kinds = tuple[str, ...]
# What a top-level "|" of a regular expression must not be looked for in.
_REGEX_PIECES = re.compile(r"\\.|\[\^?\]?(?:\\.|[^\]])*\]|.", re.DOTALL)


class Part(NamedTuple):
    """One name inside a value: its text, where it starts, and the kinds it may be.

    ``closed`` tells that the file itself must declare it, whatever the kind; ``matched`` is the
    kind of the declared names that it matches, being a pattern.
    """

    at: int
    text: str
    kinds: Kinds
    closed: bool = False
    matched: Kinds = ()


Form = Callable[[str, Kinds, Declared], tuple[Part, ...]]


def whole(value: str, kinds: Kinds, declared: Declared) -> tuple[Part, ...]:
    """The value is one name, white space around it aside."""
    name = value.strip()
    if name == value:
        return (Part(0, name, kinds),) if name else ()
    return (Part(value.index(name), name, kinds),) if name else ()


def prefixed(value: str, kinds: Kinds, declared: Declared) -> tuple[Part, ...]:
    """What the consumer puts in front of names, nothing at all included."""
    name = value.strip()
    return (Part(value.index(name), name, kinds),)


def listed(value: str, kinds: Kinds, declared: Declared) -> tuple[Part, ...]:
    """Names separated by commas or white space."""
    parts = []
    at = 0
    for name in value.replace(",", " ").split():
        at = value.index(name, at)
        parts.append(Part(at, name, kinds))
        at += len(name)
    return tuple(parts)


def scoped(value: str, kinds: Kinds, declared: Declared) -> tuple[Part, ...]:
    """SDF's ``model::link``: the last piece is the name, the ones before it are models.

    No part where the first model is none of this file, and none behind an included model: what
    they hold is named elsewhere.
    """
    pieces = list(_pieces(value))
    if len(pieces) > 1 and pieces[0][1] not in declared["model"]:
        return ()
    scopes = []
    for at, name in pieces[:-1]:
        scopes.append(Part(at, name, ("model",), True))
        if is_included(name, declared):
            return tuple(scopes)
    return (*scopes, *(Part(at, name, kinds, True) for at, name in pieces[-1:]))


def is_included(model: str, declared: Declared) -> bool:
    """Does another file describe this model? Its ``<include>`` only names it."""
    claim = declared["model"].get(model)
    return claim is not None and not claim.attribute


def _pieces(value: str) -> Iterator[tuple[int, str]]:
    at = len(value) - len(value.lstrip())
    for name in value.strip().split("::"):
        if name:
            yield at, name
        at += len(name) + 2


def suffixed(value: str, kinds: Kinds, declared: Declared) -> tuple[Part, ...]:
    """``link/light``: a declared name, the longest there is, and what the consumer adds to it."""
    at = len(value) - len(value.lstrip())
    text = value.strip()
    cuts = [n for n, mark in enumerate(text) if mark == "/"]
    for cut in (len(text), *reversed(cuts)):
        if any(text[:cut] in declared.get(kind, ()) for kind in kinds):
            return (Part(at, text[:cut], kinds),)
    return (Part(at, text[: cuts[0]] if cuts else text, kinds),) if text else ()


def regex(value: str, kinds: Kinds, declared: Declared) -> tuple[Part, ...]:
    """A regular expression for whole names: each alternative is affixed inside its anchors."""
    found = ((at, text, _matched(text, kinds, declared)) for at, text in _alternatives(value))
    return tuple(Part(at, text, kinds, True, matched[:1]) for at, text, matched in found if text)


def _alternatives(value: str) -> Iterator[tuple[int, str]]:
    """The pieces between top-level bars, anchors and white space aside, and where they start."""
    depth, begin = 0, 0
    bars = []
    for piece in _REGEX_PIECES.finditer(value):
        depth += {"(": 1, ")": -1}.get(piece[0], 0)
        if piece[0] == "|" and depth == 0:
            bars.append(piece.start())
    for end in (*bars, len(value)):
        text = value[begin:end]
        lead = len(text) - len(text.lstrip().removeprefix("^"))
        yield begin + lead, text[lead:].rstrip().removesuffix("$")
        begin = end + 1


def _matched(pattern: str, kinds: Kinds, declared: Declared) -> tuple[str, ...]:
    """The kinds of which the pattern matches a declared name."""
    try:
        matches = re.compile(pattern).fullmatch
    except re.error:
        return ()
    return tuple(kind for kind in kinds if any(map(matches, declared.get(kind, ()))))


def remap(value: str, kinds: Kinds, declared: Declared) -> tuple[Part, ...]:
    """``[node:]from:=to``: ``from`` is the consumer's own word, ``to`` is the name in the graph."""
    lead = len(value) - len(value.lstrip())
    rule = parse_remap(value.strip())
    if rule is None:
        return ()
    parts = [Part(lead, rule.node, ("node",))] if rule.node else []
    special = {"__node": ("node",), "__name": ("node",), "__ns": ("namespace",)}
    parts.append(Part(lead + rule.target_at, rule.target, special.get(rule.source, kinds)))
    return tuple(parts)


def nothing(value: str, kinds: Kinds, declared: Declared) -> tuple[Part, ...]:
    """Handled by code of its own (contact collisions)."""
    return ()


FORMS: dict[str, Form] = {
    "whole": whole,
    "list": listed,
    "scoped": scoped,
    "suffixed": suffixed,
    "regex": regex,
    "prefix": prefixed,
    "remap": remap,
    "argument": remap,
    "collision": nothing,
}
