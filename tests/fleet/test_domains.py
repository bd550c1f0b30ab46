"""A ROS domain for each robot: what a build writes for it, and what a fleet file may not say."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml
from nav2_graphs import ROVER

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.fleet.build import Outputs, make_outputs
from multibot_rewrite.fleet.checks.closed_plan import closed_plan
from multibot_rewrite.fleet.file.fleet_file import read_fleet
from multibot_rewrite.fleet.fleet import expected
from multibot_rewrite.fleet.fleet_plan import plan_fleet
from multibot_rewrite.spelling.plan_file import read_plan, to_json, to_yaml
from multibot_rewrite.system.domains import by_domain, domain_of

FLEET = f"""\
layout: {{layout}}
affix: prefix
description: {ROVER}
stack: nav2
distro: jazzy
simulator: none
shared_topics: [/map, /clock, /rosout, /parameter_events, /diagnostics]
shared_nodes: map_server
domains: {{{{robot1: 11, robot2: 12, shared_nodes: 10}}}}
crossing: [tf, tf_static, /robot1/scan]
free_fleet: {{{{router: tcp/10.0.0.1:7447, map: L1}}}}
robots: [{{{{name: robot1}}}}, {{{{name: robot2}}}}]
"""
SMALL = "robots: [{name: robot1}, {name: robot2}]\n"
SIMULATED = """\
<robot name="rover">
  <link name="base_link"/>
  <gazebo><plugin name="drive" filename="libgazebo_ros_diff_drive.so"/></gazebo>
</robot>
"""


def written(folder: Path, layout: str = "both") -> Outputs:
    file = folder / "fleet.yaml"
    file.write_text(FLEET.format(layout=layout))
    return make_outputs(plan_fleet(read_fleet(str(file), "", {})))


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Outputs:
    return written(tmp_path_factory.mktemp("fleet"))


def text(made: Outputs, path: str) -> str:
    return next(it.text for it in made.files if it.path == path)


@pytest.mark.slow
def test_the_bridge_of_a_robot_has_what_crosses(made: Outputs) -> None:
    """As domain_bridge reads it (parse_domain_bridge_yaml_config.cpp): topics is a mapping, each topic
    has a type and both domains, words of qos are those that it knows."""
    bridge = yaml.safe_load(text(made, "domain_bridge/robot1_bridge.yaml"))
    assert (bridge["name"], bridge["from_domain"], bridge["to_domain"]) == ("robot1_bridge", 11, 10)
    kept = {"reliability": "reliable", "durability": "transient_local", "depth": 100}
    assert bridge["topics"] == {
        "/map": {
            "type": "nav_msgs/msg/OccupancyGrid",
            "from_domain": 10,
            "to_domain": 11,
            "qos": kept,
        },
        "/robot1/scan": {"type": "sensor_msgs/msg/LaserScan"},
        "/robot1/tf": {"type": "tf2_msgs/msg/TFMessage"},
        "/robot1/tf_static": {"type": "tf2_msgs/msg/TFMessage", "qos": kept},
    }
    other = yaml.safe_load(text(made, "domain_bridge/robot2_bridge.yaml"))
    assert sorted(other["topics"]) == ["/map", "/robot2/tf", "/robot2/tf_static"]


@pytest.mark.slow
def test_free_fleet_gets_a_bridge_and_the_robots_of_its_adapter(made: Outputs) -> None:
    first, _, config = text(made, "free_fleet/robot2.json5").partition("\n")
    assert first.startswith("//")
    bridge = yaml.safe_load(config)
    own = bridge["plugins"]["ros2dds"]
    assert own["domain"] == 12
    # The keys that the adapter asks for: robot2/tf, robot2/battery_state, robot2/navigate_to_pose.
    assert own["allow"]["publishers"] == ["/robot2/tf", "/robot2/battery_state"]
    assert own["allow"]["action_servers"] == ["/robot2/navigate_to_pose"]
    assert bridge["connect"]["endpoints"] == ["tcp/10.0.0.1:7447"]
    robots = yaml.safe_load(text(made, "free_fleet/robots.yaml"))["rmf_fleet"]["robots"]
    assert robots["robot1"] == {
        "charger": "robot1_charger",
        "navigation_stack": 2,
        "initial_map": "L1",
        "map_frame": "map",
        "robot_frame": "robot1/base_footprint",
    }


@pytest.mark.slow
def test_the_launch_file_starts_each_robot_in_its_domain(made: Outputs) -> None:
    launch = text(made, "fleet.launch.py")
    assert "SetEnvironmentVariable('ROS_DOMAIN_ID', '10')" in launch
    assert "    'robot1': '11',\n    'robot2': '12',\n" in launch
    assert (
        "GroupAction([SetEnvironmentVariable('ROS_DOMAIN_ID', DOMAINS[name]), *actions])" in launch
    )
    assert "package='domain_bridge'" in launch
    compile(launch, "fleet.launch.py", "exec")
    commands = text(made, "commands.md")
    assert "## robot2\n\n```sh\nexport ROS_DOMAIN_ID=12\n" in commands


@pytest.mark.slow
def test_the_plan_has_the_bridge_on_both_sides_and_comes_back_from_a_file(made: Outputs) -> None:
    plan = made.planned
    assert domain_of(plan) == {"": 10, "robot1": 11, "robot2": 12}
    for text_ in (to_yaml(plan), to_json(plan)):
        again = read_plan(text_.encode(), "plan")
        assert again.domains == plan.domains
        assert by_domain(again).keys() == {10, 11, 12}
    parts = by_domain(plan)
    in_shared = {(it.node, it.role, it.name) for it in parts[10].ends}
    assert ("/robot1_bridge_10", "publishes", "/robot1/tf") in in_shared
    assert ("/robot1_bridge_10", "subscribes", "/map") in in_shared
    in_first = {(it.node, it.role, it.name) for it in parts[11].ends}
    assert ("/robot1_bridge_11", "subscribes", "/robot1/tf") in in_first
    assert ("/robot1_bridge_11", "publishes", "/map") in in_first
    assert [it.name for it in parts[11].robots] == ["robot1"]
    assert not [it for it in parts[11].nodes if "robot2" in it.name or it.name == "/map_server"]


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ("domains: {robot1: 11}\n", "domains: robot2 has none"),
        ("domains: {robot1: 11, robo2: 12}\n", "did you mean 'robo2'?"),
        ("domains: {robot1: 11, robot2: 300}\n", "232"),
        ("crossing: [odom]\n", "crossing: write domains as well"),
        ("free_fleet: {router: tcp/a:7447, map: L1}\n", "free_fleet: write domains as well"),
        (
            "domains: {robot1: 1, robot2: 2}\nzenoh: {router: tcp/a:7447}\n",
            "zenoh are for one domain",
        ),
    ],
)
def test_what_a_fleet_file_may_not_say(more: str, said: str, tmp_path: Path) -> None:
    file = tmp_path / "fleet.yaml"
    file.write_text(f"description: {ROVER}\n{more}{SMALL}")
    with pytest.raises(InputError) as raised:
        read_fleet(str(file), "jazzy", {})
    assert said in str(raised.value)
    assert str(raised.value).startswith(f"{file}:")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("layout", "old", "new", "said"),
    [
        ("both", "tf_static,", "odometry,", "no robot has a topic 'odometry'"),
        ("frames-per-robot", "", "", "take layout tf-per-robot or both"),
        ("both", "stack: nav2", "stack: robot_state", "no node of robot1 serves"),
    ],
)
def test_what_no_plan_fulfils(layout: str, old: str, new: str, said: str, tmp_path: Path) -> None:
    file = tmp_path / "fleet.yaml"
    given = FLEET.format(layout=layout).replace(old, new)
    if new == "stack: robot_state":
        given = given.replace("shared_nodes: map_server\n", "").replace(", /robot1/scan", "")
    file.write_text(given)
    with pytest.raises(UsageError, match=said):
        make_outputs(plan_fleet(read_fleet(str(file), "", {})))


def faults(folder: Path, fleet: str) -> list[Finding]:
    (folder / "robot.urdf").write_text(SIMULATED)
    (folder / "fleet.yaml").write_text(f"description: robot.urdf\ndistro: jazzy\n{fleet}{SMALL}")
    made = plan_fleet(read_fleet(str(folder / "fleet.yaml"), "", {}))
    return [it for it in closed_plan(made).gaps if it.code == "MF849"]


@pytest.mark.slow
def test_a_plugin_is_where_its_simulator_is(tmp_path: Path) -> None:
    (found,) = faults(tmp_path, "simulator: gazebo\ndomains: {robot1: 11, robot2: 12}\n")
    assert (found.level, found.line, found.others) == ("error", 4, ("robot2",))
    assert faults(tmp_path, "simulator: none\ndomains: {robot1: 11, robot2: 12}\n") == []
    # All in the simulator's domain.
    assert faults(tmp_path, "simulator: gazebo\ndomains: {robot1: 0, robot2: 0}\n") == []


@pytest.mark.more
def test_what_a_launch_file_loads_or_brings_up_is_reached_from_one_domain(tmp_path: Path) -> None:
    """Components are loaded by a service, slam_toolbox is activated by one; processes need none."""
    (tmp_path / "robot.urdf").write_text('<robot name="r"><link name="base_link"/></robot>')
    head = "description: robot.urdf\ndistro: jazzy\nsimulator: none\n"
    for stack, numbers, told in (
        ("nav2_composed", (11, 12), True),
        ("slam_toolbox", (11, 12), True),
        ("slam_toolbox", (11, 11), False),
        ("nav2", (11, 12), False),
    ):
        domains = "domains: {{robot1: {}, robot2: {}}}\n".format(*numbers)
        (tmp_path / "fleet.yaml").write_text(f"{head}stack: {stack}\n{domains}{SMALL}")
        made = make_outputs(plan_fleet(read_fleet(str(tmp_path / "fleet.yaml"), "", {})))
        found = [it for it in made.findings if it.code == "MF849"]
        assert [it.line for it in found] == [5] * told, stack


NODES = """\
nodes:
  planner:
    package: acme
    serves: {/get_plan: nav_msgs/srv/GetPlan}
    publishes: {/<serial>/state: std_msgs/msg/String}
  front:
    package: acme
    calls: {/get_plan: nav_msgs/srv/GetPlan}
stacks: {own: {about: ours, nodes: [planner, front]}}
"""
OWN = """\
nodes: nodes.yaml
stack: own
simulator: none
shared_topics: [/get_plan]
shared_nodes: front
"""


@pytest.mark.slow
def test_a_service_does_not_cross(tmp_path: Path) -> None:
    """A node of all robots calls what a robot in another domain serves."""
    (tmp_path / "nodes.yaml").write_text(NODES)
    (found,) = faults(tmp_path, f"{OWN}domains: {{robot1: 11, robot2: 12, shared_nodes: 10}}\n")
    assert (found.level, found.line) == ("warning", 8)
    assert "/front of domain 10 calls /get_plan" in found.message
    assert faults(tmp_path, f"{OWN}domains: {{robot1: 11, robot2: 11, shared_nodes: 11}}\n") == []


@pytest.mark.slow
def test_one_name_in_two_domains_is_no_clash(tmp_path: Path) -> None:
    """A driver that takes no namespace: with one domain each its robots never meet."""
    (tmp_path / "nodes.yaml").write_text(NODES)
    base = f"description: {ROVER}\ndistro: jazzy\n{OWN}{SMALL}"
    told = {}
    for word, more in (("one", ""), ("two", "domains: {robot1: 11, robot2: 12}\n")):
        (tmp_path / f"{word}.yaml").write_text(base + more)
        made = plan_fleet(read_fleet(str(tmp_path / f"{word}.yaml"), "", {})).fleet
        told[word] = {it.code for it in made.table.problems}
        assert expected(made).robots
    assert "MR101" in told["one"]
    assert "MR101" not in told["two"]
