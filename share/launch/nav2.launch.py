# SPDX-License-Identifier: Apache-2.0
"""Nav2 for all robots of a fleet: ``ros2 launch multibot_rewrite nav2.launch.py fleet:=fleet.yaml``."""

from multibot_rewrite.launch.nav2 import generate_launch_description

__all__ = ["generate_launch_description"]
