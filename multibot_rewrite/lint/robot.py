"""The links and joints of a URDF as records, for rules about the kinematic tree."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from lxml.etree import _Element


class Link(NamedTuple):
    """A ``<link>`` below the root."""

    name: str
    element: _Element


class Joint(NamedTuple):
    """A ``<joint>`` below the root; ``parent`` and ``child`` are empty where they are not said."""

    name: str
    type: str
    parent: str
    child: str
    element: _Element


class Robot(NamedTuple):
    """A URDF's own links and joints, in document order.

    ``link`` and ``joint`` hold the first of each name. ``above`` and ``below`` map a link's name to
    the joints whose child (parent) it is, declared or not.
    """

    links: tuple[Link, ...]
    joints: tuple[Joint, ...]
    link: Mapping[str, Link]
    joint: Mapping[str, Joint]
    above: Mapping[str, tuple[Joint, ...]]
    below: Mapping[str, tuple[Joint, ...]]


def read_robot(root: _Element) -> Robot:
    """The robot of a document; what is not a ``<robot>`` has no links."""
    tops = list(root) if root.tag == "robot" else []
    links = tuple(Link(it.get("name", ""), it) for it in tops if it.tag == "link")
    joints = tuple(_joint(it) for it in tops if it.tag == "joint")
    above: dict[str, tuple[Joint, ...]] = {}
    below: dict[str, tuple[Joint, ...]] = {}
    for joint in joints:
        above[joint.child] = (*above.get(joint.child, ()), joint)
        below[joint.parent] = (*below.get(joint.parent, ()), joint)
    return Robot(
        links,
        joints,
        {it.name: it for it in reversed(links)},
        {it.name: it for it in reversed(joints)},
        above,
        below,
    )


def _joint(element: _Element) -> Joint:
    parent, child = element.find("parent"), element.find("child")
    return Joint(
        element.get("name", ""),
        element.get("type", ""),
        "" if parent is None else parent.get("link", ""),
        "" if child is None else child.get("link", ""),
        element,
    )
