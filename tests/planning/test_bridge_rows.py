# SPDX-License-Identifier: Apache-2.0
"""The rows of a built bridge are the topics that the simulator's source makes of the built description.

``SYSTEMS`` is read in gazebosim/gz-sim src/systems: ignition-gazebo6_6.18.0 for Humble, gz-sim8_8.14.0,
gz-sim9_9.5.0 and gz-sim10_10.4.0 for the others; types of ROS in gazebosim/ros_gz mappings.py.
"""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import pytest
import yaml
from paths import FIXTURES

from multibot_rewrite.base.releases import RELEASES
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.planning.bridged_topics import bridge_data

LAYOUTS = ("tf-per-robot", "frames-per-robot", "both", "postfix", "frame-prefix")
IN, OUT = "GZ_TO_ROS", "ROS_TO_GZ"
DOUBLE = ("std_msgs/msg/Float64", "gz.msgs.Double")
BOOL = ("std_msgs/msg/Bool", "gz.msgs.Boolean")
EMPTY = ("std_msgs/msg/Empty", "gz.msgs.Empty")
TWIST = ("geometry_msgs/msg/Twist", "gz.msgs.Twist")
ODOMETRY = ("nav_msgs/msg/Odometry", "gz.msgs.Odometry")
TF = ("tf2_msgs/msg/TFMessage", "gz.msgs.Pose_V")
ACTUATORS = ("actuator_msgs/msg/Actuators", "gz.msgs.Actuators")
OLD, NEW = RELEASES[:1], RELEASES[1:]
# A topic as Python formats it: {model} is what the model is spawned as, the others are the texts of
# the plugin's elements. Releases, topic, types, direction.
Topics = list[tuple[tuple[str, ...], str, tuple[str, str], str]]
SYSTEMS: list[tuple[str, str, str, Topics]] = [
    # JointController.cc:199 (6.18.0: 146), :226 sub_topic, :213 the actuators of a message
    ("joint-controller", "JointController", "<joint_name>fin</joint_name>",
     [(RELEASES, "/model/{model}/joint/{joint_name}/cmd_vel", DOUBLE, OUT)]),
    ("joint-controller", "JointController", "<joint_name>rudder</joint_name><sub_topic>yaw</sub_topic>",
     [(OLD, "/model/{model}/joint/{joint_name}/cmd_vel", DOUBLE, OUT),
      (NEW, "/model/{model}/yaw", DOUBLE, OUT)]),
    ("joint-controller", "JointController",
     "<joint_name>mast</joint_name><use_actuator_msg>true</use_actuator_msg>"
     "<actuator_number>1</actuator_number><sub_topic>motors</sub_topic>",
     [(OLD, "/model/{model}/joint/{joint_name}/cmd_vel", DOUBLE, OUT),
      (NEW, "/model/{model}/motors", ACTUATORS, OUT)]),
    ("joint-controller", "JointController", "<joint_name>boom</joint_name><topic>boom_cmd</topic>",
     [(RELEASES, "{topic}", DOUBLE, OUT)]),
    # JointPositionController.cc:347 (6.18.0: 184)
    ("joint-position-controller", "JointPositionController", "<joint_name>flap</joint_name>",
     [(RELEASES, "/model/{model}/joint/{joint_name}/0/cmd_pos", DOUBLE, OUT)]),
    ("joint-position-controller", "JointPositionController",
     "<joint_name>hatch</joint_name><joint_index>1</joint_index>",
     [(RELEASES, "/model/{model}/joint/{joint_name}/1/cmd_pos", DOUBLE, OUT)]),
    # JointTrajectoryController.cc:382, 402
    ("joint-trajectory-controller", "JointTrajectoryController", "",
     [(RELEASES, "/model/{model}/joint_trajectory",
       ("trajectory_msgs/msg/JointTrajectory", "gz.msgs.JointTrajectory"), OUT),
      (RELEASES, "/model/{model}/joint_trajectory_progress",
       ("std_msgs/msg/Float32", "gz.msgs.Float"), IN)]),
    # ApplyJointForce.cc:108 (6.18.0: 97)
    ("apply-joint-force", "ApplyJointForce", "<joint_name>claw</joint_name>",
     [(RELEASES, "/model/{model}/joint/{joint_name}/cmd_force", DOUBLE, OUT)]),
    # Thruster.cc:374, 382, 388 (6.18.0: 283, without feedback), 392 by velocities, 345 with a topic
    ("thruster", "Thruster", "<joint_name>prop</joint_name>",
     [(RELEASES, "/model/{model}/joint/{joint_name}/cmd_thrust", DOUBLE, OUT),
      (NEW, "/model/{model}/joint/{joint_name}/ang_vel", DOUBLE, IN)]),
    ("thruster", "Thruster",
     "<namespace>sub</namespace><joint_name>left</joint_name><use_angvel_cmd>true</use_angvel_cmd>"
     "<deadband>1</deadband>",
     [(OLD, "/model/{namespace}/joint/{joint_name}/cmd_thrust", DOUBLE, OUT),
      (NEW, "/model/{namespace}/joint/{joint_name}/cmd_vel", DOUBLE, OUT),
      (NEW, "/model/{namespace}/joint/{joint_name}/force", DOUBLE, IN),
      (NEW, "/model/{namespace}/joint/{joint_name}/enable_deadband", BOOL, OUT)]),
    ("thruster", "Thruster", "<joint_name>right</joint_name><topic>push</topic>",
     [(RELEASES, "{model}/{topic}", DOUBLE, OUT), (NEW, "{model}/{topic}/ang_vel", DOUBLE, IN)]),
    # LinearBatteryPlugin.cc:445, 333, 336 (6.18.0: 421, 322, 325)
    ("linearbatteryplugin", "LinearBatteryPlugin",
     "<battery_name>cells</battery_name><voltage>12</voltage><capacity>2</capacity>"
     "<enable_recharge>true</enable_recharge><charging_time>3</charging_time><recharge_by_topic/>",
     [(RELEASES, "/model/{model}/battery/cells/state",
       ("sensor_msgs/msg/BatteryState", "gz.msgs.BatteryState"), IN),
      (RELEASES, "/model/{model}/battery/cells/recharge/start", BOOL, OUT),
      (RELEASES, "/model/{model}/battery/cells/recharge/stop", BOOL, OUT)]),
    # BuoyancyEngine.cc:196; gz-transport takes the slash at the end off (FullyQualifiedName)
    ("buoyancy-engine", "BuoyancyEngine", "<link_name>base_link</link_name>",
     [(RELEASES, "/model/{namespace}/buoyancy_engine", DOUBLE, OUT),
      (RELEASES, "/model/{namespace}/buoyancy_engine/current_volume", DOUBLE, IN)]),
    # DetachableJoint.cc:104, 152, 185 (6.18.0: 94, 150, 175)
    ("detachable-joint", "DetachableJoint",
     "<parent_link>base_link</parent_link><child_model>box</child_model><child_link>l</child_link>",
     [(RELEASES, "/model/{model}/detachable_joint/detach", EMPTY, OUT),
      (RELEASES, "/model/{model}/detachable_joint/attach", EMPTY, OUT),
      (RELEASES, "{output_topic}", ("std_msgs/msg/String", "gz.msgs.StringMsg"), IN)]),
    # MulticopterVelocityControl.cc:285, 291; MulticopterMotorModel.cc:376
    ("multicopter-control", "MulticopterVelocityControl",
     "<robotNamespace>quad</robotNamespace><comLinkName>base_link</comLinkName>"
     "<velocityGain>1 1 1</velocityGain><attitudeGain>1 1 1</attitudeGain>"
     "<angularRateGain>1 1 1</angularRateGain>",
     [(RELEASES, "{robotNamespace}/cmd_vel", TWIST, OUT),
      (RELEASES, "{robotNamespace}/enable", BOOL, OUT)]),
    ("multicopter-motor-model", "MulticopterMotorModel",
     "<jointName>rotor</jointName><linkName>rotor_link</linkName><motorNumber>0</motorNumber>",
     [(RELEASES, "{model}/command/motor_speed", ACTUATORS, OUT)]),
    # MecanumDrive.cc of 6.18.0 has no Publish
    ("mecanum-drive", "MecanumDrive", "",
     [(RELEASES, "/model/{model}/cmd_vel", TWIST, OUT), (NEW, "/model/{model}/odometry", ODOMETRY, IN),
      (NEW, "/model/{model}/tf", TF, IN)]),
    # PosePublisher.cc:257 of 8.14.0, 272 of 10.4.0 with Util.cc:619 and UserCommands.cc:1028
    ("pose-publisher", "PosePublisher", "<use_pose_vector_msg>true</use_pose_vector_msg>",
     [(RELEASES[:2], "/model/{model}/pose", TF, IN), (RELEASES[2:], "/{model}/pose", TF, IN)]),
    # VelocityControl.cc:177
    ("velocity-control", "VelocityControl", "<topic>twist</topic><link_name>rotor_link</link_name>",
     [(RELEASES, "{topic}", TWIST, OUT),
      (RELEASES, "/model/{model}/link/{link_name}/cmd_vel", TWIST, OUT)]),
    # TouchPlugin.cc:264
    ("touchplugin", "TouchPlugin", "<namespace>bump</namespace><target>wall</target><time>1</time>",
     [(RELEASES, "/{namespace}/touched", BOOL, IN)]),
    # TrackController.cc:257, 270, 286 (6.18.0 has no odometry)
    ("track-controller", "TrackController", "<link>rotor_link</link>",
     [(RELEASES, "/model/{model}/link/{link}/track_cmd_vel", DOUBLE, OUT),
      (RELEASES, "/model/{model}/link/{link}/track_cmd_center_of_rotation",
       ("geometry_msgs/msg/Vector3", "gz.msgs.Vector3d"), OUT),
      (NEW, "/model/{model}/link/{link}/odometry", ODOMETRY, IN)]),
]  # fmt: skip
JOINTS = [
    "fin",
    "rudder",
    "mast",
    "boom",
    "flap",
    "hatch",
    "claw",
    "prop",
    "left",
    "right",
    "rotor",
]
INERTIA = '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>'
MASS = f'<inertial><mass value="1"/>{INERTIA}</inertial>'
CONTACT = (
    '<gazebo reference="base_link"><sensor name="bumper" type="contact">'
    "<contact><collision>x</collision><topic>bumper</topic></contact></sensor></gazebo>"
)


def description(systems: list[tuple[str, str, str, Topics]]) -> str:
    plugins = "".join(
        f'<plugin filename="gz-sim-{file}-system" name="gz::sim::systems::{name}">{inside}</plugin>'
        for file, name, inside, _ in systems
    )
    joints = "".join(
        f'<link name="{it}_link">{MASS}</link><joint name="{it}" type="continuous">'
        f'<parent link="base_link"/><child link="{it}_link"/><axis xyz="0 0 1"/></joint>'
        for it in JOINTS
    )
    return (
        f'<robot name="thing"><link name="base_link">{MASS}</link>{joints}'
        f"<gazebo>{plugins}</gazebo>{CONTACT}</robot>"
    )


def build(folder: Path, text: str, layout: str, release: str) -> Path:
    """Return the folder of robot1, whose model is spawned as hull1."""
    (folder / "thing.urdf").write_text(text)
    side = "postfix" if layout == "postfix" else "prefix"
    (folder / "fleet.yaml").write_text(
        f"layout: {layout}\naffix: {side}\ndistro: {release}\nsimulator: gazebo\n"
        "description: thing.urdf\nrobots:\n- {name: robot1, model: hull1}\n"
        "- {name: robot2, model: hull2, pose: {x: 3}}\n"
    )
    assert main(["build", str(folder / "fleet.yaml"), "-o", str(folder / "out")]) == 0
    return folder / "out" / "robot1"


def rows(text: str) -> list[dict[str, Any]]:
    loaded = yaml.safe_load(text)
    assert isinstance(loaded, list)
    return loaded


def made_of(plugin: ET.Element, topics: Topics, release: str) -> set[tuple[str, ...]]:
    words = {it.tag: (it.text or "").strip() for it in plugin} | {"model": "hull1"}
    return {
        (f"/{name.format(**words).lstrip('/')}", *types, way)
        for releases, name, types, way in topics
        if release in releases
    }


@pytest.mark.sample(5)
@pytest.mark.parametrize("release", RELEASES)
@pytest.mark.parametrize("layout", LAYOUTS)
def test_rows_are_the_topics_that_the_systems_make(
    layout: str, release: str, tmp_path: Path
) -> None:
    made = build(tmp_path, description(SYSTEMS), layout, release)
    plugins = list(ET.parse(made / "thing.urdf").iter("plugin"))
    expected = {
        topic
        for plugin, (*_, topics) in zip(plugins, SYSTEMS, strict=True)
        for topic in made_of(plugin, topics, release)
    }
    sensor = next(ET.parse(made / "thing.urdf").iter("sensor"))
    touch = f"/{sensor.findtext('contact/topic', '').lstrip('/')}"
    expected |= {(touch, "ros_gz_interfaces/msg/Contacts", "gz.msgs.Contacts", IN)}
    shared = rows((tmp_path / "out" / "bridge.yaml").read_text())
    own = rows((made / "bridge.yaml").read_text())
    keys = ("gz_topic_name", "ros_type_name", "gz_type_name", "direction")
    found = {tuple(str(row[key]) for key in keys) for row in own}
    assert found == expected
    assert [row["gz_topic_name"] for row in shared] == ["/clock"]
    # Each is a name in ROS that no other of the robot has; those for tf may have one.
    names = [row["ros_topic_name"] for row in own if row["ros_type_name"] != TF[0]]
    assert len(set(names)) == len(names)
    assert all(re.fullmatch(r"(/[A-Za-z_][A-Za-z0-9_]*)+", it) for it in names)
    other = rows((tmp_path / "out" / "robot2" / "bridge.yaml").read_text())
    assert {it["gz_topic_name"] for it in other}.isdisjoint(it["gz_topic_name"] for it in own)


@pytest.mark.parametrize(
    ("layout", "expected"),
    [
        ("tf-per-robot", {
            "/model/hull1/joint/fin/cmd_vel": "/robot1/joint/fin/cmd_vel",
            "/model/hull1/joint/hatch/1/cmd_pos": "/robot1/joint/hatch_1/cmd_pos",
            "/model/hull1/battery/cells/state": "/robot1/battery/cells/state",
            "/hull1/command/motor_speed": "/robot1/command/motor_speed",
            "/model/hull1/tf": "/robot1/tf",
            "/robot1/boom_cmd": "/robot1/boom_cmd",
        }),
        ("postfix", {
            "/model/hull1/joint/fin_robot1/cmd_vel": "/joint/fin_robot1/cmd_vel/robot1",
            "/model/hull1/joint/hatch_robot1/1/cmd_pos": "/joint/hatch_robot1_1/cmd_pos/robot1",
            "/model/hull1/battery/cells/state": "/battery/cells/state/robot1",
            "/hull1/command/motor_speed": "/command/motor_speed/robot1",
            "/model/hull1/tf": "/tf/robot1",
        }),
    ],
)  # fmt: skip
def test_a_default_topic_is_the_robots_own_in_ros(
    layout: str, expected: dict[str, str], tmp_path: Path
) -> None:
    made = build(tmp_path, description(SYSTEMS), layout, "jazzy")
    named = {
        it["gz_topic_name"]: it["ros_topic_name"] for it in rows((made / "bridge.yaml").read_text())
    }
    assert named | expected == named


def test_what_is_not_bridged_is_said_with_the_reason(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    systems: list[tuple[str, str, str, Topics]] = [
        ("mecanum-drive", "MecanumDrive", "", []),
        ("joint-state-publisher", "JointStatePublisher", "", []),
        ("joint-controller", "JointController", "<joint_name>fin</joint_name>", []),
    ]
    text = description(systems).replace(
        "</robot>",
        '<gazebo><plugin filename="libGripper.so" name="mbzirc::SuctionGripperPlugin">'
        "<parent_link>base_link</parent_link><command_topic>grip</command_topic></plugin></gazebo>"
        '<gazebo reference="base_link"><sensor name="see" type="logical_camera"><topic>see</topic>'
        '</sensor><sensor name="imu" type="imu"/></gazebo></robot>',
    )
    build(tmp_path, text, "tf-per-robot", "humble")
    said = [it.split("MF509 ")[1] for it in capsys.readouterr().err.splitlines() if "MF509" in it]
    of_robot, unsent = (
        " of robot1 is not bridged: ",
        "the Gazebo of Humble advertises it and never sends it",
    )
    of_world = "the default topic has the name of the world in it"
    expected = [
        f"/model/hull1/odometry of gz-sim-mecanum-drive-system{of_robot}{unsent}",
        f"/model/hull1/tf of gz-sim-mecanum-drive-system{of_robot}{unsent}",
        f"<topic> of gz-sim-joint-state-publisher-system{of_robot}{of_world}",
        f"robot1/grip of libGripper.so{of_robot}the type of <command_topic> is not known",
        f"sensor see{of_robot}ros_gz_bridge of humble converts no gz.msgs.LogicalCameraImage",
        f"sensor imu{of_robot}{of_world}",
    ]
    assert sorted(it.split(";")[0] for it in said) == sorted(expected)


def test_two_systems_with_one_topic_have_one_row(tmp_path: Path) -> None:
    """OdometryPublisher.cc:282 and PosePublisher.cc of Humble and Jazzy both have /model/NAME/pose."""
    both: list[tuple[str, str, str, Topics]] = [
        ("pose-publisher", "PosePublisher", "", []),
        ("odometry-publisher", "OdometryPublisher", "", []),
    ]
    made = build(tmp_path, description(both), "frames-per-robot", "jazzy")
    found = [
        it
        for it in rows((made / "bridge.yaml").read_text())
        if it["gz_topic_name"].endswith("/pose")
    ]
    assert [(it["gz_topic_name"], it["ros_topic_name"]) for it in found] == [
        ("/model/hull1/pose", "/tf")
    ]


def fleets() -> list[tuple[str, str]]:
    descriptions = sorted((FIXTURES / "robots").glob("rover*.*df"))
    return [
        (str(it), layout) for it in descriptions if "gz-sim" in it.read_text() for layout in LAYOUTS
    ]


@pytest.mark.sample(5)
@pytest.mark.parametrize(("file", "layout"), [*fleets(), ("", "both"), ("", "postfix")])
@pytest.mark.parametrize("model", ["", ", model: hull"])
def test_plan_and_build_have_the_same_rows(
    file: str, layout: str, model: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    if not file:
        file = str(tmp_path / "all.urdf")
        Path(file).write_text(description(SYSTEMS))
    side = "postfix" if layout == "postfix" else "prefix"
    fleet = tmp_path / "fleet.yaml"
    fleet.write_text(
        f"layout: {layout}\naffix: {side}\nsimulator: gazebo\ndescription: {file}\n"
        f"robots:\n- {{name: r1{model}}}\n- {{name: r2, pose: {{x: 2}}}}\n"
    )
    main(["build", str(fleet), "-o", str(tmp_path / "out")])
    capsys.readouterr()
    assert main(["plan", str(fleet), "--output-kind", "bridge"]) == 0
    planned = rows(capsys.readouterr().out)
    built = [
        row
        for it in sorted((tmp_path / "out").rglob("bridge.yaml"))
        for row in rows(it.read_text())
    ]
    order = sorted(planned, key=str)
    assert order == sorted(built, key=str) and len(planned) > 5


EXAMPLES = sorted((FIXTURES.parent / "examples").rglob("fleet*.yaml"))


@pytest.mark.sample(3)
@pytest.mark.parametrize("fleet", EXAMPLES, ids=lambda it: f"{it.parent.name}-{it.stem}")
def test_plan_and_build_of_an_example_have_the_same_topics(
    fleet: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A row of a user's file takes the place of one for the same topic."""
    main(["build", str(fleet), "-o", str(tmp_path / "out")])
    capsys.readouterr()
    assert main(["plan", str(fleet), "--output-kind", "bridge"]) == 0
    planned = {it["gz_topic_name"] for it in rows(capsys.readouterr().out or "[]")}
    files = (tmp_path / "out").rglob("bridge.yaml")
    built = [row for it in files for row in rows(it.read_text())]
    names = {row.get("gz_topic_name") or row["topic_name"] for row in built}
    assert names == planned or (planned <= names and "related_files" in fleet.read_text())


def test_the_data_speaks_of_types_that_bridges_convert() -> None:
    pairs = bridge_data()["pairs"]
    groups = (*bridge_data()["sensors"].values(), *bridge_data()["plugins"].values())
    used = {(row[2], row[3].rpartition(".")[2]) for group in groups for row in group if row[2]}
    assert {it for it in used if it[1] not in pairs.get(it[0], ())} == set()
