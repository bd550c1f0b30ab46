# SPDX-License-Identifier: Apache-2.0
"""Names of links, joints and the robot that are not valid in URDF, SDF or tf, or in other formats
(USD, MJCF) that the option targets names."""

from __future__ import annotations

import re
from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.naming import is_keyword
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.description.names.shared import BLANK, TOKEN, name_of_robot, named
from multibot_rewrite.rules.subject import Subject

WORLD = "world"


@rule(
    "MB302",
    "empty-name",
    ERROR,
    what="A link or joint has an empty name.",
    why="urdfdom rejects a joint to a link without a name, and sdformat rejects the empty name of "
    "a joint. tf2 accepts no transform with an empty frame.",
    fix="Give it a name; in xacro check which argument or property is empty.",
    bad='<link name=""/>',
    good='<link name="a"/>',
)
def empty_name(subject: Subject) -> Iterator[Problem]:
    """Names that are empty or white space."""
    for kind, name, element in named(subject):
        if not name.strip():
            yield Problem(element, f"a {kind} has an empty name", "name")


@rule(
    "MB303",
    "space-in-name",
    WARNING,
    what="The name of a link or joint contains white space.",
    why="ROS names must not contain white space: rcl rejects topics, nodes and namespaces made "
    "from it. Lists of names in plugins and hardware parameters are split at spaces.",
    fix="Use an underscore, or delete the space around it, at every use as well.",
    bad='<link name="left wheel"/>',
    good='<link name="left_wheel"/>',
)
def space_in_name(subject: Subject) -> Iterator[Problem]:
    """White space in a name or around it."""
    for kind, name, element in named(subject):
        if name.strip() and BLANK.search(name):
            where = "" if name == name.strip() else " around it"
            near = "_".join(name.split())
            yield Problem(
                element, f"{kind} {name!r} contains white space{where}", "name", f"use {near!r}"
            )


@rule(
    "MB305",
    "double-colon",
    ERROR,
    what="The name of the robot, a link or a joint contains '::'.",
    why="SDF reserves '::' for names inside of models: From version 13 on sdformat converts "
    "the URDF to SDF 1.11 and rejects the whole model. Older versions look for a model "
    "with the first part as its name.",
    fix="Use an underscore.",
    bad='<link name="arm::hand"/>',
    good='<link name="arm_hand"/>',
)
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


@rule(
    "MB306",
    "reserved-name",
    ERROR,
    what="A link, a joint or the robot has a name that SDF reserves: __x__, or world for a joint "
    "or the robot.",
    why="sdformat rejects the model: 'The supplied joint name [world] is reserved'. Gazebo spawns "
    "nothing.",
    fix="Give it another name.",
    bad='<link name="__base__"/>',
    good='<link name="_base_"/>',
)
def reserved_name(subject: Subject) -> Iterator[Problem]:
    """Links, joints and the robot; a link called world is MB307."""
    for kind, name, element in named(subject):
        if is_keyword(name) or (kind == "joint" and name == WORLD):
            yield Problem(element, f"SDF reserves the name {name!r}: no {kind} may have it", "name")
    robot = name_of_robot(subject)
    if robot is not None and (is_keyword(robot) or robot == WORLD):
        message = f"SDF reserves the name {robot!r}: no model may have it"
        yield Problem(subject.document.root, message, "name")


@rule(
    "MB307",
    "world-link",
    WARNING,
    what="A link called world is more than the point to which the robot is fixed. It is not the "
    "root, or it has mass or shapes.",
    why="A root link called world is the simulation's own world: sdformat ignores its mass and "
    "shapes. Elsewhere the name is reserved, and a world that moves with the robot breaks every tf "
    "tree.",
    fix="Rename a link with content; fix the robot to an empty root link called world.",
    bad='<link name="world"><visual><geometry><sphere radius="1"/></geometry></visual></link>\n'
    '<link name="a"/>\n'
    '<joint name="j" type="fixed"><parent link="world"/><child link="a"/></joint>\n',
    good='<link name="world"/>\n'
    '<link name="a"/>\n'
    '<joint name="j" type="fixed"><parent link="world"/><child link="a"/></joint>\n',
)
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


@rule(
    "MB308",
    "link-and-joint-alike",
    WARNING,
    what="A link and a joint have the same name, and both become parts of the simulated model.",
    why="In SDF a link and a joint must not share a name. sdformat reports 'name collision' and "
    "rejects the model, so Gazebo does not spawn it.",
    fix="Rename the joint, usually to NAME_joint.",
    bad='<link name="a"/>\n'
    '<link name="b"/>\n'
    '<joint name="b" type="continuous"><parent link="a"/><child link="b"/></joint>\n',
    good='<link name="a"/>\n'
    '<link name="b"/>\n'
    '<joint name="b_joint" type="continuous"><parent link="a"/><child link="b"/></joint>\n',
    line=3,
)
def link_and_joint_alike(subject: Subject) -> Iterator[Problem]:
    """Only where both stay: Gazebo merges the links of a fixed joint, and its name is gone."""
    robot = subject.robot
    for joint in robot.joints:
        if joint.name not in robot.link or joint.type == "fixed" or not joint.name.strip():
            continue
        if all(it.type != "fixed" or it.parent == WORLD for it in robot.above.get(joint.name, ())):
            message = f"{joint.name!r} is a joint and a link"
            yield Problem(joint.element, message, "name", f"call it {joint.name + '_joint'!r}")


@rule(
    "MB309",
    "names-differ-by-case",
    NOTE,
    what="The names of two links or two joints differ only in upper and lower case.",
    why="ROS and Gazebo distinguish them; people, and files named after them on a case-insensitive "
    "disk, do not.",
    fix="Rename one of them.",
    bad='<link name="arm"/><link name="Arm"/>',
    good='<link name="arm"/><link name="arm_2"/>',
)
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


@rule(
    "MB310",
    "name-not-ascii",
    NOTE,
    what="The name of a link or joint contains a letter that is not ASCII.",
    why="ROS names must be ASCII: rcl rejects topics, nodes and namespaces made from it. Two "
    "letters that look the same can be different.",
    fix="Use the letters a to z.",
    bad='<link name="fühler"/>',
    good='<link name="fuehler"/>',
)
def name_not_ascii(subject: Subject) -> Iterator[Problem]:
    """The message names the letter, which may look like another one."""
    for kind, name, element in named(subject):
        if not name.isascii():
            letter = next(it for it in name if not it.isascii())
            code = f"U+{ord(letter):04X}"
            yield Problem(element, f"{kind} {name!r} contains {letter!r} ({code})", "name")


@rule(
    "MB320",
    "invalid-usd-name",
    WARNING,
    what="A name is not a valid USD identifier (checked with the target usd).",
    why="The names of USD prims have letters, digits and underscores, without a leading digit. "
    "Converters to USD replace the rest, and a program that looks for the URDF name finds nothing.",
    fix="Use underscores in place of other characters.",
    bad='<link name="left/wheel"/>',
    good='<link name="left_wheel"/>',
    options={"targets": ("usd",)},
)
def no_usd_name(subject: Subject) -> Iterator[Problem]:
    """The message has the name that a converter makes, and whether it already exists."""
    if "usd" not in subject.settings.targets:
        return
    names = {name for _, name, _ in named(subject)}
    for kind, name, element in named(subject):
        if name.strip() and not TOKEN.fullmatch(name):
            made = re.sub(r"\W", "_", name, flags=re.ASCII)
            made = f"_{made}" if made[0].isdigit() else made
            taken = ", which already exists" if made in names else ""
            message = (
                f"{kind} {name!r} is not a valid USD identifier: it becomes {_encoded(name)} in Isaac "
                f"Sim 6, {made!r}{taken} in others"
            )
            yield Problem(element, message, "name", f"use {made!r}")


def _encoded(name: str) -> str:
    """The name as Isaac Sim 6 spells it: what a prim may have, then a code of all else.

    Source: what usd-exchange 3.0.1 makes of names (getValidPrimName); strands-labs/robots#1902.
    """
    plain = re.sub(r"\W", "", name, flags=re.ASCII)
    if plain == name:
        return repr(f"tn__{name}_")
    return f"'tn__{plain}_' and a code" if plain else "'tn__' and a code"


@rule(
    "MB321",
    "slash-for-mjcf",
    WARNING,
    what="The name of a link or joint contains a slash (checked with the target mjcf).",
    why="MuJoCo accepts it; dm_control's mjcf does not: it reserves '/' for the names of attached "
    "models, and raises ValueError when the model is loaded.",
    fix="Use an underscore.",
    bad='<link name="left/wheel"/>',
    good='<link name="left_wheel"/>',
    options={"targets": ("mjcf",)},
)
def slash_for_mjcf(subject: Subject) -> Iterator[Problem]:
    """Links become bodies, joints stay joints."""
    if "mjcf" not in subject.settings.targets:
        return
    for kind, name, element in named(subject):
        if "/" in name:
            hint = f"use {name.strip('/').replace('/', '_')!r}"
            yield Problem(element, f"{kind} {name!r} contains a slash", "name", hint)
