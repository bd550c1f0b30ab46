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
    (f"{NODE}name='second', parameters=[{{'frequency': 30.0}}])", NOTHING, ["second: frequency"]),
    (
        f"{EKF}parameters=[{{'odom0_config': [True, False, -1.5]}}])",
        {"ekf_filter_node": {"odom0_config": [True, False, -1.5]}},
        [],
    ),
    (f"{EKF}parameters=[path])", NOTHING, []),
    (f"{EKF}parameters=[{{'use_sim_time': sim}}])", NOTHING, []),
    (f"Node(package='own', executable='driver', {RULE})", NOTHING, []), (f"{EKF}", NOTHING, []),
]  # fmt: skip


def launched(folder: Path, **files: str) -> Launched:
    for name, text in files.items():
        (folder / f"{name}.launch.py").write_text(f"\n{text}\n")
    paths = [str(folder / f"{it}.launch.py") for it in files]
    read = readings([*paths, "b.launch.xml"], "robot.urdf", ("robot.urdf", "other.urdf"))
    return given_by_launch(read, ["robot_localization"], "jazzy")


@pytest.mark.parametrize(("text", "values", "rest"), ROWS)
def test_what_a_launch_file_has_beyond_files_of_parameters(
    text: str, values: dict[str, Any], rest: list[str], tmp_path: Path
) -> None:
    found = launched(tmp_path, a=text)
    assert found.values == values
    assert found.rest == tuple((str(tmp_path / "a.launch.py"), 2, it) for it in rest)


def test_values_that_differ_from_file_to_file_are_said(tmp_path: Path) -> None:
    one, two = (f"{NODE}parameters=[{{'frequency': {it}}}])" for it in (30.0, 20.0))
    found = launched(tmp_path, a=one, b=two)
    assert found.values == {}
    assert [it for _, _, it in found.rest] == ["ekf_node: frequency"] * 2


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
    assert {"own/config/ekf.yaml", "own/config/slam.yaml"} <= files_given(read)
