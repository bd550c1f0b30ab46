# SPDX-License-Identifier: Apache-2.0
"""What is wrong with one robot's launch file is wrong with each robot of the fleet: it is told, and the
fleet is built. What only the rewrite does, or several robots together, is an error.

Expectations: two robot_localization nodes both publish odometry/filtered and odom -> base_link, in one
robot as in two (ros_filter.cpp).
"""

from __future__ import annotations

from pathlib import Path

import pytest
from built_faults import edited, in_launch
from fleet_folder import planned_fleet
from paths import fixture_text, write_files
from rule_examples import DESCRIPTION

from multibot_rewrite.base.findings.finding import ERROR, WARNING
from multibot_rewrite.checks import of_bringup
from multibot_rewrite.checks.build import make_outputs
from multibot_rewrite.checks.of_bringup import as_the_vendor_has_it
from multibot_rewrite.checks.read_back import read_back
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.knowledge.parameters import load_known_nodes
from multibot_rewrite.producers.launch.running import Knowledge
from multibot_rewrite.rules.system.sharing import sensor_twice
from multibot_rewrite.system.index import index
from multibot_rewrite.system.ownership import whose_by_plan
from multibot_rewrite.system.records import PUBLISHES, TOPIC, End

LAUNCH = fixture_text("as_the_vendor_has_it_launch.txt")
FLEET = """\
layout: {}
{}
distro: jazzy
launch: up.launch.py
simulator: none
robots:
  - {{name: robot1, description: robot.urdf}}
  - {{name: robot2, description: robot.urdf}}
"""
LAYOUTS = {
    "tf-per-robot": "",
    "frames-per-robot": "affix: prefix",
    "both": "affix: prefix",
    "postfix": "affix: postfix",
}
TWICE = {"MG325", "MG408"}


@pytest.fixture
def fleet(tmp_path: Path) -> Path:
    return folder(tmp_path, "both")


def folder(path: Path, layout: str) -> Path:
    (path / "robot.urdf").write_text(DESCRIPTION)
    (path / "up.launch.py").write_text(LAUNCH)
    (path / "fleet.yaml").write_text(FLEET.format(layout, LAYOUTS[layout]))
    return path / "fleet.yaml"


@pytest.mark.parametrize("layout", LAYOUTS)
def test_what_the_vendor_has_is_told_and_built(
    layout: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["check-launch", str(folder(tmp_path, layout).parent / "up.launch.py")]) == 1
    capsys.readouterr()
    assert main(["build", str(tmp_path / "fleet.yaml"), "-o", str(tmp_path / "out")]) == 0
    lines = capsys.readouterr().err.splitlines()
    told = [it for it in lines if any(code in it for code in TWICE)]
    assert len(told) == len(TWICE)
    assert all("warning: " in it and "for one robot, too" in it for it in told)


PUBLISHER = LAUNCH[LAUNCH.index("        Node(") : LAUNCH.index("        ekf('ekf_local')")]


@pytest.mark.parametrize(
    ("more", "said"),
    [
        # His launch has one name for both, so that nobody sees two senders there.
        (
            PUBLISHER.replace(".read_text()", ".read_text().replace('rover', 'again')"),
            "/robot1/robot_state_publisher_2",
        ),
        (
            "Node(package='tf2_ros', executable='static_transform_publisher', name='s',"
            "arguments=['0', '0,0', '0', '0', '0', '0', 'base_link', 'cam'])",
            "0,0 is in the place of --y",
        ),
        (
            "Node(package='acme', executable='drive', name='laser_filter_node',"
            "parameters=[str(ROBOT.with_name('f.yaml'))]),",
            "laser_filter is nearly its name",
        ),
    ],
)
def test_what_is_wrong_with_nodes_of_the_vendor_stops_no_build(
    more: str, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder(tmp_path, "both")
    (tmp_path / "f.yaml").write_text("laser_filter: {ros__parameters: {a: 1}}\n")
    text = LAUNCH.partition("        ekf('ekf_local')")[0].replace(PUBLISHER, PUBLISHER + more)
    (tmp_path / "up.launch.py").write_text(f"{text}    ])\n")
    assert main(["build", str(tmp_path / "fleet.yaml"), "-o", str(tmp_path / "out")]) == 0
    told = [it for it in capsys.readouterr().err.splitlines() if said in it]
    assert any("warning: " in it and "for one robot, too" in it for it in told)


def test_a_sender_that_the_vendor_has_elsewhere_is_an_error(fleet: Path) -> None:
    plan = planned_fleet(str(fleet))
    made = make_outputs(plan, "/any/out")
    assert {(it.code, it.level) for it in read_back(plan, made, "/any/out")} == {
        (it, WARNING) for it in TWICE
    }
    moved = in_launch(lambda it: it.replace('"odometry/map"', '"odometry/filtered"'))
    found = {(it.code, it.level) for it in read_back(plan, edited(made, moved), "/any/out")}
    assert ("MG325", ERROR) in found and ("MG408", WARNING) in found


@pytest.mark.parametrize(
    ("nodes", "level"),
    [
        (("/robot1/ekf_local", "/robot1/ekf_global"), WARNING),
        (("/robot1/ekf_local", "/robot2/ekf_global"), ERROR),
        (("/robot1/ekf_local", "/robot1/another"), ERROR),
    ],
)
def test_only_the_nodes_of_one_robot_excuse_it(
    nodes: tuple[str, ...], level: str, fleet: Path
) -> None:
    plan = planned_fleet(str(fleet))
    known = Knowledge(
        plan.evidence_of(plan.robots[0]).known, load_known_nodes((), "jazzy"), "jazzy"
    )
    name = "/robot1/odometry/filtered"
    ends = (End(TOPIC, PUBLISHES, name, "nav_msgs/msg/Odometry", "", it) for it in nodes)
    planned = make_outputs(plan, "/any/out").planned
    seen = index(planned._replace(ends=tuple(ends)), whose_by_plan(planned))
    given = sensor_twice.finding("both publish it", level=ERROR, names=(name,))
    (found,) = as_the_vendor_has_it(plan, seen, [given], known)
    assert found.level == level


FAULT = """local_costmap:
  local_costmap:
    ros__parameters:
      height: 3.0
"""
READER = """Node(package='nav2_controller', executable='controller_server',
             name='controller_server', parameters=[str(ROBOT.parent / 'nav2.yaml')]),
        ekf('ekf_map'"""


@pytest.mark.parametrize("by_launch", [True, False])
def test_a_fault_of_a_file_of_the_vendor_is_told_and_built(
    by_launch: bool, fleet: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The costmap does not come up with it, in one robot as in two; of other files it is an error."""
    (fleet.parent / "nav2.yaml").write_text(FAULT)
    (fleet.parent / "up.launch.py").write_text(LAUNCH.replace("ekf('ekf_map'", READER))
    if not by_launch:
        text = FLEET.format("both", LAYOUTS["both"]).replace("launch: up.launch.py\n", "")
        fleet.write_text(f"{text}node_sets: [nav2]\nrelated_files: {{params: [nav2.yaml]}}\n")
    code = main(["build", str(fleet), "-o", str(fleet.parent / "out")])
    (told,) = (it for it in capsys.readouterr().err.splitlines() if "MB120" in it)
    assert "nav2.yaml:4:" in told and ("for one robot, too" in told) is by_launch
    assert (code == 0) is by_launch


ARM = """<robot name="arm"><link name="base_link"/><link name="tip"/>
  <joint name="j" type="revolute"><parent link="base_link"/><child link="tip"/>
    <limit lower="0" upper="1" effort="1" velocity="1"/></joint>
  <ros2_control name="a" type="system"><hardware><plugin>mock_components/GenericSystem</plugin>
    </hardware><joint name="j"><command_interface name="position"/>
    <state_interface name="position"/></joint></ros2_control></robot>"""
CONTROLLERS = """controller_manager:
  ros__parameters: {arm: {type: joint_trajectory_controller/JointTrajectoryController}}
arm:
  ros__parameters:
    joints: [j]
    command_interfaces: [position]
    state_interfaces: [position, velocity]
"""
MANAGED = """Node(package='controller_manager', executable='ros2_control_node',
             parameters=[{'robot_description': ROBOT.read_text()}, str(ROBOT.parent / 'arm.yaml')]),
        Node(package='controller_manager', executable='spawner', arguments=['arm']),
    ])
"""
# Its own launch file starts no manager, and so does the fleet.
UNMANAGED = """Node(package='controller_manager', executable='spawner',
             arguments=['forward', '--param-file', str(ROBOT.parent / 'arm.yaml')]),
    ])
"""


@pytest.mark.parametrize(("nodes", "code"), [(MANAGED, "MB229"), (UNMANAGED, "MG723")])
def test_a_controller_of_the_vendor_that_does_not_start_is_told_and_built(
    nodes: str, code: str, fleet: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """It is not activated, in one robot as in two; its hardware is called by no robot's name."""
    launch = LAUNCH[: LAUNCH.index("ekf('ekf_local')")]
    write_files(fleet.parent, {"robot.urdf": ARM, "arm.yaml": CONTROLLERS})
    (fleet.parent / "up.launch.py").write_text(f"{launch}{nodes}")
    assert main(["check-launch", str(fleet.parent / "up.launch.py")]) == 1
    assert f"error: {code}" in capsys.readouterr().out
    assert main(["build", str(fleet), "-o", str(fleet.parent / "out")]) == 0
    (told,) = (it for it in capsys.readouterr().err.splitlines() if code in it)
    assert f"warning: {code}" in told and "for one robot, too" in told


CLASSIC = (
    """<gazebo><plugin filename="libgazebo_ros_planar_move.so" name="planar_move"/></gazebo>"""
)
SIMULATED = """IncludeLaunchDescription([FindPackageShare('gazebo_ros'), '/launch/gazebo.launch.py'],
            launch_arguments={'world': str(ROBOT.parent / 'office.world')}.items()),
        ekf('ekf_map'"""


def test_a_world_that_the_vendor_has_not_is_told_and_built(
    fleet: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """His simulator ends without it, for one robot as for two."""
    text = f"from launch.actions import *\nfrom launch_ros.substitutions import *\n{LAUNCH}"
    (fleet.parent / "up.launch.py").write_text(text.replace("ekf('ekf_map'", SIMULATED))
    mass = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>'
    link = f'<link name="base_link">{mass}</inertial></link>'
    (fleet.parent / "robot.urdf").write_text(f'<robot name="r">{link}{CLASSIC}</robot>')
    fleet.write_text(
        fleet.read_text().replace("simulator: none", "simulator: gazebo").replace("jazzy", "humble")
    )
    assert main(["build", str(fleet), "-o", str(fleet.parent / "out")]) == 0
    (told,) = (it for it in capsys.readouterr().err.splitlines() if "MG713" in it)
    assert "warning: MG713" in told and "for one robot, too" in told


REVERSED = """<robot name="r"><link name="base_link"/><link name="arm"/>
  <joint name="j" type="revolute"><parent link="base_link"/><child link="arm"/>
    <limit lower="1" upper="0" effort="1" velocity="1"/></joint></robot>"""


@pytest.mark.parametrize("by_launch", [True, False])
def test_a_fault_of_his_description_is_told_and_built(
    by_launch: bool, fleet: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """robot_state_publisher runs with it; of a robot that nothing starts it is an error."""
    (fleet.parent / "robot.urdf").write_text(REVERSED)
    if not by_launch:
        fleet.write_text(fleet.read_text().replace("launch: up.launch.py\n", ""))
    code = main(["build", str(fleet), "-o", str(fleet.parent / "out")])
    (told,) = (it for it in capsys.readouterr().err.splitlines() if "MB511" in it)
    assert ("warning: MB511" in told and "for one robot, too" in told) is by_launch
    assert (code == 0) is by_launch


TWO_LINKS = """<robot name="r"><link name="base_footprint"/><link name="base_link"/>
  <joint name="b" type="fixed"><parent link="base_footprint"/><child link="base_link"/></joint>
</robot>"""


@pytest.mark.parametrize("is_read", [True, False])
def test_a_publisher_of_what_cannot_be_read_has_the_description_of_the_fleet(
    is_read: bool, fleet: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """ekf sends odom -> base_link, which already hangs below base_footprint."""
    text = LAUNCH.replace("        ekf('ekf_global'),\n", "")
    if not is_read:
        lost = "Command(['xacro ', str(ROBOT.parent / 'lost.xacro')])"
        imports = "from launch.substitutions import Command\n"
        text = imports + text.replace("ROBOT.read_text()", lost)
    (fleet.parent / "robot.urdf").write_text(TWO_LINKS)
    (fleet.parent / "up.launch.py").write_text(text)
    assert main(["build", str(fleet), "-o", str(fleet.parent / "out")]) == 0
    (told,) = (it for it in capsys.readouterr().err.splitlines() if "MG401" in it)
    assert "warning: MG401" in told and "for one robot, too" in told


ASKED = "Command(['ros2 param get --hide-type /robot_state_publisher robot_description'])"
MANAGER = """        Node(package='controller_manager', executable='ros2_control_node',
             parameters=[{'robot_description': GIVEN}]),
"""


@pytest.mark.parametrize("given", [ASKED, "ROBOT.read_text()"])
def test_a_manager_that_asks_for_the_description_of_a_node_has_it(
    given: str, fleet: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A manager of Humble subscribes to none then (controller_manager.cpp, init_resource_manager)."""
    imports = "from launch.substitutions import Command\n"
    text = LAUNCH.replace("        ekf('ekf_global'),\n", MANAGER.replace("GIVEN", given))
    (fleet.parent / "robot.urdf").write_text(TWO_LINKS)
    (fleet.parent / "up.launch.py").write_text(imports + text)
    fleet.write_text(fleet.read_text().replace("jazzy", "humble"))
    assert main(["build", str(fleet), "-o", str(fleet.parent / "out")]) == 0
    assert not any("controller_manager" in it for it in capsys.readouterr().err.splitlines())
    started = (fleet.parent / "out/fleet.launch.py").read_text().partition("ros2_control_node")[2]
    assert "'robot_description': text(" in started.partition("Node(")[0]


CAMERA = """<robot name="r"><link name="base_link"><inertial><mass value="1"/>
  <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <gazebo reference="base_link"><sensor name="cam" type="camera"><topic>camera/image</topic></sensor>
  </gazebo></robot>"""
SEEN = """        Node(package='ros_gz_sim', executable='create', arguments=['-topic', 'x']),
        Node(package='ros_gz_bridge', executable='parameter_bridge',
             arguments=['/camera/image_raw@sensor_msgs/msg/Image[gz.msgs.Image']),
"""


def test_a_row_of_his_bridge_that_reads_nothing_is_told_and_built(
    fleet: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (fleet.parent / "robot.urdf").write_text(CAMERA)
    head, _, _ = LAUNCH.partition("        ekf('ekf_local'),\n")
    (fleet.parent / "up.launch.py").write_text(f"{head}{SEEN}    ])\n")
    fleet.write_text(fleet.read_text().replace("simulator: none", "simulator: gazebo"))
    assert main(["build", str(fleet), "-o", str(fleet.parent / "out")]) == 0
    (told,) = (it for it in capsys.readouterr().err.splitlines() if "MB879" in it)
    assert "warning: MB879" in told and "/camera/image_raw" in told


HEADS = """\
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.substitutions import FindPackageShare
"""
OFF = """        DeclareLaunchArgument('nav', default_value='false'),
        Node(package='nav2_controller', executable='controller_server',
             condition=IfCondition(LaunchConfiguration('nav'))),
"""
ELSEWHERE = """        Node(package='controller_manager', executable='ros2_control_node',
             parameters=[[FindPackageShare('acme_config'), '/controllers.yaml']]),
        Node(package='controller_manager', executable='spawner', arguments=['wheels']),
"""
LOST = "        IncludeLaunchDescription(str(ROBOT.parent / 'lost.launch.py')),\n"


@pytest.mark.parametrize("more", [OFF, ELSEWHERE, LOST])
def test_what_is_off_or_elsewhere_is_no_fault_of_a_build(more: str, fleet: Path) -> None:
    """The costmaps of what an argument keeps off do not run, types may be in a file that is not here,
    and a file that is lost is named."""
    (fleet.parent / "robot.urdf").write_text(TWO_LINKS)
    (fleet.parent / "up.launch.py").write_text(
        HEADS + LAUNCH.replace("        ekf('ekf_global'),\n", more)
    )
    assert main(["build", str(fleet), "-o", str(fleet.parent / "out")]) == 0


GZ_PLUGIN = '<gazebo><plugin filename="gz-sim-{0}-system" name="gz::sim::systems::{1}">{2}'
ODOMETRY = GZ_PLUGIN.format(
    "odometry-publisher", "OdometryPublisher", "<robot_base_frame>base_link</robot_base_frame>{}"
)
PLACED = (
    CAMERA.replace(
        '<link name="base_link">',
        '<link name="dummy"/><joint name="d" type="fixed"><parent link="dummy"/>'
        '<child link="base_link"/></joint><link name="base_link">',
    ),
    CAMERA,
)


ROW = "- {ros_topic_name: tf, gz_topic_name: tf, ros_type_name: tf2_msgs/msg/TFMessage,"
ROW += " gz_type_name: gz.msgs.Pose_V, direction: GZ_TO_ROS}\n"


@pytest.mark.parametrize("has_row", [False, True])
def test_a_bridge_of_his_gets_no_transforms_that_he_does_without(
    has_row: bool, fleet: Path
) -> None:
    """He bridges none of a frame that has a parent in the description, or one of two gz topics."""
    plugin = ODOMETRY.format("<tf_topic>/tf</tf_topic>" if has_row else "") + "</plugin></gazebo>"
    drive = GZ_PLUGIN.format(
        "diff-drive", "DiffDrive", "<child_frame_id>base_link</child_frame_id>"
    )
    more = f"{plugin}{drive}</plugin></gazebo>" if has_row else plugin
    text = PLACED[has_row].replace("</robot>", f"{more}</robot>")
    (fleet.parent / "robot.urdf").write_text(text)
    head, _, _ = LAUNCH.partition("        ekf('ekf_local'),\n")
    seen = SEEN.replace(
        "/camera/image_raw@sensor_msgs/msg/Image[gz.msgs.Image", "/x@std_msgs/msg/Bool"
    )
    if has_row:
        (fleet.parent / "b.yaml").write_text(ROW)
        before, _, after = seen.partition("arguments=['/x@std_msgs/msg/Bool']")
        seen = f"{before}parameters=[{{'config_file': str(ROBOT.parent / 'b.yaml')}}]{after}"
        fleet.write_text(f"{fleet.read_text()}related_files: {{bridge: [b.yaml]}}\n")
    (fleet.parent / "up.launch.py").write_text(f"{head}{seen}    ])\n")
    fleet.write_text(fleet.read_text().replace("simulator: none", "simulator: gazebo"))
    assert main(["build", str(fleet), "-o", str(fleet.parent / "out")]) == 0
    assert (fleet.parent / "out/robot1/bridge.yaml").read_text().count("Pose_V") == has_row


def test_what_the_vendor_is_warned_of_excuses_no_error(
    fleet: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The same code, names and nodes: what is a warning in one robot is not known as its error."""
    plan = planned_fleet(str(fleet))
    known = Knowledge(
        plan.evidence_of(plan.robots[0]).known, load_known_nodes((), "jazzy"), "jazzy"
    )
    name, nodes = "/robot1/odometry/filtered", ("/robot1/ekf_local", "/robot1/ekf_global")
    ends = (End(TOPIC, PUBLISHES, name, "nav_msgs/msg/Odometry", "", it) for it in nodes)
    planned = make_outputs(plan, "/any/out").planned
    seen = index(planned._replace(ends=tuple(ends)), whose_by_plan(planned))
    given = sensor_twice.finding("both publish it", level=ERROR, names=(name,))

    def levels(level: str) -> list[str]:
        alone = sensor_twice.finding("both", level=level, names=("/odometry/filtered",))
        monkeypatch.setattr(of_bringup, "judge", lambda _: [alone])
        monkeypatch.setattr(of_bringup, "judge_launch", lambda _: [])
        monkeypatch.setattr(of_bringup, "as_sure", lambda it, *_: it)
        return [it.level for it in as_the_vendor_has_it(plan, seen, [given], known)]

    assert levels(WARNING) == [ERROR]
    assert levels(ERROR) == [WARNING]
