# SPDX-License-Identifier: Apache-2.0
"""The release of parameter files, by what ros2_controllers declares in each.

tricycle_steering_controller has wheel_track, front_wheels_radius and rear_wheels_radius until Jazzy
(ros2_controllers 4.42.1, tricycle_steering_controller.yaml).
"""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite.fleet.proposal.propose import release_of_files

MANAGER = """controller_manager:
  ros__parameters:
    drive: {type: tricycle_steering_controller/TricycleSteeringController}
drive:
  ros__parameters: {%s}
"""
OLD = "wheel_track: 1.0, front_wheels_radius: 0.1, rear_wheels_radius: 0.1"


@pytest.mark.parametrize(
    ("own", "release", "why"),
    [
        (OLD, "jazzy", "lyrical lacks 3 parameters or plugins of p.yaml"),
        # One may be left over.
        ("wheel_track: 1.0", "lyrical", ""),
        ("wheelbase: 1.0", "lyrical", ""),
        ("of_nobody: 1.0, nor_this: 2.0", "lyrical", ""),
        ("]", "lyrical", ""),
    ],
)
def test_the_release_is_that_which_has_most(
    own: str, release: str, why: str, tmp_path: Path
) -> None:
    file = tmp_path / "p.yaml"
    file.write_text(MANAGER % own)
    assert release_of_files([str(file), str(tmp_path / "gone.yaml")]) == (release, why)
    assert release_of_files([]) == ("lyrical", "")
