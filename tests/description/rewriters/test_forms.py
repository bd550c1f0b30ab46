# SPDX-License-Identifier: Apache-2.0
"""The names inside a value, by the form that its row of the plugin definitions says."""

from __future__ import annotations

from typing import Any

import pytest
from lxml import etree

from multibot_rewrite.base.model import Claim
from multibot_rewrite.description.readback.parameters import default_of
from multibot_rewrite.description.rewriters.forms import FORMS, IN_FRONT, LONGEST
from multibot_rewrite.description.rewriters.plugin_definitions.grammar import SPAWNED


def claim(attribute: str) -> Any:
    return Claim(None, None, 0, attribute, "")  # type: ignore[arg-type]


DECLARED: Any = {
    "model": {"rover": claim("name"), "dock": claim("")},
    "link": dict.fromkeys(("base", "a::b", "arm/tip"), claim("name")),
    "joint": dict.fromkeys(("wheel", "arm"), claim("name")),
    "light": {"lamp": claim("name")},
}


def parts(form: str, value: str, *kinds: str) -> list[tuple[Any, ...]]:
    """Each name with its kinds, what must be declared with a !, what it matches behind a ~."""
    found = FORMS[form](value, kinds, DECLARED)
    for it in found:
        assert value[it.at :].startswith(it.text)
    return [
        (it.at, it.text, "!" * it.closed + " ".join(it.kinds) + "~" * bool(it.matched))
        for it in found
    ]


@pytest.mark.parametrize(
    ("form", "value", "kinds", "found"),
    [
        ("whole", "base", "link", [(0, "base", "link")]),
        ("whole", " base\n", "link", [(1, "base", "link")]),
        ("whole", "", "link", []),
        ("whole", "  ", "link", []),
        ("prefix", " r_ ", "joint link", [(1, "r_", "joint link~")]),
        ("prefix", "", "joint", [(0, "", "joint~")]),
        ("lettered", " Lr_", "joint", [(2, "r_", "joint~")]),
        ("lettered", "", "joint", []),
        ("list", "a, b a", "joint", [(0, "a", "joint"), (3, "b", "joint"), (5, "a", "joint")]),
        ("list", " ,", "joint", []),
        ("scoped", "base", "link", [(0, "base", "!link")]),
        ("scoped", " rover::base ", "link", [(1, "rover", "!model"), (8, "base", "!link")]),
        ("scoped", "other::base", "link", []),
        # What an included model holds is named in its own file.
        ("scoped", "dock::plate", "link", [(0, "dock", "!model")]),
        ("scoped", "a::b", "link", [(0, "a::b", "!link")]),
        ("scoped", "rover::a::b", "link", [(0, "rover", "!model"), (7, "a::b", "!link")]),
        (
            "words",
            "(x base, y wheel)",
            "link joint",
            [(3, "base", "!link"), (11, "wheel", "!joint")],
        ),
        ("words", "base-1", "link", []),
        ("suffixed", "base/lamp", "link light", [(0, "base", "link"), (5, "lamp", "!light")]),
        ("suffixed", "base::lamp", "link light", [(0, "base", "link"), (6, "lamp", "!light")]),
        ("suffixed", "base/other", "link light", [(0, "base", "link")]),
        ("suffixed", "rover::base::x", "link light", [(0, "rover", "!model"), (7, "base", "link")]),
        ("suffixed", "arm/tip/x", "link light", [(0, "arm/tip", "link")]),
        ("suffixed", "no/lamp", "link light", [(0, "no", "link"), (3, "lamp", "!light")]),
        ("suffixed", "base", "link light", [(0, "base", "link")]),
        ("member", "eye", "sensor", [(0, "eye", "sensor")]),
        ("member", "base::eye", "sensor", [(0, "base", "link"), (6, "eye", "sensor")]),
        ("member", "base/eye", "sensor", [(0, "base", "link"), (5, "eye", "sensor")]),
        (
            "member",
            "world::rover::base::eye",
            "sensor",
            [(7, "rover", "!model"), (14, "base", "link"), (20, "eye", "sensor")],
        ),
        (
            "member",
            "other::base::eye",
            "sensor",
            [(0, "other", "!model"), (7, "base", "link"), (13, "eye", "sensor")],
        ),
        ("member", "no::eye", "sensor", []),
        ("transport", "~/rover/odom", "topic", [(2, "rover", "!model")]),
        ("transport", "~/odom", "topic", [(2, "odom", "topic")]),
        ("transport", " /odom", "topic", [(1, "/odom", "topic")]),
        ("transport", "rover/odom", "topic", [(0, "rover/odom", "topic")]),
        ("transport", "~/", "topic", []),
        ("regex", "wheel", "joint", [(0, "wheel", "!joint~")]),
        ("regex", "^wheel$|other", "joint", [(1, "wheel", "!joint~"), (8, "other", "!joint")]),
        ("regex", "w.*|(a|b)", "joint", [(0, "w.*", "!joint~"), (4, "(a|b)", "!joint")]),
        ("regex", "|wheel", "joint", [(1, "wheel", "!joint~")]),
        ("regex", "(", "joint", [(0, "(", "!joint")]),
        ("remap", " ~/out:=scan", "topic", [(8, "scan", "topic")]),
        ("remap", "n:a:=b", "topic", [(0, "n", "node"), (5, "b", "topic")]),
        ("remap", "__node:=n", "topic", [(8, "n", "node")]),
        ("remap", "__name:=n", "topic", [(8, "n", "node")]),
        ("argument", "__ns:=/n", "topic", [(6, "/n", "namespace")]),
        ("remap", "no rule", "topic", []),
        ("collision", "base_collision", "shape", []),
    ],
)
def test_names_in_a_value(form: str, value: str, kinds: str, found: list[tuple[Any, ...]]) -> None:
    assert parts(form, value, *kinds.split()) == found


@pytest.mark.parametrize("form", ["scoped", "suffixed", "member", "regex"])
def test_what_is_longer_than_a_name_is_one_that_nothing_declares(form: str) -> None:
    for value in ("x" * LONGEST, "x" * LONGEST + "y"):
        (part,) = FORMS[form](value, ("link",), DECLARED)
        assert part.text == value
    (part,) = FORMS[form]("base/" + "x" * LONGEST, ("link",), DECLARED)
    assert (part.text[:5], part.closed) == ("base/", True)


def test_forms_that_are_put_in_front_of_names() -> None:
    assert set(IN_FRONT) == {"prefix", "lettered"} <= FORMS.keys()


PLUGIN = """<robot name="r"><link name="world"/><link name="base"/><link name="tip"/>
<joint name="j"><parent link="world"/><child link="base"/></joint>
<joint name="k"><parent link="base"/><child link="tip"/></joint>
<gazebo><sensor name="eye"><plugin name="p"><on> true </on><way>left</way><image>/a/image</image>
<bare>image</bare></plugin></sensor></gazebo></robot>"""


@pytest.mark.parametrize(
    ("default", "value"),
    [
        ("odom", "odom"),
        ("on=true?odom", "odom"),
        ("on=false?odom", ""),
        ("off=false?odom", "odom"),
        ("off=true?odom", ""),
        ("on=true,way=left?odom", "odom"),
        ("on=true,way=right?odom", ""),
        ("way=right|left?odom", "odom"),
        ("image/../info", "/a/info"),
        ("bare/../info", "info"),
        ("none/../info", ""),
        ("{link}", "base"),
        ("{sensor}/x", "eye/x"),
        # What stands for the model's name is no text that a user writes.
        ("{model}/x", f"{SPAWNED}x"),
        ("{model}/{way}/x", f"{SPAWNED}left/x"),
        ("x/{way}", "x/left"),
        ("x/{none}", ""),
    ],
)
def test_a_default_that_the_consumer_makes(default: str, value: str) -> None:
    plugin = next(etree.fromstring(PLUGIN).iter("plugin"))
    assert default_of(plugin, default) == value
