# SPDX-License-Identifier: Apache-2.0
"""Sensors against the robot: what they look at, and from where."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import WARNING, rule
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.description.checks.numbers import Vector
from multibot_rewrite.description.checks.poses import (
    Pose,
    dot,
    inverse,
    minus,
    origin_of,
    placed,
    turned,
)
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.checks.shapes import shapes_of, way_out
from multibot_rewrite.knowledge.worlds import CLASSIC, GAZEBO
from multibot_rewrite.rules.facts import simulators
from multibot_rewrite.rules.facts.memo import (
    CAMERAS,
    LIDARS,
    Sensor,
    link_poses,
    number_at,
    sensors,
)
from multibot_rewrite.rules.facts.support import ground_of
from multibot_rewrite.rules.subject import Subject

X: Vector = (1.0, 0.0, 0.0)
Y: Vector = (0.0, 1.0, 0.0)
Z: Vector = (0.0, 0.0, 1.0)
# As a cosine: some two degrees.
SAME = 0.9995
SUNK = 0.005
_OPTICAL = lazy_compile(r"(?:^|[_/-])optical(?:[_/-]?(?:frame|link|joint))?(?:[_/-]\w{1,3})?$")


@rule("MB625", "optical-frame-not-rotated", WARNING)
def optical_frame_not_rotated(subject: Subject) -> Iterator[Problem]:
    """Report optical links that are not rotated, and whose parents are not rotated either."""
    for link in subject.robot.links:
        if not _OPTICAL.search(link.name.lower()):
            continue
        joint = next(iter(subject.robot.above.get(link.name, ())), None)
        if joint is None or joint.type != "fixed" or "optical" in joint.parent.lower():
            continue
        pose = link_poses(subject).get(link.name)
        if pose is not None and _is_straight(pose) and _is_straight(origin_of(joint.element)):
            message = f"optical frame {link.name!r} is not turned: its z points up, not forward"
            hint = 'give the joint rpy="-1.5708 0 -1.5708"'
            yield Problem(joint.parts.get("origin", joint.element), message, None, hint)


def _is_straight(pose: Pose | None) -> bool:
    """Return whether a pose leaves x forward and z up."""
    return (
        pose is not None and turned(pose.matrix, X)[0] > SAME and turned(pose.matrix, Z)[2] > SAME
    )


@rule("MB626", "camera-at-optical-frame", WARNING)
def camera_at_optical_frame(subject: Subject) -> Iterator[Problem]:
    """Report cameras at a link that its joint rotates as an optical frame, without an own rotation."""
    for it in sensors(subject):
        if it.type not in CAMERAS or "optical" not in it.link.name.lower():
            continue
        for joint in subject.robot.above.get(it.link.name, ())[:1]:
            own = origin_of(joint.element)
            # To the right of the parent with x, forward with z.
            is_optical = (
                own and dot(turned(own.matrix, X), Y) < -SAME and turned(own.matrix, Z)[0] > SAME
            )
            if is_optical and turned(it.pose.matrix, X)[0] > SAME:
                names = f"{it.link.name!r} looks to the right of {joint.parent!r}"
                hint = f"put it at {joint.parent!r}"
                yield Problem(it.element, f"camera at optical frame {names}", None, hint)


@rule("MB627", "sensor-in-ground", WARNING)
def sensor_in_ground(subject: Subject) -> Iterator[Problem]:
    """Report sensors below the lowest point of all driven wheels."""
    found = [it for it in sensors(subject) if it.type in CAMERAS | LIDARS]
    ground = ground_of(subject) if found else None
    if ground is None:
        return
    for it in found:
        pose = link_poses(subject).get(it.link.name)
        height = None if pose is None else placed(pose, it.pose).at[2] - ground
        if height is not None and height < -SUNK:
            message = f"{it.type} at link {it.link.name!r} is {-height:.3g} m below the ground"
            yield Problem(it.element, message, None, "correct the joints above it, or its <pose>")


@rule("MB628", "scan-turned-around", WARNING)
def scan_turned_around(subject: Subject) -> Iterator[Problem]:
    """Report ranges and angles; a Classic lidar that casts rays swaps inverted angles itself."""
    for it in subject.elements.every("lidar", "ray", "logical_camera"):
        sensor = it.getparent()
        casts = sensor is not None and sensor.get("type") == "ray"
        for part, low, high in _BOUNDS[:1] if casts else _BOUNDS:
            for element in it.iterfind(part):
                least, most = number_at(element, low), number_at(element, high)
                place = element.find(low)
                if place is not None and least is not None and most is not None and least > most:
                    message = f"{low} {least:g} is above {high} {most:g}"
                    yield Problem(place, message, "", "swap them")


_BOUNDS = (
    ("range", "min", "max"),
    ("scan/horizontal", "min_angle", "max_angle"),
    ("scan/vertical", "min_angle", "max_angle"),
    (".", "near", "far"),
)


@rule("MB629", "camera-clip", WARNING)
def camera_clip(subject: Subject) -> Iterator[Problem]:
    """Yield cameras whose near plane is not before the far one; sdformat's defaults are 0.1 and 100."""
    for it in subject.elements.every("clip"):
        near, far = number_at(it, "near"), number_at(it, "far")
        near, far = (0.1 if near is None else near), (100.0 if far is None else far)
        places = [at for tag in ("near", "far") if (at := it.find(tag)) is not None]
        if places and (near <= 0 or near >= far):
            message = f"the camera sees from {near:g} m to {far:g} m"
            yield Problem(places[0], message, "", "write a near above 0 and below far")


@rule("MB630", "lidar-in-its-housing", WARNING)
def lidar_in_its_housing(subject: Subject) -> Iterator[Problem]:
    """Report lidars that cast rays at collisions; on a graphics card they pass faces from behind."""
    for it in sensors(subject):
        near = number_at(it.element, "ray/range/min") if it.type == "ray" else None
        way = 0.0 if near is None else _way_out(it)
        if near is not None and way > near:
            message = f"lidar of link {it.link.name!r} starts inside its collision shape"
            hint = f"a <min> above {way:.3g} would be outside of it"
            sizes = f"{way:.3g} m to its side, <min> is {near:g}"
            yield Problem(it.element, f"{message}: {sizes}", None, hint)


def _way_out(sensor: Sensor) -> float:
    """Return how far a ray along x is inside a collision shape of the sensor's link."""
    found = [0.0]
    for element, shape in shapes_of(sensor.link.element, "collision"):
        own = origin_of(element)
        if own is not None:
            start = turned(inverse(own.matrix), minus(sensor.pose.at, own.at))
            along = turned(inverse(own.matrix), turned(sensor.pose.matrix, X))
            found.append(way_out(shape, start, along))
    return max(found)


@rule("MB637", "lidar-without-rays", WARNING)
def lidar_without_rays(subject: Subject) -> Iterator[Problem]:
    """Yield lidars in addition to what only Gazebo loads, where nothing is for Gazebo Classic."""
    libraries = {simulators.library_of(it) for it in simulators.simulator_plugins(subject)}
    hardware = {simulator.name for _, _, simulator in simulators.simulated(subject)}
    gazebo = GAZEBO.name in hardware or any(it.startswith(_GAZEBOS) for it in libraries)
    classic = CLASSIC.name in hardware or any(it.startswith(_CLASSICS) for it in libraries)
    for it in subject.elements.every("sensor") if gazebo and not classic else ():
        if it.get("type") in _RAYS and it.find("plugin") is None:
            message = f"Gazebo simulates no sensor of type {it.get('type')!r}"
            yield Problem(it, message, "type", "write gpu_lidar")


_RAYS, _GAZEBOS, _CLASSICS = ("ray", "lidar"), ("gz-sim-", "gz_ros2_control"), "gazebo_"
