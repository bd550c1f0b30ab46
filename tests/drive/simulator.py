# SPDX-License-Identifier: Apache-2.0
"""The simulator of a folder: its world, what it keeps of each robot, and what does not work there."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import gazebo
from kept import Kept, bodies, joints_of, kept
from lxml import etree

# What runs where a world names no system (gz-sim, include/gz/sim/server.config).
DEFAULT = frozenset(("physics", "user-commands", "scene-broadcaster"))
# The system of the world that serves a sensor.
NEEDS = {
    **dict.fromkeys(("gpu_lidar", "camera", "depth_camera", "rgbd_camera"), "sensors"),
    **{it: it for it in ("imu", "navsat", "magnetometer", "contact", "altimeter")},
    "force_torque": "forcetorque",
}
# The joints of a drive: of each group it takes those that are there, and with none it stands still
# (DiffDrive.cc, MecanumDrive.cc, AckermannSteering.cc).
JOINTS = {
    "diff-drive": ("left_joint", "right_joint"),
    "mecanum-drive": (
        *("front_left_joint", "front_right_joint"),
        *("back_left_joint", "back_right_joint"),
    ),
    "ackermann-steering": (
        *("left_joint", "right_joint", "left_steering_joint", "right_steering_joint"),
    ),
}
# The parameters of ros2_controllers that name the joints of wheels on the ground.
WHEELS = (
    *("left_wheel_names", "right_wheel_names", "wheel_names", "wheel_joint_name"),
    *("front_left_wheel_command_joint_name", "front_right_wheel_command_joint_name"),
    *("rear_left_wheel_command_joint_name", "rear_right_wheel_command_joint_name"),
    *("rear_wheels_names", "traction_joints_names", "traction_joint_name"),
)
Broken = tuple[str, str, str]


class World(NamedTuple):
    """A world: its name, and its systems where they are known."""

    name: str = "default"
    systems: frozenset[str] | None = None


class Model(NamedTuple):
    """A robot in the simulator."""

    robot: str
    name: str
    root: etree._Element
    kept: Kept


def world_of(starts: list[tuple[str, Any]], folder: Path) -> World:
    """Return the world that the simulator is started with; of one elsewhere nothing is known."""
    said = " ".join(
        str(it["arguments"].get("gz_args", it["arguments"].get("world", "")))
        for _, it in starts
        if "include" in it
    )
    found = [Path(it) for it in re.findall(r'[^\s"]+\.(?:sdf|world)', said)]
    file = next((it for it in (*found, folder / "world.sdf") if it.is_file()), None)
    world = None if file is None else etree.parse(str(file)).find(".//world")
    if world is None:
        return World(found[0].stem if found else "default")
    systems = frozenset(gazebo.plugin_key(it) for it in world.iterfind("plugin"))
    return World(world.get("name", ""), systems or DEFAULT)


def models_of(roots: Mapping[str, Any], names: Mapping[str, str]) -> Iterator[Model]:
    """Yield the robots that are spawned in gz-sim; those with plugins of Classic are not."""
    for robot, name in names.items():
        root = roots.get(robot)
        if root is not None and not any(True for _ in gazebo.classic_plugins(root)):
            yield Model(robot, name, root, kept(root))


def ends_of(model: Model, world: World) -> Iterator[gazebo.GzEnd]:
    """Yield what is served of a model: no drives without joints, no sensors without their system."""
    systems = running(model, world)
    for plugin in model.kept.plugins:
        if not lacking(plugin, model.kept):
            yield from gazebo.of_plugin(plugin, model.name, world.name, first_link(model.kept))
    for link, sensor in model.kept.sensors:
        if systems is None or NEEDS.get(kind_of(sensor), "") in ("", *systems):
            yield from gazebo.of_sensor(sensor, model.name, world.name, link)


def first_link(model: Kept) -> str:
    return model.links[0] if model.links else ""


def running(model: Model, world: World) -> frozenset[str] | None:
    """Return the systems of the world, and those that a model brings."""
    own = {gazebo.plugin_key(it) for it in model.kept.plugins}
    return None if world.systems is None else world.systems | own


def kind_of(sensor: etree._Element) -> str:
    kind = sensor.get("type", "")
    return gazebo.SENSORS.get(kind, kind)


def lacking(plugin: etree._Element, model: Kept) -> list[str]:
    """Return the elements of a drive of whose joints none is in the model."""
    groups = JOINTS.get(gazebo.plugin_key(plugin), ())
    return [
        it
        for it in groups
        if not any((each.text or "").strip() in model.joints for each in plugin.iterfind(it))
    ]


def broken(model: Model, world: World, poses: bool) -> Iterator[Broken]:
    """Yield what does not work in the simulator; ``poses``: another one sends every joint's state."""
    robot, have = model.robot, model.kept
    if not have.links:
        yield robot, "starts", "Gazebo keeps no link of its description"
    if world.systems is not None and "user-commands" not in world.systems:
        yield robot, "starts", "the world has no system that spawns it"
    for it in have.plugins:
        for group in lacking(it, have):
            key = gazebo.plugin_key(it)
            yield robot, "drives", f"{key} has no {group} in Gazebo: {gazebo.text(it, group)!r}"
        if gazebo.plugin_key(it) in JOINTS and "physics" not in (running(model, world) or DEFAULT):
            yield robot, "drives", "the world has no physics"
    yield from blind(model, world)
    yield from unheard(model, world)
    for it in model.root.iter("plugin"):
        file = it.get("filename", "")
        if file in gazebo.GONE:
            word, what = gazebo.GONE[file]
            yield robot, word, f"no package of ROS 2 has {file}: {what}"
    if not poses and model.root.tag == "robot":
        yield from still(model)


def unheard(model: Model, world: World) -> Iterator[Broken]:
    """Yield what an autopilot sends and no system of its robot hears."""
    ends = list(ends_of(model, world))
    heard = {it.topic for it in ends if it.role == "hears"}
    for it in ends:
        if it.what == gazebo.AUTOPILOT and it.topic not in heard:
            yield model.robot, "drives", f"{it.what} sends {it.topic}, which nothing of it hears"


def one_port(models: Iterable[Model]) -> Iterator[Broken]:
    """Autopilots of two robots on one port (ArduPilotPlugin.cc: bind fails for the second)."""
    first: dict[str, str] = {}
    for model in models:
        for it in model.kept.plugins:
            if gazebo.plugin_key(it) == gazebo.AUTOPILOT:
                port = gazebo.text(it, "fdm_port_in") or "9002"
                if first.setdefault(port, model.robot) != model.robot:
                    yield model.robot, "starts", f"{first[port]} has its port {port}, too"


def rendered_twice(models: Iterable[Model], world: World) -> Iterator[Broken]:
    """Yield second Sensors systems, which end Gazebo (gz-sensors issue 497, create3_sim issue 218)."""
    before = "the world" if "sensors" in (world.systems or ()) else ""
    for model in models:
        if any(gazebo.plugin_key(it) == "sensors" for it in model.kept.plugins):
            if before:
                yield model.robot, "starts", f"Gazebo crashes: {before} has the system Sensors, too"
            before = before or model.robot


def idle(model: Model, values: Iterable[Mapping[str, Any]]) -> Iterator[Broken]:
    """Wheels without a collision turn, and nothing moves; ``values`` are those of the controllers."""
    named = [
        (it.text or "").strip()
        for plugin in model.kept.plugins
        for group in JOINTS.get(gazebo.plugin_key(plugin), ())
        if "steering" not in group
        for it in plugin.iterfind(group)
    ]
    given = (it[key] for it in values for key in WHEELS if it.get(key))
    named += [it for one in given for it in ([one] if isinstance(one, str) else one)]
    touching = {it.getparent().get("name") for it in model.root.iter("collision")}
    body = bodies(model.root, list(joints_of(model.root)))
    solid = {body.get(it, it) for it in touching}
    for it in model.root.iter("joint"):
        child = it.find("child")
        if it.get("name") in named and child is not None:
            wheel = child.get("link") or (child.text or "").strip()
            if body.get(wheel, wheel) not in solid:
                yield model.robot, "drives", f"the wheel {wheel} has no collision to roll on"


def blind(model: Model, world: World) -> Iterator[Broken]:
    """Sensors that Gazebo drops with their links, or that no system of the world serves."""
    have = [it.get("name") for _, it in model.kept.sensors]
    for it in model.root.iter("sensor"):
        if it.get("name") not in have and it.getparent().tag in ("gazebo", "link", "joint"):
            on = it.getparent().get("reference") or it.getparent().get("name")
            yield model.robot, "sees", f"Gazebo drops the sensor {it.get('name')} with {on}"
    systems = running(model, world)
    for _, it in model.kept.sensors:
        need = NEEDS.get(kind_of(it))
        if systems is not None and need and need not in systems:
            why = f"the world has no system {need}, which serves the sensor {it.get('name')}"
            yield model.robot, "sees", why


def still(model: Model) -> Iterator[Broken]:
    """Joints that move and are not in the simulator: no node sends their states."""
    for it in model.root.iterfind("joint"):
        if it.get("type") not in ("fixed", "floating") and it.get("name") not in model.kept.joints:
            why = f"Gazebo keeps no joint {it.get('name')}: no node sends its transform"
            yield model.robot, "plans", why
