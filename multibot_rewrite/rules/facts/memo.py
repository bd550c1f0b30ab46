# SPDX-License-Identifier: Apache-2.0
"""What several rules need of one document, computed once and kept with its subject.

Poses, parts, sensors; and what an error may rest on: that nothing elsewhere and no other release
makes it right. What may be right all the same is a warning, or a note."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import wraps
from typing import NamedTuple, TypeVar

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING
from multibot_rewrite.base.releases import OF_OLD
from multibot_rewrite.description.checks import poses
from multibot_rewrite.description.checks.links_and_joints import Link, roots
from multibot_rewrite.description.checks.numbers import number
from multibot_rewrite.description.checks.poses import Pose, sdf_pose
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.rewriters.text import text_at
from multibot_rewrite.rules.subject import Subject

_Made = TypeVar("_Made")


def memoized(make: Callable[[Subject], _Made]) -> Callable[[Subject], _Made]:
    """Decorate a function of a subject: it runs once for each, ``subject.memo`` keeps the result."""

    @wraps(make)
    def look_up(subject: Subject) -> _Made:
        memo = subject.memo
        if make not in memo:
            memo[make] = make(subject)
        made: _Made = memo[make]
        return made

    return look_up


@memoized
def link_poses(subject: Subject) -> Mapping[str, Pose]:
    """Return each link's pose in the root of its tree, without those below an invalid origin."""
    return poses.link_poses(subject.robot)


@memoized
def driven_joints(subject: Subject) -> frozenset[str]:
    """Return the joints that ``<ros2_control>``, transmissions and plugins name."""
    uses = (it for it in subject.inventory.claims if it.site.role == "uses")
    joints = (it for it in uses if it.site.whole_value_kind == "joint")
    return frozenset(it.value for it in joints if it.site.section != "element joint")


class LinkPart(NamedTuple):
    """A ``<visual>`` or ``<collision>`` of a link: its first ``<geometry>``, and the shape in that."""

    link: _Element
    element: _Element
    geometry: _Element | None
    shape: _Element | None


@memoized
def parts(subject: Subject) -> list[LinkPart]:
    """Return all visuals of links in document order, then all collisions."""
    geometries = subject.elements.first("geometry")
    found = []
    for element in subject.elements.every("visual", "collision"):
        link = element.getparent()
        if link is not None and link.tag == "link":
            geometry = geometries.get(element)
            shape = None if geometry is None else _first_element(geometry)
            found.append(LinkPart(link, element, geometry, shape))
    return found


def _first_element(geometry: _Element) -> _Element | None:
    """Return the first element inside; quick where no comment is before it."""
    if not len(geometry):
        return None
    first = geometry[0]
    return first if isinstance(first.tag, str) else next(geometry.iterchildren("*"), None)


@memoized
def level_of_absence(subject: Subject) -> str:
    """Return the level of what a description lacks, lower if it may be a part of a robot.

    A xacro file may be one, or have it behind a condition. What is surely a part has only links
    with a parent."""
    robot = subject.robot
    is_part = robot.links and not roots(robot) and any(it not in robot.link for it in robot.below)
    levels = (WARNING, NOTE) if subject.origins else (ERROR, WARNING)
    return levels[bool(is_part)]


def lacking(subject: Subject, found: Iterable[Problem]) -> Iterator[Problem]:
    """Yield the problems of what a description lacks, at most at the level that its kind allows."""
    level = level_of_absence(subject)
    for it in found:
        yield it if level == ERROR or (it.level and level == WARNING) else it._replace(level=level)


def since_jazzy(subject: Subject) -> str:
    """Return the level of what ros2_control refuses since Jazzy: a warning for Humble, else empty."""
    return WARNING if subject.settings.distro == OF_OLD else ""


# Types that render what is in front of them, along x of their pose.
CAMERAS = frozenset((
    "camera", "depth", "depth_camera", "rgbd_camera", "rgbd", "thermal", "thermal_camera",
    "segmentation_camera", "boundingbox_camera", "wideanglecamera", "wide_angle_camera",
))  # fmt: skip
LIDARS = frozenset(("ray", "gpu_ray", "lidar", "gpu_lidar"))


class Sensor(NamedTuple):
    """A sensor, the link that has it, and its pose in the frame of the link."""

    element: _Element
    type: str
    link: Link
    pose: Pose


@memoized
def sensors(subject: Subject) -> list[Sensor]:
    """Return the sensors in blocks of declared links whose poses are numbers in the link's frame."""
    found = []
    for element in subject.elements.every("sensor"):
        block = element.getparent()
        if block is None or block.tag != "gazebo" or block.getparent() is not subject.document.root:
            continue
        link = subject.robot.link.get(block.get("reference", ""))
        written = element.find("pose")
        pose = sdf_pose("" if written is None else text_at(element, "pose"))
        said = ("relative_to", "frame", "degrees")
        is_other = written is not None and any(written.get(it) for it in said)
        if link is not None and pose is not None and not is_other:
            found.append(Sensor(element, element.get("type", ""), link, pose))
    return found


def number_at(element: _Element, path: str) -> float | None:
    """Return the number at a path; None where there is none."""
    return number(text_at(element, path) or None)
