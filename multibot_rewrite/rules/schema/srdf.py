# SPDX-License-Identifier: Apache-2.0
"""An SRDF against what srdfdom and MoveIt read of it: one pass, every fault.

Sources: srdfdom model.cpp; moveit_core robot_model.cpp (joint properties).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import isfinite

from lxml.etree import _Element

from multibot_rewrite.base.bounded import own_rows
from multibot_rewrite.base.findings.finding import ERROR, WARNING
from multibot_rewrite.base.nearest import nearest
from multibot_rewrite.description.checks.links_and_joints import Robot
from multibot_rewrite.description.checks.planning_groups import is_pinocchios, text_of
from multibot_rewrite.description.checks.problem import Problem, fault

# Element -> required attributes, other attributes, children.
ELEMENTS: Mapping[str, tuple[tuple[str, ...], ...]] = {
    element: tuple(tuple(it.split()) for it in rest)
    for element, *rest in own_rows(__file__, "srdf.schema")
}
_TOP = tuple(it for it in ELEMENTS if "/" not in it)
# How many numbers a joint's state has; other types have one.
_SIZES = {"fixed": 0, "planar": 3, "floating": 7}
_PROPERTIES = ("angular_distance_weight", "motion_model", "min_translational_distance")


def srdf_faults(root: _Element, robot: Robot | None) -> Iterator[Problem]:
    """Yield every fault of an SRDF; ``robot`` is that of its URDF, if it was found."""
    yield from _misspelt(root, _TOP, ("name", "version"))
    pinocchios = is_pinocchios(root)
    for it, path in _read_elements(root):
        required, others, children = ELEMENTS[path]
        for attribute in ("name",) if path == "group_state" and pinocchios else required:
            if attribute not in it.attrib:
                message = f"<{it.tag}> has no {attribute}"
                yield fault("missing", it, None, message, f"add {attribute}")
        yield from _misspelt(it, children, (*required, *others))
    for it in root.iterchildren("joint_property"):
        yield from _unknown_word(
            it, "property_name", text_of(it, "property_name"), _PROPERTIES, WARNING
        )
    for it in root.iterchildren("virtual_joint"):
        yield from _unknown_word(it, "type", text_of(it, "type").lower(), tuple(_SIZES), ERROR)
    types = {text_of(it): text_of(it, "type").lower() for it in root.iterchildren("virtual_joint")}
    types |= {name: joint.type for name, joint in robot.joint.items()} if robot else {}
    for it in root.iterfind("group_state/joint[@value]"):
        name, text = text_of(it), it.get("value", "")
        values, size = numbers_in(text), _SIZES.get(types.get(name, ""), 1)
        if values is None:
            message = f"the value of {name!r} is {text!r}, not a number"
            yield fault("value", it, "value", message, "write a number")
        elif name in types and size and len(values) != size:
            message = f"{name!r} has {len(values)} values, a {types[name]} joint has {size}"
            hint = "write one number for each degree of freedom"
            yield fault("value", it, "value", message, hint)


def _read_elements(root: _Element) -> Iterator[tuple[_Element, str]]:
    """Yield the elements that srdfdom reads, with their places in ``ELEMENTS``."""
    for top in root.iterchildren(*_TOP):
        tag = str(top.tag)
        yield top, tag
        for child in top.iterchildren("*"):
            if child.tag in ELEMENTS[tag][2]:
                yield child, f"{tag}/{child.tag}"


def _misspelt(
    parent: _Element, children: tuple[str, ...], attributes: tuple[str, ...]
) -> Iterator[Problem]:
    """Yield elements and attributes almost like a known one; all others belong to other tools."""
    for it in parent.iterchildren("*"):
        tag = str(it.tag)
        if tag not in children and (near := nearest(tag, children)):
            yield fault("misspelt", it, None, f"<{tag}> is not known", f"did you mean <{near}>?")
    for name in map(str, parent.attrib):
        if name not in attributes and (near := nearest(name, attributes)):
            message = f"{name} of <{parent.tag}> is not known"
            yield fault("misspelt", parent, name, message, f"did you mean {near}?")


def _unknown_word(
    it: _Element, attribute: str, word: str, known: tuple[str, ...], level: str
) -> Iterator[Problem]:
    """Yield a fault for a word unknown to MoveIt, which takes a type as fixed and skips a property."""
    if attribute in it.attrib and word not in known:
        near = nearest(word, known)
        hint = f"did you mean {near!r}?" if near else f"use one of {', '.join(known)}"
        message = f"{attribute} {text_of(it, attribute)!r} is not known"
        yield fault("word", it, attribute, message, hint, level)


def numbers_in(text: str) -> list[float] | None:
    """Return the numbers of a value; None where one of them is not a number."""
    try:
        numbers = [float(word) for word in text.split()]
    except ValueError:
        return None
    return numbers if numbers and all(map(isfinite, numbers)) else None
