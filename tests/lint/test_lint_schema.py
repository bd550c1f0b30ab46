# SPDX-License-Identifier: Apache-2.0
"""The structure of a URDF against its schema: what is a fault, and what is allowed in real files."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from counted_steps import growth

from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.rules.schema.faults import read_faults
from multibot_rewrite.rules.schema.sections import FINE, schema
from multibot_rewrite.rules.schema.versions import KNOWN

LINKS = '<link name="a"/><link name="b"/>'
ENDS = '<parent link="a"/><child link="b"/>'


def faults(body: str) -> tuple[Problem, ...]:
    text = body if body.startswith(("<robot", "<sdf")) else f'<robot name="r">{body}</robot>'
    return read_faults(read_document(text.encode(), "robot.urdf"))


def kinds(body: str) -> list[tuple[str, str, str | None]]:
    return sorted((it.code, str(it.element.tag), it.attribute) for it in faults(body))


def joint(inside: str, type_: str = "revolute") -> str:
    return f'{LINKS}<joint name="j" type="{type_}">{ENDS}{inside}</joint>'


def visual(inside: str) -> str:
    return f'<link name="a"><visual>{inside}</visual></link>'


def shape(text: str) -> str:
    return visual(f"<geometry>{text}</geometry>")


def control(inside: str) -> str:
    return (
        '<ros2_control name="c" type="system"><hardware><plugin>p/P</plugin></hardware>'
        f"{inside}</ros2_control>"
    )


NO_FAULT = {
    "empty": "",
    "blanks around numbers of a vector": shape('<box size="  1   2 3 "/>'),
    "a blank in front of a number": shape('<sphere radius=" 1"/>'),
    "forms of numbers": shape('<box size="1. .5 +1e-3"/>'),
    "too small for a double": visual('<origin xyz="1e-400 0 0"/>'),
    "many digits": shape(f'<sphere radius="0.{"1" * 300}"/>'),
    "capsule": '<robot name="r" version="1.1">'
    + shape('<capsule radius="1" length="1"/>')
    + "</robot>",
    "version 1.2": '<robot name="r" version="1.2"/>',
    "shapes of others": shape('<ellipsoid radii="1 1 1"/>'),
    "shape of a namespace": '<robot name="r" xmlns:drake="d">'
    + shape('<drake:ellipsoid a="1"/>')
    + "</robot>",
    "attribute of a namespace": '<robot name="r" xmlns:drake="d">'
    + joint('<limit effort="1" velocity="1" drake:acceleration="x"/>')
    + "</robot>",
    "the whole matrix": '<link name="a"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" '
    'iyx="0" iyy="1" iyz="0" izx="0" izy="0" izz="1"/></inertial></link>',
    "axis of a fixed joint": joint('<axis xyz="0 0"/>', "fixed"),
    "extension block": "<my_tool><joint foo='1'/></my_tool>",
    "extensions named like a core element": '<sensor_d415 parent="a"/><rear_wheel/><HDL-32E/>',
    "gazebo": '<gazebo reference="a"><visual><geometry/></visual><inertial/></gazebo>',
    "gazebo inside a link": '<link name="a"><gazebo><foo/></gazebo></link>',
    "hardwareInterface": joint("<hardwareInterface>x</hardwareInterface>"),
    "origin of the robot": '<origin xyz="0 0 1"/>',
    "contact of Bullet": '<link name="a"><contact><lateral_friction value="1"/></contact></link>',
    "collision with a material": '<link name="a"><collision><geometry><sphere radius="1"/>'
    '</geometry><material name="x"/><verbose value="x"/></collision></link>',
    "a transmission of PR2": '<transmission type="x" name="t"><compensator k_belt="1"/>'
    '<actuator name="m"/></transmission>',
    "text where it belongs": control('<joint name="j"><param name="p">text</param></joint>'),
    "comments and instructions": '<!-- a --><link name="a"><!-- b --><?c d?></link>',
    "an empty texture": '<material name="m"><color rgba="0 0 0 1"/><texture/></material>',
    "twice the same": joint('<origin xyz="0 0 1"/><origin xyz="0 0 1"/>'),
    "a label anywhere": visual('<geometry name="g"><sphere radius="1"/></geometry>'),
    "colours": '<material name="m"><color rgba="0 1 .5 1.0"/></material>',
    "version": '<robot name="r" version="1.0"/>',
    "macros only": "<robot><my_macro/></robot>",
    "sdf": '<sdf version="1.9"><model name="m"><link/></model></sdf>',
    "limits of ros2_control": control(
        '<gpio name="g"><command_interface name="x" size="2"/></gpio>'
    ),
}


@pytest.mark.parametrize("body", NO_FAULT.values(), ids=NO_FAULT)
def test_what_real_files_hold_is_no_fault(body: str) -> None:
    assert kinds(body) == []


FAULTS = (
    (joint("").replace('parent link="a"', 'parent link=""'), "missing", "parent", "link"),
    (joint('<mimic joint=""/>'), "missing", "mimic", "joint"),
    ('<link name="a"><inertail/></link>', "misspelt", "inertail", None),
    # What it is meant to be may be there as well.
    (
        '<link name="a"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" '
        'iyz="0" izz="1"/></inertial><inertail/></link>',
        "misspelt",
        "inertail",
        None,
    ),
    ("<jiont/>", "misspelt", "jiont", None),
    ("<gazbo/>", "misspelt", "gazbo", None),
    ('<link name="a"><Visual/></link>', "misspelt", "Visual", None),
    ('<link name="a"><pose>0</pose></link>', "not-read", "pose", None),
    ('<link name="a"><mass value="1"/></link>', "misplaced", "mass", None),
    ("<inertial/>", "misplaced", "inertial", None),
    (visual('<origin xzy="0 0 1"/>'), "misspelt", "origin", "xzy"),
    (visual('<origin XYZ="0 0 1"/>'), "misspelt", "origin", "XYZ"),
    (joint("").replace('type="', 'tpye="'), "missing", "joint", "tpye"),
    (
        joint('<limit velocity="1" effort="1" gear_velocity="1"/>'),
        "not-read",
        "limit",
        "gear_velocity",
    ),
    (shape('<sphere radios="1"/>'), "missing", "sphere", "radios"),
    (shape("<box/>"), "missing", "box", None),
    (f"<robot>{LINKS}</robot>", "missing", "robot", None),
    ("<link/>", "missing", "link", None),
    (control('<joint name="j"><param>1</param></joint>'), "missing", "param", None),
    ('<ros2_control name="c" type="system"/>', "missing", "ros2_control", None),
    (
        '<ros2_control name="c" type="system"><hardwre/></ros2_control>',
        "missing",
        "hardwre",
        None,
    ),
    (control("<param name='x'>1</param>"), "not-read", "param", None),
    (control("<jiont name='x'/>"), "not-read", "jiont", None),
    (joint('<origin xyz="0 0 1"/><origin xyz="0 0"/>'), "repeated", "origin", None),
    (shape('<mesh filename="a"/><mesh filename="b" scale=""/>'), "repeated", "mesh", None),
    (shape('<mesh filename="a"/><box size="x"/>'), "repeated", "box", None),
    ('<link name="a"/>&gt;', "not-read", "robot", None),
    ('<link name="a">0 0 1</link>', "not-read", "link", ""),
    (joint("<axis xyz='0 0 1'/> -->"), "not-read", "joint", None),
    (shape('<sphere radius=""/>'), "value", "sphere", "radius"),
    (shape('<sphere radius="0,5"/>'), "value", "sphere", "radius"),
    (shape('<sphere radius="1_0"/>'), "value", "sphere", "radius"),
    (shape('<sphere radius="0x1"/>'), "value", "sphere", "radius"),
    (shape('<sphere radius="٣"/>'), "value", "sphere", "radius"),
    (shape('<box size="1, 1, 1"/>'), "value", "box", "size"),
    (shape('<sphere radius="NaN"/>'), "value", "sphere", "radius"),
    (shape('<sphere radius="1e400"/>'), "value", "sphere", "radius"),
    (shape(f'<sphere radius="{"9" * 400}"/>'), "value", "sphere", "radius"),
    (joint('<origin rpy="0 -inf 0"/>'), "value", "origin", "rpy"),
    (shape('<mesh filename="a" scale="1"/>'), "value", "mesh", "scale"),
    (shape('<sphere radius="1 1"/>'), "value", "sphere", "radius"),
    (joint('<axis xyz="0 1"/>'), "value", "axis", "xyz"),
    (shape('<sphere radius="1 "/>'), "value", "sphere", "radius"),
    (shape('<box size="1\t1 1"/>'), "value", "box", "size"),
    (shape('<box size="1 1\n   1"/>'), "value", "box", "size"),
    (shape('<box size="1 1 1\r\n"/>'), "value", "box", "size"),
    ('<robot name="r" version="1"/>', "word", "robot", "version"),
    (control("").replace("system", "System"), "word", "ros2_control", "type"),
    ('<material name="m"><color rgba="0 0 0"/></material>', "value", "color", "rgba"),
    ('<material name="m"><color rgba="0 0 0 2"/></material>', "value", "color", "rgba"),
    ('<material name="m"><color rgba="100 05 0 1"/></material>', "value", "color", "rgba"),
    ('<material name="m"><color rgba="-1 0 0 1"/></material>', "value", "color", "rgba"),
    ('<material name="m"><color rgba="red"/></material>', "value", "color", "rgba"),
)


@pytest.mark.parametrize(("body", "kind", "tag", "attribute"), FAULTS)
def test_one_fault_is_told_once(body: str, kind: str, tag: str, attribute: str | None) -> None:
    assert kinds(body) == [(kind, tag, attribute)]


@pytest.mark.parametrize(
    ("text", "found"),
    [
        # A line end behind a number of an element's text, and in a comment, are none of a value.
        ('<gazebo><pose>1\n2</pose></gazebo><!-- xyz="1\n2" -->', 0),
        # Between attributes there is nothing to report.
        ('<link name="a1"\n/>', 0),
        # urdfdom takes white space in front of a number.
        (shape('<box size="\n 1 \t1 1"/>'), 0),
        (shape('<box size="1\t1\t1"/>'), 1),
        (joint('<origin rpy="0 0 0" xyz="1 2\n3"/>'), 1),
        # A name may hold what it likes.
        ('<link name="a1\tb"/>', 0),
    ],
)
def test_line_ends_and_tabs_count_in_numbers_alone(text: str, found: int) -> None:
    assert len([it for it in faults(text) if it.code == "value"]) == found


def test_the_same_wrong_value_is_told_at_every_place() -> None:
    assert len(faults(shape('<sphere radius="x"/>') * 3)) == 3
    # An axis that is not read does not hide the same value where it is read.
    wrong = '<axis xyz="0 1"/>'
    fixed = f'<joint name="j" type="fixed">{ENDS}{wrong}</joint>'
    moving = f'<joint name="k" type="revolute">{ENDS}{wrong}</joint>'
    assert [it.element.getparent().get("name") for it in faults(LINKS + fixed + moving)] == ["k"]


@pytest.mark.parametrize(
    ("value", "hint"),
    [
        ("0,5", "point"),
        ("1, 2, 3", "spaces"),
        ("0.5m", "unit"),
        ("90°", "unit"),
        ("${x}", "xacro"),
        ("abc", ""),
    ],
)
def test_hints_name_the_remedy(value: str, hint: str) -> None:
    (fault,) = faults(shape(f'<sphere radius="{value}"/>'))
    assert hint in fault.hint
    assert bool(hint) == bool(fault.hint)


@pytest.mark.parametrize(
    ("body", "hint"),
    [
        (visual('<origin ryp="0 0 1"/>'), "'rpy'"),
        ('<link name="a"><inertail/></link>', "<inertial>"),
        ('<link name="a"><mass value="1"/></link>', "<inertial>"),
        ('<link name="a"><geometry/></link>', "<collision> or <visual>"),
    ],
)
def test_hints_name_what_is_meant(body: str, hint: str) -> None:
    (fault,) = faults(body)
    assert hint in fault.hint


def test_the_schema_is_whole() -> None:
    sections = schema(KNOWN[-1]).sections
    for name, section in sections.items():
        for tag, child in section.children.items():
            assert not child.section or child.section in sections, (name, tag)
        types = {kind.type for kind in section.attributes.values()}
        assert types <= {"", *FINE, "one"}, name
    reached = {child.section for it in sections.values() for child in it.children.values()}
    assert set(sections) - reached == {"robot"}


@pytest.mark.more
def test_the_cost_of_a_large_robot_grows_with_its_size_and_not_faster() -> None:
    def prepared(count: int) -> Callable[[], object]:
        body = "".join(
            f'<link name="l{i}"><visual><geometry><sphere radius="{i} x"/></geometry></visual>'
            f"<inertail/></link>"
            for i in range(count)
        )
        document = read_document(f'<robot name="r">{body}</robot>'.encode(), "r.urdf")
        assert len(read_faults(document)) == 2 * count
        return lambda: read_faults(document)

    assert growth(prepared, 100, 400) < 1.5


def test_messages_stay_short() -> None:
    long = "9" * 5000
    for body in (shape(f'<sphere radius="{long}"/>'), shape(f'<sphere radius="1 x{long}"/>'), long):
        (fault,) = faults(body)
        assert len(fault.message) < 200
