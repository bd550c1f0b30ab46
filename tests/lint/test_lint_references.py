# SPDX-License-Identifier: Apache-2.0
"""MB2: what is found, where, and what is not a fault."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from counted_steps import growth

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.lint.check import lint_file
from multibot_rewrite.rules.settings import Settings

LINKS = '<link name="base_link"/><link name="arm_link"/><link name="tip"/>'
JOINT = '<joint name="{}" type="{}"><parent link="{}"/><child link="{}"/>{}</joint>'
SHOULDER = JOINT.format("shoulder", "revolute", "base_link", "arm_link", "")
ROBOT = LINKS + SHOULDER + JOINT.format("wrist", "revolute", "arm_link", "tip", "")
FIXED = LINKS + SHOULDER + JOINT.format("wrist", "fixed", "arm_link", "tip", "")
FOLLOWS = '<mimic joint="shoulder"/>'
MIMIC = LINKS + SHOULDER + JOINT.format("wrist", "revolute", "arm_link", "tip", FOLLOWS)
CONTROL = '<ros2_control name="s" type="system">{}</ros2_control>'
BOTH = '<joint name="shoulder"/><joint name="wrist"/>'
COMMAND = (
    '<joint name="shoulder"/><joint name="wrist"{}><command_interface name="position"/></joint>'
)
BLOCK = '<gazebo reference="{}">{}</gazebo>'
SENSOR = '<sensor name="{}" type="imu">{}</sensor>'
PLUGIN = '<gazebo><plugin filename="lib{}.so" name="p">{}</plugin></gazebo>'
P3D = "<ros/><body_name>tip</body_name><frame_name>{}</frame_name>"
DRIVE = PLUGIN.format("gazebo_ros_diff_drive", "<ros/><left_joint>{}</left_joint>")


def lint(folder: Path, body: str, codes: tuple[str, ...] = ("MB2",)) -> list[Finding]:
    file = folder / "in.urdf"
    file.write_text(body if body.startswith("<robot") else f'<robot name="r">{body}</robot>')
    return lint_file(str(file), Settings(select=codes))


def found(folder: Path, body: str) -> list[str]:
    return [it.code for it in lint(folder, body)]


@pytest.mark.parametrize(
    ("body", "codes"),
    [
        (ROBOT, []),
        # a name of the other kind is not there
        (ROBOT + CONTROL.format(BOTH + '<joint name="tip"/>'), ["MB211"]),
        (ROBOT + CONTROL.format(BOTH), []),
        # a joint in two systems is not a duplicate, in one it is
        (
            ROBOT + CONTROL.format(BOTH) + CONTROL.format(BOTH).replace('name="s"', 'name="t"'),
            [],
        ),
        (ROBOT + CONTROL.format(BOTH + '<joint name="wrist"/>'), ["MB201"]),
        (ROBOT + CONTROL.format(BOTH + '<gpio name="wrist"/>'), []),
        (ROBOT + CONTROL.format(BOTH) * 2, ["MB201"]),
        # a sensor's name counts in its link
        (ROBOT + BLOCK.format("tip", SENSOR.format("s", "") * 2), ["MB201"]),
        (ROBOT + BLOCK.format("tip", SENSOR.format("s", "")) * 2, ["MB201"]),
        # a block for Gazebo is right below the robot: inside of another one no node reads it
        (ROBOT + BLOCK.format("tip", BLOCK.format("tip", SENSOR.format("s", "")) * 2), []),
        (
            ROBOT
            + BLOCK.format("tip", SENSOR.format("s", ""))
            + BLOCK.format("arm_link", SENSOR.format("s", "")),
            [],
        ),
        # links may repeat a material
        (ROBOT + '<material name="m"/>' * 2, ["MB201"]),
        (
            '<link name="a"><visual><material name="m"/></visual><visual><material name="m"/>'
            "</visual></link>",
            [],
        ),
        # a plugin of ROS 1 is not a node
        (ROBOT + PLUGIN.format("gazebo_ros_p3d", "<bodyName>tip</bodyName>") * 2, []),
        (ROBOT + PLUGIN.format("gazebo_ros_p3d", P3D.format("world")) * 2, ["MB201"]),
        (
            ROBOT
            + PLUGIN.format("gazebo_ros_p3d", P3D.format("world"))
            + PLUGIN.format(
                "gazebo_ros_p3d",
                P3D.format("world").replace("<ros/>", "<ros><namespace>/b</namespace></ros>"),
            ),
            [],
        ),
        (
            ROBOT + '<transmission name="t"><joint name="wrist"/></transmission>' * 2,
            ["MB201", "MB228"],
        ),
        # the same value twice is not a contradiction, two names of one property may be one
        (ROBOT + BLOCK.format("tip", "<mu1>1</mu1>") * 2, []),
        (
            ROBOT
            + BLOCK.format("tip", "<maxVel>1</maxVel>")
            + BLOCK.format("tip", "<max_vel>2</max_vel>"),
            ["MB210"],
        ),
        (ROBOT + BLOCK.format("tip", "<mu1>1</mu1><mu1>2</mu1>"), ["MB210"]),
        (ROBOT + BLOCK.format("", "<mu1>1</mu1><mu1>2</mu1>"), []),
        # the world, and what Gazebo makes, are there
        (ROBOT + PLUGIN.format("gazebo_ros_p3d", P3D.format("world")), []),
        (ROBOT + PLUGIN.format("gazebo_ros_p3d", P3D.format("odom")), []),
        (ROBOT + DRIVE.format("shouder"), ["MB211"]),
        (ROBOT + DRIVE.format("shoulder"), []),
        # a description without a link is a part; one with macros that nobody has is no more than that
        (DRIVE.format("shoulder") + BLOCK.format("tip", ""), []),
        (
            '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arm/>'
            '<link name="a"/><gazebo reference="b"/></robot>',
            ["MB103"],
        ),
        (f"<robot>{ROBOT}{BLOCK.format('tipp', '')}</robot>", []),
        (ROBOT + BLOCK.format("", ""), []),
        (ROBOT + BLOCK.format("wrist", ""), []),
        # Gazebo Classic takes a name with the scope of the robot, of no other
        (ROBOT + PLUGIN.format("LinkPlot3DPlugin", "<plot><link>r::tip</link></plot>"), []),
        (
            ROBOT + PLUGIN.format("LinkPlot3DPlugin", "<plot><link>x::tip</link></plot>"),
            ["MB202"],
        ),
        # the joints of a Webots robot are those of its PROTO
        (
            ROBOT
            + CONTROL.format(
                BOTH
                + "<hardware><plugin>webots_ros2_control::Ros2ControlSystem</plugin></hardware>"
                '<joint name="finger"/>'
            ),
            [],
        ),
        # white space in an attribute is part of the name, in a text it is not
        (LINKS + JOINT.format("j", "fixed", " base_link", "tip", ""), ["MB221"]),
        (ROBOT + DRIVE.format(" shoulder\n"), []),
        # mimic: an undeclared leader, a leader in another system, a command
        (ROBOT.replace("</joint>", '<mimic joint="nobody"/></joint>', 1), ["MB211"]),
        (MIMIC + CONTROL.format(BOTH), []),
        (MIMIC + CONTROL.format('<joint name="wrist"/>'), ["MB227"]),
        (MIMIC + CONTROL.format(COMMAND.format("")), ["MB226"]),
        (MIMIC + CONTROL.format(COMMAND.format(' mimic="false"')), []),
        (ROBOT + CONTROL.format(COMMAND.format("")), []),
        # what cannot move is not driven, and what is driven elsewhere is not missing
        (FIXED + CONTROL.format(BOTH), ["MB224"]),
        (FIXED + '<transmission name="t"><joint name="wrist"/></transmission>', ["MB225"]),
        (FIXED + CONTROL.format('<joint name="shoulder"/>'), []),
        (ROBOT + CONTROL.format('<joint name="shoulder"/>'), ["MB228"]),
        (ROBOT + CONTROL.format('<joint name="shoulder"/>') + DRIVE.format("wrist"), []),
        (ROBOT + CONTROL.format(""), []),
        (ROBOT + '<transmission name="t"><gap_joint name="wrist"/></transmission>', ["MB228"]),
        (ROBOT + '<transmission name="t"/>', ["MB223"]),
        # nothing falls over
        ("<joint/><link/><link/><transmission/><ros2_control><joint/></ros2_control>", ["MB223"]),
        ('<gazebo reference=""/><gazebo/><link name=" "/>', []),
    ],
)
def test_what_is_found(tmp_path: Path, body: str, codes: list[str]) -> None:
    assert sorted(found(tmp_path, body)) == sorted(codes)


@pytest.mark.parametrize(
    ("frame", "codes"),
    [
        ("tip", []),
        # what a namespace, or a robot_state_publisher with a prefix, makes of a link
        ("robot1/tip", []),
        ("/tip", []),
        ("base_lnik", ["MB217"]),
        ("robot1/base_lnik", ["MB217"]),
        ("base_lin", ["MB217"]),
        ("Base_Link", ["MB217"]),
        ("base-link", ["MB217"]),
        # frames that drivers publish are called almost like links
        ("base_link_optical", ["MB217"]),
        ("arm2_link", ["MB217"]),
        ("tap", ["MB217"]),
        ("back_link", ["MB217"]),
        ("robot1/odom", []),
        ("map", []),
    ],
)
def test_frames(tmp_path: Path, frame: str, codes: list[str]) -> None:
    assert found(tmp_path, ROBOT + PLUGIN.format("gazebo_ros_p3d", P3D.format(frame))) == codes


def test_where_the_first_one_stands_is_told(tmp_path: Path) -> None:
    (it,) = lint(tmp_path, '<robot name="r">\n<link name="a"/>\n<link name="a"/></robot>')
    assert (it.code, it.line) == ("MB201", 3)
    assert it.message.endswith("first at line 2")


@pytest.mark.slow
def test_the_cost_of_wrong_names_grows_with_their_number_and_not_faster(tmp_path: Path) -> None:
    def prepared(count: int) -> Callable[[], object]:
        links = "".join(f'<link name="link_number_{n}"/>' for n in range(count))
        blocks = "".join(BLOCK.format(f"lnik_number_{n}", "") for n in range(count))
        assert len(lint(tmp_path, links + blocks)) == count
        return lambda: lint(tmp_path, links + blocks)

    assert growth(prepared, 50, 200) < 1.5


# Both tags of each value, sdformat parser_urdf.cc (ParseSDFExtension).
PROPERTIES = (
    "material", "mu1", "mu2", "kp", "kd", "gravity", "dampingFactor", "maxVel max_vel",
    "minDepth min_depth", "maxContacts max_contacts", "laserRetro laser_retro",
    "selfCollide self_collide", "stopCfm stop_cfm", "stopErp stop_erp", "fudgeFactor fudge_factor",
    "implicitSpringDamper implicit_spring_damper", "provideFeedback provide_feedback",
)  # fmt: skip


def test_each_property_is_known_by_all_its_tags(tmp_path: Path) -> None:
    for at in (0, -1):
        pairs = [(words.split()[at], words.split()[-1 - at]) for words in PROPERTIES]
        blocks = (f"<{one}>1</{one}>\n<{other}>2</{other}>" for one, other in pairs)
        seen = lint(tmp_path, ROBOT + BLOCK.format("tip", "".join(blocks)), ("MB210",))
        assert [it.message.split()[0] for it in seen] == [other for _, other in pairs]


@pytest.mark.parametrize(
    ("body", "levels"),
    [
        (DRIVE.format("shouder"), ["warning", "error", "error"]),
        (BLOCK.format("tipp", SENSOR.format("s", "")), ["warning", "warning", "warning"]),
        (CONTROL.format('<joint name="tipp"/>'), ["error", "warning", "error"]),
        ('<transmission name="t"><joint name="tipp"/></transmission>', ["warning"] * 3),
    ],
)
def test_what_a_simulator_does_without(body: str, levels: list[str], tmp_path: Path) -> None:
    """gazebo_ros_diff_drive.cpp ends itself, gazebo_system.cpp of humble skips the joint; no
    simulator of ROS 2 reads a transmission."""
    asked = [
        Settings(select=("MB202", "MB211"), distro=distro, simulated=simulated)
        for distro, simulated in (("lyrical", False), ("humble", True), ("lyrical", True))
    ]
    file = tmp_path / "in.urdf"
    file.write_text(f'<robot name="r">{ROBOT}{body}</robot>')
    assert [it.level for one in asked for it in lint_file(str(file), one)] == levels


TWO = '<link name="base"><collision/><collision/></link><link name="bumper"><collision/></link>'
BUMPER = TWO + JOINT.format("j", "fixed", "base", "bumper", "")
TOUCH = "<contact><collision>{}</collision></contact>"
LUMPED = "base_fixed_joint_lump__bumper_collision_2"
KEEP = BLOCK.format("j", "<preserveFixedJoint>true</preserveFixedJoint>")
SDF = (
    '<sdf version="1.9"><model name="m"><link name="a"><collision name="c"/>{}</link>'
    '<link name="b"><collision name="d"/></link></model></sdf>'
)
GZ = '<gazebo><plugin filename="gz-sim-{}-system" name="gz::sim::systems::{}">{}</plugin></gazebo>'
TOUCHED = GZ.format("touchplugin", "TouchPlugin", "<target>w</target><collision>{}</collision>")
MEASURES = CONTROL.format(
    '<hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware><sensor name="{}"/>'
)
IMU = BLOCK.format("tip", SENSOR.format("imu", "")) + ROBOT
ARDUPILOT = PLUGIN.format("ArduPilotPlugin", "<imuName>{}</imuName>")


def _contact(body: str) -> str:
    return SENSOR.format("s", body).replace('"imu"', '"contact"')


@pytest.mark.parametrize(
    ("body", "hint"),
    [
        # sdformat parser_urdf.cc: CreateCollisions counts, CreateCollision says where a link was.
        *((BLOCK.format("bumper", _contact(TOUCH.format(it))) + BUMPER, hint) for it, hint in (
            ("base_collision", None), ("base_collision_1", None), (LUMPED, None),
            ("bumper_collision", f"write {LUMPED!r}"), (f"base::{LUMPED}", f"write {LUMPED!r}"),
            ("__default__", f"write {LUMPED!r}"),
        )),
        (BLOCK.format("bumper", _contact(TOUCH.format("bumper_collision")) * 2) + BUMPER + KEEP, None),
        (BLOCK.format("base", _contact(TOUCH.format("base"))) + BUMPER,
         "write 'base_collision' or 'base_collision_1'"),
        (BLOCK.format("base", _contact("")) + BUMPER, "write 'base_collision' or 'base_collision_1'"),
        (BLOCK.format("tip", _contact(TOUCH.format("tip_collision"))) + ROBOT,
         "give its link a <collision>"),
        # A part of a robot, a block of nobody, and a sensor that is no simulator's.
        (BUMPER.replace("<collision/>", _contact(TOUCH.format("x"))), None),
        (BLOCK.format("bumper", _contact(TOUCH.format("x"))), None),
        (BLOCK.format("tipp", _contact(TOUCH.format("x"))) + BUMPER, None),
        # gz-sim Contact.cc: a child of the sensor's link, by its own name.
        (SDF.format(_contact(TOUCH.format("c"))), None),
        (SDF.format(_contact(TOUCH.format("d"))), "write 'c'"),
        (TOUCHED.format("base_collision_1") + BUMPER, None),
        (TOUCHED.format(f"m::base::{LUMPED}") + BUMPER, None),
        (TOUCHED.format("base_colision_1") + BUMPER, "did you mean 'base_collision_1'?"),
        # gz_system.cpp registerSensors: by the name of the simulated one.
        (MEASURES.format("imu") + IMU, None),
        (MEASURES.format("imuu") + IMU, "did you mean 'imu'?"),
        (MEASURES.format("imuu").replace("gz_ros2_control", "b") + IMU, None),
        (ARDUPILOT.format("tip::imu") + IMU, None),
        (ARDUPILOT.format("r::tip::imuu") + IMU, "did you mean 'imu'?"),
    ],
)  # fmt: skip
def test_parts_that_nothing_has(body: str, hint: str | None, tmp_path: Path) -> None:
    file = tmp_path / ("in.sdf" if body.startswith("<sdf") else "in.urdf")
    file.write_text(body if body.startswith("<sdf") else f'<robot name="r">{body}</robot>')
    found = [(it.level, it.hint) for it in lint_file(str(file), Settings(select=("MB246",)))]
    assert found == ([] if hint is None else [("warning", hint)])
