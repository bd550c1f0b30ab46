"""The schema as data: what parsers of URDF look for in each element, read from ``urdf.schema``.

Many elements have the same attributes and children, so what the schema says about a combination is
computed once and then looked up.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

from lxml import etree

from multibot_rewrite.lint.schema.values import FINE

_FILE = Path(__file__).parent / "urdf.schema"
ROBOT = "robot"
# Combinations longer than this are not worth remembering: the children of <robot>.
_FEW = 40


class Kind(NamedTuple):
    """What an attribute must hold: a type of ``urdf.schema``, or one of ``choices``."""

    type: str
    required: bool
    choices: tuple[str, ...]


class Child(NamedTuple):
    """A child: its section, empty where its content is not checked, and how often it may come."""

    section: str
    times: str


class Section(NamedTuple):
    """One element of the schema."""

    name: str
    attributes: Mapping[str, Kind]
    children: Mapping[str, Child]
    text: bool


class Schema(NamedTuple):
    """All of ``urdf.schema``: every tag in it, and the sections that must have a
    child (``parents``)."""

    sections: Mapping[str, Section]
    tags: frozenset[str]
    parents: frozenset[str]


@lru_cache
def schema() -> Schema:
    """The schema, read once."""
    sections = _sections(_FILE.read_text(encoding="utf-8").splitlines())
    tags = frozenset(tag for it in sections.values() for tag in it.children)
    parents = frozenset(name for name, it in sections.items() if _needs_a_child(it))
    return Schema(sections, tags, parents)


def _needs_a_child(section: Section) -> bool:
    return any(it.times == "required" for it in section.children.values())


def _sections(lines: Iterable[str]) -> Mapping[str, Section]:
    found: dict[str, Section] = {}
    attributes: dict[str, Kind] = {}
    children: dict[str, Child] = {}
    name = ""
    for line in lines:
        head, *words = line.partition("#")[0].split() or [""]
        if head.startswith("["):
            name, attributes, children = head.strip("[]"), {}, {}
            found[name] = Section(name, attributes, children, False)
        elif head == "text":
            found[name] = found[name]._replace(text=True)
        elif head.startswith("@"):
            attributes[head[1:]] = _kind(words)
        elif head:
            children[head] = _child(head, words)
    return found


def _kind(words: Sequence[str]) -> Kind:
    choices = next((it[4:].split("|") for it in words if it.startswith("one:")), [])
    types = [it for it in words if it in FINE]
    return Kind(types[0] if types else "one" * bool(choices), "required" in words, tuple(choices))


def _child(tag: str, words: Sequence[str]) -> Child:
    section = next((it[1:] for it in words if it.startswith("=")), tag)
    times = next(it for it in words if it in ("required", "once", "many", "either"))
    return Child("" if "open" in words else section, times)


def is_own(name: object) -> bool:
    """Is it a tag or attribute of URDF: no comment, nothing in another program's namespace?"""
    return isinstance(name, str) and "{" not in name and ":" not in name


def section_of(element: etree._Element) -> Section | None:
    """The section of the schema that an element of a document belongs to."""
    parent = element.getparent()
    path = [element]
    while parent is not None:
        path.append(parent)
        parent = parent.getparent()
    name = ROBOT
    for it in path[-2::-1]:
        child = schema().sections[name].children.get(str(it.tag))
        if child is None or not child.section:
            return None
        name = child.section
    return schema().sections[name]


@lru_cache(maxsize=2048)
def typed_attributes(name: str, keys: tuple[str, ...]) -> tuple[tuple[int, str], ...] | None:
    """Which attributes have a type, and which; None where one of them is unknown or missing."""
    known = schema().sections[name].attributes
    if any(key not in known and key != "name" and is_own(key) for key in keys):
        return None
    if any(kind.required and key not in keys for key, kind in known.items()):
        return None
    types = [known[key].type if key in known else "" for key in keys]
    return tuple((at, kind) for at, kind in enumerate(types) if kind)


def sections_below(name: str, tags: tuple[str, ...]) -> tuple[str, ...] | None:
    """The sections of children, empty where not checked; None where the children have a fault."""
    return _known_below(name, tags) if len(tags) < _FEW else _below(name, tags)


def _below(name: str, tags: tuple[str, ...]) -> tuple[str, ...] | None:
    known = schema().sections[name].children
    count = {tag: times for tag, times in Counter(tags).items() if is_own(tag)}
    if any(tag not in known for tag in count):
        return None
    if any(child.times == "required" and tag not in count for tag, child in known.items()):
        return None
    single = [tag for tag in count if known[tag].times != "many"]
    slots = {_slot(tag, known[tag]) for tag in single}
    if len(slots) < sum(count[tag] for tag in single):
        return None
    sections = {tag: known[tag].section for tag in count}
    return tuple([sections.get(tag, "") for tag in tags])


_known_below = lru_cache(maxsize=2048)(_below)


def sections_once(name: str, tags: tuple[str, ...]) -> tuple[str, ...]:
    """The section of each child; empty from the second one on where one is read."""
    known = schema().sections[name].children
    seen: set[str] = set()
    found: list[str] = []
    for tag in tags:
        child = known.get(tag)
        key = "" if child is None or child.times == "many" else _slot(tag, child)
        found.append(child.section if child is not None and key not in seen else "")
        seen |= {key} if key else set()
    return tuple(found)


def _slot(tag: str, child: Child) -> str:
    """The place that a child which is read once takes: all shapes share one."""
    return child.times if child.times == "either" else tag
