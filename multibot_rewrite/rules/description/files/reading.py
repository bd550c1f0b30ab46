# SPDX-License-Identifier: Apache-2.0
"""Files that cannot be read, or are not a robot description as they are."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING
from multibot_rewrite.base.findings.rule import URDF, declare, rule
from multibot_rewrite.companions.kinds import EVERY
from multibot_rewrite.description.checks.audit import leftover_xacro, worlds
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.checks.twice import already_rewritten
from multibot_rewrite.rules.subject import Subject

# These five are reported where a file is read or expanded: see ``failures``.
not_xml = declare(
    "MB101",
    "not-xml",
    ERROR,
    what="The file cannot be read as a robot description: broken XML, an encoding other than "
    "UTF-8, a DOCTYPE, an empty file, or another root element. Or an SDF model includes itself.",
    why="xacro, launch files and every other program with a complete XML parser stop with an "
    "error. urdfdom's parser accepts some of it, so a part of the system may run without the rest.",
    fix="Correct the XML at the place of the finding; save the file as UTF-8.",
    bad='<robot name="r"><link name="a"></robot>',
    good='<robot name="r"><link name="a"/></robot>',
)

unreadable = declare(
    "MB102",
    "unreadable",
    ERROR,
    what="The file, or one that it includes, does not exist or cannot be opened.",
    why="xacro and robot_state_publisher stop with an error, and so does the launch file.",
    fix="Correct the path; where it has $(find PACKAGE), source the workspace with that package.",
    bad='<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
    '  <xacro:include filename="nowhere.xacro"/>\n'
    '  <link name="a"/>\n'
    "</robot>\n",
    good='<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="a"/></robot>',
    line=2,
)

xacro_failed = declare(
    "MB103",
    "xacro-failed",
    ERROR,
    what="xacro cannot expand the file: a property or macro is missing, or an expression is wrong.",
    why="There is no URDF: the Command substitution of the launch file fails and nothing starts.",
    fix="See the message; a property may have to come from a file that is included first.",
    bad='<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
    '  <link name="${side}_arm"/>\n'
    "</robot>\n",
    good='<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
    '  <xacro:property name="side" value="left"/>\n'
    '  <link name="${side}_arm"/>\n'
    "</robot>\n",
    line=2,
)

needs_argument = declare(
    "MB145",
    "needs-argument",
    NOTE,
    what="A xacro file has an argument without a default, and none was given: the file was not "
    "expanded and not checked.",
    why="Where the launch file does not give the argument either, xacro stops and nothing starts.",
    fix="Give it as NAME:=VALUE or in the configuration, or give the <xacro:arg> a default. "
    "Set the level to error if the file has to expand without arguments.",
    bad='<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
    '  <link name="$(arg side)_arm"/>\n'
    "</robot>\n",
    good='<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
    '  <xacro:arg name="side" default="left"/>\n'
    '  <link name="$(arg side)_arm"/>\n'
    "</robot>\n",
    line=2,
)

package_not_found = declare(
    "MB119",
    "not-expanded",
    NOTE,
    what="The xacro file reads a package with $(find PACKAGE) that was not found. The file was "
    "not expanded and not checked.",
    why="It is looked up in the packages of the sourced workspace at run time; a checkout of one "
    "repository need not have it.",
    fix="Give the source folder of the workspace as a root (--roots), or source the workspace. "
    "Set the level of MB119 to error if the package has to be there.",
    bad='<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
    '  <xacro:include filename="$(find no_such_package)/a.xacro"/>\n'
    '  <link name="a"/>\n'
    "</robot>\n",
    good='<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="a"/></robot>',
    line=2,
)


@rule(
    "MB105",
    "placeholder-left",
    WARNING,
    what="A description that is not named .xacro holds xacro elements or ${...} and $(arg ...). Or"
    " a file beside it holds a placeholder, such as $(var area) or <area>, in a section or a "
    "name. It does not stand for the robot, and stays. It is a note where only the file is "
    "looked at, and of a template ({{ ... }}, {% ... %}), of which nothing else is checked.",
    why="A program that loads it as it is does not expand it. urdfdom rejects the joint, and with"
    " it the robot, where ${...} is in place of a number. In a file no node has the section, "
    "and what a launch file puts there does not get the robot's name from the build.",
    fix="Name a description .urdf.xacro and load it through xacro. In a file write "
    "<robot_namespace>, <robot_name>, $(var namespace) or the like for the robot: these "
    "are filled in. Let the launch file replace any other placeholder (ParameterFile, "
    "allow_substs).",
    bad='<link name="a"/><link name="${prefix}b"/>',
    good='<link name="a"/><link name="b"/>',
    formats=(URDF, *EVERY),
)
def leftover(subject: Subject) -> Iterator[Problem]:
    """One finding for a description, at the first of them."""
    return leftover_xacro(subject.inventory)


@rule(
    "MB106",
    "already-rewritten",
    WARNING,
    what="The description is already rewritten for one of the robots. A name begins or ends with "
    "the robot's name, in any layout and with any separator, or there is text that a rewrite "
    "inserted. A robot may be called like a part (left, arm, base). Then more than half of the "
    "links, joints, namespaces or topics must have its name: left_wheel alone is by chance.",
    why="urdf-postfix rejects it: a second rewrite would make base_link/robot1/robot1. If several "
    "robots use it, all of them have the frames and topics of that one robot.",
    fix="Lint and rewrite the source file, or give the robot another name; undo the rewrite with "
    "urdf-postfix --undo, insist with --force, or exclude generated files.",
    bad='<robot name="r_robot1"><link name="base/robot1"/></robot>',
    good='<robot name="r"><link name="base"/></robot>',
    options={"robots": ("robot1", "robot2")},
)
def already(subject: Subject) -> Iterator[Problem]:
    """One finding per file, for the first robot whose name is in it."""
    # What has a robot's name by an argument has it by its author.
    robots = [it for it in subject.settings.robots if it not in subject.arguments]
    found = already_rewritten(subject.inventory, robots, False)
    for it in islice(found, 1):
        yield it._replace(hint="lint the source it was made from")


@rule(
    "MB109",
    "sdf-world",
    ERROR,
    what="The file is an SDF world, which holds several models, and robots are named that it is for.",
    why="It is unknown which of the models is the robot, so names cannot be checked or renamed for "
    "one robot.",
    fix="Keep the robot in a model.sdf of its own and include it in the world.",
    bad='<?xml version="1.0"?><sdf version="1.9"><world name="w"/></sdf>',
    good='<?xml version="1.0"?><sdf version="1.9"><model name="r"><link name="a"/></model></sdf>',
    options={"robots": ("robot1", "robot2")},
)
def sdf_world(subject: Subject) -> Iterator[Problem]:
    """Every world of the file; one that is only a world has no robots."""
    return worlds(subject.inventory) if subject.settings.robots else iter(())
