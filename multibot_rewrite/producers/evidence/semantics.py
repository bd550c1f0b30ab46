# SPDX-License-Identifier: Apache-2.0
"""An SRDF beside its URDF -> what MoveIt makes of it: groups, passive and virtual joints.

Sources: srdfdom model.cpp; moveit2 robot_model.cpp (fixed and mimic joints are no variables of a
group), current_state_monitor.cpp (passive joints need no state; a virtual joint that moves is looked up
in tf), trajectory_execution_manager.cpp (a trajectory's controllers have to move all its joints).
"""

from __future__ import annotations

from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.checks.links_and_joints import Robot, read_robot
from multibot_rewrite.description.checks.planning_groups import groups_of, joints_of, text_of
from multibot_rewrite.system.records import Place

FIXED = "fixed"


class PlanningGroup(NamedTuple):
    """A group with the joints that a plan for it moves."""

    name: str
    joints: tuple[str, ...]
    place: Place


class VirtualJoint(NamedTuple):
    """What joins the root link to a frame: MoveIt plans in ``parent``. One that is not ``fixed`` has
    its state from the transform between them."""

    name: str
    type: str
    parent: str
    child: str
    place: Place


class Semantics(NamedTuple):
    """The groups of an SRDF, and its virtual joints."""

    groups: tuple[PlanningGroup, ...]
    virtual: tuple[VirtualJoint, ...]


def semantics(srdf: _Element, urdf: _Element, file: str) -> Semantics:
    """What an SRDF says of the robot of a URDF; ``file`` is the SRDF's."""
    return Semantics(
        tuple(_groups(srdf, read_robot(urdf), file)),
        tuple(_virtual(it, file) for it in srdf.iterchildren("virtual_joint")),
    )


def _groups(srdf: _Element, robot: Robot, file: str) -> Iterator[PlanningGroup]:
    groups = groups_of(srdf)
    passive = {text_of(it) for it in srdf.iter("passive_joint")}
    for name, element in groups.items():
        joints = joints_of(name, groups, robot)
        active = (it.name for it in robot.joints if it.name in joints and it.name not in passive)
        moved = tuple(it for it in dict.fromkeys(active) if _moves(robot, it))
        yield PlanningGroup(name, moved, _place(element, file))


def _moves(robot: Robot, name: str) -> bool:
    """Is it a variable of its own?"""
    joint = robot.joint[name]
    return joint.type != FIXED and "mimic" not in joint.parts


def _virtual(joint: _Element, file: str) -> VirtualJoint:
    name, type_ = text_of(joint), text_of(joint, "type")
    parent, child = text_of(joint, "parent_frame"), text_of(joint, "child_link")
    return VirtualJoint(name, type_, parent, child, _place(joint, file))


def _place(element: _Element, file: str) -> Place:
    line: int = element.sourceline or 1  # type: ignore[assignment]
    return Place(file, line)
