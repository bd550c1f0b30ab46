# SPDX-License-Identifier: Apache-2.0
"""A package for one robot takes a prefix: its sources afterwards, written by hand; what is left."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from multibot_rewrite import InputError, adopt
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.description.sources.expand import expand

SPACE = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
ARGUMENT = """
  <xacro:arg name="prefix" default=""/>
  <xacro:property name="prefix" value="$(arg prefix)"/>"""
# What stands in the robot -> what it becomes.
CASES = {
    "literals": (
        '<link name="base"/><link name="arm"/>\n'
        '<joint name="j" type="fixed"><parent link="base"/><child link="arm"/></joint>',
        '<link name="${prefix}base"/><link name="${prefix}arm"/>\n'
        '<joint name="${prefix}j" type="fixed"><parent link="${prefix}base"/>'
        '<child link="${prefix}arm"/></joint>',
    ),
    "a macro's names get it where they are used": (
        '<link name="base"/><xacro:macro name="wheel" params="side">'
        '<link name="${side}_wheel"/></xacro:macro><xacro:wheel side="left"/>',
        '<link name="${prefix}base"/><xacro:macro name="wheel" params="side">'
        '<link name="${prefix}${side}_wheel"/></xacro:macro><xacro:wheel side="left"/>',
    ),
    "where the world is a parent too, the name gets it in the call": (
        '<link name="world"/><link name="a"/><link name="b"/>'
        '<xacro:macro name="m" params="up down"><joint name="to_${down}" type="fixed">'
        '<parent link="${up}"/><child link="${down}"/></joint></xacro:macro>'
        '<xacro:m up="world" down="a"/><xacro:m up="a" down="b"/>',
        '<link name="world"/><link name="${prefix}a"/><link name="${prefix}b"/>'
        '<xacro:macro name="m" params="up down"><joint name="${prefix}to_${down}" type="fixed">'
        '<parent link="${up}"/><child link="${prefix}${down}"/></joint></xacro:macro>'
        '<xacro:m up="world" down="a"/><xacro:m up="${prefix}a" down="b"/>',
    ),
    "frames, sensors and texts of plugins": (
        '<link name="base"/><gazebo reference="base"><sensor name="lidar" type="gpu_lidar">'
        "<gz_frame_id> base </gz_frame_id></sensor></gazebo>",
        '<link name="${prefix}base"/><gazebo reference="${prefix}base">'
        '<sensor name="${prefix}lidar" type="gpu_lidar">'
        "<gz_frame_id> ${prefix}base </gz_frame_id></sensor></gazebo>",
    ),
    "the name that Gazebo makes of a collision": (
        '<link name="base"><collision><geometry><sphere radius="1"/></geometry></collision></link>'
        '<gazebo reference="base"><sensor name="bump" type="contact"><contact>'
        "<collision>base_collision</collision></contact></sensor></gazebo>",
        '<link name="${prefix}base"><collision><geometry><sphere radius="1"/></geometry></collision>'
        '</link><gazebo reference="${prefix}base"><sensor name="${prefix}bump" type="contact">'
        "<contact><collision>${prefix}base_collision</collision></contact></sensor></gazebo>",
    ),
    "behind what another property has": (
        '<xacro:property name="lead" value="/"/><link name="base"/><gazebo reference="base">'
        '<sensor name="lidar" type="gpu_lidar"><gz_frame_id>${lead}base</gz_frame_id></sensor>'
        "</gazebo>",
        '<xacro:property name="lead" value="/"/><link name="${prefix}base"/>'
        '<gazebo reference="${prefix}base"><sensor name="${prefix}lidar" type="gpu_lidar">'
        "<gz_frame_id>${lead}${prefix}base</gz_frame_id></sensor></gazebo>",
    ),
    "ros2_control and its joints": (
        '<link name="base"/><link name="a"/><joint name="j" type="revolute"><parent link="base"/>'
        '<child link="a"/><limit effort="1" velocity="1" lower="0" upper="1"/></joint>'
        '<ros2_control name="hw" type="system"><hardware><plugin>mock_components/GenericSystem'
        '</plugin></hardware><joint name="j"/></ros2_control>',
        '<link name="${prefix}base"/><link name="${prefix}a"/><joint name="${prefix}j" type="revolute">'
        '<parent link="${prefix}base"/><child link="${prefix}a"/>'
        '<limit effort="1" velocity="1" lower="0" upper="1"/></joint>'
        '<ros2_control name="${prefix}hw" type="system"><hardware><plugin>'
        'mock_components/GenericSystem</plugin></hardware><joint name="${prefix}j"/></ros2_control>',
    ),
}


def robot(inside: str, more: str = "") -> str:
    return f'<robot name="r" {SPACE}>{more}\n  {inside}\n</robot>\n'


@pytest.mark.parametrize("case", CASES)
def test_the_sources_take_the_prefix(case: str, tmp_path: Path) -> None:
    inside, wanted = CASES[case]
    path = tmp_path / "r.urdf.xacro"
    path.write_text(robot(inside))
    made = adopt(str(tmp_path))
    assert {name: data.decode() for name, data in made.after.items()} == {
        str(path): robot(wanted, ARGUMENT)
    }
    assert (made.argument, made.verified, made.left) == ("prefix", (str(path),), ())
    assert made.before == {str(path): path.read_bytes()}


@pytest.mark.more
def test_an_included_file_is_changed_once_for_all_that_include_it(tmp_path: Path) -> None:
    part = tmp_path / "part.xacro"
    part.write_text(
        f'<robot {SPACE}><xacro:macro name="p" params="n"><link name="${{n}}_p"/></xacro:macro></robot>'
    )
    for name in ("one", "two"):
        include = '<xacro:include filename="part.xacro"/><xacro:p n="x"/>'
        (tmp_path / f"{name}.urdf.xacro").write_text(robot(include))
    made = adopt(str(tmp_path))
    assert len(made.verified) == 2
    assert made.after[str(part)].count(b"${prefix}") == 1
    assert b'<link name="${prefix}${n}_p"/>' in made.after[str(part)]


# What stands in a plugin -> what it becomes, and what it is in robot1.
SPACES = {
    "a namespace that is there": (
        "<robotNamespace>/demo</robotNamespace>",
        "<robotNamespace>/${namespace and namespace + '/'}demo</robotNamespace>",
        "<robotNamespace>/robot1/demo</robotNamespace>",
    ),
    "the root": (
        "<robotNamespace>/</robotNamespace>",
        "<robotNamespace>/${namespace}</robotNamespace>",
        "<robotNamespace>/robot1</robotNamespace>",
    ),
    "none": (
        "<ros><argument>x</argument></ros>",
        "<ros><xacro:if value=\"${namespace != ''}\"><namespace>/${namespace}</namespace></xacro:if>"
        "<argument>x</argument></ros>",
        "<ros><namespace>/robot1</namespace><argument>x</argument></ros>",
    ),
    "a plugin without anything": ("", "", "<ros><namespace>/robot1</namespace></ros>"),
    "an empty one": (
        "<ros><namespace/></ros>",
        "<ros><namespace><xacro:if value=\"${namespace != ''}\">/${namespace}</xacro:if>"
        "</namespace></ros>",
        "<ros><namespace>/robot1</namespace></ros>",
    ),
}
ROS = "<ros><namespace>/${namespace}</namespace></ros>"
ADDED = f"<xacro:if value=\"${{namespace != ''}}\">{ROS}</xacro:if>"
DRIVES = {
    "": "libgazebo_ros_imu_sensor.so",
    "robotNamespace": "libgazebo_ros_control.so",
    "ros": "libgazebo_ros_joint_state_publisher.so",
}


@pytest.mark.parametrize("case", SPACES)
def test_plugins_take_a_namespace(case: str, tmp_path: Path) -> None:
    inside, wanted, shown = SPACES[case]
    path = tmp_path / "r.urdf.xacro"
    plugin = f'<plugin name="p" filename="{DRIVES[inside[1:].partition(">")[0]]}">{{}}</plugin>'
    block = f'<link name="base"/><gazebo>\n{plugin.format(inside)}\n</gazebo>'
    path.write_text(robot(block.replace("></plugin>", "/>") if not inside else block))
    before = expand(str(path), {})
    made = adopt(str(tmp_path))
    assert (made.namespace, made.spaced) == ("namespace", (str(path),))
    path.write_bytes(made.after[str(path)])
    assert plugin.format(wanted or ADDED) in path.read_text()
    assert expand(str(path), {}) == before
    text = "".join(
        line.strip() for line in expand(str(path), {"namespace": "robot1"}).decode().split("\n")
    )
    assert f">{shown}</plugin>" in text


@pytest.mark.parametrize(
    ("value", "said"),
    [
        ("<![CDATA[/demo]]>", "it gets no namespace: .*'/demo' cannot be edited in place"),
        ("/d&#101;mo", "'/demo' is put together"),
    ],
)
def test_a_namespace_that_cannot_be_edited_is_told(value: str, said: str, tmp_path: Path) -> None:
    plugin = '<plugin name="p" filename="libgazebo_ros_control.so"><robotNamespace>{}'
    inside = f"<gazebo>{plugin.format(value)}</robotNamespace></plugin></gazebo>"
    path = tmp_path / "r.urdf.xacro"
    path.write_text(robot(f'<link name="base"/>{inside}'))
    made = adopt(str(tmp_path))
    (left,) = made.left
    assert left.place.startswith(str(path)) and re.match(said, left.why)
    wanted = robot(f'<link name="${{prefix}}base"/>{inside}', ARGUMENT)
    assert (made.namespace, made.after[str(path)].decode()) == ("", wanted)


def test_one_with_a_namespace_of_its_own_keeps_it(tmp_path: Path) -> None:
    own = (
        '<xacro:arg name="robot_namespace" default=""/><link name="base"/><gazebo><plugin name="p" '
        'filename="libgazebo_ros_control.so"><robotNamespace>/$(arg robot_namespace)</robotNamespace>'
        "</plugin></gazebo>"
    )
    path = tmp_path / "r.urdf.xacro"
    path.write_text(robot(own))
    made = adopt(str(tmp_path))
    assert (made.argument, made.namespace) == ("prefix", "")
    why = "it has an argument for a namespace: robot_namespace"
    assert [tuple(it) for it in made.left] == [(str(path), why)]
    assert b"/$(arg robot_namespace)</robotNamespace>" in made.after[str(path)]


WHEEL = '<xacro:macro name="w" params="prefix"><link name="${prefix}_wheel"/></xacro:macro>'
# What takes a prefix already -> what it becomes, and the argument of that.
HANDED = {
    "a call": (
        f'{WHEEL}<xacro:w prefix="left"/>',
        f'{WHEEL}<xacro:w prefix="$(arg prefix)left"/>',
        "prefix",
    ),
    "a call that gives it another name": (
        WHEEL.replace("prefix", "arm_id") + '<xacro:w arm_id="left"/>',
        WHEEL.replace("prefix", "arm_id") + '<xacro:w arm_id="$(arg prefix)left"/>',
        "prefix",
    ),
    "a call without it": (
        WHEEL.replace('="prefix"', "=\"prefix:='a'\"") + "<xacro:w/>",
        WHEEL.replace('="prefix"', "=\"prefix:='a'\"") + '<xacro:w prefix="$(arg prefix)a"/>',
        "prefix",
    ),
    "a call through another one, and a name beside": (
        '<xacro:macro name="o" params="prefix"><xacro:w prefix="${prefix}"/><link name="hub"/>'
        f'</xacro:macro>{WHEEL}<xacro:o prefix=""/>',
        '<xacro:macro name="o" params="prefix"><xacro:w prefix="${prefix}"/>'
        f'<link name="${{prefix}}hub"/></xacro:macro>{WHEEL}<xacro:o prefix="$(arg prefix)"/>',
        "prefix",
    ),
    "a property": (
        '<xacro:property name="prefix" value=""/><link name="${prefix}a"/><link name="b"/>',
        '<xacro:property name="prefix" value="$(arg prefix)"/><link name="${prefix}a"/>'
        '<link name="${prefix}b"/>',
        "prefix",
    ),
}


def test_a_prefix_that_changes_more_than_names_is_handed_to_nobody(tmp_path: Path) -> None:
    inside = (
        '<xacro:property name="prefix" value=""/><link name="${prefix}a"/>'
        '<xacro:if value="${prefix == \'\'}"><link name="b"/></xacro:if>'
    )
    (tmp_path / "r.urdf.xacro").write_text(robot(inside))
    made = adopt(str(tmp_path))
    assert (made.argument, len(made.verified)) == ("prefix", 1)
    assert b'<link name="$(arg prefix)b"/>' in made.after[str(tmp_path / "r.urdf.xacro")]


@pytest.mark.parametrize("case", HANDED)
def test_what_takes_a_prefix_already_gets_the_argument(case: str, tmp_path: Path) -> None:
    inside, wanted, argument = HANDED[case]
    path = tmp_path / "r.urdf.xacro"
    path.write_text(robot(inside))
    made = adopt(str(tmp_path))
    declared = ARGUMENT.splitlines()[1]
    assert made.after[str(path)].decode() == robot(wanted, f"\n{declared}")
    assert (made.argument, made.verified, dict(made.bare)) == (argument, (str(path),), {})


def test_a_parameter_of_the_name_does_not_hide_the_argument(tmp_path: Path) -> None:
    """It is in the middle of a name, so nothing can be handed to it."""
    inside = (
        '<xacro:macro name="m" params="prefix"><link name="${prefix}_a"/><link name="b_${prefix}"/>'
        '</xacro:macro><xacro:m prefix="left"/>'
    )
    (tmp_path / "r.urdf.xacro").write_text(robot(inside))
    made = adopt(str(tmp_path))
    names = b'<link name="$(arg prefix)${prefix}_a"/><link name="$(arg prefix)b_${prefix}"/>'
    assert names in next(iter(made.after.values()))


def test_an_argument_that_another_description_hands_on_is_not_put_before_its_names_twice(
    tmp_path: Path,
) -> None:
    """Both use the macro, whose material has the parameter, too: so it is not handed to the call."""
    link = '<link name="${prefix}a"><visual><material name="${prefix}red"/></visual></link>'
    macro = f'<xacro:macro name="m" params="prefix">{link}</xacro:macro>'
    (tmp_path / "m.xacro").write_text(f"<robot {SPACE}>{macro}</robot>")
    include = '<xacro:include filename="m.xacro"/>'
    own = '<xacro:arg name="prefix" default=""/><xacro:m prefix="$(arg prefix)"/>'
    (tmp_path / "one.urdf.xacro").write_text(robot(include + own))
    (tmp_path / "two.urdf.xacro").write_text(robot(f'{include}<xacro:m prefix="l_"/>'))
    made = adopt(str(tmp_path))
    for path, data in made.after.items():
        Path(path).write_bytes(data)
    assert b'<link name="z_a">' in expand(str(tmp_path / "one.urdf.xacro"), {"prefix": "z_"})


# What an argument reaches in part -> what it becomes.
PARTIAL = {
    "its property": (
        '<xacro:property name="p" value="$(arg prefix)"/><link name="${p}a"/><link name="b"/>',
        '<xacro:property name="p" value="$(arg prefix)"/><link name="${p}a"/><link name="${p}b"/>',
    ),
    "alone, and a reference": (
        '<link name="$(arg prefix)a"/><gazebo reference="a"/>',
        '<link name="$(arg prefix)a"/><gazebo reference="$(arg prefix)a"/>',
    ),
    "nothing yet": ('<link name="a"/>', '<link name="$(arg prefix)a"/>'),
    "an attribute of another namespace": (
        '<link name="$(arg prefix)a"/><gazebo reference="$(arg prefix)a" xmlns:gz="http://gazebosim.org/schema"><collision>'
        '<surface><friction><ode><fdir1 gz:expressed_in="a">1 0 0</fdir1></ode></friction></surface>'
        "</collision></gazebo>",
        '<link name="$(arg prefix)a"/><gazebo reference="$(arg prefix)a" xmlns:gz="http://gazebosim.org/schema"><collision>'
        '<surface><friction><ode><fdir1 gz:expressed_in="$(arg prefix)a">1 0 0</fdir1></ode>'
        "</friction></surface></collision></gazebo>",
    ),
}


@pytest.mark.parametrize("case", PARTIAL)
def test_an_argument_of_its_own_reaches_all_names(case: str, tmp_path: Path) -> None:
    inside, wanted = PARTIAL[case]
    path = tmp_path / "r.urdf.xacro"
    own = '<xacro:arg name="prefix" default=""/>'
    path.write_text(robot(f"{own}{inside}"))
    made = adopt(str(tmp_path))
    assert {it: data.decode() for it, data in made.after.items()} == {
        str(path): robot(f"{own}{wanted}")
    }
    assert (dict(made.already), made.verified) == ({str(path): "prefix"}, (str(path),))


def test_a_file_of_macros_that_take_it_declares_no_argument(tmp_path: Path) -> None:
    names = '<link name="${prefix}a"/><gazebo reference="a"/>'
    macro = f'<robot {SPACE}><xacro:macro name="m" params="prefix">{names}</xacro:macro></robot>'
    (tmp_path / "m.xacro").write_text(macro)
    own = '<xacro:arg name="prefix" default=""/><xacro:m prefix="$(arg prefix)"/>'
    (tmp_path / "r.urdf.xacro").write_text(robot(f'<xacro:include filename="m.xacro"/>{own}'))
    ((path, data),) = adopt(str(tmp_path)).after.items()
    wanted = macro.replace('reference="a"', 'reference="${prefix}a"')
    assert (path, data.decode()) == (str(tmp_path / "m.xacro"), wanted)


# Two arguments that are not empty; together they are before all links but that of the world.
ARMS = (
    '<xacro:arg name="prefix_1" default="L_"/><xacro:arg name="prefix_2" default="R_"/>'
    '<xacro:macro name="m" params="prefix"><link name="${prefix}a"/></xacro:macro>'
    '<link name="ground"/><xacro:m prefix="$(arg prefix_1)"/><xacro:m prefix="$(arg prefix_2)"/>'
)


@pytest.mark.parametrize(("more", "stays"), [("", True), ('<link name="b"/>', False)])
def test_two_arms_with_an_argument_each_stay(more: str, stays: bool, tmp_path: Path) -> None:
    path = tmp_path / "r.urdf.xacro"
    path.write_text(robot(ARMS + more))
    made = adopt(str(tmp_path))
    assert (dict(made.already), bool(made.after)) == (
        {str(path): "prefix_1, prefix_2"} if stays else {},
        not stays,
    )


def test_a_robot_that_another_one_includes_takes_the_argument_too(tmp_path: Path) -> None:
    arm = tmp_path / "arm.urdf.xacro"
    joint = '<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>'
    arm.write_text(robot(f'<link name="a"/><link name="b"/>{joint}'))
    (tmp_path / "more.urdf.xacro").write_text(robot('<xacro:include filename="arm.urdf.xacro"/>'))
    made = adopt(str(tmp_path))
    assert made.verified == tuple(str(tmp_path / f"{it}.urdf.xacro") for it in ("more", "arm"))
    arm.write_bytes(made.after[str(arm)])
    assert b'<link name="left_b"/>' in expand(str(arm), {"prefix": "left_"})


def test_names_that_no_argument_reaches_are_an_error(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """An argument that is a part of a name is not put before others."""
    own = '<xacro:arg name="robot_name" default=""/>'
    names = "".join(f'<link name="$(arg robot_name)_{it}"/>' for it in "ab")
    path = tmp_path / "r.urdf.xacro"
    path.write_text(robot(f'{own}{names}<link name="c"/>'))
    assert dict(adopt(str(tmp_path)).bare) == {str(path): ("c",)}
    assert main(["adopt", str(tmp_path)]) == 1
    assert f"{path}: error: 'c' stay without the prefix" in capsys.readouterr().err


def test_a_plain_urdf_becomes_a_xacro_beside_it(tmp_path: Path) -> None:
    plain = tmp_path / "r.urdf"
    plain.write_text('<robot name="r"><!-- kept --><link name="base"/></robot>')
    made = adopt(str(tmp_path))
    ((path, data),) = made.after.items()
    assert path == f"{plain}.xacro"
    assert made.before == {path: b""}
    assert b'<!-- kept --><link name="${prefix}base"/>' in data
    Path(path).write_bytes(data)
    assert b'<link name="left_base"/>' in expand(path, {"prefix": "left_"})
    assert b'<link name="base"/>' in expand(path, {})


def test_a_urdf_beside_its_xacro_is_left(tmp_path: Path) -> None:
    (tmp_path / "r.urdf").write_text('<robot name="r"><link name="base"/></robot>')
    (tmp_path / "r.urdf.xacro").write_text(robot('<link name="base"/>'))
    made = adopt(str(tmp_path))
    assert made.verified == (str(tmp_path / "r.urdf.xacro"),)
    assert list(made.unread) == [str(tmp_path / "r.urdf")]


@pytest.mark.more
def test_a_link_of_another_description_has_the_prefix_too(tmp_path: Path) -> None:
    (tmp_path / "part.xacro").write_text(f'<robot {SPACE}><gazebo reference="top"/></robot>')
    include = '<xacro:include filename="part.xacro"/><link name="base"/>'
    (tmp_path / "small.urdf.xacro").write_text(robot(include))
    (tmp_path / "tall.urdf.xacro").write_text(robot(f'{include}<link name="top"/>'))
    made = adopt(str(tmp_path))
    assert b'<gazebo reference="${prefix}top"/>' in made.after[str(tmp_path / "part.xacro")]


def test_a_xacro_without_the_namespace_gets_it(tmp_path: Path) -> None:
    path = tmp_path / "r.urdf.xacro"
    path.write_text('<robot name="r"><link name="base"/></robot>')
    made = adopt(str(tmp_path))
    assert made.after[str(path)].startswith(f'<robot {SPACE} name="r">'.encode())


def test_a_name_between_others_is_left_with_its_place(tmp_path: Path) -> None:
    """The condition compares the name: with a prefix in it, another part of the robot is there."""
    inside = (
        '<link name="world"/><xacro:property name="names" value="${[\'world\', \'a\']}"/>'
        '<link name="a"/><xacro:macro name="m" params="n"><gazebo reference="${names[n]}">'
        '<material>Gazebo/Red</material></gazebo></xacro:macro><xacro:m n="0"/><xacro:m n="1"/>'
    )
    path = tmp_path / "r.urdf.xacro"
    path.write_text(robot(inside))
    made = adopt(str(tmp_path))
    assert [(it.place.partition(":")[2], it.why) for it in made.left] == [
        (f"2:{robot(inside).splitlines()[1].index('<gazebo') + 1}", "'a' is put together")
    ]
    assert made.verified == ()


def test_a_name_that_stays_with_another_argument_is_left(tmp_path: Path) -> None:
    """Robotiq's driver asks for its GPIO by that name; without it the GPIO is one of the robot."""
    inside = (
        '<link name="a"/><xacro:arg name="sim" default="true"/><ros2_control name="g" type="system">'
        '<hardware><xacro:if value="$(arg sim)"><plugin>mock_components/GenericSystem</plugin>'
        '</xacro:if><xacro:unless value="$(arg sim)">'
        "<plugin>robotiq_driver/RobotiqGripperHardwareInterface</plugin></xacro:unless></hardware>"
        '<gpio name="reactivate_gripper"><command_interface name="c"/></gpio></ros2_control>'
    )
    (tmp_path / "r.urdf.xacro").write_text(robot(inside))
    (it,) = adopt(str(tmp_path)).left
    assert it.why == "'reactivate_gripper' stays with other arguments or elsewhere"


def test_what_compares_a_name_is_refused(tmp_path: Path) -> None:
    inside = (
        '<link name="a"/><link name="world"/><xacro:macro name="m" params="n">'
        '<gazebo reference="${n}"/><xacro:if value="${n == \'a\'}"><link name="more"/></xacro:if>'
        '</xacro:macro><xacro:m n="a"/><xacro:m n="world"/>'
    )
    (tmp_path / "r.urdf.xacro").write_text(robot(inside))
    with pytest.raises(InputError, match="wherever the prefix is put, it changes"):
        adopt(str(tmp_path))


def test_a_folder_without_a_robot_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="there is no description"):
        adopt(str(tmp_path))


@pytest.mark.more
def test_the_command_prints_a_patch_or_changes_the_files(
    here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = here / "r.urdf.xacro"
    path.write_text(robot('<link name="base"/>'))
    assert main(["adopt", ".", "--color", "never"]) == 0
    shown = capsys.readouterr()
    assert "--- a/r.urdf.xacro\n+++ b/r.urdf.xacro\n" in shown.out
    assert '+  <link name="${prefix}base"/>\n' in shown.out
    assert shown.err == (
        "multibot: argument prefix: 1 description in 1 file; verified\n"
        "multibot: r.urdf.xacro: it takes the argument; verified\n"
    )
    assert path.read_text() == robot('<link name="base"/>')
    assert main(["adopt", ".", "--in-place"]) == 0
    assert path.read_text() == robot('<link name="${prefix}base"/>', ARGUMENT)
