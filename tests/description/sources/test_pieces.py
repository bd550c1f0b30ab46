# SPDX-License-Identifier: Apache-2.0
"""Every piece of a value knows where it was written: read off the files by hand, and verified by
changing them."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

import pytest

from multibot_rewrite.description.sources.access import BOUNDED
from multibot_rewrite.description.sources.expand import Expansion, expand_traced, expand_whole
from multibot_rewrite.description.sources.trace import Piece
from multibot_rewrite.description.steps.document import read_document

HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
# What is in the robot -> the pieces of the name of its last link, as (text, kind, as it is written).
CASES = {
    "literal": ('<link name="base"/>', [("base", "literal", "base")]),
    "property": (
        '<xacro:property name="side" value="left"/><link name="wheel_${side}_link"/>',
        [
            ("wheel_", "literal", "wheel_"),
            ("left", "property", "left"),
            ("_link", "literal", "_link"),
        ],
    ),
    "argument": (
        '<xacro:arg name="p" default="a_"/><link name="$(arg p)base"/>',
        [("a_", "argument", "a_"), ("base", "literal", "base")],
    ),
    "argument in an expression": (
        """<xacro:arg name="p" default="a_"/><link name="${xacro.arg('p')}base"/>""",
        [("a_", "argument", "a_"), ("base", "literal", "base")],
    ),
    "argument given": (
        '<xacro:arg name="given" default=""/><link name="$(arg given)base"/>',
        [("mine_", "given argument", ""), ("base", "literal", "base")],
    ),
    "parameter": (
        '<xacro:macro name="m" params="n"><link name="${n}_link"/></xacro:macro><xacro:m n="arm"/>',
        [("arm", "parameter", "arm"), ("_link", "literal", "_link")],
    ),
    "parameter of a parameter": (
        '<xacro:macro name="i" params="n"><link name="${n}"/></xacro:macro>'
        '<xacro:macro name="o" params="n"><xacro:i n="${n}_2"/></xacro:macro><xacro:o n="arm"/>',
        [("arm", "parameter", "arm"), ("_2", "parameter", "_2")],
    ),
    "default of a parameter": (
        '<xacro:macro name="m" params="a:=1 n:=arm"><link name="${n}"/></xacro:macro><xacro:m/>',
        [("arm", "default", "arm")],
    ),
    "number": (
        '<xacro:property name="n" value="3"/><link name="leg_${n + 1}"/>',
        [("leg_", "literal", "leg_"), ("4", "expression", "${n + 1}")],
    ),
    "sum": (
        """<xacro:property name="n" value="arm"/><link name="${n + '_link'}"/>""",
        [("arm", "property", "arm"), ("_link", "literal", "_link")],
    ),
    "word that is there twice": (
        """<link name="${'a' if True else 'a'}"/>""",
        [("a", "expression", "${'a' if True else 'a'}")],
    ),
    "changed text": (
        """<xacro:property name="n" value="ARM"/><link name="${n.lower()}"/>""",
        [("arm", "expression", "${n.lower()}")],
    ),
    "part of a text": (
        """<xacro:property name="n" value="left_arm"/><link name="${n[5:]}"/>""",
        [("arm", "property", "arm")],
    ),
    "quotes that xacro takes off": (
        """<xacro:property name="n" value="'arm'"/><link name="l_${n}"/>""",
        [("l_", "literal", "l_"), ("arm", "property", "arm")],
    ),
    "dollar": ('<link name="a$${b}"/>', [("a", "literal", "a"), ("${b}", "literal", "${b}")]),
    "block": (
        '<xacro:macro name="m" params="*b"><xacro:insert_block name="b"/></xacro:macro>'
        '<xacro:property name="s" value="x"/><xacro:m><link name="in_${s}"/></xacro:m>',
        [("in_", "literal", "in_"), ("x", "property", "x")],
    ),
    "attribute that is made": (
        '<link name="no"><xacro:attribute name="name" value="yes"/></link>',
        [("yes", "parameter", "yes")],
    ),
}


def expanded(path: Path, changed: Mapping[str, bytes] | None = None) -> Expansion:
    data = (changed or {}).get(str(path)) or path.read_bytes()
    given = {"given": "mine_"} if b'"given"' in data else {}
    return expand_traced(str(path), data, given, None, BOUNDED, True, changed or {})


def values(read: Expansion) -> list[tuple[str, tuple[Piece, ...]]]:
    """Each value of a result with its pieces."""
    found = []
    for number, element in enumerate(read_document(read.data, "r").elements):
        texts = [("", element.text)] if element.text and not len(element) else []
        for attribute, value in (*element.attrib.items(), *texts):
            found.append((str(value), read.pieces.of(number, str(attribute), str(value))))
    return found


@pytest.mark.parametrize("case", CASES)
def test_the_pieces_of_a_name_stand_where_they_are_written(case: str, tmp_path: Path) -> None:
    inside, wanted = CASES[case]
    path = tmp_path / "r.urdf.xacro"
    path.write_text(f"{HEAD}\n{inside}\n</robot>")
    read = expanded(path)
    _, pieces = values(read)[-1]
    source = path.read_bytes()
    found = [(it.text, it.kind, source[it.start : it.end].decode()) for it in pieces]
    assert found == wanted


def test_a_name_in_yaml_stands_in_that_file(tmp_path: Path) -> None:
    (tmp_path / "names.yaml").write_text("arms:\n  - first\n  - 'second'\n")
    path = tmp_path / "r.urdf.xacro"
    path.write_text(
        f"{HEAD}<xacro:property name='y' value=\"${{xacro.load_yaml('names.yaml')}}\"/>"
        '<link name="${y.arms[0]}_link"/><link name="${y.arms[1]}"/></robot>'
    )
    *_, (_, first), (_, second) = values(expanded(path))
    source = (tmp_path / "names.yaml").read_bytes()
    for piece, text in ((first[0], "first"), (second[0], "second")):
        assert (piece.kind, os.path.basename(piece.file)) == ("YAML", "names.yaml")
        assert source[piece.start : piece.end] == text.encode()


@pytest.mark.more
@pytest.mark.parametrize(
    "file", ["fixtures/xacros/arm.urdf.xacro", "examples/namespace_and_prefix/hexbase.urdf.xacro"]
)
def test_a_mark_in_a_piece_comes_out_in_each_value_that_has_it(file: str) -> None:
    """The text is what xacro makes without a look at pieces; and each piece, changed, changes these
    values."""
    path = Path(file)
    read = expanded(path)
    assert read.data == expand_whole(file, {}).data
    every = values(read)
    written = {
        (it.file, it.start, it.end)
        for value, pieces in every
        for it in pieces
        if value.isidentifier() and it.kind in ("literal", "parameter", "property", "default")
    }
    assert len(written) > 3
    for name, start, end in sorted(written)[::3]:
        source = Path(name).read_bytes()
        changed = {os.path.realpath(name): source[:end] + b"QZ" + source[end:]}
        mine = {**changed, str(path): changed.get(os.path.realpath(path), path.read_bytes())}
        wanted = [
            "".join(
                it.text + "QZ" * ((it.file, it.start, it.end) == (name, start, end))
                for it in pieces
            )
            or value
            for value, pieces in every
        ]
        assert [value for value, _ in values(expanded(path, mine))] == wanted
