# SPDX-License-Identifier: Apache-2.0
"""The links and joints of an SDF model as those of a URDF, as far as rules about wheels ask for them.

Source: sdformat.org, joint.sdf and "Pose Frame Semantics": an axis is in the frame of its joint, or in
the one that it is ``expressed_in``; up to SDF 1.6 in that of the model if it says so.
"""

from typing import NamedTuple

from lxml import etree
from lxml.etree import _Element

from multibot_rewrite.base.model import InputError
from multibot_rewrite.description.checks.links_and_joints import Joint, Robot, read_robot
from multibot_rewrite.description.checks.numbers import Vector, numbers, vector
from multibot_rewrite.description.checks.poses import Pose, turned
from multibot_rewrite.description.checks.sdf_frames import Frames, Named, ends_of, named_in


class ModelWheels(NamedTuple):
    """A model's links with their shapes, and its joints: the child's pose and the axis in the model."""

    robot: Robot
    wheels: dict[str, tuple[Joint, Pose, Vector]]


def model_wheels(model: _Element) -> ModelWheels | None:
    """Return a model's wheels; None if its poses are defined in a circle."""
    frames = Frames({it.name: it for it in named_in(model, "")}, "")
    root = etree.Element("robot")
    wheels = {}
    try:
        for ends in ends_of(frames).values():
            it = frames.named[ends.joint]
            type_ = it.element.get("type", "")
            joint = Joint(it.name, type_, ends.parent, ends.child, it.element, {})
            axis = _axis(frames, it)
            if axis is not None:
                wheels[it.name] = (joint, frames.pose(ends.child), axis)
    except InputError:
        return None
    for it in frames.named.values():
        if it.tag == "link":
            root.append(_urdf_link(it))
    return ModelWheels(read_robot(root), wheels)


def _axis(frames: Frames, joint: Named) -> Vector | None:
    """Return the axis of a joint in the model; None for one that is no vector."""
    written = joint.element.find("axis/xyz")
    axis = (0.0, 0.0, 1.0) if written is None else vector(written.text or "")
    if axis is None or joint.text("axis/use_parent_model_frame") in ("1", "true"):
        return axis
    within = "" if written is None else written.get("expressed_in", "")
    return turned(frames.pose(joint.within(within) if within else joint.name).matrix, axis)


def _urdf_link(link: Named) -> _Element:
    """Return a link of SDF as one of URDF, without shapes whose pose cannot be read."""
    made = etree.Element("link", name=link.name)
    for written in link.element.iterchildren("collision", "visual"):
        pose = written.find("pose")
        six = (0.0,) * 6 if pose is None else numbers(pose.text or "") or (0.0,) * 6
        if len(six) != 6 or (pose is not None and pose.attrib):
            continue
        element = etree.SubElement(made, str(written.tag))
        at, turn = (" ".join(map(repr, it)) for it in (six[:3], six[3:]))
        etree.SubElement(element, "origin", xyz=at, rpy=turn)
        geometry = etree.SubElement(element, "geometry")
        for shape in written.iterfind("geometry/*"):
            sizes = {it: (shape.findtext(it) or "").strip() for it in ("size", "radius", "length")}
            etree.SubElement(geometry, str(shape.tag), {k: v for k, v in sizes.items() if v})
    return made
