"""Names in values that no site claims: where they are seen, and what is no name."""

from __future__ import annotations

import pytest

from multibot_rewrite import rewrite
from multibot_rewrite.description.checks.mentions import mentioned

NAMES = frozenset(("wl", "wr", "arm.left", "a::b", "robot1/base", "x|y"))
PLAIN = frozenset(("wl", "wr", "arm"))


@pytest.mark.parametrize(
    ("value", "name"),
    [
        ("wl", "wl"),
        ('["wl","wr"]', "wl"),
        ("['wr']", "wr"),
        ("{left: wl}", "wl"),
        ("{left:wr, right:wl}", "wr"),
        ("left=wl|right=wr", "wl"),
        ("wr.position", "wr"),
        ("(wl)", "wl"),
        ("f(wr)", "wr"),
        ("joints: [a, wr]", "wr"),
        ("wl/position", "wl"),
        ("rover::wl", "wl"),
        ("a:=wl", "wl"),
        ("a;wl", "wl"),
        ("package://p/m.dae;wl", "wl"),
        ("arm.left, other", "arm.left"),
        ("[arm.left]", "arm.left"),
        ("(a::b)", "a::b"),
        ("{at: robot1/base}", "robot1/base"),
        ("x|y", "x|y"),
    ],
)
def test_a_name_is_seen_between_whatever_separates(value: str, name: str) -> None:
    assert mentioned(value, NAMES) == name


@pytest.mark.parametrize(
    "value",
    [
        "wl_joint",
        "wlx",
        "the-wl",
        "WL",
        "wl.dae",
        "meshes/wl/wl.STL",
        "arm.yaml",
        "package://arm/meshes/wl",
        "package://wl/meshes/arm.dae",
        "file:///home/arm/wl",
        "model://arm",
        '["meshes/wl.stl", "arm.png"]',
        "libarm.so",
        "arm/arm.so",
        "1.0 2.0 wl_",
        "",
    ],
)
def test_parts_of_words_files_and_addresses_are_no_names(value: str) -> None:
    assert mentioned(value, PLAIN) == ""


@pytest.mark.parametrize("value", ['["wl","wr"]', "{left: wl}", "wl=1|wr=2", "wl.position", "(wl)"])
def test_a_rewrite_warns_of_it(value: str) -> None:
    links = '<link name="wl"/><link name="wr"/>'
    text = f"<robot name='r'>{links}<gazebo><own>{value}</own></gazebo></robot>"
    (found,) = (it for it in rewrite(text, "robot1").findings if it.code == "MB901")
    assert "'wl'" in found.message and found.column == text.index(value) + 1
