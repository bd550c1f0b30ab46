"""The names of a xacro source by the macro they are written in, and the prefixes it takes."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.lazy import regex

# What people call what stands in front of a robot's names.
PREFIX = regex(r"(?:\w+_)?(?:prefix|namespace)|ns|robot_ns|robot_name")
_PARAM = regex(r"\*{0,2}([A-Za-z_]\w*)(?::?=(?:'[^']*'|\"[^\"]*\"|\S*))?")
SUBSTITUTIONS = regex(r"\$\{([^}]*)\}|\$\(arg\s+([^)\s]+)\s*\)")
_LITERAL = regex(r"'[^']*'|\"[^\"]*\"")
_WORD = regex(r"[A-Za-z_]\w*")
# Tag -> the attribute that refers to a link or joint; empty for the text.
_REFERENCES = {
    "parent": "link",
    "child": "link",
    "mimic": "joint",
    "gazebo": "reference",
    "left_joint": "",
    "right_joint": "",
    "leftJoint": "",
    "rightJoint": "",
    "joint_name": "",
    "jointName": "",
    "link_name": "",
    "linkName": "",
    "frame_name": "",
    "frameName": "",
    "body_name": "",
    "bodyName": "",
    "robot_base_frame": "",
    "robotBaseFrame": "",
    "child_frame_id": "",
    "gz_frame_id": "",
    "ignition_frame_id": "",
}


class WrittenName(NamedTuple):
    """A name as written: the attribute it stands in (empty for text), and its holes' names."""

    element: _Element
    attribute: str
    text: str
    words: frozenset[str]


class Scope(NamedTuple):
    """What stands in one macro, or outside of all of them (``macro`` is None then)."""

    macro: _Element | None
    carriers: frozenset[str]
    declared: list[WrittenName]
    used: list[WrittenName]


def scopes(root: _Element) -> list[Scope]:
    arguments = [it.get("name", "") for it in root.iter("{*}arg") if is_xacro(it)]
    given = frozenset(prefixes(arguments))
    macros = [it for it in root.iter("{*}macro") if is_xacro(it)]
    own = {it: given | frozenset(prefixes(parameters(it))) for it in macros}
    if not given and not any(own.values()):
        return []
    makes = _made_from(root)
    carriers = {names: _carriers(names, makes) for names in {given, *own.values()}}
    scopes: dict[_Element | None, Scope] = {}
    for element in root.iter("link", "joint", *_REFERENCES):
        home = next((it for it in element.iterancestors("{*}macro") if is_xacro(it)), None)
        scope = scopes.get(home)
        if scope is None:
            names = given if home is None else own[home]
            scope = scopes[home] = Scope(home, carriers[names], [], [])
        _add(scope, element)
    return list(scopes.values())


def _add(scope: Scope, element: _Element) -> None:
    tag = str(element.tag)
    if tag in ("link", "joint"):
        declares = _declares(element)
        name = element.get("name")
        if name:
            (scope.declared if declares else scope.used).append(_name_at(element, "name", name))
        return
    attribute = _REFERENCES[tag]
    value = element.get(attribute) if attribute else element.text
    if value and value.strip():
        scope.used.append(_name_at(element, attribute, value.strip()))


def _declares(element: _Element) -> bool:
    """A link or joint of the robot itself, inside nothing but the robot and xacro's elements."""
    if element.tag == "joint" and element.find("parent") is None:
        return False
    above = element.getparent()
    return above is not None and (above.tag == "robot" or is_xacro(above))


def _name_at(element: _Element, attribute: str, text: str) -> WrittenName:
    return WrittenName(
        element, attribute, text, frozenset(_names_in(text)) if "$" in text else frozenset()
    )


def _names_in(text: str) -> Iterator[str]:
    """The names in all substitutions of a text, ``$`` for those that hold none of them."""
    for expression, argument in SUBSTITUTIONS.findall(text):
        yield from [argument] if argument else _WORD.findall(_LITERAL.sub("", expression))
    yield "$"


def without_substitutions(name: WrittenName) -> str:
    return SUBSTITUTIONS.sub("", name.text)


def _made_from(root: _Element) -> Mapping[str, list[str]]:
    """For each name the properties whose values it is in."""
    makes: defaultdict[str, list[str]] = defaultdict(list)
    for it in root.iter("{*}property"):
        value = it.get("value", "")
        for word in set(_names_in(value)) if "$" in value and is_xacro(it) else ():
            makes[word].append(it.get("name", ""))
    makes.pop("$", None)
    return makes


def _carriers(names: frozenset[str], makes: Mapping[str, list[str]]) -> frozenset[str]:
    """These names, and the properties made from them."""
    found, waiting = set(names), list(names)
    while waiting:
        new = set(makes.get(waiting.pop(), ())) - found
        found |= new
        waiting += new
    return frozenset(found)


def parameters(macro: _Element) -> list[str]:
    return [it[1] for it in _PARAM.finditer(macro.get("params", ""))]


def prefixes(names: list[str]) -> list[str]:
    return [it for it in names if PREFIX.fullmatch(it)]


def is_xacro(element: _Element) -> bool:
    tag = element.tag
    return isinstance(tag, str) and "xacro}" in tag


def words_of(top: _Element) -> frozenset[str]:
    """The names in all substitutions and conditions below an element."""
    words: set[str] = set()
    for it in top.iterdescendants("*"):
        for value in (*it.values(), it.text or "", it.tail or ""):
            if "$" in value:
                words.update(_names_in(str(value)))
        if is_xacro(it):
            words.update(_WORD.findall(it.get("value", "")))
    return frozenset(words)
