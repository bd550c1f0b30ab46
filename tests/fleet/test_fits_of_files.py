# SPDX-License-Identifier: Apache-2.0
"""What a node set adds finds the drive that a robot's own files have: a controller of ros2_control, a
filter that places the robot, a bridge file of one type."""

from __future__ import annotations

from pathlib import Path

import pytest
from paths import ROOT
from plans import ends_of

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.planning.plan import read_plan

ROVER = ROOT / "examples" / "launch_tutorial" / "rover.urdf"
RVIZ = ROOT / "examples" / "launch_tutorial" / "rover.rviz"
MASS = """<inertial><mass value="1"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>"""
WHEEL = """
<link name="{0}_wheel">{1}</link>
<joint name="{0}_wheel_joint" type="continuous"><parent link="chassis"/>
<child link="{0}_wheel"/></joint>
"""
STATE = """<joint name="{}_wheel_joint"><command_interface name="velocity"/>
<state_interface name="position"/><state_interface name="velocity"/></joint>"""
DRIVEN = f"""<robot name="driven">
<link name="chassis">{MASS}</link>
{WHEEL.format("left", MASS)}{WHEEL.format("right", MASS)}
<ros2_control name="wheels" type="system">
<hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware>
{STATE.format("left")}{STATE.format("right")}
</ros2_control>
<gazebo><plugin filename="gz_ros2_control-system" name="gz_ros2_control::GazeboSimROS2ControlPlugin">
<parameters>controllers.yaml</parameters></plugin></gazebo>
</robot>
"""
CONTROLLERS = """\
controller_manager:
  ros__parameters:
    drive: {type: diff_drive_controller/DiffDriveController}
drive:
  ros__parameters:
    left_wheel_names: [left_wheel_joint]
    right_wheel_names: [right_wheel_joint]
    base_frame_id: chassis
"""
# A file of Nav2 as people shorten it: nothing says the type of commands.
NAV2 = """\
controller_server: {ros__parameters: {controller_frequency: 20.0}}
behavior_server: {ros__parameters: {robot_base_frame: base_link}}
velocity_smoother: {ros__parameters: {smoothing_frequency: 20.0}}
"""
ROW = """\
- {{ros_topic_name: {0}, gz_topic_name: {0}, direction: {1},
   ros_type_name: {2}, gz_type_name: {3}}}
"""
PLAIN = ROW.format("cmd_vel", "ROS_TO_GZ", "geometry_msgs/msg/Twist", "gz.msgs.Twist")
ROBOTS = "robots: [{name: robot1, pose: {y: 0.0}}, {name: robot2, pose: {y: 3.0}}]\n"


def build(folder: Path, text: str, **files: str) -> int:
    """Return the exit code of a build of these lines as a fleet file, beside these files, into
    ``out``."""
    for name, data in files.items():
        (folder / name.replace("_", ".")).write_text(data)
    fleet = folder / "fleet.yaml"
    fleet.write_text(text + ROBOTS)
    return main(["build", str(fleet), "-o", str(folder / "out"), "-q"])


def ends(folder: Path, node: str) -> set[tuple[str, str]]:
    """Return what the plan says that a node does with topics."""
    plan = read_plan((folder / "out" / "plan.yaml").read_bytes(), "plan.yaml")
    return {(it.role, it.name) for it in ends_of(plan, node)}


def is_as_planned(folder: Path) -> bool:
    """Whether what the launch file starts has no error against the plan."""
    out = folder / "out"
    return (
        main(["check-launch", str(out / "fleet.launch.py"), "--plan", str(out / "plan.yaml")]) != 1
    )


@pytest.mark.sample(2)
@pytest.mark.parametrize("release", ["humble", "jazzy", "lyrical"])
@pytest.mark.parametrize("layout", ["both", "frames-per-robot"])
def test_nav2_drives_a_controller(release: str, layout: str, tmp_path: Path) -> None:
    """diff_drive_controller.cpp: commands at ~/cmd_vel, odometry at ~/odom; no launch file of the robot
    has a rule for them. In Humble nothing but the plugin hands the description over."""
    text = f"layout: {layout}\naffix: prefix\ndistro: {release}\nnode_sets: nav2\n"
    more = "description: driven.urdf\nrelated_files: {params: controllers.yaml}\n"
    assert build(tmp_path, text + more, driven_urdf=DRIVEN, controllers_yaml=CONTROLLERS) == 0
    last = "velocity_smoother" if release == "humble" else "collision_monitor"
    assert ("publishes", "/robot1/drive/cmd_vel") in ends(tmp_path, f"/robot1/{last}")
    assert ("subscribes", "/robot1/drive/odom") in ends(tmp_path, "/robot1/bt_navigator")
    params = (tmp_path / "out" / "robot1" / "controllers.yaml").read_text()
    assert "robot1/chassis" in params
    assert "base_footprint" not in params
    assert is_as_planned(tmp_path)


def test_a_section_without_the_type_takes_that_of_the_bridge(tmp_path: Path) -> None:
    """Kilted's Nav2 sends TwistStamped, the bridge file has Twist, and no file says otherwise."""
    text = f"layout: both\ndistro: kilted\nnode_sets: navigation\ndescription: {ROVER}\n"
    more = "related_files: {params: nav2.yaml, bridge: bridge.yaml}\n"
    assert build(tmp_path, text + more, nav2_yaml=NAV2, bridge_yaml=PLAIN) == 0
    launch = (tmp_path / "out" / "fleet.launch.py").read_text()
    started = launch.split("Node(")
    for node in ("controller_server", "behavior_server", "velocity_smoother", "collision_monitor"):
        (one,) = (it for it in started if f"name='{node}'" in it)
        assert "'enable_stamped_cmd_vel': False" in one, node
    assert is_as_planned(tmp_path)


def test_real_robots_in_domains_need_no_bridge_to_gazebo(tmp_path: Path) -> None:
    """The file is kept for simulated ones; a domain_bridge is none to Gazebo."""
    text = "layout: both\ndistro: jazzy\nnode_sets: slam_toolbox\n"
    text += f"simulator: none\ndescription: {ROVER}\n"
    more = (
        "domains: {robot1: 11, robot2: 12}\ncrossing: [tf]\nrelated_files: {bridge: bridge.yaml}\n"
    )
    assert build(tmp_path, text + more, bridge_yaml=PLAIN) == 0
    assert not (tmp_path / "out" / "robot1" / "bridge.yaml").exists()
    assert "ros_gz_bridge has to" not in (tmp_path / "out" / "plan.yaml").read_text()


def test_rviz_shows_what_its_file_has(tmp_path: Path) -> None:
    """The panels of Nav2 are in nav2_default_view.rviz; this file has none."""
    text = f"layout: both\ndistro: kilted\nnode_sets: [nav2, rviz_nav2]\ndescription: {ROVER}\n"
    assert build(tmp_path, f"{text}related_files: {{rviz: {RVIZ}}}\n") == 0
    assert is_as_planned(tmp_path)


REAL = DRIVEN.replace("gz_ros2_control/GazeboSimSystem", "acme/Driver")
BARE = f"{REAL[: REAL.index('<gazebo>')]}</robot>"


@pytest.mark.sample(2)
@pytest.mark.parametrize("layout", ["postfix", "both"])
@pytest.mark.parametrize("node_set", ["controllers", "gz_ros2_control"])
@pytest.mark.parametrize(
    ("robot", "codes"), [(DRIVEN, {"MF843"}), (REAL, set()), (BARE, {"MG723"})]
)
def test_a_manager_that_no_node_set_starts_is_one_finding(
    robot: str, codes: set[str], node_set: str, layout: str,
    tmp_path: Path, capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    """In layouts without namespaces the manager is the robot's by its name, whoever starts it."""
    text = f"layout: {layout}\ndistro: jazzy\nsimulator: none\nnode_sets: {node_set}\n"
    more = "description: driven.urdf\n"
    assert build(tmp_path, text + more, driven_urdf=robot) == bool(codes)
    errors = [it for it in capsys.readouterr().err.splitlines() if " error: " in it]
    assert {it.split(" error: ")[1].split()[0] for it in errors} == codes
    assert len(errors) == len(codes)
    assert all("add ros2_control to `node_sets:`" in it for it in errors if "MG723" in it)
    if codes:
        return
    manager = "/controller_manager_robot1" if layout == "postfix" else "/robot1/controller_manager"
    plan = read_plan((tmp_path / "out" / "plan.yaml").read_bytes(), "plan.yaml")
    assert ("calls", f"{manager}/load_controller") in {(it.role, it.name) for it in plan.ends}
    launch = (tmp_path / "out" / "fleet.launch.py").read_text()
    assert ("'-c', f'controller_manager_{name}'" in launch.replace('"', "'")) == (
        layout == "postfix"
    )


ASSISTED = """behavior_server:
  ros__parameters:
    behavior_plugins: [assisted_teleop]
    assisted_teleop: {{plugin: "nav2_behaviors::AssistedTeleop"}}
{}"""
MUX = """twist_mux:
  ros__parameters:
{}    topics:
      navigation: {{topic: nav_vel, timeout: 0.5, priority: 10}}
      teleop: {{topic: joy_vel, timeout: 0.5, priority: 100}}
"""


@pytest.mark.sample(6)
@pytest.mark.parametrize("node_set", ["nav2", "[nav2, teleop]", "[navigation, twist_mux]"])
@pytest.mark.parametrize("release", ["humble", "jazzy", "lyrical"])
@pytest.mark.parametrize(
    ("behaviors", "mux"),
    [("", "use_stamped: true"), ("", ""), ("enable_stamped_cmd_vel: true", "")],
)
def test_assisted_teleop_takes_the_type_of_its_server(
    behaviors: str, mux: str, release: str, node_set: str, tmp_path: Path
) -> None:
    """nav2_behaviors assisted_teleop.cpp: a TwistSubscriber, which asks for the server's
    enable_stamped_cmd_vel; the build sets that where the files leave it open."""
    nav2, own = (f"    {it}\n" if it else "" for it in (behaviors, mux))
    text = f"layout: both\ndistro: {release}\nnode_sets: {node_set}\ndescription: {ROVER}\n"
    files = {"nav2_yaml": ASSISTED.format(nav2), "mux_yaml": MUX.format(own)}
    assert (
        build(tmp_path, f"{text}related_files: {{params: [nav2.yaml, mux.yaml]}}\n", **files) == 0
    )
    plan = read_plan((tmp_path / "out" / "plan.yaml").read_bytes(), "plan.yaml")
    of_server = [it for it in plan.ends if it.node == "/robot1/behavior_server"]
    assert "/robot1/cmd_vel_teleop" in {it.name for it in of_server}
    assert len({it.type for it in of_server if "/Twist" in it.type}) == 1


@pytest.mark.sample(2)
@pytest.mark.parametrize("layout", ["tf-per-robot", "postfix"])
@pytest.mark.parametrize("release", ["jazzy", "lyrical"])
def test_the_launch_replaces_the_share_folders_in_a_parameter_file(
    layout: str, release: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """nav2_bringup params/nav2_params.yaml: its own launch file gives it by ParameterFile with
    allow_substs."""
    own = """bt_navigator:
  ros__parameters:
    bt_search_directories: [$(find-pkg-share nav2_bt_navigator)/behavior_trees]
"""
    (tmp_path / "nav2.yaml").write_text(f"{NAV2}{own}")
    (tmp_path / "fleet.yaml").write_text(
        f"distro: {release}\nlayout: {layout}\nnode_sets: nav2\ndescription: {ROVER}\n"
        "related_files: {params: [nav2.yaml]}\nrobots: [{name: a}, {name: b}]\n"
    )
    build = ["build", str(tmp_path / "fleet.yaml"), "-o", str(tmp_path / "out"), "-q"]
    assert main(build) == 0
    launch = tmp_path / "out" / "fleet.launch.py"
    assert "nav2.yaml'), allow_substs=True)" in launch.read_text()
    check = ["check-launch", str(launch), "--plan", str(tmp_path / "out" / "plan.yaml"), "-q"]
    # 3: the package may not be installed here.
    assert main(check) in (0, 3)
    assert " error: " not in capsys.readouterr().out


def test_a_topic_to_which_a_launched_node_appends_a_word_is_left_to_its_rule(
    tmp_path: Path,
) -> None:
    """nav2_costmap_2d costmap_subscriber.cpp also subscribes to the topic with _updates behind it."""
    (tmp_path / "nav2.yaml").write_text(
        "behavior_server:\n  ros__parameters:\n    local_costmap_topic: local_costmap/costmap_raw\n"
        "    tree: $(find-pkg-share not_here)/a\n"
    )
    (tmp_path / "up.launch.py").write_text(
        "from launch import LaunchDescription\nfrom launch_ros.actions import Node\n"
        "def generate_launch_description():\n    return LaunchDescription([Node(\n"
        "        package='nav2_behaviors', executable='behavior_server', name='behavior_server',\n"
        f"        parameters=['{tmp_path}/nav2.yaml'])])\n"
    )
    (tmp_path / "fleet.yaml").write_text(
        f"distro: lyrical\nlayout: postfix\nsimulator: none\nlaunch: [up.launch.py]\n"
        f"description: {ROVER}\nrelated_files: {{params: [nav2.yaml]}}\n"
        "robots: [{name: a}, {name: b}]\n"
    )
    main(["build", str(tmp_path / "fleet.yaml"), "-o", str(tmp_path / "out"), "-q"])
    written = (tmp_path / "out" / "a" / "nav2.yaml").read_text()
    assert "local_costmap_topic: local_costmap/costmap_raw\n" in written
