# SPDX-License-Identifier: Apache-2.0
"""A package is adopted in all its configurations: what a switch or a word of an argument brings in has
the prefix, too, and a place that one of them needs as it is stays for all."""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite import adopt
from multibot_rewrite.description.sources.access import TRUSTED
from multibot_rewrite.description.sources.expand import expand

SPACE = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
# A description -> arguments that another configuration has, and what is in it with a prefix.
CASES = {
    "a switch": (
        '<xacro:arg name="arm" default="false"/>'
        '<xacro:if value="$(arg arm)"><link name="arm"/></xacro:if>',
        {"arm": "true"},
        b'<link name="a_arm"/>',
    ),
    "a word of a macro's parameter": (
        '<xacro:arg name="tool" default="none"/><xacro:macro name="tools" params="kind">'
        '<xacro:if value="${kind == \'hand\'}"><link name="hand"/></xacro:if></xacro:macro>'
        '<xacro:tools kind="$(arg tool)"/>',
        {"tool": "hand"},
        b'<link name="a_hand"/>',
    ),
    "a word of a list, of a property": (
        '<xacro:arg name="model" default="s"/><xacro:property name="size" value="$(arg model)"/>'
        "<xacro:if value=\"${size in ['m', 'l']}\"><link name=\"more\"/></xacro:if>",
        {"model": "l"},
        b'<link name="a_more"/>',
    ),
    "a word before the argument": (
        '<xacro:arg name="model" default="s"/>'
        "<xacro:if value=\"${'m' == '$(arg model)'}\"><link name=\"more\"/></xacro:if>",
        {"model": "m"},
        b'<link name="a_more"/>',
    ),
}


def written(folder: Path, inside: str) -> Path:
    path = folder / "r.urdf.xacro"
    path.write_text(f'<robot name="r" {SPACE}><link name="base"/>\n{inside}</robot>\n')
    return path


@pytest.mark.sample(2)
@pytest.mark.parametrize("case", CASES)
def test_what_another_configuration_has_gets_the_prefix(case: str, tmp_path: Path) -> None:
    inside, given, there = CASES[case]
    path = written(tmp_path, inside)
    before = expand(str(path), given)
    made = adopt(str(tmp_path))
    words = " ".join(f"{name}:={value}" for name, value in given.items())
    assert f"{path} {words}" in made.configurations
    path.write_bytes(made.after[str(path)])
    assert expand(str(path), given) == before
    assert there in expand(str(path), {**given, "prefix": "a_"})


def test_the_world_of_another_configuration_is_no_name_of_the_robot(tmp_path: Path) -> None:
    """By default the macro's parent is a link of the robot, with the switch it is the world."""
    inside = (
        '<xacro:arg name="fixed" default="false"/><link name="a"/><xacro:if value="$(arg fixed)">'
        '<link name="world"/></xacro:if><xacro:macro name="on" params="up">'
        '<joint name="j" type="fixed"><parent link="${up}"/><child link="a"/></joint></xacro:macro>'
        '<xacro:if value="$(arg fixed)"><xacro:on up="world"/></xacro:if>'
        '<xacro:unless value="$(arg fixed)"><xacro:on up="base"/></xacro:unless>'
    )
    path = written(tmp_path, inside)
    made = adopt(str(tmp_path))
    assert (made.left, len(made.configurations)) == ((), 1)
    path.write_bytes(made.after[str(path)])
    assert b'<parent link="world"/>' in expand(str(path), {"fixed": "true", "prefix": "a_"})
    assert b'<parent link="a_base"/>' in expand(str(path), {"prefix": "a_"})


def test_a_configuration_that_does_not_expand_is_told(tmp_path: Path) -> None:
    inside = (
        '<xacro:arg name="more" default="false"/>'
        '<xacro:if value="$(arg more)"><xacro:include filename="none.xacro"/></xacro:if>'
    )
    written(tmp_path, inside)
    made = adopt(str(tmp_path))
    ((where, why),) = made.unread.items()
    assert where.endswith("r.urdf.xacro more:=true")
    assert why.startswith("with more:=true: ")
    assert "none.xacro" in why


def test_an_argument_that_is_given_stays_as_it_is(tmp_path: Path) -> None:
    more = '<xacro:if value="$(arg m)"><link name="x"/></xacro:if>'
    written(tmp_path, f'<xacro:arg name="m" default="false"/>{more}')
    assert adopt(str(tmp_path), xacro_args={"m": "true"}).configurations == ()


def test_who_else_includes_a_file_needs_no_argument(tmp_path: Path) -> None:
    """A package that is not looked at includes the same macro."""
    for name in ("r", "other"):
        (tmp_path / name).mkdir()
    part = tmp_path / "r/part.xacro"
    part.write_text(
        f'<robot {SPACE}><xacro:macro name="p" params="n"><link name="${{n}}_p"/></xacro:macro></robot>'
    )
    written(tmp_path / "r", '<xacro:include filename="part.xacro"/><xacro:p n="x"/>')
    other = tmp_path / "other/o.urdf.xacro"
    other.write_text(
        f'<robot name="o" {SPACE}><xacro:include filename="../r/part.xacro"/><xacro:p n="x"/></robot>'
    )
    before = expand(str(other), {}, reach=TRUSTED)
    for path, data in adopt(str(tmp_path / "r")).after.items():
        Path(path).write_bytes(data)
    assert b"${prefix}" in part.read_bytes()
    assert expand(str(other), {}, reach=TRUSTED) == before
