# SPDX-License-Identifier: Apache-2.0
"""Prefixes that a xacro macro or file takes: names that lack them, and unused ones."""

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.base.conventions import WORLD_FRAMES
from multibot_rewrite.base.findings.finding import WARNING, XACRO, rule
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.lazy import IN_EXPRESSION, lazy_compile
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.subject import Subject

# What people call the parameter that is put in front of a robot's names.
PREFIX = lazy_compile(r"(?:\w+_)?(?:prefix|namespace)|ns|robot_ns|robot_name")
_PARAM = lazy_compile(r"\*{0,2}([A-Za-z_]\w*)(?::?=(?:'[^']*'|\"[^\"]*\"|\S*))?")
SUBSTITUTIONS = lazy_compile(rf"\$\{{({IN_EXPRESSION})\}}|\$\(arg\s+([^)\s]+)\s*\)")
_LITERAL = lazy_compile(r"'[^']*'|\"[^\"]*\"")
_WORD = lazy_compile(r"[A-Za-z_]\w*")
# Tag -> the attribute that refers to a link or joint; empty for the text.
_REFERENCES = {
    **{"parent": "link", "child": "link", "mimic": "joint", "gazebo": "reference"},
    **dict.fromkeys(("left_joint", "right_joint", "leftJoint", "rightJoint"), ""),
    **dict.fromkeys(("joint_name", "jointName", "link_name", "linkName"), ""),
    **dict.fromkeys(("frame_name", "frameName", "body_name", "bodyName"), ""),
    **dict.fromkeys(("robot_base_frame", "robotBaseFrame", "child_frame_id"), ""),
    **dict.fromkeys(("gz_frame_id", "ignition_frame_id"), ""),
}


class WrittenName(NamedTuple):
    """A name in the source: its attribute (empty for text), and the names in its substitutions."""

    element: _Element
    attribute: str
    text: str
    words: frozenset[str]


class Scope(NamedTuple):
    """The names in one macro, or outside of all of them (``macro`` is None then).

    ``prefix_names`` are its prefixes and the properties made from them."""

    macro: _Element | None
    prefix_names: frozenset[str]
    declared: list[WrittenName]
    used: list[WrittenName]


def scopes(root: _Element) -> list[Scope]:
    """Return the macros of a file, and what is outside of them; empty where nothing takes a prefix."""
    arguments = [it.get("name", "") for it in root.iter("{*}arg") if is_xacro(it)]
    given = frozenset(prefixes(arguments))
    macros = [it for it in root.iter("{*}macro") if is_xacro(it)]
    own = {it: given | frozenset(prefixes(parameters(it))) for it in macros}
    if not given and not any(own.values()):
        return []
    users = _properties_by_name(root)
    prefix_names = {names: _with_properties(names, users) for names in {given, *own.values()}}
    found: dict[_Element | None, Scope] = {}
    for element in root.iter("link", "joint", *_REFERENCES):
        home = next((it for it in element.iterancestors("{*}macro") if is_xacro(it)), None)
        scope = found.get(home)
        if scope is None:
            names = given if home is None else own[home]
            scope = found[home] = Scope(home, prefix_names[names], [], [])
        tag = str(element.tag)
        if tag in ("link", "joint"):
            declares = _declares(element)
            if name := element.get("name"):
                (scope.declared if declares else scope.used).append(
                    _written_name(element, "name", name)
                )
            continue
        attribute = _REFERENCES[tag]
        value = element.get(attribute) if attribute else element.text
        if value and value.strip():
            scope.used.append(_written_name(element, attribute, value.strip()))
    return list(found.values())


def _declares(element: _Element) -> bool:
    """Return whether an element is a link or joint right below the robot or an element of xacro."""
    if element.tag == "joint" and element.find("parent") is None:
        return False
    above = element.getparent()
    return above is not None and (above.tag == "robot" or is_xacro(above))


def _written_name(element: _Element, attribute: str, text: str) -> WrittenName:
    words = frozenset(_names_in(text) if "$" in text else ())
    return WrittenName(element, attribute, text, words)


def _names_in(text: str) -> Iterator[str]:
    """Yield the names in all substitutions of a text, and ``$`` for substitutions without a name."""
    for expression, argument in SUBSTITUTIONS.findall(text):
        yield from [argument] if argument else _WORD.findall(_LITERAL.sub("", expression))
    yield "$"


def _properties_by_name(root: _Element) -> Mapping[str, list[str]]:
    """Return by name the properties whose values use it."""
    every = ((it, it.get("value", "")) for it in root.iter("{*}property"))
    made = ((it, value) for it, value in every if "$" in value and is_xacro(it))
    users = lists_by_key(
        (word, it.get("name", "")) for it, value in made for word in set(_names_in(value))
    )
    users.pop("$", None)
    return users


def _with_properties(names: frozenset[str], users: Mapping[str, list[str]]) -> frozenset[str]:
    """Return these names and the properties made from them."""
    found, waiting = set(names), list(names)
    while waiting:
        new = set(users.get(waiting.pop(), ())) - found
        found |= new
        waiting += new
    return frozenset(found)


def parameters(macro: _Element) -> list[str]:
    """Return the names of a macro's parameters."""
    return [it[1] for it in _PARAM.finditer(macro.get("params", ""))]


def prefixes(names: list[str]) -> list[str]:
    """Return those of the names that people use for a prefix."""
    return [it for it in names if PREFIX.fullmatch(it)]


def is_xacro(element: _Element) -> bool:
    """Return whether an element is one of xacro, which goes by the prefix alone."""
    return element.prefix == "xacro"


def names_below(top: _Element) -> frozenset[str]:
    """Return the names in all substitutions and conditions below an element."""
    words: set[str] = set()
    for it in top.iterdescendants("*"):
        for value in (*it.values(), it.text or "", it.tail or ""):
            if "$" in value:
                words.update(_names_in(str(value)))
        if is_xacro(it):
            words.update(_WORD.findall(it.get("value", "")))
    return frozenset(words)


# The elements of xacro itself: all others call a macro.
_BUILTIN = frozenset(
    {
        *("macro", "arg", "property", "include", "if", "unless"),
        *("insert_block", "element", "attribute", "call"),
    }
)


@rule("MB417", "prefix-forgotten", WARNING, formats=(XACRO,))
def prefix_forgotten(subject: Subject) -> Iterator[Problem]:
    """Report literal names where others have the prefix, and literal uses of names that have it."""
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
    """Report parameters and arguments that nothing in the file reads, and no included file can."""
    root = subject.document.root
    for macro in root.iter("{*}macro"):
        names = prefixes(parameters(macro)) if is_xacro(macro) else []
        if names and not _calls_others(macro):
            read = names_below(macro)
            for name in names:
                if name not in read and macro.find(".//link") is not None:
                    message = f"macro {macro.get('name', '')!r} takes {name!r} and does not use it"
                    yield Problem(macro, message, "params", "put it in front of the names")
    # An included file sees the arguments too, so a file with includes is left alone.
    if any(is_xacro(it) for it in root.iter("{*}include")) or root.find(".//link") is None:
        return
    arguments = [it for it in root.iter("{*}arg") if is_xacro(it)]
    read = names_below(root) if arguments else frozenset()
    for element in arguments:
        name = element.get("name", "")
        if PREFIX.fullmatch(name) and name not in read:
            message = f"argument {name!r} is declared and not used"
            yield Problem(element, message, "name", "put it in front of the names")


def _forgotten(scope: Scope, declared: list[WrittenName]) -> Iterator[Problem]:
    """Report literal names, where most links (joints) have the prefix."""
    bare = [it for it in declared if not it.words and it.text.strip("/") not in WORLD_FRAMES]
    prefixed = sum(1 for it in declared if it.words & scope.prefix_names)
    owner = "this file" if scope.macro is None else f"macro {scope.macro.get('name', '')!r}"
    for it in bare if prefixed >= len(bare) else ():
        message = (
            f"{it.element.tag} {it.text!r} lacks the prefix that {prefixed} other "
            f"{it.element.tag}s of {owner} have"
        )
        yield Problem(it.element, message, it.attribute, _hint(scope, it.text))


def _calls_others(macro: _Element) -> bool:
    """Return whether a macro calls macros, which see the parameters of their caller."""
    inside = (it for it in macro.iterdescendants("{*}*") if is_xacro(it))
    return any(str(it.tag).rpartition("}")[2] not in _BUILTIN for it in inside)


def _hint(scope: Scope, text: str) -> str:
    """Return how to write a name with the prefix, as another name of the scope has it."""
    own = next((it for it in scope.declared if it.words & scope.prefix_names), None)
    found = SUBSTITUTIONS.search(own.text) if own else None
    return f"use {found[0] + text!r}" if found else "put the prefix in front"
