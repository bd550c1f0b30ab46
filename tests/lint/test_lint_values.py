"""Two hundred faults of values, each alone in a healthy robot with its files: told, and how loudly."""

from __future__ import annotations

from collections import Counter

import pytest
from value_faults import SILENT, Fault, faults, found_for, healthy_findings, level_of

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING

CLASSES, QUESTIONS = faults("classes"), faults("questions")
ODD = faults("oddities")
# What only a note tells: a value that is the default, parameters of another release.
QUIET = {
    *("initial_pose_not_used", "q_jtc_integer", "q_stamped_in_jazzy"),
    *("q_topic_for_frame", "q_control_plugin_name", "q_root_with_inertia"),
}
# What nothing tells: a joint alone in its file that is not nearly one of the robot, and a filter of a
# costmap among its layers, which is loaded all the same.
UNTOLD = {"limits_joint_not_there", "q_keepout_as_layer"}


def test_the_lists_are_whole() -> None:
    every = [it.name for it in (*CLASSES, *QUESTIONS)]
    assert len(every) == len(set(every)) == 200
    assert len(ODD) == 115
    assert all(it.source.startswith("https://") for it in QUESTIONS)


@pytest.mark.more
def test_the_robot_without_a_fault_has_no_warning() -> None:
    assert [it for it in healthy_findings() if it.level != NOTE] == []


@pytest.mark.more
@pytest.mark.sample(10)
@pytest.mark.parametrize("fault", [*CLASSES, *QUESTIONS], ids=lambda it: it.name)
def test_a_fault_is_told(fault: Fault) -> None:
    quiet = (SILENT,) if fault.name in UNTOLD else (NOTE,)
    told = quiet if fault.name in QUIET | UNTOLD else (ERROR, WARNING)
    assert level_of(fault) in told


@pytest.mark.more
@pytest.mark.sample(10)
@pytest.mark.parametrize("fault", ODD, ids=lambda it: it.name)
def test_what_is_odd_and_healthy_is_left_alone(fault: Fault) -> None:
    assert [it for it in found_for(fault) if it.level != NOTE] == []


@pytest.mark.deep
def test_two_of_two_hundred_are_silent() -> None:
    levels = Counter(level_of(it) for it in (*CLASSES, *QUESTIONS))
    assert levels[SILENT] == len(UNTOLD)
