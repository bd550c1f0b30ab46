# SPDX-License-Identifier: Apache-2.0
"""MB8: an SRDF finds its URDF, and what is compared with it."""

from __future__ import annotations

from pathlib import Path

import pytest
from lint_calls import ArgumentSet, Settings, lint_file, lint_files

from multibot_rewrite.base.model import InputError
from multibot_rewrite.lint.files.named import robot_name
from multibot_rewrite.lint.files.pairing import described, named_urdfs

SHAPE = "<collision><geometry><sphere radius='1'/></geometry></collision>"
LINK = '<link name="{}">{}</link>'
JOINT = '<joint name="{}" type="{}"><parent link="{}"/><child link="{}"/>{}</joint>'
LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'
SETTINGS = Settings(select=("MB8", "MB110", "MB115", "MB12"))
URDF = (
    '<robot name="{}">'
    + LINK.format("base", SHAPE)
    + LINK.format("left", SHAPE)
    + LINK.format("right", SHAPE)
    + LINK.format("tool", "")
    + JOINT.format("jl", "revolute", "base", "left", LIMIT)
    + JOINT.format("jr", "continuous", "base", "right", "")
    + JOINT.format("jt", "fixed", "left", "tool", "")
    + "</robot>"
)
ARM = '<group name="arm"><chain base_link="base" tip_link="tool"/></group>'
STATE = ARM + '<group_state name="s" group="arm"><joint name="{}" value="{}"/></group_state>'
PARTLY = (
    '<group name="all"><joint name="jl"/><group name="typo"/></group>'
    '<group_state name="s" group="all"><joint name="{}" value="0"/></group_state>'
)
VIRTUAL = '<virtual_joint name="v" type="{}" parent_frame="odom" child_link="base"/>'
PAIR = '<disable_collisions link1="{}" link2="{}" reason="Never"/>'
ALL = PAIR.format("base", "left") + PAIR.format("right", "base")
WHEELS = '<group name="base"><joint name="v"/></group><group_state name="s" group="base">'
AT = '<joint name="v" value="{}"/></group_state>'


def write(folder: Path, name: str, text: str) -> str:
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return str(path)


def lint(folder: Path, body: str, urdf: str = "") -> list[str]:
    file = write(folder, "in.srdf", f'<robot name="r">{body}</robot>')
    write(folder, "r.urdf", urdf or URDF.format("r"))
    return [it.code for it in lint_file(file, SETTINGS)]


@pytest.mark.parametrize(
    ("body", "codes"),
    [
        ("", []),
        (ARM, []),
        # white space around a name counts for nothing in srdfdom
        (ARM.replace('"base"', '" base "'), []),
        # a chain may go up and down again
        ('<group name="g"><chain base_link="right" tip_link="tool"/></group>', []),
        ('<group name="g"><chain base_link="tool" tip_link="base"/></group>', []),
        ('<group name="g"><chain base_link="tool" tip_link="tool"/></group>', ["MB810"]),
        # one wrong name is one finding
        ('<group name="g"><chain base_link="bsae" tip_link="tool"/></group>', ["MB803"]),
        (ARM + '<group name="g"><link name="jl"/></group>', ["MB803"]),
        (ARM + '<group name="g"><joint name="left"/></group>', ["MB804"]),
        (ARM + '<group name="g"/>', ["MB811"]),
        (ARM + '<group name="g"><!-- later --></group>', ["MB811"]),
        (ARM + '<group name="g"><group name="g"/></group>', []),
        (ARM + VIRTUAL.format("fixed") * 2, ["MB806"]),
        # states: in the group, in the limits, one number a degree of freedom
        (STATE.format("jl", "1"), []),
        (STATE.format("jl", "1.00009"), []),
        (STATE.format("jl", "1.001"), ["MB813"]),
        (STATE.format("jl", "-1.001"), ["MB813"]),
        (STATE.format("jr", "100"), ["MB812"]),
        # What a group without one of its groups holds is not known.
        (PARTLY.format("jr"), ["MB805"]),
        (STATE.format("jl", "0 0"), ["MB120"]),
        (STATE.format("jl", ""), ["MB120"]),
        (STATE.format("jl", "nan"), ["MB120"]),
        (STATE.format("jl", "1e400"), ["MB120"]),
        (STATE.format("jt", "0"), []),
        (VIRTUAL.format("planar") + WHEELS + AT.format("0 0 0"), []),
        (VIRTUAL.format("planar") + WHEELS + AT.format("0 0"), ["MB120"]),
        (VIRTUAL.format("Floating") + WHEELS + AT.format("0 0 0 0 0 0 1"), []),
        (VIRTUAL.format("moving"), ["MB124"]),
        (VIRTUAL.format("fixed").replace("base", "left"), ["MB815"]),
        # pairs
        (ALL, []),
        (ALL + PAIR.format("left", "base"), ["MB809"]),
        (ALL + PAIR.format("left", "base") * 3, ["MB809"]),
        (ALL + PAIR.format("left", "left"), ["MB818"]),
        (ALL + PAIR.format("left", "tool"), ["MB819"]),
        (ALL + PAIR.format("left", "lost") + PAIR.format("base", "lost"), ["MB807"]),
        (PAIR.format("left", "right"), ["MB820"]),
        (PAIR.format("left", "right") + '<disable_default_collisions link="base"/>', []),
        # what other tools have in an SRDF stays out of it
        (ARM + "<gripper name='g'/><calibration_info/>", []),
        (ARM + '<disable_collision link1="a"/>', ["MB110"]),
        (ARM.replace("base_link", "baselink"), ["MB115", "MB110"]),
        (ARM + "<end_effector/>", ["MB115"] * 3),
        (ARM + '<joint_property joint_name="jl"/>', ["MB115"] * 2),
        # nothing falls over
        ("<group/><group_state/><virtual_joint/><enable_collisions/>", ["MB811"] + ["MB115"] * 9),
        ('<passive_joint name="jl"><x/></passive_joint>', []),
    ],
)
def test_what_is_found(tmp_path: Path, body: str, codes: list[str]) -> None:
    assert sorted(lint(tmp_path, body)) == sorted(codes)


def test_a_fixed_joint_to_a_world_link_is_what_gazebo_wants(tmp_path: Path) -> None:
    world = LINK.format("world", "") + JOINT.format("w", "fixed", "world", "base", "")
    urdf = URDF.format("r").replace("</robot>", f"{world}</robot>")
    assert lint(tmp_path, ARM + VIRTUAL.format("fixed"), urdf) == []
    assert lint(tmp_path, ARM + VIRTUAL.format("planar"), urdf) == ["MB815"]


def test_a_circle_of_links_ends(tmp_path: Path) -> None:
    circle = JOINT.format("back", "fixed", "tool", "base", "")
    urdf = URDF.format("r").replace("</robot>", f"{circle}</robot>")
    body = ARM.replace('"tool"', '"right"') + STATE.replace("arm", "arm2").format("jl", "0")
    assert "MB810" not in lint(tmp_path, body, urdf)


def codes_of(found: object, file: str) -> list[str]:
    return [it.code for it in found if it.file == file]  # type: ignore[attr-defined]


@pytest.mark.slow
def test_workers_find_the_same(tmp_path: Path) -> None:
    paths = []
    for n in range(14):
        text = f'<robot name="r{n}">{STATE.format("jl", n)}</robot>'
        paths += [write(tmp_path, f"s/r{n}.srdf", text)]
        paths += [write(tmp_path, f"u/r{n}.urdf", URDF.format(f"r{n}"))]
    settings = SETTINGS
    alone, many = (lint_files(paths, settings, jobs=jobs) for jobs in (1, 2))
    assert alone == many
    assert len(alone) == 12


def test_a_urdf_of_the_same_file_name_tells_the_other_name(tmp_path: Path) -> None:
    srdf = write(tmp_path, "arm.srdf", f'<robot name="r">{ARM}</robot>')
    write(tmp_path, "arm.urdf", URDF.format("arm"))
    assert codes_of(lint_file(srdf, SETTINGS), srdf) == ["MB802"]


def test_an_srdf_of_xacro_is_expanded_and_named_by_its_source(tmp_path: Path) -> None:
    head = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
    body = '<xacro:property name="tip" value="tol"/>\n<group name="g">\n'
    chain = '<chain base_link="base" tip_link="${tip}"/></group></robot>'
    srdf = write(tmp_path, "r.srdf.xacro", head + body + chain)
    write(tmp_path, "r.urdf", URDF.format("r"))
    (it,) = lint_file(srdf, SETTINGS)
    assert (it.code, it.file, it.line) == ("MB803", srdf, 3)
    assert it.hint == "did you mean 'tool'?"


def test_without_a_urdf_its_own_names_are_looked_at(tmp_path: Path) -> None:
    body = STATE.format("jl", "x") + '<group name="h"><group name="amr"/></group>'
    srdf = write(tmp_path, "in.srdf", f'<robot name="r">{body}</robot>')
    found = lint_file(srdf, SETTINGS)
    assert sorted(it.code for it in found) == ["MB120", "MB801", "MB805"]


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ('<?xml version="1.0"?>\n<!-- c -->\n<robot\n xmlns:x="y" name = "arm">', "arm"),
        ("<robot name='a b'>", "a b"),
        ('<robot name="$(arg name)">', ""),
        ("<robot>", ""),
        ('<robot filename="x">', ""),
    ],
)
def test_the_name_of_a_robot_is_read_from_its_head(tmp_path: Path, text: str, name: str) -> None:
    assert robot_name(write(tmp_path, "x.urdf", text)) == name


def test_a_file_that_is_not_there_has_no_name(tmp_path: Path) -> None:
    assert robot_name(str(tmp_path / "nothing.urdf")) == ""


def test_a_xacro_that_another_includes_is_no_urdf_of_an_srdf(tmp_path: Path) -> None:
    """An included URDF may be a robot by itself, as one that a world or a cell takes in."""
    for name in ("arm.urdf", "arm.xacro", "part.xacro", "part.urdf", "nameless.urdf", "arm.srdf"):
        word = "" if name.startswith("nameless") else f' name="{name}"'
        (tmp_path / name).write_text(f"<robot{word}/>")
    paths = [str(it) for it in sorted(tmp_path.iterdir())]
    included = frozenset(it for it in paths if "part" in it)
    found = named_urdfs(paths, included)
    assert [name for name, _ in found] == ["arm.urdf", "arm.xacro", "part.urdf"]
    assert [path for _, path in found] == [str(tmp_path / name) for name, _ in found]
    assert named_urdfs([it for it in paths if not it.endswith(".srdf")], included) == ()


XACRO_NAME = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
NEEDS = (
    f'<robot {XACRO_NAME} name="r"><xacro:property name="p" value="1"/><link name="$(arg side)"/>'
    "</robot>"
)
SIDES = (ArgumentSet("*", (("side", "left"),)), ArgumentSet("*", (("side", "right"),)))


@pytest.mark.parametrize(
    ("name", "arguments", "found"),
    [
        ("r.xacro", SIDES, "left"), ("r.xacro", SIDES[1:], "right"), ("r.xacro", (), None),
        ("r.xacro", (ArgumentSet("other*", (("side", "left"),)),), None),
        ("r.urdf", SIDES, "left"), ("r.urdf", (), "$(arg side)"),
    ],
)  # fmt: skip
def test_a_description_is_read_with_the_arguments_that_it_needs(
    name: str, arguments: tuple[ArgumentSet, ...], found: str | None, tmp_path: Path
) -> None:
    """A URDF may have a rest of xacro in it, and is read all the same."""
    path = write(tmp_path, name, NEEDS)
    settings = Settings(arguments=arguments)
    if found is None:
        with pytest.raises(InputError):
            described(path, settings)
        return
    text, said = described(path, settings)
    assert f'name="{found}"' in text.decode()
    assert said == (path if "$" in found else f"{path} (expanded)")
