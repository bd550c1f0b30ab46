# SPDX-License-Identifier: Apache-2.0
"""Several arms as one robot: their URDFs below one world link, their SRDFs in one.

Sources: urdfdom model.cpp (a material that is declared twice ends the reading), moveit2 2.12.4
robot_model.cpp (``buildModel``: a virtual joint counts only where its child is the root link).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from lxml import etree
from lxml.etree import _Element

from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.nearest import did_you_mean_one_of
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.joining.join import Given, join_texts
from multibot_rewrite.description.joining.kept import without_marks
from multibot_rewrite.description.joining.part import Part
from multibot_rewrite.description.joining.semantic import without_virtual_joints, xml_text
from multibot_rewrite.description.readback.xml import read_xml
from multibot_rewrite.description.rewriters.tree import Tree
from multibot_rewrite.fleet.file.cell_file import Cell
from multibot_rewrite.fleet.file.robot_spec import Pose

_STANDING = Pose()


class Arm(NamedTuple):
    """A robot of a cell: its written URDF and SRDF, the word in its frames, where it stands; ``place``
    is its line of the fleet file."""

    name: str
    tag: str
    urdf: bytes
    srdf: bytes
    pose: Pose | None
    place: str


def joined_urdf(name: str, world: str, arms: Sequence[Arm], tree: Tree) -> bytes:
    """One URDF of all arms, each fixed to the link ``world`` where it stands.

    Raises InputError for an arm that has no place, and as ``join_texts``.
    """
    root = etree.Element("robot", name=name)
    etree.SubElement(root, "link", name=world)
    parts = [Given(Part("", name=name), etree.tostring(root), name)]
    for arm in arms:
        pose = tuple(arm.pose or _STANDING)
        part = Part("", world, pose, name=arm.tag)
        _check_place(arm, _root_link(read_xml(arm.urdf, arm.place), arm), world)
        parts.append(Given(part, arm.urdf, f"{arm.place}: cell: robot {arm.name!r}"))
    return without_marks(join_texts(parts, tree).data)


def joined_srdf(cell: Cell, arms: Sequence[Arm]) -> bytes:
    """One SRDF with what all arms have, and the cell's own groups.

    A virtual joint says where an arm stands: the URDF of the cell does. Raises InputError for one that
    moves, for groups of one name, and for groups of the cell that name others.
    """
    root = etree.Element("robot", name=cell.name)
    for arm in arms:
        own = read_xml(arm.srdf, arm.place)
        for it in own.iterchildren("virtual_joint"):
            _check_stands(it, arm)
        without_virtual_joints(own)
        root.extend(list(own))
    known = [it.get("name", "") for it in root.iterchildren("group")]
    for name, parts in cell.groups.items():
        _check_parts(cell, name, parts, known)
        group = etree.SubElement(root, "group", name=name)
        group.extend(etree.Element("group", name=it) for it in parts)
    _check_names(root, ("group", "end_effector"), arms)
    return xml_text(root)


def _root_link(own: _Element, arm: Arm) -> str:
    below = {it.get("link") for it in own.iterfind("joint/child")}
    found = [it.get("name", "") for it in own.iterchildren("link") if it.get("name") not in below]
    if own.tag != "robot" or len(found) != 1:
        what = f"{len(found)} root links" if own.tag == "robot" else f"a description in <{own.tag}>"
        raise InputError(
            f"{arm.place}: cell: robot {arm.name!r} has {what}; give it a URDF with one"
        )
    return found[0]


def _check_place(arm: Arm, base: str, world: str) -> None:
    where = f"{arm.place}: cell: robot {arm.name!r}"
    if base == world and arm.pose not in (None, _STANDING):
        what = f"has a pose, but its description fixes it to {world!r}"
        raise InputError(f"{where} {what}; set shared_frames: [map], or remove the pose")
    if base != world and arm.pose is None:
        raise InputError(
            f"{where} has no pose; write where it stands in {world!r}: pose: {{x: 0.5}}"
        )


def _check_stands(joint: _Element, arm: Arm) -> None:
    if joint.get("type") != "fixed":
        what = (
            f"the virtual joint {joint.get('name')!r} of robot {arm.name!r} is {joint.get('type')}"
        )
        raise InputError(f"{arm.place}: cell: {what}; an arm of a cell stands: make it fixed")


def _check_parts(cell: Cell, name: str, parts: Sequence[str], known: Sequence[str]) -> None:
    where = f"{cell.place}: cell: group {name!r}"
    if name in known:
        raise InputError(f"{where} is a group of one arm; write another name")
    for it in parts:
        if it not in known:
            near = did_you_mean_one_of(it, known) or "name a group of an SRDF"
            raise InputError(f"{where}: no arm has a group {it!r}; {near}")


def _check_names(root: _Element, tags: Iterable[str], arms: Sequence[Arm]) -> None:
    for tag in tags:
        seen: set[str] = set()
        for it in root.iterchildren(tag):
            name = it.get("name", "")
            if name in seen:
                hint = "set groups: rename" if tag in ("group", "end_effector") else "rename one"
                what = f"two robots have the {tag} {name!r}"
                raise InputError(f"{arms[0].place}: cell: {what}; {hint}")
            seen.add(name)
