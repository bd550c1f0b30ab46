"""MB7: which files are looked for where, and how they may be named."""

from __future__ import annotations

from os import mkfifo
from pathlib import Path
from struct import pack

import pytest

from multibot_rewrite.checks.mesh_box import mesh_box
from multibot_rewrite.lint.check import lint_file
from multibot_rewrite.lint.config.settings import Settings
from multibot_rewrite.sources import packages


def manifest(folder: Path, name: str) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "package.xml").write_text(f"<package><name> {name} </name></package>")
    return folder


@pytest.fixture
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A package ``arm`` with the description, one called otherwise than its folder, and a folder
    without a manifest."""
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


def test_its_own_package_is_found_without_roots(workspace: Path) -> None:
    name = "package://arm/meshes/{}.stl"
    assert linted(workspace, name.format("Base"), name.format("No"), roots=False) == ["MB701"]
    assert linted(workspace, "package://hand/meshes/No.stl", roots=False) == ["MB702"]


def test_packages_of_the_environment(workspace: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    manifest(workspace / "install/leg/share/leg", "leg")
    monkeypatch.setenv("AMENT_PREFIX_PATH", f"{workspace}/install/leg:/nowhere")
    assert linted(workspace, "package://leg/a.stl", roots=False) == ["MB701"]
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(workspace / "src/deep"))
    assert linted(workspace, "package://hand/meshes/Base.stl", roots=False) == []


def test_a_package_that_is_there_twice_is_searched_twice(workspace: Path) -> None:
    other = manifest(workspace / "src/copy/hand", "hand")
    (other / "new.stl").write_text("solid")
    assert linted(workspace, "package://hand/new.stl", "package://hand/meshes/Base.stl") == []


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
    packages._below.cache_clear()
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


def text_stl(x: float, y: float, z: float) -> bytes:
    corners = "".join(f"vertex {it}\n" for it in ("0 0 0", f"{x:e} 0 0", f"{x} {y} {z}"))
    return f"solid a\nfacet normal 0 0 1\nouter loop\n{corners}endloop\nendfacet\n".encode()


def obj(x: float, y: float, z: float) -> bytes:
    return f"# v 9 9 9\nvn 0 0 1\nv 0 0 0\nv {x} {y} {z} 1.0\nf 1 2 1\n".encode()


@pytest.mark.parametrize(
    ("name", "data"),
    [("a.stl", binary_stl(*SIDES)), ("a.STL", text_stl(*SIDES)), ("a.obj", obj(*SIDES))],
)
def test_the_box_around_a_mesh(tmp_path: Path, name: str, data: bytes) -> None:
    file = tmp_path / name
    file.write_bytes(data)
    for whole in (True, False):
        assert mesh_box(str(file), whole) == ((0.0, 0.0, 0.0), SIDES)


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


def test_a_large_mesh_is_read_in_part_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("multibot_rewrite.checks.mesh_box.MOST_BYTES", 100)
    file = tmp_path / "a.stl"
    file.write_bytes(binary_stl(*SIDES))
    assert mesh_box(str(file)) is None
    assert mesh_box(str(file), whole=False) is not None


def test_a_mesh_that_was_written_anew_is_read_again(tmp_path: Path) -> None:
    file = tmp_path / "a.obj"
    file.write_bytes(obj(*SIDES))
    assert mesh_box(str(file)) == ((0.0, 0.0, 0.0), SIDES)
    file.write_bytes(obj(1, 2, 3) + b"# more")
    assert mesh_box(str(file)) == ((0.0, 0.0, 0.0), (1, 2, 3))


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


def test_a_pipe_is_no_mesh(workspace: Path) -> None:
    pipe = workspace / "src/arm/meshes/pipe.stl"
    mkfifo(pipe)
    names = (f"file://{pipe}", "package://arm/meshes/pipe.stl")
    assert linted(workspace, *names, select="MB714") == []
