"""MB7: which files are looked for where, and how they may be named."""

from __future__ import annotations

from pathlib import Path

import pytest

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
