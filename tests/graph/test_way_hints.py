"""The hint to a name that no rule moved names the place where the node takes its rules."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from paths import ROBOTS

from multibot_rewrite.fleets.fleet import expected, make_fleet
from multibot_rewrite.graph.expectation import Expectation, PlannedEndpoint
from multibot_rewrite.graph.plan_file import from_yaml, to_yaml
from multibot_rewrite.graph.rules.causes import how_to_remap

GZ = str(ROBOTS / "rover_gz.urdf")


def plan(release: str, stack: str) -> Expectation:
    fleet = make_fleet(GZ, ["robot1"], [stack], {"layout": "tf-per-robot"}, release=release)
    return from_yaml(to_yaml(expected(fleet)).encode(), "plan.yaml")


def hint(of: Expectation, node: str) -> str:
    view: Any = SimpleNamespace(plan=of, places={})
    end = PlannedEndpoint(f"/robot1/{node}", "topic", "publishes", "/robot1/tf", "", "/tf")
    return how_to_remap(view, end)


@pytest.mark.parametrize(
    ("release", "words"),
    [("humble", "--ros-args -r /tf:=tf"), ("lyrical", '--controller-ros-args "-r /tf:=tf"')],
)
def test_a_controllers_rule_is_for_its_spawner_since_that_takes_it(
    release: str, words: str
) -> None:
    assert words in hint(plan(release, "ros2_control"), "diff_drive_controller")


def test_a_components_rule_is_for_its_loading() -> None:
    assert "ComposableNode" in hint(plan("lyrical", "nav2_composed"), "amcl")


def test_a_process_takes_it_as_it_is_started() -> None:
    assert "pass it with --ros-args -r /tf:=tf" in hint(plan("lyrical", "nav2"), "amcl")
