# SPDX-License-Identifier: Apache-2.0
"""MB7: which files are looked for where, and how they may be named.

Of ``rules/description/meshes``: boxes, lookup, paths, shared.
"""

from __future__ import annotations

import re
from pathlib import Path
from struct import pack

import pytest
from lint_calls import Settings, lint_file

from multibot_rewrite.description.sources import packages
from multibot_rewrite.rules.description.meshes.lookup import mesh_box


def manifest(folder: Path, name: str) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "package.xml").write_text(f"<package><name> {name} </name></package>")
    return folder


@pytest.fixture
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a package ``arm`` with the description, one called otherwise than its folder, and a
    folder without a manifest."""
    monkeypatch.delenv("ROS_PACKAGE_PATH", raising=False)
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)
    for folder in (
        manifest(tmp_path / "src/arm", "arm"),
        manifest(tmp_path / "src/deep/er/hand-1.0", "hand"),
        tmp_path / "src/plain",
    ):
        (folder / "meshes").mkdir(parents=True)
        (folder / "meshes/Base.stl").write_text("solid")
        (folder / "meshes/a b.stl").write_text("solid")
    (tmp_path / "src/arm/urdf").mkdir()
    return tmp_path


def linted(workspace: Path, *names: str, select: str = "MB7", roots: bool = True) -> list[str]:
    meshes = "".join(
        f'<link name="l{at}"><visual><geometry><mesh filename="{name}"/></geometry></visual></link>'
        for at, name in enumerate(names)
    )
    file = workspace / "src/arm/urdf/r.urdf"
    file.write_text(f'<robot name="r">{meshes}</robot>')
    given = (str(workspace),) if roots else ()
    found = lint_file(str(file), Settings(select=tuple(select.split()), roots=given))
    return [it.code for it in found]


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("package://arm/meshes/Base.stl", []),
        ("package://arm/meshes/a b.stl", []),
        ("package://arm/meshes/a%20b.stl", []),
        ("package://arm/meshes/../meshes/Base.stl", []),
        ("package://arm//meshes/Base.stl", []),
        ("package://arm/meshes/base.stl", ["MB703"]),
        ("package://arm/Meshes/Base.stl", ["MB703"]),
        ("package://arm/meshes/Bass.stl", ["MB701"]),
        ("package://arm/elsewhere/Base.stl", ["MB701"]),
        # The name is the manifest's, not the folder's.
        ("package://hand/meshes/Base.stl", []),
        ("package://hand-1.0/meshes/Base.stl", ["MB702"]),
        ("package://plain/meshes/Base.stl", []),
        ("package://plain/meshes/Bass.stl", ["MB701"]),
        # A folder that only is called so.
        ("package://plain/models/Base.stl", ["MB702"]),
        ("package://leg/meshes/Base.stl", ["MB702"]),
        ("package://arm", ["MB707"]),
        ("package://", ["MB707"]),
        ("../meshes/Base.stl", []),
        ("meshes/Base.stl", []),
        ("../meshes/base.stl", ["MB703"]),
        ("Base.stl", ["MB713"]),
        ("../../meshes/Base.stl", ["MB713"]),
        ("Bass.stl", ["MB701"]),
        ("file:///home/me/Base.stl", ["MB704"]),
        ("file:/home/me/Base.stl", ["MB704"]),
        ("/home/me/Base.stl", ["MB704"]),
        ("C:\\me\\Base.stl", ["MB704", "MB705"]),
        (r"package://arm\meshes\Base.stl", ["MB705"]),
        ("model://arm/meshes/Base.stl", ["MB710"]),
        ("https://example.org/Base.stl", ["MB711"]),
        ("file://$(find arm)/meshes/Base.stl", ["MB712"]),
        ("${mesh}", []),
        ("", ["MB706"]),
        ("  ", ["MB706"]),
        ("package://arm/meshes/Base.step", ["MB701", "MB707"]),
        ("package://leg/a.STL", ["MB702"]),
        ("package://leg/a.glb", ["MB702", "MB708"]),
        ("package://leg/a", ["MB702", "MB707"]),
        ("package://leg/v1.2/a", ["MB702", "MB707"]),
    ],
)
def test_one_mesh(name: str, expected: list[str], workspace: Path) -> None:
    assert sorted(linted(workspace, name)) == expected


PLACED = "write package://NAME/..."
LOADED = "use .stl, .dae or .obj"
MILLIMETRES = 'add scale="0.001 0.001 0.001"'
SAID = {
    "package://arm/Meshes/base.stl": [
        "MB703 error 'Meshes/base.stl' is 'meshes/Base.stl' on the disk; use 'meshes/Base.stl'",
    ],
    "package://arm/meshes/Bass.stl": [
        "MB701 error 'package://arm/meshes/Bass.stl' does not exist; did you mean 'Base.stl'?",
    ],
    # A package is told once.
    "package://leg/meshes/a.stl package://leg/b/c.stl": [
        "MB702 note package 'leg' was not found; give its folder with --roots",
    ],
    "package://arm": [f"MB707 warning 'package://arm': it has no extension; {LOADED}"],
    "package://leg/a.step": [
        "MB702 note package 'leg' was not found; give its folder with --roots",
        f"MB707 warning 'package://leg/a.step': no program can load .step; {LOADED}",
    ],
    "package://leg/a.glb": [
        "MB702 note package 'leg' was not found; give its folder with --roots",
        "MB708 note 'package://leg/a.glb': Gazebo Classic and gz before Garden cannot read glTF;"
        f" {LOADED}",
    ],
    "Base.stl": [
        "MB713 note 'Base.stl' is not next to this file; use package://arm/meshes/Base.stl",
    ],
    "/home/me/Base.stl file:///home/me/Bass.stl": [
        f"MB704 warning '/home/me/Base.stl' is a path of one machine (and 1 more); {PLACED}",
    ],
    r"package://arm\meshes\Base.stl": [
        r"MB705 warning 'package://arm\\meshes\\Base.stl' has backslashes; write"
        " 'package://arm/meshes/Base.stl'",
    ],
    "model://arm/meshes/Base.stl": [
        "MB710 warning RViz cannot load 'model://arm/meshes/Base.stl'; write package://",
    ],
    "https://example.org/Base.stl": [
        "MB711 note 'https://example.org/Base.stl' needs the network; put it into a package",
    ],
    "": [
        "MB706 error <mesh> has an empty file name; add the file name, or remove the visual or"
        " collision",
    ],
    "package://arm/meshes/a.dae": [
        "MB714 warning 'package://arm/meshes/a.dae' is 300 m long; correct <unit meter> in the file,"
        f" or {MILLIMETRES}",
    ],
    "package://arm/meshes/a.stl package://arm/meshes/a.stl": [
        "MB714 warning 'package://arm/meshes/a.stl' is 300 m long; are these millimetres?"
        f" {MILLIMETRES}",
    ],
}


@pytest.mark.parametrize("names", SAID)
def test_what_is_said_of_meshes(names: str, workspace: Path) -> None:
    (workspace / "src/arm/meshes/a.dae").write_bytes(collada(unit="100"))
    (workspace / "src/arm/meshes/a.stl").write_bytes(binary_stl(*SIDES))
    text = "".join(
        f'<link name="l{at}"><visual><geometry><mesh filename="{name}"/></geometry></visual></link>'
        for at, name in enumerate(names.split(" "))
    )
    text = f'<robot name="r">{text}</robot>'
    file = workspace / "src/arm/urdf/r.urdf"
    file.write_text(text)
    found = lint_file(str(file), Settings(select=("MB7",), roots=(str(workspace),)))
    assert [f"{it.code} {it.level} {it.message}; {it.hint}" for it in found] == SAID[names]
    assert {text[it.column - 1 :].partition("=")[0] for it in found} == {"filename"}


def test_what_is_wrong_in_many_places_is_told_once(workspace: Path) -> None:
    names = [f"package://leg/{at}.glb" for at in range(5)]
    assert sorted(linted(workspace, *names)) == ["MB702", "MB708"]
    assert linted(workspace, *[f"/home/me/{at}.stl" for at in range(5)]) == ["MB704"]
    assert linted(workspace, *["package://arm/meshes/No.stl"] * 5) == ["MB701"]
    # The folder is there, or it is missing with all that should be in it.
    assert linted(workspace, *[f"package://arm/meshes/{at}.stl" for at in "xy"]) == ["MB701"] * 2
    assert linted(workspace, *[f"package://arm/visual/{at}.stl" for at in "xy"]) == ["MB701"]
    assert linted(workspace, "../visual/x.stl", "../visual/y.stl", "../hard/x.stl") == ["MB701"] * 2


def test_mixed_schemes(workspace: Path) -> None:
    good = "package://arm/meshes/Base.stl"
    assert linted(workspace, good, good, select="MB709") == []
    assert linted(workspace, good, "../meshes/Base.stl", "model://a/b.stl", select="MB709") == [
        "MB709"
    ]


def test_the_search_ends(workspace: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for at in range(30):
        (workspace / f"src/many/{at}").mkdir(parents=True)
    (workspace / "src/many/0/loop").symlink_to(workspace)
    manifest(workspace / "a/b/c/d/e", "too_deep")
    manifest(workspace / "src/.hidden", "hidden")
    manifest(workspace / "src/build/built", "built")
    for name in ("too_deep", "hidden", "built"):
        assert linted(workspace, f"package://{name}/a.stl") == ["MB702"]
    monkeypatch.setattr(packages, "MOST_FOLDERS", 3)
    packages.packages_below.cache_clear()
    assert len(list(packages._folders((str(workspace),)))) == 3


def test_a_mesh_of_sdf_has_a_uri(workspace: Path) -> None:
    file = workspace / "r.urdf"
    geometry = "<geometry><mesh>{}</mesh></geometry>"
    file.write_text(
        f'<robot name="r"><link name="a"><visual>{geometry.format("")}</visual></link>'
        f"<gazebo><link><visual>{geometry.format('<uri>model://a/b.stl</uri>')}</visual></link>"
        f"<visual>{geometry.format('')}</visual></gazebo></robot>"
    )
    found = lint_file(str(file), Settings(select=("MB706",)))
    assert [it.code for it in found] == ["MB706"]


# ---------------------------------------------------------------- how large they are

SIDES = (300.0, 200.0, 100.0)


def binary_stl(x: float, y: float, z: float) -> bytes:
    """Two triangles from the origin to a corner."""
    corners = (0, 0, 0, x, 0, 0, x, y, 0), (0, 0, 0, x, y, z, 0, y, z)
    triangles = [pack("<12f2x", 0, 0, 1, *it) for it in corners]
    return b"solid by chance".ljust(80) + pack("<I", 2) + b"".join(triangles)


def obj(x: float, y: float, z: float) -> bytes:
    return f"# v 9 9 9\nvn 0 0 1\nv 0 0 0\nv {x} {y} {z} 1.0\nf 1 2 1\n".encode()


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("a.dae", b"<COLLADA/>"),
        ("a.stl", b""),
        ("a.stl", b"solid"),
        ("a.stl", binary_stl(*SIDES)[:-1]),
        ("a.stl", binary_stl(1, 2, float("nan"))),
        ("a.stl", binary_stl(1, 2, float("inf"))),
        ("a.obj", b"v 1 2\nv . . .\n"),
    ],
)
def test_what_cannot_be_measured_has_no_box(tmp_path: Path, name: str, data: bytes) -> None:
    (tmp_path / name).write_bytes(data)
    assert mesh_box(str(tmp_path / name)) is None


@pytest.mark.parametrize(("more", "known"), [(0, True), (1, False)])
def test_a_mesh_is_read_up_to_four_megabytes(more: int, known: bool, tmp_path: Path) -> None:
    file = tmp_path / "a.obj"
    file.write_bytes(obj(*SIDES).ljust(4 * 2**20 + more))
    assert (mesh_box(str(file)) is not None) == known
    assert mesh_box(str(file), whole=False) == ((0.0, 0.0, 0.0), SIDES)


CUBE = """<geometry id="cube"><mesh>
<source id="at"><float_array count="9">0 0 0 1 2 3 -1 0 0</float_array>
<technique_common><accessor source="#array" stride="3"/></technique_common></source>
<source id="normals"><float_array count="3">90 90 90</float_array></source>
<vertices id="all"><input semantic="POSITION" source="#at"/></vertices></mesh></geometry>"""
SHOWN = '<instance_geometry url="#cube"/>'
NODES = f'<library_nodes><node id="far"><scale>2 2 2</scale>{SHOWN}</node></library_nodes>'


def collada(scene: str = SHOWN, unit: str = "1", beside: str = "", above: str = "") -> bytes:
    return f"""{above}<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="u" meter="{unit}"/><up_axis>Y_UP</up_axis></asset>
<library_geometries>{CUBE}</library_geometries>{beside}
<library_visual_scenes><visual_scene id="s"><node id="n">{scene}</node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>""".encode()


@pytest.mark.parametrize(
    ("data", "low", "high"),
    [
        (collada(), (-1, 0, 0), (1, 2, 3)),
        (
            collada()
            .replace(b'stride="3"', b'stride="4" offset="1"')
            .replace(b"0 0 0 1 2 3 -1 0 0", b"9 1 2 3 9 4 5 6"),
            (1, 2, 3),
            (4, 5, 6),
        ),
        (re.sub(rb"(?s)<technique_common>.*?</technique_common>", b"", collada()),
         (-1, 0, 0), (1, 2, 3)),
        (collada(f"<matrix>1 1 0 0 0 1 0 0 0 0 1 2 0 0 0 1</matrix>{SHOWN}"), (-1, 0, 2), (3, 2, 5)),
        (collada(unit="0.001"), (-0.001, 0, 0), (0.001, 0.002, 0.003)),
        (collada(f"<translate>1 0 0</translate>{SHOWN}", "0.1"), (0, 0, 0), (0.2, 0.2, 0.3)),
        (collada(f"<scale>2 -1 1</scale>{SHOWN}"), (-2, -2, 0), (2, 0, 3)),
        (collada(f"<rotate>0 0 2 90</rotate>{SHOWN}"), (-2, -1, 0), (0, 1, 3)),
        (collada(f"<rotate>0 0 1 45</rotate>{SHOWN}"), (-0.7071, -0.7071, 0), (0, 2.1213, 3)),
        (
            collada(f"<translate>10 0 0</translate><rotate>0 0 1 90</rotate>{SHOWN}"),
            (8, -1, 0),
            (10, 1, 3),
        ),
        (
            collada(f"<matrix>0 0 1 5 1 0 0 0 0 1 0 0 0 0 0 1</matrix>{SHOWN}"),
            (5, -1, 0),
            (8, 1, 2),
        ),
        (
            collada(f'{SHOWN}<node><translate>0 0 7</translate>{SHOWN}</node>'),
            (-1, 0, 0),
            (1, 2, 10),
        ),
        (
            collada(
                '<translate>1 1 1</translate><instance_node url="#far"/>',
                beside=NODES,
            ),
            (-1, 1, 1),
            (3, 5, 7),
        ),
        (
            collada(beside=NODES),
            (-1, 0, 0),
            (1, 2, 3),
        ),
    ],
)  # fmt: skip
def test_the_box_around_a_collada_scene(
    tmp_path: Path, data: bytes, low: tuple[float, ...], high: tuple[float, ...]
) -> None:
    """Whatever the axis is that points up: RViz and Gazebo do not turn the scene."""
    file = tmp_path / "a.dae"
    file.write_bytes(data)
    box = mesh_box(str(file), whole=False)
    assert box is not None
    assert (box.low, box.high) == (pytest.approx(low, abs=1e-4), pytest.approx(high, abs=1e-4))


BOMB = '<!DOCTYPE a [<!ENTITY a "1 2 3 "><!ENTITY b "%s">]>' % ("&a;" * 10)


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    "data",
    [
        collada(""),
        collada('<instance_geometry url="#other"/>'),
        collada('<instance_geometry url="other.dae#cube"/>'),
        collada('<instance_geometry url="/cube"/>'),
        collada('<instance_controller url="#skin"/>'),
        collada(f"<lookat>0 0 0 1 0 0 0 0 1</lookat>{SHOWN}"),
        collada(f"<translate>0 0</translate>{SHOWN}"),
        collada(f"<matrix>1 0 0</matrix>{SHOWN}"),
        collada(f"<rotate>0 0 1 nan</rotate>{SHOWN}"),
        collada(f"{SHOWN}" + '<instance_node url="#n"/>'),
        collada("<node>" * 400 + SHOWN + "</node>" * 400),
        collada("".join(f'<node id="m{at}">' + f'<instance_node url="#m{at + 1}"/>' * 9 + "</node>"
                        for at in range(9)) + f'<node id="m9">{SHOWN}</node>'),
        collada(f"<scale>&b; 1 1</scale>{SHOWN}", above=BOMB),
        collada(unit="one"),
        collada().replace(b'url="#s"', b'url="#t"'),
        collada().replace(b"1 2 3", b"1 two 3"),
        collada().replace(b"1 2 3", b"1 2 inf"),
        collada()[:-20],
        b"version https://git-lfs.github.com/spec/v1\n",
    ],
)  # fmt: skip
def test_a_collada_scene_that_cannot_be_measured_has_no_box(tmp_path: Path, data: bytes) -> None:
    (tmp_path / "a.dae").write_bytes(data)
    assert mesh_box(str(tmp_path / "a.dae")) is None


@pytest.mark.parametrize(
    ("data", "scale", "expected"),
    [
        (binary_stl(*SIDES), "", ["MB714"]),
        (binary_stl(*SIDES), 'scale="0.001 0.001 0.001"', []),
        (binary_stl(0.3, 0.2, 0.1), "", []),
        (binary_stl(0.3, 0.2, 0.1), 'scale="1000 -1000 1000"', ["MB714"]),
        (binary_stl(300, 1, 1), "", []),
        (binary_stl(40, 40, 40), "", []),
    ],
)
def test_a_mesh_in_millimetres(
    data: bytes, scale: str, expected: list[str], workspace: Path
) -> None:
    (workspace / "src/arm/meshes/Base.stl").write_bytes(data)
    name = f'package://arm/meshes/Base.stl" {scale} x="'
    assert linted(workspace, name, name, select="MB714") == expected
    absolute = workspace / "src/arm/meshes/Base.stl"
    assert linted(workspace, f'file://{absolute}" {scale} x="', select="MB714") == expected


@pytest.mark.parametrize(
    ("xyz", "expected"), [("0 0 0", []), ("-0.15 0.25 0.1", []), ("0.15 0 0", ["MB631"])]
)
def test_a_collision_away_from_a_mesh(xyz: str, expected: list[str], workspace: Path) -> None:
    (workspace / "src/arm/meshes/Base.stl").write_bytes(binary_stl(300, 200, 100))
    mesh = '<mesh filename="package://arm/meshes/Base.stl" scale="0.001 0.001 0.001"/>'
    turned = '<origin rpy="0 0 1.5708"/>'
    file = workspace / "src/arm/urdf/r.urdf"
    file.write_text(
        f'<robot name="r"><link name="a"><visual>{turned}<geometry>{mesh}</geometry></visual>'
        f'<collision><origin xyz="{xyz}"/><geometry><box size="0.1 0.1 0.1"/></geometry>'
        "</collision></link></robot>"
    )
    found = lint_file(str(file), Settings(select=("MB631",), roots=(str(workspace),)))
    assert [it.code for it in found] == expected
