# SPDX-License-Identifier: Apache-2.0
"""Nodes and topics that all robots of a fleet share: one map_server, one map."""

from __future__ import annotations

from pathlib import Path

import pytest
from fleet_folder import planned_fleet
from nav2_graphs import ROVER
from plans import own

from multibot_rewrite.base.model import InputError
from multibot_rewrite.checks.build import make_outputs
from multibot_rewrite.checks.closed_plan import closed_plan
from multibot_rewrite.fleet.file.fleet_file import read_fleet
from multibot_rewrite.fleet.fleet import expected
from multibot_rewrite.fleet.fleet_plan import make_plan
from multibot_rewrite.system.records import System

LAYOUTS = ("tf-per-robot", "frames-per-robot", "both", "postfix")
FLEET = """\
layout: {layout}
description: {rover}
node_sets: nav2
distro: jazzy
shared_topics: [/map, /clock, /rosout, /parameter_events, /diagnostics]
shared_nodes: {shared}
robots: [{{name: robot1}}, {{name: robot2}}]
"""


def planned(folder: Path, layout: str, shared: str = "map_server") -> System:
    file = folder / "fleet.yaml"
    file.write_text(FLEET.format(layout=layout, rover=ROVER, shared=shared))
    made = planned_fleet(file).fleet
    assert [it for it in made.table.problems if it.level == "error"] == []
    return expected(made)


@pytest.mark.slow
@pytest.mark.parametrize("layout", LAYOUTS)
def test_each_amcl_reads_the_map_of_the_one_map_server(tmp_path: Path, layout: str) -> None:
    plan = planned(tmp_path, layout)
    assert own(plan) == ("/map_server",)
    ends = [it for it in plan.ends if it.name == "/map"]
    senders = [it.node for it in ends if it.role == "publishes"]
    readers = {it.node for it in ends if it.role == "subscribes" and "amcl" in it.node}
    assert senders == ["/map_server"]
    assert len(readers) == 2
    assert not [it.name for it in plan.ends if it.name.endswith("/map") and it.name != "/map"
                and it.kind == "topic"]  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("layout", LAYOUTS)
def test_no_robot_has_a_copy_of_it_or_manages_it(tmp_path: Path, layout: str) -> None:
    plan = planned(tmp_path, layout)
    below = {it.name for it in plan.ends if "map_server" in it.name}
    assert below
    assert all(name.startswith("/map_server/") for name in below)
    managers = {it.node for it in plan.ends if "amcl" in it.name and it.role == "calls"}
    assert len(managers) == 2
    callers = {it.node for it in plan.ends if "map_server" in it.name and it.role == "calls"}
    assert callers == set()


@pytest.mark.slow
def test_a_client_of_a_shared_node_calls_the_one_there_is(tmp_path: Path) -> None:
    """A service below a node that is shared is that node's, in every layout."""
    nodes = tmp_path / "nodes.yaml"
    nodes.write_text(
        "nodes:\n"
        "  atlas: {package: acme, serves: {~/load: std_srvs/srv/Trigger}}\n"
        "  reader: {package: acme, calls: {atlas/load: std_srvs/srv/Trigger}}\n"
        "node_sets: {acme: {nodes: [atlas, reader]}}\n"
    )
    for layout in LAYOUTS:
        file = tmp_path / "fleet.yaml"
        text = FLEET.format(layout=layout, rover=ROVER, shared="atlas")
        file.write_text(text.replace("node_sets: nav2", "node_sets: acme\nnodes: nodes.yaml"))
        plan = expected(planned_fleet(file).fleet)
        names = {it.name for it in plan.ends if "load" in it.name}
        assert names == {"/atlas/load"}, layout


def test_a_name_that_no_robot_runs_is_refused(tmp_path: Path) -> None:
    with pytest.raises(
        InputError, match=r"shared_nodes: no robot has a node 'map_servr'.*map_server"
    ):
        planned(tmp_path, "both", "map_servr")


@pytest.mark.parametrize(("value", "is_told"), [("map.yaml", False), ("''", True), (None, True)])
def test_a_map_server_without_a_map_is_told(
    value: str | None, is_told: bool, tmp_path: Path
) -> None:
    """nav2_map_server map_server.cpp: with an empty yaml_filename it waits for a service call."""
    text = FLEET.format(layout="tf-per-robot", rover=ROVER, shared="map_server")
    if value is not None:
        own_file = f"map_server: {{ros__parameters: {{yaml_filename: {value}}}}}\n"
        (tmp_path / "own.yaml").write_text(own_file)
        text += "related_files: {params: own.yaml}\n"
    (tmp_path / "fleet.yaml").write_text(text)
    found = make_outputs(planned_fleet(tmp_path / "fleet.yaml")).findings
    assert [it.level for it in found if it.code == "MF857"] == ["note"] * is_told


ROBOT = """<robot name="bot"><link name="base_link"/><gazebo><plugin
 filename="gz-sim-odometry-publisher-system" name="gz::sim::systems::OdometryPublisher">
 <odom_topic>odom</odom_topic></plugin></gazebo></robot>"""
OF_MODEL = (
    '<model name="{}"><link name="l"><sensor name="s" type="camera">{}</sensor></link></model>'
)
ROW = "- {{topic_name: {}, ros_type_name: {}, gz_type_name: a.B, direction: GZ_TO_ROS}}\n".format
ENDS = {"/model/box/pose": "geometry_msgs/msg/Pose", "/above/image": "sensor_msgs/msg/Image",
        "/found": "acme/msg/Found", "/model/bot/pose": "geometry_msgs/msg/Pose"}  # fmt: skip


OWN = "nodes: nodes.yaml\nrelated_files: {bridge: [rows.yaml]}"


def shared_of(folder: Path, **files: str) -> tuple[set[str], str]:
    """Return what robots' nodes subscribe to, and the bridge of all, in a fleet with these files."""
    reads = "".join(f"      {name}: {type_}\n" for name, type_ in ENDS.items())
    nodes = f"nodes:\n  finder: {{package: acme, publishes: {{found: {ENDS['/found']}, cmd_vel: "
    nodes += "geometry_msgs/msg/Twist}}\n  follow:\n    package: acme\n    subscribes:\n"
    nodes += f"{reads}      cmd_vel: geometry_msgs/msg/Twist\n"
    nodes += "node_sets: {acme: {nodes: [finder, follow]}}\n"
    for name, text in {"bot.urdf": ROBOT, "nodes.yaml": nodes, **files}.items():
        (folder / name).write_text(text)
    plan = planned_fleet(folder / "fleet.yaml")
    read = {
        it.name
        for it in expected(plan.fleet).ends
        if {"follow", "robot1"} <= {*it.node.replace("_", "/").split("/")}
    }
    made = {it.path: it.data.decode() for it in make_outputs(plan).files}
    return read, made.get("bridge.yaml", "")


@pytest.mark.parametrize("layout", LAYOUTS[::3])
def test_what_is_given_once_is_shared_and_what_is_the_robots_is_not(
    layout: str, tmp_path: Path
) -> None:
    """Neither an order of one node for all, nor a topic of the model that is the robot."""
    box, above = OF_MODEL.format("box", ""), OF_MODEL.format("eye", "<topic>above/image</topic>")
    bot = OF_MODEL.format("bot", "<topic>odom</topic>")
    fleet = FLEET.format(layout=layout, rover="bot.urdf", shared="finder")
    fleet = fleet.replace("nav2", f"acme\nsimulator: gazebo\nsimulator_world: w.sdf\n{OWN}")
    rows = "".join(ROW(name, type_) for name, type_ in ENDS.items() if name != "/found")
    world = f"<sdf version='1.9'><world name='w'>{box}{above}{bot}</world></sdf>"
    files = {"fleet.yaml": fleet, "w.sdf": world, "rows.yaml": rows}
    read, bridge = shared_of(tmp_path, **files)
    once = {"/model/box/pose", "/above/image", "/found"}
    assert {it for it in read if "robot1" not in it} == once
    assert {it.replace("/robot1", "").replace("_robot1", "") for it in read} == {*ENDS, "/cmd_vel"}
    assert all(it in bridge for it in once - {"/found"}) and "bot" not in bridge


def test_what_plugins_of_a_classic_world_send_is_shared(tmp_path: Path) -> None:
    """gazebo_plugins gazebo_ros_p3d.cpp sends odom."""
    p3d = (
        "<model name='{0}'><link name='l'/><plugin name='p3d' filename='libgazebo_ros_p3d.so'><ros>"
        "<namespace>/model/{0}</namespace><remapping>odom:=pose</remapping></ros></plugin></model>"
    ).format
    world = f"<sdf version='1.6'><world name='w'>{p3d('box')}</world></sdf>"
    start = "Node(package='acme', executable='follow', name='follow')"
    launch = (
        "from launch import LaunchDescription\nfrom launch.actions import ExecuteProcess\n"
        "from launch_ros.actions import Node\ndef generate_launch_description():\n    return "
        f"LaunchDescription([ExecuteProcess(cmd=['gzserver', '{tmp_path / 'w.world'}']), {start}])\n"
    )
    fleet = FLEET.format(layout="both", rover="bot.urdf", shared="[]").replace("jazzy", "humble")
    fleet = fleet.replace("nav2", f"acme\nsimulator: gazebo\nlaunch: go.launch.py\n{OWN}")
    rows = ROW("/x", "std_msgs/msg/Empty")
    files = {"fleet.yaml": fleet, "w.world": world, "go.launch.py": launch, "rows.yaml": rows}
    read, _ = shared_of(tmp_path, **files)
    assert {it for it in read if not it.startswith("/robot1/")} == {"/model/box/pose"}


def test_what_a_shared_node_sends_is_not_moved_to_a_robot(tmp_path: Path) -> None:
    """A build judges one robot at a time: it has to know who sends for all."""
    box = "{/box: geometry_msgs/msg/PoseStamped}"
    (tmp_path / "nodes.yaml").write_text(
        f"nodes:\n  boxes: {{package: acme, publishes: {box}}}\n"
        f"  picker: {{package: acme, subscribes: {box.replace('/box', 'box')}}}\n"
        "node_sets: {acme: {nodes: [boxes, picker]}}\n"
    )
    file = tmp_path / "fleet.yaml"
    text = FLEET.format(layout="tf-per-robot", rover=ROVER, shared="boxes")
    file.write_text(text.replace("node_sets: nav2", "node_sets: acme\nnodes: nodes.yaml"))
    # The plan itself shares the topic.
    plan = make_plan(read_fleet(str(file), "", {}))
    (found,) = (it for it in closed_plan(plan).gaps if it.code == "MG303")
    assert found.hint.startswith("pass the rule /robot1/box:=/box, or put /box in shared_topics")


@pytest.mark.parametrize(
    ("layout", "windows"),
    [("both", ["/robot1/rviz2", "/robot2/rviz2"]), ("frames-per-robot", ["/rviz2"])],
)
def test_the_plan_has_the_windows_that_the_build_opens(
    layout: str, windows: list[str], tmp_path: Path
) -> None:
    """One RViz reads one tf topic: an RViz for all is one for each where each has its own."""
    launch = (
        "from launch import LaunchDescription\nfrom launch_ros.actions import Node\n"
        "def generate_launch_description():\n    return LaunchDescription([\n"
        "        Node(package='rviz2', executable='rviz2')])\n"
    )
    (tmp_path / "go.launch.py").write_text(launch)
    fleet = FLEET.format(layout=layout, rover=ROVER, shared="[]")
    (tmp_path / "fleet.yaml").write_text(fleet.replace("node_sets: nav2", "launch: go.launch.py"))
    made = planned_fleet(tmp_path / "fleet.yaml")
    plan = expected(made.fleet)
    assert [it.name for it in plan.nodes if it.name.endswith("rviz2")] == windows
    tf = {it.name for it in plan.ends if it.node in windows and it.name.endswith("/tf")}
    assert tf == {it.replace("rviz2", "tf") for it in windows}
    (text,) = (
        it.data.decode() for it in make_outputs(made).files if it.path.endswith(".launch.py")
    )
    assert ("f'/{name}/tf'" in text.partition("rviz2")[2]) is (layout == "both")
