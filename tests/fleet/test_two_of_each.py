# SPDX-License-Identifier: Apache-2.0
"""Two robots of each sort are read back; a fault of a robot that would be left out is found as well.

Expectations: the same faults in a fleet of two robots, where all is read.
"""

from __future__ import annotations

import os
import re
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from built_faults import BUILT, FLEET, LAUNCH, OUT, Edit, edited, fleet, in_file
from fleet_folder import planned_fleet

from multibot_rewrite.checks.build import Outputs, make_outputs
from multibot_rewrite.checks.read_back import read_back
from multibot_rewrite.checks.two_of_each import two_of_each
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.system.records import PUBLISHES, Topic

pytestmark = pytest.mark.more

# The robots with the faults are last: the others of their sort are read in their place.
NAMES = ("robot3", "robot4", "robot5", "robot1", "robot2")


@cache
def five(*names: str) -> tuple[FleetPlan, Outputs]:
    rows = ", ".join(f"{{name: {name}, pose: {{x: {at}}}}}" for at, name in enumerate(names))
    with TemporaryDirectory() as folder:
        file = Path(folder) / "fleet.yaml"
        file.write_text(re.sub("(?m)^robots:.*$", f"robots: [{rows}]", FLEET))
        plan = planned_fleet(file, around=os.environ, trust=True)
        return plan, make_outputs(plan, OUT)


def left(edit: Edit | None = None, names: tuple[str, ...] = NAMES) -> frozenset[str]:
    """Return the robots that are not read."""
    plan, made = five(*names)
    made = edited(made, edit) if edit else made
    return two_of_each(made, [it.spec for it in plan.robots]).left


def test_two_are_read_of_robots_that_differ_in_names_and_poses() -> None:
    assert left() == {"robot5", "robot1", "robot2"}
    assert read_back(*five(*NAMES), OUT) == []


def test_a_topic_that_only_a_bridge_brings_leaves_with_its_robot() -> None:
    """No node of the plan has an end of it, so that all robots were read for its sake."""
    plan, made = five(*NAMES)
    brought = tuple(Topic(f"/{name}/scan/points", bridge=(PUBLISHES,)) for name in NAMES)
    planned = made.planned._replace(topics=(*made.planned.topics, *brought))
    few = two_of_each(made._replace(planned=planned), [it.spec for it in plan.robots]).made
    kept = {it.name for it in few.planned.topics} & {it.name for it in brought}
    assert kept == {"/robot3/scan/points", "/robot4/scan/points"}


@pytest.mark.parametrize(
    "edit",
    [
        in_file("robot1/nav2_params.yaml", "scan_topic: scan", "scan_topic: scan2"),
        in_file("robot1/bridge.yaml", "/robot1/scan", "/robot2/scan"),
        in_file("robot1/hexbase.urdf", "<link", "<!-- --><link"),
        in_file(LAUNCH, '"robot1": start_robot1', '"robot1":  start_robot1'),
        in_file("plan.yaml", "- name: robot1\n", "- name: robot1\n  tag: other\n"),
    ],
)  # fmt: skip
def test_a_robot_with_another_text_is_read(edit: Edit) -> None:
    assert left(edit) == {"robot5", "robot2"}


def test_all_are_read_where_names_are_within_each_other() -> None:
    assert left(names=("arm", "arm_left", "arm_right")) == frozenset()


@pytest.mark.parametrize(
    ("old", "new"),
    [("ROBOTS = {", "ROBOTS  = {"), ('"robot1": start_robot1', '"robot1": start_robot2')],
)
def test_all_are_read_where_the_launch_file_has_another_form(old: str, new: str) -> None:
    assert left(in_file(LAUNCH, old, new)) == frozenset()


def test_a_robot_that_all_others_obey_is_read() -> None:
    def edit(path: str, text: str) -> str:
        return text.replace("scan_topic: scan", "scan_topic: /robot5/scan")

    assert "robot5" not in left(edit)
    plan, made = five(*NAMES)
    found = read_back(plan, edited(made, edit), OUT)
    told = {name for it in found for name in it.robots or (it.robot,) if it.node.endswith("/amcl")}
    assert told == {name for name in NAMES if name != "robot5"}


def test_a_file_of_all_robots_may_name_one_that_is_left_out() -> None:
    """Two bridges send one robot's scan."""
    plan, made = five(*NAMES)
    row = next(it.text for it in made.files if it.path == "robot5/bridge.yaml")
    spoiled = edited(made, lambda path, text: text + row if path == "bridge.yaml" else text)
    assert "robot5" in two_of_each(spoiled, [it.spec for it in plan.robots]).left
    assert "/robot5/scan" in {name for it in read_back(plan, spoiled, OUT) for name in it.names}


@pytest.mark.sample(12)
@pytest.mark.parametrize("name", BUILT)
def test_a_fault_of_a_robot_that_would_be_left_out_is_found(name: str) -> None:
    def codes(plan: FleetPlan, made: Outputs) -> set[str]:
        return {it.code for it in read_back(plan, edited(made, BUILT[name]), OUT)}

    assert codes(*five(*NAMES)) >= codes(*fleet()) != set()
