# SPDX-License-Identifier: Apache-2.0
"""The wheels of a plugin that drives a robot on two rows of them, and where they are.

Sources: gz-sim src/systems/diff_drive/DiffDrive.cc (the speed of a left wheel is (v - w *
separation / 2) / radius, that of a right one has the plus), gazebo_ros_pkgs
gazebo_plugins/src/gazebo_ros_diff_drive.cpp (ros2: the same), gazebo_ros_skid_steer_drive.cpp
(noetic-devel).
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from math import sqrt
from typing import Any, NamedTuple

from lxml.etree import _Element

from multibot_rewrite.description.checks.links_and_joints import Joint, Robot
from multibot_rewrite.description.checks.numbers import Vector, number
from multibot_rewrite.description.checks.poses import (
    Pose,
    axis_of,
    dot,
    minus,
    origin_of,
    placed,
    turned,
)
from multibot_rewrite.description.checks.shapes import around, extent_of, shapes_of
from multibot_rewrite.description.rewriters.text import text_of
from multibot_rewrite.rules.facts.memo import link_poses, memoized
from multibot_rewrite.rules.facts.model_wheels import ModelWheels, model_wheels
from multibot_rewrite.rules.subject import Subject

# Axes that point the same way, as a cosine.
ALONG = 0.99
# Relative. A wheel of a mesh may stand beside its joint, and wheels that skid turn a robot as if they
# were further apart than they are.
TOLERANCE, UNSEEN, SKIDDING = 0.1, 0.25, 2.0
# A robot that is more than a few millimetres off: CAD programs round.
ROUNDING = 0.003
# As cosines; and a step that a suspension does not explain, in metres.
_UPRIGHT, _CROSS, _STEP = 0.9, 0.3, 0.01


class Tags(NamedTuple):
    """How a plugin calls its wheels and their sizes.

    ``radius_of`` is the radius in its unit: 0.5 for a diameter. ``turns_left`` says that the left
    wheels are slower in a turn to the left."""

    left: Sequence[str]
    right: Sequence[str]
    separation: str
    radius: str
    radius_of: float
    defaults: tuple[float, float]
    turns_left: bool = True


_GZ = Tags(("left_joint",), ("right_joint",), "wheel_separation", "wheel_radius", 1, (1.0, 0.2))
_ROS_2 = Tags(
    ("left_joint",), ("right_joint",), "wheel_separation", "wheel_diameter", 0.5, (0.34, 0.15)
)
_ROS_1 = Tags(
    ("leftJoint",), ("rightJoint",), "wheelSeparation", "wheelDiameter", 0.5, (0.34, 0.15), False
)
_SKID = Tags(
    ("leftFrontJoint", "leftRearJoint"),
    ("rightFrontJoint", "rightRearJoint"),
    "wheelSeparation",
    "wheelDiameter",
    0.5,
    (0.4, 0.15),
    False,
)
TAGS: Mapping[str, tuple[Tags, ...]] = {
    "gz-sim-diff-drive-system": (_GZ,),
    "gazebo_ros_diff_drive": (_ROS_2, _ROS_1),
    "gazebo_ros_skid_steer_drive": (_SKID,),
}


class Wheel(NamedTuple):
    """A driven wheel in the root's frame: joint, link's pose, axis, and the element that names it."""

    named: Any
    joint: Joint
    pose: Pose
    axis: Vector


class Drive(NamedTuple):
    """A plugin, its wheels, and the elements of its sizes, None where it takes its default.

    ``robot`` has the links of the wheels: of an SDF those of the model that the plugin is in."""

    robot: Robot
    plugin: _Element
    tags: Tags
    left: tuple[Wheel, ...]
    right: tuple[Wheel, ...]
    sizes: Mapping[str, _Element | None]

    @property
    def pairs(self) -> list[tuple[Wheel, Wheel]]:
        """Pairs of a left and a right wheel, in the order they are named in."""
        return list(zip(self.left, self.right, strict=False))


@memoized
def drives(subject: Subject) -> list[Drive]:
    """Return the drives of a robot that name wheels on both sides."""
    found = (
        _drive(subject, plugin, TAGS[name])
        for plugin, section in subject.inventory.served
        for name in section.names
        if name in TAGS
    )
    return [it for it in found if it is not None]


def wheel_joints(subject: Subject) -> Iterator[tuple[_Element, Joint]]:
    """Yield each joint that a drive names as a wheel's, and the element that names it."""
    for plugin, section in subject.inventory.served:
        kinds = next((TAGS[it] for it in section.names if it in TAGS), ())
        names = {tag for it in kinds for tag in (*it.left, *it.right)}
        model = _wheels_of_model(plugin) if names else None
        for element in plugin.iterchildren(*names) if names else ():
            name = text_of(element)
            of_model = model.wheels.get(name) if model else None
            joint = of_model[0] if of_model else subject.robot.joint.get(name)
            if joint is not None:
                yield element, joint


def _wheels_of_model(plugin: _Element) -> ModelWheels | None:
    above = plugin.getparent()
    return model_wheels(above) if above is not None and above.tag == "model" else None


def _drive(subject: Subject, plugin: _Element, kinds: Sequence[Tags]) -> Drive | None:
    """Return the drive that a plugin is; None if it names no wheels on both sides."""
    model = _wheels_of_model(plugin)
    for tags in kinds:
        left, right = (tuple(_wheels(subject, model, plugin, it)) for it in (tags.left, tags.right))
        if left and right:
            sizes = {it: plugin.find(it) for it in (tags.separation, tags.radius)}
            robot = model.robot if model else subject.robot
            return Drive(robot, plugin, tags, left, right, sizes)
    return None


def _wheels(
    subject: Subject, model: ModelWheels | None, plugin: _Element, tags: Sequence[str]
) -> Iterator[Wheel]:
    """Yield the wheels that a plugin names by these tags."""
    for it in plugin.iterchildren(*tags):
        name = text_of(it)
        if model is None:
            found = wheel_of(subject, name, it)
        else:
            found = Wheel(it, *model.wheels[name]) if name in model.wheels else None
        if found is not None:
            yield found


def wheel_of(subject: Subject, name: str, named: object) -> Wheel | None:
    """Return the wheel on a joint; None if its place or its axis is unknown."""
    joint = subject.robot.joint.get(name)
    axis = None if joint is None else axis_of(joint)
    pose = None if joint is None else link_poses(subject).get(joint.child)
    if joint is None or axis is None or pose is None:
        return None
    return Wheel(named, joint, pose, turned(pose.matrix, axis))


def size_of(drive: Drive, name: str, default: float) -> float | None:
    """Return a size as the plugin reads it; None where it is no number."""
    element = drive.sizes[name]
    return default if element is None else number(text_of(element))


class Measured(NamedTuple):
    """What a size may be, and what it is best."""

    low: float
    high: float
    best: float

    def holds(self, value: float) -> bool:
        """Return whether a size is one of these."""
        return self.low <= value <= self.high


def separation(robot: Robot, left: Wheel, right: Wheel, several: bool) -> Measured | None:
    """Return how far two wheels are apart; None if not parallel. ``several`` of a side skid."""
    if abs(dot(left.axis, right.axis)) < ALONG:
        return None
    slack = TOLERANCE if radii(robot, left) else UNSEEN
    found = [
        abs(apart(one, other, left.axis))
        for one in middles(robot, left)
        for other in middles(robot, right)
    ]
    most = SKIDDING if several else 1 + slack
    low, high = min(found) * (1 - slack) - ROUNDING, max(found) * most + ROUNDING
    return Measured(low, high, found[0]) if found[0] > ROUNDING else None


def radius(robot: Robot, wheels: Iterable[Wheel]) -> Measured | None:
    """Return the radius of the round shapes of all wheels; None where none has one."""
    found = [it for wheel in wheels for it in radii(robot, wheel)]
    if not found:
        return None
    low, high = min(found) * (1 - TOLERANCE) - ROUNDING, max(found) * (1 + TOLERANCE) + ROUNDING
    return Measured(low, high, max(found))


def are_swapped(left: Wheel, right: Wheel) -> float:
    """Return how far the left wheel is on the right, if both roll forward; 0 if left or unknown."""
    if dot(left.axis, right.axis) < ALONG or abs(left.axis[2]) > 1 - ALONG:
        return 0.0
    across = apart(left.pose.at, right.pose.at, left.axis)
    return -across if across < -ROUNDING else 0.0


def are_opposite(left: Wheel, right: Wheel) -> bool:
    """Return whether the axes of two wheels point in opposite directions."""
    return dot(left.axis, right.axis) < -ALONG


def rolling_faults(robot: Robot, left: Wheel, right: Wheel) -> Iterator[str]:
    """Yield why two wheels of one axle would not roll, such as an upright axis or two heights."""
    for wheel in (left, right):
        name = wheel.joint.name
        if abs(wheel.axis[2]) > _UPRIGHT:
            yield f"the axis of wheel {name!r} is upright: it turns like a turntable"
        elif lies_flat(robot, wheel):
            yield f"wheel {name!r} is a cylinder that does not turn about its own axis"
    one, other = left.pose.at, right.pose.at
    across = (one[0] - other[0], one[1] - other[1], 0.0)
    flat = abs(left.axis[2]) <= 1 - ALONG and abs(dot(left.axis, right.axis)) > ALONG
    length = sqrt(dot(across, across))
    if flat and length > 0 and abs(dot(left.axis, across)) < _CROSS * length:
        yield f"the axis of wheel {left.joint.name!r} does not point to {right.joint.name!r}"
    higher = one[2] - other[2]
    if abs(higher) > max(_STEP, 0.1 * max([*radii(robot, left), *radii(robot, right), 0.0])):
        names = f"{left.joint.name!r} and {right.joint.name!r}"
        yield f"wheels {names} are at two heights, {abs(higher):.3g} m apart"


def lies_flat(robot: Robot, wheel: Wheel) -> bool:
    """Return whether a wheel that touches the ground is nothing but cylinders across its axis."""
    link = robot.link.get(wheel.joint.child)
    shapes = list(shapes_of(link.element, "collision")) if link else []
    across = [
        abs(dot(turned(placed(wheel.pose, own).matrix, (0.0, 0.0, 1.0)), wheel.axis)) < 1 - ALONG
        for element, shape in shapes
        if shape.tag == "cylinder" and (own := origin_of(element)) is not None
    ]
    return bool(across) and len(across) == len(shapes) and all(across)


def radii(robot: Robot, wheel: Wheel) -> list[float]:
    """Return the radii of a wheel's round collisions, or of its visuals if it has no collision."""
    for tag in ("collision", "visual"):
        found = []
        for shape, pose in _turning_shapes(robot, wheel, tag):
            along = turned(pose.matrix, (0.0, 0.0, 1.0))
            is_round = shape.tag == "sphere" or abs(dot(along, wheel.axis)) > ALONG
            size = number(shape.get("radius")) if is_round else None
            found += [] if size is None else [size]
        if found:
            return found
    return []


def _turning_shapes(robot: Robot, wheel: Wheel, tag: str) -> Iterator[tuple[_Element, Pose]]:
    """Yield the shapes of all that turns with a wheel, each with its pose."""
    # The links fixed to a wheel, itself first, with their poses in the root.
    found = [(wheel.joint.child, wheel.pose)]
    for name, pose in found:  # grows
        for joint in robot.below.get(name, ()):
            own = origin_of(joint.element) if joint.type == "fixed" else None
            if own is not None and len(found) < len(robot.links):
                found.append((joint.child, placed(pose, own)))
    for name, pose in found:
        link = robot.link.get(name)
        for element, shape in shapes_of(link.element, tag) if link else ():
            own = origin_of(element)
            if own is not None:
                yield shape, placed(pose, own)


def middles(robot: Robot, wheel: Wheel) -> list[Vector]:
    """Return where a wheel may be: at its joint, in the middle of its shapes."""
    found = [wheel.pose.at]
    for tag in ("collision", "visual"):
        extents = (extent_of(shape, pose) for shape, pose in _turning_shapes(robot, wheel, tag))
        box = around(it for it in extents if it is not None)
        found += [] if box is None else [box.middle]
    return found


def apart(one: Vector, other: Vector, axis: Vector) -> float:
    """Return how far two points are from each other along an axis; signed."""
    return dot(minus(one, other), axis)
