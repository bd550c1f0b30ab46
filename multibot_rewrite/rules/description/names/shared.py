# SPDX-License-Identifier: Apache-2.0
"""What rules about names share: the links, joints and robot that have one."""

from __future__ import annotations

from lxml.etree import _Element

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.subject import Subject

# Names with a substitution are skipped: MB105 reports them.
SUBSTITUTION = "$"
BLANK = lazy_compile(r"\s")


@memoized
def named(subject: Subject) -> list[tuple[str, str, _Element]]:
    """(kind, name, element) of the links and joints that have a name attribute."""
    links, joints = subject.robot.links, subject.robot.joints
    every = [
        *[("link", it.name, it.element) for it in links],
        *[("joint", it.name, it.element) for it in joints],
    ]
    return [it for it in every if SUBSTITUTION not in it[1] and _has_name(*it[1:])]


def _has_name(name: str, element: _Element) -> bool:
    return bool(name) or element.get("name") is not None


def name_of_robot(subject: Subject) -> str | None:
    """The robot's own name; None where it has none, or a substitution."""
    root = subject.document.root
    name = root.get("name") if root.tag == "robot" else None
    return None if name is None or SUBSTITUTION in name else name
