"""The links and joints of a URDF as records, for rules about the kinematic tree."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.lint.numbers import number, value_of

MOMENTS = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
WORLD = "world"


class Inertial(NamedTuple):
    """A link's ``<inertial>``. ``moments`` are in the order of ``MOMENTS``; like ``mass`` they are
    None where they are missing or no numbers."""

    element: _Element
    mass: float | None
    moments: tuple[float, ...] | None


class Link(NamedTuple):
    """A ``<link>`` below the root."""

    name: str
    element: _Element
    inertial: Inertial | None = None


class Joint(NamedTuple):
    """A ``<joint>`` below the root; ``parent`` and ``child`` are empty where they are not said.

    ``parts`` are the first of its elements by tag.
    """

    name: str
    type: str
    parent: str
    child: str
    element: _Element
    parts: Mapping[str, _Element]


class Robot(NamedTuple):
    """A URDF's own links and joints, in document order.

    ``link`` and ``joint`` hold the first of each name. ``above`` and ``below`` map a link's name to
    the joints whose child (parent) it is, declared or not. ``body`` maps each link that hangs on a
    root to the link that a simulator merges it into, itself if none: links on fixed joints become
    a part of their parent, but of ``world``, as in sdformat.
    """

    links: tuple[Link, ...]
    joints: tuple[Joint, ...]
    link: Mapping[str, Link]
    joint: Mapping[str, Joint]
    above: Mapping[str, tuple[Joint, ...]]
    below: Mapping[str, tuple[Joint, ...]]
    body: Mapping[str, str]


def read_robot(root: _Element) -> Robot:
    """The robot of a document; what is not a ``<robot>`` has no links."""
    tops = list(root) if root.tag == "robot" else []
    links = tuple(_link(it) for it in tops if it.tag == "link")
    joints = tuple(_joint(it) for it in tops if it.tag == "joint")
    above = _by_name((it.child, it) for it in joints)
    below = _by_name((it.parent, it) for it in joints)
    return Robot(
        links,
        joints,
        {it.name: it for it in reversed(links)},
        {it.name: it for it in reversed(joints)},
        above,
        below,
        _bodies(links, above, below),
    )


def _link(element: _Element) -> Link:
    inertial = next(element.iterchildren("inertial"), None)
    name = element.get("name", "")
    return Link(name, element, None if inertial is None else _inertial(inertial))


def _inertial(element: _Element) -> Inertial:
    parts = {it.tag: it for it in reversed(element)}
    mass, inertia = parts.get("mass"), parts.get("inertia")
    values = () if inertia is None else tuple(number(inertia.get(it)) for it in MOMENTS)
    moments = tuple(it for it in values if it is not None)
    return Inertial(
        element,
        None if mass is None else value_of(mass, "value"),
        moments if len(moments) == len(MOMENTS) else None,
    )


def _joint(element: _Element) -> Joint:
    parts = {it.tag: it for it in reversed(element)}
    parent, child = parts.get("parent"), parts.get("child")
    return Joint(
        element.get("name", ""),
        element.get("type", ""),
        "" if parent is None else parent.get("link", ""),
        "" if child is None else child.get("link", ""),
        element,
        parts,
    )


def _by_name(pairs: Iterable[tuple[str, Joint]]) -> dict[str, tuple[Joint, ...]]:
    found: dict[str, list[Joint]] = {}
    for name, joint in pairs:
        if name:
            found.setdefault(name, []).append(joint)
    return {name: tuple(joints) for name, joints in found.items()}


def _bodies(
    links: Iterable[Link],
    above: Mapping[str, tuple[Joint, ...]],
    below: Mapping[str, tuple[Joint, ...]],
) -> dict[str, str]:
    body = {it.name: it.name for it in links if it.name not in above}
    todo = list(body)
    while todo:
        name = todo.pop()
        for joint in below.get(name, ()):
            if joint.child and joint.child not in body:
                merged = joint.type == "fixed" and name != WORLD
                body[joint.child] = body[name] if merged else joint.child
                todo.append(joint.child)
    return body
