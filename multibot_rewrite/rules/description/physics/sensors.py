# SPDX-License-Identifier: Apache-2.0
"""Sensors against the robot: what they look at, and from where."""

from __future__ import annotations

from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.description.checks.links_and_joints import Joint
from multibot_rewrite.description.checks.numbers import Vector
from multibot_rewrite.description.checks.poses import Pose, dot, minus, origin_of, placed
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.checks.rotation import inverse, turned
from multibot_rewrite.description.checks.shapes import shapes_of, way_out
from multibot_rewrite.rules.description.examples import a_joint, a_link, block
from multibot_rewrite.rules.description.physics.shared import a_rover
from multibot_rewrite.rules.facts.memo import link_poses
from multibot_rewrite.rules.facts.sensors import CAMERAS, LIDARS, Sensor, number_at, sensors
from multibot_rewrite.rules.facts.simulators import (
    CLASSIC,
    GAZEBO,
    library_of,
    simulated,
    simulator_plugins,
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
_TURNED = '<origin rpy="-1.5708 0 -1.5708"/>'


def _camera_at(link: str, *optical: str) -> str:
    """An example: a camera with an optical frame; its joint is in line 7, the sensor in line 12."""
    return (
        a_link("base")
        + a_link("camera")
        + a_joint("camera_joint", "fixed", "base", "camera")
        + a_link("camera_optical_frame")
        + a_joint("optical_joint", "fixed", "camera", "camera_optical_frame", *optical)
        + block(f'<gazebo reference="{link}">', '<sensor name="front" type="camera"/>')
    )


@rule(
    "MB625",
    "optical-frame-not-rotated",
    WARNING,
    what="An optical frame is turned like the robot: its x points forward and its z up.",
    why="Optical frames have z forward, x to the right and y down (REP 103). Images and depth "
    "clouds with this frame are shown looking at the ceiling, and costmaps get obstacles "
    "from above.",
    fix='Turn its joint: rpy="-1.5708 0 -1.5708" below a link with x forward.',
    bad=_camera_at("camera"),
    good=_camera_at("camera", _TURNED),
    line=7,
)
def optical_frame_not_rotated(subject: Subject) -> Iterator[Problem]:
    """Links with optical at the end of their names that are not turned, and neither is what they are
    fixed to."""
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
            yield Problem(_origin(joint), message, None, hint)


def _origin(joint: Joint) -> _Element:
    return joint.parts.get("origin", joint.element)


def _is_straight(pose: Pose | None) -> bool:
    """Does x point forward and z up?"""
    return (
        pose is not None and turned(pose.matrix, X)[0] > SAME and turned(pose.matrix, Z)[2] > SAME
    )


@rule(
    "MB626",
    "camera-at-optical-frame",
    WARNING,
    what="A simulated camera is at an optical frame, and is not turned back.",
    why="Simulated cameras look along x of their link, which in an optical frame points to the "
    "right. The image shows what is beside the robot, and tf says that it is in front.",
    fix="Put the sensor at the camera's link, and name the optical frame as the frame of its messages.",
    bad=_camera_at("camera_optical_frame", _TURNED),
    good=_camera_at("camera", _TURNED),
    line=12,
)
def camera_at_optical_frame(subject: Subject) -> Iterator[Problem]:
    """Cameras at a link whose joint turns it as an optical frame, with no rotation of their own."""
    for it in sensors(subject):
        if it.type not in CAMERAS or "optical" not in it.link.name.lower():
            continue
        for joint in subject.robot.above.get(it.link.name, ())[:1]:
            own = origin_of(joint.element)
            if own and _is_optical(own) and turned(it.pose.matrix, X)[0] > SAME:
                names = f"{it.link.name!r} looks to the right of {joint.parent!r}"
                hint = f"put it at {joint.parent!r}"
                yield Problem(it.element, f"camera at optical frame {names}", None, hint)


def _is_optical(pose: Pose) -> bool:
    """Is x to the right of the parent, and z forward?"""
    return dot(turned(pose.matrix, X), Y) < -SAME and turned(pose.matrix, Z)[0] > SAME


def _lidar(*inside: str) -> str:
    return block('<sensor name="scan" type="gpu_lidar">', *inside)


def _lidar_with(low: str, high: str, near: str = "0.1", far: str = "10") -> str:
    """An example: a lidar; its horizontal angles begin in line 7, its ranges in line 11."""
    angles = [f"<min_angle>{low}</min_angle>", f"<max_angle>{high}</max_angle>"]
    scan = block("<scan>", block("<horizontal>", *angles))
    ranges = block("<range>", f"<min>{near}</min>", f"<max>{far}</max>")
    ray = block("<lidar>", scan, ranges)
    return a_link("a") + block('<gazebo reference="a">', _lidar(ray))


def _on_mast(z: str) -> str:
    """An example: a lidar on the link of a rover."""
    mast = a_joint("mast", "fixed", "base", "laser", f'<origin xyz="0 0 {z}"/>')
    return a_link("laser") + mast + block('<gazebo reference="laser">', _lidar())


@rule(
    "MB627",
    "sensor-in-ground",
    WARNING,
    what="A camera or lidar of a robot on wheels is below the ground that the wheels stand on.",
    why="It renders the inside of the ground: no obstacle is seen, or all is at the shortest range.",
    fix="Correct the origins of the joints above it; the sign of z is often wrong.",
    bad=a_rover() + _on_mast("-0.3"),
    good=a_rover() + _on_mast("0.3"),
    line=38,
)
def sensor_in_ground(subject: Subject) -> Iterator[Problem]:
    """Sensors below the lowest point of all driven wheels."""
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


@rule(
    "MB628",
    "scan-turned-around",
    WARNING,
    what="The smallest angle or range of a lidar is above the greatest one.",
    why="gz-sim takes a negative field of view for its smallest one (gz-rendering's GpuRays): all "
    "rays go one way. No range is between a smallest and a greatest that are swapped.",
    fix="Swap the two values.",
    bad=_lidar_with("1.57", "-1.57"),
    good=_lidar_with("-1.57", "1.57"),
    line=7,
)
def scan_turned_around(subject: Subject) -> Iterator[Problem]:
    """Ranges, and angles; a Classic lidar that casts rays turns them the other way round."""
    for it in subject.elements.every("lidar", "ray"):
        sensor = it.getparent()
        casts = sensor is not None and sensor.get("type") == "ray"
        for part, low, high in _BOUNDS[:1] if casts else _BOUNDS:
            for element in it.iterfind(part):
                yield from _swapped(element, low, high)


_BOUNDS = (
    ("range", "min", "max"),
    ("scan/horizontal", "min_angle", "max_angle"),
    ("scan/vertical", "min_angle", "max_angle"),
)


def _swapped(element: _Element, low: str, high: str) -> Iterator[Problem]:
    least, most = number_at(element, low), number_at(element, high)
    if least is not None and most is not None and least > most:
        place = element.find(low)
        if place is not None:
            message = f"{low} {least:g} is above {high} {most:g}"
            yield Problem(place, message, "", "swap them")


def _clip(near: str, far: str) -> str:
    inside = block("<clip>", f"<near>{near}</near>", f"<far>{far}</far>")
    camera = block("<camera>", inside)
    return a_link("a") + block(
        '<gazebo reference="a">', block('<sensor name="c" type="camera">', camera)
    )


@rule(
    "MB629",
    "camera-clip",
    WARNING,
    what="A camera's far plane is not beyond its near one, or the near one is not in front of it.",
    why="Nothing is between the planes: the image is empty. Ogre rejects a near plane of 0 or "
    "less ('Near clip distance must be greater than zero').",
    fix="Write metres, the near one above 0 and below the far one.",
    bad=_clip("10", "0.1"),
    good=_clip("0.1", "10"),
    line=6,
)
def camera_clip(subject: Subject) -> Iterator[Problem]:
    """The planes of each camera; a value that is left out is one of sdformat's, 0.1 and 100."""
    for it in subject.elements.every("clip"):
        near, far = number_at(it, "near"), number_at(it, "far")
        near, far = (0.1 if near is None else near), (100.0 if far is None else far)
        places = [at for tag in ("near", "far") if (at := it.find(tag)) is not None]
        if places and (near <= 0 or near >= far):
            message = f"the camera sees from {near:g} m to {far:g} m"
            yield Problem(places[0], message, "", "write a near above 0 and below far")


_HOUSING = '<geometry><cylinder radius="0.1" length="0.1"/></geometry>'


def _housed(near: str) -> str:
    """An example: a lidar of Gazebo Classic in its housing; the sensor is in line 7."""
    ray = block("<ray>", block("<range>", f"<min>{near}</min>", "<max>10</max>"))
    return block('<link name="a">', block("<collision>", _HOUSING)) + block(
        '<gazebo reference="a">', block('<sensor name="scan" type="ray">', ray)
    )


@rule(
    "MB630",
    "lidar-in-its-housing",
    WARNING,
    what="The rays of a Gazebo Classic lidar start inside the collision shape of its link.",
    why="Its rays hit collision shapes from within, those of its own link, too. Every range is "
    "that to the housing, and the robot sees obstacles all around.",
    fix="Make the shortest range larger than the housing, or delete the <collision>.",
    bad=_housed("0.02"),
    good=_housed("0.12"),
    line=7,
)
def lidar_in_its_housing(subject: Subject) -> Iterator[Problem]:
    """Lidars that cast rays at collisions; those on a graphics card do not see faces from behind."""
    for it in sensors(subject):
        near = number_at(it.element, "ray/range/min") if it.type == "ray" else None
        way = 0.0 if near is None else _way_out(it)
        if near is not None and way > near:
            message = f"lidar of link {it.link.name!r} starts inside its collision shape"
            hint = f"a <min> above {way:.3g} would be outside of it"
            yield Problem(
                it.element, f"{message}: {way:.3g} m to its side, <min> is {near:g}", None, hint
            )


def _way_out(sensor: Sensor) -> float:
    """How far a ray along x is inside a collision shape of the sensor's link."""
    found = [0.0]
    for element, shape in shapes_of(sensor.link.element, "collision"):
        own = origin_of(element)
        if own is not None:
            start = turned(inverse(own.matrix), minus(sensor.pose.at, own.at))
            along = turned(inverse(own.matrix), turned(sensor.pose.matrix, X))
            found.append(way_out(shape, start, along))
    return max(found)


_FOR_GAZEBO = '<gazebo><plugin filename="gz-sim-imu-system" name="gz::sim::systems::Imu"/></gazebo>'


def _in_gazebo(type_: str) -> str:
    sensor = block('<gazebo reference="a">', f'<sensor name="scan" type="{type_}"/>')
    return a_link("a") + _FOR_GAZEBO + sensor


@rule(
    "MB637",
    "lidar-without-rays",
    WARNING,
    what="A description for Gazebo has a lidar of a type that only Gazebo Classic simulates: ray or "
    "lidar.",
    why="gz-sim makes no such sensor ('Sensor type LIDAR not supported yet', SdfEntityCreator.cc): it "
    "has no topic, and nothing sees an obstacle.",
    fix="Write gpu_lidar, and load the system Sensors in the world.",
    bad=_in_gazebo("ray"),
    good=_in_gazebo("gpu_lidar"),
    line=3,
)
def lidar_without_rays(subject: Subject) -> Iterator[Problem]:
    """Lidars beside what only Gazebo loads, where nothing is for Gazebo Classic."""
    libraries = {library_of(it) for it in simulator_plugins(subject)}
    hardware = {simulator.name for _, _, simulator in simulated(subject)}
    gazebo = GAZEBO.name in hardware or any(it.startswith(_GAZEBOS) for it in libraries)
    classic = CLASSIC.name in hardware or any(it.startswith(_CLASSICS) for it in libraries)
    for it in subject.elements.every("sensor") if gazebo and not classic else ():
        if it.get("type") in _RAYS and it.find("plugin") is None:
            message = f"Gazebo simulates no sensor of type {it.get('type')!r}"
            yield Problem(it, message, "type", "write gpu_lidar")


_RAYS, _GAZEBOS, _CLASSICS = ("ray", "lidar"), ("gz-sim-", "gz_ros2_control"), "gazebo_"
