# SPDX-License-Identifier: Apache-2.0
"""Parameters with the types that rcl gives them (rcl_yaml_param_parser parse.c, get_value)."""

from __future__ import annotations

import math

import pytest
from related_file_calls import YamlText, flattened, raw_sections, read_yaml

from multibot_rewrite.base.model import InputError
from multibot_rewrite.related_files.params.rcl_parameters import (
    check_values,
    exact_nodes,
    node_parameters,
    typed,
)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("0", 0), ("-7", -7), ("+7", 7), ("0x1F", 31), ("0X1f", 31), ("-0x10", -16), ("017", 15),
        ("9223372036854775807", 2**63 - 1), ("-9223372036854775808", -(2**63)),
        ("9223372036854775808", 9223372036854775808.0),
        ("1.", 1.0), (".5", 0.5), ("-1.5e-3", -0.0015), ("1e3", 1000.0), ("09", 9.0), ("0x1.8p1", 3.0),
        ("0x1p-1", 0.5), ("0x.8", 0.5), (".inf", math.inf), ("-.INF", -math.inf), ("+.Inf", math.inf),
        ("inf", math.inf), ("-Infinity", -math.inf), ("INF", math.inf),
        ("1e400", "1e400"), ("1e-400", "1e-400"), ("1e-310", "1e-310"), ("0e-400", 0.0),
        ("tRUE", "tRUE"), ("oN", "oN"), ("1_000", "1_000"), ("1:30", "1:30"), ("0b1", "0b1"),
        ("a", "a"), ("inf(x)", "inf(x)"), (".iNf", ".iNf"), ("1e", "1e"), ("0x", "0x"), (".", "."),
    ],
)  # fmt: skip
def test_what_is_a_number(text: str, value: object) -> None:
    found = typed(text)
    assert (found, type(found)) == (value, type(value))


@pytest.mark.parametrize("text", [".nan", ".NaN", ".NAN", "nan", "NaN", "-nan", "nan(1_a)"])
def test_what_is_no_number_is_one(text: str) -> None:
    found = typed(text)
    assert isinstance(found, float) and math.isnan(found)


OF_SINGLE = "p.yaml:3: a list holds a list or a map; rcl takes single values only"


def read(text: str) -> YamlText:
    return read_yaml(text.encode(), "p.yaml")


FILE = """\
/**: {ros__parameters: {a: 1, b: {c: x, d.e: [1, 2]}}}
/r/node: {ros__parameters: {a: "2", b: {c: !!str 5}}}
/*/node: {ros__parameters: {only: [a, "1"]}}
other: {ros__parameters: {a: 9}}
"""


def test_a_later_section_wins() -> None:
    assert node_parameters(read(FILE), "/r/node") == {
        "a": "2", "b.c": "5", "b.d.e": [1, 2], "only": ["a", "1"],
    }  # fmt: skip
    assert node_parameters(read(FILE), "/else") == {"a": 1, "b.c": "x", "b.d.e": [1, 2]}
    assert exact_nodes(read(FILE)) == ["/r/node", "/other"]


def test_a_list_of_one_mapping_is_that_mapping() -> None:
    """As a node of rclpy jazzy has them, given such a file with --params-file."""
    text = read("a: {ros__parameters: {x: {y: [{only: [b, c]}], z: [{w: [{v: [1]}]}]}}}\n")
    assert node_parameters(text, "/a") == {"x.y.only": ["b", "c"], "x.z.w.v": [1]}
    assert [name for name, _ in flattened(raw_sections(text)[0].body)] == ["x.y.only", "x.z.w.v"]


@pytest.mark.parametrize(
    ("value", "said"),
    [
        ("[{a: [1], b: [2]}]", OF_SINGLE),
        ("[{a: [1]}, {b: [2]}]", OF_SINGLE),
        # A single value becomes a list there.
        ("[{a: 1}]", OF_SINGLE),
        ("[{}]", OF_SINGLE),
        ("[1, [2]]", OF_SINGLE),
        (
            "[1, 2.0]",
            "p.yaml:3: the list mixes types, which rcl rejects; write all as floats, or quote all",
        ),
        ("", 'p.yaml:3: the value is missing; write "" for an empty string'),
    ],
)
def test_what_rcl_rejects_is_said(value: str, said: str) -> None:
    text = read(f"a:\n  ros__parameters:\n    x: {value}\n")
    with pytest.raises(InputError) as caught:
        check_values(text)
    assert str(caught.value) == said
    check_values(read('a: {ros__parameters: {x: "", y: [1.0, 2.0], z: []}}'))
