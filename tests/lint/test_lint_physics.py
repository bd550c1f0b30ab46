# SPDX-License-Identifier: Apache-2.0
"""MB6 beyond the examples: what must be found, at which line, and what must not."""

from __future__ import annotations

import random
from pathlib import Path

import pytest
from lint_calls import RULES, Settings, lint_file

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.rules.description.physics.inertia import eigenvalues

GROUP = Settings(select=("MB6", "MB115", "MB125"), ignore=("MB609", "MB610", "MB611"))
WHOLE = Settings(select=("MB609", "MB610", "MB611"))
BOX = '<geometry><box size="0.1 0.1 0.1"/></geometry>'
SEEN, HARD = f"<visual>{BOX}</visual>", f"<collision>{BOX}</collision>"


def inertia(*values: object) -> str:
    """ixx ixy ixz iyy iyz izz; of three values the diagonal."""
    xx, xy, xz, yy, yz, zz = values if values[3:] else (values[0], 0, 0, values[1], 0, values[2])
    return f'<inertia ixx="{xx}" ixy="{xy}" ixz="{xz}" iyy="{yy}" iyz="{yz}" izz="{zz}"/>'


def weighs(mass: object, *values: object) -> str:
    values = values or (0.01, 0.01, 0.01)
    return f'<inertial><mass value="{mass}"/>{inertia(*values)}</inertial>'


GOOD = weighs(1)


def reaching(shape: str, size: str, radius: float | None, xyz: str = "0 0 0") -> str:
    """Return a shape, and an inertia of this radius of gyration."""
    own = "" if radius is None else weighs(1, *[radius**2] * 3)
    what = f'<origin xyz="{xyz}"/><geometry><{shape} {size}/></geometry>'
    return f"{own}<collision>{what}</collision>"


def robot(*parts: str, name: str = "a") -> str:
    """Return a chain from its root on: insides of links, between them the types of the joints.

    A link's line is its place, with the root on line 1; names go on from ``name``.
    """
    names = [name, *(f"{name}{it}" for it in range(1, len(parts)))]
    text = f'<link name="{name}">{parts[0]}</link>'
    for at in range(1, len(parts) - 1, 2):
        upper, lower = names[at // 2], names[at // 2 + 1]
        text += (
            f'\n<link name="{lower}">{parts[at + 1]}</link><joint name="j{at}" type="{parts[at]}">'
            f'<parent link="{upper}"/><child link="{lower}"/></joint>'
        )
    return text


def found(body: str, folder: Path, settings: Settings = GROUP) -> list[Finding]:
    file = folder / "robot.urdf"
    file.write_text(f'<robot name="r">{body}</robot>')
    return lint_file(str(file), settings)


def reported(findings: list[Finding]) -> str:
    return " ".join(sorted(f"{it.code}:{it.line}" for it in findings))


@pytest.mark.parametrize(("distro", "level"), [("humble", "warning"), ("jazzy", "note")])
def test_a_mass_that_one_release_takes_for_none(distro: str, level: str, tmp_path: Path) -> None:
    """sdformat 12 compares with 0 within 1e-6 (parser_urdf.cc), later ones ask for a mass above 0."""
    settings = Settings(distro=distro, select=("MB612",))
    body = robot(GOOD, MOVES, weighs("1e-6", "1e-9", "1e-9", "1e-9"))
    assert [(it.level, it.line) for it in found(body, tmp_path, settings)] == [(level, 2)]


MOVES, HOLDS = "continuous", "fixed"
CASES = [
    # mass
    pytest.param(robot("<inertial/>"), "MB115:1 MB115:1", id="empty inertial"),
    pytest.param(
        robot(f"<inertial><mass/>{inertia(1, 1, 1)}</inertial>"), "MB115:1", id="mass without value"
    ),
    pytest.param(robot(weighs("x")), "", id="not a number: another rule"),
    pytest.param(robot(weighs("nan")), "", id="nan, too"),
    pytest.param(robot(weighs(-1)), "MB125:1", id="negative mass of the root"),
    pytest.param(robot(GOOD, HOLDS, weighs(-1)), "MB125:2", id="negative mass on a fixed joint"),
    pytest.param(robot(GOOD, HOLDS, weighs(0, 0, 0, 0)), "", id="a frame without mass"),
    pytest.param(robot(GOOD, MOVES, weighs(0)), "MB603:2", id="a wheel without mass"),
    pytest.param(robot(GOOD, MOVES, "", HOLDS, GOOD), "", id="the mass is fixed to it"),
    pytest.param(robot(GOOD, MOVES, "", MOVES, GOOD), "MB603:2", id="the mass turns on it"),
    pytest.param(robot(GOOD, MOVES, "", MOVES, ""), "MB603:2", id="the upper one says it all"),
    pytest.param(robot("", HOLDS, GOOD), "", id="base_footprint"),
    pytest.param(robot("", MOVES, GOOD), "MB603:1", id="a root without mass"),
    pytest.param(robot("", HOLDS, GOOD, MOVES, GOOD, name="world"), "", id="world has none"),
    pytest.param(robot("", MOVES, ""), "", id="no masses at all"),
    pytest.param(robot(GOOD, MOVES, weighs("x")), "", id="an unknown mass is one"),
    pytest.param(robot(GOOD, MOVES, weighs("1e-9", 0, 0, "1e-12")), "MB606:2 MB612:2", id="tiny"),
    pytest.param(robot(GOOD, HOLDS, weighs("1e-9")), "", id="a tiny frame"),
    # inertia
    pytest.param(
        robot('<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial>'),
        "MB115:1",
        id="no products",
    ),
    pytest.param(robot(GOOD, MOVES, weighs(1, 0, 0, 0)), "MB605:2", id="zero"),
    pytest.param(robot(GOOD, MOVES, weighs(1, 0, 0, 0), HOLDS, GOOD), "", id="the sum is not zero"),
    pytest.param(robot(GOOD, HOLDS, weighs(1, 0, 0, 0)), "", id="a point mass, merged"),
    pytest.param(robot(weighs(1, 0, 0, 0), MOVES, GOOD), "", id="a root does not turn"),
    pytest.param(robot(weighs(1, 0, "1e-35", 0, 0, 0, "-1e-19")), "", id="noise of an exporter"),
    pytest.param(robot(weighs(1, 1, 1, 2)), "", id="a plate is on the border"),
    pytest.param(robot(weighs(1, 0, 1, 1)), "", id="so is a rod"),
    pytest.param(robot(weighs(1, "1.0e-5", "1.0e-5", "2.01e-5")), "", id="rounding"),
    pytest.param(robot(weighs(1, 1, 1, 2.1)), "MB606:1", id="not rounding"),
    pytest.param(robot(weighs(1, 1, 1, 1, 1, 1, 1)), "MB606:1", id="all ones are 0, 0, 3"),
    pytest.param(robot(weighs(1, -1, 1, 1)), "MB606:1", id="negative"),
    pytest.param(robot(weighs(1, 1, 0.24, 0.24, 1, 0.24, 1)), "", id="large products"),
    pytest.param(robot(GOOD, HOLDS, weighs(1, 1, 1, 3)), "MB606:2", id="merged triangle"),
    pytest.param(robot(GOOD, HOLDS, weighs(1, -1, 1, 1)), "MB606:2", id="merged negative"),
    pytest.param(robot(weighs(1, 1, 1, 3), HOLDS, GOOD), "MB606:1", id="others are merged into it"),
    pytest.param(robot(weighs(1, 1, 1, 3), HOLDS, ""), "MB606:1", id="nothing of mass is"),
    pytest.param(robot(weighs(1, 1, 1, 3), name="world"), "MB606:1", id="world is not a body"),
    # scale
    pytest.param(robot(weighs(3, 100, 100, 100)), "MB608:1", id="six metres"),
    pytest.param(robot(weighs(2000, 1e5, 1e5, 1e5)), "", id="a boat"),
    pytest.param(robot(weighs(0.001, 1, 1, 1)), "", id="a placeholder"),
    pytest.param(robot(weighs(1, "1e-9", "1e-9", "1e-9")), "MB608:1", id="a needle's point"),
    pytest.param(
        robot(weighs(1, 36, 36, 36) + HARD), "MB608:1", id="six metres in ten centimetres"
    ),
    pytest.param(robot(weighs(1, 0.1, 0.1, 0.1) + HARD), "", id="only three times too large"),
    pytest.param(
        robot(weighs(15, 0.001, 0.001, 0.001) + HARD.replace("0.1 0.1 0.1", "2 2 2")),
        "MB608:1",
        id="15 kg in the middle of two metres",
    ),
    pytest.param(
        robot(weighs(1, 1, 1, 1) + HARD.replace("box", "mesh")),
        "",
        id="the size of a mesh is not known",
    ),
    pytest.param(robot(reaching("sphere", 'radius="0.1"', 0.41)), "MB608:1", id="4 spheres"),
    pytest.param(robot(reaching("sphere", 'radius="0.1"', 0.39)), "", id="nearly"),
    # A box reaches half its diagonal, a cylinder its radius or length, as far as its origin is off.
    pytest.param(robot(reaching("box", 'size="0.2 0.2 0.1"', 0.61)), "MB608:1", id="4 boxes"),
    pytest.param(robot(reaching("box", 'size="0.2 0.2 0.1"', 0.59)), "", id="nearly a box"),
    pytest.param(
        robot(reaching("cylinder", 'radius="0.1" length="0.3"', 1.21)), "MB608:1", id="4 cylinders"
    ),
    pytest.param(
        robot(reaching("cylinder", 'radius="0.1" length="0.3"', 1.19)), "", id="nearly one"
    ),
    pytest.param(
        robot(reaching("sphere", 'radius="0.1"', 1.61, "0 0.3 0")), "MB608:1", id="off the origin"
    ),
    pytest.param(robot(reaching("sphere", 'radius="0.1"', 1.59, "0 0.3 0")), "", id="nearly off"),
    pytest.param(
        robot(reaching("sphere", 'radius="0.1"', 0.41) + reaching("box", 'size="1 1 1"', None)),
        "",
        id="the largest of its shapes",
    ),
    # shapes
    pytest.param(robot(HARD.replace("0.1 0.1 0.1", "1 -1 1")), "MB125:1", id="negative side"),
    pytest.param(
        robot('<visual><geometry>\n<cylinder radius="0" length="1"/></geometry></visual>'),
        "MB125:2",
        id="a line",
    ),
    pytest.param(robot(HARD.replace("0.1 0.1 0.1", "1 1")), "", id="two numbers: another rule"),
    pytest.param(robot(HARD.replace("0.1 0.1 0.1", "100 100 0.1")), "", id="a floor"),
    pytest.param(robot(HARD.replace("0.1 0.1 0.1", "30 0.1 0.1")), "", id="a rail"),
    pytest.param(robot(HARD.replace("0.1 0.1 0.1", "80 60 40")), "MB614:1", id="millimetres"),
    pytest.param(robot("<collision><geometry/></collision>"), "MB615:1", id="empty geometry"),
    pytest.param(
        robot('<visual><geometry><cone radius="1" length="1"/></geometry></visual>'), "MB615:1"
    ),
    pytest.param(robot("<visual><geometry><!-- a --><box size='1 1 1'/></geometry></visual>"), ""),
    pytest.param("<gazebo><visual/><link name='a'/></gazebo><link name='a'/>", "", id="not URDF's"),
    pytest.param(
        robot("<visual><geometry><mesh filename='a' scale='0 0 0'/></geometry></visual>"), "MB616:1"
    ),
    pytest.param(
        robot("<visual><geometry><mesh filename='a' scale='-1 1 1'/></geometry></visual>"),
        "MB616:1",
    ),
    pytest.param(
        robot("<visual><geometry><mesh filename='a' scale='-1 -1 1'/></geometry></visual>"),
        "",
        id="half a turn",
    ),
    pytest.param(
        robot(
            "<visual><geometry><mesh filename='a' scale='.0254 .0254 .0254'/></geometry></visual>"
        ),
        "",
        id="inches",
    ),
    pytest.param(
        robot("<visual><geometry><mesh filename='a' scale='0.04 0.04 0.5'/></geometry></visual>"),
        "",
        id="a unit cylinder, stretched",
    ),
    pytest.param(
        robot("<visual><geometry><mesh filename='a' scale='.001 .001 1'/></geometry></visual>"),
        "MB616:1",
        id="one scale forgotten",
    ),
]


@pytest.mark.parametrize(("body", "expected"), CASES)
def test_what_is_found_and_what_is_not(body: str, expected: str, tmp_path: Path) -> None:
    assert reported(found(body, tmp_path)) == expected


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        (robot(GOOD, MOVES, GOOD), "MB609:1"),
        (robot("", HOLDS, GOOD), ""),
        (robot("", MOVES, ""), "MB610:1"),
        (robot("", HOLDS, ""), ""),
        (robot(SEEN + HARD, MOVES, SEEN), "MB610:1 MB611:2"),
        (robot(SEEN + HARD, HOLDS, SEEN), ""),
        (robot(SEEN + HARD, MOVES, SEEN, HOLDS, HARD), "MB610:1"),
        (robot(HARD, MOVES, HARD, HOLDS, SEEN), "MB610:1"),
        (robot(SEEN, MOVES, SEEN, MOVES, SEEN), "MB610:1 MB611:1"),
    ],
)
def test_the_robot_as_a_whole(body: str, expected: str, tmp_path: Path) -> None:
    assert reported(found(body, tmp_path, WHOLE)) == expected


def test_how_much_gazebo_leaves_out_is_told(tmp_path: Path) -> None:
    (finding,) = found(robot(GOOD, MOVES, "", MOVES, GOOD, HOLDS, GOOD), tmp_path)
    assert finding.message.endswith("Gazebo leaves it out, with 2 links below it")


@pytest.mark.parametrize("value", ["", "nan", "-inf", "1e400", "abc", "1 2", "1e-320", "9" * 300])
def test_odd_values_crash_nothing(value: str, tmp_path: Path) -> None:
    shapes = "".join(
        f'<visual><geometry><{tag} size="{value}" radius="{value}" length="{value}" scale="{value}"/>'
        "</geometry></visual>"
        for tag in ("box", "cylinder", "sphere", "mesh")
    )
    for mass, moment in ((value, value), (value, 1), (1, value)):
        inside = weighs(mass, moment, moment, 0, 1, value, 1) + shapes
        codes = {it.code for it in found(robot(inside, MOVES, inside), tmp_path)}
        assert "MB001" not in codes


@pytest.mark.slow
def test_principal_moments_are_those_of_numpy() -> None:
    numpy = pytest.importorskip("numpy")
    draw = random.Random(6).uniform
    for _ in range(300):
        scale = 10 ** draw(-9, 9)
        xx, xy, xz, yy, yz, zz = values = tuple(draw(-1, 1) * scale for _ in range(6))
        expected = numpy.linalg.eigvalsh([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        assert eigenvalues(values) == pytest.approx(list(expected), abs=1e-7 * scale)


def test_every_rule_of_the_group_is_in_a_case() -> None:
    """Those from MB620 on are in test_lint_geometry.py."""
    codes = {it[:5] for case in CASES for it in str(case.values[1]).split() if it[:3] == "MB6"}
    assert codes | {"MB609", "MB610", "MB611"} == {it for it in RULES if "MB6" <= it < "MB620"}


def test_of_two_geometries_the_first_is_read(tmp_path: Path) -> None:
    """urdfdom takes FirstChildElement, whatever follows."""
    empty = "<geometry/>"
    first = found(f'<link name="a">\n<visual>{empty}{BOX}</visual></link>', tmp_path)
    assert reported(first) == "MB615:2"
    assert found(f'<link name="a"><visual>{BOX}{empty}</visual></link>', tmp_path) == []
