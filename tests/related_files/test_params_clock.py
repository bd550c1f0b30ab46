# SPDX-License-Identifier: Apache-2.0
"""``use_sim_time`` of a fleet file in parameter files, which count more than a launch argument."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml
from paths import ROBOTS

from multibot_rewrite import load_fleet

PARAMS = """\
/**:
  ros__parameters: {use_sim_time: False}   # of all
amcl:
  ros__parameters: {use_sim_time: yes, alpha1: 0.2}
bt_navigator:
  ros__parameters: {use_sim_time: $(var use_sim_time)}
rviz2:
  ros__parameters: {use_sim_time: false}
"""


def text(folder: Path, told: str, robot: str = "robot1") -> str:
    (folder / "params.yaml").write_text(PARAMS)
    (folder / "fleet.yaml").write_text(
        f"layout: both\nnode_sets: [nav2, rviz]\n{told}\n"
        "related_files: {params: params.yaml}\nrobots:\n"
        f"  - {{name: robot1, description: {ROBOTS / 'rover.urdf'}}}\n"
        f"  - {{name: robot2, description: {ROBOTS / 'rover.urdf'}, use_sim_time: false}}\n"
    )
    return load_fleet(folder / "fleet.yaml").robot(robot).text("params.yaml")


@pytest.mark.more
@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("told", "robot", "every", "own"),
    [
        ("", "robot1", False, True),
        ("use_sim_time: true", "robot1", True, True),
        ("use_sim_time: true", "robot2", False, False),
    ],
)
def test_the_clock_of_the_fleet_is_that_of_its_files(
    tmp_path: Path, told: str, robot: str, every: bool, own: bool
) -> None:
    made = text(tmp_path, told, robot)
    assert "# of all" in made
    sections = {key: it.get("ros__parameters", {}) for key, it in yaml.safe_load(made).items()}
    found = {key: it["use_sim_time"] for key, it in sections.items() if "use_sim_time" in it}
    # A launch fills the placeholder; each robot has an RViz.
    kept = {f"/{robot}/bt_navigator": "$(var use_sim_time)", f"/{robot}/rviz2": every}
    assert found == {"/**": every, f"/{robot}/amcl": own, **kept}
