# SPDX-License-Identifier: Apache-2.0
"""The links and joints of a URDF as records, for rules about the kinematic tree."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple, TypeVar

from lxml.etree import _Element

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.description.checks.numbers import number, value_of
from multibot_rewrite.description.rewriters.text import end_of, kept_joints

MOMENTS = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
WORLD = "world"

TYPES = ("fixed", "revolute", "continuous", "prismatic", "floating", "planar")
# The types with one position, which have an axis; the types that need a limit.
ONE_AXIS = frozenset(("revolute", "continuous", "prismatic"))
BOUNDED = frozenset(("revolute", "prismatic"))
TOLERANCE = 1e-3


class Inertial(NamedTuple):
    """A link's ``<inertial>``, moments as in ``MOMENTS``; what is missing or no number is None."""

    element: _Element
    mass: float | None
    moments: tuple[float, ...] | None


class Link(NamedTuple):
    """A ``<link>`` below the root."""

    name: str
    element: _Element
    inertial: Inertial | None = None


class Joint(NamedTuple):
    """A ``<joint>`` below the root; ``parent`` and ``child`` are empty where they are missing.

    ``parts`` are the first of its elements by tag.
    """

    name: str
    type: str
    parent: str
    child: str
    element: _Element
    parts: Mapping[str, _Element]


_Named = TypeVar("_Named", Link, Joint)


class Robot(NamedTuple):
    """A URDF's own links and joints, in document order.

    ``link`` and ``joint`` hold the first of each name. ``above`` and ``below`` map a link's name to
    the joints whose child (parent) it is, declared or not. ``body`` maps each link below a
    root to the link that a simulator merges it into, or to itself: links on fixed joints become a
    part of their parent, except where that is ``world`` or a block keeps the joint, as in sdformat.
    """

    links: tuple[Link, ...]
    joints: tuple[Joint, ...]
    link: Mapping[str, Link]
    joint: Mapping[str, Joint]
    above: Mapping[str, Sequence[Joint]]
    below: Mapping[str, Sequence[Joint]]
    body: Mapping[str, str]


def read_robot(root: _Element) -> Robot:
    """Return the robot of a document, without links if it is no ``<robot>``."""
    tops = list(root) if root.tag == "robot" else []
    links = tuple(_link(it) for it in tops if it.tag == "link")
    joints = tuple(_joint(it) for it in tops if it.tag == "joint")
    above = lists_by_key((it.child, it) for it in joints if it.child)
    below = lists_by_key((it.parent, it) for it in joints if it.parent)
    return Robot(
        *(links, joints, _firsts(links), _firsts(joints), above, below),
        _body_by_link(links, above, below, kept_joints(root)),
    )


def _link(element: _Element) -> Link:
    name = element.get("name", "")
    inertial = next(element.iterchildren("inertial"), None)
    if inertial is None:
        return Link(name, element)
    parts = {it.tag: it for it in reversed(inertial)}
    mass, inertia = parts.get("mass"), parts.get("inertia")
    values = [] if inertia is None else [number(inertia.get(it)) for it in MOMENTS]
    moments = tuple([it for it in values if it is not None])
    weight = None if mass is None else value_of(mass, "value")
    whole = moments if len(moments) == len(MOMENTS) else None
    return Link(name, element, Inertial(inertial, weight, whole))


def _firsts(things: Sequence[_Named]) -> dict[str, _Named]:
    """Return the first item of each name, in document order."""
    first: dict[str, _Named] = {}
    for it in things:
        first.setdefault(it.name, it)
    return first


def _joint(element: _Element) -> Joint:
    """Return a joint of a URDF as a record."""
    return Joint(
        element.get("name", ""),
        element.get("type", ""),
        end_of(element, "parent"),
        end_of(element, "child"),
        element,
        {it.tag: it for it in reversed(element)},
    )


def _body_by_link(
    links: Iterable[Link],
    above: Mapping[str, Sequence[Joint]],
    below: Mapping[str, Sequence[Joint]],
    kept: frozenset[str],
) -> dict[str, str]:
    """Return for each link the first link of the body that fixed joints make it part of."""
    body = {it.name: it.name for it in links if it.name not in above}
    todo = list(body)
    while todo:
        name = todo.pop()
        for joint in below.get(name, ()):
            if joint.child and joint.child not in body:
                merged = joint.type == "fixed" and name != WORLD and joint.name not in kept
                body[joint.child] = body[name] if merged else joint.child
                todo.append(joint.child)
    return body


def weighs(robot: Robot) -> bool:
    """Return whether any link has a mass; a value that is not a number counts as one."""
    masses = (it.inertial.mass for it in robot.links if it.inertial)
    return any(it is None or it > 0 for it in masses)


def roots(robot: Robot) -> list[Link]:
    """Return the links that are no joint's child; of two with one name the first."""
    return [it for name, it in robot.link.items() if name and name not in robot.above]


def reached(robot: Robot, starts: Iterable[str], seen: set[str]) -> list[str]:
    """Return ``starts`` and the names below them that are not in ``seen``, and add them there."""
    found = [it for it in starts if it not in seen]
    seen.update(found)
    for name in found:  # grows
        below = [it.child for it in robot.below.get(name, ()) if it.child not in seen and it.child]
        seen.update(below)
        found += dict.fromkeys(below)
    return found


def is_tree(robot: Robot) -> bool:
    """Return whether everything is below a root, and below one joint. Then there is no loop."""
    single = all(len(joints) == 1 for joints in robot.above.values())
    return single and robot.above.keys() <= robot.body.keys()


def loops(robot: Robot) -> list[list[Joint]]:
    """Return the loops of joints; of loops that share links only one."""
    rest = _not_of_a_tree(robot)
    done: set[str] = set()
    found = []
    for start in rest:
        path: dict[str, Joint] = {}
        name = start
        while name not in done:
            done.add(name)
            path[name] = next(it for it in robot.above[name] if _is_valid(it) and it.parent in rest)
            name = path[name].parent
        if name in path:
            found.append(list(path.values())[list(path).index(name) :][::-1])
    return found


def _not_of_a_tree(robot: Robot) -> dict[str, None]:
    """Return the links in loops and below them, in document order."""
    open_ = {name: sum(map(_is_valid, joints)) for name, joints in robot.above.items()}
    ready = [it for it in robot.below if not open_.get(it)]
    for name in ready:  # grows
        for joint in filter(_is_valid, robot.below.get(name, ())):
            open_[joint.child] -= 1
            if not open_[joint.child]:
                ready.append(joint.child)
    return {name: None for name, count in open_.items() if count}


def _is_valid(joint: Joint) -> bool:
    """Return whether a joint has a parent and another child."""
    return bool(joint.parent) and bool(joint.child) and joint.parent != joint.child


def joints_with(robot: Robot, tag: str) -> Iterator[tuple[Joint, _Element]]:
    """Yield (joint, element) for the joints that have an element of this tag."""
    for joint in robot.joints:
        if tag in joint.parts:
            yield joint, joint.parts[tag]
