# SPDX-License-Identifier: Apache-2.0
"""Contact sensors name collisions by the names libsdformat makes up; they have to follow the links.

Every name here was measured with libsdformat 12.3, or follows from parser_urdf.cc.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import pytest
from lxml import etree

from multibot_rewrite import RewriteRefused, rewrite, strip
from multibot_rewrite.description.rewriters.contact import Respell, collision_map

UNDERSCORE = {"link": "_"}


class Link(NamedTuple):
    """A link, the names of its collisions (empty: unnamed), and the fixed joint it hangs on."""

    name: str
    collisions: Sequence[str] = ("",)
    parent: str = ""
    joint: str = ""


def robot(links: Sequence[Link], more: str = "") -> str:
    text = '<robot name="r">'
    for link in links:
        named = [f' name="{name}"' if name else "" for name in link.collisions]
        text += (
            f'<link name="{link.name}">' + "".join(f"<collision{n}/>" for n in named) + "</link>"
        )
        if link.parent:
            text += f'<joint name="{link.joint or link.name + "_joint"}" type="fixed">'
            text += f'<parent link="{link.parent}"/><child link="{link.name}"/></joint>'
    return f"{text}{more}</robot>"


def contact(collision: str) -> str:
    return (
        '<gazebo reference="base"><sensor name="s" type="contact"><contact>'
        f"<collision>{collision}</collision></contact></sensor></gazebo>"
    )


def names(
    links: Sequence[Link], more: str = "", respell: Respell = lambda _, name: name
) -> list[str]:
    """Return the made-up names, in document order of the collisions."""
    return list(collision_map(etree.fromstring(robot(links, more)), respell).values())


def postfixed(kind: str, name: str) -> str:
    return f"{name}_r1"


def prefixed(kind: str, name: str) -> str:
    return f"r1_{name}"


BASE = Link("base")
CASES = [
    pytest.param(
        [BASE, Link("lidar", parent="base")],
        "base_fixed_joint_lump__lidar_collision_1",
        "base_r1_fixed_joint_lump__lidar_r1_collision_1",
        "r1_base_fixed_joint_lump__r1_lidar_collision_1",
        id="lumped",
    ),
    pytest.param(
        [BASE, Link("base_scan", parent="base")],
        "base_scan_collision_1",
        "base_r1_fixed_joint_lump__base_scan_r1_collision_1",
        "r1_base_scan_collision_1",
        id="lumped-and-begins-alike",
    ),
    pytest.param(
        [Link("base", ["foo"])],
        "base_fixed_joint_lump__foo_collision",
        "base_r1_fixed_joint_lump__foo_r1_collision",
        "r1_base_fixed_joint_lump__r1_foo_collision",
        id="named",
    ),
    pytest.param(
        [Link("base", ["base_col"])],
        "base_col_collision",
        "base_r1_fixed_joint_lump__base_col_r1_collision",
        "r1_base_col_collision",
        id="named-like-the-link",
    ),
    pytest.param([BASE], "base_collision", "base_r1_collision", "r1_base_collision", id="alone"),
    pytest.param(
        [Link("base", ["", ""])],
        "base_collision_1",
        "base_r1_collision_1",
        "r1_base_collision_1",
        id="second",
    ),
    pytest.param(
        [BASE, Link("mast", ["", ""], "base"), Link("cam", ["lens"], "mast")],
        "base_fixed_joint_lump__lens_collision_3",
        "base_r1_fixed_joint_lump__lens_r1_collision_3",
        "r1_base_fixed_joint_lump__r1_lens_collision_3",
        id="chain",
    ),
    pytest.param(
        [BASE, Link("mast", (), "base"), Link("cam", parent="mast")],
        "base_fixed_joint_lump__cam_collision_1",
        "base_r1_fixed_joint_lump__cam_r1_collision_1",
        "r1_base_fixed_joint_lump__r1_cam_collision_1",
        id="chain-through-an-empty-link",
    ),
]


@pytest.mark.parametrize(("links", "old", "postfix", "prefix"), CASES)
def test_the_name_is_made_anew(links: list[Link], old: str, postfix: str, prefix: str) -> None:
    assert names(links)[-1] == old
    assert names(links, respell=postfixed)[-1] == postfix
    assert names(links, respell=prefixed)[-1] == prefix


@pytest.mark.sample(1)
@pytest.mark.parametrize("scope", ["", "r::base::", "world::r::base::"])
@pytest.mark.parametrize(("links", "old", "postfix", "prefix"), CASES)
def test_a_contact_sensor_follows(
    links: list[Link], old: str, postfix: str, prefix: str, scope: str
) -> None:
    source = robot(links, contact(scope + old))
    for side, new in (("postfix", postfix), ("prefix", prefix)):
        result = rewrite(source, "r1", affix=side, separators=UNDERSCORE)
        assert f"{new}</collision>" in result.text
        (change,) = [change for change in result.changes if change.kind == "collision"]
        assert change.old == scope + old
        assert strip(result.data, "r1", affix=side, separators=UNDERSCORE) == source.encode()


def test_a_link_below_world_is_not_lumped() -> None:
    links = [Link("world", ()), Link("base", parent="world"), Link("lidar", parent="base")]
    assert names(links) == ["base_collision", "base_fixed_joint_lump__lidar_collision_1"]


def test_a_number_that_hangs_on_the_robots_name_is_refused() -> None:
    """``j_b_r1`` sorts before ``j_r1``, but ``j_a1`` before ``j_b_a1``: one plan cannot hold both."""
    links = [BASE, Link("a", parent="base", joint="j"), Link("b", parent="base", joint="j_b")]
    source = robot(links, contact("base_fixed_joint_lump__a_collision_1"))
    with pytest.raises(RewriteRefused) as caught:
        rewrite(source, "r1")
    assert "MB424" in {finding.code for finding in caught.value.findings}
    prefixed = rewrite(source, "r1", affix="prefix").text
    assert "r1/base_fixed_joint_lump__r1/a_collision_1</collision>" in prefixed


SDF = """<sdf version="1.9"><model name="m">
  <link name="tip"><collision name="tip"/></link>
  <model name="hand"><link name="tip"><collision name="c"/></link></model>
  <include><uri>model://tool</uri><name>tool</name></include>
  <link name="base"><sensor name="s" type="contact"><contact>
    <collision>{}</collision></contact></sensor></link>
</model></sdf>"""


@pytest.mark.parametrize(
    ("old", "new"),
    [
        pytest.param("tip", "tip", id="bare"),
        pytest.param("c", "c", id="bare-in-another-scope"),
        pytest.param("tip::tip", "tip/r1::tip", id="link"),
        pytest.param("m::tip::tip", "m_r1::tip/r1::tip", id="model"),
        pytest.param("m::hand::tip::c", "m_r1::hand_r1::tip/r1::c", id="nested"),
        pytest.param("tool::tip::c", "tool_r1::tip::c", id="included"),
        pytest.param("m::tool::tip::c", "m_r1::tool_r1::tip::c", id="included-from-the-root"),
        pytest.param("table::tip::tip", "table::tip::tip", id="another-model"),
    ],
)
def test_a_contact_of_sdf_spells_its_scopes(old: str, new: str) -> None:
    """A collision of SDF has a name of its own; only one made from a URDF link's is recomputed."""
    source = SDF.format(old)
    result = rewrite(source, "r1")
    assert f"<collision>{new}</collision>" in result.text
    assert [it.code for it in result.findings] == ["MB906"]
    assert strip(result.data, "r1") == source.encode()


def test_a_block_for_a_link_and_joint_of_one_name_is_reported() -> None:
    links = [BASE, Link("lidar", parent="base", joint="lidar")]
    try:
        result = rewrite(robot(links, '<gazebo reference="lidar"/>'), "r1")
    except RewriteRefused as error:
        assert [finding.code for finding in error.findings] == ["MB203"]
    else:
        assert '<gazebo reference="lidar/r1"/>' in result.text
        assert [finding.code for finding in result.findings] == ["MB203"]
