"""Elements and attributes that srdfdom cannot use."""

from __future__ import annotations

from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import ERROR, WARNING
from multibot_rewrite.base.nearest import nearest
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.description.srdf.shared import APART, ARM, ELEMENTS, TOP, srdf_rule
from multibot_rewrite.rules.subject import Subject


@srdf_rule(
    "MB817",
    "srdf-incomplete",
    ERROR,
    what="A required attribute is missing.",
    why="srdfdom skips the element with an error; a joint_property without a joint_name stops "
    "move_group.",
    fix="Add the attribute.",
    bad=ARM + '<end_effector name="e" group="arm"/>',
    good=ARM + '<end_effector name="e" group="arm" parent_link="b"/>',
    line=2,
)
def srdf_incomplete(subject: Subject) -> Iterator[Problem]:
    """Every attribute that srdfdom asks for."""
    for it, path in _elements(subject.document.root):
        for attribute in ELEMENTS[path][0]:
            if attribute not in it.attrib:
                yield Problem(it, f"<{it.tag}> has no {attribute}", None, f"add {attribute}")


@srdf_rule(
    "MB821",
    "srdf-misspelled",
    WARNING,
    what="An unknown element or attribute whose name is almost that of a known one.",
    why="srdfdom silently skips what it does not know: the group, pair or state does not exist.",
    fix="Correct the name.",
    bad=ARM + '<disable_collision link1="a" link2="b"/>',
    good=ARM + APART,
    line=2,
)
def srdf_misspelled(subject: Subject) -> Iterator[Problem]:
    """Elements and attributes almost like a known one; all others belong to other tools."""
    for parent, path in ((subject.document.root, ""), *_elements(subject.document.root)):
        children = ELEMENTS[path][2] if path else TOP
        for it in parent.iterchildren("*"):
            tag = str(it.tag)
            if tag not in children and (near := nearest(tag, children)):
                yield Problem(it, f"<{tag}> is not known", None, f"did you mean <{near}>?")
        known = (*ELEMENTS[path][0], *ELEMENTS[path][1]) if path else ("name", "version")
        for name in map(str, parent.attrib):
            if name not in known and (near := nearest(name, known)):
                message = f"{name} of <{parent.tag}> is not known"
                yield Problem(parent, message, name, f"did you mean {near}?")


def _elements(root: _Element) -> Iterator[tuple[_Element, str]]:
    """The elements that srdfdom reads and their places in ``ELEMENTS``."""
    for top in root.iterchildren(*TOP):
        tag = str(top.tag)
        yield top, tag
        for child in top.iterchildren("*"):
            if child.tag in ELEMENTS[tag][2]:
                yield child, f"{tag}/{child.tag}"
