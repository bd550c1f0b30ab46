# SPDX-License-Identifier: Apache-2.0
"""Rules that a description alone is asked, and a system: their words, with the example of a system."""

from __future__ import annotations

from multibot_rewrite.base.findings.finding import WARNING
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.rules.declaration import SYSTEM, system_options

NOT_EXPORTED = declare(
    "MB229",
    "interface-not-exported",
    WARNING,
    what="A controller claims an interface that no <ros2_control> of its robot exports. A note "
    "where a planning group of an SRDF has a joint that none of MoveIt's controllers moves. Where "
    "the files before a rewrite agreed, `build` says it as an error. For a description alone, the "
    "controllers are read from the parameter file that it loads. If it loads none, they are read "
    "from the only file called *controllers*.yaml in its folder. Of a joint whose interface an "
    "argument of xacro chooses nothing is said.",
    why="The controller manager does not activate a controller whose interfaces do not exist. MoveIt "
    "plans for the group and cannot execute: no set of controllers moves all its joints.",
    fix="Name an interface that the description has, or add it to its <ros2_control>. Add the "
    "joint of a planning group to a controller of MoveIt. If nothing moves it, declare it passive "
    "in the SRDF.",
    bad="""\
running: /robot1/controller_manager exports command elbow/position
running: /robot1/arm claims command elbo/position
""",
    good="""\
running: /robot1/controller_manager exports command elbow/position
running: /robot1/arm claims command elbow/position
""",
    line=2,
    formats=(SYSTEM,),
    options=system_options(absence=True),
)
CLAIMED_TWICE = declare(
    "MB240",
    "interface-claimed-twice",
    WARNING,
    what="Two parameters of a controller name the same joint, so it claims a command interface twice.",
    why="An interface is claimed once: the controller is not activated, or one wheel is driven twice.",
    fix="Name another joint in one of them.",
    bad="""\
running: /robot1/drive claims command wheel/velocity
running: /robot1/drive claims command wheel/velocity
""",
    good="""\
running: /robot1/drive claims command left_wheel/velocity
running: /robot1/drive claims command right_wheel/velocity
""",
    formats=(SYSTEM,),
    options=system_options(),
)
ONE_DEVICE = declare(
    "MB412",
    "one-device",
    WARNING,
    what="Two robots have one device: an address, serial number or calibration of their hardware, "
    "a port or file that only one process can have. It is a note for what two computers can both "
    "have. That is a device /dev/ttyUSB0, or a port or output folder of a node that is not known. "
    "It is one, too, for a description alone, whose <ros2_control> has a fixed serial port, CAN "
    "interface or IP address. So it is for a parameter file that names the calibration of a "
    "camera.",
    why="Both drivers command one arm, or the second one is refused; both nodes write into one file "
    "and damage it. With another arm's calibration the tool is millimetres from where tf has it; with "
    "another camera's one robot measures wrongly.",
    fix="Give each robot its own: with an argument of its xacro, `arguments` in the fleet file, or "
    "its own parameter file, loaded last. In the path of a calibration `<robot_namespace>` becomes "
    "the robot's name.",
    bad="""\
running: /robot1/controller_manager holds device robot_ip 10.0.0.2
running: /robot2/controller_manager holds device robot_ip 10.0.0.2
""",
    good="""\
running: /robot1/controller_manager holds device robot_ip 10.0.0.2
running: /robot2/controller_manager holds device robot_ip 10.0.0.3
""",
    line=2,
    formats=(SYSTEM,),
    options=system_options(),
)
