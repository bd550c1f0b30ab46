# SPDX-License-Identifier: Apache-2.0
"""Rules MB3 about names: what is refused by whom, and what real robots are called."""

from __future__ import annotations

import pytest
from lint_calls import Settings, fix, lint_data

MB3 = ("MB3",)


def codes(body: str, name: str = "r") -> list[str]:
    text = f'<robot name="{name}">{body}</robot>'
    return [it.code for it in lint_data("r.urdf", text.encode(), Settings(MB3))]


def linked(parent: str, child: str, joint: str, type_: str = "continuous", more: str = "") -> str:
    return (
        f'<link name="{parent}"/><link name="{child}"/><joint name="{joint}" type="{type_}">'
        f'<parent link="{parent}"/><child link="{child}"/></joint>{more}'
    )


def control(part: str) -> str:
    return f'<ros2_control name="c" type="system"><hardware/>{part}</ros2_control>'


def plugin(inside: str, library: str = "libgazebo_ros_imu_sensor.so") -> str:
    return f'<gazebo><plugin name="p" filename="{library}">{inside}</plugin></gazebo>'


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("my_robot", []),
        ("PR2", []),
        ("", ["MB311"]),
        ("my-robot", ["MB311"]),
        ("2dof", ["MB311"]),
        ("two words", ["MB311"]),
        ("a/b", ["MB311"]),
        ("a::b", ["MB305"]),
        ("world", ["MB306"]),
        ("$(arg name)", []),
    ],
)
def test_names_of_robots(name: str, expected: list[str]) -> None:
    assert codes("", name=name) == expected


INERTIAL = '<inertial><mass value="1"/></inertial>'
LASER = "libgazebo_ros_laser.so"


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        # Links and joints.
        (linked("a", "b", "j"), []),
        # What tf and controllers take: namespaces, hyphens, dots, capitals, digits in front.
        (linked("robot1/base-link", "4_wheel.1", "Bottom-V2.j"), []),
        (linked("", "b", "j"), ["MB302"]),
        (linked("a", " ", ""), ["MB302", "MB302"]),
        (linked("a b", " b", "cover to body"), ["MB303"] * 3),
        # A name that is missing is reported by another rule.
        ("<link/>", []),
        ('<link name="${prefix} a"/><link name="$(arg x)::b"/>', []),
        (linked("a::x", "b", "j"), ["MB305"]),
        (linked("a", "b:c", "j::k"), ["MB305"]),
        (linked("__a__", "__model__", "__j__"), ["MB306"] * 3),
        (linked("____", "___", "__"), ["MB306"]),
        (linked("__a", "b__", "_j_"), []),
        (linked("a", "b", "world"), ["MB306"]),
        (linked("fühler", "b", "j"), ["MB310"]),
        # No ASCII hides a second thing: the rules look at different ones.
        (linked("arm", "Arm", "ARM"), ["MB309"]),
        (linked("a", "b", "j", more='<link name="A"/>'), ["MB309"]),
        # The world.
        (linked("world", "a", "j", "fixed"), []),
        (linked("world", "a", "j", "floating"), []),
        ('<link name="world"/>', []),
        (
            linked("world", "a", "j").replace('"world"/>', f'"world">{INERTIAL}</link>', 1),
            ["MB307"],
        ),
        (linked("a", "world", "j", "fixed"), ["MB307"]),
        (linked("a", "world", "j"), ["MB307"]),
        (
            linked("a", "world", "j").replace('"world"/>', f'"world">{INERTIAL}</link>', 1),
            ["MB307"],
        ),
        ('<link name="World"><visual/></link>', []),
        ('<link name="world"><!-- the floor --></link>', []),
        # A link and a joint of one name.
        (linked("a", "b", "b"), ["MB308"]),
        (linked("a", "b", "a", "prismatic"), ["MB308"]),
        # Gazebo merges fixed links: neither name is left.
        (linked("a", "b", "b", "fixed"), []),
        (
            linked("a", "b", "x", "fixed", '<link name="c"/><joint name="b" type="revolute"/>'),
            [],
        ),
        # Links on the world stay.
        (
            linked("world", "b", "x", "fixed", '<link name="c"/><joint name="b" type="revolute"/>'),
            ["MB308"],
        ),
        (linked("a", "b", ""), ["MB302"]),
        # In ros2_control.
        (control('<joint name="a/j"/>'), ["MB304"]),
        (control('<sensor name="robot1/imu"/><gpio name="x/y"/>'), ["MB304", "MB304"]),
        # Elsewhere a slash in a joint's name is nothing special.
        (linked("a", "b", "a/j"), []),
        (control('<joint name="j"><state_interface name=" "/></joint>'), ["MB313"]),
        (control('<joint name="j"><command_interface name="my position"/></joint>'), ["MB313"]),
        (control('<joint name="j"><state_interface name="position velocity"/></joint>'), ["MB313"]),
        (control('<gpio name="io 1"/>'), ["MB313"]),
        # What Dynamixels call their registers.
        (control('<gpio name="dxl"><state_interface name="Present Position"/></gpio>'), []),
        (control('<gpio name="dxl"><command_interface name="Goal Current"/></gpio>'), []),
        (control('<gpio name=""/>'), ["MB313"]),
        # The parser strips what is around a name.
        (control('<joint name="j"><state_interface name=" position "/></joint>'), []),
        (control("<joint><state_interface/></joint>"), []),
        # hardware_component_interface.cpp makes a node of this name, and '/' becomes '_'.
        ('<ros2_control name="Arm-1"><hardware/></ros2_control>', ["MB312"]),
        ('<ros2_control name="Arm/1 "><hardware/></ros2_control>', []),
        (
            '<ros2_control name="a-1"><hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin>'
            "</hardware></ros2_control>",
            [],
        ),
        # Topics and namespaces.
        (plugin("<ros><namespace>my-robot</namespace></ros>"), ["MB312"]),
        (plugin("<ros><namespace>/</namespace></ros>"), []),
        (plugin("<ros><namespace></namespace></ros>"), []),
        (plugin("<ros><namespace>/robot1/</namespace></ros>"), []),
        (plugin("<ros><namespace>1st</namespace></ros>"), ["MB312"]),
        (plugin("<ros><namespace>${ns}</namespace></ros>"), []),
        (plugin("<ros><remapping>~/out:=imu data</remapping></ros>"), ["MB312"]),
        (plugin("<ros><remapping>~/out:=imu/data</remapping></ros>"), []),
        (plugin("<ros><remapping>a-b:=c</remapping></ros>"), ["MB312"]),
        (plugin("<ros><remapping>no rule</remapping></ros>"), []),
        (plugin("<ros><argument>--ros-args</argument></ros>"), []),
        (plugin("<ros><argument>__ns:=/a-b</argument></ros>"), []),
        (plugin("<topicName>front-scan</topicName>", LASER), ["MB312"]),
        # Digits after a slash: ROS 1 and Gazebo take them.
        (plugin("<topicName>scan/0</topicName>", LASER), []),
        (plugin("<topicName>scan</topicName>", LASER), []),
        # gz-transport has rules of its own.
        (
            '<gazebo reference="a"><sensor name="s" type="imu"><topic>a-b</topic></sensor></gazebo>',
            [],
        ),
    ],
)
def test_names_of_parts_and_topics(body: str, expected: list[str]) -> None:
    assert codes(body) == expected


@pytest.mark.parametrize(
    ("body", "fixed"),
    [
        # The frame without its slash is a link: the slash goes.
        ('<link name="a"/>' + plugin("<frame_name>/a</frame_name>"), True),
        ('<link name="a"/>' + plugin("<frame_name>\n /a\n</frame_name>"), True),
        # Not a link: a person must check.
        ('<link name="a"/>' + plugin("<frame_name>/b</frame_name>"), False),
        ('<link name="/a"/>', False),
    ],
)
def test_a_slash_in_front_goes_where_that_is_safe(body: str, fixed: bool) -> None:
    text = f'<robot name="r">{body}</robot>'
    settings = Settings(("MB301",))
    assert [it.code for it in lint_data("r.urdf", text.encode(), settings)] == ["MB301"]
    source, left = fix("r.urdf", text.encode(), settings)
    assert source.decode() == (text.replace("/a", "a", 1) if fixed else text)
    assert bool(left) is not fixed


def test_an_interface_without_a_name_is_to_get_one() -> None:
    body = control('<gpio name=""/>')
    found = lint_data("r.urdf", f"<robot>{body}</robot>".encode(), Settings(MB3))
    assert [it.hint for it in found if it.code == "MB313"] == ["give it a name"]


def test_a_lone_slash_is_no_frame() -> None:
    assert codes(plugin("<frame_name>/</frame_name>")) == []


@pytest.mark.slow
def test_many_names_take_linear_time() -> None:
    body = "".join(f'<link name="L{i}"/><link name="l{i}"/>' for i in range(5000))
    assert len(codes(body)) == 5000
