# SPDX-License-Identifier: Apache-2.0
"""What launch files themselves give to nodes that a fleet starts: init carries what is plain."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

from multibot_rewrite import load_fleet
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.fleet.proposal.given_by_launch import (
    Launched,
    files_given,
    given_by_launch,
    not_read,
    readings,
    started_elsewhere,
)

RULE = "remappings=[('odometry/filtered', '/odom'), ('/tf', 'tf')]"
NODE = "Node(package='robot_localization', executable='ekf_node', "
EKF = f"{NODE}name='ekf_filter_node', "
SAID = ["ekf_filter_node: odometry/filtered:=/odom"]
RATE = {"ekf_filter_node": {"frequency": 30.0}}
NOTHING: dict[str, Any] = {}
GIVEN = "parameters=[{'frequency': 30.0}]"
ASKED = "LaunchConfiguration('rate')"
DECLARED = "DeclareLaunchArgument('rate', default_value='30.0')"
ROWS = [
    (f"{EKF}{RULE})", NOTHING, SAID),
    (f"{EKF}parameters=[path, {{'frequency': 30.0, 'use_sim_time': True}}])", RATE, []),
    (f"{NODE}parameters=[{{'frequency': 30.0}}])", RATE, []),
    (f"{NODE}parameters=[own]); own = {{'frequency': 30.0}}", RATE, []),
    (f"{NODE}parameters=[{{'frequency': rate}}]); rate = {ASKED}; {DECLARED}", RATE, []),
    (f"{NODE}parameters=[{{'frequency': {ASKED}}}])", NOTHING, ["ekf_node: frequency"]),
    (f"{NODE}parameters=[{{'frequency': Command('rate')}}])", NOTHING, ["ekf_node: frequency"]),
    (f"{NODE}parameters=[{{'frequency': 15.0 * 2}}], condition=IfCondition('false'))", RATE, []),
    (f"GroupAction([{NODE}{GIVEN})], condition=UnlessCondition('true'))", RATE, []),
    (f"OpaqueFunction(function=lambda _: [{NODE}{GIVEN})])", RATE, []),
    # What stands in the file alone: other values are those of a file that it reads.
    (f"{NODE}parameters=[dict(eval(\"{{'freq'+'uency': 1.0, 'x'+'y': 2}}\"))])", NOTHING,
     ["ekf_node: 2 values of files that it reads"]),


    # The fleet starts no node of this name.
    (f"{NODE}name='second', parameters=[{{'frequency': 30.0}}])", NOTHING, ["second: frequency: 30.0"]),
    (
        f"{EKF}parameters=[{{'odom0_config': [True, False, True]}}])",
        {"ekf_filter_node": {"odom0_config": [True, False, True]}},
        [],
    ),
    (f"{EKF}parameters=[path])", NOTHING, []),
    (f"{EKF}parameters=[{{'use_sim_time': True}}])", NOTHING, []),
    (f"Node(package='own', executable='driver', {RULE})", NOTHING, []), (f"{EKF})", NOTHING, []),
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
    (XML_DECLARED + XML_EKF.format(XML_RATE.format("$(var rate)")), RATE, []),
    (f"<group>{XML_EKF.format(XML_RATE.format('30.0'))}</group>", RATE, []),
    (XML_EKF.format(XML_RATE.format("$(eval '30.0')")), RATE, []),
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
    (f"{YAML_DECLARED}\n{YAML_NODE.format(YAML_RATE.format('$(var rate)'))}", RATE, []),
    (YAML_NODE.format(YAML_RULE), NOTHING, ["ekf_node: odometry/filtered:=/odom"]),
    ("- group:\n  " + YAML_NODE.format(YAML_RATE.format("30.0")), RATE, []),
    ("- node: [", NOTHING, []), ("- node", NOTHING, []),
]  # fmt: skip


IMPORTS = "; ".join(
    f"from {it} import *"
    for it in ("launch", "launch.actions", "launch.conditions", "launch.launch_description_sources",
               "launch.substitutions", "launch_ros.actions", "launch_ros.descriptions",
               "launch_ros.substitutions")
)  # fmt: skip


def program(text: str) -> str:
    """A launch file in Python of statements and actions, all of which are in its second line."""
    parts = text.split("; ")
    before = [it for it in parts if re.match(r"\w+ = ", it)]
    actions = ", ".join(
        sorted((it for it in parts if it not in before), key=lambda it: it[:1] != "D")
    )
    given = "; ".join(["path = '/p.yaml'", *before, f"return LaunchDescription([{actions}])"])
    return f"{IMPORTS}\ndef generate_launch_description(): {given}\n"


def launched(folder: Path, end: str = "py", **files: str) -> Launched:
    for name, text in files.items():
        written = program(text) if end == "py" else f"\n{text}\n"
        (folder / f"{name}.launch.{end}").write_text(written)
    paths = [str(folder / f"{it}.launch.{end}") for it in files]
    read = readings(paths, "robot.urdf", ("robot.urdf", "other.urdf"))
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
    both, other = "its = 'robot.urdf', 'other.urdf'; ", "its = 'other.urdf'; "
    found = launched(tmp_path, a=f"{both}{mine}", b=f"{other}{its}")
    assert found == Launched(RATE, ())


INCLUDED = (
    "rate = {'frequency': LaunchConfiguration('rate')}; "
    "DeclareLaunchArgument('rate', default_value='10.0'); "
    "DeclareLaunchArgument('file', default_value='none.yaml'); "
    f"{NODE}parameters=[LaunchConfiguration('file'), rate])"
)
INCLUDES = (
    "own = FindPackageShare('own'); file = PathJoinSubstitution([own, 'config/ekf.yaml']); "
    "IncludeLaunchDescription(PathJoinSubstitution([own, 'launch', 'ekf.launch.py']), "
    "launch_arguments={'rate': '30.0', 'file': file}.items()); "
    "IncludeLaunchDescription(PythonLaunchDescriptionSource([FindPackageShare('slam_toolbox'), "
    "'/launch/online_async_launch.py']), "
    "launch_arguments=[('slam_params_file', [own, '/config/slam.yaml'])])"
)
MAPS = {
    "py": program(
        "file = PathJoinSubstitution([FindPackageShare('own'), 'maps', 'hall.yaml']); "
        "IncludeLaunchDescription('bringup_launch.py', launch_arguments={'map': file}.items())"
    ),
    "xml": '<launch><include file="$(find-pkg-share nav2_bringup)/launch/bringup_launch.py">'
    '<arg name="map" value="$(find-pkg-share own)/maps/hall.yaml"/></include></launch>',
    "yaml": "launch:\n- include:\n    file: bringup_launch.py\n"
    "    arg: [{name: map, value: $(find-pkg-share own)/maps/hall.yaml}]",
}


def package(folder: Path, **files: str) -> None:
    """Make a package of some files, each empty where there is no text."""
    for path, text in {"package.xml": "<package><name>own</name></package>", **files}.items():
        (folder / "own" / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / "own" / path).write_text(text)


def test_the_map_of_an_included_file_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    package(tmp_path, **{"maps/hall.yaml": ""})
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
    """What the file has by itself (10.0) does not count: the other one starts it."""
    monkeypatch.chdir(tmp_path)
    given = "/**: {ros__parameters: {a: 1}}\n"
    made = {f"config/{it}.yaml": given for it in ("ekf", "slam", "other")}
    both = {"ekf": program(INCLUDED), "all": program(INCLUDES)}
    package(tmp_path, **made, **{f"launch/{name}.launch.py": it for name, it in both.items()})
    read = readings([f"own/launch/{it}.launch.py" for it in both], "robot.urdf", ())
    assert given_by_launch(read, ["robot_localization"], "jazzy") == Launched(RATE, ())
    given_files = files_given(read, [f"own/{it}" for it in made])
    assert given_files == {
        "own/config/ekf.yaml": {"", "robot_localization"},
        "own/config/slam.yaml": {""},
    }


ONE = "; Node(package='a', executable='b')"
BAD = {
    "an argument": ("Node(package='a', executable=LaunchConfiguration('ip'))", "'ip' is not set"),
    "it writes": (f"x = open('FOLDER/b', 'w'){ONE}", "give --trust"),
    "it asks the network": (f"x = __import__('socket').socket(){ONE}", "give --trust"),
    "it raises": (f"x = 1 / 0{ONE}", "ZeroDivisionError"),
    "it includes itself": ("IncludeLaunchDescription('FOLDER/a.launch.py')", "without an end"),
    "it ends": (f"x = exit(){ONE}", "it ends itself"),
    "it waits": (f"x = __import__('time').sleep(99){ONE}", "took more than 2 s"),
}


@pytest.mark.parametrize("kind", BAD)
def test_what_cannot_be_read_of_a_launch_file_is_a_line(
    kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What the others have counts, and nothing is written."""
    text, said = BAD[kind]
    if kind == "it waits":
        monkeypatch.setattr("multibot_rewrite.fleet.proposal.given_by_launch._SECONDS", 2.0)
    for name, one in (
        ("a", text.replace("FOLDER", str(tmp_path))),
        ("c", f"{NODE}parameters=[{{'frequency': 30.0}}])"),
    ):
        (tmp_path / f"{name}.launch.py").write_text(program(one))
    paths = [str(tmp_path / f"{it}.launch.py") for it in "ac"]
    read = readings(paths, "robot.urdf", ())
    ((file, _, why),) = not_read(read)
    assert file == paths[0] and said in why
    assert given_by_launch(read, ["robot_localization"], "jazzy").values == RATE
    assert not (tmp_path / "b").exists()


def test_launch_files_that_wait_are_not_all_waited_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("multibot_rewrite.fleet.proposal.given_by_launch._SECONDS", 1.0)
    paths = [str(tmp_path / f"{it}.launch.py") for it in "abcd"]
    for it in paths:
        Path(it).write_text("import time\ntime.sleep(99)\n")
    whys = [why for _, _, why in not_read(readings(paths, "robot.urdf", ()))]
    assert (
        whys
        == ["reading it took more than 1 s; stopped"] * 2 + ["those before it took too long"] * 2
    )


def test_a_program_of_a_launch_file_is_not_started(tmp_path: Path) -> None:
    """Its output is empty, and what the file starts besides is read."""
    made = tmp_path / "made"
    touch = f"os.system('touch {made}'); subprocess.check_call(['touch', {str(made)!r}])"
    lines = f"import os, subprocess; {touch}\n"
    file = tmp_path / "a.launch.py"
    file.write_text(lines + program("Node(package='acme', executable='wheels.py')"))
    found = started_elsewhere(readings([str(file)], "robot.urdf", ()), [], "jazzy")
    assert [it for _, _, it in found] == ["wheels.py (acme)"] and not made.exists()


IMU = "imu_filter_madgwick"
FILTER = f"Node(package='{IMU}', executable='{IMU}_node', name='imu_filter', {{}})"
OWN = "Node(package='acme', executable='wheels.py')"
STARTED = [
    (OWN, ["wheels.py (acme)"]),
    (f"{OWN}; {OWN}", ["wheels.py (acme)"]),
    (FILTER.format("remappings=[('/imu/data', '/imu/out'), ('/tf', 'tf')]"),
     ["imu_filter (imu_filter_madgwick imu_filter_madgwick_node): /imu/data:=/imu/out"]),
    ("LoadComposableNodes(target_container='c', composable_node_descriptions=["
     "ComposableNode(package='acme', plugin='acme::Wheels')])", ["acme::Wheels (acme)"]),
    ("LifecycleNode(package='acme', executable='base', name='b', namespace='')", ["b (acme base)"]),
    ("Node(package='tf2_ros', executable='static_transform_publisher')",
     ["static_transform_publisher (tf2_ros)"]),
    # Its program is not plain; it may be anything.
    ("Node(package='acme', executable=Command('program'))", []),
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
    file.write_text(program(text))
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
