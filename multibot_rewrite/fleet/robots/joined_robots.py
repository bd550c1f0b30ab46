# SPDX-License-Identifier: Apache-2.0
"""Robots that are joined of parts: one description, SRDF and parameter file each, made before all else.

They are texts of files that are on no disk; what reads a file of a robot takes them by their paths.
"""

import os
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from lxml import etree
from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import NOTE, Finding, declare
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.nearest import did_you_mean_one_of
from multibot_rewrite.base.releases import ROS_2
from multibot_rewrite.description.joining.join import GivenPart, join_texts
from multibot_rewrite.description.joining.kept import without_marks
from multibot_rewrite.description.joining.part import Part
from multibot_rewrite.description.joining.semantic import PartSemantics, joined_srdf, xml_text
from multibot_rewrite.description.readback.xml import read_xml
from multibot_rewrite.description.rewriters.tree import Tree, builtin_tree
from multibot_rewrite.description.sources.own_names import filled
from multibot_rewrite.description.sources.read import JOIN, is_xacro
from multibot_rewrite.fleet.file.domains import Cell
from multibot_rewrite.fleet.file.fleet_file import FleetFile
from multibot_rewrite.fleet.file.robot_spec import Pose, RobotSpec
from multibot_rewrite.related_files.join import Joined, join_plain
from multibot_rewrite.related_files.named_file import MOVEIT, PARAMS, RVIZ

ABOUT_PARTS = declare("MF848", "joined-parts", NOTE, formats=("fleet",))


def with_joined(file: FleetFile, trust: bool) -> tuple[FleetFile, Mapping[str, Sequence[Finding]]]:
    """Return the fleet with joined descriptions, findings by robot; raises as ``join_plain``."""
    found: dict[str, Joined] = {}
    notes: dict[str, Sequence[Finding]] = {}
    robots = []
    for it in file.robots:
        if not it.parts or it.description in dict(it.filled):
            robots.append(it)
            continue
        own = filled(it.arguments, it.name)
        given = tuple(
            part._replace(xacro_args={**own, **part.xacro_args})
            if is_xacro(str(part.description))
            else part
            for part in it.parts
        )
        key = repr(given)
        if key not in found:
            tree = builtin_tree(file.definitions, file.distro, ROS_2)
            found[key] = join_plain(given, f"{it.file}:{it.line}", tree, trust)
            hint = "see what it means for the robot; multibot join shows the files"
            said = (f"robot {it.name!r} is joined of parts: {text}" for text in found[key].notes)
            notes[it.name] = [
                ABOUT_PARTS.finding(text, hint, file=it.file, line=it.line) for text in said
            ]
        robots.append(_with_files(it, found[key]))
    return file._replace(robots=tuple(robots)), notes


def _with_files(robot: RobotSpec, made: Joined) -> RobotSpec:
    """Return the robot with its texts; an SRDF of its own replaces that of the parts."""
    folder, name = os.path.split(robot.description)
    below = robot.description if name.endswith(JOIN) else folder
    stem = os.path.join(below, name.removesuffix(JOIN).removesuffix(".urdf"))
    beside = {f"{stem}_controllers.yaml": made.controllers} if made.controllers else {}
    moveit = {os.path.join(below, it): data for it, data in made.moveit.items()}
    window = {f"{stem}.rviz": made.rviz} if made.rviz else {}
    texts = {robot.description: made.data, **beside, **moveit, **window}
    if made.srdf and not robot.srdf:
        robot = robot._replace(srdf=f"{stem}.srdf")
        texts[robot.srdf] = made.srdf
    related_files = dict(robot.related_files)
    for kind, more in ((PARAMS, beside), (MOVEIT, moveit), (RVIZ, window)):
        if more:
            related_files[kind] = (*more, *related_files.get(kind, ()))
    filled_in = ((path, data.decode()) for path, data in texts.items())
    return robot._replace(related_files=related_files, filled=(*robot.filled, *filled_in))


# Several arms as one robot: the robots of a cell, as they are written, joined at one world link.
# Source: moveit2 2.12.4 robot_model.cpp (``buildModel``: a virtual joint counts only where its child is
# the root link).
_STANDING = Pose()


class Arm(NamedTuple):
    """A robot of a cell: URDF and SRDF, the word in its frames, its pose, its line in the file."""

    name: str
    tag: str
    urdf: bytes
    srdf: bytes
    pose: Pose | None
    place: str

    @property
    def where(self) -> str:
        """Return the place in the fleet file with which a message about the arm begins."""
        return f"{self.place}: cell: robot {self.name!r}"


def joined_arms(cell: Cell, world: str, arms: Sequence[Arm], tree: Tree) -> Mapping[str, bytes]:
    """Return one URDF and one SRDF of all arms, by their endings.

    Each arm is fixed to the link ``world`` at its pose. Raises InputError for an arm without a
    pose or one that moves, for groups that do not exist, and as ``join_texts`` and
    ``joined_srdf``."""
    root = etree.Element("robot", name=cell.name)
    etree.SubElement(root, "link", name=world)
    parts = [GivenPart(Part("", name=cell.name), etree.tostring(root), cell.name)]
    for arm in arms:
        part = Part("", world, tuple(arm.pose or _STANDING), name=arm.tag)
        parts.append(GivenPart(part, arm.urdf, arm.where))
    made = join_texts(parts, tree)
    own, *others = (it.part for it in made.parts)
    semantics = [PartSemantics(own, b"", "")]
    for arm, read in zip(arms, others, strict=True):
        if read.root == world and arm.pose not in (None, _STANDING):
            what = f"has a pose, but its description fixes it to {world!r}"
            raise InputError(f"{arm.where} {what}; set shared_frames: [map], or remove the pose")
        if read.root != world and arm.pose is None:
            what = f"has no pose; write its place in {world!r}: pose: {{x: 0.5}}"
            raise InputError(f"{arm.where} {what}")
        # A virtual joint says where an arm stands; in a cell the URDF does.
        for it in read_xml(arm.srdf, arm.place).iterchildren("virtual_joint"):
            if it.get("type") != "fixed":
                what = f"its virtual joint {it.get('name')!r} is {it.get('type')}"
                raise InputError(f"{arm.where}: {what}; arms of a cell are fixed: make it fixed")
        semantics.append(PartSemantics(read, arm.srdf, arm.where))
    srdf = read_xml(joined_srdf(semantics, made.data, hint="set groups: rename").data, cell.place)
    _add_groups(srdf, cell)
    return {".urdf": without_marks(made.data), ".srdf": xml_text(srdf)}


def _add_groups(srdf: _Element, cell: Cell) -> None:
    known = [it.get("name", "") for it in srdf.iterchildren("group")]
    for name, parts in cell.groups.items():
        place = f"{cell.place}: cell: group {name!r}"
        if name in known:
            raise InputError(f"{place} is a group of one arm; write another name")
        for it in (it for it in parts if it not in known):
            near = did_you_mean_one_of(it, known) or "name a group of an SRDF"
            raise InputError(f"{place}: no arm has a group {it!r}; {near}")
        group = etree.SubElement(srdf, "group", name=name)
        group.extend(etree.Element("group", name=it) for it in parts)
