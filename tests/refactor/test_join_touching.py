# SPDX-License-Identifier: Apache-2.0
"""Which links of two parts never or always touch: boxes of which it is known by hand."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from lxml import etree

from multibot_rewrite import InputError, Joined, Part, UsageError, join
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.description.joining.from_file import listed_in

BOX = '<collision><origin xyz="{}"/><geometry><box size="{}"/></geometry></collision>'
# A bar of 1 m that turns about its end, on a column.
ARM = f"""<robot name="arm">
  <link name="column">{BOX.format("0 0 0", "0.1 0.1 0.1")}</link>
  <link name="bar">{BOX.format("0.5 0 0", "1 0.1 0.1")}</link>
  <joint name="turn" type="continuous">
    <parent link="column"/><child link="bar"/><axis xyz="0 0 1"/>
  </joint>
</robot>
"""
# Of two blocks the near one is on the bar's way, the far one is not.
BLOCKS = f"""<robot name="blocks">
  <link name="floor"/>
  <link name="near">{BOX.format("0.7 0 0", "0.2 0.2 0.2")}</link>
  <link name="far">{BOX.format("1.5 0 0", "0.2 0.2 0.2")}</link>
  <link name="round">{BOX.format("0 0 0", "9 9 9")}</link>
  <joint name="a" type="fixed"><parent link="floor"/><child link="near"/></joint>
  <joint name="b" type="fixed"><parent link="near"/><child link="far"/></joint>
  <joint name="c" type="fixed"><parent link="far"/><child link="round"/></joint>
</robot>
"""
MESH = '<collision><geometry><mesh filename="package://nowhere/far.stl"/></geometry></collision>'
SRDF = "<robot name='it'/>"
ADJACENT = {("column", "near"): "Adjacent"}


def joined(blocks: str = BLOCKS, samples: int = 200, pose: float = 0.0) -> Joined:
    where = (pose, 0, 0, 0, 0, 0)
    parts = [Part(ARM, srdf=SRDF), Part(blocks, "column", where, name="blocks", srdf=SRDF)]
    return join(parts, samples=samples)


def disabled(made: Joined) -> dict[tuple[str, str], str]:
    found = etree.fromstring(made.srdf).iterchildren("disable_collisions")
    return {(it.get("link1", ""), it.get("link2", "")): it.get("reason", "") for it in found}


def test_without_samples_nothing_is_guessed() -> None:
    made = joined(samples=0)
    assert disabled(made) == ADJACENT
    assert any("5 pairs of links of two parts are checked" in it for it in made.notes)


@pytest.mark.more
def test_what_never_and_what_always_touches_is_disabled() -> None:
    pytest.importorskip("pinocchio")
    made = joined()
    assert disabled(made) == {
        **ADJACENT,
        ("bar", "far"): "Never",
        ("bar", "round"): "Always",
        ("column", "far"): "Never",
        ("column", "round"): "Always",
    }
    said = "of 5 pairs of links of two parts 2 never touch in 200 random poses"
    assert any(said in it for it in made.notes)
    assert any("'bar' and 'round' touch in every pose" in it for it in made.notes)


@pytest.mark.more
def test_it_is_the_same_each_time_and_knows_where_the_part_is() -> None:
    pytest.importorskip("pinocchio")
    assert joined().srdf == joined().srdf
    # 0.6 m nearer both blocks are on the bar's way.
    assert ("bar", "far") not in disabled(joined(pose=-0.6))


# Blocks of which the bar touches one at a time.
AROUND = [(0.7, 0), (-0.7, 0), (0, 0.7), (0, -0.7)]


@pytest.mark.more
def test_what_touches_in_some_poses_is_checked() -> None:
    pytest.importorskip("pinocchio")
    links = "".join(
        f'<link name="b{at}">{BOX.format(f"{x} {y} 0", "0.2 0.2 0.2")}</link>'
        f'<joint name="j{at}" type="fixed"><parent link="floor"/><child link="b{at}"/></joint>'
        for at, (x, y) in enumerate(AROUND)
    )
    made = joined(f'<robot name="blocks"><link name="floor"/>{links}</robot>')
    assert [it for it in disabled(made) if "bar" in it] == []


@pytest.mark.more
def test_the_poses_are_the_same_each_time() -> None:
    pytest.importorskip("pinocchio")
    # In one pose the bar is in this half or it is not.
    half = BLOCKS.replace(BOX.format("1.5 0 0", "0.2 0.2 0.2"), BOX.format("0 5 0", "10 9.9 1"))
    assert len({joined(half, samples=1).srdf for _ in range(8)}) == 1


@pytest.mark.more
def test_limits_are_kept() -> None:
    pytest.importorskip("pinocchio")
    limit = '<limit lower="1" upper="2" effort="1" velocity="1"/></joint>'
    arm = ARM.replace("continuous", "revolute").replace("</joint>", limit)
    made = join(
        [Part(arm, srdf=SRDF), Part(BLOCKS, "column", name="blocks", srdf=SRDF)], samples=200
    )
    assert disabled(made)["bar", "near"] == "Never"


@pytest.mark.more
def test_of_a_mesh_that_is_not_there_nothing_is_said() -> None:
    pytest.importorskip("pinocchio")
    far = BOX.format("1.5 0 0", "0.2 0.2 0.2")
    made = joined(BLOCKS.replace(far, MESH))
    assert ("bar", "far") not in disabled(made)
    assert any(
        "of 'far' were not checked: the mesh package://nowhere/far.stl" in it for it in made.notes
    )


@pytest.mark.more
def test_meshes_are_found_from_their_package(tmp_path: Path) -> None:
    pytest.importorskip("pinocchio")
    (tmp_path / "package.xml").write_text("<package><name>blocks</name></package>")
    (tmp_path / "far.stl").write_text(TRIANGLE)
    far = BOX.format("1.5 0 0", "0.2 0.2 0.2")
    (tmp_path / "blocks.urdf").write_text(BLOCKS.replace(far, MESH.replace("nowhere", "blocks")))
    assert disabled(joined(str(tmp_path / "blocks.urdf")))["bar", "far"] == "Never"


TRIANGLE = """solid far
facet normal 0 0 1
outer loop
vertex 5 0 0
vertex 6 0 0
vertex 5 1 0
endloop
endfacet
endsolid far
"""


def test_without_pinocchio_it_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pinocchio", None)
    with pytest.raises(UsageError, match="pip install pin, or leave out samples"):
        joined()


@pytest.mark.more
def test_a_list_of_parts_says_how_many_poses(tmp_path: Path) -> None:
    pytest.importorskip("pinocchio")
    listed, out = parts_in(tmp_path, "200", "srdf: it.srdf, "), tmp_path / "out"
    assert main(["join", listed, "-q", "-o", str(out / "r.urdf")]) == 0
    assert b'"Never"' in (out / "r.srdf").read_bytes()


@pytest.mark.parametrize(
    ("samples", "told"), [("100", "an SRDF: give a part its srdf"), ("few", "a number such as")]
)
def test_samples_are_a_number_for_an_srdf(samples: str, told: str, tmp_path: Path) -> None:
    listed = parts_in(tmp_path, samples, "")
    with pytest.raises(InputError, match=rf"all\.join:1: samples is .*{told}"):
        listed_in(listed)


def parts_in(folder: Path, samples: str, srdf: str) -> str:
    for name, text in (("arm.urdf", ARM), ("blocks.urdf", BLOCKS), ("it.srdf", SRDF)):
        (folder / name).write_text(text)
    part = f"{{{srdf}description: blocks.urdf, at: {{parent: column}}}}"
    listed = folder / "all.join"
    listed.write_text(f"samples: {samples}\njoin: [{{{srdf}description: arm.urdf}}, {part}]\n")
    return str(listed)
