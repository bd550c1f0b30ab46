# SPDX-License-Identifier: Apache-2.0
"""Pieces of YAML texts: whole lines, values with their quotes, slots for robots, kinds of files."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml
from paths import fixture_text

from multibot_rewrite.base.model import InputError
from multibot_rewrite.companions import named_file
from multibot_rewrite.companions.bridge_entry import (
    below as below_of,
    faults,
    model_of,
    models,
    row_of,
    text_in,
)
from multibot_rewrite.companions.context import (
    NAMESPACE_SLOT,
    TAG_SLOT,
    check_no_slots,
    fill_template,
    make_template,
)
from multibot_rewrite.companions.yaml_text import (
    Splice,
    YamlText,
    anchors,
    as_item,
    blocks,
    cut_out,
    is_block,
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
    spliced,
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


def test_splices_are_made_in_their_order() -> None:
    document = read("\ufeffabc: d\n")
    assert spliced(document, [Splice(5, 6, "x"), Splice(0, 3, "key")]) == "\ufeffkey: x\n"
    assert (document.bom, document.text) == ("\ufeff", "abc: d\n")


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


LIST = fixture_text("yaml_pieces_list.txt")


def test_entries_are_whole_lines_with_the_comments_above_them() -> None:
    document = read(LIST)
    assert document.root is not None and is_block(document.root)
    found = blocks(document, document.root)
    assert [LIST[it.start : it.end] for it in found] == [
        "- a: 1\n  b: |\n    text\n", "# about the second\n- {a: 2}\n", "\n- a: 3\n",
    ]  # fmt: skip
    assert {it.column for it in found} == {0}
    after = read("\n- a: 1\n")
    assert after.root is not None and blocks(after, after.root) == [(1, 8, 0)]
    flow = read("[a, b]")
    assert flow.root is not None and blocks(flow, flow.root) == [] and not is_block(flow.root)
    assert not is_block(None)
    maps = read("x:\n  a: 1\n  b: 2")
    inner = pairs(maps.root)[0][1]
    assert [(maps.text[it.start : it.end], it.column) for it in blocks(maps, inner)] == [
        ("  a: 1\n", 2), ("  b: 2", 2),
    ]  # fmt: skip


def test_a_piece_ends_with_the_line_end_of_its_text() -> None:
    document = read("a: 1\r\nb: 2")
    assert newline(document) == "\r\n" and newline(read("a: 1")) == "\n"
    assert cut_out(document, 6, 10) == "b: 2\r\n"
    assert cut_out(document, 0, 6, [Splice(3, 4, "x")]) == "a: x\r\n"
    assert cut_out(document, 3, 3) == ""


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


def test_values_of_an_entry_and_its_model() -> None:
    row = row_of(entry("- {a: 1, b: [2]}"))
    assert [text_in(row, it) for it in "abc"] == ["1", "", ""]
    text = (
        "- {gz_topic_name: /world/w/clock}\n- {topic_name: /model/rover/odom}\n"
        "- {gz_topic_name: /world/w/model/arm/x}\n- {topic_name: model/c}\n"
        "- {gz_topic_name: '/model/${name}/x'}\n- {ros_topic_name: /model/d/x}\n"
    )
    assert [name for _, name in models(read(text))] == ["rover", "arm", "c"]
    assert (model_of(read(text)), model_of(read("- {topic_name: /a}"))) == ("rover", "")
    assert [below_of(*it) for it in (("a", "b"), ("/a", "b"), ("a", ""))] == ["/b/a", "/a", "a"]


# ---------------------------------------------------------------- kinds of files


PARAMS, TREE = (
    "a:\n  ros__parameters:\n    x: 1\n",
    '<root BTCPP_format="4"><BehaviorTree ID="a"/></root>',
)


@pytest.mark.parametrize(
    ("name", "is_one"),
    [("a.yaml", True), ("A.YML", True), ("a.rviz", True), ("a.LUA", True), ("a.xml", False),
     ("a.XML", False), ("a.urdf", False), ("yaml", False)],
)  # fmt: skip
def test_files_that_are_called_as_those_beside_a_description(name: str, is_one: bool) -> None:
    assert named_file.is_named_beside(name) is is_one
    assert named_file.is_beside(name) is is_one


def test_xml_is_beside_a_description_where_it_is_a_tree(tmp_path: Path) -> None:
    tree, other = tmp_path / "tree.XML", tmp_path / "other.xml"
    tree.write_text(TREE)
    other.write_text('<robot name="r"/>')
    gone = str(tmp_path / "gone.xml")
    assert [named_file.is_beside(it) for it in (str(tree), str(other), gone)] == [
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
    assert [named_file.is_beside(it) for it in texts] == [True, True, False, True, True]


def test_of_yaml_in_a_folder_what_is_known_is_linted(tmp_path: Path) -> None:
    known, other = tmp_path / "p.yaml", tmp_path / "o.yaml"
    known.write_text(PARAMS)
    other.write_text("a: 1\n")
    found = (str(known), str(other), str(tmp_path / "gone.yaml"), str(tmp_path / "a.urdf"))
    # What cannot be read is reported where it is read.
    assert [named_file.is_linted(it) for it in found] == [True, False, True, True]
    assert (named_file.kind_of(PARAMS.encode()), named_file.kind_of(b"a: 1")) == (
        named_file.PARAMS,
        "",
    )


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
