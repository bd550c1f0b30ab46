# SPDX-License-Identifier: Apache-2.0
"""The simulators that load a robot's hardware.

Sources: gz_hardware_plugins.xml and gz_system.cpp:326 of gz_ros2_control (jazzy), the same of
ign_ros2_control (humble), gazebo_hardware_plugins.xml and gazebo_system.cpp of gazebo_ros2_control;
for the plugins the plugin definitions."""

from __future__ import annotations

from typing import NamedTuple


class Simulator(NamedTuple):
    """A simulator: the hardware classes that its plugins load, and the plugins.

    ``takes`` are the interfaces of a joint that its hardware exports, the others it leaves out.
    """

    name: str
    hardware: tuple[str, ...]
    plugins: tuple[str, ...]
    takes: tuple[str, ...]


_TAKES = ("position", "velocity", "effort")
GAZEBO = Simulator(
    "Gazebo",
    ("gz_ros2_control/GazeboSimSystem", "ign_ros2_control/IgnitionSystem"),
    ("gz_ros2_control-system", "ign_ros2_control-system"),
    _TAKES,
)
CLASSIC = Simulator(
    "Gazebo Classic", ("gazebo_ros2_control/GazeboSystem",), ("gazebo_ros2_control",), _TAKES
)
SIMULATORS = (GAZEBO, CLASSIC)
