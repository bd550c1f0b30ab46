# SPDX-License-Identifier: Apache-2.0
"""The kinematic tree: one root, no loops, every link reached."""

from __future__ import annotations

from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import ERROR, WARNING, rule
from multibot_rewrite.base.nearest import nearest
from multibot_rewrite.base.wording import SHOWN, shorten
from multibot_rewrite.description.checks.links_and_joints import is_tree, loops, reached, roots
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.facts.memo import level_of_absence
from multibot_rewrite.rules.subject import Subject

# With more than this many pairs of names a search for the nearest one takes too long.
MANY = 50


@rule("MB501", "several-roots", ERROR)
def several_roots(subject: Subject) -> Iterator[Problem]:
    """Report every root except that of the largest tree; a misspelled child link is MB202."""
    robot = subject.robot
    found = roots(robot)
    if len(found) < 2:
        return
    level = level_of_absence(subject)
    seen: set[str] = set()
    sizes = [len(reached(robot, [it.name], seen)) for it in found]
    main = found[sizes.index(max(sizes))]
    lost = [it for it in robot.above if it not in robot.link]
    search = lost if len(found) * len(lost) <= MANY else ()
    for link in found:
        if link is main or nearest(link.name, search):
            continue
        message = f"link {link.name!r} has no parent joint, like the root {main.name!r}"
        hint = "add a joint that connects it"
        yield Problem(link.element, message, "name", hint, level=level)


@rule("MB502", "no-link", WARNING)
def no_link(subject: Subject) -> Iterator[Problem]:
    """Yield a problem for a robot without links, unless it is a file of macros or xacro's result."""
    root = subject.document.root
    if root.tag != "robot" or subject.robot.links or subject.origins:
        return
    tags = [str(it.tag) for it in root.iterchildren("*")]
    if {*tags} != {"material"} and not any("xacro}" in it or it == "webots" for it in tags):
        yield Problem(root, "the robot has no link")


@rule("MB503", "kinematic-loop", ERROR)
def kinematic_loop(subject: Subject) -> Iterator[Problem]:
    """Report each loop, at the last of its joints in the file."""
    order: dict[_Element, int] = {}
    for joints in [] if is_tree(subject.robot) else loops(subject.robot):
        order = order or {it.element: at for at, it in enumerate(subject.robot.joints)}
        last = max(joints, key=lambda it: order[it.element])
        at = joints.index(last) + 1
        names = [it.child for it in joints[at:] + joints[:at]]
        path = " -> ".join(repr(it) for it in names[:SHOWN]) + (" -> ..." if names[SHOWN:] else "")
        below = f"{last.child!r} is below itself ({names[-1]!r} -> {path})"
        message = f"joint {last.name!r} closes a loop of {len(joints)} joints: {below}"
        yield Problem(last.element, message)


@rule("MB504", "several-parents", ERROR)
def several_parents(subject: Subject) -> Iterator[Problem]:
    """Report every joint but the first with the link as its child; copies of a joint are MB201."""
    for name, joints in subject.robot.above.items():
        for joint in joints[1:]:
            if joint.name != joints[0].name and joint.parent != name:
                both = f"{joint.name!r} and of {joints[0].name!r}"
                message = f"link {name!r} is the child of {both}"
                yield Problem(joint.parts["child"], message, "link")


@rule("MB505", "unreachable-link", ERROR)
def unreachable_link(subject: Subject) -> Iterator[Problem]:
    """Report links that the root does not reach, once; links in the loop itself are MB503."""
    robot = subject.robot
    if is_tree(robot):
        return
    seen: set[str] = set()
    reached(robot, (it for it in (*robot.link, *robot.below) if it not in robot.above), seen)
    if not seen or all(it in seen for it in robot.link):
        return
    seen.update(it.child for joints in loops(robot) for it in joints)
    seen.update(it.child for it in robot.joints if it.child == it.parent)
    if lost := [it for name, it in robot.link.items() if name not in seen]:
        names = shorten((repr(it.name) for it in lost), SHOWN)
        yield Problem(lost[0].element, f"not connected to the root: {names}", "name")


@rule("MB506", "joint-to-itself", ERROR)
def joint_to_itself(subject: Subject) -> Iterator[Problem]:
    """Report joints from a link to itself."""
    for joint in subject.robot.joints:
        if joint.parent == joint.child and joint.parent:
            message = f"joint {joint.name!r} has {joint.child!r} as its parent and as its child"
            yield Problem(joint.parts["child"], message, "link")
