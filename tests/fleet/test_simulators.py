# SPDX-License-Identifier: Apache-2.0
"""Real robots and simulated ones: what a description has for a simulator, in plan, build and check."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml
from fleet_folder import planned_fleet
from nav2_graphs import environment
from paths import ROBOTS

from multibot_rewrite import compare
from multibot_rewrite.checks.closed_plan import closed_plan
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.fleet.fleet import expected
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.system.records import Node, System

# A drive that is a ROS node, and a sensor whose topic a bridge has to carry.
DESCRIPTION = """\
<robot name="rover">
  <link name="base_link"/>
  <gazebo>
    <plugin name="drive" filename="libgazebo_ros_diff_drive.so"/>
  </gazebo>
  <gazebo reference="base_link">
    <sensor name="lidar" type="gpu_lidar"><topic>scan</topic></sensor>
  </gazebo>
</robot>
"""
AMCL = "    /amcl: {pkg: nav2_amcl, exec: amcl, node_name: amcl}\n"
FLEET = """\
layout: tf-per-robot
distro: jazzy
robots:
  - {name: r1, description: robot.urdf}
  - {name: r2, description: robot.urdf}
"""


def plan_of(folder: Path, more: str = "", launched: str = AMCL, fleet: str = FLEET) -> FleetPlan:
    (folder / "robot.urdf").write_text(DESCRIPTION)
    (folder / "system_model.yaml").write_text(f"structure:\n  nodes:\n{launched}")
    (folder / "fleet.yaml").write_text(fleet + more)
    return planned_fleet(folder / "fleet.yaml")


def expectation(folder: Path, more: str = "", launched: str = AMCL) -> System:
    return expected(closed_plan(plan_of(folder, more, launched)))


def test_no_bridge_is_missing_for_a_real_robot(tmp_path: Path) -> None:
    state = [f"/{robot}/robot_state_publisher" for robot in ("r1", "r2")]
    seen = System(tuple(Node(it, it) for it in state), (), (), environment())

    def codes(more: str) -> set[str]:
        return {it.code for it in compare(expectation(tmp_path, more), seen)}

    simulated, real = codes("simulator: gazebo\n"), codes("simulator: none\n")
    assert simulated - real == {"MG101", "MG126"} and real <= simulated


def test_no_controller_sent_joint_states_before_a_rewrite_either(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """doosan dsr_description2: gazebo_ros2_control beside parameters without a controller_manager. It
    publishes no joint states itself (ros2_controllers joint_state_broadcaster does)."""
    (tmp_path / "arm.urdf").write_text("""<robot name="arm"><link name="base"/><link name="upper"/>
<joint name="j" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<gazebo><plugin name="control" filename="libgazebo_ros2_control.so"/></gazebo></robot>""")
    (tmp_path / "params.yaml").write_text(
        "move:\n  ros__parameters: {type: forward_command_controller/ForwardCommandController}\n"
    )
    (tmp_path / "fleet.yaml").write_text(
        "layout: frames-per-robot\ndistro: humble\nsimulator: gazebo\ndescription: arm.urdf\n"
        "related_files: {params: params.yaml}\nrobots: [{name: robot1}]\n"
    )
    main(["plan", str(tmp_path / "fleet.yaml"), "-o", str(tmp_path / "plan.yaml")])
    said = capsys.readouterr().err
    assert "which no node publishes after the rewrite" not in said and "MG316" in said


MODEL = """\
<?xml version="1.0"?><sdf version="1.9"><model name="rover">
  <plugin filename="gz-sim-velocity-control-system" name="gz::sim::systems::VelocityControl">{}</plugin>
  <link name="base_link"><inertial><mass>1</mass></inertial></link>
</model></sdf>
"""


@pytest.mark.parametrize(
    ("given", "hears"),
    [
        ("", "/model/robot1/cmd_vel"),
        ("<topic>/model/rover/cmd_vel</topic>", "/model/robot1_rover/cmd_vel"),
    ],
)
def test_a_topic_that_is_written_out_is_bridged_as_it_is(
    given: str, hears: str, tmp_path: Path
) -> None:
    """VelocityControl.cc makes a topic of the model's name, as it is spawned, where none is given."""
    (tmp_path / "rover.sdf").write_text(MODEL.format(given))
    words = "layout: frames-per-robot\naffix: prefix\ndistro: jazzy\nsimulator: gazebo\n"
    (tmp_path / "f.yaml").write_text(f"{words}description: rover.sdf\nrobots: [{{name: robot1}}]\n")
    main(["build", str(tmp_path / "f.yaml"), "-o", str(tmp_path / "out"), "--force"])
    rows = yaml.safe_load((tmp_path / "out" / "robot1" / "bridge.yaml").read_text())
    assert [it["gz_topic_name"] for it in rows] == [hears]
    if given:
        assert f"<topic>{hears}</topic>" in (tmp_path / "out" / "robot1" / "rover.sdf").read_text()


OWN = """\
<robot name="rover">
  <link name="base_link"/><link name="wheel"/>
  <joint name="turn" type="continuous"><parent link="base_link"/><child link="wheel"/></joint>
  {}
</robot>
"""
PLUGIN = '<gazebo><plugin name="own" filename="libacme.so">{}</plugin></gazebo>'
KNOWN = '<gazebo><plugin name="drive" filename="libgazebo_ros_diff_drive.so"/></gazebo>'
SENSOR = (
    '<gazebo reference="wheel"><sensor name="s" type="ray"><plugin name="p" filename="libacme.so">'
)
HARDWARE = (
    '<ros2_control name="h" type="system"><hardware><plugin>acme/Base</plugin></hardware>'
    '<joint name="turn"><command_interface name="velocity"/></joint></ros2_control>'
)
REAL = "simulator: none\n"


@pytest.mark.parametrize(
    ("parts", "more", "said"),
    [
        (PLUGIN.format("<left>turn</left>") + KNOWN, "", "names the joint turn"),
        (PLUGIN.format("<on>rover::wheel</on>") + KNOWN, "", "names the link wheel"),
        (PLUGIN.format("<rate>5</rate>"), "", "is all that may move it"),
        (PLUGIN.format("<rate>5</rate>") + KNOWN, "", ""),
        (PLUGIN.format("<left>turn</left>"), REAL, ""),
        (f"{SENSOR}<left>turn</left></plugin></sensor></gazebo>", "", ""),
        (HARDWARE, f"{REAL}node_sets: ros2_control\n", "names the joint turn"),
        (HARDWARE, REAL, ""),
    ],
)
def test_a_drive_that_nobody_has_read_is_told(
    parts: str, more: str, said: str, tmp_path: Path
) -> None:
    (tmp_path / "own.urdf").write_text(OWN.format(parts))
    fleet = f"layout: both\naffix: prefix\ndistro: humble\n{more}description: own.urdf\n"
    (tmp_path / "f.yaml").write_text(f"{fleet}robots: [{{name: robot1}}, {{name: robot2}}]\n")
    gaps = closed_plan(planned_fleet(tmp_path / "f.yaml")).gaps
    found = [it.message for it in gaps if it.code == "MF844"]
    assert [said in it for it in found] == ([True] if said else [])


@pytest.mark.parametrize("affix", ["prefix", "postfix"])
def test_the_time_of_a_manager_in_the_simulator_is_that_of_its_robot(
    affix: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A node is known by its name without its robot's, on either side."""
    words = f"layout: postfix\naffix: {affix}\ndistro: jazzy\nnode_sets: gz_ros2_control\n"
    robot = ROBOTS / "rover_gz.urdf"
    file = tmp_path / "fleet.yaml"
    file.write_text(
        f"{words}description: {robot}\nuse_sim_time: false\nrobots: [{{name: r1}}, {{name: r2}}]\n"
    )
    assert main(["build", str(file), "-o", str(tmp_path / "out"), "-q"]) == 1
    name = "r1_robot_state_publisher" if affix == "prefix" else "robot_state_publisher_r1"
    assert f"/{name}: error: MG503" in capsys.readouterr().err


SENSING = """<robot name="bot"><link name="base_link"><inertial><mass value="1"/>
  <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <gazebo reference="base_link"><sensor name="l" type="gpu_lidar"><topic>scan</topic></sensor></gazebo>
</robot>"""


@pytest.mark.parametrize(
    ("keys", "is_told"),
    [
        ("simulator: gazebo\nuse_sim_time: false\nnode_sets: [robot_localization]", True),
        ("simulator: gazebo\nuse_sim_time: true\nnode_sets: [robot_localization]", False),
        ("simulator: gazebo\nnode_sets: [robot_localization]", False),
        ("simulator: none\nuse_sim_time: false\nnode_sets: [robot_localization]", False),
    ],
)
def test_nodes_on_the_time_of_the_machine_beside_sensors_of_a_simulator(
    keys: str, is_told: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """tf and filters refuse data that is decades older than now."""
    (tmp_path / "robot.urdf").write_text(SENSING)
    robots = "robots: [{name: r1}, {name: r2, pose: {x: 3}}]\n"
    text = f"layout: both\naffix: prefix\ndistro: jazzy\ndescription: robot.urdf\n{keys}\n{robots}"
    (tmp_path / "fleet.yaml").write_text(text)
    main(["build", str(tmp_path / "fleet.yaml"), "-o", str(tmp_path / "out")])
    told = [it for it in capsys.readouterr().err.splitlines() if "MG503" in it]
    assert bool(told) is is_told
    assert all("warning:" in it and "on the time of the machine" in it for it in told)
