# SPDX-License-Identifier: Apache-2.0
"""A URDF against the schema of what parsers look for: one pass, every fault of its structure."""

from __future__ import annotations

from bisect import bisect_right
from collections import Counter, defaultdict
from collections.abc import Collection, Iterable, Iterator, Sequence
from itertools import chain

from lxml import etree

from multibot_rewrite.base.findings.finding import ERROR, WARNING
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.nearest import MISTYPED, nearest
from multibot_rewrite.description.checks.problem import Problem, fault
from multibot_rewrite.description.steps.document import Document, tag_end
from multibot_rewrite.rules.schema.sections import (
    COUNTS,
    ROBOT,
    Kind,
    Schema,
    UrdfPart,
    is_fine,
    is_own,
    schema,
    section_of,
    sections_below,
    sections_once,
    shortened,
    typed_attributes,
    wrong_numbers,
)
from multibot_rewrite.rules.schema.versions import Version, is_known, version_of

# What a child of <robot> can be a misspelling of: anything else there is an extension.
_CORE = ("link", "joint", "material", "transmission", "ros2_control", "gazebo")
# The parts of a robot with text in them, found quickly, and where the text is.
_TOPS = etree.XPath(
    "/robot[text()[normalize-space()]] | /robot/link[normalize-space()]"
    " | /robot/joint[normalize-space()] | /robot/material[normalize-space()]"
)
_TEXTS = etree.XPath("descendant-or-self::*[text()[normalize-space()]]")
# A number with a line break or tab right after it; that there is none at all is quick to see.
_BROKEN = {
    b"\n": lazy_compile(rb"\n(?<=[\d.]\n)"),
    b"\t": lazy_compile(rb"\t(?<=[\d.]\t)"),
    b"\r": lazy_compile(rb"\r(?<=[\d.]\r)"),
}
_ASSIGNED = lazy_compile(rb"(?<![\w.-])([\w.-]+)\s*=\s*[\"'][^\"'=]*$")
# Joints of these types have no axis that urdfdom reads.
_AXIS_FREE = ("fixed", "floating")


def read_faults(document: Document) -> tuple[Problem, ...]:
    """Return every fault of a URDF; what is not a ``<robot>`` has none."""
    root = document.root
    if root.tag != ROBOT:
        return ()
    known = schema(version_of(root))
    faults = [*_stray_texts(root, known), *_broken_numbers(document, known)]
    level = {ROBOT: [root]}
    while level:
        below: dict[str, list[etree._Element]] = defaultdict(list)
        for name, elements in level.items():
            for element in _doubtful_elements(known, name, elements):
                faults += _attribute_faults(element, known.sections[name], known.version)
            faults += _sorted_children(known, name, elements, below)
        level = below
    return tuple(faults)


def _sorted_children(
    known: Schema,
    name: str,
    parents: Iterable[etree._Element],
    below: dict[str, list[etree._Element]],
) -> Iterator[Problem]:
    """Sort the children of elements into their sections; yield what is wrong with the children."""
    families: dict[tuple[str, ...], list[list[etree._Element]]] = defaultdict(list)
    for parent in parents if name in known.parents else filter(len, parents):
        family = [parent, *parent]
        families[tuple([it.tag for it in family])].append(family)
    for (_, *found), alike in families.items():
        tags = tuple(found)
        sections = sections_below(known.version, name, tags)
        above, *columns = zip(*alike, strict=True)
        if sections is None:
            for parent in above:
                yield from _child_faults(parent, known.sections[name], known)
            sections = sections_once(known.version, name, tags)
        for section, children in zip(sections, columns, strict=True):
            if section:
                below[section] += children


def _doubtful_elements(
    known: Schema, name: str, elements: Iterable[etree._Element]
) -> Iterable[etree._Element]:
    """Return the elements whose attributes may have a fault."""
    kinds: dict[tuple[str, ...], list[etree._Element]] = defaultdict(list)
    for element in elements:
        kinds[tuple(element.keys())].append(element)  # type: ignore[arg-type]
    found: list[etree._Element] = []
    for keys, alike in kinds.items():
        typed = typed_attributes(known.version, name, keys)
        if typed is None:
            found += alike
        elif typed:
            found += _with_odd_values(alike, typed)
    return found


def _with_odd_values(
    alike: Sequence[etree._Element], typed: Iterable[tuple[int, Kind]]
) -> Iterable[etree._Element]:
    """Return elements of the same attributes with odd values, checked by columns: most recur."""
    columns = list(zip(*[it.values() for it in alike], strict=True))
    found: dict[etree._Element, None] = {}
    for at, kind in typed:
        values = set(columns[at]).difference(kind.choices)
        if odd := {value for value in values if not is_fine(kind.type, value)}:
            pairs = zip(alike, columns[at], strict=True)
            found |= {element: None for element, value in pairs if value in odd}
    return found


def _attribute_faults(
    element: etree._Element, section: UrdfPart, version: Version
) -> Iterator[Problem]:
    """Yield all faults of an element's attributes."""
    keys = [str(key) for key in element.attrib]
    yield from _unknown_attributes(element, section, keys)
    for key in keys:
        kind = section.attributes.get(key)
        if kind is not None and kind.type:
            yield from _value_faults(element, kind, key, version)
        if kind is not None and kind.instead_of in keys:
            message = f"<{element.tag}> has both {kind.instead_of} and {key}"
            yield fault("rotation-twice", element, key, message)
        since = section.later.get(f"@{key}")
        if since and section.name != "limit":  # MB129 reports those of a limit together
            message = f"{key} of <{element.tag}> is not read: it needs URDF {since}"
            yield fault("needs-later-version", element, key, message)


def _unknown_attributes(
    element: etree._Element, section: UrdfPart, keys: Sequence[str]
) -> Iterator[Problem]:
    """Yield attributes that are missing, and those that no parser knows."""
    known = section.attributes
    there = frozenset(keys)
    free = [it for it in known if it not in there]
    # A file of macros has neither a name nor links.
    empty = section.name == ROBOT and element.find("link") is None
    missing = [key for key in known if known[key].required and key not in there and not empty]
    for key in keys:
        if key in known or key == "name" or not is_own(key):
            continue
        meant = _nearest_name(key, free)
        hint = f"did you mean {meant!r}?" if meant else ""
        where = f"<{element.tag}> has an attribute {key!r}, which no URDF parser reads"
        if meant in missing:
            missing.remove(meant)
            yield fault("missing", element, key, f"<{element.tag}> has no {meant!r}", hint)
        elif meant:
            yield fault("misspelt", element, key, where, hint)
        else:
            yield fault("not-read", element, key, where)
    if missing:
        names = " and no ".join(map(repr, missing))
        yield fault(
            "missing", element, None, f"<{element.tag}> has no {names}", f"add {missing[0]}="
        )


def _child_faults(element: etree._Element, section: UrdfPart, schema: Schema) -> Iterator[Problem]:
    """Yield children that are missing, repeated, or that no parser knows, or not yet."""
    known = section.children
    tags = [child.tag for child in element.iterchildren("*")]
    count = Counter(tags)
    missing = [tag for tag in known if known[tag].times == "required" and tag not in count]
    for child in element.iterchildren("*"):
        if child.tag in section.later:
            message = f"<{child.tag}> is not read: it needs URDF {section.later[str(child.tag)]}"
            yield fault("needs-later-version", child, None, message)
        if child.tag in known or not is_own(child.tag):
            continue
        meant = _nearest_name(str(child.tag), _CORE if section.name == ROBOT else known)
        if meant in missing:
            missing.remove(meant)
            message = f"<{element.tag}> has no <{meant}>"
            yield fault("missing", child, None, message, f"is <{child.tag}> misspelled?")
        else:
            yield from _unknown_child(element, child, section, schema, meant)
    for tag in missing:
        yield fault("missing", element, None, f"<{element.tag}> has no <{tag}>", f"add <{tag}>")
    # Children that are read once and come again with other content.
    for tag, times in count.items():
        declared = section.children.get(tag)
        if times < 2 or declared is None or declared.times not in ("once", "required"):
            continue
        first, *others = element.findall(tag)
        other = next((it for it in others if canonical(it) != canonical(first)), None)
        if other is not None:
            message = f"<{element.tag}> has {times} <{tag}>: urdfdom reads only the first"
            yield fault("repeated", other, None, message)
    either = [tag for tag, child in section.children.items() if child.times == "either"]
    shapes = list(element.iterchildren(*either)) if either else []
    if len(shapes) > 1:
        message = f"<{element.tag}> has {len(shapes)} shapes: urdfdom reads only the first"
        yield fault("repeated", shapes[1], None, message)


def _unknown_child(
    element: etree._Element, child: etree._Element, section: UrdfPart, schema: Schema, meant: str
) -> Iterator[Problem]:
    """Yield the fault of a child that the schema does not have in its parent."""
    message = f"no parser reads <{child.tag}> inside <{element.tag}>"
    hint = f"did you mean <{meant}>?" if meant else ""
    if section.name == "ros2_control":
        message = f"<{child.tag}> in <ros2_control> is no component"
        yield fault("not-read", child, None, message, hint, ERROR)
    elif section.name == "geometry":
        return  # MB615 reports it
    elif meant:
        yield fault("misspelt", child, None, message, hint)
    elif child.tag in schema.tags:
        homes = [it.name for it in schema.sections.values() if child.tag in it.children]
        tags = sorted({home.rpartition("_")[2] for home in homes} - {str(element.tag)})
        hint = f"move it into {' or '.join(f'<{tag}>' for tag in tags)}" if tags else "delete it"
        if child.tag == "plugin" and child.get("filename"):
            hint = "move it into a <gazebo>"
        yield fault("misplaced", child, None, message, hint)
    elif section.name != ROBOT:
        yield fault("not-read", child, None, message)


def canonical(element: etree._Element) -> bytes:
    """Return an element in the form that all equal elements share."""
    return etree.tostring(element, method="c14n", with_tail=False)


def _nearest_name(name: str, known: Collection[str]) -> str:
    """Return the known name that is most like another: the same letters, or nearly all of them."""
    low = name.lower()
    letters = sorted(low)
    same = next((it for it in known if sorted(it.lower()) == letters), "")
    return same or nearest(low, known, MISTYPED)


def _value_faults(
    element: etree._Element, kind: Kind, attribute: str, version: Version
) -> Iterator[Problem]:
    """Yield what is wrong with a value."""
    value = element.get(attribute, "")
    where = f"{element.tag}@{attribute} is {shortened(value)!r}"
    if kind.type == "one":
        if value not in kind.choices:
            meant = _nearest_name(value.strip(), kind.choices)
            hint = f"did you mean {meant!r}?" if meant else ""
            message = f"{where}, not one of {', '.join(kind.choices)}"
            yield fault("word", element, attribute, message, hint)
    elif kind.type == "version":
        if not is_known(value):
            message = f"{where}, urdfdom reads 1.0, 1.1 and 1.2"
            yield fault("word", element, attribute, message, "leave it out for 1.0")
    elif kind.type == "filled":
        if not value:
            yield fault("missing", element, attribute, f"{attribute} of <{element.tag}> is empty")
    elif not _is_unread(element):
        named, problem, hint = wrong_numbers(value, kind.type)
        if named:
            # Readers go on without a colour, and take a number out of range before it is refused.
            mild = kind.type == "rgba" or (named == "range" and kind.refused > version)
            level = WARNING if mild else ""
            yield fault(named, element, attribute, f"{where}{problem}", hint, level)


def _is_unread(element: etree._Element) -> bool:
    """Return whether an element is the axis of a joint whose axis is not read."""
    joint = element.getparent()
    return element.tag == "axis" and joint is not None and joint.get("type") in _AXIS_FREE


def _stray_texts(root: etree._Element, known: Schema) -> Iterator[Problem]:
    """Yield text where no parser expects any, mostly a stray ``>``."""
    tops = _elements_at(_TOPS, root)
    inside = ([top] if top.tag == ROBOT else _elements_at(_TEXTS, top) for top in tops)
    for element in chain.from_iterable(inside):
        section = section_of(element, known)
        if section is None or section.text:
            continue
        pieces = [element.text, *(child.tail for child in element)]
        found = next(" ".join(it.split()) for it in pieces if it and it.strip())
        at = "" if element.text and element.text.strip() else None
        message = f"text {shortened(found)!r} in <{element.tag}>, which no parser reads"
        yield fault("not-read", element, at, message)


def _elements_at(path: etree.XPath, element: etree._Element) -> list[etree._Element]:
    return path(element)  # type: ignore[return-value]


def _broken_numbers(document: Document, known: Schema) -> Iterator[Problem]:
    """Yield line breaks and tabs after a number: white space for XML, but not for urdfdom."""
    source, elements, starts = document.source, document.elements, document.starts
    seen: set[int] = set()
    patterns = [pattern for blank, pattern in _BROKEN.items() if blank in source]
    for at in (it.start() for pattern in patterns for it in pattern.finditer(source)):
        number = bisect_right(starts, at) - 1
        if number < 0 or number in seen or tag_end(source, starts[number]) <= at:
            continue
        seen.add(number)
        section = section_of(elements[number], known)
        found = _ASSIGNED.search(source, starts[number], at)
        key = found[1].decode() if found else ""
        if section and key in section.attributes and section.attributes[key].type in COUNTS:
            message = f"{elements[number].tag}@{key} has a tab or a line break after a number"
            yield fault("value", elements[number], key, message, "write one space")
