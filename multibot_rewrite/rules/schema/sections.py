# SPDX-License-Identifier: Apache-2.0
"""The schema as data: what parsers of URDF look for in each element, read from ``urdf.schema``.

A version of URDF has a schema of its own: what came later is in ``later``, and not read. Many elements
have the same attributes and children, so what a schema says about a combination is computed once and
then looked up.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from typing import NamedTuple

from lxml import etree

from multibot_rewrite.rules.schema.described import table_text
from multibot_rewrite.rules.schema.values import FINE
from multibot_rewrite.rules.schema.versions import OLDEST, Version, read_version

_FILE = "urdf.schema"
ROBOT = "robot"
NO_LATER: Mapping[str, Version] = {}


class Kind(NamedTuple):
    """What an attribute must hold: a type of ``urdf.schema``, or one of ``choices``.

    It is read from version ``since`` on, and not beside the attribute ``instead_of``. A number out of
    range is refused from version ``refused`` on.
    """

    type: str
    required: bool
    choices: tuple[str, ...]
    since: Version = OLDEST
    refused: Version = OLDEST
    instead_of: str = ""


class Child(NamedTuple):
    """A child: its section, empty where its content is not checked, and how often it may come.

    It is read from version ``since`` on.
    """

    section: str
    times: str
    since: Version = OLDEST


class UrdfPart(NamedTuple):
    """One element of the schema.

    ``later`` are the attributes (``@name``) and children that only later versions read.
    """

    name: str
    attributes: Mapping[str, Kind]
    children: Mapping[str, Child]
    text: bool
    later: Mapping[str, Version] = NO_LATER


class Schema(NamedTuple):
    """All of ``urdf.schema`` for a version: every tag in it, and the sections that must have a
    child (``parents``)."""

    version: Version
    sections: Mapping[str, UrdfPart]
    tags: frozenset[str]
    parents: frozenset[str]


@lru_cache
def schema(version: Version) -> Schema:
    """The schema of a version."""
    sections = {name: _of_version(it, version) for name, it in _all_sections().items()}
    tags = frozenset(tag for it in sections.values() for tag in it.children)
    parents = frozenset(name for name, it in sections.items() if _needs_a_child(it))
    return Schema(version, sections, tags, parents)


@lru_cache
def _all_sections() -> Mapping[str, UrdfPart]:
    return _sections(table_text(_FILE).splitlines())


def _of_version(section: UrdfPart, version: Version) -> UrdfPart:
    """A section as a version has it: what comes later has no type, nothing in it is checked."""
    attributes = {key: _kind_of_version(it, version) for key, it in section.attributes.items()}
    children = {
        tag: it if it.since <= version else it._replace(section="")
        for tag, it in section.children.items()
    }
    later = {f"@{key}": it.since for key, it in attributes.items() if it.since > version}
    later |= {tag: it.since for tag, it in children.items() if it.since > version}
    return section._replace(attributes=attributes, children=children, later=later)


def _kind_of_version(kind: Kind, version: Version) -> Kind:
    return kind._replace(type="", instead_of="") if kind.since > version else kind


def _needs_a_child(section: UrdfPart) -> bool:
    return any(it.times == "required" for it in section.children.values())


def _sections(lines: Iterable[str]) -> Mapping[str, UrdfPart]:
    found: dict[str, UrdfPart] = {}
    attributes: dict[str, Kind] = {}
    children: dict[str, Child] = {}
    name = ""
    for line in lines:
        head, *words = line.partition("#")[0].split() or [""]
        if head.startswith("["):
            name, attributes, children = head.strip("[]"), {}, {}
            found[name] = UrdfPart(name, attributes, children, False)
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
    return Kind(
        types[0] if types else "one" * bool(choices),
        "required" in words,
        tuple(choices),
        _version_behind("since:", words),
        _version_behind("refused:", words),
        next((it[11:] for it in words if it.startswith("instead-of:")), ""),
    )


def _version_behind(start: str, words: Sequence[str]) -> Version:
    found = (it.removeprefix(start) for it in words if it.startswith(start))
    return next(map(_version, found), OLDEST)


def _version(word: str) -> Version:
    found = read_version(word)
    assert found, f"{word} in {_FILE} is a version"
    return found


def _child(tag: str, words: Sequence[str]) -> Child:
    section = next((it[1:] for it in words if it.startswith("=")), tag)
    times = next(it for it in words if it in ("required", "once", "many", "either"))
    return Child("" if "open" in words else section, times, _version_behind("since:", words))


def is_own(name: object) -> bool:
    """Is it a tag or attribute of URDF: no comment, nothing in another program's namespace?"""
    return isinstance(name, str) and "{" not in name and ":" not in name


def section_of(element: etree._Element, known: Schema) -> UrdfPart | None:
    """The section of a schema that an element of a document belongs to."""
    parent = element.getparent()
    path = [element]
    while parent is not None:
        path.append(parent)
        parent = parent.getparent()
    name = ROBOT
    for it in path[-2::-1]:
        child = known.sections[name].children.get(str(it.tag))
        if child is None or not child.section:
            return None
        name = child.section
    return known.sections[name]


@lru_cache(maxsize=2048)
def typed_attributes(
    version: Version, name: str, keys: tuple[str, ...]
) -> tuple[tuple[int, Kind], ...] | None:
    """Which attributes have a type, and what they hold; None where one of them is a fault itself."""
    section = schema(version).sections[name]
    known = section.attributes
    if any(f"@{key}" in section.later for key in keys):
        return None
    if any(key in known and known[key].instead_of in keys for key in keys):
        return None
    if any(key not in known and key != "name" and is_own(key) for key in keys):
        return None
    if any(kind.required and key not in keys for key, kind in known.items()):
        return None
    return tuple(
        (at, known[key]) for at, key in enumerate(keys) if key in known and known[key].type
    )


@lru_cache(maxsize=2048)
def sections_below(version: Version, name: str, tags: tuple[str, ...]) -> tuple[str, ...] | None:
    """The sections of children, empty where not checked; None where the children have a fault."""
    section = schema(version).sections[name]
    known = section.children
    if any(tag in section.later for tag in tags):
        return None
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


def sections_once(version: Version, name: str, tags: tuple[str, ...]) -> tuple[str, ...]:
    """The section of each child; empty from the second one on where one is read."""
    known = schema(version).sections[name].children
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
