# SPDX-License-Identifier: Apache-2.0
"""What launch files themselves give to nodes that a fleet starts: init carries what is plain."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from multibot_rewrite.fleet.proposal.given_by_launch import (
    Launched,
    files_given,
    given_by_launch,
    readings,
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
