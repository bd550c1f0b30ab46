"""Parameters of simulator plugins and of ros2_control hardware, against what their code reads."""

from __future__ import annotations

from functools import partial

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.rules.description.gazebo.shared import a_system, of_kind, parameter_faults

_found = partial(partial, of_kind, parameter_faults)
_drive = partial(a_system, "diff-drive", "DiffDrive")
_motor = partial(a_system, "multicopter-motor-model", "MulticopterMotorModel")

_slip = partial(a_system, "wheel-slip", "WheelSlip")
_LATERAL = "<slip_compliance_lateral>0.1</slip_compliance_lateral>"

misspelt_parameter = rule(
    "MB162",
    "misspelt-parameter",
    WARNING,
    what="A parameter that a plugin or a ros2_control hardware class does not read, and whose name is "
    "almost one that it reads.",
    why="Plugins ask for parameters by name: the default holds, and nobody says so.",
    fix="Correct the name.",
    bad=_drive("<wheel_seperation>0.4</wheel_seperation>"),
    good=_drive("<wheel_separation>0.4</wheel_separation>"),
    line=3,
)(_found("misspelt"))

parameter_of_other_simulator = rule(
    "MB163",
    "parameter-of-other-simulator",
    WARNING,
    what="A plugin of Gazebo has a parameter that only the plugin of Gazebo Classic with the same task "
    "reads, or the reverse; or one of ROS 2 has a parameter of ROS 1's, or the reverse.",
    why="It has no effect: what a file was migrated for is at its default. Classic's wheel_diameter "
    "is no wheel_radius; commandTopic of ROS 1 leaves the robot of ROS 2 at cmd_vel.",
    fix="Use the parameter of this simulator and ROS, if it has one.",
    bad=_drive("<wheel_diameter>0.2</wheel_diameter>"),
    good=_drive("<wheel_radius>0.1</wheel_radius>"),
    line=3,
)(_found("simulator"))

unread_parameter = rule(
    "MB164",
    "unread-parameter",
    NOTE,
    what="A parameter that the code of a known plugin does not read.",
    why="It has no effect: the plugin runs with what it has built in, whatever the value says. "
    "<alwaysOn> and <updateRate> in a lidar's plugin are the sensor's own elements.",
    fix="Delete it.",
    bad=_drive("<use_sim_time>true</use_sim_time>"),
    good=_drive("<topic>cmd_vel</topic>"),
    line=3,
)(_found("unread"))

parameter_outside = rule(
    "MB174",
    "parameter-outside-its-block",
    WARNING,
    what="A plugin reads a parameter in a block of its own that is there, and the parameter is beside "
    "that block.",
    why="It has no effect: a <remapping> or <namespace> beside <ros> remaps nothing, and all robots "
    "share the topic.",
    fix="Move it into the block.",
    bad=_slip('<wheel link_name="wheel"/>', _LATERAL),
    good=_slip(f'<wheel link_name="wheel">{_LATERAL}</wheel>'),
    line=4,
)(_found("outside"))

missing_parameter = rule(
    "MB165",
    "missing-parameter",
    ERROR,
    what="A parameter is missing without which a plugin or a hardware class stops loading.",
    why="The plugin prints an error and does nothing; the controller manager has no hardware.",
    fix="Add it.",
    bad=a_system("thruster", "Thruster", "<namespace>boat</namespace>"),
    good=a_system("thruster", "Thruster", "<joint_name>propeller</joint_name>"),
    line=2,
)(_found("missing"))

wrong_type = rule(
    "MB166",
    "wrong-type",
    WARNING,
    what="The value of a plugin's or a hardware class's parameter is not of the type that its code "
    "asks for, or only a part of it is read.",
    why="In Gazebo a text for a number counts as 0, anything but true, false, 1 and 0 as false, and a "
    "number ends at the first letter that is none; ros2_control hardware throws.",
    fix="Write a plain number with a decimal point, or true or false.",
    bad=_drive("<wheel_radius>ten cm</wheel_radius>"),
    good=_drive("<wheel_radius>0.1</wheel_radius>"),
    line=3,
)(_found("type"))

unknown_choice = rule(
    "MB167",
    "unknown-choice",
    WARNING,
    what="A parameter has a word that its plugin does not compare it with, and nearly one that it "
    "does.",
    why="The plugin prints a warning at most and takes its default: a propeller turns the wrong way.",
    fix="Use the word in the hint.",
    bad=_motor("<turningDirection>ccww</turningDirection>"),
    good=_motor("<turningDirection>ccw</turningDirection>"),
    line=3,
)(_found("word"))

parameter_of_another_release = rule(
    "MB168",
    "plugin-parameter-of-another-release",
    NOTE,
    what="A plugin reads a parameter in another release than this one.",
    why="It has no effect in this release: the plugin runs with what it has built in, as if the line "
    "were not there.",
    fix="Leave it out, or name the release that the description is for: --distro.",
    bad=_motor("<actuator_number>0</actuator_number>"),
    good=_motor("<motorNumber>0</motorNumber>"),
    line=3,
    options={"distro": "humble"},
)(_found("later"))

parameter_out_of_range = rule(
    "MB169",
    "parameter-out-of-range",
    WARNING,
    what="A number of a plugin makes no sense for any robot: a wheel without radius, a negative rate.",
    why="The code divides by it or leaves the parameter out: velocities become infinite or nan.",
    fix="Write the value of the robot.",
    bad=_drive("<wheel_radius>0</wheel_radius>"),
    good=_drive("<wheel_radius>0.1</wheel_radius>"),
    line=3,
)(_found("range"))

parameter_in_degrees = rule(
    "MB170",
    "parameter-in-degrees",
    WARNING,
    what="An angle of a plugin is more than a turn.",
    why="Gazebo's angles are in radians: a steering limit of 30 limits nothing, and the wheels turn "
    "all the way round.",
    fix="Write radians; the hint has them.",
    bad=a_system("ackermann-steering", "AckermannSteering", "<steering_limit>30</steering_limit>"),
    good=a_system(
        "ackermann-steering", "AckermannSteering", "<steering_limit>0.52</steering_limit>"
    ),
    line=3,
)(_found("degrees"))
