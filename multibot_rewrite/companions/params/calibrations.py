"""Calibrations of cameras that a parameter names: the file is left as it is, and all robots read it.

Source: image_common, camera_info_manager.cpp (humble to rolling). A ``camera_info_url`` is file:///,
package:// or flash:///, with ``${NAME}`` and ``${ROS_HOME}`` filled in; an empty one is
file://${ROS_HOME}/camera_info/${NAME}.yaml. The file has numbers, and a ``camera_name`` that is only
compared (a warning): no name of a robot.
"""

from __future__ import annotations

from collections.abc import Iterator

import yaml

from multibot_rewrite.base.findings.finding import NOTE, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.companions.names.placeholders import filled
from multibot_rewrite.companions.params.sections import ParamSection
from multibot_rewrite.companions.params.values import ParamsJob
from multibot_rewrite.companions.yaml_text import found_at, pairs

# The second one: camera_aravis, spinnaker_camera_driver.
_URLS = frozenset({"camera_info_url", "camerainfo_url"})
_OF_THE_COMPUTER = "${ROS_HOME}"
_SCHEMES = ("file://", "package://")

CALIBRATION = declare(
    "MF133",
    "calibration-of-all-robots",
    NOTE,
    what="A parameter names the calibration of a camera, and each robot gets the same.",
    why="The file has no name of a robot, so it is left where it is. But it describes the lens of one "
    "camera: of two real robots at least one measures wrongly, and on one computer the calibration of "
    "one robot (set_camera_info) overwrites that of the other.",
    fix="Write `<robot_namespace>` into the path, which becomes the robot's name, and calibrate each "
    "camera; or leave the parameter out: then the file is on each robot's own computer.",
    bad="""\
usb_cam:
  ros__parameters:
    camera_info_url: package://my_robot/config/camera.yaml
""",
    good="""\
usb_cam:
  ros__parameters:
    camera_info_url: package://my_robot/config/<robot_namespace>/camera.yaml
""",
    line=3,
    formats=("params",),
)


def shared_calibrations(job: ParamsJob, section: ParamSection) -> Iterator[Finding]:
    """Each calibration that all robots of a file read."""
    # A file of one robot has its calibration.
    for url in () if job.own else _urls(section.body):
        text = str(url.value)
        own = filled(text, "") != text or _OF_THE_COMPUTER in text
        if text.lower().startswith(_SCHEMES) and not own:
            message = f"every robot reads the calibration {text!r}; real cameras have one each"
            hint = "write <robot_namespace> into the path, which becomes the robot's name"
            yield found_at(job.document, url, CALIBRATION, message, hint)


def _urls(body: yaml.Node) -> Iterator[yaml.ScalarNode]:
    for key, value in pairs(body):
        if isinstance(value, yaml.MappingNode):
            yield from _urls(value)
        elif isinstance(value, yaml.ScalarNode) and key.value.rpartition(".")[2] in _URLS:
            yield value
