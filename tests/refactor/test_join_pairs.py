# SPDX-License-Identifier: Apache-2.0
"""Public parts joined in pairs: pinocchio has every link where its part has it, and every joint."""

from __future__ import annotations

import importlib.util
import os
from collections.abc import Iterator
from contextlib import contextmanager

import joined_pairs
import pytest
from joined_pairs import PREFIX, WRONG, counted, largest_gap, seen
from lxml import etree
from paths import CORPUS
from real_robots import corpus_files

from multibot_rewrite import Part, join, split

# A product of two matrices in doubles.
ROUNDED = 1e-14
needs_pin = pytest.mark.skipif(
    importlib.util.find_spec("pinocchio") is None, reason="pinocchio is missing: pip install pin"
)


@contextmanager
def quiet() -> Iterator[None]:
    """urdfdom says from C++ what it thinks of a file."""
    kept, sink = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    os.dup2(sink, 2)
    try:
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(sink)


@needs_pin
@pytest.mark.sample(33)
@pytest.mark.parametrize("name", joined_pairs.pairs())
def test_every_link_is_where_its_part_has_it(name: str) -> None:
    pair = joined_pairs.pairs()[name]
    made = joined_pairs.joined_pair(pair)
    with quiet():
        whole, host, tool = seen(made.data), *(seen(it.read_bytes()) for it in (pair[0], pair[2]))
        gap = largest_gap(pair, made.data, PREFIX)
    assert gap < ROUNDED
    moving = {PREFIX + it for it in tool.joints if it != "universe"}
    assert whole.joints == host.joints | moving
    assert whole.mass == pytest.approx(host.mass + tool.mass, abs=1e-12)
    assert split(made.data) == {"host": pair.host.read_bytes(), "tool": pair.tool.read_bytes()}
    found = counted(made.data)
    before = counted(pair.host.read_bytes()) + counted(pair.tool.read_bytes())
    assert [found[it] for it in WRONG] == [before[it] for it in WRONG]


@pytest.mark.sample(19)
@pytest.mark.parametrize("name", joined_pairs.twins())
def test_no_name_of_a_part_leads_into_its_twin(name: str) -> None:
    pair = joined_pairs.twins()[name]
    assert joined_pairs.crossed(pair, joined_pairs.by_join(pair)) == 0


def test_there_are_enough_pairs() -> None:
    """Else the table says little."""
    found = joined_pairs.pairs()
    if len(found) < len(joined_pairs.HOSTS) * len(joined_pairs.TOOLS) / 2:
        pytest.skip("the corpus is not here")
    assert len(found) >= 40


XARM = "xArm-Developer+xarm_ros2/xarm_description__urdf__"


def elements(data: bytes) -> dict[tuple[str, str], bytes]:
    """Return the elements of a description by tag and name; materials without the prefix of an arm."""
    root = joined_pairs.plain(data)
    for it in root.iter("material"):
        it.set("name", it.get("name", "").removeprefix("L_").removeprefix("R_"))
    etree.indent(root)
    found = root.iterchildren("link", "joint", "transmission", "gazebo")
    named = (it for it in found if it.get("name") or it.get("reference"))
    return {
        (str(it.tag), it.get("name") or it.get("reference") or ""): etree.tostring(
            it, method="c14n", with_tail=False
        )
        for it in named
    }


def test_two_xarms_on_the_ground_are_what_their_vendor_writes() -> None:
    """But for the name of the component, which the vendor gives to both arms, and for the materials of
    each arm."""
    files = corpus_files()
    if f"{XARM}dual_xarm_device.urdf" not in files:
        pytest.skip("the corpus is not here")
    arm = files[f"{XARM}xarm_device.urdf"]
    ground = '<robot name="dual_xarm"><link name="ground"/></robot>'
    right = Part(arm, "ground", (0, 1, 0, 0, 0, 0), "R_")
    made = elements(join([Part(ground), Part(arm, "ground", prefix="L_"), right]).data)
    theirs = elements(files[f"{XARM}dual_xarm_device.urdf"].read_bytes())
    assert len(theirs) > 50
    assert made == theirs


def semantics(data: bytes) -> set[tuple[object, ...]]:
    """Return the elements of an SRDF; which of two links is named first means nothing."""
    pairs: set[tuple[object, ...]] = set()
    for it in joined_pairs.plain(data).iterchildren():
        links = sorted(it.get(key, "") for key in ("link1", "link2") if it.get(key))
        inside = etree.tostring(it, method="c14n", with_tail=False).split()
        pairs.add((it.tag, *links) if links else (it.tag, b" ".join(inside)))
    return pairs


def test_the_srdf_of_two_xarms_is_what_their_vendor_writes() -> None:
    """And the two feet, between which is nothing that has a shape."""
    folder = CORPUS / "srdf" / "xArm-Developer+xarm_ros2"
    if not folder.is_dir():
        pytest.skip("the corpus is not here")
    arm = corpus_files()[f"{XARM}xarm_device.urdf"]
    one = folder / "xarm_moveit_config__srdf__xarm.srdf"
    ground = '<robot name="dual_xarm"><link name="ground"/></robot>'
    parts = [Part(arm, "ground", prefix=it, srdf=one) for it in ("L_", "R_")]
    made = semantics(join([Part(ground), *parts]).srdf)
    theirs = semantics((folder / "xarm_moveit_config__srdf__dual_xarm.srdf").read_bytes())
    assert made == theirs | {("disable_collisions", "L_link_base", "R_link_base")}
    assert len(theirs) > 30
