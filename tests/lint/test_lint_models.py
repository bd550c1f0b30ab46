# SPDX-License-Identifier: Apache-2.0
"""Values in worlds and models of SDF, and pairs of values that cannot both be meant."""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite.lint.check import lint_data, lint_file
from multibot_rewrite.rules.settings import Settings

JAZZY = Settings(distro="jazzy")


def world(inside: str) -> str:
    return f'<sdf version="1.9"><world name="w">{inside}</world></sdf>'


def model(mass: str, ixx: str) -> str:
    inertia = f"<inertia><ixx>{ixx}</ixx><iyy>0.02</iyy><izz>0.03</izz></inertia>"
    inertial = f"<inertial><mass>{mass}</mass>{inertia}</inertial>"
    return world(f'<model name="m"><link name="a">{inertial}</link></model>')


def robot(inside: str) -> str:
    return f'<robot name="r"><link name="a"/>{inside}</robot>'


def system(library: str, class_: str, inside: str = "") -> str:
    return f'<gazebo><plugin filename="{library}" name="{class_}">{inside}</plugin></gazebo>'


def control(plugin: str, low: str = "-1", high: str = "1") -> str:
    limits = f'<param name="min">{low}</param><param name="max">{high}</param>'
    interface = f'<command_interface name="position">{limits}</command_interface>'
    return robot(
        '<link name="b"/><joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint>'
        f'<ros2_control name="s" type="system"><hardware>{plugin}</hardware>'
        f'<joint name="j">{interface}<state_interface name="position"/></joint></ros2_control>'
    )


def lidar(type_: str) -> str:
    """Return a model with a lidar, in a world of gz-sim."""
    plugin = '<plugin filename="gz-sim-sensors-system" name="gz::sim::systems::Sensors"/>'
    sensor = f'<sensor name="s" type="{type_}"><topic>scan</topic></sensor>'
    return world(f'{plugin}<model name="m"><link name="a">{sensor}</link></model>')


JSP = ("gz-sim-joint-state-publisher-system", "gz::sim::systems::JointStatePublisher")
DRIVE = ("gz-sim-diff-drive-system", "gz::sim::systems::DiffDrive")
MOCK = "<plugin>mock_components/GenericSystem</plugin>"
# What is wrong, what is not, and the code that tells the one from the other.
PAIRS = {
    "a pose of five numbers": (
        world('<model name="m"><pose>0 0 1 0 0</pose><link name="a"/></model>'),
        world('<model name="m"><pose>0 0 1 0 0 0</pose><link name="a"/></model>'),
        "MB120",
    ),
    # Param.cc: must have 6 values, but more than that were found; 7 are a quaternion's.
    "a pose of seven numbers": (
        world('<model name="m"><pose>0 0 1 0 0 0 1</pose><link name="a"/></model>'),
        world(
            '<model name="m"><pose rotation_format="quat_xyzw">0 0 1 0 0 0 1</pose>'
            '<link name="a"/></model>'
        ),
        "MB120",
    ),
    # SdfEntityCreator.cc of gz-sim: Sensor type LIDAR not supported yet.
    "a lidar of Classic in a model": (
        lidar("ray"),
        lidar("gpu_lidar"),
        "MB637",
    ),
    "a word for true": (
        world('<model name="m"><static>yes</static><link name="a"/></model>'),
        world('<model name="m"><static>1</static><link name="a"/></model>'),
        "MB120",
    ),
    "a tag of a light": (
        world('<light name="s" type="point"><cast_shadow>true</cast_shadow></light>'),
        world('<light name="s" type="point"><cast_shadows>true</cast_shadows></light>'),
        "MB110",
    ),
    "steps of no time": (
        world('<physics type="ode"><max_step_size>0</max_step_size></physics>'),
        world('<physics type="ode"><max_step_size>0.001</max_step_size></physics>'),
        "MB125",
    ),
    "a link without a mass": (model("0", "0.02"), model("1", "0.02"), "MB606"),
    "an inertia of no body": (model("1", "0.2"), model("1", "0.02"), "MB606"),
    "a system twice": (
        robot(system(*JSP) * 2),
        robot(system(*JSP, "<joint_name>j</joint_name>") + system(*JSP)),
        "MB201",
    ),
    "a library nearly that of a class": (
        robot(system("gz-sim-imu-sytem", "gz::sim::systems::Imu")),
        robot(system("my-imu", "gz::sim::systems::Imu")),
        "MB160",
    ),
    "a frame to itself": (
        robot(system(*DRIVE, "<frame_id>a</frame_id><child_frame_id>a</child_frame_id>")),
        robot(system(*DRIVE, "<frame_id>odom</frame_id><child_frame_id>a</child_frame_id>")),
        "MB230",
    ),
    "a minimum above": (
        robot(system(*DRIVE, "<min_velocity>1</min_velocity><max_velocity>0.5</max_velocity>")),
        robot(system(*DRIVE, "<min_velocity>-1</min_velocity><max_velocity>0.5</max_velocity>")),
        "MB125",
    ),
    "hardware without a class": (control("<plugin/>"), control(MOCK), "MB115"),
    "a command's min above its max": (control(MOCK, "1", "-1"), control(MOCK), "MB538"),
    "a word of one's own": (
        robot(system("gazebo_ros_joint_state_publishr", "jsp")),
        robot(system("libmy_joint_state_publisher.so", "jsp")),
        "MB110",
    ),
    "a format that only Classic takes": (
        robot(
            '<gazebo reference="a"><sensor name="c" type="camera"><camera><image>'
            "<format>FLOAT32</format></image></camera></sensor></gazebo>"
        ),
        robot(
            '<gazebo reference="a"><sensor name="c" type="camera"><camera><image>'
            "<format>FLOAT32</format></image></camera>"
            '<plugin name="p" filename="libgazebo_ros_camera.so"/></sensor></gazebo>'
        ),
        "MB124",
    ),
}


@pytest.mark.parametrize("name", PAIRS)
def test_one_of_two_is_wrong(name: str) -> None:
    wrong, right, code = PAIRS[name]
    kind = "m.sdf" if wrong.startswith("<sdf") else "r.urdf"
    found = [{it.code for it in lint_data(kind, text.encode(), JAZZY)} for text in (wrong, right)]
    assert [code in codes for codes in found] == [True, False]


@pytest.mark.parametrize(
    ("installed", "found"),
    [
        ("install(DIRECTORY src/meshes DESTINATION share/${PROJECT_NAME})", []),
        ("install(DIRECTORY launch src/\n  DESTINATION share/${PROJECT_NAME}/)", []),
        ("install(DIRECTORY src/meshes DESTINATION share/${PROJECT_NAME}/other)", ["MB701"]),
        ("", ["MB701"]),
    ],
)
def test_a_mesh_that_cmake_installs(tmp_path: Path, installed: str, found: list[str]) -> None:
    (tmp_path / "package.xml").write_text("<package><name>arm</name></package>")
    (tmp_path / "CMakeLists.txt").write_text(f"project(arm)\n{installed}\n")
    (tmp_path / "src" / "meshes").mkdir(parents=True)
    (tmp_path / "src" / "meshes" / "base.stl").write_text("solid")
    (tmp_path / "urdf").mkdir()
    file = tmp_path / "urdf" / "arm.urdf"
    mesh = '<visual><geometry><mesh filename="package://arm/meshes/base.stl"/></geometry></visual>'
    file.write_text(f'<robot name="r"><link name="a">{mesh}</link></robot>')
    codes = [it.code for it in lint_file(str(file), Settings(distro="jazzy", select=("MB701",)))]
    assert codes == found


def rover(
    left: str = "0.2", axis: str = "<xyz>0 0 1</xyz>", sizes: tuple[str, str] = ("0.4", "0.1")
) -> str:
    shape = "<geometry><cylinder><radius>0.1</radius><length>0.04</length></cylinder></geometry>"
    parts = "".join(
        f'<link name="{side}"><pose>0 {at} 0 -1.5708 0 0</pose><collision name="c">{shape}</collision>'
        f'</link><joint name="{side}_joint" type="revolute"><parent>base</parent><child>{side}</child>'
        f"<axis>{axis}</axis></joint>"
        for side, at in (("left", left), ("right", "-0.2"))
    )
    joints = "<left_joint>left_joint</left_joint><right_joint>right_joint</right_joint>"
    written = (
        f"<wheel_separation>{sizes[0]}</wheel_separation><wheel_radius>{sizes[1]}</wheel_radius>"
    )
    plugin = '<plugin filename="{}" name="{}">{}</plugin>'.format(*DRIVE, joints + written)
    return world(
        f'<model name="m"><pose>3 3 0 0 0 1</pose><link name="base"/>{parts}{plugin}</model>'
    )


# gz-sim DiffDrive.cc: a left wheel gets (v - w * separation / 2) / radius about its own axis.
@pytest.mark.parametrize(
    ("text", "codes"),
    [
        (rover(), []),
        (rover(axis='<xyz expressed_in="__model__">0 1 0</xyz>'), []),
        (rover(sizes=("0.8", "0.1")), ["MB620"]),
        (rover(sizes=("0.4", "0.2")), ["MB620"]),
        (rover(left="0.6"), ["MB620"]),
        (rover(left="-0.6"), ["MB622"]),
        (rover(axis="<xyz>0 0 -1</xyz>"), ["MB622"]),
        (rover(axis="<xyz>0 1 0</xyz>"), ["MB622"] * 2),
        (rover().replace("<pose>0 0.2 0", '<pose relative_to="left">0 0.2 0'), []),
    ],
)
def test_the_drive_of_a_model_is_measured(text: str, codes: list[str]) -> None:
    settings = JAZZY._replace(select=("MB620", "MB622"))
    assert [it.code for it in lint_data("m.sdf", text.encode(), settings)] == codes


@pytest.mark.parametrize(("distro", "level"), [("humble", "note"), ("jazzy", "error")])
def test_a_range_that_classic_does_not_know_is_a_note_there(distro: str, level: str) -> None:
    friction = "<surface><friction><ode><mu>-1</mu></ode></friction></surface>"
    collision = f'<collision name="c"><geometry><box/></geometry>{friction}</collision>'
    text = world(f'<model name="m"><link name="a">{collision}</link></model>')
    settings = Settings(distro=distro, select=("MB125",))
    assert [it.level for it in lint_data("m.sdf", text.encode(), settings)] == [level]
    system = '<plugin filename="ignition-gazebo-physics-system" name="Physics"/></world>'
    other = text.replace("</world>", system)
    assert [it.level for it in lint_data("m.sdf", other.encode(), settings)] == ["error"]
