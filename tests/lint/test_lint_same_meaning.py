# SPDX-License-Identifier: Apache-2.0
"""When two descriptions say the same: what a fix between versions of URDF may change, and what not."""

from __future__ import annotations

import pytest
from lxml import etree

from multibot_rewrite.lint.fix import same_meaning

CAPSULE = (
    '<link name="a"><collision><origin xyz="0 0 1"/><geometry><capsule radius="0.1" length="2"/>'
    '</geometry><material name="m"/></collision></link>'
)
BALL = (
    '<collision><origin xyz="0 0 {}"/><geometry><sphere radius="{}"/></geometry>'
    '<material name="m"/></collision>'
)
CYLINDER = CAPSULE.replace("capsule", "cylinder")


def with_balls(*balls: str) -> str:
    return CYLINDER.replace("</link>", f"{''.join(balls)}</link>")


@pytest.mark.parametrize(
    ("one", "other", "same"),
    [
        ('<link name="a"/>', '<link  name = "a" ></link>', True),
        ('<link name="a"/>', '<link name="b"/>', False),
        ('<link name="a"/>', '<joint name="a"/>', False),
        ('<link name="a"/>', '<link name="a" x=""/>', False),
        ("<a> x </a>", "<a>x</a>", True),
        ("<a>x</a>", "<a>y</a>", False),
        ("<a><b/> x</a>", "<a><b/>x</a>", True),
        ("<a><b/>x</a>", "<a><b/>y</a>", False),
        ("<a><b/><c/></a>", "<a><c/><b/></a>", False),
        ("<a><b/></a>", "<a><b/><b/></a>", False),
        ('<a><b c="1"/><d/></a>', '<a><b c="2"/><d/></a>', False),
        # The version of a URDF is no content; that of another element is.
        ('<robot name="r" version="1.0"/>', '<robot name="r" version="1.2"/>', True),
        ('<a version="1.0"/>', '<a version="1.2"/>', False),
        # A pose by its numbers, whichever way a rotation is written.
        ('<origin xyz="0 0 1"/>', '<origin xyz="0.0 0 1.00" rpy="0 0 0"/>', True),
        ('<origin xyz="0 0 1"/>', '<origin xyz="0 0 1.1"/>', False),
        ('<origin xyz="1 0 0"/>', '<origin xyz="0 0 0"/>', False),
        ('<origin rpy="0 0 3.14159265358979"/>', '<origin quat_xyzw="0 0 1 0"/>', True),
        ('<origin rpy="0 0 3.14159265358979"/>', '<origin quat_xyzw="0 1 0 0"/>', False),
        ('<origin xyz="a"/>', '<origin xyz="b"/>', False),
        ('<a xyz="0 0 1"/>', '<a xyz="0 0 1.0"/>', False),
        # A capsule is a cylinder with a ball at either end.
        (CAPSULE, with_balls(BALL.format("2.0", "0.1"), BALL.format("0.0", "0.1")), True),
        (CAPSULE, with_balls(BALL.format("2.0", "0.1"), BALL.format("0.5", "0.1")), False),
        (CAPSULE, with_balls(BALL.format("2.0", "0.1"), BALL.format("0.0", "0.2")), False),
        (CAPSULE, with_balls(BALL.format("2.0", "0.1")), False),
        (CAPSULE, CYLINDER, False),
    ],
)
def test_two_texts_say_the_same(one: str, other: str, same: bool) -> None:
    assert same_meaning(etree.fromstring(one), etree.fromstring(other)) is same
    assert same_meaning(etree.fromstring(other), etree.fromstring(one)) is same
