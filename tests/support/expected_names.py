# SPDX-License-Identifier: Apache-2.0
"""What a rewrite must make of links, joints and their references.

Computed from the parsed text alone; nothing of it comes from the package.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping
from typing import NamedTuple

from lxml import etree

ROBOT = "robot1"
BARE_LAYOUTS = ("L1", "tf-per-robot")
Options = Mapping[str, object]


class Names(NamedTuple):
    """Old name -> new name of the links and joints that stand directly below the root."""

    link: dict[str, str]
    joint: dict[str, str]


class Slot(NamedTuple):
    """One attribute or text; ``attribute`` is empty for text."""

    tag: str
    attribute: str
    value: str


# What libxml2 calls the faults that TinyXML-2 does not have.
LOOSE = {"NS_ERR_UNDEFINED_NAMESPACE", "ERR_HYPHEN_IN_COMMENT", "ERR_RESERVED_XML_NAME"}


def parsed(data: bytes) -> etree._Element:
    """Return the root; libxml2 goes on after faults that are none to TinyXML-2."""
    try:
        return etree.fromstring(data)
    except etree.XMLSyntaxError:
        parser = etree.XMLParser(recover=True)
        root = etree.fromstring(data, parser)
        assert {it.type_name for it in parser.error_log} <= LOOSE
        return root


def spelled(name: str, separator: str, options: Options, robot: str) -> str:
    """Return a declared link's or joint's name as the options ask for."""
    if options.get("layout") in BARE_LAYOUTS:
        return name
    if options.get("affix", "postfix") == "postfix":
        return f"{name}{separator}{robot}"
    slash = "/" if name.startswith("/") else ""
    return f"{slash}{robot}{separator}{name[len(slash) :]}"


def frame_spelled(name: str, options: Options, robot: str) -> str:
    """Return a frame's or link's name; shared ones stay, with or without slashes around."""
    shared = options.get("shared_frames", ("world", "map"))
    if name.strip("/") in {str(frame).strip("/") for frame in shared}:  # type: ignore[attr-defined]
        return name
    return spelled(name, _separator(options, "link", "/"), options, robot)


def _separator(options: Options, kind: str, default: str) -> str:
    given = options.get("separators") or {}
    return given.get(kind, default)  # type: ignore[attr-defined, no-any-return]


def new_names(root: etree._Element, options: Options, robot: str) -> Names:
    """Return what the links and joints of a description are called for a robot."""
    underscore = _separator(options, "joint", "_")
    return Names(
        {name: frame_spelled(name, options, robot) for name in _named(root, "link")},
        {name: spelled(name, underscore, options, robot) for name in _named(root, "joint")},
    )


def _named(root: etree._Element, tag: str) -> list[str]:
    """Return the names of the elements that have one."""
    found = [element.get("name", "").strip() for element in root.iterchildren(tag)]
    return [name for name in found if name]


REFERENCES = {
    "joint/parent@link": ("link",),
    "joint/child@link": ("link",),
    "joint/mimic@joint": ("joint",),
    "gazebo@reference": ("link", "joint"),
    "transmission/joint@name": ("joint",),
    "ros2_control/joint@name": ("joint",),
}


def references(root: etree._Element) -> list[tuple[tuple[str, ...], str]]:
    """(kinds, value) of every reference below the root whose place any reader agrees on."""
    found = []
    for place, kinds in REFERENCES.items():
        path, _, attribute = place.partition("@")
        values = [element.get(attribute, "").strip() for element in root.iterfind(path)]
        found += [(kinds, value) for value in values]
    return found


def graph_problems(source: bytes, output: bytes, options: Options, robot: str = ROBOT) -> list[str]:
    """Where the output is not the same robot under the new names."""
    before, after = parsed(source), bare(output, robot)
    names, now = new_names(before, options, robot), new_names(after, {"layout": "L1"}, robot)
    problems = []
    for kind in Names._fields:
        wanted = Counter(getattr(names, kind).values())
        if wanted != Counter(getattr(now, kind).keys()):
            problems.append(f"{kind}s: wanted {[*wanted]}, got {[*getattr(now, kind)]}")
    pairs = zip(references(before), references(after), strict=True)
    return problems + [
        f"{kinds} {old!r} -> {new!r}"
        for (kinds, old), (_, new) in pairs
        if not _same_target(kinds, old, new, names, now)
    ]


def _same_target(kinds: tuple[str, ...], old: str, new: str, names: Names, now: Names) -> bool:
    """Return whether a resolved reference leads to the renamed thing, and any other one nowhere."""
    for kind in kinds:
        if old in getattr(names, kind):
            return bool(new == getattr(names, kind)[old])
    return not any(new in getattr(now, kind) for kind in kinds)


def bare(output: bytes, robot: str) -> etree._Element:
    """Return the output's tree without what its markers say was inserted."""
    root = parsed(output)
    for comment in list(root.iter(etree.Comment)):
        words = (comment.text or "").partition(":")[0].split()
        if words[:2] == ["multibot", robot]:
            parent = comment.getparent()
            assert parent is not None
            inserted = list(comment.itersiblings("*"))[: int(words[2])]
            comment.tail = "".join(item.tail or "" for item in (comment, *inserted))
            for item in inserted:
                parent.remove(item)
    return root


def slots(root: etree._Element) -> list[Slot]:
    """Every attribute and text of a tree, in document order."""
    found = []
    for element in root.iter("*"):
        tag = str(element.tag)
        text = [element.text or "", *(child.tail or "" for child in element)]
        values = [*element.attrib.items(), ("", "".join(text))]
        found += [Slot(tag, str(key), " ".join(str(value).split())) for key, value in values]
    return found


def changed_slots(source: bytes, output: bytes, robot: str = ROBOT) -> list[tuple[Slot, str]]:
    """Each slot whose value differs, with the new value; the trees must be alike otherwise."""
    before, after = slots(parsed(source)), slots(bare(output, robot))
    assert [slot[:2] for slot in before] == [slot[:2] for slot in after]
    pairs = zip(before, after, strict=True)
    return [(old, new.value) for old, new in pairs if old.value != new.value]


def is_insertion(old: str, new: str, robot: str = ROBOT) -> bool:
    """Is the new value the old one with nothing but the robot's name and separators put in?"""
    gap = rf"(?:[/_.-]{{0,2}}{re.escape(robot)}[/_.-]{{0,2}})?"
    pattern = gap + "".join(re.escape(letter) + gap for letter in old)
    return new != old and re.fullmatch(pattern, new, re.DOTALL) is not None
