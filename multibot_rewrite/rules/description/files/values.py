"""Values of attributes that URDF parsers reject."""

from __future__ import annotations

from functools import partial

from multibot_rewrite.base.findings.finding import ERROR, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.rules.description.files.shared import faults

not_a_number = rule(
    "MB120",
    "not-a-number",
    ERROR,
    what="A value that must be a number is not one: empty, with a unit, with a decimal comma.",
    why="urdfdom rejects the file if it is in a joint, and drops the remaining visuals and "
    "collisions of the link if it is in a link.",
    fix="Write plain numbers with a decimal point, separated by spaces, in metres, radians and "
    "kilograms.",
    bad='<link name="a"><visual><geometry><sphere radius="0,5"/></geometry></visual></link>',
    good='<link name="a"><visual><geometry><sphere radius="5e-1"/></geometry></visual></link>',
)(partial(faults, "not-a-number", substitutions=False))

wrong_count = rule(
    "MB121",
    "wrong-count",
    ERROR,
    what="A value has too many or too few numbers: a scale of one number, an xyz of two.",
    why="urdfdom rejects the file if it is in a joint, and drops the remaining visuals and "
    "collisions of the link if it is in a link.",
    fix="Write all the numbers: three for xyz, rpy, size and scale, four for quat_xyzw, one for the "
    "rest.",
    bad='<link name="a">\n'
    "  <visual>\n"
    '    <geometry><mesh filename="file:///a.stl" scale="0.001"/></geometry>\n'
    "  </visual>\n"
    "</link>\n",
    good='<link name="a">\n'
    "  <visual>\n"
    '    <geometry><mesh filename="file:///a.stl" scale="1 1 1"/></geometry>\n'
    "  </visual>\n"
    "</link>\n",
    line=3,
)(partial(faults, "wrong-count"))

not_finite = rule(
    "MB122",
    "not-finite",
    ERROR,
    what="A number is nan, inf, or too large for a double.",
    why="urdfdom's number parser accepts neither nan nor inf: it rejects the file if it is in a "
    "joint, and drops the remaining visuals and collisions of a link. Programs that accept it "
    "compute with nan from then on.",
    fix="Write a large finite number; for a joint without limits use type='continuous'.",
    bad='<link name="a"><visual><geometry><sphere radius="inf"/></geometry></visual></link>',
    good='<link name="a"><visual><geometry><sphere radius="1e9"/></geometry></visual></link>',
)(partial(faults, "not-finite"))

space_after_number = rule(
    "MB123",
    "space-after-number",
    ERROR,
    what="A single number has a space after it, or a number is followed by a tab or a line break.",
    why="urdfdom splits values at single spaces and expects every part to be a number: it rejects "
    "'1 ' and a tab between numbers.",
    fix="Delete the space; separate numbers by spaces.",
    bad='<link name="a"><visual><geometry><sphere radius="1 "/></geometry></visual></link>',
    good='<link name="a"><visual><geometry><box size="1  1 1 "/></geometry></visual></link>',
)(partial(faults, "space-after-number"))

bad_choice = rule(
    "MB124",
    "bad-choice",
    ERROR,
    what="A value is not one of those that the parser knows: the type of a ros2_control, or the "
    "version of the URDF.",
    why="Hardware of an unknown type is not loaded, and ros2_control's resource manager does not "
    "report it; urdfdom rejects every version but 1.0, 1.1 and 1.2.",
    fix="Use one of the values in the message, in lower case.",
    bad='<ros2_control name="c" type="System">\n'
    "  <hardware><plugin>p/P</plugin></hardware>\n"
    "</ros2_control>\n",
    good='<ros2_control name="c" type="system">\n'
    "  <hardware><plugin>p/P</plugin></hardware>\n"
    "</ros2_control>\n",
)(partial(faults, "bad-choice"))

bad_colour = rule(
    "MB130",
    "bad-colour",
    WARNING,
    what="A colour is not four numbers from 0 to 1.",
    why="urdfdom cannot read it: three numbers become black, and for a number above 1 it reports "
    "'malformed color' and the shape has no colour.",
    fix="Write red, green, blue and alpha from 0 to 1.",
    bad='<material name="m"><color rgba="255 0 0 1"/></material><link name="a"/>',
    good='<material name="m"><color rgba="1 0 0 1"/></material><link name="a"/>',
)(partial(faults, "bad-colour", substitutions=False))
