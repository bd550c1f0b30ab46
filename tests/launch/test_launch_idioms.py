# SPDX-License-Identifier: Apache-2.0
"""What launch authors write, a launch file each: in the real launch, and on its page."""

from __future__ import annotations

import re
from pathlib import Path

import launch_idioms
import pytest
import yaml
from paths import FIXTURES

from multibot_rewrite import launch, load_fleet

WITHOUT = f"not tried in the real launch, which is not here: {launch.missing()}"
EVERY = launch_idioms.idioms()


@pytest.mark.sample(1)
@pytest.mark.skipif(bool(launch.missing()), reason=WITHOUT)
@pytest.mark.parametrize("idiom", EVERY, ids=[it.file.name for it in EVERY])
def test_it_works(idiom: launch_idioms.Idiom, tmp_path: Path) -> None:
    if launch_idioms.is_missing(idiom):
        pytest.skip(f"not tried beside ours in the real launch: no {idiom.needs} here")
    assert launch_idioms.tried(idiom, tmp_path) == launch_idioms.WORKS


def test_the_page_has_them_all() -> None:
    """All of them work: the page was made by running them."""
    outcomes = {it.file.name: launch_idioms.WORKS for it in EVERY}
    assert launch_idioms.PAGE.read_text() == launch_idioms.page(outcomes)
    assert len(EVERY) >= 16
    assert {it.needs for it in EVERY} == {
        *("", "nav2_common", "moveit_configs_utils", "simple_launch")
    }


def test_links_of_the_page_lead_somewhere() -> None:
    for target in re.findall(r"\]\(([^)#]+)", launch_idioms.PAGE.read_text()):
        assert (launch_idioms.PAGE.parent / target).exists(), target


def test_parameters_of_move_group_are_those_of_moveit_configs_utils(tmp_path: Path) -> None:
    """As ``MoveItConfigs.to_dict`` joins them (moveit_configs_builder.py), with the arm's own names."""
    for it in launch_idioms.SOURCES.iterdir():
        (tmp_path / it.name).write_bytes(it.read_bytes())
    (tmp_path / "arm.urdf").write_text(launch_idioms.ARM.read_text())
    (tmp_path / "ompl_planning.yaml").write_text("arm: {planner_configs: [RRT]}\n")
    fleet = (tmp_path / "arms.yaml").read_text()
    more = "moveit: [pilz_cartesian_limits.yaml, ompl_planning.yaml, "
    (tmp_path / "arms.yaml").write_text(fleet.replace("moveit: [", more))
    right = load_fleet(tmp_path / "arms.yaml").robot("right")
    found = right.to_dict()
    assert found["robot_description"] == right.description
    assert found["robot_description_semantic"] == right.srdf
    assert found["robot_description_kinematics"]["arm"]["kinematics_solver_timeout"] == 0.05
    assert set(found["robot_description_planning"]) == {"joint_limits", "cartesian_limits"}
    limits = found["robot_description_planning"]["joint_limits"]
    assert set(limits) == {"right_shoulder", "right_wrist"}
    controller = found["moveit_simple_controller_manager"]["arm_controller"]
    assert controller["joints"] == ["right_shoulder", "right_wrist"]
    assert found["ompl"] == {"arm": {"planner_configs": ["RRT"]}}
    plain = yaml.safe_load((FIXTURES / "launch_idioms" / "joint_limits.yaml").read_text())
    assert set(plain["joint_limits"]) == {"shoulder", "wrist"}
