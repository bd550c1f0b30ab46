# SPDX-License-Identifier: Apache-2.0
"""Where a rule stands and which node has it then, by release, as the programs' sources say.

Controllers: ros2_control 2.54.0 (humble), 4.46.0 (jazzy), 5.16.0 (kilted), 6.5.0 (lyrical),
``determine_controller_node_options``. Components: rclcpp_components ``create_node_options``.
Costmaps: navigation2 ``Costmap2DROS`` of 1.3 and of 1.5.
"""

from __future__ import annotations

import pytest

from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.base.releases import RELEASES, has_release
from multibot_rewrite.knowledge.controller_ways import CONTROLLER_WAYS
from multibot_rewrite.knowledge.records import Endpoint, NodeFacts
from multibot_rewrite.planning.records import Run, Table
from multibot_rewrite.planning.table import build_table
from multibot_rewrite.planning.way_checks import running_nodes
from multibot_rewrite.planning.ways import deliveries, rules_by_taker
from multibot_rewrite.system.records import PUBLISHES, SUBSCRIBES, TOPIC

TF = Endpoint(TOPIC, PUBLISHES, "/tf")
HEARD = Endpoint(TOPIC, SUBSCRIBES, "/tf", helper=True)
MANAGER = NodeFacts("controller_manager", "controller_manager", ())
BASE = NodeFacts("base_controller", "diff_drive_controller", (TF,), host="controller_manager")
SERVER = NodeFacts("controller_server", "nav2_controller", (Endpoint(TOPIC, PUBLISHES, "/cmd"),))
COSTMAP = NodeFacts("map/map", "nav2_costmap_2d", (HEARD,), host="controller_server")
BOX = NodeFacts("box", "rclcpp_components", ())


def table(release: str, *facts: NodeFacts, tags: tuple[str, ...] = ()) -> Table:
    """Two robots; each description has a controller manager's plugin with the rules ``tags``."""
    plugins = {robot: [tag(robot, *tags)] for robot in (("robot1", "robot2") if tags else ())}
    return build_table(["robot1", "robot2"], facts, make_naming("L1"), plugins, release=release)


def tag(robot: str, *rules: str) -> Run:
    pairs = (rule.replace("ROBOT", robot).partition(":=") for rule in rules)
    own = tuple((old, new) for old, _, new in pairs)
    fact = NodeFacts("controller_manager", "gz", (), plugin="gz_ros2_control-system")
    names = (robot, "controller_manager", f"/{robot}", "controller_manager")
    return Run(*names, own, fact, written=True, process_wide=True)


def stands(made: Table, node: str) -> list[tuple[str, str, tuple[tuple[str, str], ...]]]:
    found = (it for it in deliveries(made) if (it.node.robot, it.node.node) == ("robot2", node))
    return [(it.way, it.taker, it.rules) for it in found]


def running(made: Table, node: str, *left_out: str) -> Run:
    found = (it for _, it in running_nodes(made, left_out))
    return next(it for it in found if (it.robot, it.node) == ("robot2", node))


def test_each_release_has_one_way_for_controllers() -> None:
    for release in RELEASES:
        assert len([it for it in CONTROLLER_WAYS if has_release(it.releases, release)]) == 1


@pytest.mark.parametrize(
    ("release", "way", "taker", "source"),
    [
        ("humble", "host", "controller_manager", "base_controller:/tf"),
        ("jazzy", "spawner", "base_controller", "/tf"),
        ("kilted", "spawner", "base_controller", "/tf"),
        ("lyrical", "spawner", "base_controller", "/tf"),
        ("rolling", "spawner", "base_controller", "/tf"),
    ],
)
def test_a_controllers_rule_is_given_to_its_spawner_since_that_takes_it(
    release: str, way: str, taker: str, source: str
) -> None:
    made = table(release, MANAGER, BASE)
    assert stands(made, "base_controller") == [(way, taker, ((source, "tf"),))]
    assert (source, "tf") in running(made, "base_controller").rules


@pytest.mark.parametrize(
    ("release", "rules"),
    [
        ("humble", (("/tf", "robot1"),)),  # of the process: those of the first plugin
        ("jazzy", (("/tf", "robot2"),)),  # forwarded by its manager
        ("kilted", (("/tf", "robot2"),)),
        ("lyrical", ()),
        ("rolling", ()),
    ],
)
def test_the_rules_of_a_plugin_reach_its_controllers_or_not(
    release: str, rules: tuple[tuple[str, str], ...]
) -> None:
    made = table(release, MANAGER, BASE, tags=("/tf:=ROBOT",))
    assert running(made, "base_controller", "spawner").rules == rules


def test_a_tag_has_what_is_written_there_and_not_what_a_controller_wants() -> None:
    made = table("humble", MANAGER, BASE, tags=("a:=b",))
    assert stands(made, "base_controller")[0][:2] == ("plugin", "controller_manager")
    standing = rules_by_taker(deliveries(made))
    assert standing["robot2", "controller_manager"] == (("a", "b"),)


def composed(release: str) -> Table:
    nodes = (it._replace(container="box") if it is SERVER else it for it in (BOX, SERVER, COSTMAP))
    heard = BASE._replace(name="amcl", host="", container="box", endpoints=(TF, HEARD))
    return table(release, *nodes, heard)


def test_a_component_has_the_rules_of_its_loading_alone_its_helper_those_of_the_container() -> None:
    made = composed("jazzy")
    tf = (("/tf", "tf"),)
    assert stands(made, "amcl") == [("component", "amcl", tf), ("host", "box", tf)]
    amcl = running(made, "amcl")
    assert amcl.rules == tf
    costmap = (("map:/tf", "/robot2/tf"), ("/tf", "/robot2/tf"))
    assert set(amcl.process_rules) == {*tf, *costmap}
    assert running(made, "controller_server").rules == (("/cmd", "cmd"),)
