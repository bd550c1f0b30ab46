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
from multibot_rewrite.spelling.records import Run, Table
from multibot_rewrite.spelling.table import build_table
from multibot_rewrite.spelling.way_checks import is_stand_in, running_nodes
from multibot_rewrite.spelling.ways import deliveries, rules_by_taker
from multibot_rewrite.system.records import ACTION, CALLS, PUBLISHES, SUBSCRIBES, TOPIC

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


@pytest.mark.parametrize(
    ("role", "theirs"), [(PUBLISHES, True), ("", True), (SUBSCRIBES, False), (CALLS, False)]
)
def test_what_a_plugin_publishes_is_of_its_controllers(role: str, theirs: bool) -> None:
    end = Endpoint(TOPIC, role, "odom")
    assert is_stand_in(tag("robot1"), end) is theirs
    assert not is_stand_in(Run("robot1", "n", "/robot1", "n", ()), end)


def test_what_is_forwarded_comes_before_the_spawners_rules() -> None:
    made = table("jazzy", MANAGER, BASE, tags=("/tf:=ROBOT",))
    assert running(made, "base_controller").rules == (("/tf", "robot2"), ("/tf", "tf"))


@pytest.mark.parametrize("release", ["humble", "jazzy", "lyrical"])
def test_a_plugin_and_the_stack_are_one_node_in_the_plugin(release: str) -> None:
    made = table(release, MANAGER, BASE, tags=("a:=b",))
    assert stands(made, "controller_manager") == [("plugin", "controller_manager", (("a", "b"),))]
    assert running(made, "controller_manager").rules == (("a", "b"),)


def test_a_tag_has_what_is_written_there_and_not_what_a_controller_wants() -> None:
    made = table("humble", MANAGER, BASE, tags=("a:=b",))
    assert stands(made, "base_controller")[0][:2] == ("plugin", "controller_manager")
    standing = rules_by_taker(deliveries(made))
    assert standing["robot2", "controller_manager"] == (("a", "b"),)


def test_a_plugins_node_has_its_own_rules_before_those_of_the_process() -> None:
    made = table("jazzy", MANAGER, tags=("/x:=ROBOT",))
    assert running(made, "controller_manager").rules == (("/x", "robot2"), ("/x", "robot1"))
    made = table("humble", MANAGER, tags=("/x:=ROBOT",))
    assert running(made, "controller_manager").rules == (("/x", "robot1"),)


def test_a_hosted_node_has_the_rules_of_its_hosts_process_which_name_it() -> None:
    made = table("jazzy", SERVER, COSTMAP)
    own = ("map:/tf", "/robot2/tf")
    helpers = ("/tf", "/robot2/tf")
    at = ("host", "controller_server")
    assert stands(made, "map/map") == [(*at, (own,)), (*at, (helpers,))]
    rules = (own, helpers, ("/cmd", "cmd"))
    assert running(made, "map/map").rules == rules
    assert running(made, "controller_server").rules == rules
    # A helper node in it has no namespace but the process's.
    assert running(made, "map/map").process_namespace == "/robot2"
    assert helpers in running(made, "map/map").process_rules


def test_a_helper_needs_no_rule_that_its_process_has() -> None:
    server = SERVER._replace(endpoints=(TF,))
    made = table("jazzy", server, COSTMAP)
    assert stands(made, "map/map") == [("host", "controller_server", (("map:/tf", "/robot2/tf"),))]
    assert ("/tf", "tf") in running(made, "map/map").process_rules


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


def test_a_container_has_all_rules_of_an_action_that_a_helper_calls() -> None:
    """rcl resolves each of the five parts by itself (rcl_action names.c)."""
    called = Endpoint(ACTION, CALLS, "/spin", helper=True)
    navigator = NodeFacts("bt_navigator", "nav2_bt_navigator", (called,), container="box")
    parts = ("send_goal", "cancel_goal", "get_result", "feedback", "status")
    names = ["spin", *(f"spin/_action/{it}" for it in parts)]
    rules = dict(running(table("jazzy", BOX, navigator), "box").process_rules)
    assert rules == {f"/{it}": it for it in names}


@pytest.mark.parametrize(
    ("release", "taker"), [("kilted", "box"), ("lyrical", "controller_server")]
)
def test_a_costmap_of_a_component(release: str, taker: str) -> None:
    made = composed(release)
    own = ("map:/tf", "/robot2/tf")
    assert stands(made, "map/map")[0] == ("host", taker, (own,))
    assert stands(made, "map/map")[1] == ("host", "box", (("/tf", "/robot2/tf"),))
    assert own in running(made, "map/map").rules


def test_a_host_that_does_not_run_takes_nothing() -> None:
    assert stands(table("jazzy", COSTMAP), "map/map")[0][:2] == ("process", "map/map")
    alone = table("humble", BASE)
    assert running(alone, "base_controller").rules == (("base_controller:/tf", "tf"),)


@pytest.mark.parametrize("left", ["process", "host", "component", "spawner", "plugin"])
def test_the_rules_of_a_way_can_be_left_out(left: str) -> None:
    made = table("lyrical", MANAGER, BASE, SERVER, COSTMAP, tags=("a:=b",))
    there = {
        "process": ("/cmd", "cmd") in running(made, "controller_server", left).rules,
        "host": ("map:/tf", "/robot2/tf") in running(made, "map/map", left).rules,
        "component": ("/tf", "tf") in running(composed("lyrical"), "amcl", left).rules,
        "spawner": ("/tf", "tf") in running(made, "base_controller", left).rules,
        "plugin": ("a", "b") in running(made, "controller_manager", left).rules,
    }
    assert {way for way, found in there.items() if not found} == {left}
