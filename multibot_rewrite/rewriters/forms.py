"""Where inside a value the names are: one function per ``form=`` word of the vocabulary.

A form maps a value to its parts. Because a part is a position and not a new text, lists, scopes
and remap rules need no writer of their own.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from multibot_rewrite.rosnames import parse_remap


class Part(NamedTuple):
    """One name inside a value: its text, where it starts, and the kinds it may be."""

    at: int
    text: str
    kinds: tuple[str, ...]


Form = Callable[[str, tuple[str, ...]], tuple[Part, ...]]


def whole(value: str, kinds: tuple[str, ...]) -> tuple[Part, ...]:
    """The value is one name, white space around it aside."""
    name = value.strip()
    if name == value:
        return (Part(0, name, kinds),) if name else ()
    return (Part(value.index(name), name, kinds),) if name else ()


def listed(value: str, kinds: tuple[str, ...]) -> tuple[Part, ...]:
    """Names separated by commas or white space."""
    parts = []
    at = 0
    for name in value.replace(",", " ").split():
        at = value.index(name, at)
        parts.append(Part(at, name, kinds))
        at += len(name)
    return tuple(parts)


def scoped(value: str, kinds: tuple[str, ...]) -> tuple[Part, ...]:
    """``model::link``: the last piece is the name, the ones before it are models."""
    parts = []
    at = len(value) - len(value.lstrip())
    pieces = value.strip().split("::")
    for number, name in enumerate(pieces, 1):
        if name:
            parts.append(Part(at, name, kinds if number == len(pieces) else ("model",)))
        at += len(name) + 2
    return tuple(parts)


def remap(value: str, kinds: tuple[str, ...]) -> tuple[Part, ...]:
    """``[node:]from:=to``: ``from`` is the consumer's own word, ``to`` is the name in the graph."""
    lead = len(value) - len(value.lstrip())
    rule = parse_remap(value.strip())
    if rule is None:
        return ()
    parts = [Part(lead, rule.node, ("node",))] if rule.node else []
    special = {"__node": ("node",), "__name": ("node",), "__ns": ("namespace",)}
    parts.append(Part(lead + rule.target_at, rule.target, special.get(rule.source, kinds)))
    return tuple(parts)


def nothing(value: str, kinds: tuple[str, ...]) -> tuple[Part, ...]:
    """Handled by code of its own (contact collisions)."""
    return ()


FORMS: dict[str, Form] = {
    "whole": whole,
    "list": listed,
    "scoped": scoped,
    "prefix": whole,
    "remap": remap,
    "argument": remap,
    "collision": nothing,
}
