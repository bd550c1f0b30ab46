# SPDX-License-Identifier: Apache-2.0
"""Prefixes that a xacro macro or file takes: names that lack them, and unused ones."""

from __future__ import annotations

from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.base.conventions import WORLD_FRAMES
from multibot_rewrite.base.findings.finding import WARNING
from multibot_rewrite.base.findings.rule import XACRO, rule
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.description.multirobot.xacro_scopes import (
    PREFIX,
    SUBSTITUTIONS,
    Scope,
    WrittenName,
    is_xacro,
    parameters,
    prefixes,
    scopes,
    words_of,
)
from multibot_rewrite.rules.subject import Subject

# The elements of xacro itself: all others call a macro.
_BUILTIN = frozenset(
    {
        *("macro", "arg", "property", "include", "if", "unless"),
        *("insert_block", "element", "attribute", "call"),
    }
)


@rule("MB417", "prefix-forgotten", WARNING, formats=(XACRO,))
def prefix_forgotten(subject: Subject) -> Iterator[Problem]:
    """Literal names where others have the prefix, and literal uses of names that have it."""
    for scope in scopes(subject.document.root):
        for kind in ("link", "joint"):
            yield from _forgotten(scope, [it for it in scope.declared if it.element.tag == kind])
        stems = {
            SUBSTITUTIONS.sub("", it.text) for it in scope.declared if it.words & scope.prefix_names
        }
        bare = {it.text for it in scope.declared if not it.words}
        for it in scope.used if stems else ():
            if not it.words and it.text in stems and it.text not in bare:
                message = f"{it.text!r} has the prefix where it is declared, and lacks it here"
                yield Problem(it.element, message, it.attribute, _hint(scope, it.text))


@rule("MB418", "prefix-unused", WARNING, formats=(XACRO,))
def prefix_unused(subject: Subject) -> Iterator[Problem]:
    """Parameters and arguments that nothing in the file reads, and no included file can."""
    root = subject.document.root
    for macro in root.iter("{*}macro"):
        names = prefixes(parameters(macro)) if is_xacro(macro) else []
        if names and not _calls_others(macro):
            read = words_of(macro)
            for name in names:
                if name not in read and macro.find(".//link") is not None:
                    message = f"macro {macro.get('name', '')!r} takes {name!r} and does not use it"
                    yield Problem(macro, message, "params", "put it in front of the names")
    yield from _unused_arguments(root)


def _forgotten(scope: Scope, declared: list[WrittenName]) -> Iterator[Problem]:
    """Literal names, where most links (joints) have the prefix."""
    bare = [it for it in declared if not it.words and it.text.strip("/") not in WORLD_FRAMES]
    prefixed = sum(1 for it in declared if it.words & scope.prefix_names)
    for it in bare if prefixed >= len(bare) else ():
        message = (
            f"{it.element.tag} {it.text!r} lacks the prefix that {prefixed} other "
            f"{it.element.tag}s of {_of(scope)} have"
        )
        yield Problem(it.element, message, it.attribute, _hint(scope, it.text))


def _unused_arguments(root: _Element) -> Iterator[Problem]:
    """An included file sees the arguments too, so a file with includes is left alone."""
    if any(is_xacro(it) for it in root.iter("{*}include")) or root.find(".//link") is None:
        return
    arguments = [it for it in root.iter("{*}arg") if is_xacro(it)]
    read = words_of(root) if arguments else frozenset()
    for element in arguments:
        name = element.get("name", "")
        if PREFIX.fullmatch(name) and name not in read:
            message = f"argument {name!r} is declared and not used"
            yield Problem(element, message, "name", "put it in front of the names")


def _calls_others(macro: _Element) -> bool:
    """Does it call macros? They see the parameters of their caller."""
    inside = (it for it in macro.iterdescendants("{*}*") if is_xacro(it))
    return any(str(it.tag).rpartition("}")[2] not in _BUILTIN for it in inside)


def _of(scope: Scope) -> str:
    return "this file" if scope.macro is None else f"macro {scope.macro.get('name', '')!r}"


def _hint(scope: Scope, text: str) -> str:
    own = next((it for it in scope.declared if it.words & scope.prefix_names), None)
    found = SUBSTITUTIONS.search(own.text) if own else None
    return f"use {found[0] + text!r}" if found else "put the prefix in front"
