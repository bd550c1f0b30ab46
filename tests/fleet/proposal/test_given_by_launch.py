"""What launch files themselves give to nodes that a fleet starts: init says what it does not carry."""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite.fleet.proposal.given_by_launch import given_by_launch

RULE = "remappings=[('odometry/filtered', '/odom'), ('/tf', 'tf')]"
EKF = "Node(package='robot_localization', executable='ekf_node', name='ekf_filter_node', "
ROWS = [
    (f"{EKF}{RULE})", ["ekf_filter_node: odometry/filtered:=/odom"]),
    (
        f"{EKF}parameters=[path, {{'frequency': 30.0, 'use_sim_time': True}}])",
        ["ekf_filter_node: frequency"],
    ),
    (f"launch_ros.actions.{EKF}{RULE})", ["ekf_filter_node: odometry/filtered:=/odom"]),
    (f"{EKF}parameters=[path])", []), (f"{EKF}parameters=[{{'use_sim_time': sim}}])", []),
    (f"Node(package='own', executable='driver', {RULE})", []), (f"{EKF}", []),
]  # fmt: skip


@pytest.mark.parametrize(("text", "wanted"), ROWS)
def test_only_what_a_launch_file_has_beyond_files_of_parameters_is_said(
    text: str, wanted: list[str], tmp_path: Path
) -> None:
    path = tmp_path / "a.launch.py"
    path.write_text(f"\n{text}\n")
    found = list(given_by_launch([str(path), "b.launch.xml"], ["robot_localization"], "jazzy"))
    assert found == [(str(path), 2, it) for it in wanted]
