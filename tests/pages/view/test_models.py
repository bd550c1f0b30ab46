# SPDX-License-Identifier: Apache-2.0
"""What the view takes from a URDF and from the files of meshes."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest
from lxml import etree
from paths import ROBOTS, ROOT, fixture_text

from multibot_rewrite.base.model import InputError
from multibot_rewrite.pages.view import models
from multibot_rewrite.pages.view.models import (
    MOST_BYTES,
    Mesh,
    Model,
    find_mesh,
    load_mesh,
    load_urdf,
)

IDENTITY = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
CORNERS = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0)
PLY = fixture_text("models_ply.txt")
COLOURS = "".join(f"property uchar {it}\n" for it in ("red", "green", "blue"))


def load(inner: str) -> Model:
    return load_urdf(etree.fromstring(f'<robot name="r">{inner}</robot>'), "/nowhere/r.urdf")


def shapes(geometry: str, more: str = "") -> list[tuple[object, ...]]:
    visual = f"<visual><geometry>{geometry}</geometry>{more}</visual>"
    colour = '<material name="red"><color rgba="1 0 0 0.5"/></material>'
    return [
        (it.kind, it.size, it.colour)
        for it in load(f'{colour}<link name="a">{visual}</link>').links["a"]
    ]


@pytest.mark.parametrize(
    ("geometry", "kind", "size"),
    [
        ('<box size="1 2 3"/>', "box", (1, 2, 3)),
        ('<cylinder radius="0.5" length="2"/>', "cylinder", (0.5, 2)),
        ('<sphere radius="0.5"/>', "sphere", (0.5,)),
        ('<capsule radius="0.5" length="2"/>', "cylinder", (0.5, 2)),
        ('<mesh filename="none.stl"/>', "box", (0.1, 0.1, 0.1)),
    ],
)
def test_a_shape_of_each_kind(geometry: str, kind: str, size: tuple[float, ...]) -> None:
    assert shapes(geometry) == [(kind, size, ())]
    assert shapes(geometry, '<material name="red"/>') == [(kind, size, (1, 0, 0, 0.5))]
    assert shapes(geometry, '<material name="none"/>') == [(kind, size, ())]
    own = '<material name="red"><color rgba="0 0 1 1"/></material>'
    assert shapes(geometry, own) == [(kind, size, (0, 0, 1, 1))]


def test_a_mesh_that_is_not_there_is_said() -> None:
    model = load(
        '<link name="a"><visual><geometry><mesh filename="b/none.stl"/></geometry></visual></link>'
    )
    (shape,) = model.links["a"]
    assert (shape.mesh, shape.missing) == ("", "b/none.stl is not found")
    assert [list(it) for it in shape.pose] == IDENTITY


@pytest.mark.parametrize(("scale", "size"), [("", (1, 1, 1)), ('scale="2 3 4"', (2, 3, 4))])
def test_a_mesh_has_its_scale(scale: str, size: tuple[float, ...], tmp_path: Path) -> None:
    (tmp_path / "a.stl").write_bytes(b"")
    geometry = f'<geometry><mesh filename="a.stl" {scale}/></geometry>'
    text = f'<robot name="r"><link name="a"><visual>{geometry}</visual></link></robot>'
    (shape,) = load_urdf(etree.fromstring(text), str(tmp_path / "r.urdf")).links["a"]
    assert (shape.kind, shape.size, shape.mesh) == ("mesh", size, str(tmp_path / "a.stl"))


JOINTS = [
    ("revolute", '<limit lower="-1" upper="0.5" effort="1" velocity="1"/>', -1, 0.5),
    ("revolute", '<limit effort="1" velocity="1"/>', 0, 0),
    ("prismatic", '<limit lower="-2" upper="3" effort="1" velocity="1"/>', -2, 3),
    ("continuous", '<limit lower="-1" upper="0.5" effort="1" velocity="1"/>', -3.1416, 3.1416),
    ("fixed", '<limit lower="-1" upper="0.5" effort="1" velocity="1"/>', 0, 0),
]


@pytest.mark.parametrize(("kind", "limit", "lower", "upper"), JOINTS)
def test_a_joint_moves_within_its_limits(kind: str, limit: str, lower: float, upper: float) -> None:
    ends = '<parent link="a"/><child link="b"/>'
    (joint,) = load(
        f'<link name="a"/><link name="b"/><joint name="j" type="{kind}">{ends}{limit}</joint>'
    ).joints
    assert (joint.name, joint.type, joint.parent, joint.child) == ("j", kind, "a", "b")
    assert (joint.lower, joint.upper, joint.mimic) == (lower, upper, None)
    assert joint.axis == (1, 0, 0) and [list(it) for it in joint.pose] == IDENTITY


@pytest.mark.parametrize(
    ("words", "mimic"),
    [("", ("k", 1, 0)), ('multiplier="2"', ("k", 2, 0)), ('offset="0.5"', ("k", 1, 0.5)),
     ('multiplier="0"', ("k", 0, 0))],
)  # fmt: skip
def test_a_joint_follows_another(words: str, mimic: tuple[object, ...]) -> None:
    ends = '<parent link="a"/><child link="b"/><axis xyz="0 1 0"/><origin xyz="1 2 3"/>'
    text = f'<joint name="j" type="revolute">{ends}<mimic joint="k" {words}/></joint>'
    (joint,) = load(f'<link name="a"/><link name="b"/>{text}').joints
    assert (joint.mimic, joint.axis) == (mimic, (0, 1, 0))
    assert [row[3] for row in joint.pose] == [1, 2, 3, 1]


def test_a_fault_that_nobody_sees_is_none_of_the_picture() -> None:
    broken = "<inertial><mass/></inertial><collision><geometry/></collision><visual/>"
    assert load(f'<link name="a">{broken}</link>').links == {"a": ()}


def test_a_joint_without_its_link_and_a_mesh_that_is_not_there_are_read() -> None:
    joint = '<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>'
    link = '<link name="a"><visual><geometry><mesh filename="no.stl"/></geometry></visual></link>'
    model = load(link + joint)
    assert (model.links["a"][0].missing, model.joints[0].child) == ("no.stl is not found", "b")


@pytest.mark.parametrize(
    "shape", [*(f'<sphere radius="{it}"/>' for it in ("", "x", "nan", "1 2")), '<box size="1 2"/>']
)
def test_a_urdf_that_yourdfpy_does_not_read_is_named(shape: str) -> None:
    with pytest.raises(InputError, match=r"/nowhere/r\.urdf: yourdfpy cannot read it: .*urdf-lint"):
        shapes(shape)


@pytest.mark.more
@pytest.mark.parametrize(
    "path", [*sorted(ROBOTS.glob("*.urdf")), *sorted(ROOT.glob("examples/*/*.urdf"))], ids=str
)
def test_a_robot_is_as_yourdfpy_reads_it(path: Path) -> None:
    """Where each joint is, what it turns about and how far, and what each link looks like."""
    yourdfpy = pytest.importorskip("yourdfpy")
    off = {"build_scene_graph": False, "load_meshes": False}
    robot = yourdfpy.URDF.load(str(path), **off).robot
    model = load_urdf(etree.parse(path).getroot(), str(path))
    joints = {it.name: it for it in model.joints}
    assert joints.keys() == {it.name for it in robot.joints}
    for it in robot.joints:
        own, moves = joints[it.name], it.type in ("revolute", "prismatic")
        assert (own.type, own.parent, own.child) == (it.type, it.parent, it.child)
        assert np.allclose(own.pose, np.eye(4) if it.origin is None else it.origin)
        assert np.allclose(own.axis, (1, 0, 0) if it.axis is None else it.axis)
        limits = (it.limit.lower, it.limit.upper) if moves else (own.lower, own.upper)
        assert (own.lower, own.upper) == limits
        assert (own.mimic or ("",))[0] == (it.mimic.joint if it.mimic else "")
    for link in robot.links:
        assert len(model.links[link.name]) == len(link.visuals)
        for shape, visual in zip(model.links[link.name], link.visuals, strict=True):
            assert np.allclose(shape.pose, np.eye(4) if visual.origin is None else visual.origin)


def test_meshes_are_looked_for_as_ros_does(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        models, "package_folder", lambda name, *_: str(tmp_path) if name == "p" else ""
    )
    (tmp_path / "meshes").mkdir()
    mesh = tmp_path / "meshes" / "a.stl"
    mesh.write_bytes(b"")
    source = str(tmp_path / "r.urdf")
    for name in (
        "package://p/meshes/a.stl",
        "model://p/meshes/a.stl",
        f"file://{mesh}",
        "meshes/a.stl",
    ):
        assert find_mesh(name, source) == str(mesh), name
    others = (
        "package://q/meshes/a.stl",
        "package://p/meshes",
        "package://p",
        "file://a",
        "b.stl",
        "",
    )
    assert {find_mesh(it, source) for it in others} == {""}
    odd = tmp_path / "odd:"
    odd.mkdir()
    (odd / "b.stl").write_bytes(b"")
    assert find_mesh("package://p/odd://b.stl", source) == f"{tmp_path}/odd://b.stl"


def written(path: Path, data: str | bytes) -> str:
    path.write_bytes(data if isinstance(data, bytes) else data.encode())
    return str(path)


@pytest.mark.more
def test_a_mesh_is_its_corners_and_triangles(tmp_path: Path) -> None:
    plain = load_mesh(written(tmp_path / "a.ply", PLY.format("", "", "", colours="")))
    assert isinstance(plain, Mesh)
    assert struct.unpack("<9f", plain.vertices) == CORNERS
    assert struct.unpack("<3I", plain.faces) == (0, 1, 2) and plain.colours == b""
    rows = (" 255 0 0", " 0 255 0", " 1 2 3")
    made = load_mesh(written(tmp_path / "b.ply", PLY.format(*rows, colours=COLOURS)))
    assert isinstance(made, Mesh) and made.colours == bytes((255, 0, 0, 0, 255, 0, 1, 2, 3))
    # Corners of the same place stay two: a format may give each a colour of its own.
    twice = PLY.replace("vertex 3", "vertex 6").replace("face 1", "face 2")
    twice = twice.replace("3 0 1 2\n", "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 3 4 5\n")
    same = load_mesh(written(tmp_path / "c.ply", twice.format("", "", "", colours="")))
    assert isinstance(same, Mesh) and len(same.vertices) == 2 * len(plain.vertices)


@pytest.mark.more
def test_a_mesh_has_the_colour_of_its_material(tmp_path: Path) -> None:
    (tmp_path / "a.mtl").write_text("newmtl m\nKd 1 0 0\n")
    text = "mtllib a.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
    made = load_mesh(written(tmp_path / "a.obj", text))
    assert isinstance(made, Mesh) and made.colours == bytes((255, 0, 0)) * 3


@pytest.mark.more
def test_what_is_no_mesh_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert str(load_mesh(str(tmp_path / "none.stl"))).startswith("none.stl: ")
    points = PLY.replace("face 1", "face 0").replace("3 0 1 2\n", "")
    assert load_mesh(written(tmp_path / "p.ply", points.format("", "", "", colours=""))) == (
        "p.ply has no triangles"
    )
    path = written(tmp_path / "a.ply", PLY.format("", "", "", colours=""))
    monkeypatch.setattr(models, "MOST_FACES", 1)
    whole = load_mesh(path)
    assert isinstance(whole, Mesh) and len(whole.faces) == 12
    monkeypatch.setattr(models, "MOST_FACES", 0)
    box = load_mesh(path)
    assert isinstance(box, Mesh) and len(box.faces) == 12 * 12


@pytest.mark.more
def test_a_mesh_that_is_too_large_is_not_read(tmp_path: Path) -> None:
    with (tmp_path / "a.stl").open("wb") as file:
        file.truncate(MOST_BYTES + 1)
    assert load_mesh(str(tmp_path / "a.stl")) == "a.stl is larger than 256 MiB"
