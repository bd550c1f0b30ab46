# SPDX-License-Identifier: Apache-2.0
"""What a description is: its simulator, whether it is controlled, and how much is in it; by hand."""

from __future__ import annotations

from pathlib import Path

import pytest
from lxml import etree

from multibot_rewrite.description.sources.access import Reach
from multibot_rewrite.producers.launch.records import (
    FileRead,
    LaunchArgument,
    LaunchGraph,
    LaunchOrder,
)
from multibot_rewrite.proposal import looking
from multibot_rewrite.proposal.launches import Reading
from multibot_rewrite.proposal.looking import Looked, NeededValues

CONTROL = '<ros2_control name="c" type="system"/>'
LINKS = '<link name="a"/><link name="b"/><link/>'


def plugin(file: str, inside: str = "") -> str:
    return f'<gazebo><plugin filename="{file}" name="p">{inside}</plugin></gazebo>'


@pytest.mark.parametrize(
    ("inside", "simulator", "control", "own_tf"),
    [
        ("", "none", False, False),
        (CONTROL, "none", True, False),
        (plugin("gz-sim-x-system"), "gz", False, False),
        (plugin("gz-sim-x-system") + CONTROL, "gz", False, False),
        (plugin("gz_ros2_control-system") + CONTROL, "gz", True, False),
        (plugin("libgazebo_ros2_control.so") + CONTROL, "classic", True, False),
        (plugin("libgazebo_ros2_control.so"), "classic", False, False),
        (plugin("libgazebo_ros_ray_sensor.so"), "classic", False, False),
        (plugin("gz-sim-x-system") + plugin("libgazebo_ros_imu_sensor.so"), "classic", False, False),
        ('<gazebo><sensor name="s" type="imu"/></gazebo>', "gz", False, False),
        ('<plugin filename="gz-sim-x" name="p"/>', "none", False, False),
        (plugin("x", "<ros><remapping>/tf:=tf</remapping></ros>"), "gz", False, True),
        (plugin("x", "<ros><argument> /tf:=tf </argument></ros>"), "gz", False, True),
        (plugin("x", "<ros><remapping>/odom:=odom</remapping><remapping/></ros>"), "gz", False, False),
    ],
)  # fmt: skip
def test_what_is_in_a_urdf(inside: str, simulator: str, control: bool, own_tf: bool) -> None:
    text = f'<robot name="r">{LINKS}{inside}</robot>'
    found = looking._description_in("p/r.urdf", text.encode(), (("x", "1"),))
    assert found._replace(root=None) == Looked(
        "p/r.urdf", "r", "robot", 2, simulator, control, (("x", "1"),), own_tf=own_tf
    )


@pytest.mark.parametrize(
    ("inside", "nothing"),
    [
        (plugin("libgazebo_ros2_control.so", "<parameters/>"), True),
        (plugin("libgazebo_ros2_control.so", "<parameters> </parameters>"), True),
        (plugin("libgazebo_ros2_control.so", "<parameters/><parameters>a</parameters>"), False),
        (plugin("libgazebo_ros2_control.so"), False),
        (plugin("gz-sim-x", "<parameters/>"), False),
        ("", False),
    ],
)
def test_a_manager_without_a_file(inside: str, nothing: bool) -> None:
    root = etree.fromstring(f'<robot name="r">{inside}</robot>')
    assert looking._loads_nothing(root) is nothing
    assert looking._loads_nothing(None) is False


def test_arguments_that_name_robots_are_empty_but_for_needed_and_given_ones() -> None:
    arguments = (("a", "{robot}_"), ("b", "{robot}"), ("c", "{robot}/"), ("d", "true"))
    looked = Looked("r.xacro", arguments=arguments, needed=("b",))
    found = looking.without_names(looked, {"c": "x"})
    assert found == looked._replace(arguments=(("a", ""), *arguments[1:]))


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("prefix", "{robot}_"), ("tf_prefix", "{robot}_"), ("name", "{robot}"),
        ("robot_name", "{robot}"), ("namespace", "{robot}"), ("ns", "{robot}"),
        ("model", "ur5"), ("size", "small"), ("both", "b"), ("mode", "sim"), ("nobody", ""),
        ("mod", ""),
    ],
)  # fmt: skip
def test_a_needed_argument_has_the_value_of_launch_files(
    name: str, value: str, tmp_path: Path
) -> None:
    declared = (
        LaunchArgument("model", "ur5", ()),
        LaunchArgument("size", "", ("small", "large")),
        LaunchArgument("both", "b", ("a", "b")),
    )
    given = FileRead("r.xacro", (("mode", "sim"), ("model", "")))
    graphs = LaunchGraph(declared=declared), LaunchGraph(read=(given,))
    (tmp_path / "r.xacro").write_text(f'<xacro:arg name="both"/><xacro:arg name="{name}"/>')
    values = NeededValues([Reading(LaunchOrder("up.launch.py"), it) for it in graphs])
    assert values.of(name) == value
    # The one that every launch has to choose.
    mandatory = {"size": "small"} if name == "size" else {}
    assert values.of_mandatory(str(tmp_path / "r.xacro")) == mandatory


CONTROLLED = """\
<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="bad" default=""/><xacro:arg name="idle" default=""/>
  <xacro:arg name="file" default=""/><xacro:arg default="" name="more"/>
  <xacro:if value="${'$(arg bad)' != ''}"><xacro:include filename="nowhere.xacro"/></xacro:if>
  <link name="base"/><ros2_control name="c" type="system"/>
  <gazebo><plugin filename="gz_ros2_control-system" name="p">
    <parameters>$(arg file)$(arg more)</parameters>
  </plugin></gazebo>
</robot>
"""


@pytest.mark.parametrize(("given", "named"), [("", "file"), ("a.yaml", "")])
def test_the_first_argument_that_gives_the_manager_its_file_is_taken(
    given: str, named: str, tmp_path: Path
) -> None:
    """Not one that ends the expansion, nor one that changes nothing."""
    path, control = tmp_path / "urdf" / "r.urdf.xacro", tmp_path / "control.yaml"
    path.parent.mkdir()
    path.write_text(CONTROLLED.replace("$(arg file)", f"{given}$(arg file)"))
    control.write_text("controller_manager:\n  ros__parameters: {}\n")
    (tmp_path / "other.yaml").write_text("a: 1\n")
    reach, nothing = Reach(trust=False), NeededValues([])
    seen = looking.look(str(path), {}, reach, nothing)
    files = [str(tmp_path / "other.yaml"), str(control)]
    found = looking.with_controllers(seen, files, reach)
    assert found.arguments == (((named, "../control.yaml"),) if named else ())
    assert found.root is not None
    assert [it.text for it in found.root.iter("parameters")] == [given or "../control.yaml"]
    assert looking.with_controllers(seen, files[:1], reach) == seen
