# SPDX-License-Identifier: Apache-2.0
"""Elements, attributes and parameters that their readers do not expect, or miss."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING
from multibot_rewrite.base.findings.rule import SRDF, URDF, rule
from multibot_rewrite.companions.kinds import MOVEIT, PARAMS
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.description.files.libraries import (
    misspelt_hardware,
    misspelt_libraries,
    plugins_without_library,
)
from multibot_rewrite.rules.description.references.gazebo import (
    sensors_elsewhere,
    sensors_of_joints,
)
from multibot_rewrite.rules.description.references.interfaces import misspelt_interfaces
from multibot_rewrite.rules.facts.certain import lacking
from multibot_rewrite.rules.facts.faults import faults
from multibot_rewrite.rules.subject import Subject


@rule(
    "MB110",
    "misspelt",
    WARNING,
    what="A name is not known where it is, and is almost one that is known there. It is the name "
    "of an element or attribute of a URDF or SRDF or below <gazebo>. Or it names a parameter "
    "of a plugin, of ros2_control hardware or of a node, a library, a hardware class or an "
    "interface of ros2_control.",
    why="Readers skip what they do not know, without a word: the link has no mass, the joint no limit, "
    "the plugin or node its default. A library or class is not found, an interface is claimed by none.",
    fix="Correct the name. Names of parameters come from the generate_parameter_library files of "
    "the node's package, if its sources are there. Otherwise they come from installed NoDL "
    "documents and the sources of the release.",
    bad='<link name="a"><inertail/></link>',
    good='<link name="a"><visual><geometry><sphere radius="1"/></geometry></visual></link>',
    formats=(URDF, SRDF, PARAMS, MOVEIT),
)
def misspelt(subject: Subject) -> Iterator[Problem]:
    """Elements, attributes, parameters; what a plugin or <hardware> loads; interfaces."""
    yield from faults("misspelt", subject)
    yield from misspelt_libraries(subject)
    yield from misspelt_hardware(subject)
    yield from misspelt_interfaces(subject)


not_read = rule(
    "MB111",
    "not-read",
    NOTE,
    what="An element, attribute, parameter or text that nothing reads. It is in a URDF, below "
    "<gazebo>, in a known plugin, or in a node whose package declares all of its parameters. Below "
    "<ros2_control> it is an error where it is no component. It is a warning for a parameter of a "
    "controller that is in the section of its manager.",
    why="It has no effect: <gravity> works in a <gazebo reference> block and not in a link, <alwaysOn> "
    "in a sensor and not in its plugin. ros2_control's parser throws 'invalid tag name', and the "
    "controller manager has no hardware.",
    fix="Delete it, or move it to where it is read; make a remark a comment.",
    bad='<link name="a"><gravity>1</gravity></link>',
    good='<link name="a"/><gazebo reference="a"><gravity>1</gravity></gazebo>',
    formats=(URDF, PARAMS),
)(partial(faults, "not-read"))


@rule(
    "MB112",
    "misplaced",
    WARNING,
    what="An element of URDF or SDF, or a parameter of a plugin, in a place where no parser looks "
    "for it. Examples are an <origin> of a link, friction in a <gazebo> without reference and a "
    "<remapping> beside <ros>.",
    why="Readers look for children by name in one place only. It has no effect.",
    fix="Move it to the place that the hint names.",
    bad='<link name="a"><mass value="1"/></link>',
    good='<link name="a">\n'
    "  <inertial>\n"
    '    <mass value="1"/>\n'
    '    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>\n'
    "  </inertial>\n"
    "</link>\n",
)
def misplaced(subject: Subject) -> Iterator[Problem]:
    """By what each reader looks for where, and sensors that no block of a link has."""
    yield from faults("misplaced", subject)
    yield from sensors_of_joints(subject)
    yield from sensors_elsewhere(subject)


@rule(
    "MB115",
    "missing",
    ERROR,
    what="A required attribute, child element or parameter is missing or empty: of a URDF or SRDF,"
    " below <gazebo>, of a plugin or of ros2_control hardware. In parameters it is the class "
    "of a listed plugin or the type of a controller. What goes with a listed source is a "
    "warning.",
    why="urdfdom rejects the whole file for a part of a joint. In a link it drops every visual "
    "and collision from the fault on. libsdformat does not load the model, srdfdom skips the "
    "element, and a plugin or hardware is not loaded. In Humble a battery ends Gazebo's server.",
    fix="Add what is missing, or delete the element that needs it.",
    bad='<link name="a"><visual><geometry><cylinder radius="1"/></geometry></visual></link>',
    good='<link name="a">\n'
    '  <visual><geometry><cylinder radius="1" length="1"/></geometry></visual>\n'
    "</link>\n",
    formats=(URDF, SRDF, PARAMS, MOVEIT),
)
def missing(subject: Subject) -> Iterator[Problem]:
    """By what each reader requires."""
    root = subject.document.root
    for it in faults("missing", subject):
        # What includes a part of a robot may have its name.
        yield from lacking(subject, [it]) if it.element is root else [it]
    yield from plugins_without_library(subject)


repeated_element = rule(
    "MB116",
    "repeated-element",
    WARNING,
    what="An element appears twice, with different content, where parsers read only one.",
    why="urdfdom reads the first and ignores the others. Other parsers may take the last.",
    fix="Keep the right one.",
    bad='<link name="a"/>\n'
    '<link name="b"/>\n'
    '<joint name="j" type="fixed">\n'
    '  <parent link="a"/>\n'
    '  <child link="b"/>\n'
    '  <origin xyz="0 0 1"/>\n'
    '  <origin xyz="0 0 2"/>\n'
    "</joint>\n",
    good='<link name="a"/>\n'
    '<link name="b"/>\n'
    '<joint name="j" type="fixed">\n'
    '  <parent link="a"/>\n'
    '  <child link="b"/>\n'
    '  <origin xyz="0 0 1"/>\n'
    "</joint>\n",
    line=7,
)(partial(faults, "repeated"))

of_another_release = rule(
    "MB157",
    "of-another-release",
    NOTE,
    what="An element below <gazebo> is newer than the SDF that Gazebo of this release reads, or "
    "a plugin reads the parameter in another release only.",
    why="It has no effect in this release. For example, a sensor with <frame_id> publishes in its "
    "default frame.",
    fix="Leave it out, or name the release that the description is for: --distro.",
    bad='<link name="a"/>\n'
    '<gazebo reference="a">\n'
    '  <sensor name="s" type="imu"><frame_id>a</frame_id></sensor>\n'
    "</gazebo>\n",
    good='<link name="a"/>\n'
    '<gazebo reference="a">\n'
    '  <sensor name="s" type="imu"><topic>imu</topic></sensor>\n'
    "</gazebo>\n",
    line=3,
    options={"distro": "humble"},
)(partial(faults, "later"))

of_another_simulator = rule(
    "MB163",
    "parameter-of-other-simulator",
    WARNING,
    what="A plugin has a parameter that only its counterpart reads. A plugin of Gazebo has one of "
    "Gazebo Classic, a plugin of ROS 2 one of ROS 1, or the reverse.",
    why="It has no effect: what a file was migrated for is at its default. Classic's wheel_diameter "
    "is no wheel_radius; commandTopic of ROS 1 leaves the robot of ROS 2 at cmd_vel.",
    fix="Use the parameter of this simulator and ROS, if it has one.",
    bad="<gazebo>\n"
    '  <plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">\n'
    "    <wheel_diameter>0.2</wheel_diameter>\n"
    "  </plugin>\n"
    "</gazebo>\n",
    good="<gazebo>\n"
    '  <plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">\n'
    "    <wheel_radius>0.1</wheel_radius>\n"
    "  </plugin>\n"
    "</gazebo>\n",
    line=3,
)(partial(faults, "simulator"))
