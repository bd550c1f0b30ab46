"""Parameter files and MoveIt's controllers against what else is in their package."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from multibot_rewrite.base.findings.finding import WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.companions.kinds import MOVEIT, PARAMS
from multibot_rewrite.rules.description.physics.shared import a_rover

if TYPE_CHECKING:
    from multibot_rewrite.companions.named_file import NamedFile
    from multibot_rewrite.rules.files.records import Remark


def _wheels(separation: str) -> str:
    return (
        "controller_manager:\n"
        "  ros__parameters: {drive: {type: diff_drive_controller/DiffDriveController}}\n"
        "drive:\n"
        "  ros__parameters:\n"
        "    left_wheel_names: [left_joint]\n"
        "    right_wheel_names: [right_joint]\n"
        f"    wheel_separation: {separation}\n"
        "    wheel_radius: 0.1\n"
    )


@rule(
    "MB856",
    "controller-wheels",
    WARNING,
    what="The wheels of a diff_drive_controller are not as it is told: their separation or radius "
    "is another in the package's description, left and right are swapped, or their axes point in "
    "opposite directions.",
    why="The robot turns or drives too far or the wrong way, and its odometry says otherwise.",
    fix="Write the sizes of the description, or correct its joints.",
    bad=_wheels("0.8"),
    good=_wheels("0.4"),
    line=7,
    formats=(PARAMS,),
    beside={
        "package.xml": "<package><name>rover</name></package>",
        "urdf/rover.urdf": f'<robot name="rover">{a_rover()}</robot>',
    },
)
def controller_wheels(file: NamedFile) -> Iterator[Remark]:
    """What no description of the package fits."""
    from multibot_rewrite.rules.files.wheels import faulty_wheels

    return faulty_wheels(file)


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
def undeclared_controller(file: NamedFile) -> Iterator[Remark]:
    """Controllers of ``moveit_simple_controller_manager``."""
    from multibot_rewrite.rules.files.moveit import unknown_controllers

    return unknown_controllers(file)
