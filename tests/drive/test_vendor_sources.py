# SPDX-License-Identifier: Apache-2.0
"""What the vendor's own nodes open is asked for: commands that nobody reads, odometry and scans that
nobody sends are no fleet that drives."""

from __future__ import annotations

from pathlib import Path

import fleet
import pytest
import rcl_names
import verdict

from multibot_rewrite.cli import multibot

pytestmark = [pytest.mark.live, rcl_names.needed()]
HEAD = """import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from sensor_msgs.msg import LaserScan
class Own(Node):
    def __init__(self):
        super().__init__('own')
"""
DRIVER = """        self.declare_parameter('topic', 'cmd_vel')
        topic = self.get_parameter('topic').value
        self.create_subscription(Twist, topic, self.move, 10)
        self.odom = self.create_publisher(Odometry, 'odom', 10)
"""
LIDAR = "        self.scan = self.create_publisher(LaserScan, 'scan', 10)\n"
BRAIN = """        self.create_subscription(LaserScan, 'scan', self.see, 10)
        self.create_subscription(Odometry, 'odom', self.see, 10)
        self.out = self.create_publisher(Twist, 'cmd_vel', 10)
"""
TAIL = """    def move(self, it):
        pass
    see = move
def main():
    rclpy.init()
    rclpy.spin(Own())
if __name__ == '__main__':
    main()
"""
LAUNCH = """from launch import LaunchDescription
from launch_ros.actions import Node
def generate_launch_description():
    return LaunchDescription([
        Node(package='acme', executable='driver.py', name='driver', parameters=[GIVEN]),
        Node(package='acme', executable='lidar.py', name='lidar'),
        Node(package='acme', executable='brain.py', name='brain')])
"""
URDF = '<robot name="r"><link name="base_link"/></robot>'
FLEET = """layout: both
distro: jazzy
simulator: none
launch: acme/up.launch.py
robots: [{name: robot1, description: acme/r.urdf}, {name: robot2, description: acme/r.urdf}]
"""


@pytest.mark.parametrize(
    ("given", "driver", "lidar", "wrong"),
    [
        ("{}", DRIVER, LIDAR, ""),
        ("{'topic': 'motors'}", DRIVER, LIDAR, "/robot1/cmd_vel: that moves nothing"),
        ("{}", "", LIDAR, "/robot1/cmd_vel, which nothing reads that drives"),
        ("{}", DRIVER, "", "/robot1/brain reads /robot1/scan, which no node sends"),
        ("{}", DRIVER.replace("'odom'", "'o'"), LIDAR, "brain reads /robot1/odom, which no node"),
        # A rule leads what is absolute to the robot.
        ("{}", DRIVER.replace("'odom'", "'/odom'"), LIDAR, ""),
    ],
)
def test_a_fleet_drives_by_what_its_vendors_nodes_open(
    given: str, driver: str, lidar: str, wrong: str, tmp_path: Path
) -> None:
    package = tmp_path / "acme"
    package.mkdir()
    rest = "        self.create_publisher(LaserScan, 'other', 10)\n"
    for name, text in {"driver": driver, "lidar": lidar, "brain": BRAIN}.items():
        (package / f"{name}.py").write_text(HEAD + (text or rest) + TAIL)
    (package / "package.xml").write_text("<package><name>acme</name></package>")
    (package / "up.launch.py").write_text(LAUNCH.replace("GIVEN", given))
    (package / "r.urdf").write_text(URDF)
    (tmp_path / "fleet.yaml").write_text(FLEET)
    out = tmp_path / "out"
    assert multibot.main(["build", str(tmp_path / "fleet.yaml"), "-o", str(out), "-q"]) in (0, 1)
    found = fleet.read(out, "jazzy", (tmp_path,))
    assert found.whole
    said = [it.why for it in verdict.judged(found)]
    assert [it for it in said if wrong in it] if wrong else said == [], said
    assert ("drives", "no") not in verdict.done(found)["robot1"].items() or "cmd_vel" in wrong
    # Without the sources nobody knows.
    assert fleet.read(out, "jazzy").unknown
