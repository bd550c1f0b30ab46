"""What rules about names share: the links, joints and robot that have one."""

from __future__ import annotations

import re
from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.lazy import lazy_compile
from multibot_rewrite.lint.records import Subject

# Names with a substitution are skipped: MB105 reports them.
SUBSTITUTION = "$"
BLANK = lazy_compile(r"\s")
TOKEN = lazy_compile(r"[A-Za-z_]\w*", re.ASCII)


def named(subject: Subject) -> Iterator[tuple[str, str, _Element]]:
    """(kind, name, element) of the links and joints that have a name attribute."""
    for link in subject.robot.links:
        if SUBSTITUTION not in link.name and "name" in link.element.attrib:
            yield "link", link.name, link.element
    for joint in subject.robot.joints:
        if SUBSTITUTION not in joint.name and "name" in joint.element.attrib:
            yield "joint", joint.name, joint.element


def name_of_robot(subject: Subject) -> str | None:
    """The robot's own name; None where it has none, or a substitution."""
    root = subject.document.root
    name = root.get("name") if root.tag == "robot" else None
    return None if name is None or SUBSTITUTION in name else name
