# SPDX-License-Identifier: Apache-2.0
"""Names of links, joints and the robot that are not valid in URDF, SDF or tf."""

from __future__ import annotations

from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.naming import is_keyword
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.subject import Subject

WORLD = "world"


@rule("MB302", "empty-name", ERROR)
def empty_name(subject: Subject) -> Iterator[Problem]:
    """Names that are empty or white space."""
    for kind, name, element in named(subject):
        if not name.strip():
            yield Problem(element, f"a {kind} has an empty name", "name")


@rule("MB303", "space-in-name", WARNING)
def space_in_name(subject: Subject) -> Iterator[Problem]:
    """White space in a name or around it."""
    for kind, name, element in named(subject):
        if name.strip() and BLANK.search(name):
            where = "" if name == name.strip() else " around it"
            near = "_".join(name.split())
            yield Problem(
                element, f"{kind} {name!r} contains white space{where}", "name", f"use {near!r}"
            )


@rule("MB305", "double-colon", ERROR)
def double_colon(subject: Subject) -> Iterator[Problem]:
    """Names that become names in SDF."""
    for kind, name, element in named(subject):
        if "::" in name:
            hint = f"use {name.replace('::', '_')!r}"
            yield Problem(
                element, f"{kind} {name!r} contains '::', which SDF reserves", "name", hint
            )
    if "::" in (name_of_robot(subject) or ""):
        yield Problem(
            subject.document.root, "the robot's name contains '::', which SDF reserves", "name"
        )


@rule("MB306", "reserved-name", ERROR)
def reserved_name(subject: Subject) -> Iterator[Problem]:
    """Links, joints and the robot; a link called world is MB307."""
    for kind, name, element in named(subject):
        if is_keyword(name) or (kind == "joint" and name == WORLD):
            yield Problem(element, f"SDF reserves the name {name!r}: no {kind} may have it", "name")
    robot = name_of_robot(subject)
    if robot is not None and (is_keyword(robot) or robot == WORLD):
        message = f"SDF reserves the name {robot!r}: no model may have it"
        yield Problem(subject.document.root, message, "name")


@rule("MB307", "world-link", WARNING)
def world_link(subject: Subject) -> Iterator[Problem]:
    """One finding, for its worst fault."""
    link = subject.robot.link.get(WORLD)
    if link is None:
        return
    above = subject.robot.above.get(WORLD, ())
    content = next(
        (it.tag for it in link.element.iterchildren("inertial", "visual", "collision")), ""
    )
    if above:
        message = f"link 'world' is not the root: joint {above[0].name!r} moves it with the robot"
        yield Problem(link.element, message, "name")
    elif content:
        message = f"link 'world' has <{content}>, which Gazebo ignores"
        yield Problem(link.element, message, "name")


@rule("MB308", "link-and-joint-alike", WARNING)
def link_and_joint_alike(subject: Subject) -> Iterator[Problem]:
    """Only where both stay: Gazebo merges the links of a fixed joint, and its name is gone."""
    robot = subject.robot
    for joint in robot.joints:
        if joint.name not in robot.link or joint.type == "fixed" or not joint.name.strip():
            continue
        if all(it.type != "fixed" or it.parent == WORLD for it in robot.above.get(joint.name, ())):
            message = f"{joint.name!r} is a joint and a link"
            yield Problem(joint.element, message, "name", f"call it {joint.name + '_joint'!r}")


@rule("MB309", "names-differ-by-case", NOTE)
def names_differ_by_case(subject: Subject) -> Iterator[Problem]:
    """The second of each pair."""
    links = {it.name: it.element for it in subject.robot.links}
    joints = {it.name: it.element for it in subject.robot.joints}
    for kind, parts in (("link", links), ("joint", joints)):
        if len({name.lower() for name in parts}) == len(parts):
            continue
        seen: dict[str, str] = {}
        for name, element in parts.items():
            first = seen.setdefault(name.lower(), name)
            if first != name:
                message = f"{kind} {name!r} differs from {first!r} only in upper and lower case"
                yield Problem(element, message, "name")


@rule("MB310", "name-not-ascii", NOTE)
def name_not_ascii(subject: Subject) -> Iterator[Problem]:
    """The message names the letter, which may look like another one."""
    for kind, name, element in named(subject):
        if not name.isascii():
            letter = next(it for it in name if not it.isascii())
            code = f"U+{ord(letter):04X}"
            yield Problem(element, f"{kind} {name!r} contains {letter!r} ({code})", "name")


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
