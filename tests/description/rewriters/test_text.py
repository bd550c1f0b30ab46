# SPDX-License-Identifier: Apache-2.0
"""The text in force, as TinyXML-2's GetText has it."""

from __future__ import annotations

import pytest
from lxml import etree

from multibot_rewrite import rewrite
from multibot_rewrite.description.rewriters.text import text_at, text_of


# tinyxml2.cpp: comments are skipped, then the first node counts if it is text; white space is no node.
@pytest.mark.parametrize(
    ("inside", "text"),
    [
        ("imu", "imu"),
        (" imu\n", "imu"),
        ("<!-- a -->imu", "imu"),
        (" <!-- a --> <!-- b -->\n imu ", "imu"),
        ("a<!-- c -->b", "a"),
        ("<!-- c -->a<!-- d -->b", "a"),
        ("<x/>imu", ""),
        ("<!-- c --><x/>imu", ""),
        ("a<x/>b", "a"),
        ("<!-- imu -->", ""),
        ("", ""),
    ],
)
def test_the_first_text_behind_comments_counts(inside: str, text: str) -> None:
    root = etree.fromstring(f"<r><topic>{inside}</topic><topic>other</topic></r>")
    assert text_of(root[0]) == text_at(root, "topic") == text
    assert text_at(root, "none") == ""


def test_a_claimed_text_behind_a_comment_is_no_mention() -> None:
    source = """<robot name="r"><link name="base"/><gazebo>
<canonicalBody><!-- c -->base</canonicalBody>
<own>base</own></gazebo></robot>"""
    found = rewrite(source, "r1").findings
    assert [(it.code, it.line) for it in found] == [("MB901", 3)]
