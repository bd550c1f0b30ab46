# SPDX-License-Identifier: Apache-2.0
"""Descriptions of URDF 1.1 and 1.2 are rewritten like those of 1.0."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import numpy as np
import pytest
from paths import fixture_text
from urdfdom_cases import CHECK, check_urdf

from multibot_rewrite import rewrite

ROBOT = fixture_text("urdf_versions_robot.urdf")
FILES = {
    "1.1": ROBOT.format("1.1", ""),
    "1.2": ROBOT.format("1.2", ' acceleration="2" deceleration="3" jerk="5"'),
}


@pytest.mark.skipif(CHECK is None, reason="check_urdf is missing: pip install pin")
@pytest.mark.parametrize("version", FILES)
def test_urdfdom_has_nothing_to_say_of_them(version: str, tmp_path: Path) -> None:
    text = rewrite(FILES[version].encode(), "robot1").data.decode()
    assert check_urdf(text, tmp_path) == (True, False)


@pytest.mark.slow
@pytest.mark.skipif(
    importlib.util.find_spec("pinocchio") is None, reason="pinocchio is missing: pip install pin"
)
@pytest.mark.parametrize("version", FILES)
def test_every_pose_is_what_it_was(version: str) -> None:
    import pinocchio as pin  # takes half a second

    before = pin.buildModelFromXML(FILES[version])
    after = pin.buildModelFromXML(rewrite(FILES[version].encode(), "robot1").data.decode())
    for one, other in zip(before.jointPlacements, after.jointPlacements, strict=True):
        assert np.array_equal(one.homogeneous, other.homogeneous)
