# SPDX-License-Identifier: Apache-2.0
"""Versions of URDF: what urdfdom 6 says of small files, and conversions that other programs measure."""

from __future__ import annotations

import importlib.util
import math
import random
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from lint_calls import Settings, fix, lint_data
from urdfdom_cases import (
    CHECK,
    INERTIA,
    JOINTS,
    LINKS,
    VERSIONS,
    check_urdf,
    joint,
    robot,
    turned,
    visual,
)

from multibot_rewrite.base.findings.finding import ERROR, Finding
from multibot_rewrite.base.releases import RELEASES
from multibot_rewrite.description.checks.poses import (
    matrix_of_quaternion,
    quaternion_of_rpy,
    rpy_of,
)

needs_check = pytest.mark.skipif(CHECK is None, reason="check_urdf is missing: pip install pin")
needs_pin = pytest.mark.skipif(
    importlib.util.find_spec("pinocchio") is None, reason="pinocchio is missing: pip install pin"
)
# Rules that say what urdfdom refuses, drops or warns of.
OF_URDFDOM = frozenset(f"MB{it}" for it in (115, 120, *range(124, 127), 128, 129, 509, 615))
# Warnings of these are of what other programs make of a file before URDF 1.2.
OF_OTHERS = ("MB125", "MB509")
EXACT = 1e-12


def linted(text: str, distro: str = "lyrical") -> list[Finding]:
    return lint_data("robot.urdf", text.encode(), Settings(distro=distro))


def codes(text: str, distro: str = "lyrical") -> set[str]:
    return {it.code for it in linted(text, distro)}


def fixed(text: str, distro: str = "lyrical") -> str:
    return fix("robot.urdf", text.encode(), Settings(distro=distro))[0].decode()


def complaints(text: str, version: str) -> list[Finding]:
    # That upper is below lower urdfdom only says in 1.2.
    judged = {*OF_URDFDOM, *(["MB511"] if version == "1.2" else [])}
    found = [it for it in linted(text) if it.code in judged]
    return [it for it in found if it.level == ERROR or it.code not in OF_OTHERS]


@pytest.mark.sample(1)
@needs_check
@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("case", JOINTS)
def test_joints_are_judged_as_urdfdom_does(case: str, version: str, tmp_path: Path) -> None:
    text = robot(version, JOINTS[case])
    said, found = check_urdf(text, tmp_path), complaints(text, version)
    assert said.complains == bool(found)
    assert said.reads == all(it.level != ERROR for it in found)


@pytest.mark.sample(1)
@needs_check
@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("case", LINKS)
def test_links_are_judged_as_urdfdom_does(case: str, version: str, tmp_path: Path) -> None:
    text = robot(version, LINKS[case])
    said = check_urdf(text, tmp_path)
    assert said.reads, "urdfdom drops what is in a link, and reads the rest"
    assert said.complains == bool(complaints(text, version))


@pytest.mark.parametrize(
    ("distro", "found"),
    [
        ("humble", {"MB133"}),
        ("jazzy", {"MB133"}),
        ("kilted", {"MB133"}),
        ("lyrical", {"MB135"}),
        ("rolling", set()),
    ],
)
def test_what_a_release_does_not_read(distro: str, found: set[str]) -> None:
    capsule = robot("1.1", visual('<capsule radius="1" length="2"/>'))
    assert codes(capsule, distro) & {"MB128", "MB133", "MB134", "MB135"} == found
    assert codes(robot("1.0", visual('<sphere radius="1"/>')), distro) == set()


@pytest.mark.parametrize("distro", RELEASES)
def test_a_limit_is_read_only_where_file_and_release_are_new(distro: str) -> None:
    jerk = JOINTS["jerk"]
    old = distro in ("humble", "jazzy", "kilted")
    assert ("MB129" in codes(robot("1.2", jerk), distro)) == old
    (found,) = [it for it in linted(robot("1.1", jerk), distro) if it.code == "MB129"]
    assert found.hint.startswith("delete it" if old else 'write version="1.2"')


def test_the_shape_of_a_capsule_is_a_matter_of_gazebo_alone() -> None:
    capsule = visual('<capsule radius="1" length="2"/>')
    assert "MB134" not in codes(robot("1.1", capsule))
    assert "MB134" in codes(robot("1.1", f'{capsule}<gazebo reference="a"/>'))
    assert "MB134" not in codes(robot("1.0", f'{capsule}<gazebo reference="a"/>'))


@pytest.mark.slow
@pytest.mark.skipif(
    importlib.util.find_spec("mujoco") is None, reason="mujoco is missing: pip install mujoco"
)
@pytest.mark.parametrize("quaternion", ["0 0 0.6 0.8", "0.5 -0.5 0.5 -0.5", "0 0 0.6 -80"])
def test_mujoco_reads_the_rotation_after_the_fix_alone(quaternion: str, here: Path) -> None:
    import mujoco  # takes half a second

    def turn(text: str) -> np.ndarray:
        model = mujoco.MjModel.from_xml_string(text)
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        return data.body("b").xmat.reshape(3, 3)

    heavy = f'<link name="b"><inertial>{INERTIA}</inertial></link>'
    text = robot("1.1", turned(f'quat_xyzw="{quaternion}"').replace('<link name="b"/>', heavy))
    x, y, z, w = map(float, quaternion.split())
    after = fix("r.urdf", text.encode(), Settings(targets=("mjcf",)))[0].decode()
    assert np.array_equal(turn(text), np.eye(3))
    assert np.abs(turn(after) - np.array(matrix_of_quaternion((x, y, z, w)))).max() <= EXACT


# ---------------------------------------------------------------- rotations


def near_the_pole(at: random.Random) -> tuple[float, float, float]:
    away = at.choice((0.0, 1e-17, 1e-15, 1e-9, 1e-8, 1e-7, 1e-5))
    pitch = at.choice((1, -1)) * (math.pi / 2 + at.choice((1, -1)) * away)
    return at.uniform(-4, 4), pitch, at.uniform(-4, 4)


@pytest.mark.more
def test_roll_pitch_and_yaw_of_any_quaternion_are_the_same_rotation() -> None:
    at = random.Random(3)
    free = [tuple(at.gauss(0, 1) for _ in range(4)) for _ in range(2000)]
    poles = [quaternion_of_rpy(near_the_pole(at)) for _ in range(2000)]
    rounded = [tuple(round(it, at.choice((2, 4, 9))) for it in one) for one in poles]
    for x, y, z, w in (*free, *poles, *rounded):
        matrix = np.array(matrix_of_quaternion((x, y, z, w)))
        back = np.array(matrix_of_quaternion(quaternion_of_rpy(rpy_of(matrix.tolist()))))
        assert np.abs(matrix - back).max() <= EXACT


# ---------------------------------------------------------------- conversions, measured by pinocchio


def numbers(at: random.Random, count: int) -> str:
    return " ".join(f"{at.uniform(-2, 2):.{at.choice((2, 6, 17))}g}" for _ in range(count))


def rotation(at: random.Random) -> str:
    if at.random() < 0.2:
        return f'rpy="{numbers(at, 3)}"'
    if at.random() < 0.3:
        pole = " ".join(map(repr, quaternion_of_rpy(near_the_pole(at))))
        return f'quat_xyzw="{pole}"'
    return f'quat_xyzw="{numbers(at, 4)}"'


def random_robot(seed: int, version: str) -> str:
    """Return a chain of links with turned joints, inertials and capsules."""
    at = random.Random(seed)
    parts = []
    for number in range(6):
        origin = f'<origin xyz="{numbers(at, 3)}" {rotation(at)}/>'
        inner = f'<origin xyz="{numbers(at, 3)}" {rotation(at)}/>'
        size = f'radius="{at.uniform(0.01, 1):.3f}" length="{at.uniform(0.01, 1):.3f}"'
        shape = at.choice(("capsule", "cylinder"))
        body = f"{inner}<geometry><{shape} {size}/></geometry>"
        parts.append(
            f'<link name="l{number}">\n'
            '  <inertial><origin xyz="0 0 1" quat_xyzw="0 0.6 0 0.8"/><mass value="2"/>'
            '<inertia ixx="1" ixy="0" ixz="0" iyy="2" iyz="0" izz="2.5"/></inertial>\n'
            f"  <visual>{body}</visual>\n  <collision>{body}</collision>\n"
            f"  <collision>{inner}<geometry><sphere radius='1'/></geometry></collision>\n</link>"
        )
        if number:
            ends = f'<parent link="l{number - 1}"/><child link="l{number}"/>'
            limits = '<limit lower="-1" upper="1" effort="1" velocity="1" jerk="3"/>'
            parts.append(
                f'<joint name="j{number}" type="revolute">{ends}{origin}'
                f'<axis xyz="0 0 1"/>{limits}</joint>'
            )
    return robot(version, "\n".join(parts))


def placements(text: str) -> tuple[dict[str, np.ndarray], list[np.ndarray]]:
    """Every frame for some angles of the joints, and every inertia, by urdfdom and pinocchio."""
    import pinocchio as pin  # takes half a second

    model = pin.buildModelFromXML(text)
    data = model.createData()
    pin.framesForwardKinematics(model, data, np.linspace(-0.9, 0.8, model.nq))
    frames = {it.name: pose.homogeneous for it, pose in zip(model.frames, data.oMf, strict=True)}
    return frames, [it.toDynamicParameters() for it in model.inertias]


def points(text: str) -> dict[tuple[str, str], list[tuple[Any, ...]]]:
    """Return the shapes of every link as pinocchio has them, a capsule as its three parts."""
    import pinocchio as pin

    model = pin.buildModelFromXML(text)
    found: dict[tuple[str, str], list[tuple[Any, ...]]] = {}
    for kind in ("VISUAL", "COLLISION"):
        whole = pin.buildGeomFromUrdfString(model, text, getattr(pin.GeometryType, kind))
        for it in whole.geometryObjects:
            link = it.name.rpartition("_")[0]
            found.setdefault((kind, link), []).extend(parts_of(it))
    return found


def parts_of(it: Any) -> Iterator[tuple[Any, ...]]:
    shape, at = it.geometry, it.placement
    name = type(shape).__name__
    if name == "Sphere":
        yield ("Sphere", shape.radius, at.translation)
        return
    yield ("Cylinder", shape.radius, shape.halfLength, at.homogeneous)
    if name == "Capsule":
        for side in (1, -1):
            middle = at.act(np.array([0, 0, side * shape.halfLength]))
            yield ("Sphere", shape.radius, middle)


def is_among(part: tuple[Any, ...], others: list[tuple[Any, ...]]) -> bool:
    def same(one: Any, other: Any) -> bool:
        if isinstance(one, str):
            return one == other
        return np.shape(one) == np.shape(other) and np.abs(one - other).max() <= EXACT

    return any(len(part) == len(it) and all(map(same, part, it)) for it in others)


@pytest.mark.more
@pytest.mark.sample(1)
@needs_pin
@pytest.mark.parametrize("version", ["1.1", "1.2"])
@pytest.mark.parametrize("seed", range(8))
def test_a_file_for_an_older_release_has_every_pose_and_shape(seed: int, version: str) -> None:
    before = random_robot(seed, version)
    after = fixed(before, "jazzy")
    assert 'version="1.0"' in after and "quat_xyzw" not in after and "capsule" not in after
    assert not codes(after, "jazzy") & {"MB128", "MB133"}
    (frames, inertias), (frames_after, inertias_after) = placements(before), placements(after)
    assert frames.keys() == frames_after.keys()
    assert all(np.abs(frames[it] - frames_after[it]).max() <= EXACT for it in frames)
    assert np.abs(np.array(inertias) - np.array(inertias_after)).max() <= 1e-11
    shapes, shapes_after = points(before), points(after)
    assert shapes.keys() == shapes_after.keys()
    for link, parts in shapes.items():
        assert len(parts) == len(shapes_after[link])
        assert all(is_among(it, shapes_after[link]) for it in parts)


@pytest.mark.slow
@needs_pin
@pytest.mark.parametrize("seed", range(4))
def test_a_rotation_that_was_ignored_is_the_one_that_is_written(seed: int) -> None:
    written = random_robot(seed, "1.1").replace("capsule", "cylinder")
    ignored = written.replace('version="1.1"', 'version="1.0"')
    for distro in RELEASES:
        after = fixed(ignored, distro)
        assert ('version="1.1"' in after) == (distro in ("lyrical", "rolling"))
        frames, frames_after = placements(written)[0], placements(after)[0]
        assert all(np.abs(frames[it] - frames_after[it]).max() <= EXACT for it in frames)


@pytest.mark.more
@needs_pin
def test_a_capsule_that_was_not_read_is_drawn_on_every_release() -> None:
    body = visual('<capsule length="0.4" radius="0.1"/>', '<origin xyz="1 0 0" rpy="0 0.5 0"/>')
    after = fixed(robot("1.0", body))
    assert 'version="1.0"' in after and codes(after) == set()
    (before,), (parts,) = points(robot("1.1", body)).values(), points(after).values()
    assert len(parts) == 3 and all(is_among(it, parts) for it in before)


# ---------------------------------------------------------------- what stays as it is


NOT_THE_SAME = {
    "no effort, which is endless in 1.2": joint('<limit lower="0" upper="1"/>'),
    "two rotations": turned('rpy="1 0 0" quat_xyzw="0 0 0 1"'),
    "four words": turned('quat_xyzw="a b c d"'),
    "a collision with a name": visual('<capsule length="1" radius="1"/>')
    .replace("<visual>", '<collision name="c">')
    .replace("</visual>", "</collision>"),
    "a capsule of length 0": visual('<capsule length="0" radius="1"/>'),
}


@pytest.mark.parametrize("case", NOT_THE_SAME)
def test_what_would_mean_something_else_is_not_converted(case: str) -> None:
    text = robot("1.2", NOT_THE_SAME[case])
    assert fixed(text, "jazzy") == text


def test_a_collision_that_a_sensor_names_keeps_its_capsule() -> None:
    body = visual('<capsule length="1" radius="1"/>').replace("visual", "collision")
    named = '<gazebo reference="a"><sensor><contact><collision>a_collision</collision></contact>'
    text = robot("1.1", f"{body}{named}</sensor></gazebo>")
    assert fixed(text) == text
    assert "capsule" not in fixed(robot("1.1", f"{body}<gazebo/>"))


def test_two_rotations_of_which_one_is_ignored_differ() -> None:
    text = robot("1.0", turned('rpy="1 0 0" quat_xyzw="0 0 0 1"'))
    assert fixed(text) == text
    same = robot("1.0", turned('rpy="0 0 0" quat_xyzw="0 0 0 1"'))
    assert fixed(same) == robot("1.0", turned('rpy="0 0 0"'))


def test_nearly_the_same_is_another_rotation() -> None:
    twice = robot("1.1", turned('rpy="0 0 0.001" quat_xyzw="0 0 0.00049999999 0.99999987"'))
    assert fixed(twice) == twice
    once = robot("1.1", turned('rpy="0 0 1" quat_xyzw="0 0 0.479425538604203 0.8775825618903728"'))
    assert "rpy" not in fixed(once)


def test_a_quaternion_without_a_length_is_no_rotation() -> None:
    zeros = robot("1.1", turned('quat_xyzw="0 0 0 0"'))
    assert "MB127" in codes(zeros)
    assert fixed(zeros, "jazzy") == robot("1.0", turned('rpy="0 0 0"'))
    large = robot("1.1", turned('quat_xyzw="1e200 0 0 1e200"'))
    assert fixed(large, "jazzy") == robot("1.0", turned('rpy="0 0 0"'))
    assert "MB127" not in codes(robot("1.0", turned('quat_xyzw="0 0 0 0"')))


def test_quotes_line_ends_and_comments_stay() -> None:
    body = (
        "<link name='a'>\r\n\t<visual><!-- </link> -->\r\n"
        "\t\t<origin\r\n quat_xyzw = '0 0 1 0' xyz='1 2 3' />\r\n"
        "\t\t<geometry><capsule radius='1' length='2'></capsule></geometry>"
        "<material name='m'><color rgba='1 0 0 1'/></material>\r\n"
        "\t</visual>\r\n\t<!-- </link> -->\r\n</link>"
    )
    material = "<material name='m'><color rgba='1 0 0 1'/></material></visual>\r\n"
    sphere = '\t<visual><origin xyz="1 2 {}"/><geometry><sphere radius="1"/></geometry>' + material
    after = (
        body.replace("quat_xyzw = '0 0 1 0'", f"rpy='0 0 {math.pi!r}'")
        .replace("<capsule", "<cylinder")
        .replace("</capsule", "</cylinder")
    )
    end = after.rindex("</link>")
    expected = after[:end] + sphere.format(4) + sphere.format(2) + after[end:]
    assert fixed(robot("1.1", body), "jazzy") == robot("1.0", expected)
