# SPDX-License-Identifier: Apache-2.0
"""Groups and controller managers of a MoveIt file that the robots of a fleet do not have."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.naming import NAMESPACE
from multibot_rewrite.companions.kinds import MOVEIT
from multibot_rewrite.companions.moveit.rewrite import asks_below_root
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.companions.sites import slot_of
from multibot_rewrite.rules.files.records import Remark, of_robots, remark

_MANAGER = "moveit_controller_manager: "


@rule(
    "MB892",
    "moveit-groups-without-srdf",
    WARNING,
    what="The fleet renames planning groups (groups: rename), but no SRDF is given. Asked by `build` "
    "and `plan`.",
    why="Only the SRDF says which names are groups, so the groups in this file stay unchanged. "
    "move_group gets an SRDF with other groups from elsewhere and finds no solver or planner for "
    "them.",
    fix="Name the SRDF under srdf: in the fleet file.",
    bad="arm: {kinematics_solver: kdl_kinematics_plugin/KDLKinematicsPlugin}\n",
    good="joint_limits: {}\n",
    formats=(MOVEIT,),
    options={"build": True, "groups": "rename"},
)
def groups_without_srdf(file: NamedFile) -> Iterator[Remark]:
    """Each group, at its first place."""
    names = file.context.names
    asked = "group" in names.naming.separators and not names.declared.get("group")
    groups = {it.text: it for it in reversed(file.names) if it.kind == "group"}
    for text, site in groups.items() if asked and file.is_certain else ():
        message = f"groups are renamed, but no SRDF is given, so {text!r} stays unchanged"
        yield remark(site, message, "name the SRDF under srdf:")


@rule(
    "MB893",
    "moveit-one-controller-manager",
    WARNING,
    what="A file selects Ros2ControlManager, but in this layout the controller manager of each "
    "robot has another name.",
    why="Ros2ControlManager looks for a node called controller_manager, at the root or in the "
    "namespace ros_control_namespace. In a layout without namespaces there is "
    "controller_manager_robot1 only: move_group finds no controllers and executes no trajectory.",
    fix="Use moveit_simple_controller_manager, which calls the actions of the controllers, or a "
    "layout with namespaces.",
    bad=f"{_MANAGER}moveit_ros_control_interface/Ros2ControlManager\n",
    good=f"{_MANAGER}moveit_simple_controller_manager/MoveItSimpleControllerManager\n",
    formats=(MOVEIT,),
    options={"build": True, "layout": "postfix"},
)
@of_robots
def one_controller_manager(file: NamedFile) -> Iterator[Remark]:
    """Places that select a controller manager which no robot has."""
    if file.document is None or file.context.names.naming.topics == NAMESPACE:
        return
    key = asks_below_root(file.document)
    slots = [slot_of(key)] if key else []
    for slot in (*slots, *(it.slot for it in file.names if it.kind == "namespace")):
        message = "MoveIt looks for /controller_manager, but each robot's has a different name"
        yield remark(
            slot, message, "use moveit_simple_controller_manager or a layout with namespaces"
        )
