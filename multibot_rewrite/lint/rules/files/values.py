"""Values of attributes that readers of URDF cannot take."""

from __future__ import annotations

from functools import partial

from multibot_rewrite.findings.finding import ERROR, WARNING
from multibot_rewrite.findings.rule import rule
from multibot_rewrite.lint.rules.files.shared import faults

not_a_number = rule(
    "MB120",
    "not-a-number",
    ERROR,
    what="A value that has to be a number is none: empty, with a unit, with a decimal comma.",
    why="urdfdom refuses the file if it is in a joint, and drops the rest of the link's shapes if "
    "it is in a link.",
    fix="Write plain numbers with a decimal point, separated by blanks, in metres, radians and "
    "kilograms.",
    bad='<link name="a"><visual><geometry><sphere radius="0,5"/></geometry></visual></link>',
    good='<link name="a"><visual><geometry><sphere radius="5e-1"/></geometry></visual></link>',
)(partial(faults, "not-a-number", substitutions=False))

wrong_count = rule(
    "MB121",
    "wrong-count",
    ERROR,
    what="A value holds more or fewer numbers than it must: a scale of one number, an xyz of two.",
    why="urdfdom refuses the file if it is in a joint, and drops the rest of the link's shapes if "
    "it is in a link.",
    fix="Write all the numbers: three for xyz, rpy, size and scale, one for the rest.",
    bad='<link name="a"><visual><geometry><mesh filename="file:///a.stl" scale="0.001"/></geometry>'
    "</visual></link>",
    good='<link name="a"><visual><geometry><mesh filename="file:///a.stl" scale="1 1 1"/>'
    "</geometry></visual></link>",
)(partial(faults, "wrong-count"))

not_finite = rule(
    "MB122",
    "not-finite",
    ERROR,
    what="A number is nan, inf, or too large for a double.",
    why="urdfdom's number reader knows neither nan nor inf: it refuses a joint's file, and drops "
    "the rest of a link's shapes. Readers that take it compute with nan from then on.",
    fix="Write a large finite number, or leave a limit out by type='continuous'.",
    bad='<link name="a"><visual><geometry><sphere radius="inf"/></geometry></visual></link>',
    good='<link name="a"><visual><geometry><sphere radius="1e9"/></geometry></visual></link>',
)(partial(faults, "not-finite"))

blank_behind_number = rule(
    "MB123",
    "blank-behind-number",
    ERROR,
    what="A lone number has a blank behind it, or a tab or line end follows a number in a value.",
    why="urdfdom splits at single blanks alone and wants a number to be all of its part: it reads "
    "'1 ' and a tab between numbers as no number, and refuses it.",
    fix="Delete the blank; write blanks between numbers.",
    bad='<link name="a"><visual><geometry><sphere radius="1 "/></geometry></visual></link>',
    good='<link name="a"><visual><geometry><box size="1  1 1 "/></geometry></visual></link>',
)(partial(faults, "blank-behind-number"))

bad_choice = rule(
    "MB124",
    "bad-choice",
    ERROR,
    what="A value is not one of those that the loader knows: the type of a ros2_control, or the "
    "version of the URDF.",
    why="Hardware of an unknown type is loaded by nobody, and ros2_control's resource manager does "
    "not say so; urdfdom refuses a file of another version than 1.0.",
    fix="Write one of the values in the message, in lower case.",
    bad='<ros2_control name="c" type="System"><hardware><plugin>p/P</plugin></hardware>'
    "</ros2_control>",
    good='<ros2_control name="c" type="system"><hardware><plugin>p/P</plugin></hardware>'
    "</ros2_control>",
)(partial(faults, "bad-choice"))

bad_colour = rule(
    "MB130",
    "bad-colour",
    WARNING,
    what="A colour is not four numbers from 0 to 1.",
    why="urdfdom cannot read it: of three numbers it makes black, and with one above 1 it says "
    "'malformed color' and the shape goes without its colour.",
    fix="Write red, green, blue and alpha from 0 to 1.",
    bad='<material name="m"><color rgba="255 0 0 1"/></material><link name="a"/>',
    good='<material name="m"><color rgba="1 0 0 1"/></material><link name="a"/>',
)(partial(faults, "bad-colour", substitutions=False))
