# SPDX-License-Identifier: Apache-2.0
"""XML as TinyXML-2 and sdformat read it: the expectations are those of their sources."""

from __future__ import annotations

import pytest

from multibot_rewrite.description.readback.xml import is_on, read_xml, text_of, values_at


# tinyxml2.cpp, XMLElement::GetText and XMLNode::ParseDeep: comments in front are skipped, the first
# text ends at the next child, text of white space alone is no node.
@pytest.mark.parametrize(
    ("xml", "text"),
    [
        ("<a>scan</a>", "scan"),
        ("<a> scan\n</a>", "scan"),
        ("<a><!-- c -->scan</a>", "scan"),
        ("<a>\n  <!-- c -->\n  <!-- d -->\n  scan\n</a>", "scan"),
        ("<a>scan<!-- c -->ner</a>", "scan"),
        ("<a><b/>scan</a>", ""),
        ("<a><!-- c --><b/>scan</a>", ""),
        ("<a><![CDATA[scan]]></a>", "scan"),
        ("<a>&lt;x&gt;</a>", "<x>"),
        ("<a></a>", ""),
        ("<a/>", ""),
        ("<a>   </a>", ""),
    ],
)
def test_text(xml: str, text: str) -> None:
    assert text_of(read_xml(xml.encode(), "")) == text


@pytest.mark.parametrize(
    ("path", "values"),
    [
        ("@name", ["p"]),
        ("ros/namespace", ["", "two"]),
        ("param[@name=x]", ["1"]),
        ("wheel@link", ["l", "r"]),
        ("nothing", []),
        ("wheel@nothing", []),
    ],
)
def test_values(path: str, values: list[str]) -> None:
    text = (
        b'<plugin name=" p "><ros><namespace/><namespace>two</namespace></ros>'
        b'<param name="x">1</param><param name="y">2</param><wheel link="l"/><wheel link="r"/></plugin>'
    )
    assert list(values_at(read_xml(text, ""), path)) == values


# sdformat Param.cc, ValueFromStringImpl: lower case, then true or 1, false or 0.
@pytest.mark.parametrize("usual", [True, False])
@pytest.mark.parametrize(
    ("text", "on"),
    [
        ("true", True),
        ("True", True),
        ("TRUE", True),
        ("1", True),
        (" true ", True),
        ("false", False),
        ("False", False),
        ("0", False),
        ("yes", None),
        ("", None),
        (None, None),
    ],
)
def test_booleans(text: str | None, on: bool | None, usual: bool) -> None:
    assert is_on(text, usual) is (usual if on is None else on)
