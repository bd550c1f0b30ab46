# SPDX-License-Identifier: Apache-2.0
"""The simulated sensors of a description, and where they look from."""

from __future__ import annotations

from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.description.checks.links_and_joints import Link
from multibot_rewrite.description.checks.numbers import number
from multibot_rewrite.description.checks.poses import Pose, sdf_pose
from multibot_rewrite.description.rewriters.text import text_at
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.subject import Subject

# Types that render what is in front of them, along x of their pose.
CAMERAS = frozenset(
    (
        "camera",
        "depth",
        "depth_camera",
        "rgbd_camera",
        "rgbd",
        "thermal",
        "thermal_camera",
        "segmentation_camera",
        "boundingbox_camera",
        "wideanglecamera",
        "wide_angle_camera",
    )
)
LIDARS = frozenset(("ray", "gpu_ray", "lidar", "gpu_lidar"))


class Sensor(NamedTuple):
    """A sensor, the link that has it, and its pose in the frame of the link."""

    element: _Element
    type: str
    link: Link
    pose: Pose


@memoized
def sensors(subject: Subject) -> list[Sensor]:
    """The sensors in the blocks of declared links whose poses are numbers in the link's frame."""
    found = []
    for element in subject.elements.every("sensor"):
        block = element.getparent()
        if block is None or block.tag != "gazebo" or block.getparent() is not subject.document.root:
            continue
        link = subject.robot.link.get(block.get("reference", ""))
        written = element.find("pose")
        pose = sdf_pose("" if written is None else text_at(element, "pose"))
        if link is not None and pose is not None and (written is None or not _relative(written)):
            found.append(Sensor(element, element.get("type", ""), link, pose))
    return found


def _relative(pose: _Element) -> bool:
    return bool(pose.get("relative_to") or pose.get("frame") or pose.get("degrees"))


def number_at(element: _Element, path: str) -> float | None:
    """The number at a path; None where there is none."""
    return number(text_at(element, path) or None)
