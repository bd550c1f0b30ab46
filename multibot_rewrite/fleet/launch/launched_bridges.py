"""Where in a robot's namespace a launch file runs the bridge that gets a bridge file.

Clearpath starts the bridge of each sensor in NAMESPACE/sensors (clearpath_generator_gz
launch/sensors.py): relative ROS names of its file are there.
"""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator

from multibot_rewrite.base.bounded import load_yaml
from multibot_rewrite.fleet.file.fleet_file import FleetFile, RobotSpec
from multibot_rewrite.fleet.launch.launched_robot import launch_of
from multibot_rewrite.producers.launch.records import LaunchedNode

_PACKAGES = ("ros_gz_bridge", "ros_ign_bridge")
# The parameter that names a bridge's file (ros_gz_bridge/src/ros_gz_bridge.cpp).
_FILE = "config_file"


def with_bridge_namespaces(file: FleetFile) -> FleetFile:
    """The fleet with the namespaces that launch files give to bridges, where it has none of its own.

    Raises InputError for a launch file that cannot be read. A file of the launch is the robot's of the
    same name, as for parameter files.
    """
    # A launch file may be written for one of the robots.
    robots = {word for it in file.robots for word in it.words}
    return file._replace(robots=tuple(_with(it, robots) for it in file.robots))


def _with(spec: RobotSpec, robots: Collection[str]) -> RobotSpec:
    files = spec.companions.get("bridge", ())
    if spec.bridge_namespace or not (files and spec.launch):
        return spec
    values = (value.strip("/") for it in spec.launch for _, value in it.arguments)
    words = {*robots, *filter(None, values)}
    nodes = (it for it in launch_of(spec.launch, spec.name).nodes if it.package in _PACKAGES)
    told = {os.path.basename(name): _below(it, words) for it in nodes for name in _files_of(it)}
    found = ((path, told.get(os.path.basename(path), "")) for path in files)
    return spec._replace(bridges_below=tuple((path, below) for path, below in found if below))


def _files_of(node: LaunchedNode) -> Iterator[str]:
    """The files that a bridge is told, and those of which the launch makes another one."""
    for it in node.parameters:
        if it.source:
            yield it.source
            continue
        sections = load_yaml(it.text)
        for section in sections.values() if isinstance(sections, dict) else ():
            value = section.get("ros__parameters", {}).get(_FILE, "")
            yield from [value] if isinstance(value, str) and value else ()


def _below(node: LaunchedNode, words: Collection[str]) -> str:
    """The namespace of a launched node without the robot's, which is one of the words."""
    own = node.namespace.strip("/")
    for word in sorted(words, key=len, reverse=True):
        if f"{own}/".startswith(f"{word}/"):
            return own[len(word) + 1 :]
    return own
