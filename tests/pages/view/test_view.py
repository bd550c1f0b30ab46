# SPDX-License-Identifier: Apache-2.0
"""``multibot view``: models, names before and after, one page that fetches nothing."""

from __future__ import annotations

import base64
import json
import re
import struct
import sys
from pathlib import Path

import pytest
from paths import FIXTURES, ROBOTS, fixture_text
from view_pages import page

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.pages.view import models

# What reads meshes takes longer to be imported than all of this to run.
pytestmark = pytest.mark.more

# A mesh of one triangle, with the corners below.
CORNERS = ((0, 0, 0), (1, 0, 0), (0, 1, 0))
STL = b"\0" * 80 + struct.pack("<I", 1) + struct.pack("<12f", 0, 0, 1, *sum(CORNERS, ())) + b"\0\0"
ROBOT = fixture_text("view_robot.urdf")


@pytest.fixture
def file(tmp_path: Path) -> Path:
    (tmp_path / "part.stl").write_bytes(STL)
    (tmp_path / "r.urdf").write_text(ROBOT)
    return tmp_path / "r.urdf"


def test_a_robot_has_its_shapes_and_joints(file: Path) -> None:
    (robot,) = page(file.parent, file, "--affix", "prefix")["robots"]
    mesh, cylinder, missing = robot["links"]["robot1/base"]
    assert mesh[0] == "mesh" and mesh[1] == [2, 2, 2] and mesh[3] == [1, 0, 0, 0.5]
    assert cylinder[:2] == ["cylinder", [0.1, 0.4]]
    assert [row[3] for row in cylinder[2]] == [1, 2, 3, 1]
    assert missing[0] == "box" and "package://nowhere/a.dae is not found" in missing[5]
    turn, push = robot["joints"]
    assert turn[:4] == ["robot1_turn", "revolute", "robot1/base", "robot1/arm"]
    assert turn[5:8] == [[0, 0, 1], -1, 0.5]
    assert push[8] == ["robot1_turn", 2, 0.1]


def test_a_mesh_is_in_the_page_once(file: Path) -> None:
    made = page(file.parent, file, "robot1", "robot2")
    (mesh,) = made["meshes"]
    assert struct.unpack("<9f", base64.b64decode(mesh["v"])) == sum(CORNERS, ())
    assert struct.unpack("<3I", base64.b64decode(mesh["f"])) == (0, 1, 2)
    assert {it["name"]: it["pose"][1] for it in made["robots"]} == {"robot1": 0, "robot2": 1.5}


def test_triangles_of_a_mesh_keep_corners_of_their_own(file: Path) -> None:
    """As the file has them: two triangles at one edge are not drawn as a bent surface."""
    other = ((1, 0, 0), (1, 1, 0), (0, 1, 0))
    packed = (struct.pack("<12f", 0, 0, 1, *sum(it, ())) for it in (CORNERS, other))
    whole = b"\0" * 80 + struct.pack("<I", 2) + b"".join(it + b"\0\0" for it in packed)
    (file.parent / "part.stl").write_bytes(whole)
    (mesh,) = page(file.parent, file)["meshes"]
    assert struct.unpack("<18f", base64.b64decode(mesh["v"])) == sum((*CORNERS, *other), ())
    assert struct.unpack("<6I", base64.b64decode(mesh["f"])) == tuple(range(6))


def test_an_sdf_with_a_model_inside(tmp_path: Path) -> None:
    (robot,) = page(tmp_path, ROBOTS / "rover.sdf", "a")["robots"]
    assert robot["names"]["head_a::base_link/a"] == ["head::base_link", 39]
    assert robot["names"]["neck_a"] == ["neck", 46]
    (neck,) = [it for it in robot["joints"] if it[0] == "neck_a"]
    # The frame on the base is at 0.1 0 0.1, the head 0.1 above it.
    assert [row[3] for row in neck[4][:3]] == pytest.approx([0.1, 0, 0.2])


def test_what_names_were_and_where(file: Path) -> None:
    (robot,) = page(file.parent, file, "a")["robots"]
    assert robot["names"]["base/a"] == ["base", 3]
    assert robot["names"]["turn_a"] == ["turn", 10]
    rows = [row for row in robot["changes"] if row[3] == "turn"]
    assert [(row[0], row[1], row[4]) for row in rows] == [
        (10, "joint", "turn_a"),
        (13, "joint", "turn_a"),
    ]


def test_topics_have_the_namespace_where_it_is_another_word(tmp_path: Path) -> None:
    fleet = tmp_path / "fleet.yaml"
    (tmp_path / "rover.urdf").write_bytes((ROBOTS / "rover.urdf").read_bytes())
    fleet.write_text(
        "layout: both\naffix: prefix\ndescription: rover.urdf\n"
        "robots: [{name: one, namespace: site, prefix: p1, pose: {x: 2, yaw: 1}}]\n"
    )
    (robot,) = page(tmp_path, fleet)["robots"]
    assert robot["pose"] == [2, 0, 0, 0, 0, 1]
    new = {row[4] for row in robot["changes"]}
    assert "p1/base_link" in new
    assert "/site" in new
    assert not [it for it in new if "one" in it]
    lines = [row[0] for row in robot["changes"]]
    assert lines == sorted(lines)


def test_frames_of_a_snapshot(tmp_path: Path) -> None:
    """Of a graph in which robot1's tree was heard, but for one frame that hangs elsewhere."""
    snapshot = json.loads((FIXTURES / "graphs" / "healthy.json").read_text())
    (imu,) = [it for it in snapshot["edges"] if it["child"] == "imu_link/robot1"]
    imu["parent"] = "lidar_link/robot1"
    (tmp_path / "graph.json").write_text(json.dumps(snapshot))
    words = [ROBOTS / "rover.urdf", "robot1", "--layout", "frames-per-robot"]
    (robot,) = page(tmp_path, *words, "--from", tmp_path / "graph.json")["robots"]
    others = {link: "heard" for link in robot["links"] if link != "imu_link/robot1"}
    assert robot["heard"] == {**others, "imu_link/robot1": "elsewhere"}


def test_the_page_fetches_nothing_and_is_small(file: Path) -> None:
    page(file.parent, file)
    text = (file.parent / "view.html").read_text()
    assert len(text) < 1_500_000
    assert "default-src 'none'" in text
    assert not re.search(r"""(?:src|href)\s*=\s*["']?(?:https?:)?//""", text)


def test_names_of_a_file_do_not_reach_the_page_as_code(tmp_path: Path) -> None:
    evil = "x</script><img src=q onerror=alert(1)>"
    name = evil.replace("<", "&lt;").replace(">", "&gt;")
    (tmp_path / "r.urdf").write_text(f'<robot name="r"><link name="{name}"/></robot>')
    made = page(tmp_path, tmp_path / "r.urdf")
    assert list(made["robots"][0]["links"]) == [f"{evil}/robot1"]
    assert "<img" not in (tmp_path / "view.html").read_text()


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["nowhere.urdf"], "nowhere.urdf"),
        (["{folder}/fleet.yaml", "robot1"], "a fleet file has its own, leave out ROBOT"),
        (["{folder}/r.urdf", "a", "a"], "'a'"),
        (["{folder}/r.urdf", "a:=b"], "is no xacro: leave out NAME:=VALUE"),
        (["{folder}/r.urdf", "-o", "{folder}/r.urdf"], "r.urdf"),
        (["{folder}/r.urdf", "--from", "{folder}/r.urdf"], "r.urdf"),
    ],
)
def test_mistakes_are_one_line(
    words: list[str], says: str, file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (file.parent / "fleet.yaml").write_text("description: r.urdf\nrobots: [{name: a}]\n")
    given = [it.format(folder=file.parent) for it in words]
    more = [] if "-o" in given else ["-o", str(file.parent / "view.html")]
    assert main(["view", *given, *more]) == 2
    said = capsys.readouterr().err
    assert says in said and len(said.splitlines()) == 1
    assert not (file.parent / "view.html").exists()
    assert file.read_text() == ROBOT


def test_without_trimesh_it_says_what_to_install(
    file: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "trimesh", None)
    assert main(["view", str(file), "-o", str(file.parent / "view.html")]) == 4
    assert "pip install 'multibot_rewrite[view]'" in capsys.readouterr().err


def test_what_is_read_is_told_mesh_by_mesh(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[str] = []
    monkeypatch.setattr("multibot_rewrite.cli.view.status", lambda: told.append)
    page(file.parent, file)
    assert told == [f"1 of 1 mesh file: {file.parent / 'part.stl'}", ""]


def test_a_large_mesh_is_shown_as_its_box(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(models, "MOST_FACES", 0)
    (mesh,) = page(file.parent, file)["meshes"]
    assert len(base64.b64decode(mesh["f"])) == 12 * 12


OBJ = "mtllib part.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl paint\nf 1 2 3\n"


def test_a_mesh_has_the_colours_of_its_file(file: Path) -> None:
    """As in RViz: the material of the description is for a mesh that has none."""
    assert not page(file.parent, file)["meshes"][0]["c"]
    (file.parent / "part.obj").write_text(OBJ)
    (file.parent / "part.mtl").write_text("newmtl paint\nKd 0.2 0.4 0.6\n")
    file.write_text(ROBOT.replace("part.stl", "part.obj"))
    (mesh,) = page(file.parent, file)["meshes"]
    assert [*base64.b64decode(mesh["c"])] == [51, 102, 153] * 3


def test_a_shape_without_a_colour_leaves_it_to_the_page(file: Path) -> None:
    (robot,) = page(file.parent, file)["robots"]
    (links,) = (its for its in robot["links"].values() if its)
    assert [it[3] for it in links] == [[1, 0, 0, 0.5], [], []]


def test_a_robot_without_a_shape_is_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bare = tmp_path / "bare.urdf"
    bare.write_text('<robot name="r"><link name="base"/></robot>')
    assert main(["view", str(bare), "robot1", "-o", str(tmp_path / "v.html")]) == 0
    assert "robot1: its links have no <visual>: only frames are shown" in capsys.readouterr().err


def test_plugins_with_their_lines(tmp_path: Path) -> None:
    text = (ROBOTS / "rover.urdf").read_text().splitlines()
    (robot,) = page(tmp_path, ROBOTS / "rover.urdf", "a")["robots"]
    wanted = [at for at, line in enumerate(text, 1) if "<plugin " in line]
    assert [it[2] for it in robot["plugins"]] == wanted
    assert robot["plugins"][0] == ["diff_drive", "libgazebo_ros_diff_drive.so", wanted[0]]


def test_a_mesh_that_cannot_be_read_is_said(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (file.parent / "part.stl").write_bytes(b"")
    assert main(["view", str(file), "-o", str(file.parent / "view.html")]) == 0
    said = capsys.readouterr().err
    assert "package://nowhere/a.dae is not found, it is shown as a box" in said
    assert said.count("part.stl") == 1
