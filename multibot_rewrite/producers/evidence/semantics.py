# SPDX-License-Identifier: Apache-2.0
"""What MoveIt makes of an SRDF and its URDF, and which joints its controllers move.

Sources: srdfdom model.cpp; moveit2 robot_model.cpp (fixed and mimic joints are no variables of a
group), current_state_monitor.cpp (passive joints need no state; a virtual joint that moves is looked up
in tf), trajectory_execution_manager.cpp (a trajectory's controllers have to move all its joints).

moveit_simple_controller_manager_plugin.cpp has ``controller_names``, and of each a map."""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

import yaml
from lxml.etree import _Element

from multibot_rewrite.description.checks.links_and_joints import read_robot
from multibot_rewrite.description.checks.planning_groups import groups_of, joints_of, text_of
from multibot_rewrite.knowledge.records import MOVE_GROUP
from multibot_rewrite.related_files.moveit.file_kind import NAMES, SIMPLE
from multibot_rewrite.related_files.yaml_text import YamlText, items, line_of, pairs
from multibot_rewrite.system.records import CLAIMS, EXPORTS, JOINT, Interface, Place, System

FIXED = "fixed"
JOINTS = "joints"


class PlanningGroup(NamedTuple):
    """A group with the joints that a plan for it moves."""

    name: str
    joints: tuple[str, ...]
    place: Place


class VirtualJoint(NamedTuple):
    """What joins the root link to ``parent``, where MoveIt plans; it moves unless it is ``fixed``."""

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
    """Return an SRDF's virtual joints and groups, with the joints of the URDF that each moves."""
    virtual = []
    for it in srdf.iterchildren("virtual_joint"):
        parent, child = text_of(it, "parent_frame"), text_of(it, "child_link")
        own = text_of(it), text_of(it, "type"), parent, child
        virtual.append(VirtualJoint(*own, _place(it, file)))
    robot, groups = read_robot(urdf), groups_of(srdf)
    passive = {text_of(it) for it in srdf.iter("passive_joint")}
    planned = []
    for name, element in groups.items():
        joints = joints_of(name, groups, robot)
        active = (it.name for it in robot.joints if it.name in joints and it.name not in passive)
        joined = ((it, robot.joint[it]) for it in dict.fromkeys(active))
        # Those that are variables of their own.
        moved = tuple(it for it, own in joined if own.type != FIXED and "mimic" not in own.parts)
        planned.append(PlanningGroup(name, moved, _place(element, file)))
    return Semantics(tuple(planned), tuple(virtual))


def _place(element: _Element, file: str) -> Place:
    line: int = element.sourceline or 1  # type: ignore[assignment]
    return Place(file, line)


def managers(node: yaml.Node | None) -> Iterator[yaml.Node]:
    """Yield each map below ``moveit_simple_controller_manager``, at any depth of a file."""
    for key, value in pairs(node):
        if key.value == SIMPLE:
            yield value
        elif isinstance(value, yaml.MappingNode):
            yield from managers(value)


def controllers_of(manager: yaml.Node) -> Iterator[tuple[yaml.ScalarNode, yaml.Node]]:
    """Yield the listed controllers that have a map: its key and the map."""
    below = {key.value: (key, value) for key, value in pairs(manager)}
    yield from (below[str(it.value)] for it in listed(manager, NAMES) if it.value in below)


def listed(holder: yaml.Node, key: str) -> list[yaml.ScalarNode]:
    """Return the names that a map lists under a key: a manager's controllers, a controller's joints."""
    value = next((value for name, value in pairs(holder) if name.value == key), None)
    return [it for it in items(value) if isinstance(it, yaml.ScalarNode)]


def planning_system(documents: Iterable[YamlText], semantics: Semantics) -> System:
    """Return a system with the joints that MoveIt's controllers move and the SRDF's groups plan for."""
    moved = (
        Interface(
            JOINT, str(joint.value), f"/{key.value}", EXPORTS, Place(document.file, line_of(joint))
        )
        for document in documents
        for manager in managers(document.root)
        for key, body in controllers_of(manager)
        for joint in listed(body, JOINTS)
    )
    planned = (
        Interface(JOINT, joint, f"/{MOVE_GROUP}", CLAIMS, group.place)
        for group in semantics.groups
        for joint in group.joints
    )
    return System(interfaces=(*moved, *planned))
