# SPDX-License-Identifier: Apache-2.0
"""What launch files themselves give to nodes that a fleet starts: init carries what is plain."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from multibot_rewrite import load_fleet
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.fleet.proposal.given_by_launch import (
    Launched,
    files_given,
    given_by_launch,
    readings,
    started_elsewhere,
)

RULE = "remappings=[('odometry/filtered', '/odom'), ('/tf', 'tf')]"
NODE = "Node(package='robot_localization', executable='ekf_node', "
EKF = f"{NODE}name='ekf_filter_node', "
SAID = ["ekf_filter_node: odometry/filtered:=/odom"]
RATE = {"ekf_filter_node": {"frequency": 30.0}}
NOTHING: dict[str, Any] = {}
ASKED = "LaunchConfiguration('rate')"
DECLARED = "DeclareLaunchArgument('rate', default_value='30.0')"
ROWS = [
    (f"{EKF}{RULE})", NOTHING, SAID), (f"launch_ros.actions.{EKF}{RULE})", NOTHING, SAID),
    (f"{EKF}parameters=[path, {{'frequency': 30.0, 'use_sim_time': True}}])", RATE, []),
    (f"{NODE}parameters=[{{'frequency': 30.0}}])", RATE, []),
    (f"{NODE}parameters=[own]); own = {{'frequency': 30.0}}", RATE, []),
    (f"{NODE}parameters=[{{'frequency': rate}}]); rate = {ASKED}; {DECLARED}", RATE, []),
    (f"{NODE}parameters=[{{'frequency': {ASKED}}}])", NOTHING, ["ekf_node: frequency"]),
    (f"{NODE}parameters=[{{'frequency': rate()}}])", NOTHING, ["ekf_node: frequency"]),
    # The fleet starts no node of this name.
    (f"{NODE}name='second', parameters=[{{'frequency': 30.0}}])", NOTHING, ["second: frequency: 30.0"]),
    (
        f"{EKF}parameters=[{{'odom0_config': [True, False, -1.5]}}])",
        {"ekf_filter_node": {"odom0_config": [True, False, -1.5]}},
        [],
    ),
    (f"{EKF}parameters=[path])", NOTHING, []),
    (f"{EKF}parameters=[{{'use_sim_time': sim}}])", NOTHING, []),
    (f"Node(package='own', executable='driver', {RULE})", NOTHING, []), (f"{EKF}", NOTHING, []),
]  # fmt: skip


# An element with what is in it and around it, and the same in YAML.
XML_NODE = '<node pkg="robot_localization" exec="ekf_node"{}>{}</node>'
XML_EKF = XML_NODE.format(' name="ekf_filter_node"', "{}")
XML_RATE = '<param name="frequency" value="{}"/>'
XML_RULE = '<remap from="odometry/filtered" to="/odom"/>'
XML_DECLARED = '<arg name="rate" default="30.0"/>'
YAML_NODE = "- node: {{pkg: robot_localization, exec: ekf_node, {}}}"
YAML_DECLARED = "- arg: {name: rate, default: '30.0'}"
YAML_RULE = "remap: [{from: odometry/filtered, to: /odom}]"
YAML_RATE = "param: [{{name: frequency, value: {}}}]"
XML_ROWS = [
    (XML_EKF.format(XML_RULE + '<remap from="/tf" to="tf"/>'), NOTHING, SAID),
    (XML_EKF.format('<param from="a.yaml"/>' + XML_RATE.format("30.0")), RATE, []),
    (XML_EKF.format(XML_RATE.format("$(var rate)")) + XML_DECLARED, RATE, []),
    (f"<group>{XML_EKF.format(XML_RATE.format('30.0'))}</group>", RATE, []),
    (XML_EKF.format(XML_RATE.format("$(eval '30')")), NOTHING, ["ekf_filter_node: frequency"]),
    (XML_NODE.format("", XML_RATE.format("$(env RATE)")), NOTHING, ["ekf_node: frequency"]),
    (
        XML_EKF.format('<param name="odom0_config" value="[true, false, -1.5]"/>'),
        {"ekf_filter_node": {"odom0_config": [True, False, -1.5]}},
        [],
    ),
    (
        XML_EKF.format('<param name="a"><param name="b" type="str" value="1"/></param>'),
        {"ekf_filter_node": {"a.b": "1"}},
        [],
    ),
    (f"<!-- none -->{XML_EKF.format('')}", NOTHING, []), ("<node", NOTHING, []),
]  # fmt: skip
YAML_ROWS = [
    (YAML_NODE.format(YAML_RATE.format("30.0")), RATE, []),
    (f"{YAML_NODE.format(YAML_RATE.format('$(var rate)'))}\n{YAML_DECLARED}", RATE, []),
    (YAML_NODE.format(YAML_RULE), NOTHING, ["ekf_node: odometry/filtered:=/odom"]),
    ("- group:\n  " + YAML_NODE.format(YAML_RATE.format("30.0")), RATE, []),
    ("- node: [", NOTHING, []), ("- node", NOTHING, []),
]  # fmt: skip


def launched(folder: Path, end: str = "py", **files: str) -> Launched:
    for name, text in files.items():
        (folder / f"{name}.launch.{end}").write_text(f"\n{text}\n")
    paths = [str(folder / f"{it}.launch.{end}") for it in files]
    read = readings([*paths, "none.launch.xml"], "robot.urdf", ("robot.urdf", "other.urdf"))
    return given_by_launch(read, ["robot_localization"], "jazzy")


@pytest.mark.parametrize(("text", "values", "rest"), ROWS)
def test_what_a_launch_file_has_beyond_files_of_parameters(
    text: str, values: dict[str, Any], rest: list[str], tmp_path: Path
) -> None:
    found = launched(tmp_path, a=text)
    assert found.values == values
    assert found.rest == tuple((str(tmp_path / "a.launch.py"), 2, it) for it in rest)


@pytest.mark.parametrize(
    ("end", "whole", "rows"),
    [("xml", "<launch>{}</launch>", XML_ROWS), ("yaml", "launch:\n{}", YAML_ROWS)],
)
def test_launch_files_in_xml_and_yaml(
    end: str, whole: str, rows: list[tuple[str, dict[str, Any], list[str]]], tmp_path: Path
) -> None:
    """As the frontends of launch read them: names of their elements, YAML in texts."""
    for at, (text, values, rest) in enumerate(rows):
        found = launched(tmp_path, end, **{f"r{at}": whole.format(text)})
        assert (text, found.values) == (text, values)
        assert [it for _, _, it in found.rest] == rest
        lines = {2, 3} if end == "yaml" else {2}
        assert {line for _, line, _ in found.rest} <= lines


def test_values_that_differ_from_file_to_file_are_said(tmp_path: Path) -> None:
    one, two = (f"{NODE}parameters=[{{'frequency': {it}}}])" for it in (30.0, 20.0))
    found = launched(tmp_path, a=one, b=two)
    assert found.values == {}
    assert [it for _, _, it in found.rest] == [f"ekf_node: frequency: {it}" for it in (30.0, 20.0)]


def test_the_launch_file_of_another_description_counts_not(tmp_path: Path) -> None:
    mine, its = (f"{NODE}parameters=[{{'frequency': {it}}}])" for it in (30.0, 20.0))
    found = launched(tmp_path, a=f"'robot.urdf', 'other.urdf'\n{mine}", b=f"'other.urdf'\n{its}")
    assert found == Launched(RATE, ())


INCLUDED = """\
DeclareLaunchArgument('rate', default_value='10.0')
DeclareLaunchArgument('file', default_value='none.yaml')
rate = {'frequency': LaunchConfiguration('rate')}
Node(executable='ekf_node', parameters=[LaunchConfiguration('file'), rate])
"""
INCLUDES = """\
here = get_package_share_directory('own')
IncludeLaunchDescription(
    PythonLaunchDescriptionSource(os.path.join(here, 'launch', 'ekf.launch.py')),
    launch_arguments={'rate': '30.0', 'file': PathJoinSubstitution([here, 'config/ekf.yaml'])}.items())
IncludeLaunchDescription(
    PythonLaunchDescriptionSource([FindPackageShare('slam_toolbox'), '/launch/online_async_launch.py']),
    launch_arguments=[('slam_params_file', [FindPackageShare('own'), '/config/slam.yaml'])])
"""


MAPS = {
    "py": "IncludeLaunchDescription('bringup_launch.py', launch_arguments={'map': file}.items())\n"
    "file = PathJoinSubstitution([FindPackageShare('own'), 'maps', 'hall.yaml'])",
    "xml": '<launch><include file="$(find-pkg-share nav2_bringup)/launch/bringup_launch.py">'
    '<arg name="map" value="$(find-pkg-share own)/maps/hall.yaml"/></include></launch>',
    "yaml": "launch:\n- include:\n    file: bringup_launch.py\n"
    "    arg: [{name: map, value: $(find-pkg-share own)/maps/hall.yaml}]",
}


def test_the_map_of_an_included_file_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "own").mkdir()
    (tmp_path / "own" / "package.xml").write_text("<package><name>own</name></package>")
    for end, text in MAPS.items():
        (tmp_path / "own" / f"a.launch.{end}").write_text(text)
        read = readings([f"own/a.launch.{end}"], "robot.urdf", ())
        found = given_by_launch(read, ["nav2"], "jazzy")
        (rest,) = found.rest
        assert (found.values, rest[2]) == ({}, "map_server: yaml_filename: own/maps/hall.yaml")
        assert given_by_launch(read, ["slam_toolbox"], "jazzy").rest == ()


def test_arguments_of_included_files_are_followed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "own" / "launch").mkdir(parents=True)
    (tmp_path / "own" / "package.xml").write_text("<package><name>own</name></package>")
    paths = ["own/launch/ekf.launch.py", "own/launch/all.launch.py"]
    for path, text in zip(paths, (INCLUDED, INCLUDES), strict=True):
        Path(path).write_text(text)
    read = readings(paths, "robot.urdf", ())
    assert given_by_launch(read, ["robot_localization"], "jazzy") == Launched(RATE, ())
    assert {"own/config/ekf.yaml", "own/config/slam.yaml"} <= files_given(read).keys()


IMU = "imu_filter_madgwick"
FILTER = f"Node(package='{IMU}', executable='{IMU}_node', name='imu_filter', {{}})"
OWN = "Node(package='acme', executable='wheels.py')"
STARTED = [
    (OWN, ["wheels.py (acme)"]),
    (f"{OWN}; {OWN}", ["wheels.py (acme)"]),
    (FILTER.format("remappings=[('/imu/data', '/imu/out'), ('/tf', 'tf')]"),
     ["imu_filter (imu_filter_madgwick imu_filter_madgwick_node): /imu/data:=/imu/out"]),
    ("ComposableNode(package='acme', plugin='acme::Wheels')", ["acme::Wheels (acme)"]),
    ("LifecycleNode(package='acme', executable='base', name='b')", ["b (acme base)"]),
    ("Node(package='tf2_ros', executable='static_transform_publisher')",
     ["static_transform_publisher (tf2_ros)"]),
    # Its program is not plain; it may be anything.
    ("Node(package='acme', executable=program())", []),
    # What the fleet has by its stack, every fleet has, only looks, or is no node of a robot.
    (EKF + ")", []), (NODE + "name='second')", []),
    ("Node(package='robot_state_publisher', executable='robot_state_publisher')", []),
    ("Node(package='controller_manager', executable='spawner', arguments=['arm'])", []),
    ("Node(package='ros_gz_bridge', executable='parameter_bridge')", []),
    ("Node(package='rviz2', executable='rviz2')", []), ("", []),
]  # fmt: skip


@pytest.mark.parametrize(("text", "started"), STARTED)
def test_the_nodes_that_launch_files_start_and_a_fleet_does_not(
    text: str, started: list[str], tmp_path: Path
) -> None:
    file = tmp_path / "a.launch.py"
    file.write_text(f"\n{text}\n")
    read = readings([str(file)], "robot.urdf", ("robot.urdf",))
    found = started_elsewhere(read, ["robot_localization"], "jazzy")
    assert found == tuple((str(file), 2, it) for it in started)


BASE = """\
<robot name="base"><link name="base_link"/><link name="imu_link"/>
<joint name="i" type="fixed"><parent link="base_link"/><child link="imu_link"/></joint></robot>
"""
FILES = {
    "package.xml": "<package><name>acme</name></package>",
    "urdf/base.urdf": BASE,
    "config/ekf.yaml": "ekf_node:\n  ros__parameters: {imu0: imu/out, world_frame: odom}\n",
    "config/imu.yaml": "imu_filter:\n  ros__parameters: {use_mag: false, publish_tf: false}\n",
    "launch/base.launch.py": f"""\
from launch import LaunchDescription
from launch_ros.actions import Node
def generate_launch_description():
    return LaunchDescription([
        {FILTER.format("remappings=[('/imu/data', '/imu/out')]")},
        {NODE} name='ekf_node'),
    ])
""",
}


@pytest.mark.slow
def test_what_init_says_of_such_a_node_is_true_and_helps(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    """The rule is lost where the fleet does not start the node, and is there with ``launch:``."""
    for path, text in FILES.items():
        file = tmp_path / "src" / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    fleet = tmp_path / "fleet.yaml"
    args = [
        "init",
        str(tmp_path / "src"),
        "-n",
        "2",
        "--yes",
        "--distro",
        "humble",
        "-o",
        str(fleet),
    ]
    assert main(args) == 0
    assert "started by launch files and not by this fleet: imu_filter" in capfd.readouterr().err
    text = fleet.read_text()
    assert "src/launch/base.launch.py:5: imu_filter (imu_filter_madgwick" in text
    assert "/imu/data:=/imu/out" in text
    launch = load_fleet(fleet).text("fleet.launch.py")
    assert "Not started: imu_filter (nothing in the fleet file starts it" in " ".join(
        launch.split()
    )
    fleet.write_text(f"launch: src/launch/base.launch.py\n{text}")
    mended = load_fleet(fleet, trust=True)
    assert "('imu/data', 'imu/out')" in mended.text("fleet.launch.py")
