# SPDX-License-Identifier: Apache-2.0
"""Faults of values, each alone in a healthy robot with its files: told, and how loudly."""

from __future__ import annotations

from collections import Counter

import pytest
from value_faults import SILENT, Fault, faults, found_for, healthy_findings, level_of

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING

CLASSES, QUESTIONS, UNSEEN = faults("classes"), faults("questions"), faults("unseen")
EVERY = (*CLASSES, *QUESTIONS, *UNSEEN)
ODD = faults("oddities")
# What only a note tells: a value that is the default, parameters of another release, a class of a
# package that is not known, whatever its name is like.
QUIET = {
    "q_static_layer_unknown",
    *("initial_pose_not_used", "u_mux_output_stamped", "q_jtc_integer", "q_stamped_in_jazzy"),
    *(
        "q_topic_for_frame",
        "q_control_plugin_name",
        "q_root_with_inertia",
        "u_servo_planning_frame",
        "u_trajectory_interface_name",
    ),
}
# What nothing tells: a filter of a costmap among its layers, which is loaded all the same; what Jazzy
# takes (it was refused in Humble, where it is told); a sensor type that sdformat takes; a node that is
# not known; what twist_mux never reads; a map on the robot. Of the third list: what the node may be
# called in another place, what it takes or mends by itself (max_points, samples, ranges, no map), a
# frame that another node may send, a steered joint that only its interfaces tell, a dummy's inertia.
UNTOLD = {
    *(
        "w_section_of_another_name",
        "w_type_in_own_block",
        "w_monitor_max_points",
        "w_dwb_no_samples",
    ),
    *("w_slam_below_the_sensor", "w_slam_above_the_sensor", "w_slam_localization_without_map"),
    *("w_mapping_of_listed", "w_ekf_base_is_camera", "w_ackermann_four_steered"),
    *("w_fake_link_heavy", "w_step_of_a_second"),
    *("q_keepout_as_layer", "u_pursuit_turns_and_reverses", "v_camera_type_word"),
    *("u_gz_control_node", "v_map_not_there"),
}


def test_the_lists_are_whole() -> None:
    assert len(EVERY) == len({it.name for it in EVERY}) == 325
    assert len(ODD) == 206
    assert all(it.source.startswith("https://") for it in QUESTIONS)


@pytest.mark.more
def test_the_robot_without_a_fault_has_no_warning() -> None:
    assert [it for it in healthy_findings() if it.level != NOTE] == []


@pytest.mark.more
@pytest.mark.sample(80)
@pytest.mark.parametrize("fault", EVERY, ids=lambda it: it.name)
def test_a_fault_is_told(fault: Fault) -> None:
    quiet = (SILENT,) if fault.name in UNTOLD else (NOTE,)
    told = quiet if fault.name in QUIET | UNTOLD else (ERROR, WARNING)
    assert level_of(fault) in told


@pytest.mark.more
@pytest.mark.sample(60)
@pytest.mark.parametrize("fault", ODD, ids=lambda it: it.name)
def test_what_is_odd_and_healthy_is_left_alone(fault: Fault) -> None:
    assert [it for it in found_for(fault) if it.level != NOTE] == []


@pytest.mark.deep
def test_so_many_are_silent() -> None:
    levels = Counter(level_of(it) for it in EVERY)
    assert levels[SILENT] == len(UNTOLD)
