# SPDX-License-Identifier: Apache-2.0
"""Runs a launch file as ``ros2 launch`` does: file, then name:=value; needs launch."""

from __future__ import annotations

import sys

from launch import LaunchDescription, LaunchService
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import AnyLaunchDescriptionSource

if __name__ == "__main__":
    file, *words = sys.argv[1:]
    pairs = [tuple(word.split(":=", 1)) for word in words]
    source = AnyLaunchDescriptionSource(file)
    service = LaunchService()
    service.include_launch_description(
        LaunchDescription([IncludeLaunchDescription(source, launch_arguments=pairs)])
    )
    sys.exit(service.run())
