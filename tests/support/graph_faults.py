# SPDX-License-Identifier: Apache-2.0
"""Faults put into systems in which nothing was wrong, and what has to be said of each.

They come from thinking about what hurts a fleet, not from the rules. A row has the system, what is done
to it, the code that has to be found, and words that the finding must have: who did it, and the remedy.
"""

from __future__ import annotations

from answered_faults import file_rows, header_rows, state_rows
from chain_faults import chain_rows
from fault_changes import Fault
from fault_sources import (
    ADDRESSES,
    AGES,
    HASHES,
    HEADERS,
    LOOKUPS,
    NODES,
    NUMBERS,
    PARAMETERS,
    QOS,
    READERS,
    SENDERS,
    SERVICES,
    STATES,
    TRANSFORMS,
)
from moving_faults import command_rows, tf_rows
from naming_faults import clock_rows, data_rows, name_rows
from open_faults import like_rows, open_rows, place_rows, sender_rows

FAULTS = (
    *tf_rows(),
    *command_rows(),
    *name_rows(),
    *data_rows(),
    *clock_rows(),
    *header_rows(),
    *state_rows(),
    *chain_rows(),
    *file_rows(),
    *open_rows(),
    *sender_rows(),
    *place_rows(),
    *like_rows(),
)
# What a fault with this code cannot be seen without.
NEEDS = {
    **dict.fromkeys(("MG301", "MG302", "MG311", "MG312", "MG313", "MG314", "MG405"), (NODES,)),
    **dict.fromkeys(("MG502", "MG503"), (NODES,)),
    **dict.fromkeys(("MG303", "MG306", "MG308", "MG310", "MG315", "MG321", "MG501"), (READERS,)),
    **dict.fromkeys(("MG304", "MG305"), (SERVICES,)),
    **dict.fromkeys(("MG320", "MG323", "MG324", "MG325"), (SENDERS,)),
    **dict.fromkeys(("MG401", "MG403", "MG404", "MG406", "MG407", "MG414"), (TRANSFORMS,)),
    **dict.fromkeys(("MG402", "MG408"), (TRANSFORMS, SENDERS)),
    **dict.fromkeys(("MG411", "MG412"), (HEADERS,)),
    **dict.fromkeys(("MG511", "MG512", "MG513"), (STATES,)),
    "MG307": (QOS, READERS),
    "MG309": (QOS, READERS),
    "MG326": (HEADERS, NODES),
    "MG322": (NODES,),
    "MG327": (NODES,),
    "MG417": (HEADERS, AGES),
    "MG416": (TRANSFORMS, NUMBERS),
    "MG415": (TRANSFORMS, NODES),
    "MG514": (PARAMETERS,),
    "MB412": (ADDRESSES,),
    "MG413": (LOOKUPS, TRANSFORMS),
}
# Of single faults.
MORE_NEEDS = {"two versions of a message": (HASHES, READERS)}


def needed(fault: Fault) -> tuple[str, ...]:
    """Return what a source must have of a system to show the fault."""
    return MORE_NEEDS.get(fault.name, NEEDS[fault.code])


# Those whose types are on PyPI; a fault in an action needs nav2_msgs.
LIVE = (
    "a joystick in the root",
    "robot2's teleop drives robot1",
    "a joystick called after robot2 drives robot1",
    "a joystick against Nav2",
    "ros2 topic pub on cmd_vel",
    "both drivers obey /cmd_vel",
    "both amcl take /initialpose",
    "ros2 bag play into the running robot",
    "two programs send one arm's trajectories",
    "a lifecycle manager in the root",
    "a costmap's relative scan",
    "amcl has an absolute scan topic",
    "a best effort scan, a reliable reader",
    "both lidars on /scan",
    "map_server beside SLAM",
    "robot2's amcl reads robot1's scan",
    "joint_state_publisher beside the driver",
    "amcl started twice",
    "a second lifecycle manager",
    "robot2 on simulated time without a clock",
    "nobody passed /tf:=tf: both trees on /tf",
    "one robot_state_publisher lacks /tf:=tf",
    "a static map -> odom beside amcl",
    "the EKF sends the controller's odometry as well",
    "a node sends base_link -> map",
    "frame_prefix on top of a rewritten description",
    "one joystick for both teleops",
    "a relay of robot1's scan to robot2",
    "the namespace twice: /robot2/robot2/scan",
    "two filters on odometry/filtered",
    "a robot without a namespace and robot2 on /tf",
)
