"""Names in files beside a description that the description does not have, and rows of a bridge."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from multibot_rewrite.findings.finding import NOTE, WARNING
from multibot_rewrite.findings.rule import rule
from multibot_rewrite.lint.beside.kinds import BRIDGE, MOVEIT, PARAMS, RVIZ
from multibot_rewrite.lint.rules.examples import a_joint, a_link

if TYPE_CHECKING:
    from multibot_rewrite.lint.beside.records import Beside, Remark

_ROVER = {
    "package.xml": "<package><name>rover</name></package>",
    "urdf/rover.urdf": '<robot name="rover">'
    + a_link("base_link")
    + a_link("left")
    + a_link("right")
    + a_joint("left_wheel_joint", "continuous", "base_link", "left")
    + a_joint("right_wheel_joint", "continuous", "base_link", "right")
    + "</robot>",
}


def _drive(left: str) -> str:
    return (
        "drive_controller:\n"
        "  ros__parameters:\n"
        f"    left_wheel_names: [{left}]\n"
        "    right_wheel_names: [right_wheel_joint]\n"
    )


@rule(
    "MB853",
    "misspelled-link-beside",
    WARNING,
    what="A parameter file, RViz config or file of MoveIt names a frame or link that no "
    "description of the package has, and a link has almost the same name.",
    why="tf does not have the frame: the node waits for its transform for ever, RViz shows "
    "nothing ('frame does not exist').",
    fix="Correct the name.",
    bad="amcl:\n  ros__parameters:\n    base_frame_id: base_lnik\n",
    good="amcl:\n  ros__parameters:\n    base_frame_id: base_link\n",
    line=3,
    formats=(PARAMS, RVIZ, MOVEIT),
    beside=_ROVER,
)
def misspelled_link(beside: Beside) -> Iterator[Remark]:
    """Frames that are known to be the robot's; others may be of other nodes."""
    from multibot_rewrite.lint.beside.names import misspelled_frames

    return misspelled_frames(beside)


@rule(
    "MB854",
    "undeclared-joint-beside",
    NOTE,
    what="A parameter file or a file of MoveIt names a joint that no description of the package "
    "has, beside others that one has.",
    why="The controller is not activated: no hardware exports an interface of that joint. MoveIt "
    "refuses to execute on a controller with it.",
    fix="Name a joint of the description.",
    bad=_drive("left_whel_joint"),
    good=_drive("left_wheel_joint"),
    line=3,
    formats=(PARAMS, MOVEIT),
    beside=_ROVER,
)
def undeclared_joint(beside: Beside) -> Iterator[Remark]:
    """Joints of parameters that are known to hold joints."""
    from multibot_rewrite.lint.beside.names import undeclared_joints

    return undeclared_joints(beside)


def _row(key: str, direction: str = "GZ_TO_ROS") -> str:
    return (
        f"- {key}: scan\n"
        "  ros_type_name: sensor_msgs/msg/LaserScan\n"
        "  gz_type_name: gz.msgs.LaserScan\n"
        f"  direction: {direction}\n"
    )


@rule(
    "MB855",
    "bridge-row",
    WARNING,
    what="A row of a ros_gz_bridge file has a key that the bridge does not know, a direction that "
    "it does not have, or lacks a topic or a type.",
    why="ros_gz_bridge reports the row and leaves it out, or ignores the key: the topic is not "
    "bridged, or in both directions.",
    fix="Write ros_topic_name and gz_topic_name or topic_name, both types, and one of BIDIRECTIONAL, "
    "GZ_TO_ROS and ROS_TO_GZ.",
    bad=_row("topic_name", "GZ_TO_ROSS"),
    good=_row("topic_name"),
    line=4,
    formats=(BRIDGE,),
)
def bridge_row(beside: Beside) -> Iterator[Remark]:
    """Each fault of each row."""
    from multibot_rewrite.lint.beside.bridges import faulty_rows

    return faulty_rows(beside)


def _limits(name: str) -> str:
    return (
        "moveit_simple_controller_manager:\n"
        f"  controller_names: [{name}]\n"
        f"  {name}: {{type: FollowJointTrajectory, action_ns: follow_joint_trajectory, joints: [a]}}\n"
    )


@rule(
    "MB857",
    "undeclared-controller-beside",
    WARNING,
    what="MoveIt's controllers name a controller, a joint of it or an action that the parameter "
    "files in the same folder do not have, though they declare others.",
    why="MoveIt waits for the action, and rejects every plan to execute: 'Action client not "
    "connected to action server'.",
    fix="Use the names of the controllers that ros2_control loads.",
    bad=_limits("arm_controler"),
    good=_limits("arm_controller"),
    line=3,
    formats=(MOVEIT, PARAMS),
    beside={
        "ros2_controllers.yaml": "controller_manager:\n  ros__parameters:\n    arm_controller: "
        "{type: joint_trajectory_controller/JointTrajectoryController}\narm_controller:\n"
        "  ros__parameters: {joints: [a]}\n"
    },
)
def undeclared_controller(beside: Beside) -> Iterator[Remark]:
    """Controllers of ``moveit_simple_controller_manager``."""
    from multibot_rewrite.lint.beside.moveit import unknown_controllers

    return unknown_controllers(beside)
