# SPDX-License-Identifier: Apache-2.0
"""Included models are what libsdformat makes of them, and are renamed with the model around them."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest
from paths import fixture_text

from multibot_rewrite import InputError, rewrite
from multibot_rewrite.base.findings.finding import ERROR
from multibot_rewrite.description.sources.included_models import (
    VARIABLES,
    model_file,
    with_includes,
)
from multibot_rewrite.lint.check import lint_file
from multibot_rewrite.rules.settings import Settings

IGN = next(filter(None, map(shutil.which, ("gz", "ign"))), "")
BASE = fixture_text("included_models_base.sdf")
CAM = """<sdf version="1.9"><model name="cam"><link name="camera_link">
<sensor name="eye" type="imu"><topic>tilt</topic></sensor></link></model></sdf>"""
ROVER = fixture_text("included_models_rover.sdf")
MID = '<sdf version="1.9"><model name="mid"><include merge="1"><uri>base</uri></include></model></sdf>'


CONFIG = "<model><name>m</name><sdf version='1.9'>model.sdf</sdf></model>"
OLD = """<sdf version='1.6'><model name='b'>
<link name='base_link'><pose frame='x'/></link></model></sdf>"""


@pytest.fixture
def rover(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for name in VARIABLES:
        monkeypatch.delenv(name, raising=False)
    texts = {"base": BASE.format(""), "mid": MID, "cam": CAM, "rover": ROVER}
    for name, text in texts.items():
        (tmp_path / "models" / name).mkdir(parents=True)
        (tmp_path / "models" / name / "model.sdf").write_text(text)
        (tmp_path / "models" / name / "model.config").write_text(CONFIG)
    return tmp_path / "models" / "rover" / "model.sdf"


def test_every_line_keeps_its_number(rover: Path) -> None:
    before = rover.read_text().splitlines()
    after = with_includes(rover.read_bytes(), str(rover)).decode().splitlines()
    assert len(after) == len(before)
    assert [it for it in before if "mount" in it] == [after[9]]


def test_the_lint_knows_what_is_included(rover: Path) -> None:
    assert not {"MB211", "MB202", "MB219", "MB906"} & {
        it.code for it in lint_file(str(rover), Settings())
    }
    rover.write_text(ROVER.replace(">spin<", ">spun<"))
    (found,) = (it for it in lint_file(str(rover), Settings()) if it.code == "MB211")
    assert (
        found.line
        == ROVER.splitlines().index(next(it for it in ROVER.splitlines() if "spin" in it)) + 1
    )
    assert "spin" in found.hint


@pytest.mark.parametrize("variable", VARIABLES)
def test_it_is_looked_for_where_gazebo_looks(
    rover: Path, variable: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    alone = tmp_path / "elsewhere" / "deep" / "model.sdf"
    alone.parent.mkdir(parents=True)
    alone.write_text(ROVER)
    assert [it.code for it in rewrite(alone, "r1").findings].count("MB906") == 2
    monkeypatch.setenv(variable, f"/nowhere:{rover.parents[1]}")
    assert rewrite(alone, "r1").not_verified == ()


def test_a_file_beside_the_included_model_is_found_from_the_new_one(rover: Path) -> None:
    mesh = rover.parents[1] / "base" / "meshes" / "a.stl"
    mesh.parent.mkdir()
    mesh.write_text("")
    visual = "<visual name='v'><geometry><mesh><uri>meshes/a.stl</uri></mesh></geometry></visual>"
    base = BASE.format(f"<link name='more'>{visual}</link>")
    (rover.parents[1] / "base" / "model.sdf").write_text(base)
    assert f"<uri>file://{mesh}</uri>".encode() in rewrite(rover, "r1").data


@pytest.mark.parametrize(
    ("file", "text"),
    [
        ("base", OLD),
        ("base", "<sdf version='1.9'><model"),
        ("base", "<robot name='r'/>"),
    ],
    ids=("old", "broken", "no-model"),
)
def test_what_cannot_be_put_in_stays_and_is_said(rover: Path, file: str, text: str) -> None:
    (rover.parents[1] / file / "model.sdf").write_text(text)
    done = rewrite(rover, "r1")
    assert "MB906" in {it.code for it in done.findings}
    assert b"<include" in done.data


@pytest.mark.parametrize("back", ["mid", "rover"])
def test_a_model_that_includes_itself_is_an_error(rover: Path, back: str) -> None:
    """libsdformat reads on until there is no memory: ign sdf ends with bad_alloc."""
    mid = rover.parents[1] / "mid" / "model.sdf"
    mid.write_text("\n" + MID.replace(">base<", f">{back}<"))
    (rover.parent / "model.config").write_text(CONFIG)
    with pytest.raises(InputError, match=f"{mid}:2: '{back}' leads back"):
        rewrite(rover, "r1")
    (found,) = lint_file(str(rover), Settings())
    assert (found.code, found.level, found.file, found.line) == ("MB101", ERROR, str(mid), 2)


@pytest.mark.parametrize(
    "uri", ["../../../etc/x.sdf", "https://fuel.gazebosim.org/a", "/etc/passwd", ""]
)
def test_nothing_else_is_read(rover: Path, uri: str) -> None:
    rover.write_text(ROVER.replace("model://mid", uri))
    assert uri.encode() in rewrite(rover, "r1").data


@pytest.mark.slow
@pytest.mark.skipif(
    not IGN, reason="libsdformat is missing: apt install ignition-tools libsdformat-dev"
)
def test_libsdformat_makes_the_same_of_it(rover: Path) -> None:
    """Its own text of both; numbers are written as they were read."""
    home = str(rover.parents[1])
    whole = rover.with_name("whole.sdf")
    whole.write_bytes(with_includes(rover.read_bytes(), str(rover)))
    one, other = (printed(it, home) for it in (rover, whole))
    assert any("_merged__mid__model__" in it for it in one)
    assert other == one


def test_what_sdformat_merges_is_merged(rover: Path) -> None:
    """sdformat parser.cc, readXml: links, models, joints, frames, grippers, plugins."""
    parts = '<gripper name="g"/><plugin name="p" filename="f"/><model name="n"/><static>1</static>'
    base = rover.parent.parent / "base" / "model.sdf"
    base.write_text(BASE.format(parts))
    text = with_includes(rover.read_bytes(), str(rover)).decode()
    merged = text.partition("<include>")[0]
    assert all(f'name="{it}"' in merged for it in ("g", "p", "n", "rotor", "spin", "top"))
    assert "<static>" not in merged


def printed(file: Path, home: str) -> list[str]:
    run = [IGN, "sdf", "-p", str(file)]
    env = {**os.environ, "SDF_PATH": home}
    done = subprocess.run(run, capture_output=True, text=True, check=True, env=env)
    lines = (it.replace("-0", "0").strip() for it in done.stdout.splitlines())
    return re.findall(r"<.*|[^\s<].*", "\n".join(it for it in lines if it))


INNER = """<sdf version="1.9"><model name="in" canonical_link="b"><pose>1 0 0 0 0 0</pose>
<link name="a"/><!-- a note --><link name="b"><pose>0 0 1 0 0 0</pose></link>
<model name="n"><link name="x"/></model><frame name="f"/>
<frame name="g" attached_to="a"><pose relative_to="__model__">0 0 2 0 0 0</pose></frame>
<frame name="h" attached_to="__model__"><pose>0 0 3 0 0 0</pose></frame>
<joint name="j" type="revolute"><parent> __model__ </parent><child>b</child>
<axis><xyz expressed_in="__model__">0 0 1</xyz></axis><axis2><xyz expressed_in="a">0 1 0</xyz></axis2>
</joint><static>true</static></model></sdf>"""
OUTER = """<sdf version="1.9"><model name="out"><link name="o"/>{}</model></sdf>"""
PLUGIN = '<plugin name="p" filename="f"/>'


def put_in(folder: Path, include: str, inner: str = INNER) -> str:
    """Return what stands in the place of an include, without lines."""
    (folder / "in.sdf").write_text(inner)
    file = folder / "out.sdf"
    file.write_text(OUTER.format(include))
    text = with_includes(file.read_bytes(), str(file)).decode()
    before, _, after = OUTER.format("|").partition("|")
    assert text.startswith(before) and text.endswith(after)
    return re.sub(r"\s*\n\s*", "", text.removeprefix(before).removesuffix(after)).replace(
        "> <", "><"
    )


@pytest.mark.parametrize(
    ("merge", "pose", "placed"),
    [
        ("true", "", '<pose relative_to="__model__">1 0 0 0 0 0</pose>'),
        (" TRUE ", "<pose>2 0 0 0 0 0</pose>", '<pose relative_to="__model__">2 0 0 0 0 0</pose>'),
        ("1", '<pose relative_to="o">2 0 0 0 0 0</pose>', '<pose relative_to="o">2 0 0 0 0 0</pose>'),
    ],
)  # fmt: skip
def test_a_merged_model_is_placed_from_a_frame_that_stands_for_it(
    merge: str, pose: str, placed: str, tmp_path: Path
) -> None:
    """sdformat parser.cc, readXml and the merge-include tests of includes.cc."""
    include = f'<include merge="{merge}"><uri>in.sdf</uri>{pose}{PLUGIN}</include>'
    mine = '_merged__in__model__"'
    assert put_in(tmp_path, include) == (
        f'<frame name="{mine} attached_to="b">{placed}</frame>'
        f'<link name="a"><pose relative_to="{mine}>0 0 0 0 0 0</pose></link>'
        f'<link name="b"><pose relative_to="{mine}>0 0 1 0 0 0</pose></link>'
        f'<model name="n"><link name="x"/><pose relative_to="{mine}>0 0 0 0 0 0</pose></model>'
        f'<frame name="f" attached_to="{mine}/>'
        f'<frame name="g" attached_to="a"><pose relative_to="{mine}>0 0 2 0 0 0</pose></frame>'
        f'<frame name="h" attached_to="{mine}><pose>0 0 3 0 0 0</pose></frame>'
        '<joint name="j" type="revolute"><parent>_merged__in__model__</parent><child>b</child>'
        f'<axis><xyz expressed_in="{mine}>0 0 1</xyz></axis>'
        f'<axis2><xyz expressed_in="a">0 1 0</xyz></axis2></joint>{PLUGIN}'
    )


def test_a_model_is_nested_with_what_its_include_says(tmp_path: Path) -> None:
    said = (
        "<name>front</name><pose>3 0 0 0 0 0</pose><static>false</static>"
        "<placement_frame>b</placement_frame>"
    )
    inner = (
        '<sdf version="1.9"><model name="in"><pose>1 0 0 0 0 0</pose><link name="a"/>'
        "<static>true</static><!-- gone --></model></sdf>"
    )
    plain = '<include merge="false"><uri>in.sdf</uri></include>'
    assert put_in(tmp_path, plain, inner) == (
        '<model name="in"><pose>1 0 0 0 0 0</pose><link name="a"/><static>true</static></model>'
    )
    assert put_in(tmp_path, f"<include><uri>in.sdf</uri>{said}{PLUGIN}</include>", inner) == (
        '<model name="front" placement_frame="b"><link name="a"/><pose>3 0 0 0 0 0</pose>'
        f"<static>false</static>{PLUGIN}</model>"
    )


@pytest.mark.parametrize(
    ("text", "is_in"),
    [
        ('<sdf version="1.7"><model name="in"><link name="a"><pose frame=""/></link></model></sdf>',
         True),
        ('<sdf version="1.6"><model name="in"><link name="a"><pose frame=""/></link></model></sdf>',
         False),
        ('<sdf version="1.6"><model name="in"><link name="a"><pose/></link></model></sdf>', True),
        ('<sdf version="1.6"><model name="in"><use_parent_model_frame/></model></sdf>', False),
        ('<sdf version="1.10"><model name="in"><link frame ="a"/></model></sdf>', True),
        ('<sdf><model name="in"><link frame="a"/></model></sdf>', False),
        ('<sdf version="1.9"/>', False),
        # What is lost in an include of it would be lost in the model.
        ('<sdf version="1.9"><model name="in"><include><uri>gone</uri></include></model></sdf>', False),
    ],
)  # fmt: skip
def test_what_is_put_in_says_the_same_in_a_new_file(text: str, is_in: bool, tmp_path: Path) -> None:
    """Before 1.7 a pose had a frame, and an axis that of the model above."""
    include = "<include><uri>in.sdf</uri></include>"
    assert (put_in(tmp_path, include, text) != include) == is_in


def test_only_the_include_of_a_model_in_a_file_without_a_world_is_one(tmp_path: Path) -> None:
    (tmp_path / "in.sdf").write_text(INNER)
    include = "<include><uri>in.sdf</uri></include>"
    for text in (
        f'<sdf version="1.9">{include}</sdf>', f"<robot name='r'><model>{include}</model></robot>",
        f'<sdf version="1.9"><world name="w"/><model name="m">{include}</model></sdf>',
        f'<sdf version="1.9"><model name="m"><own>{include}</own></model></sdf>',
    ):  # fmt: skip
        assert with_includes(text.encode(), str(tmp_path / "out.sdf")) == text.encode()


@pytest.mark.parametrize(
    ("config", "found"),
    [
        ("<model><sdf version='1.9'> a.sdf\n</sdf></model>", "a.sdf"), ("<model/>", ""),
        ("<model><sdf version='1.10'>a.sdf</sdf><sdf version='1.9'>b.sdf</sdf></model>", "a.sdf"),
        ("<model><sdf>b.sdf</sdf><sdf version='1.9'>a.sdf</sdf></model>", "a.sdf"),
        ("<model><sdf version='1.9'>x/a.sdf</sdf></model>", ""), ("<model><sdf/></model>", ""),
        ("<model><sdf version='1.9'>gone.sdf</sdf></model>", ""), ("<model", ""),
    ],
)  # fmt: skip
def test_the_file_of_a_model_is_the_newest_that_its_config_names(
    config: str, found: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in VARIABLES:
        monkeypatch.delenv(name, raising=False)
    home = tmp_path / "m"
    (home / "x").mkdir(parents=True)
    for name in ("a.sdf", "b.sdf", "x/a.sdf"):
        (home / name).write_text("<sdf/>")
    (home / "model.config").write_text(config)
    for uri in ("model://m", "m", "model://m/"):
        assert model_file(uri, str(tmp_path)) == (str(home / found) if found else "")
