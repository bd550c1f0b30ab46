# SPDX-License-Identifier: Apache-2.0
"""A description that carries a robot's namespace or tag already is refused for the fleet."""

from __future__ import annotations

from pathlib import Path

import pytest
from fleet_folder import fleet_folder, planned_fleet

from multibot_rewrite.base.findings.finding import RewriteRefused
from multibot_rewrite.fleet.fleet_plan import FleetPlan

FLEET = "layout: both\naffix: prefix\ndescription: rover.urdf\nrobots: [{}]\n"
ROBOT = '<robot name="rover"><link name="{}"/><link name="b"/><link name="c"/>{}</robot>\n'
DRIVE = '<gazebo><plugin name="p" filename="libgazebo_ros_diff_drive.so">{}</plugin></gazebo>'
NAMESPACE = DRIVE.format("<ros><namespace>{}</namespace></ros>")


def planned(folder: Path, robot: str, link: str, namespace: str) -> FleetPlan:
    """Return the plan of a fleet of one robot, whose description has a link and a namespace."""
    text = ROBOT.format(link, NAMESPACE.format(namespace))
    return planned_fleet(fleet_folder(folder, FLEET.format(robot), rover__urdf=text))


BOTH = "{name: r7, namespace: site7, prefix: s1}"


@pytest.mark.parametrize(
    ("robot", "link", "namespace", "of"),
    [
        pytest.param("{name: r7}", "r7_a", "/x", "r7", id="link"),
        pytest.param("{name: r7}", "a", "/r7", "r7", id="namespace"),
        pytest.param(BOTH, "s1/a", "/x", "s1", id="tag"),
        pytest.param(BOTH, "a", "/site7", "site7", id="namespace-beside-a-tag"),
    ],
)
def test_refused(tmp_path: Path, robot: str, link: str, namespace: str, of: str) -> None:
    with pytest.raises(RewriteRefused, match=f"MB106 .*already rewritten for {of}: "):
        planned(tmp_path, robot, link, namespace)
