# SPDX-License-Identifier: Apache-2.0
"""What is started for the nodes of a table: processes, components, spawners, and their arguments."""

from __future__ import annotations

import json

import pytest
from paths import ROBOTS

from multibot_rewrite.base.naming import Policy
from multibot_rewrite.checks.judged_plan import make_fleet
from multibot_rewrite.planning.records import Table
from multibot_rewrite.planning.table_formats import FORMS
from multibot_rewrite.planning.ways import arguments, started

GZ = str(ROBOTS / "rover_gz.urdf")


def table(release: str, *node_sets: str, layout: str = "tf-per-robot") -> Table:
    policy: Policy = {"layout": layout}
    return make_fleet(GZ, ["robot1", "robot2"], node_sets, policy, release=release).table


@pytest.mark.more
def test_the_data_says_where_each_rule_stands() -> None:
    found = json.loads(FORMS["json"](table("lyrical", "gz_ros2_control", "nav2")))
    assert found["distro"] == "lyrical"
    own = found["robots"]["robot1"]
    ways = {node: (it["way"], it["at"]) for node, it in own.items()}
    assert ways["controller_manager"] == ("plugin", "controller_manager")
    assert ways["diff_drive_controller"] == ("spawner", "diff_drive_controller")
    assert ways["local_costmap/local_costmap"] == ("host", "controller_server")
    assert ways["amcl"] == ("process", "amcl")
    assert own["diff_drive_controller"]["remappings"] == [["/tf", "tf"]]


@pytest.mark.more
def test_a_component_is_loaded_with_its_name_namespace_and_rules() -> None:
    found = {
        it.node.node: arguments(it)
        for it in started(table("lyrical", "nav2_composed"))
        if it.node.robot == "robot1"
    }
    assert found["amcl"][:4] == ["-n", "amcl", "--node-namespace", "/robot1"]
    assert found["amcl"][4:] == ["-r", "/tf:=tf", "-r", "/tf_static:=tf_static"]
    assert found["nav2_container"][:3] == ["--ros-args", "-r", "__ns:=/robot1"]
