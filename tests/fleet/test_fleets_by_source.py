# SPDX-License-Identifier: Apache-2.0
"""A fleet of nodes that nobody has described: their source, beside the launch file, is read."""

from __future__ import annotations

from pathlib import Path

import pytest
from paths import fixture_text, write_files

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.system.json import from_yaml

NODE = fixture_text("fleets_by_source_node.txt")
SETUP = """
from setuptools import setup
setup(name="acme", entry_points={"console_scripts": ["driver = acme.driver:main"]})
"""
LAUNCH = """
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([NODES])
"""
ONE = "Node(package='acme', executable='driver', parameters=[{}])"
ROBOT = """<robot name="bare"><link name="base_link"/><link name="laser"/>
<joint name="l" type="fixed"><parent link="base_link"/><child link="laser"/></joint></robot>"""
FLEET = """
robots:
  - {name: robot1, description: bare.urdf, simulator: none}
  - {name: robot2, description: bare.urdf, simulator: none}
launch: acme/launch/acme.launch.py
"""


TWO = "\n".join(
    ONE.format("").replace("driver'", f"driver', namespace='{it}'") + "," for it in "ab"
)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    files = {
        "acme/package.xml": "<package><name>acme</name></package>",
        "acme/setup.py": SETUP,
        "acme/acme/__init__.py": "",
        "acme/acme/driver.py": NODE,
        "acme/launch/acme.launch.py": LAUNCH.replace("NODES", ONE.format("")),
        "bare.urdf": ROBOT,
        "fleet.yaml": FLEET,
    }
    write_files(tmp_path, files)
    return tmp_path


def test_an_absolute_name_is_that_of_both_robots(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = folder / "acme/launch/acme.launch.py"
    file.write_text(LAUNCH.replace("NODES", TWO))
    assert main(["check-launch", str(file)]) == 1
    said = capsys.readouterr()
    assert "MG310" in said.out and "/cmd_vel: /a/acme_driver, /b/acme_driver" in said.out
    # A relative name is each robot's own.
    assert "MG320" not in said.out
    # Two trees with one base on one topic.
    assert "MG402" in said.out
    assert "2 nodes known in part, by their source" in said.err
    assert (
        "driver.py:19: publishes sensor_msgs/msg/LaserScan under a name made at run time"
        in said.err
    )
    assert "all known (2 in part)" in said.err


def test_a_file_of_nodes_is_above_the_source(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file, nodes = folder / "acme/launch/acme.launch.py", folder / "nodes.yaml"
    file.write_text(LAUNCH.replace("NODES", TWO))
    entry = "{package: acme, programs: [driver], subscribes: {cmd_vel: geometry_msgs/msg/Twist}}"
    nodes.write_text(f"nodes:\n  acme_driver: {entry}\n")
    main(["check-launch", str(file), "--nodes", str(nodes)])
    said = capsys.readouterr()
    assert "MG310" not in said.out
    assert "in part" not in said.err


def test_each_robot_gets_its_rules(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["build", str(folder / "fleet.yaml"), "-o", str(folder / "built")]) == 0
    said = capsys.readouterr()
    assert "MF822" not in said.out + said.err
    launch = (folder / "built/fleet.launch.py").read_text()
    for rule in ("('/cmd_vel', f'/cmd_vel/{name}')", "('left/odom', f'left/odom/{name}')"):
        assert rule in launch
    assert "('/tf', f'/tf/{name}')" in launch


def test_a_frame_of_the_code_is_the_same_for_every_robot(folder: Path) -> None:
    assert main(["build", str(folder / "fleet.yaml"), "-o", str(folder / "built")]) == 0
    plan = (folder / "built/plan.yaml").read_text()
    for robot in ("robot1", "robot2"):
        sent = f"{{child: base_link, parent: odom, publishers: [/acme_driver_{robot}]}}"
        assert sent in plan
    assert "under a name made at run time" in plan


DEAF = """
import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node


class Pilot(Node):
    def __init__(self):
        super().__init__("pilot")
        self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(Odometry, "odom", print, 10)


def main():
    rclpy.init()
    rclpy.spin(Pilot())
"""


def gaps(folder: Path, node: str) -> dict[str, str]:
    """Return the level and words of each code that the plan of a built fleet has as a gap."""
    (folder / "acme/acme/driver.py").write_text(node)
    assert main(["build", str(folder / "fleet.yaml"), "-o", str(folder / "built")]) == 0
    plan = from_yaml((folder / "built/plan.yaml").read_bytes(), "plan.yaml")
    return {it.code: f"{it.level} {it.message}" for it in plan.gaps}


def test_a_fleet_that_nothing_moves_is_not_as_planned(folder: Path) -> None:
    found = gaps(folder, DEAF)
    what = "nothing reads cmd_vel of acme_driver and nothing sends odom of acme_driver"
    who = "robot 'robot1': all that it runs is known, and"
    assert found["MF865"] == f"warning {who} {what}".replace("acme_driver", "pilot_robot1")


def test_two_programs_that_call_their_nodes_alike_are_both_known(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """rclcpp and rclpy start both; the plan tells them apart by a number, and reads back both."""
    other = NODE.replace('"left"', '"right"').replace('"base_link"', '"tool"')
    (folder / "acme/acme/other.py").write_text(other)
    setup = SETUP.replace('main"]', 'main", "other = acme.other:main"]')
    (folder / "acme/setup.py").write_text(setup)
    two = f"{ONE.format('')}, {ONE.format('').replace('driver', 'other')}"
    (folder / "acme/launch/acme.launch.py").write_text(LAUNCH.replace("NODES", two))
    fleet = folder / "fleet.yaml"
    fleet.write_text(f"layout: tf-per-robot\n{FLEET}")
    assert main(["build", str(fleet), "-o", str(folder / "built")]) == 0
    assert "MG101" not in capsys.readouterr().err
    plan = from_yaml((folder / "built/plan.yaml").read_bytes(), "plan.yaml")
    own = {it.name: it.known for it in plan.nodes if "acme" in it.name}
    assert own["/robot1/acme_driver"] == "acme driver"
    assert own["/robot1/acme_driver_2"] == "acme other"
