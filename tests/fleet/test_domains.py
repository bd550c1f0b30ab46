# SPDX-License-Identifier: Apache-2.0
"""A ROS domain for each robot: what a build writes for it, and what a fleet file may not say."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import NamedTuple

import pytest
import yaml
from drawn_fleets import CONTROLLERS, KINDS
from fleet_folder import built_fleet, planned_fleet
from nav2_graphs import ROVER

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.checks.build import Outputs
from multibot_rewrite.checks.closed_plan import closed_plan
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.fleet.file.fleet_file import read_fleet
from multibot_rewrite.fleet.fleet import expected
from multibot_rewrite.planning.plan import read_plan, to_yaml
from multibot_rewrite.system.domains import by_domain, domain_of
from multibot_rewrite.system.json import to_json
from multibot_rewrite.system.records import PUBLISHES, SUBSCRIBES

FLEET = f"""\
layout: {{layout}}
affix: prefix
description: {ROVER}
node_sets: nav2
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
    return built_fleet(file)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Outputs:
    return written(tmp_path_factory.mktemp("fleet"))


def text(made: Outputs, path: str) -> str:
    return next(it.text for it in made.files if it.path == path)


class Bridged(NamedTuple):
    """A topic as domain_bridge takes it."""

    topic: str
    type: str
    start: int
    end: int
    qos: dict[str, object]


def as_domain_bridge_reads(text: str) -> tuple[str, list[Bridged]]:
    """Return the name and the topics, by parse_domain_bridge_yaml_config.cpp and bridge_topic of
    domain_bridge.cpp (c2523e1); what these throw at, or leave out, fails here."""
    root = yaml.compose(text)
    (topics,) = [value for key, value in root.value if key.value == "topics"]
    keys = [key.value for key, _ in topics.value]
    assert len(keys) == len({*keys}), "of one topic only one is bridged"
    config = yaml.safe_load(text)
    assert config.get("mode", "normal") == "normal"
    found = []
    for topic, own in config["topics"].items():
        assert isinstance(own, dict) and "services" not in own
        ends = [own.get(it, config.get(it)) for it in ("from_domain", "to_domain")]
        assert all(type(it) is int and 0 <= it <= 232 for it in ends), "as<std::size_t>"
        assert ends[0] != ends[1], "Domain IDs must be different"
        assert isinstance(topic, str) and re.fullmatch(r"(/[A-Za-z_][A-Za-z0-9_]*)+", topic)
        # rosbag2_cpp get_typesupport_library: PACKAGE/msg/TYPE.
        assert isinstance(own["type"], str) and re.fullmatch(r"\w+/msg/\w+", own["type"])
        qos = own.get("qos", {})
        assert isinstance(qos, dict)
        assert qos.get("reliability", "reliable") in ("reliable", "best_effort")
        assert qos.get("durability", "volatile") in ("volatile", "transient_local")
        assert qos.get("history", "keep_last") in ("keep_last", "keep_all")
        assert type(qos.get("depth", 10)) is int
        known = {"type", "from_domain", "to_domain", "qos", "remap", "bidirectional", "reversed"}
        assert own.keys() <= known and qos.keys() <= {"reliability", "durability", "depth"}
        found.append(Bridged(topic, own["type"], ends[0], ends[1], qos))
    # A node of this name and the domain's number is made in each of both.
    assert re.fullmatch(r"[A-Za-z_]\w*", config["name"])
    return config["name"], found


@pytest.mark.more
def test_domain_bridge_takes_what_is_written(made: Outputs) -> None:
    """Also of names with a slash, and of a topic that the robot only reads."""
    for robot in ("robot1", "robot2"):
        name, topics = as_domain_bridge_reads(text(made, f"domain_bridge/{robot}_bridge.yaml"))
        assert name == f"{robot}_bridge" and topics
        in_plan = {
            (it.node, it.role, it.name, it.type) for it in made.planned.ends if name in it.node
        }
        by_file = {
            end
            for it in topics
            for end in (
                (f"/{name}_{it.start}", SUBSCRIBES, it.topic, it.type),
                (f"/{name}_{it.end}", PUBLISHES, it.topic, it.type),
            )
        }
        assert in_plan == by_file


@pytest.mark.more
def test_the_bridge_of_a_robot_has_what_crosses(made: Outputs) -> None:
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


@pytest.mark.more
def test_free_fleet_gets_a_bridge_and_the_robots_of_its_adapter(made: Outputs) -> None:
    """DEFAULT_CONFIG.json5 of zenoh-bridge-ros2dds at 0b277b7 has the keys; the adapter asks for
    robot2/tf, robot2/battery_state and robot2/navigate_to_pose, and wants these five of a robot."""
    first, _, config = text(made, "free_fleet/robot2.json5").partition("\n")
    assert first == "// On robot2: zenoh-bridge-ros2dds -c robot2.json5"
    none = ("subscribers", "service_servers", "service_clients", "action_clients")
    allow = {
        **{it: [] for it in none},
        "publishers": ["/robot2/tf", "/robot2/battery_state"],
        "action_servers": ["/robot2/navigate_to_pose"],
    }
    rate = ["/robot2/battery_state=1"]
    assert json.loads(config) == {
        "plugins": {"ros2dds": {"domain": 12, "allow": allow, "pub_max_frequencies": rate}},
        "mode": "client",
        "connect": {"endpoints": ["tcp/10.0.0.1:7447"]},
        "listen": {"endpoints": []},
    }
    assert text(made, "free_fleet/robots.yaml") == (
        "# The robots of the fleet adapter: put them below rmf_fleet of its configuration.\n"
        "rmf_fleet:\n  robots:\n"
    ) + "".join(
        f'    {it}:\n      charger: "{it}_charger"\n      navigation_stack: 2\n'
        f'      initial_map: "L1"\n      map_frame: "map"\n'
        f'      robot_frame: "{it}/base_footprint"\n'
        for it in ("robot1", "robot2")
    )


@pytest.mark.more
@pytest.mark.parametrize("layout", ["both", "tf-per-robot"])
def test_the_adapter_of_free_fleet_finds_each_robot(layout: str, tmp_path: Path) -> None:
    """As nav2_robot_adapter.py and fleet_adapter.py (002505f): names have the robot's before them, and
    so have all frames that come on its tf, among which map -> robot_frame is looked up."""
    zenoh = pytest.importorskip("zenoh")
    made = written(tmp_path, layout)
    robots = yaml.safe_load(text(made, "free_fleet/robots.yaml"))["rmf_fleet"]["robots"]
    edges = [it for it in made.planned.edges if not it.static]
    for robot, told in robots.items():
        assert told["navigation_stack"] == 2 and told["initial_map"]
        file = zenoh.Config.from_json5(text(made, f"free_fleet/{robot}.json5"))
        allow = json.loads(file.get_json("plugins/ros2dds/allow"))
        assert not any(own for what, own in allow.items() if what not in ALLOWED)
        for what, words in ALLOWED.items():
            wanted = {f"/{it}/{word}" for it in robots for word in words}
            passed = {it for it in wanted if any(re.fullmatch(own, it) for own in allow[what])}
            assert passed == {f"/{robot}/{word}" for word in words}
        # A driver that nobody names moves the base; amcl joins its odometry with the map.
        own = {it.parent for it in edges if f"/{robot}/amcl" in it.publishers}
        assert own == {told.get("map_frame", "map")}
        (there,) = (it for it in made.planned.robots if it.name == robot)
        assert told.get("robot_frame", "base_footprint") in there.frames


ALLOWED = {"publishers": ("tf", "battery_state"), "action_servers": ("navigate_to_pose",)}


@pytest.mark.more
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


@pytest.mark.more
def test_the_plan_has_the_bridge_on_both_sides_and_comes_back_from_a_file(made: Outputs) -> None:
    plan = made.planned
    assert domain_of(plan) == {"": 10, "robot1": 11, "robot2": 12}
    for data in (to_yaml(plan).encode(), to_json(plan)):
        again = read_plan(data, "plan")
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
            "domains: {robot1: 1, robot2: 2}\nzenoh: {router: 'tcp/a:7447', domain: 3}\n",
            "leave out that of zenoh",
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


@pytest.mark.more
@pytest.mark.parametrize(
    ("layout", "old", "new", "said"),
    [
        ("both", "tf_static,", "odometry,", "no robot has a topic 'odometry'"),
        ("frames-per-robot", "", "", "take layout tf-per-robot or both"),
        ("both", "node_sets: nav2", "node_sets: robot_state", "no node of robot1 serves"),
    ],
)
def test_what_no_plan_fulfils(layout: str, old: str, new: str, said: str, tmp_path: Path) -> None:
    file = tmp_path / "fleet.yaml"
    given = FLEET.format(layout=layout).replace(old, new)
    if new == "node_sets: robot_state":
        given = given.replace("shared_nodes: map_server\n", "").replace(", /robot1/scan", "")
    file.write_text(given)
    with pytest.raises(UsageError, match=said):
        built_fleet(file)


def faults(folder: Path, fleet: str) -> list[Finding]:
    (folder / "robot.urdf").write_text(SIMULATED)
    (folder / "fleet.yaml").write_text(f"description: robot.urdf\ndistro: jazzy\n{fleet}{SMALL}")
    made = planned_fleet(folder / "fleet.yaml")
    return [it for it in closed_plan(made).gaps if it.code == "MF849"]


@pytest.mark.more
def test_a_plugin_is_where_its_simulator_is(tmp_path: Path) -> None:
    (found,) = faults(tmp_path, "simulator: gazebo\ndomains: {robot1: 11, robot2: 12}\n")
    assert (found.level, found.line, found.robots) == ("error", 4, ("robot1", "robot2"))
    assert faults(tmp_path, "simulator: none\ndomains: {robot1: 11, robot2: 12}\n") == []
    # All in the simulator's domain.
    assert faults(tmp_path, "simulator: gazebo\ndomains: {robot1: 0, robot2: 0}\n") == []


@pytest.mark.more
def test_a_manager_of_a_plugin_is_there_beside_another_description(tmp_path: Path) -> None:
    """gz_ros2_control makes it in the simulator, whatever the robot's parameter file says of it."""
    (tmp_path / "cart.urdf").write_text('<robot name="cart"><link name="base_link"/></robot>')
    (tmp_path / "arm.urdf").write_text(KINDS["gz arm"].text.replace("ROBOT", "arm"))
    (tmp_path / "controllers.yaml").write_text(CONTROLLERS)
    for others in ("", "- {name: r2, description: cart.urdf, simulator: none}\n"):
        (tmp_path / "fleet.yaml").write_text(
            "distro: jazzy\nsimulator: gazebo\nlayout: frame-prefix\n"
            f"domains: {{r1: 7{', r2: 8' if others else ''}}}\n"
            f"robots:\n- {{name: r1, description: arm.urdf}}\n{others}"
        )
        made = planned_fleet(tmp_path / "fleet.yaml")
        (found,) = (it for it in closed_plan(made).gaps if it.code == "MF849")
        assert (found.level, found.robots) == ("error", ("r1",)), others


LOADS = """
from launch import LaunchDescription
from launch_ros.actions import ComposableNodeContainer, LoadComposableNodes, Node
from launch_ros.descriptions import ComposableNode
def generate_launch_description():
    box = dict(package='rclcpp_components', executable='component_container', name='box')
    part = ComposableNode(package='image_proc', plugin='image_proc::RectifyNode', name='rectify')
    return LaunchDescription([{}])
"""


@pytest.mark.more
def test_what_a_launch_file_loads_or_brings_up_is_reached_from_one_domain(tmp_path: Path) -> None:
    """Components are loaded by a service, slam_toolbox is activated by one; processes need none."""
    (tmp_path / "robot.urdf").write_text('<robot name="r"><link name="base_link"/></robot>')
    box = "ComposableNodeContainer(**box, namespace='', composable_node_descriptions=[{}])"
    later = "LoadComposableNodes(target_container='box', composable_node_descriptions=[part])"
    for name, actions in (
        ("part", box.format("part")),
        ("part_later", f"{box.format('')}, {later}"),
    ):
        (tmp_path / f"{name}.launch.py").write_text(LOADS.format(actions))
    (tmp_path / "box.launch.py").write_text(LOADS.format("Node(**box)"))
    head = "description: robot.urdf\ndistro: jazzy\nsimulator: none\n"
    for source, numbers, told in (
        ("node_sets: nav2_composed", (11, 12), True),
        ("node_sets: slam_toolbox", (11, 12), True),
        ("node_sets: slam_toolbox", (11, 11), False),
        ("node_sets: nav2", (11, 12), False),
        ("launch: part.launch.py", (11, 12), True),
        ("launch: part_later.launch.py", (11, 12), True),
        ("launch: part_later.launch.py", (11, 11), False),
        ("launch: box.launch.py", (11, 12), False),
    ):
        domains = "domains: {{robot1: {}, robot2: {}}}\n".format(*numbers)
        (tmp_path / "fleet.yaml").write_text(f"{head}{source}\n{domains}{SMALL}")
        made = built_fleet(tmp_path / "fleet.yaml")
        found = [it for it in made.findings if it.code == "MF849"]
        assert [it.line for it in found] == [5] * told, source
        # The class of this one is known from the launch file alone.
        loaded = {it.plugin for it in made.starts.every}
        assert ("image_proc::RectifyNode" in loaded) == ("part" in source), source


NODES = """\
nodes:
  planner:
    package: acme
    serves: {/get_plan: nav_msgs/srv/GetPlan}
    publishes: {/<serial>/state: std_msgs/msg/String}
  front:
    package: acme
    calls: {/get_plan: nav_msgs/srv/GetPlan}
node_sets: {own: {about: ours, nodes: [planner, front]}}
"""
OWN = """\
nodes: nodes.yaml
node_sets: own
simulator: none
shared_topics: [/get_plan]
shared_nodes: front
"""


@pytest.mark.more
def test_a_service_does_not_cross(tmp_path: Path) -> None:
    """A node of all robots calls what a robot in another domain serves."""
    (tmp_path / "nodes.yaml").write_text(NODES)
    (found,) = faults(tmp_path, f"{OWN}domains: {{robot1: 11, robot2: 12, shared_nodes: 10}}\n")
    assert (found.level, found.line) == ("warning", 8)
    assert "/front of domain 10 calls /get_plan" in found.message
    assert faults(tmp_path, f"{OWN}domains: {{robot1: 11, robot2: 11, shared_nodes: 11}}\n") == []


@pytest.mark.more
def test_one_name_in_two_domains_is_no_clash(tmp_path: Path) -> None:
    """A driver that takes no namespace: with one domain each its robots never meet."""
    (tmp_path / "nodes.yaml").write_text(NODES)
    base = f"description: {ROVER}\ndistro: jazzy\n{OWN}{SMALL}"
    told = {}
    for word, more in (("one", ""), ("two", "domains: {robot1: 11, robot2: 12}\n")):
        (tmp_path / f"{word}.yaml").write_text(base + more)
        made = planned_fleet(tmp_path / f"{word}.yaml").fleet
        told[word] = {it.code for it in made.table.problems}
        assert expected(made).robots
    assert "MR101" in told["one"]
    assert "MR101" not in told["two"]


@pytest.mark.parametrize("layout", ["tf-per-robot", "postfix"])
def test_check_launch_reads_the_files_of_domain_bridge(
    layout: str, here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Each side of a bridge is a node in its domain, with the topics of the file. Robots may be called
    as topics and parts of nodes are, one may be in the domain of all robots."""
    (here / "rover.urdf").write_text(KINDS["gz rover"].text.replace("ROBOT", "rover"))
    (here / "fleet.yaml").write_text(
        f"layout: {layout}\ndistro: jazzy\ndescription: rover.urdf\n"
        "domains: {scan: 11, a: 5, bridge: 0}\ncrossing: [robot_description]\n"
        "robots: [{name: scan}, {name: a, pose: {x: 3}}, {name: bridge, pose: {x: 6}}]\n"
    )
    assert main(["build", "fleet.yaml", "-o", "out", "-q"]) == 0
    check = ["check-launch", "out/fleet.launch.py", "--plan", "out/plan.yaml"]
    capsys.readouterr()
    assert main(check) == 0
    said = capsys.readouterr().out
    assert " error: " not in said and " warning: " not in said
    # In one view of all domains the copies are left out.
    assert main(check[:2]) == 0
    assert "_bridge_0" not in capsys.readouterr().out
    file = here / "out/domain_bridge/a_bridge.yaml"
    config = yaml.safe_load(file.read_text())
    del config["topics"]["/clock"]
    file.write_text(yaml.safe_dump(config))
    assert main(check) == 1
    said = capsys.readouterr().out
    for node, does, domain in (("/a_bridge_0", "subscribe to", 0), ("/a_bridge_5", "publish", 5)):
        wrong = f"{node}: error: MG102 should {does} topic /clock, but does not, in domain {domain}"
        assert f"{wrong} (the file of domain_bridge has no such topic" in said
    file.write_text("topics: [")
    assert main(check) == 3
    assert "domain_bridge does not read" in capsys.readouterr().err
