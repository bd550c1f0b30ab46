# SPDX-License-Identifier: Apache-2.0
"""Damaged xacro files: each is expanded or refused in one line; nothing else comes out of xacro."""

from __future__ import annotations

import random
from collections import Counter
from pathlib import Path

import pytest
from lxml import etree
from paths import FIXTURES

from multibot_rewrite.base.model import InputError
from multibot_rewrite.description.sources.expand import expand

pytestmark = pytest.mark.slow

XACRO = "http://www.ros.org/wiki/xacro"
ROVER = (FIXTURES / "robots" / "rover.urdf.xacro").read_bytes()
# Some of all there is in xacro.
SAMPLER = f"""\
<robot xmlns:xacro="{XACRO}" name="r"><xacro:arg name="a" default="1"/>
<xacro:property name="p" value="${{[1,2,{{'a':3}}]}}"/><xacro:property name="y" value="${{dict(a=1)}}"/>
<xacro:macro name="m" params="x:=1 y:=^|2 *b **c"><link name="l${{x}}">
<xacro:insert_block name="b"/></link></xacro:macro><xacro:m x="3"><visual/><c/></xacro:m>
<xacro:if value="${{p[0]==1}}"><link name="${{y['a']}}"/></xacro:if><xacro:unless value="$(arg a)"/>
<xacro:element xacro:name="joint"/><xacro:attribute name="q" value="1"/>
<xacro:call macro="m" x="$(eval 1+1)"><visual/><c/></xacro:call>
<link name="$(optenv HOME x)$(dirname)"/></robot>""".encode()
WORDS = (
    "", "${p}", "${p[9]}", "${1/0}", "${None}", "$(arg zz)", "$(find nope)", "$(env NOPE)",
    "$(eval 1+)", "${y.zz}", '${"a"+1}', "**b", "x:=", "x:=^", "1e999", '${load_yaml("x")}',
    "${(lambda:0)()}", "-", "ns.m", "m", "maybe", '${open("/nope")}', "${p", "$(", "xacro:if",
    "${python.len}", "${a=1}", "..",
)  # fmt: skip
NAMES = ("name", "value", "params", "macro", "file", "ns", "default", "scope", "remove", "x")
TAGS = ("if", "property", "macro", "include", "arg", "element", "attribute", "call", "m", "nope")
FEW, MANY = 150, 3_000


def damaged(chance: random.Random, data: bytes) -> bytes:
    """Return the file with a value, an attribute, a tag or a text that is another one."""
    root = etree.fromstring(data)
    elements = list(root.iter("*"))
    for _ in range(chance.randint(1, 3)):
        element, word = chance.choice(elements), chance.choice(WORDS)
        kind = chance.choice(("value", "value", "gone", "more", "tag", "text"))
        if kind in ("value", "gone") and element.attrib:
            name = chance.choice(list(element.attrib))
            element.set(name, word) if kind == "value" else element.attrib.pop(name)
        elif kind == "tag":
            element.tag = f"{{{XACRO}}}{chance.choice(TAGS)}"
        elif kind == "text":
            element.text = word
        else:
            element.set(chance.choice(NAMES), word)
    return etree.tostring(root)


def outcomes(times: int, folder: Path) -> Counter[str]:
    """How many damaged files were expanded and how many refused; anything else is raised."""
    chance = random.Random(times)
    counts: Counter[str] = Counter()
    file = folder / "damaged.xacro"
    for _ in range(times):
        file.write_bytes(damaged(chance, chance.choice((ROVER, SAMPLER, SAMPLER))))
        try:
            etree.fromstring(expand(str(file), {}))
            counts["expanded"] += 1
        except InputError as error:
            assert "\n" not in str(error)
            counts["refused"] += 1
    return counts


@pytest.mark.parametrize("tag", ["nope", "macro", "if", "robot"])
def test_a_root_in_the_xacro_namespace_is_refused(tmp_path: Path, tag: str) -> None:
    file = tmp_path / "my.urdf.xacro"
    file.write_text(f'<xacro:{tag} xmlns:xacro="{XACRO}" name="r"><link name="a"/></xacro:{tag}>')
    with pytest.raises(InputError, match=rf"my\.urdf\.xacro: the root element is <xacro:{tag}>"):
        expand(str(file), {})


def assert_both(counts: Counter[str]) -> None:
    """Neither is all there is, or nothing was tested."""
    assert min(counts["expanded"], counts["refused"]) > sum(counts.values()) / 20


def test_a_damaged_file_is_expanded_or_refused(tmp_path: Path) -> None:
    assert_both(outcomes(FEW, tmp_path))


@pytest.mark.deep
def test_many_damaged_files_are_expanded_or_refused(tmp_path: Path) -> None:
    assert_both(outcomes(MANY, tmp_path))
