"""Elements and values below ``<gazebo>`` that SDF does not have, or not like that."""

from __future__ import annotations

from functools import partial

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.rules.description.gazebo.shared import (
    a_sensor,
    element_faults,
    in_link,
    of_kind,
)

_found = partial(partial, of_kind, element_faults)

unreadable_value = rule(
    "MB150",
    "unreadable-value",
    ERROR,
    what="A value below <gazebo> is not of the type that SDF has for it: a number, true or false, a "
    "vector, a pose, a colour.",
    why="libsdformat stops at it ('Error reading element') and Gazebo does not load the model: "
    "nothing is spawned. For <mu1>, <kp> and others that URDF's converter reads itself, the program "
    "ends with an exception of std::stod.",
    fix="Write it as the type asks: true or false instead of yes and on, six numbers in a pose, "
    "colours from 0 to 1.",
    bad=a_sensor("imu", "<always_on>yes</always_on>"),
    good=a_sensor("imu", "<always_on>True</always_on>"),
    line=4,
)(_found("unreadable"))

value_out_of_range = rule(
    "MB151",
    "value-out-of-range",
    ERROR,
    what="A number below <gazebo> is outside of the range that SDF allows.",
    why="libsdformat refuses it ('greater than the maximum allowed value') and Gazebo does not load "
    "the model. A field of view in degrees is the usual case.",
    fix="Write a number inside of the range; angles are in radians.",
    bad=a_sensor("camera", "<camera><horizontal_fov>60</horizontal_fov></camera>"),
    good=a_sensor("camera", "<camera><horizontal_fov>1.047</horizontal_fov></camera>"),
    line=4,
)(_found("range"))

unknown_word = rule(
    "MB152",
    "unknown-word",
    ERROR,
    what="A type of a sensor, the format of an image, or another word of a list is not one that SDF "
    "knows.",
    why="libsdformat reports 'type is missing or invalid' and the sensor does not exist: nothing is "
    "published.",
    fix="Use the word in the hint; case counts.",
    bad=a_sensor("camra"),
    good=a_sensor("camera"),
    line=3,
)(_found("word"))

missing_attribute = rule(
    "MB153",
    "missing-attribute",
    ERROR,
    what="An element below <gazebo> lacks an attribute that SDF requires.",
    why="libsdformat reports 'Required attribute is not specified' and Gazebo does not load the model.",
    fix="Add it.",
    bad=in_link('<sensor type="imu"/>'),
    good=in_link('<sensor name="s" type="imu"/>'),
    line=3,
)(_found("missing"))

misspelt_sdf_element = rule(
    "MB154",
    "misspelt-sdf-element",
    WARNING,
    what="An unknown element or attribute below <gazebo> whose name is almost one that SDF has there.",
    why="libsdformat copies it and nobody reads it: the default holds, a sensor runs at another rate "
    "or a joint reports no forces.",
    fix="Correct the name; SDF writes words with underscores, and URDF's own tags in a <gazebo "
    "reference> are in camel case.",
    bad=a_sensor("imu", "<updaterate>100</updaterate>"),
    good=a_sensor("imu", "<update_rate>100</update_rate>"),
    line=4,
)(_found("misspelt"))

misplaced_sdf_element = rule(
    "MB155",
    "misplaced-sdf-element",
    WARNING,
    what="An element below <gazebo> is in a place where Gazebo does not read it: friction in the "
    "block of a joint or in one without reference, a child of a camera in its sensor.",
    why="It has no effect: mu1 without a reference changes no friction.",
    fix="Move it to where the hint says.",
    bad='<link name="a"/>\n<gazebo>\n  <mu1>0.2</mu1>\n</gazebo>\n',
    good=in_link("<mu1>0.2</mu1>"),
    line=3,
)(_found("misplaced"))

unknown_sdf_element = rule(
    "MB156",
    "unknown-sdf-element",
    NOTE,
    what="An element below <gazebo> that SDF does not have.",
    why="Gazebo copies it and reads it not, unless a plugin of your own does.",
    fix="Delete it, or move it into the plugin that reads it.",
    bad=a_sensor("imu", "<colour>red</colour>"),
    good=a_sensor("imu", "<visualize>true</visualize>"),
    line=4,
)(_found("unknown"))

later_sdf_element = rule(
    "MB157",
    "later-sdf-element",
    NOTE,
    what="An element below <gazebo> came with a later version of SDF than Gazebo of this release "
    "reads.",
    why="It has no effect in this release: a sensor with <frame_id> publishes in the frame that it "
    "has without.",
    fix="Leave it out, or name the release that the description is for: --distro.",
    bad=a_sensor("imu", "<frame_id>a</frame_id>"),
    good=a_sensor("imu", "<topic>imu</topic>"),
    line=4,
    options={"distro": "humble"},
)(_found("later"))

partly_read_value = rule(
    "MB158",
    "partly-read-value",
    WARNING,
    what="Only a part of a value below <gazebo> is read, or as something else: a unit behind a "
    "number, a comma for a point, a negative number where none can be.",
    why="libsdformat reads numbers up to the first letter that is none: 0,5 is 0 and 640.5 pixels "
    "are 640.",
    fix="Write a plain number with a decimal point.",
    bad=a_sensor("imu", "<update_rate>0,5</update_rate>"),
    good=a_sensor("imu", "<update_rate>0.5</update_rate>"),
    line=4,
)(_found("misread"))

angle_in_degrees = rule(
    "MB173",
    "angle-in-degrees",
    WARNING,
    what="An angle below <gazebo> is more than a turn: of a lidar's scan, or in a <pose>.",
    why="SDF has radians: a scan from -180 to 180 goes round 57 times, and a pose of 90 is one of 1.9.",
    fix='Write radians; a pose may have degrees="true" from SDF 1.9 on.',
    bad=a_sensor("imu", "<pose>0 0 0 0 0 90</pose>"),
    good=a_sensor("imu", "<pose>0 0 0 0 0 1.5708</pose>"),
    line=4,
)(_found("degrees"))
