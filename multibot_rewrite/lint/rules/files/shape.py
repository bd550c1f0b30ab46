"""Elements and attributes that readers of URDF do not expect, or miss."""

from __future__ import annotations

from functools import partial

from multibot_rewrite.findings.finding import ERROR, NOTE, WARNING
from multibot_rewrite.findings.rule import rule
from multibot_rewrite.lint.rules.files.shared import faults

misspelled_element = rule(
    "MB110",
    "misspelled-element",
    WARNING,
    what="An element is no part of URDF where it stands, and nearly has the name of one that is.",
    why="Every loader skips elements that it does not know: the link has no mass, the joint no "
    "limit, and nothing says so.",
    fix="Write the name that is meant.",
    bad='<link name="a"><inertail/></link>',
    good='<link name="a"><visual><geometry><sphere radius="1"/></geometry></visual></link>',
)(partial(faults, "misspelled-element"))

ignored_element = rule(
    "MB111",
    "ignored-element",
    NOTE,
    what="An element inside a link or joint that no reader of URDF knows.",
    why="It has no effect: <gravity>, <kinematic> or <pose> work in a <gazebo reference> block, "
    "where sdformat looks for them, and not here.",
    fix="Move it into <gazebo reference>, or delete it.",
    bad='<link name="a"><gravity>1</gravity></link>',
    good='<link name="a"/><gazebo reference="a"><gravity>1</gravity></gazebo>',
)(partial(faults, "ignored-element"))

misplaced_element = rule(
    "MB112",
    "misplaced-element",
    WARNING,
    what="An element of URDF stands where nobody looks for it.",
    why="Loaders look for children by name in one place alone: an <origin> of a link or an "
    "<inertial> of the robot is left out without a word.",
    fix="Move it to where it belongs; the hint names the places.",
    bad='<link name="a"><mass value="1"/></link>',
    good='<link name="a"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" '
    'iyz="0" izz="1"/></inertial></link>',
)(partial(faults, "misplaced-element"))

misspelled_attribute = rule(
    "MB113",
    "misspelled-attribute",
    WARNING,
    what="An attribute is none of its element's, and nearly has the name of one that is absent.",
    why="Loaders ask for attributes by name and take the default where there is none: "
    "xzy='0 0 1' is an origin of 0 0 0.",
    fix="Write the name that is meant.",
    bad='<link name="a"><visual><origin xzy="0 0 1"/><geometry><sphere radius="1"/></geometry>'
    "</visual></link>",
    good='<link name="a"><visual><origin xyz="0 0 1"/><geometry><sphere radius="1"/></geometry>'
    "</visual></link>",
)(partial(faults, "misspelled-attribute"))

ignored_attribute = rule(
    "MB114",
    "ignored-attribute",
    NOTE,
    what="An attribute that no reader of URDF knows.",
    why="It has no effect: loaders ask for the attributes they know and for no others.",
    fix="Delete it, or move it to where your own program reads it.",
    bad='<link name="a"><visual colour="red"><geometry><sphere radius="1"/></geometry></visual>'
    "</link>",
    good='<link name="a"><visual name="ball"><geometry><sphere radius="1"/></geometry></visual>'
    "</link>",
)(partial(faults, "ignored-attribute"))

missing = rule(
    "MB115",
    "missing",
    ERROR,
    what="An attribute or child is missing without which its element cannot be read.",
    why="urdfdom refuses the whole file for the name of the robot or of a joint; of a link it drops "
    "every shape from the fault on; ros2_control's parser throws, and the controller manager has "
    "no hardware.",
    fix="Add what is missing.",
    bad='<link name="a"><visual><geometry><cylinder radius="1"/></geometry></visual></link>',
    good='<link name="a"><visual><geometry><cylinder radius="1" length="1"/></geometry></visual>'
    "</link>",
)(partial(faults, "missing"))

repeated_element = rule(
    "MB116",
    "repeated-element",
    WARNING,
    what="An element comes twice, with different content, where loaders read one.",
    why="urdfdom takes the first and never looks at the others: what the second says does not "
    "happen. Other readers may take the last.",
    fix="Keep the one that is meant.",
    bad='<link name="a"/><link name="b"/><joint name="j" type="fixed"><parent link="a"/>'
    '<child link="b"/><origin xyz="0 0 1"/><origin xyz="0 0 2"/></joint>',
    good='<link name="a"/><link name="b"/><joint name="j" type="fixed"><parent link="a"/>'
    '<child link="b"/><origin xyz="0 0 1"/></joint>',
)(partial(faults, "repeated-element"))

unknown_component = rule(
    "MB117",
    "unknown-component",
    ERROR,
    what="A child of <ros2_control> is no component: hardware, joint, sensor, gpio, transmission.",
    why='ros2_control\'s component parser throws "invalid tag name" for it, and the controller '
    "manager goes without any hardware.",
    fix="Write one of the components, or move a <param> into <hardware>.",
    bad='<ros2_control name="c" type="system"><hardware><plugin>p/P</plugin></hardware>'
    '<param name="port">1</param></ros2_control>',
    good='<ros2_control name="c" type="system"><hardware><plugin>p/P</plugin>'
    '<param name="port">1</param></hardware></ros2_control>',
)(partial(faults, "unknown-component"))

stray_text = rule(
    "MB118",
    "stray-text",
    NOTE,
    what="Text stands where no reader of URDF expects any.",
    why="It has no effect. Mostly it is what an edit left: the end of a comment, a doubled '>', "
    "a remark without its comment marks.",
    fix="Delete it, or make it a comment.",
    bad='<link name="a"/>>',
    good='<link name="a"/><!-- a remark -->',
)(partial(faults, "stray-text"))
