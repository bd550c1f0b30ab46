"""Elements and attributes that URDF parsers do not expect, or miss."""

from __future__ import annotations

from functools import partial

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.rules.description.files.shared import faults

misspelled_element = rule(
    "MB110",
    "misspelled-element",
    WARNING,
    what="An unknown element whose name is almost that of a URDF element which is allowed here.",
    why="Every parser skips elements that it does not know: the link has no mass or the joint no "
    "limit, without an error.",
    fix="Correct the name.",
    bad='<link name="a"><inertail/></link>',
    good='<link name="a"><visual><geometry><sphere radius="1"/></geometry></visual></link>',
)(partial(faults, "misspelled-element"))

ignored_element = rule(
    "MB111",
    "ignored-element",
    NOTE,
    what="An element inside a link or joint that no URDF parser reads.",
    why="It has no effect: <gravity>, <kinematic> and <pose> work in a <gazebo reference> block, "
    "where sdformat looks for them, and not here.",
    fix="Move it into <gazebo reference>, or delete it.",
    bad='<link name="a"><gravity>1</gravity></link>',
    good='<link name="a"/><gazebo reference="a"><gravity>1</gravity></gazebo>',
)(partial(faults, "ignored-element"))

misplaced_element = rule(
    "MB112",
    "misplaced-element",
    WARNING,
    what="A URDF element in a place where no parser looks for it.",
    why="Parsers look for children by name in one place only: an <origin> of a link or an "
    "<inertial> of the robot is silently ignored.",
    fix="Move it to where it belongs; the hint names the places.",
    bad='<link name="a"><mass value="1"/></link>',
    good='<link name="a">\n'
    "  <inertial>\n"
    '    <mass value="1"/>\n'
    '    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>\n'
    "  </inertial>\n"
    "</link>\n",
)(partial(faults, "misplaced-element"))

misspelled_attribute = rule(
    "MB113",
    "misspelled-attribute",
    WARNING,
    what="An unknown attribute whose name is almost that of an attribute which is missing.",
    why="Parsers ask for attributes by name and use the default for missing ones: xzy='0 0 1' is "
    "an origin of 0 0 0.",
    fix="Correct the name.",
    bad='<link name="a">\n'
    '  <visual><origin xzy="0 0 1"/><geometry><sphere radius="1"/></geometry></visual>\n'
    "</link>\n",
    good='<link name="a">\n'
    '  <visual><origin xyz="0 0 1"/><geometry><sphere radius="1"/></geometry></visual>\n'
    "</link>\n",
    line=2,
)(partial(faults, "misspelled-attribute"))

ignored_attribute = rule(
    "MB114",
    "ignored-attribute",
    NOTE,
    what="An attribute that no URDF parser reads.",
    why="It has no effect: parsers read the attributes they know and no others.",
    fix="Delete it, or move it to where your own program reads it.",
    bad='<link name="a">\n'
    '  <visual colour="red"><geometry><sphere radius="1"/></geometry></visual>\n'
    "</link>\n",
    good='<link name="a">\n'
    '  <visual name="ball"><geometry><sphere radius="1"/></geometry></visual>\n'
    "</link>\n",
    line=2,
)(partial(faults, "ignored-attribute"))

missing = rule(
    "MB115",
    "missing",
    ERROR,
    what="A required attribute or child element is missing.",
    why="urdfdom rejects the whole file if the robot or a joint has no name; in a link it drops "
    "every visual and collision from the fault on; ros2_control's parser throws, and the "
    "controller manager has no hardware.",
    fix="Add what is missing.",
    bad='<link name="a"><visual><geometry><cylinder radius="1"/></geometry></visual></link>',
    good='<link name="a">\n'
    '  <visual><geometry><cylinder radius="1" length="1"/></geometry></visual>\n'
    "</link>\n",
)(partial(faults, "missing"))

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
)(partial(faults, "repeated-element"))

unknown_component = rule(
    "MB117",
    "unknown-component",
    ERROR,
    what="A child of <ros2_control> is not a component: hardware, joint, sensor, gpio or "
    "transmission.",
    why='ros2_control\'s component parser throws "invalid tag name" for it, and the controller '
    "manager has no hardware.",
    fix="Use one of the components, or move a <param> into <hardware>.",
    bad='<ros2_control name="c" type="system">\n'
    "  <hardware><plugin>p/P</plugin></hardware>\n"
    '  <param name="port">1</param>\n'
    "</ros2_control>\n",
    good='<ros2_control name="c" type="system">\n'
    '  <hardware><plugin>p/P</plugin><param name="port">1</param></hardware>\n'
    "</ros2_control>\n",
    line=3,
)(partial(faults, "unknown-component"))

stray_text = rule(
    "MB118",
    "stray-text",
    NOTE,
    what="There is text in a place where URDF parsers expect none.",
    why="It has no effect. Usually it is left over from an edit: the end of a comment, a doubled "
    "'>', a remark without comment marks.",
    fix="Delete it, or make it a comment.",
    bad='<link name="a"/>>',
    good='<link name="a"/><!-- a remark -->',
)(partial(faults, "stray-text"))
