# SPDX-License-Identifier: Apache-2.0
"""``urdf.schema`` as data: what parsers look for in each element and attribute, and faults of values.

A version of URDF has a schema of its own: what came later is in ``later``, and not read. Many
elements have the same attributes and children, so what a schema says about a combination is
computed once and then looked up."""

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from functools import lru_cache
from math import isfinite
from typing import NamedTuple

from lxml import etree

from multibot_rewrite.base.conventions import ROWS
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.rules.schema.described import table_text
from multibot_rewrite.rules.schema.versions import OLDEST, Version, read_version

_FILE = "urdf.schema"
ROBOT = "robot"
NO_LATER: Mapping[str, Version] = {}


class Kind(NamedTuple):
    """What an attribute must hold: a type of ``urdf.schema``, or one of ``choices``.

    It is read from version ``since`` on, and not with the attribute ``instead_of``. A number out of
    range is refused from version ``refused`` on."""

    type: str
    required: bool
    choices: tuple[str, ...]
    since: Version = OLDEST
    refused: Version = OLDEST
    instead_of: str = ""


class Child(NamedTuple):
    """A child: its section, empty if not checked, how often it may come, the version ``since``."""

    section: str
    times: str
    since: Version = OLDEST


class UrdfPart(NamedTuple):
    """One element of the schema; ``later``: attributes (``@name``) and children of later versions."""

    name: str
    attributes: Mapping[str, Kind]
    children: Mapping[str, Child]
    text: bool
    later: Mapping[str, Version] = NO_LATER


class Schema(NamedTuple):
    """All of ``urdf.schema`` for a version: every tag, and ``parents``, which must have a child."""

    version: Version
    sections: Mapping[str, UrdfPart]
    tags: frozenset[str]
    parents: frozenset[str]


@lru_cache
def schema(version: Version) -> Schema:
    """Return the schema of a version."""
    sections = {name: _of_version(it, version) for name, it in _all_sections().items()}
    tags = frozenset(tag for it in sections.values() for tag in it.children)
    kinds = ((name, child.times) for name, it in sections.items() for child in it.children.values())
    parents = frozenset(name for name, times in kinds if times == "required")
    return Schema(version, sections, tags, parents)


@lru_cache
def _all_sections() -> Mapping[str, UrdfPart]:
    found: dict[str, UrdfPart] = {}
    attributes: dict[str, Kind] = {}
    children: dict[str, Child] = {}
    name = ""
    for line in table_text(_FILE).splitlines():
        head, *words = line.partition("#")[0].split() or [""]
        if head.startswith("["):
            name, attributes, children = head.strip("[]"), {}, {}
            found[name] = UrdfPart(name, attributes, children, False)
        elif head == "text":
            found[name] = found[name]._replace(text=True)
        elif head.startswith("@"):
            attributes[head[1:]] = _kind(words)
        elif head:
            section = next((it[1:] for it in words if it.startswith("=")), head)
            section = "" if "open" in words else section
            times = next(it for it in words if it in ("required", "once", "many", "either"))
            children[head] = Child(section, times, _version_behind("since:", words))
    return found


def _of_version(section: UrdfPart, version: Version) -> UrdfPart:
    """Return a section as a version has it: later parts have no type and are not checked."""
    attributes = {
        key: it if it.since <= version else it._replace(type="", instead_of="")
        for key, it in section.attributes.items()
    }
    children = {
        tag: it if it.since <= version else it._replace(section="")
        for tag, it in section.children.items()
    }
    later = {f"@{key}": it.since for key, it in attributes.items() if it.since > version}
    later |= {tag: it.since for tag, it in children.items() if it.since > version}
    return section._replace(attributes=attributes, children=children, later=later)


def _kind(words: Sequence[str]) -> Kind:
    """Return the kind of a value from the words of a row, such as ``required`` or ``one:a|b``."""
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
    """Return the version behind ``start`` in the words of a row; the oldest without one."""
    given = (it.removeprefix(start) for it in words if it.startswith(start))
    word = next(given, str(OLDEST))
    found = read_version(word)
    assert found, f"{word} in {_FILE} is a version"
    return found


def is_own(name: object) -> bool:
    """Return whether a name is a tag or attribute of URDF: no comment, no other namespace."""
    return isinstance(name, str) and "{" not in name and ":" not in name


def section_of(element: etree._Element, known: Schema) -> UrdfPart | None:
    """Return the schema's section for an element of a document; None for an unknown one."""
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
    """Return (index, kind) of the attributes that have a type; None if one is a fault itself."""
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
    """Return the sections of children, empty where not checked; None if the children have a fault."""
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
    slots = {_shared_slot(tag, known[tag]) for tag in single}
    if len(slots) < sum(count[tag] for tag in single):
        return None
    sections = {tag: known[tag].section for tag in count}
    return tuple([sections.get(tag, "") for tag in tags])


def sections_once(version: Version, name: str, tags: tuple[str, ...]) -> tuple[str, ...]:
    """Return the section of each child; empty for repetitions of a child that is read once."""
    known = schema(version).sections[name].children
    seen: set[str] = set()
    found: list[str] = []
    for tag in tags:
        child = known.get(tag)
        key = "" if child is None or child.times == "many" else _shared_slot(tag, child)
        found.append(child.section if child is not None and key not in seen else "")
        seen |= {key} if key else set()
    return tuple(found)


def _shared_slot(tag: str, child: Child) -> str:
    """Return the slot of a child that is read once: all shapes share one."""
    return child.times if child.times == "either" else tag


_SCALAR = r"[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d\d?)?"
_UNIT = r"(?:0+(?:\.\d*)?|\.\d+|1(?:\.0*)?)"
# What most values look like. urdfdom accepts spaces before a single number and none after it.
_ONE = lazy_compile(rf" *{_SCALAR}", re.ASCII)
_THREE = lazy_compile(rf" *{_SCALAR}(?: +{_SCALAR}){{2}} *", re.ASCII)
FINE = {
    "number": _ONE,
    "numbers": _THREE,
    "rgba": lazy_compile(rf" *{_UNIT}(?: +{_UNIT}){{3}} *", re.ASCII),
    "quaternion": lazy_compile(rf" *{_SCALAR}(?: +{_SCALAR}){{3}} *", re.ASCII),
    "unsigned": _ONE,
    "positive": _ONE,
    "positives": _THREE,
    "version": lazy_compile(r"1\.[0-2]", re.ASCII),
    "filled": lazy_compile(r"\S.*"),
}
_LONG = 200
COUNTS = {kind: int(count) for (kind, count), _ in ROWS["counts"]}
# What numbers of these types may not be.
_BEYOND = {"unsigned": "below 0", "positive": "not above 0", "positives": "not above 0"}
_NUMBER = lazy_compile(r"[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?", re.ASCII)
_INFINITE = lazy_compile(r"[-+]?(?:nan|inf|infinity)", re.IGNORECASE)
_UNITS = lazy_compile(r"[-+.\deE]*\d\.?\s*[A-Za-z°%]+", re.ASCII)


def is_fine(kind: str, value: str) -> bool:
    """Return whether a value looks like most correct ones; others may be correct as well."""
    if len(value) > _LONG or kind not in FINE or FINE[kind].fullmatch(value) is None:
        return False
    if kind == "unsigned":
        return not value.lstrip().startswith("-")
    # Each number has a digit that is not 0 in front of its exponent, and no minus.
    return kind not in _BEYOND or all(it.strip("+0.")[:1].isdigit() for it in value.split())


def shortened(text: str) -> str:
    """Return a text short enough for a message."""
    return text if len(text) < 60 else f"{text[:56]} ..."


def wrong_numbers(value: str, kind: str) -> tuple[str, str, str]:
    """Return (fault, what is wrong, hint) of a value that should be numbers; empty if fine."""
    words = value.split()
    odd = next((word for word in words if not _NUMBER.fullmatch(word)), None)
    if not words:
        return "value", ", which is not a number", ""
    if odd is not None and not _INFINITE.fullmatch(odd):
        wrong = f": {shortened(odd)!r} is not a number" if odd != value else ""
        return "value", wrong, _number_hint(value, odd)
    if odd is not None or not all(isfinite(float(word)) for word in words):
        return "value", ", which is not finite", "write a large number, or leave it out"
    return _miscounted(value, [float(word) for word in words], kind)


def _miscounted(value: str, numbers: Sequence[float], kind: str) -> tuple[str, str, str]:
    """Return (kind, end of the message, hint) of a value of numbers alone; empty if it is right."""
    wanted = COUNTS[kind]
    if len(numbers) != wanted:
        count = f"{len(numbers)} numbers" if len(numbers) != 1 else "1 number"
        return "value", f": {count} of {wanted}", ""
    if kind == "rgba" and not all(0 <= it <= 1 for it in numbers):
        return "value", ": outside of 0 to 1", "divide by 255" if max(numbers) > 1 else ""
    if wanted == 1 and value.endswith(" "):
        return "value", ", with a space after it", "delete the space"
    if kind in _BEYOND and (min(numbers) < 0 or (kind != "unsigned" and 0 in numbers)):
        return "range", f", which is {_BEYOND[kind]}", ""
    return "", "", ""


def _number_hint(value: str, odd: str) -> str:
    if "," in value:
        single = re.fullmatch(r"\s*[-+]?\d+,\d+\s*", value)
        return "use a decimal point" if single else "separate numbers by spaces, not commas"
    if "$" in value:
        return "expand it with xacro first"
    if _UNITS.fullmatch(odd):
        return "leave the unit out: lengths are metres, angles radians, masses kilograms"
    return ""
