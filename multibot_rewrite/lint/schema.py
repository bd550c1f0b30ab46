"""A URDF against the schema of what its readers look for: one pass, every fault of its shape.

The schema is data (``urdf.schema``). Elements are alike in their attributes and children, so what
the schema says about a combination is worked out once and then looked up.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections import Counter, defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from functools import lru_cache
from math import isfinite
from pathlib import Path
from typing import NamedTuple

from lxml import etree

from multibot_rewrite.checks.audit import nearest
from multibot_rewrite.lazy import lazy_compile
from multibot_rewrite.steps.document import Document, tag_end

_FILE = Path(__file__).parent / "urdf.schema"
ROBOT = "robot"
# What a child of <robot> can be a misspelling of: anything else there is an extension of its own.
_CORE = ("link", "joint", "material", "transmission", "ros2_control", "gazebo")
# Combinations longer than this are not worth remembering: the children of <robot>.
_FEW = 40
_SCALAR = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d\d?)?"
_UNIT = r"(?:0+\.?\d*|\.\d+|1\.?0*)"
# One look tells that a usual value is fine. urdfdom takes blanks in front of a lone number and none
# behind it.
_FINE = {
    "number": lazy_compile(rf" *{_SCALAR}", re.ASCII),
    "numbers": lazy_compile(rf" *{_SCALAR}(?: +{_SCALAR}){{2}} *", re.ASCII),
    "rgba": lazy_compile(rf" *{_UNIT}(?: +{_UNIT}){{3}} *", re.ASCII),
    "version": lazy_compile(r"0*1\.0+", re.ASCII),
}
_LONG = 200
_COUNTS = {"number": 1, "numbers": 3, "rgba": 4}
_NUMBER = lazy_compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?", re.ASCII)
_INFINITE = lazy_compile(r"[-+]?(?:nan|inf|infinity)", re.IGNORECASE)
_UNITS = lazy_compile(r"[-+.\deE]*\d\.?\s*[A-Za-z°%]+", re.ASCII)
# The parts of a robot that hold text somewhere, which is quickly asked, and where.
_TOPS = etree.XPath(
    "/robot[text()[normalize-space()]] | /robot/link[normalize-space()]"
    " | /robot/joint[normalize-space()] | /robot/material[normalize-space()]"
)
_TEXTS = etree.XPath("descendant-or-self::*[text()[normalize-space()]]")
# A number with a line end or tab right behind it.
_BROKEN = (
    lazy_compile(rb"\n(?<=[\d.]\n)"),
    lazy_compile(rb"\t(?<=[\d.]\t)"),
    lazy_compile(rb"\r(?<=[\d.]\r)"),
)
_ASSIGNED = lazy_compile(rb"([\w.-]+)\s*=\s*[\"'][^\"'=]*$")
# Joints of these types have no axis that urdfdom reads.
_AXIS_FREE = ("fixed", "floating")


class Kind(NamedTuple):
    """What an attribute must hold: a type of ``urdf.schema``, or one of ``choices``."""

    type: str
    required: bool
    choices: tuple[str, ...]


class Child(NamedTuple):
    """A child: its section, empty where nobody looks inside, and how often it may stand there."""

    section: str
    times: str


class Section(NamedTuple):
    """One element of the schema."""

    name: str
    attributes: Mapping[str, Kind]
    children: Mapping[str, Child]
    text: bool


class Fault(NamedTuple):
    """A fault of the document's shape; ``kind`` is the name of the rule that tells it.

    ``attribute`` is as in ``Problem``.
    """

    kind: str
    element: etree._Element
    attribute: str | None
    message: str
    hint: str = ""


def read_faults(document: Document) -> tuple[Fault, ...]:
    """Every fault of a URDF; what is not a ``<robot>`` has none."""
    root = document.root
    if root.tag != ROBOT:
        return ()
    faults = [*_texts(root), *_broken(document)]
    level = {ROBOT: [root]}
    while level:
        below: dict[str, list[etree._Element]] = defaultdict(list)
        for name, elements in level.items():
            for element in _doubtful(name, elements):
                faults += _attributes(element, schema()[name])
            faults += _sorted_children(name, elements, below)
        level = below
    return tuple(faults)


def _sorted_children(
    name: str, parents: Iterable[etree._Element], below: dict[str, list[etree._Element]]
) -> Iterator[Fault]:
    """Adds the children of a section's elements to theirs; what is wrong with which are there."""
    families: dict[tuple[str, ...], list[list[etree._Element]]] = defaultdict(list)
    for parent in parents if name in _parents() else filter(len, parents):
        family = [parent, *parent]
        families[tuple([it.tag for it in family])].append(family)
    for (_, *tags), alike in families.items():
        known = tuple(tags)
        sections = _below(name, known) if len(known) < _FEW else _below.__wrapped__(name, known)
        above, *columns = zip(*alike, strict=True)
        if sections is None:
            for parent in above:
                yield from _children(parent, schema()[name])
            sections = _sections(name, known)
        for section, children in zip(sections, columns, strict=True):
            if section:
                below[section] += children


def _doubtful(name: str, elements: Iterable[etree._Element]) -> Iterable[etree._Element]:
    """Those of a section's elements whose attributes are not fine at one look."""
    kinds: dict[tuple[str, ...], list[etree._Element]] = defaultdict(list)
    for element in elements:
        kinds[tuple(element.keys())].append(element)  # type: ignore[arg-type]
    found: list[etree._Element] = []
    for keys, alike in kinds.items():
        typed = _typed(name, keys)
        if typed is None:
            found += alike
        elif typed:
            found += _with_odd_values(alike, typed)
    return found


def _with_odd_values(
    alike: Sequence[etree._Element], typed: Iterable[tuple[int, str]]
) -> Iterable[etree._Element]:
    """Elements of the same attributes, looked at by columns: most values come again and again."""
    columns = list(zip(*[it.values() for it in alike], strict=True))
    found: dict[etree._Element, None] = {}
    for at, kind in typed:
        odd = {value for value in set(columns[at]) if not _is_fine(kind, value)}
        if odd:
            pairs = zip(alike, columns[at], strict=True)
            found |= {element: None for element, value in pairs if value in odd}
    return found


def _is_fine(kind: str, value: str) -> bool:
    return len(value) <= _LONG and kind in _FINE and bool(_FINE[kind].fullmatch(value))


def _attributes(element: etree._Element, section: Section) -> Iterator[Fault]:
    """All that is wrong with an element's attributes."""
    keys = [str(key) for key in element.attrib]
    yield from _strange_attributes(element, section, keys)
    for key in keys:
        kind = section.attributes.get(key)
        if kind is not None and kind.type:
            yield from _value(element, kind, key, element.get(key, ""))


# ------------------------------------------------------------------ the schema


@lru_cache
def schema() -> Mapping[str, Section]:
    """The sections of ``urdf.schema``."""
    found: dict[str, Section] = {}
    attributes: dict[str, Kind] = {}
    children: dict[str, Child] = {}
    name = ""
    for line in _FILE.read_text(encoding="utf-8").splitlines():
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
    types = [it for it in words if it in _FINE]
    return Kind(types[0] if types else "one" * bool(choices), "required" in words, tuple(choices))


def _child(tag: str, words: Sequence[str]) -> Child:
    section = next((it[1:] for it in words if it.startswith("=")), tag)
    times = next(it for it in words if it in ("required", "once", "many", "either"))
    return Child("" if "open" in words else section, times)


@lru_cache
def _tags() -> frozenset[str]:
    """Every element that stands somewhere in the schema."""
    return frozenset(tag for section in schema().values() for tag in section.children)


@lru_cache
def _parents() -> frozenset[str]:
    """The sections that must have a child."""
    known = schema().items()
    return frozenset(
        name for name, it in known if any(c.times == "required" for c in it.children.values())
    )


def _is_own(name: object) -> bool:
    """Is it URDF's own name: no comment, no name of another program's namespace?"""
    return isinstance(name, str) and "{" not in name and ":" not in name


# ------------------------------------------------- combinations, each worked out once


@lru_cache(maxsize=2048)
def _typed(name: str, keys: tuple[str, ...]) -> tuple[tuple[int, str], ...] | None:
    """Which attributes have a type, and it; None where one of them is strange or missing."""
    known = schema()[name].attributes
    if any(key not in known and key != "name" and _is_own(key) for key in keys):
        return None
    if any(kind.required and key not in keys for key, kind in known.items()):
        return None
    types = [known[key].type if key in known else "" for key in keys]
    return tuple((at, kind) for at, kind in enumerate(types) if kind)


@lru_cache(maxsize=2048)
def _below(name: str, tags: tuple[str, ...]) -> tuple[str, ...] | None:
    """The sections of children, empty for those left alone; None where the children have a fault."""
    known = schema()[name].children
    count = {tag: times for tag, times in Counter(tags).items() if _is_own(tag)}
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


def _sections(name: str, tags: tuple[str, ...]) -> tuple[str, ...]:
    """The section of each child; the second of what is read once is not looked at."""
    known = schema()[name].children
    seen: set[str] = set()
    found: list[str] = []
    for tag in tags:
        child = known.get(tag)
        key = "" if child is None or child.times == "many" else _slot(tag, child)
        found.append(child.section if child is not None and key not in seen else "")
        seen |= {key} if key else set()
    return tuple(found)


def _slot(tag: str, child: Child) -> str:
    """What a child that is read once takes up: shapes have one place among them."""
    return child.times if child.times == "either" else tag


# ------------------------------------------------------------------ what is wrong


def _strange_attributes(
    element: etree._Element, section: Section, keys: Sequence[str]
) -> Iterator[Fault]:
    """Attributes that are missing, and those nobody reads."""
    known = section.attributes
    # A file of macros has neither a name nor links.
    empty = section.name == ROBOT and element.find("link") is None
    missing = [key for key in known if known[key].required and key not in keys and not empty]
    for key in keys:
        if key in known or key == "name" or not _is_own(key):
            continue
        meant = _near(key, [it for it in known if it not in keys])
        hint = f"did you mean {meant!r}?" if meant else ""
        where = f"<{element.tag}> has an attribute {key!r}, which no reader of URDF knows"
        if meant in missing:
            missing.remove(meant)
            yield Fault("missing", element, key, f"<{element.tag}> has no {meant!r}", hint)
        elif meant:
            yield Fault("misspelled-attribute", element, key, where, hint)
        else:
            yield Fault("ignored-attribute", element, key, where)
    for key in missing:
        yield Fault("missing", element, None, f"<{element.tag}> has no {key!r}")


def _children(element: etree._Element, section: Section) -> Iterator[Fault]:
    """Children that are missing, come twice, or that nobody reads."""
    known = section.children
    tags = [child.tag for child in element.iterchildren("*")]
    count = Counter(tags)
    missing = [tag for tag in known if known[tag].times == "required" and tag not in count]
    for child in element.iterchildren("*"):
        if child.tag in known or not _is_own(child.tag):
            continue
        meant = _near(str(child.tag), _CORE if section.name == ROBOT else known)
        if meant in missing:
            missing.remove(meant)
            message = f"<{element.tag}> has no <{meant}>"
            yield Fault("missing", child, None, message, f"is <{child.tag}> meant to be it?")
        else:
            yield from _strange(element, child, section, meant)
    for tag in missing:
        yield Fault("missing", element, None, f"<{element.tag}> has no <{tag}>")
    yield from _repeated(element, section, count)
    yield from _shapes(element, section)


def _strange(
    element: etree._Element, child: etree._Element, section: Section, meant: str
) -> Iterator[Fault]:
    """A child that the schema does not have there."""
    message = f"<{child.tag}> in <{element.tag}> is read by nobody"
    hint = f"did you mean <{meant}>?" if meant else ""
    if section.name == "ros2_control":
        yield Fault("unknown-component", child, None, f"<{child.tag}> in <ros2_control>", hint)
    elif section.name == "geometry":
        return  # MB615 tells it
    elif meant:
        yield Fault("misspelled-element", child, None, message, hint)
    elif child.tag in _tags():
        homes = [it.name for it in schema().values() if child.tag in it.children]
        tags = sorted({home.rpartition("_")[2] for home in homes})
        hint = f"it belongs in {' or '.join(f'<{tag}>' for tag in tags)}"
        yield Fault("misplaced-element", child, None, message, hint)
    elif section.name != ROBOT:
        yield Fault("ignored-element", child, None, message)


def _repeated(element: etree._Element, section: Section, count: Counter[str]) -> Iterator[Fault]:
    """What is read once and comes again with another content."""
    for tag, times in count.items():
        child = section.children.get(tag)
        if times < 2 or child is None or child.times not in ("once", "required"):
            continue
        first, *others = element.findall(tag)
        other = next((it for it in others if _written(it) != _written(first)), None)
        if other is not None:
            message = f"<{element.tag}> has {times} <{tag}>: urdfdom reads the first one alone"
            yield Fault("repeated-element", other, None, message)


def _written(element: etree._Element) -> bytes:
    return etree.tostring(element, method="c14n", with_tail=False)


def _shapes(element: etree._Element, section: Section) -> Iterator[Fault]:
    """A geometry has one shape, and the first element is it."""
    known = [tag for tag, child in section.children.items() if child.times == "either"]
    shapes = list(element.iterchildren(*known)) if known else []
    if len(shapes) > 1:
        message = f"<{element.tag}> has {len(shapes)} shapes: urdfdom reads the first one alone"
        yield Fault("repeated-element", shapes[1], None, message)


def _near(name: str, known: Collection[str]) -> str:
    """The known name that is most like another: the same letters, or nearly all of them."""
    low = name.lower()
    letters = sorted(low)
    same = next((it for it in known if sorted(it.lower()) == letters), "")
    return same or nearest(low, known)


def _value(element: etree._Element, kind: Kind, attribute: str, value: str) -> Iterator[Fault]:
    """What is wrong with a value that is not fine at first sight."""
    where = f"{element.tag}@{attribute} is {_short(value)!r}"
    if kind.type == "one":
        if value not in kind.choices:
            meant = _near(value.strip(), kind.choices)
            hint = f"did you mean {meant!r}?" if meant else ""
            message = f"{where}, not one of {', '.join(kind.choices)}"
            yield Fault("bad-choice", element, attribute, message, hint)
    elif kind.type == "version":
        if _FINE["version"].fullmatch(value):
            return
        message = f"{where}, urdfdom knows 1.0 alone"
        yield Fault(
            "bad-choice", element, attribute, message, 'write version="1.0", or leave it out'
        )
    elif not _is_unread(element):
        said, problem, hint = _wrong(value, kind.type)
        if said:
            named = "bad-colour" if kind.type == "rgba" else said
            yield Fault(named, element, attribute, f"{where}{problem}", hint)


def _short(text: str) -> str:
    return text if len(text) < 60 else f"{text[:56]} ..."


def _is_unread(element: etree._Element) -> bool:
    """The axis of a joint that has none."""
    joint = element.getparent()
    return element.tag == "axis" and joint is not None and joint.get("type") in _AXIS_FREE


def _wrong(value: str, kind: str) -> tuple[str, str, str]:
    """(kind of fault, what is wrong, hint) of a value that should be numbers; empty where fine."""
    words = value.split()
    odd = next((word for word in words if not _NUMBER.fullmatch(word)), None)
    if not words:
        return "not-a-number", ", which is no number", ""
    if odd is not None and not _INFINITE.fullmatch(odd):
        return (
            "not-a-number",
            f": {_short(odd)!r} is no number" * (odd != value),
            _number_hint(value, odd),
        )
    if odd is not None or not all(isfinite(float(word)) for word in words):
        return "not-finite", ", which is not finite", "write a large number, or leave it out"
    return _miscounted(value, [float(word) for word in words], kind)


def _miscounted(value: str, numbers: Sequence[float], kind: str) -> tuple[str, str, str]:
    """The same for a value of nothing but numbers."""
    wanted = _COUNTS[kind]
    if len(numbers) != wanted:
        count = f"{len(numbers)} numbers" if len(numbers) != 1 else "1 number"
        return "wrong-count", f": {count} of {wanted}", ""
    if kind == "rgba" and not all(0 <= it <= 1 for it in numbers):
        return kind, ": outside of 0 to 1", "divide by 255" if max(numbers) > 1 else ""
    if kind == "number" and value.endswith(" "):
        return "blank-behind-number", ", with a blank behind it", "delete the blank"
    return "", "", ""


def _number_hint(value: str, odd: str) -> str:
    if "," in value:
        alone = re.fullmatch(r"\s*[-+]?\d+,\d+\s*", value)
        return "write a point for the comma" if alone else "separate numbers by blanks, not commas"
    if "$" in value:
        return "expand it with xacro first"
    if _UNITS.fullmatch(odd):
        return "leave the unit out: lengths are metres, angles radians, masses kilograms"
    return ""


# ------------------------------------------------------------------ what only the text shows


def _texts(root: etree._Element) -> Iterator[Fault]:
    """Text where none belongs, a stray ``>`` mostly."""
    for element in (it for top in _found(_TOPS, root) for it in _texts_in(top)):
        section = section_of(element)
        if section is None or section.text:
            continue
        pieces = [element.text, *(child.tail for child in element)]
        said = next(" ".join(it.split()) for it in pieces if it and it.strip())
        inside = "" if element.text and element.text.strip() else None
        message = f"text {_short(said)!r} in <{element.tag}>, where nobody reads it"
        yield Fault("stray-text", element, inside, message)


def _texts_in(top: etree._Element) -> list[etree._Element]:
    return [top] if top.tag == ROBOT else _found(_TEXTS, top)


def _found(path: etree.XPath, element: etree._Element) -> list[etree._Element]:
    return path(element)  # type: ignore[return-value]


def section_of(element: etree._Element) -> Section | None:
    """The section of the schema that an element of a document belongs to."""
    parent = element.getparent()
    path = [element]
    while parent is not None:
        path.append(parent)
        parent = parent.getparent()
    name = ROBOT
    for it in path[-2::-1]:
        child = schema()[name].children.get(str(it.tag))
        if child is None or not child.section:
            return None
        name = child.section
    return schema()[name]


def _broken(document: Document) -> Iterator[Fault]:
    """Line ends and tabs behind a number: blanks to XML, and no blanks to urdfdom."""
    source, elements, starts = document.source, document.elements, document.starts
    seen: set[int] = set()
    for at in (it.start() for pattern in _BROKEN for it in pattern.finditer(source)):
        number = bisect_right(starts, at) - 1
        if number < 0 or number in seen or tag_end(source, starts[number]) <= at:
            continue
        seen.add(number)
        section = section_of(elements[number])
        found = _ASSIGNED.search(source, starts[number], at)
        key = found[1].decode() if found else ""
        if section and key in section.attributes and section.attributes[key].type in _COUNTS:
            message = f"{elements[number].tag}@{key} has a tab or a line end behind a number"
            yield Fault("blank-behind-number", elements[number], key, message, "write one blank")
