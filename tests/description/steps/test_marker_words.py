# SPDX-License-Identifier: Apache-2.0
"""What the comment at inserted rules says follows what these reach in the release."""

from __future__ import annotations

import pytest
from paths import ROBOTS

from multibot_rewrite import rewrite

ROVER = (ROBOTS / "rover_gz.urdf").read_bytes()


def marker(distro: str) -> str:
    found = rewrite(ROVER, "robot1", layout="tf-per-robot", distro=distro)
    lines = found.text.splitlines()
    return next(it for it in lines if "<!-- multibot" in it and "/tf_static" in it)


@pytest.mark.parametrize("distro", ["lyrical", "rolling"])
def test_controllers_take_rules_of_their_spawner_alone(distro: str) -> None:
    """ros2_control 6.5.0 controller_manager.cpp, determine_controller_node_options."""
    words = (
        "all robots would share the root namespace, and all but controllers, whose rules are their"
    )
    assert f"{words} spawner's, would share /tf, /tf_static)" in marker(distro)
