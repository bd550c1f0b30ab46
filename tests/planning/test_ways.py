# SPDX-License-Identifier: Apache-2.0
"""Where a rule stands and which node has it then, by release, as the programs' sources say.

Controllers: ros2_control 2.54.0 (humble), 4.46.0 (jazzy), 5.16.0 (kilted), 6.5.0 (lyrical),
``determine_controller_node_options``. Components: rclcpp_components ``create_node_options``.
Costmaps: navigation2 ``Costmap2DROS`` of 1.3 and of 1.5.
"""

from __future__ import annotations

import pytest

from multibot_rewrite.base.naming import Policy, make_naming
from multibot_rewrite.base.releases import RELEASES, has_release
from multibot_rewrite.checks.judged_plan import make_fleet
from multibot_rewrite.knowledge.controller_ways import CONTROLLER_WAYS
from multibot_rewrite.knowledge.records import Endpoint, NodeFacts
from multibot_rewrite.planning.records import Run, Table
from multibot_rewrite.planning.table import build_table
from multibot_rewrite.planning.way_checks import not_taken, running_nodes
from multibot_rewrite.planning.ways import deliveries, rules_by_taker
from multibot_rewrite.system.records import ACTION, PUBLISHES, SUBSCRIBES, TOPIC

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


# MR105 and MR103 by release: a rule in a plugin's tag that is meant for a controller.
LAYOUT: Policy = {"layout": "tf-per-robot"}


NEITHER: Policy = {"layout": "postfix"}


def description(*rules: str) -> bytes:
    tags = "".join(f"<remapping>{rule}</remapping>" for rule in rules)
    return (
        '<robot name="rover"><link name="base_link"/><gazebo>'
        '<plugin name="control" filename="gz_ros2_control-system"><parameters>c.yaml</parameters>'
        f"<ros>{tags}</ros></plugin></gazebo></robot>"
    ).encode()


def codes(
    release: str, *rules: str, node_set: str = "", policy: Policy = LAYOUT
) -> list[tuple[str, str]]:
    node_sets = [node_set] if node_set else []
    made = make_fleet(description(*rules), ["robot1", "robot2"], node_sets, policy, release=release)
    return [(it.code, it.robot) for it in made.table.problems if it.code.startswith("MR1")]


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("release", "rule", "node_set", "found"),
    [
        # Forwarded to the controllers, one of which has the name.
        ("jazzy", "~/odom:=odom", "gz_ros2_control", []),
        ("humble", "~/odom:=odom", "gz_ros2_control", []),
        ("lyrical", "~/odom:=odom", "gz_ros2_control", ["MR103"]),
        ("jazzy", "diff_drive_controller:~/odom:=odom", "gz_ros2_control", []),
        ("jazzy", "joint_trajectory_controller:~/odom:=odom", "gz_ros2_control", ["MR103"]),
        ("jazzy", "~/odmo:=odom", "gz_ros2_control", ["MR103"]),
        # For a controller that other robots of the description have, or of another release.
        ("jazzy", "~/reference:=cmd_vel", "gz_ros2_control", []),
        ("jazzy", "drive_controller/cmd_vel:=cmd_vel", "gz_ros2_control", []),
        ("jazzy", "~/cmd_vel_unstamped:=cmd_vel", "gz_ros2_control", []),
        ("jazzy", "/diagnostics:=diagnostics", "gz_ros2_control", []),
        ("jazzy", "drive_controller/cmd_vle:=cmd_vel", "gz_ros2_control", ["MR103"]),
        ("lyrical", "drive_controller/cmd_vel:=cmd_vel", "gz_ros2_control", ["MR103"]),
        # Nobody knows the controllers.
        ("jazzy", "~/odom:=odom", "", []),
        ("lyrical", "~/odom:=odom", "", ["MR103", "MR105"]),
    ],
)
def test_a_rule_for_a_controller(release: str, rule: str, node_set: str, found: list[str]) -> None:
    assert sorted({code for code, _ in codes(release, rule, node_set=node_set)}) == found


def test_each_robot_of_a_description_is_looked_at() -> None:
    robots = [f"robot{at}" for at in range(1, 6)]
    node_sets = ["gz_ros2_control"]
    made = make_fleet(description(), robots, node_sets, NEITHER, release="humble")
    found = {it.robot for it in made.table.problems if it.code == "MR105"}
    assert found - {"robot1"} == {*robots[1:]}


Name = tuple[Endpoint, str]


def hosted(robot: str, *names: Name, **home: str) -> Table:
    """Return a node in another one's process, with a rule for ``/y`` alone."""
    fact = NodeFacts("map", "acme", (), **{"host": "server", **home})  # type: ignore[arg-type]
    return Table(
        "tf-per-robot",
        (
            Run(robot, "server", f"/{robot}", "server", ()),
            Run(robot, "map", f"/{robot}", "map", (("/y", "y"),), fact, names=names),
        ),
        (), "jazzy",
    )  # fmt: skip


def named(name: str, meant: str, **more: str) -> Name:
    end = {"kind": TOPIC, "role": PUBLISHES, "name": name, **more}
    return Endpoint(**end), meant


@pytest.mark.parametrize(
    ("name", "told"),
    [
        (named("/x", "/a/x"), ("/x",)),
        (named("/y", "/a/y"), ()),
        (named("/x", "/x"), ()),
        (named("/go", "/a/go", kind=ACTION), ("/go",)),
        # A rule cannot reach it, or it need not be there.
        (named("/x", "/a/x", fixed="in its code"), ()),
        (named("/x", "/a/x", when="x: true"), ()),
        # It is called otherwise, but like nothing that the code or another robot has.
        (named("/y", "/a/other"), ()),
        (named("/x", "/a/x", role=SUBSCRIBES), ("/x",)),
    ],
)
def test_a_name_that_its_rule_does_not_reach(name: Name, told: tuple[str, ...]) -> None:
    assert [it.names for it in not_taken(hosted("a", name))] == [told] * bool(told)
