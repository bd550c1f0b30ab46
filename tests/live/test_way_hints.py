# SPDX-License-Identifier: Apache-2.0
"""The hint to a name that no rule moved names the place where the node takes its rules."""

from __future__ import annotations

import pytest
from graph_calls import from_yaml, index, to_yaml, whose_by_plan
from paths import ROBOTS
from plans import planned_end

from multibot_rewrite.checks.judged_plan import make_fleet
from multibot_rewrite.fleet.fleet import expected
from multibot_rewrite.rules.system.causes import how_to_remap, why_other_name
from multibot_rewrite.system.records import System

GZ = str(ROBOTS / "rover_gz.urdf")


def plan(release: str, node_set: str) -> System:
    fleet = make_fleet(GZ, ["robot1"], [node_set], {"layout": "tf-per-robot"}, release=release)
    return from_yaml(to_yaml(expected(fleet)).encode(), "plan.yaml")


def hint(of: System, node: str) -> str:
    end = planned_end(f"/robot1/{node}", "topic", "publishes", "/robot1/tf", "", "/tf")
    return how_to_remap(index(of, whose_by_plan(of)), end)


@pytest.mark.parametrize(
    ("release", "words"),
    [
        # On Humble, and made by the plugin of the description.
        (
            "humble",
            "in the description: <remapping>/tf:=tf</remapping> in <ros> of the plugin of ",
        ),
        ("lyrical", '--controller-ros-args "-r /tf:=tf"'),
    ],
)
def test_a_controllers_rule_is_for_its_spawner_since_that_takes_it(
    release: str, words: str
) -> None:
    assert words in hint(plan(release, "ros2_control"), "diff_drive_controller")


def test_a_components_rule_is_for_its_loading() -> None:
    assert "ComposableNode" in hint(plan("lyrical", "nav2_composed"), "amcl")


COSTMAP = "local_costmap/local_costmap"


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("release", "node_set", "words"),
    [
        ("jazzy", "nav2", "to /robot1/controller_server, whose process it is in: --ros-args -r "),
        ("jazzy", "nav2_composed", "to /robot1/nav2_container, whose process it is in: --ros-args"),
        ("lyrical", "nav2_composed", "remappings=[('local_costmap:/tf', '/robot1/tf')] of its "),
    ],
)
def test_a_hosted_nodes_rule_is_for_what_its_host_is_started_with(
    release: str, node_set: str, words: str
) -> None:
    text = hint(plan(release, node_set), COSTMAP)
    assert words in text
    assert "local_costmap:/tf" in text


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("node_set", "node", "words"),
    [
        ("nav2", "amcl", "--ros-args -r __ns:=/robot1"),
        ("nav2_composed", "amcl", "namespace='/robot1' of its ComposableNode"),
        ("nav2", COSTMAP, "start /robot1/controller_server as planned"),
    ],
)
def test_a_node_under_another_name_is_told_where_its_name_is_given(
    node_set: str, node: str, words: str
) -> None:
    of = plan("lyrical", node_set)
    it = index(of, whose_by_plan(of))
    assert words in why_other_name(it, f"/robot1/{node}", f"/{node}").hint
