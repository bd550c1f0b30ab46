# SPDX-License-Identifier: Apache-2.0
"""One ROS loads all plugins of a description: the release that is named, what only one of them has and
its package decide it; a plugin with parameters of ROS 1 in a robot of ROS 2 gets a namespace."""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite import rewrite, rewrite_all, strip

PLUGIN = """\
<gazebo reference="base">
  <sensor name="imu" type="imu">
    <plugin filename="libgazebo_ros_imu_sensor.so" name="imu_plugin">
      <topicName>imu</topicName><bodyName>base</bodyName>
    </plugin>
  </sensor>
</gazebo>
"""


OF_ROS_1 = """\
<gazebo><plugin filename="libgazebo_ros_control.so" name="control"/></gazebo>
"""


def imu_plugins(more: str, file: str = "", **given: str) -> list[bool]:
    """Rewrite a robot with the IMU of ROS 1's words; does each robot's have a namespace of ROS 2?"""
    text = f'<robot name="rover"><link name="base"/>\n{more}{PLUGIN}</robot>'
    if file:
        with open(file, "w", encoding="utf-8") as out:
            out.write(text)
    made = rewrite_all(file or text, ["robot1", "robot2"], layout="frames-per-robot", **given)
    plugins = (
        (it.robot, it.text.partition("imu_plugin")[2].partition("</plugin>")[0]) for it in made
    )
    return [f"<namespace>/{robot}</namespace>" in plugin for robot, plugin in plugins]


@pytest.mark.parametrize("more", ["", OF_ROS_1])
def test_a_named_release_is_one_of_ros_2(more: str) -> None:
    assert imu_plugins(more, distro="humble") == [True, True]


@pytest.mark.parametrize(
    ("package", "is_ros_2"),
    [
        ("<export><build_type>ament_cmake</build_type></export>", True),
        ("<buildtool_depend>ament_cmake</buildtool_depend>", True),
        ("<buildtool_depend>catkin</buildtool_depend>", False),
        ("<description>catkin and ament_cmake</description>", False),
    ],
)
@pytest.mark.parametrize("file", ["a.urdf", "a.xacro"])
def test_the_package_decides_where_the_description_does_not(
    tmp_path: Path, package: str, is_ros_2: bool, file: str
) -> None:
    (tmp_path / "package.xml").write_text(f"<package>{package}</package>")
    folder = tmp_path / "urdf"
    folder.mkdir()
    assert imu_plugins("", str(folder / file)) == [is_ros_2, is_ros_2]


MOVE = """\
<gazebo><plugin filename="libgazebo_ros_planar_move.so" name="move">
  <commandTopic>cmd_vel</commandTopic>
</plugin></gazebo>
"""
BARE = PLUGIN.replace("<topicName>imu</topicName><bodyName>base</bodyName>", "")


def test_an_inserted_block_is_no_evidence_of_ros_2() -> None:
    """What a rewrite put in does not change how the text is read when it is undone."""
    text = f'<robot name="rover"><link name="base"/>\n{MOVE}{BARE}</robot>'
    one = rewrite(text, "robot1", layout="both")
    assert "<ros>" in one.text
    assert "<robotNamespace>/robot1" in one.text
    assert strip(one.text, "robot1", layout="both").decode() == text


def test_it_is_undone_where_its_package_is_not(tmp_path: Path) -> None:
    """The package says that it is of ROS 2; the text alone is one of ROS 1."""
    (tmp_path / "package.xml").write_text(
        "<package><buildtool_depend>ament_cmake</buildtool_depend></package>"
    )
    file = tmp_path / "a.urdf"
    file.write_text(f'<robot name="rover"><link name="base"/>\n{OF_ROS_1}{PLUGIN}</robot>')
    made = rewrite(file, "robot1", layout="both").data
    assert b"<ros>" in made and b"<ros>" not in rewrite(file.read_text(), "robot1").data
    assert strip(made, "robot1", layout="both") == file.read_bytes()
