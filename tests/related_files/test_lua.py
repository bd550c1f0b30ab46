# SPDX-License-Identifier: Apache-2.0
"""Cartographer's Lua: plain assignments are spelled, everything else stays and is told."""

from __future__ import annotations

import pytest
from beside import findings_of
from hypothesis import given, strategies as st
from related_file_calls import NEWEST_LTS, Context, fill_template, make_context, make_naming

from multibot_rewrite.base.model import InputError
from multibot_rewrite.related_files.lua import rewrite_lua, tokens_of

LAYOUTS = ("L1", "L2", "L3", "L4")
DECLARED = {"link": {"base_link": None, "imu_link": None}, "joint": {}}


def context(layout: str = "L2") -> Context:
    naming = make_naming(layout, "postfix" if layout == "L4" else "prefix")
    return make_context(DECLARED, naming, (), distro=NEWEST_LTS)  # type: ignore[arg-type]


def text_of(text: str, layout: str = "L2") -> str:
    return fill_template(rewrite_lua(text.encode(), "a.lua", context(layout)).template, "amr", "sp")


def codes(text: str, layout: str = "L2") -> list[tuple[str, int]]:
    return [
        (it.code, it.line)
        for it in findings_of(rewrite_lua(text.encode(), "a.lua", context(layout)))
    ]


OPTIONS = """\
include "map_builder.lua"
-- published_frame = "base_link"
--[[ tracking_frame = "imu_link" ]] options = {\r
  map_frame = "map",
  tracking_frame = 'imu_link', --[==[ x ]] ]==]
  published_frame = "base_link";
  ["odom_frame"] = "odom",
  provide_odom_frame = true, use_odometry = false, num_laser_scans = 1,
  lookup_transform_timeout_sec = 0.2, pose = 5e-3, ratio = 1.,
}
options.tracking_frame = "base_link"
return options
"""
BEHIND = {"imu_link", "base_link", "odom"}


@pytest.mark.parametrize("layout", LAYOUTS)
def test_plain_assignments(layout: str) -> None:
    wanted = OPTIONS
    for at, line in enumerate(OPTIONS.splitlines()):
        if layout == "L1" or at < 3:
            continue
        new = line
        for name in BEHIND:
            for quote in "'\"":
                spelled = f"{name}/sp" if layout == "L4" else f"sp/{name}"
                new = new.replace(f"= {quote}{name}{quote}", f"= {quote}{spelled}{quote}")
        wanted = wanted.replace(f"\n{line}\n", f"\n{new}\n")
    assert text_of(OPTIONS, layout) == wanted
    assert (wanted == OPTIONS) == (layout == "L1")
    assert codes(OPTIONS, layout) == []


@pytest.mark.parametrize(
    "value",
    [
        "prefix .. 'base_link'",
        "'base_link' .. suffix",
        "base",
        "[[base_link]]",
        "'base\\95link'",
        "os.getenv('FRAME') or 'base_link'",
        "'base_link' or x",
        "'base_link' and x",
        "f'base_link'",
        "nil",
    ],
)
def test_what_is_not_a_plain_string_is_only_reported(value: str) -> None:
    text = f"options = {{\n  published_frame = {value},\n}}\n"
    assert text_of(text) == text
    assert ("MB888", 2) in codes(text)
    assert ("MB888", 2) not in codes(text, "L1")


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ('tracking_frame = "base_lnk"', [("MB853", 1)]),
        ('tracking_frame = "odom"', []),
        ('include "my_base.lua"', [("MB887", 1)]),
        ("\ninclude('my_base.lua')", [("MB887", 2)]),
        ('local frame = "base_link"', [("MB901", 1)]),
        ("local frame = [[base_link]]", [("MB901", 1)]),
        ("include [[my_base.lua]]", [("MB887", 1)]),
        ("include [==[my_base.lua]==]", [("MB887", 1)]),
        ("include", []),
        ("include(name)", []),
        ("include(name, 'my_base.lua')", []),
        ("print('my_base.lua')", []),
        ("tracking_frame = 'odom' a = 1", []),
        ('-- "base_link"\nlocal a = "base"', []),
        ('x.published_frame == "base_link"', [("MB901", 1)]),
        ('my_published_frame = "base_link"', [("MB901", 1)]),
    ],
)
def test_findings(text: str, found: list[tuple[str, int]]) -> None:
    assert text_of(text) == text or found in ([("MB853", 1)], [])
    assert codes(text) == found


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ('a = 1\nb = "x\n', 2),
        ("a = 'x", 1),
        ("\n--[[ x", 2),
        ("--[==[ x ]]", 1),
        ("a = [[ x", 1),
        ("a = [=[ x ]]", 1),
    ],
)
def test_what_does_not_end_is_one_line(text: str, line: int) -> None:
    with pytest.raises(InputError, match=rf"^a\.lua:{line}: not valid Lua: .*close it$"):
        rewrite_lua(text.encode(), "a.lua", context())


PIECES = st.sampled_from(
    [
        '"a\\"b"',
        "'c'",
        "[[ d\n]]",
        "[=[ ]] ]=]",
        "-- e\n",
        "--[[ f ]]",
        "x",
        "1.5e-3",
        "..",
        "=",
        "{",
    ]
)


@pytest.mark.slow
@given(st.lists(PIECES))
def test_tokens_are_the_text(pieces: list[str]) -> None:
    text = " ".join(pieces)
    found = list(tokens_of(text, "a.lua"))
    assert all(text.startswith(it.text, it.at) for it in found)
    assert [it.text for it in found] == [it for it in pieces if not it.startswith("--")]
