"""xacro sources: the prefix that a macro or file takes, and the names that lack it."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.lazy import lazy_compile
from multibot_rewrite.lint.records import Problem, Subject
from multibot_rewrite.naming import SHARED_FRAMES

# What people call what stands in front of a robot's names.
_PREFIX = lazy_compile(r"(?:\w+_)?(?:prefix|namespace)|ns|robot_ns|robot_name")
_PARAM = lazy_compile(r"\*{0,2}([A-Za-z_]\w*)(?::?=(?:'[^']*'|\"[^\"]*\"|\S*))?")
_HOLES = lazy_compile(r"\$\{([^}]*)\}|\$\(arg\s+([^)\s]+)\s*\)")
_LITERAL = lazy_compile(r"'[^']*'|\"[^\"]*\"")
_WORD = lazy_compile(r"[A-Za-z_]\w*")
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
# Elements of xacro that call no macro.
_BUILTIN = frozenset(
    {
        *("macro", "arg", "property", "include", "if", "unless"),
        *("insert_block", "element", "attribute", "call"),
    }
)


class Written(NamedTuple):
    """A name as written: the attribute it stands in (empty for text), and its holes' names."""

    element: _Element
    attribute: str
    text: str
    words: frozenset[str]


class Scope(NamedTuple):
    """What stands in one macro, or outside of all of them (``macro`` is None then)."""

    macro: _Element | None
    carriers: frozenset[str]
    declared: list[Written]
    used: list[Written]


def forgotten(subject: Subject) -> Iterator[Problem]:
    """Literal names in scopes where most have the prefix, and literal uses of names that have."""
    for scope in _scopes(subject.document.root):
        for kind in ("link", "joint"):
            yield from _forgotten(scope, [it for it in scope.declared if it.element.tag == kind])
        stems = {_stem(it) for it in scope.declared if it.words & scope.carriers}
        bare = {it.text for it in scope.declared if not it.words}
        for it in scope.used if stems else ():
            if not it.words and it.text in stems and it.text not in bare:
                message = f"{it.text!r} has the prefix where it is declared, and lacks it here"
                yield Problem(it.element, message, it.attribute, _hint(scope, it.text))


def _forgotten(scope: Scope, declared: list[Written]) -> Iterator[Problem]:
    """Where most links (joints) have the prefix: those that are nothing but text."""
    bare = [it for it in declared if not it.words and it.text.strip("/") not in SHARED_FRAMES]
    prefixed = sum(1 for it in declared if it.words & scope.carriers)
    for it in bare if prefixed >= len(bare) else ():
        message = (
            f"{it.element.tag} {it.text!r} lacks the prefix that {prefixed} other "
            f"{it.element.tag}s of {_of(scope)} have"
        )
        yield Problem(it.element, message, it.attribute, _hint(scope, it.text))


def unused(subject: Subject) -> Iterator[Problem]:
    """Prefix parameters of macros, and prefix arguments of the file, that nothing reads."""
    root = subject.document.root
    for macro in root.iter("{*}macro"):
        names = _prefixes(_parameters(macro)) if _is_xacro(macro) else []
        if names and not _calls_others(macro):
            read = _words_of(macro)
            for name in names:
                if name not in read and macro.find(".//link") is not None:
                    message = f"macro {macro.get('name', '')!r} takes {name!r} and uses it nowhere"
                    yield Problem(macro, message, "params", "put it in front of the names")
    yield from _unused_arguments(root)


def _unused_arguments(root: _Element) -> Iterator[Problem]:
    """An included file sees the arguments too, so a file with includes is left alone."""
    if any(_is_xacro(it) for it in root.iter("{*}include")) or root.find(".//link") is None:
        return
    arguments = [it for it in root.iter("{*}arg") if _is_xacro(it)]
    read = _words_of(root) if arguments else frozenset()
    for element in arguments:
        name = element.get("name", "")
        if _PREFIX.fullmatch(name) and name not in read:
            message = f"argument {name!r} is declared and used nowhere"
            yield Problem(element, message, "name", "put it in front of the names")


def _scopes(root: _Element) -> list[Scope]:
    arguments = [it.get("name", "") for it in root.iter("{*}arg") if _is_xacro(it)]
    given = frozenset(_prefixes(arguments))
    macros = [it for it in root.iter("{*}macro") if _is_xacro(it)]
    own = {it: given | frozenset(_prefixes(_parameters(it))) for it in macros}
    if not given and not any(own.values()):
        return []
    makes = _makes(root)
    carriers = {names: _carriers(names, makes) for names in {given, *own.values()}}
    scopes: dict[_Element | None, Scope] = {}
    for element in root.iter("link", "joint", *_REFERENCES):
        home = next((it for it in element.iterancestors("{*}macro") if _is_xacro(it)), None)
        scope = scopes.get(home)
        if scope is None:
            names = given if home is None else own[home]
            scope = scopes[home] = Scope(home, carriers[names], [], [])
        _sort_in(scope, element)
    return list(scopes.values())


def _sort_in(scope: Scope, element: _Element) -> None:
    tag = str(element.tag)
    if tag in ("link", "joint"):
        declares = _declares(element)
        name = element.get("name")
        if name:
            (scope.declared if declares else scope.used).append(_written(element, "name", name))
        return
    attribute = _REFERENCES[tag]
    value = element.get(attribute) if attribute else element.text
    if value and value.strip():
        scope.used.append(_written(element, attribute, value.strip()))


def _declares(element: _Element) -> bool:
    """A link or joint of the robot itself, inside nothing but the robot and xacro's elements."""
    if element.tag == "joint" and element.find("parent") is None:
        return False
    above = element.getparent()
    return above is not None and (above.tag == "robot" or _is_xacro(above))


def _written(element: _Element, attribute: str, text: str) -> Written:
    return Written(
        element, attribute, text, frozenset(_holes(text)) if "$" in text else frozenset()
    )


def _holes(text: str) -> Iterator[str]:
    """The names in all substitutions of a text, ``$`` for those that hold none of them."""
    for expression, argument in _HOLES.findall(text):
        yield from [argument] if argument else _WORD.findall(_LITERAL.sub("", expression))
    yield "$"


def _stem(name: Written) -> str:
    return _HOLES.sub("", name.text)


def _makes(root: _Element) -> Mapping[str, list[str]]:
    """For each name the properties whose values it is in."""
    makes: defaultdict[str, list[str]] = defaultdict(list)
    for it in root.iter("{*}property"):
        value = it.get("value", "")
        for word in set(_holes(value)) if "$" in value and _is_xacro(it) else ():
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


def _parameters(macro: _Element) -> list[str]:
    return [it[1] for it in _PARAM.finditer(macro.get("params", ""))]


def _prefixes(names: list[str]) -> list[str]:
    return [it for it in names if _PREFIX.fullmatch(it)]


def _is_xacro(element: _Element) -> bool:
    tag = element.tag
    return isinstance(tag, str) and "xacro}" in tag


def _calls_others(macro: _Element) -> bool:
    """A macro that is called sees what its caller was given."""
    inside = (it for it in macro.iterdescendants("{*}*") if _is_xacro(it))
    return any(str(it.tag).rpartition("}")[2] not in _BUILTIN for it in inside)


def _words_of(top: _Element) -> frozenset[str]:
    """The names in all substitutions and conditions below an element."""
    words: set[str] = set()
    for it in top.iterdescendants("*"):
        for value in (*it.values(), it.text or "", it.tail or ""):
            if "$" in value:
                words.update(_holes(str(value)))
        if _is_xacro(it):
            words.update(_WORD.findall(it.get("value", "")))
    return frozenset(words)


def _of(scope: Scope) -> str:
    return "this file" if scope.macro is None else f"macro {scope.macro.get('name', '')!r}"


def _hint(scope: Scope, text: str) -> str:
    own = next((it for it in scope.declared if it.words & scope.carriers), None)
    found = _HOLES.search(own.text) if own else None
    return f"write {found[0] + text!r}" if found else "put the prefix in front"
