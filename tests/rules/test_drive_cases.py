# SPDX-License-Identifier: Apache-2.0
"""A drive on two wheels: where they stand, how they turn and how large they are, and what is said.

Of ``rules/facts/drives.py`` and ``rules/description/physics/drives.py``.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite.lint.check import lint_file
from multibot_rewrite.rules.settings import Settings

ROUND = '<cylinder radius="0.1" length="0.04"/>'
# About the axis of a wheel: a cylinder stands on its z.
TURNED = "1.5707963 0 0"


def wheel(
    name: str,
    at: str,
    axis: str = "0 1 0",
    *,
    shape: str = ROUND,
    rpy: str = TURNED,
    kind: str = "continuous",
    tag: str = "collision",
) -> str:
    geometry = f"<geometry>{shape}</geometry>"
    body = f'<{tag}><origin rpy="{rpy}"/>{geometry}</{tag}>' if shape else ""
    return (
        f'<link name="{name}">{body}</link><joint name="{name}_joint" type="{kind}">'
        f'<parent link="base"/><child link="{name}"/><origin xyz="{at}"/><axis xyz="{axis}"/>'
        "</joint>"
    )


def said(wheels: str, folder: Path, sizes: tuple[str, str] = ("0.4", "0.1")) -> list[str]:
    plugin = (
        '<plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">'
        "<left_joint>l_joint</left_joint><right_joint>r_joint</right_joint>"
        f"<wheel_separation>{sizes[0]}</wheel_separation><wheel_radius>{sizes[1]}</wheel_radius>"
        "</plugin>"
    )
    text = f'<robot name="r"><link name="base"/>{wheels}<gazebo>{plugin}</gazebo></robot>'
    (folder / "r.urdf").write_text(text)
    found = lint_file(str(folder / "r.urdf"), Settings(select=("MB620", "MB622", "MB624")))
    return [f"{it.level} {it.message}" for it in found]


LEFT, RIGHT = "0 0.2 0", "0 -0.2 0"
AGAINST = "warning the axes of wheels 'l_joint' and 'r_joint' point in opposite directions"
SWAPPED = "warning left wheel 'l_joint' is 0.4 m right of 'r_joint'"
UPRIGHT = "warning the axis of wheel '{}_joint' is upright: it turns like a turntable"
FLAT = "warning wheel '{}_joint' is a cylinder that does not turn about its own axis"
BESIDE = "warning the axis of wheel 'l_joint' does not point to 'r_joint'"
NEAR = "warning wheel_separation is 0.4 m, but the wheels are 0.005 m apart"
HEIGHTS = "warning wheels 'l_joint' and 'r_joint' are at two heights, {} m apart"


@pytest.mark.parametrize(
    ("wheels", "expected"),
    [
        (wheel("l", LEFT) + wheel("r", RIGHT), []),
        (wheel("l", RIGHT) + wheel("r", LEFT), [SWAPPED]),
        # It drives along -x: with x forward both are on the wrong side, and both turn backwards.
        (wheel("l", RIGHT, "0 -1 0") + wheel("r", LEFT, "0 -1 0"), []),
        (wheel("l", LEFT, "0 -1 0") + wheel("r", RIGHT, "0 -1 0"), [SWAPPED]),
        # Which side is left cannot be said of wheels that turn against each other.
        (wheel("l", RIGHT, "0 1 0") + wheel("r", LEFT, "0 -1 0"), [AGAINST]),
        (wheel("l", LEFT) + wheel("r", RIGHT, "0 -1 0"), [AGAINST]),
        # Nor of upright ones, though one is below the other.
        (
            wheel("l", "0 0.2 0", "0 0 1", rpy="0 0 0")
            + wheel("r", "0 -0.2 0.005", "0 0 1", rpy="0 0 0"),
            [UPRIGHT.format("l"), UPRIGHT.format("r"), NEAR],
        ),
        (
            wheel("l", LEFT, rpy="0 0 0") + wheel("r", RIGHT),
            [FLAT.format("l")],
        ),
        # Of what is only seen nobody can say how it rolls.
        (wheel("l", LEFT, rpy="0 0 0", tag="visual") + wheel("r", RIGHT), []),
        (wheel("l", LEFT, shape='<sphere radius="0.1"/>') + wheel("r", RIGHT), []),
        # Along the robot's length; behind each other across it.
        (
            wheel("l", LEFT, "1 0 0", rpy="0 1.5707963 0")
            + wheel("r", RIGHT, "1 0 0", rpy="0 1.5707963 0"),
            [BESIDE],
        ),
        (wheel("l", "0 0.2 0") + wheel("r", "0 -0.2 -0.05"), [HEIGHTS.format("0.05")]),
        # A tenth of a radius of 0.1 m is a centimetre.
        (wheel("l", "0 0.2 0") + wheel("r", "0 -0.2 0.009"), []),
        (wheel("l", "0 0.2 0") + wheel("r", "0 -0.2 0.011"), [HEIGHTS.format("0.011")]),
        (
            wheel("l", LEFT, kind="fixed") + wheel("r", RIGHT),
            ["error wheel joint 'l_joint' is fixed: it cannot turn"],
        ),
        (
            wheel("l", LEFT) + wheel("r", RIGHT, kind="prismatic"),
            ["error wheel joint 'r_joint' is prismatic: it cannot turn"],
        ),
        (
            wheel("l", LEFT)
            + wheel("r", RIGHT, kind="revolute").replace(
                "</joint>", '<limit lower="-3" upper="3"/></joint>'
            ),
            ["error wheel joint 'r_joint' turns from -3 to 3 radians only"],
        ),
        (
            wheel("l", LEFT)
            + wheel("r", RIGHT, kind="revolute").replace(
                "</joint>", '<limit lower="-99" upper="99"/></joint>'
            ),
            [],
        ),
    ],
)
def test_how_wheels_turn(wheels: str, expected: list[str], tmp_path: Path) -> None:
    assert sorted(said(wheels, tmp_path)) == sorted(expected)


@pytest.mark.parametrize(
    ("sizes", "shape", "expected"),
    [
        (("0.4", "0.1"), ROUND, []),
        # A tenth of it either way, and three millimetres.
        (("0.44", "0.11"), ROUND, []),
        (("0.36", "0.09"), ROUND, []),
        (
            ("0.45", "0.1"),
            ROUND,
            ["warning wheel_separation is 0.45 m, but the wheels are 0.4 m apart"],
        ),
        (
            ("0.35", "0.1"),
            ROUND,
            ["warning wheel_separation is 0.35 m, but the wheels are 0.4 m apart"],
        ),
        (("0.4", "0.12"), ROUND, ["warning wheel_radius is 0.12 m, but the wheels have 0.1 m"]),
        (("0.4", "0.08"), ROUND, ["warning wheel_radius is 0.08 m, but the wheels have 0.1 m"]),
        (
            ("0.4", "0.12"),
            '<sphere radius="0.1"/>',
            ["warning wheel_radius is 0.12 m, but the wheels have 0.1 m"],
        ),
        # Nobody can tell the radius of a box or a mesh, and it may stand beside its joint.
        (("0.4", "0.3"), '<box size="0.2 0.04 0.2"/>', []),
        (("0.49", "0.1"), '<mesh filename="package://r/w.stl"/>', []),
        (
            ("0.52", "0.1"),
            '<mesh filename="package://r/w.stl"/>',
            ["warning wheel_separation is 0.52 m, but the wheels are 0.4 m apart"],
        ),
        (("a", "b"), ROUND, []),
        (("0", "-1"), ROUND, []),
    ],
)
def test_sizes_of_wheels(
    sizes: tuple[str, str], shape: str, expected: list[str], tmp_path: Path
) -> None:
    wheels = wheel("l", LEFT, shape=shape) + wheel("r", RIGHT, shape=shape)
    assert said(wheels, tmp_path, sizes) == expected


def test_a_sphere_has_its_radius_however_it_is_turned_and_a_cylinder_about_its_axis(
    tmp_path: Path,
) -> None:
    for shape, expected in (
        ('<sphere radius="0.1"/>', ["warning wheel_radius is 0.12 m, but the wheels have 0.1 m"]),
        (ROUND, [FLAT.format("l"), FLAT.format("r")]),
    ):
        wheels = wheel("l", LEFT, shape=shape, rpy="0 0 0") + wheel(
            "r", RIGHT, shape=shape, rpy="0 0 0"
        )
        assert said(wheels, tmp_path, ("0.4", "0.12")) == expected
