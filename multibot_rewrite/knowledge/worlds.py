# SPDX-License-Identifier: Apache-2.0
"""The systems of gz-sim that a world needs, and what they send. Source: the names in gz-sim8
src/systems, and include/gz/sim/server.config for those of a world that names none;
SceneBroadcaster.cc SetupTransport, SimulationRunner.cc for the topics, which are below /world/NAME."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from multibot_rewrite.base.conventions import ROWS

DEFAULTS = ("physics", "user-commands", "scene-broadcaster")
SENT_BY_ANY: Mapping[str, str] = MappingProxyType({"clock": "Clock", "stats": "WorldStatistics"})
SENT_BY: Mapping[str, Mapping[str, str]] = MappingProxyType(
    {system: dict(it.split("=") for it in sent) for (system, *sent), _ in ROWS["sent by systems"]}
)
_CAMERAS = "sensors", "Sensors"
# The library and the class, by the type of a sensor.
SYSTEMS: Mapping[str, tuple[str, str]] = MappingProxyType(
    {
        **dict.fromkeys(("camera", "depth_camera", "depth", "rgbd_camera", "rgbd"), _CAMERAS),
        **dict.fromkeys(("gpu_lidar", "gpu_ray", "lidar", "ray"), _CAMERAS),
        **dict.fromkeys(("thermal_camera", "thermal", "wide_angle_camera"), _CAMERAS),
        **dict.fromkeys(("segmentation_camera", "segmentation"), _CAMERAS),
        **dict.fromkeys(("boundingbox_camera", "boundingbox"), _CAMERAS),
        "imu": ("imu", "Imu"),
        "magnetometer": ("magnetometer", "Magnetometer"),
        "altimeter": ("altimeter", "Altimeter"),
        "air_pressure": ("air-pressure", "AirPressure"),
        "air_speed": ("air-speed", "AirSpeed"),
        "force_torque": ("forcetorque", "ForceTorque"),
        "logical_camera": ("logical-camera", "LogicalCamera"),
        **dict.fromkeys(("navsat", "gps"), ("navsat", "NavSat")),
    }
)
