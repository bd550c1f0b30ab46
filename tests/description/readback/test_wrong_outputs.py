# SPDX-License-Identifier: Apache-2.0
"""Outputs in which robots would share something: the second reading names it."""

from __future__ import annotations

import pytest
from description_calls import (
    NEWEST_LTS,
    load_definitions,
    make_naming,
    meetings,
    read,
    same_for_all,
)
from paths import FIXTURES, fixture_text
from proof_faults import Fault, read_faults

from multibot_rewrite import rewrite

RUNNING = fixture_text("wrong_outputs_running.urdf").encode()
FAULTS = read_faults(FIXTURES / "meeting_faults.txt")
LEAST = 25


def named(kind: str, name: str) -> str:
    return f"{kind}:{name}"


def shared(text: bytes, layout: str) -> set[str]:
    """Return what all robots would have of one robot's text."""
    reading = read(text, "rover", load_definitions((), NEWEST_LTS))
    found = same_for_all(reading.names, "robot1", make_naming(layout))
    return {named(it.kind, it.name) for it in found}


def met(texts: dict[str, bytes], layout: str) -> set[str]:
    """Where robots meet, by their texts."""
    definitions = load_definitions((), NEWEST_LTS)
    names = {robot: read(text, robot, definitions).names for robot, text in texts.items()}
    found = meetings(names, make_naming(layout))
    return {named(it.name.kind, it.name.name) for it in found}


@pytest.mark.sample(1)
@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.about)
def test_what_is_shared_is_named(fault: Fault) -> None:
    text = rewrite(RUNNING, "robot1", layout=fault.layout).data
    wrong = fault.planted(text)
    twin = wrong.replace(b"robot1", b"robot2")
    assert fault.refused_by not in shared(text, fault.layout)
    assert fault.refused_by in shared(wrong, fault.layout)
    assert fault.refused_by in met({"robot1": wrong, "robot2": twin}, fault.layout)


@pytest.mark.parametrize("layout", ["both", "postfix", "tf-per-robot", "frames-per-robot"])
def test_without_a_fault_nothing_is_shared(layout: str) -> None:
    one, two = (rewrite(RUNNING, robot, layout=layout).data for robot in ("robot1", "robot2"))
    assert shared(one, layout) == set()
    assert met({"robot1": one, "robot2": two}, layout) == set()


def test_a_text_of_another_robot_meets_that_robot() -> None:
    """The second robot got the first one's text: it is right by itself."""
    text = rewrite(RUNNING, "robot1", layout="both").data
    found = met({"robot1": text, "robot2": text}, "both")
    assert found >= {"frame:base/robot1", "node:/robot1/imu", "topic:/robot1/scan"}


def test_no_fault_was_lost() -> None:
    assert len(FAULTS) >= LEAST
