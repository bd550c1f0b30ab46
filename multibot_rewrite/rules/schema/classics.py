# SPDX-License-Identifier: Apache-2.0
"""Whether Gazebo Classic may be what reads a description, which refuses less than its successor."""

from __future__ import annotations

from lxml.etree import _Element

from multibot_rewrite.base.releases import OF_OLD
from multibot_rewrite.rules.schema.versions import read_version

# The newest SDF that Gazebo Classic wrote; what names a system of its successor.
_NEWEST = (1, 7)
_SYSTEMS = ("ignition-gazebo", "gz-sim", "ign_ros2_control", "gz_ros2_control")


def may_be_classics(root: _Element, release: str) -> bool:
    """May Gazebo Classic read it? Its libsdformat 9 has no ranges and reads what it can of poses and
    colours (src/Param.cc), and it goes on with a model that it has errors about."""
    version = read_version(root.get("version", "")) if root.tag == "sdf" else None
    if release != OF_OLD and not (version and version <= _NEWEST):
        return False
    files = [it.get("filename", "") for it in root.iter("plugin")]
    return not any(name in it for it in files for name in _SYSTEMS)
