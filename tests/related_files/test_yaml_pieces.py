# SPDX-License-Identifier: Apache-2.0
"""Pieces of YAML texts: whole lines, values with their quotes, slots for robots, kinds of files."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from multibot_rewrite.base.model import InputError
from multibot_rewrite.related_files import named_file
from multibot_rewrite.related_files.bridge import faults
from multibot_rewrite.related_files.context import (
    NAMESPACE_SLOT,
    TAG_SLOT,
    check_no_slots,
    fill_template,
    make_template,
)
from multibot_rewrite.related_files.yaml_text import (
    Splice,
    YamlText,
    anchors,
    as_item,
    blocks,
    is_text,
    items,
    line_of,
    lines_of,
    moved,
    newline,
    pairs,
    quoted,
    read_yaml,
    refuse_anchors,
    replaced,
)
from multibot_rewrite.system.json import to_yaml
from multibot_rewrite.system.records import System


def read(text: str) -> YamlText:
    return read_yaml(text.encode(), "a.yaml")


@pytest.mark.parametrize(
    ("value", "style", "text"),
    [
        ("a/b_c.d~e-f", "", "a/b_c.d~e-f"), ("true", "", '"true"'), ("No", "", '"No"'),
        ("~", "", '"~"'),
        ("1a", "", '"1a"'), ("", "", '""'), ("a b", "", '"a b"'), ("it's", "'", "'it''s'"),
        ("a", '"', '"a"'), ('a"\\', "", '"a\\"\\\\"'), ("a\nb", "'", '"a\\nb"'), ("y", "", '"y"'),
        ("-a", "", '"-a"'), ("/a", "", "/a"),
    ],
)  # fmt: skip
def test_a_value_keeps_its_quotes_or_gets_those_that_it_needs(
    value: str, style: str, text: str
) -> None:
    assert quoted(value, style) == text
    assert yaml.safe_load(text) == value


def test_words_that_yaml_1_1_reads_as_something_else_are_quoted() -> None:
    """yaml.org/type/bool.html, null.html; rcl reads as YAML 1.1."""
    for word in ("~", "null", "true", "false", "yes", "no", "on", "off", "y", "n"):
        for it in (word, word.upper(), word.title()):
            assert quoted(it) == f'"{it}"'
            assert f'shared_frames: ["{it}"]' in to_yaml(System(shared_frames=(it,)))


def test_a_scalar_is_replaced_with_its_quotes() -> None:
    document = read("a: 'x'\nb: |\n  text\n")
    assert document.root is not None
    (_, first), (_, block) = pairs(document.root)
    assert isinstance(first, yaml.ScalarNode) and isinstance(block, yaml.ScalarNode)
    assert replaced(first, "y") == Splice(3, 6, "'y'")
    with pytest.raises(ValueError, match="a block scalar is not one name"):
        replaced(block, "y")


def test_parts_of_a_document() -> None:
    document = read("a: 1\na: [x, 'y']\n? [b]\n: 2\n")
    found = pairs(document.root)
    assert [(key.value, line_of(value)) for key, value in found] == [("a", 1), ("a", 2)]
    assert [it.value for it in items(found[1][1])] == ["x", "y"]
    assert [it.value for it in items(found[0][1])] == ["1"]
    assert items(document.root) == items(None) == pairs(None) == pairs(found[0][1]) == []
    assert [is_text(it) for it in items(found[1][1])] == [True, True]
    assert [is_text(it) for it in (found[0][1], found[1][1])] == [False, False]
    assert is_text(pairs(read("a: '1'").root)[0][1])


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b"a: 1\n\xff", "a.yaml:2: it is not UTF-8; save it as UTF-8"),
        (b"a: 1\n---\nb: 2\n", "a.yaml:2:1: not valid YAML: there is more than one document;"
         " delete everything from the second --- on"),
        (b"a:\n\t- b\n", "a.yaml:2:1: not valid YAML: a tab; indent with spaces; YAML does not allow"
         " tabs"),
        (b"a: [\n", "a.yaml:2:1: not valid YAML: "),
    ],
)  # fmt: skip
def test_what_is_no_yaml_is_said_with_its_place(data: bytes, said: str) -> None:
    with pytest.raises(InputError) as caught:
        read_yaml(data, "a.yaml")
    assert str(caught.value).startswith(said)


def test_anchors_and_aliases_are_found() -> None:
    document = read("a: &x 1\nb: *x\nc: 'no &y'\n")
    assert [*anchors(document)] == [(1, "&x"), (2, "*x")]
    with pytest.raises(InputError) as caught:
        refuse_anchors(document)
    assert str(caught.value) == (
        "a.yaml:1: anchors and aliases are not allowed: &x; write the value out"
    )
    refuse_anchors(read("a: 1 & 2\n"))


def test_lines_are_moved_and_made_items() -> None:
    assert lines_of("a\n\nb\x0bc") == ["a\n", "\n", "b\x0bc"]
    assert moved("a\n\n  b\n", 2) == "  a\n\n    b\n"
    assert moved("a\n    b\n", -2) == "a\n  b\n"
    assert as_item("  # c\n\n  a: 1\n  b: 2\n", 2, 4) == "      # c\n\n    - a: 1\n      b: 2\n"
    assert as_item("a: 1\n", 0, 0) == "- a: 1\n"


def test_a_template_is_filled_for_each_robot() -> None:
    text = f"{NAMESPACE_SLOT}/{TAG_SLOT}_x"
    made = make_template("a: b\nc: d\n", [Splice(8, 9, text), Splice(3, 4, TAG_SLOT)])
    assert fill_template(made, "/r", "t") == "a: t\nc: /r/t_x\n"
    assert make_template("", ()).pieces == ("",)
    for slot in (NAMESPACE_SLOT, TAG_SLOT):
        with pytest.raises(InputError) as caught:
            check_no_slots(f"a {slot}", "f")
        assert (
            str(caught.value) == f"f: the word {slot} is reserved for this tool; use another word"
        )
    check_no_slots("multibot", "f")


# ---------------------------------------------------------------- entries of a bridge


def entry(text: str) -> yaml.Node:
    (node,) = items(read(text).root)
    return node


OUT = "the bridge leaves it out"
TYPES = "ros_type_name: a, gz_type_name: b"
BOTH_TYPES = "ros_type_name and gz_type_name"


@pytest.mark.parametrize(
    ("row", "found"),
    [
        (f"- {{topic_name: /a, {TYPES}}}", []),
        (f"- {{gz_topic_name: /a, {TYPES}, direction: ROS_TO_GZ}}", []),
        (f"- {{ros_topic_name: /a, {TYPES}, direction: BIDIRECTIONAL}}", []),
        ("- {service_name: /a}", []),
        ("- a", [(f"the row is not a map of keys and values: {OUT}", "")]),
        (
            f"- {{topic_name: /a, ros_topic_name: /b, gz_topic_name: /c, {TYPES}}}",
            [
                (f"the row has topic_name and ros_topic_name: {OUT}", "delete topic_name"),
                (f"the row has topic_name and gz_topic_name: {OUT}", "delete topic_name"),
            ],
        ),
        (
            f"- {{topic_name: /a, {TYPES}, direction: GZ_TO_RO}}",
            [(f"the bridge has no direction 'GZ_TO_RO': {OUT}", "did you mean 'GZ_TO_ROS'?")],
        ),
        (f"- {{{TYPES}}}", [(f"the row has no ros_topic_name: {OUT}", "add ros_topic_name")]),
        (
            "- {topic_name: /a}",
            [(f"the row has no {BOTH_TYPES}: {OUT}", f"add {BOTH_TYPES}")],
        ),
        (
            "- {topic_name: /a, ros_type_name: a}",
            [(f"the row has no gz_type_name: {OUT}", "add gz_type_name")],
        ),
    ],
)  # fmt: skip
def test_what_a_bridge_leaves_out(row: str, found: list[tuple[str, str]]) -> None:
    """gazebosim/ros_gz bridge_config.cpp parseEntry."""
    assert [(it.message, it.hint) for it in faults(entry(row))] == found


# ---------------------------------------------------------------- kinds of files


PARAMS, TREE = (
    "a:\n  ros__parameters:\n    x: 1\n",
    '<root BTCPP_format="4"><BehaviorTree ID="a"/></root>',
)


def test_xml_is_beside_a_description_where_it_is_a_tree(tmp_path: Path) -> None:
    tree, other = tmp_path / "tree.XML", tmp_path / "other.xml"
    tree.write_text(TREE)
    other.write_text('<robot name="r"/>')
    gone = str(tmp_path / "gone.xml")
    assert [named_file.is_related_file(it) for it in (str(tree), str(other), gone)] == [
        True,
        False,
        False,
    ]
    assert [named_file.is_linted(it) for it in (str(tree), str(other), gone)] == [
        True,
        False,
        False,
    ]
    texts = (TREE.encode(), b"\xef\xbb\xbf \n" + TREE.encode(), b"<robot/>", b"a: 1", b"")
    assert [named_file.is_related_file(it) for it in texts] == [True, True, False, True, True]


@pytest.mark.parametrize("end", ["\r", "\r\n", "\x85", "\u2028"])
def test_lines_end_where_yaml_ends_them(end: str) -> None:
    """A group of displays is whole lines: the file of an editor with its own line ends is one line to
    who looks for line feeds alone."""
    lines = ["Visualization Manager:", "  Displays:"]
    for name in ("scan", "more"):
        lines += [
            "    - Class: rviz_default_plugins/LaserScan",
            f"      Name: {name}",
            "      Topic:",
        ]
        lines += [f"        Value: /{name}"]
    whole = read_yaml("\n".join([*lines, ""]).encode(), "f")
    other = read_yaml(end.join([*lines, ""]).encode(), "f")

    def entries(document: YamlText) -> list[str]:
        assert document.root is not None
        ((_, below),) = pairs(document.root)
        ((_, displays),) = pairs(below)
        assert newline(document) == ("\n" if document is whole else end)
        return [document.text[it.start : it.end] for it in blocks(document, displays)]

    assert entries(other) == [it.replace("\n", end) for it in entries(whole)]
    assert [moved(it, 2) for it in entries(other)] == [
        moved(it, 2).replace("\n", end) for it in entries(whole)
    ]
