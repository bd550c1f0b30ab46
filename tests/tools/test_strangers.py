# SPDX-License-Identifier: Apache-2.0
"""The table of strangers says of what nobody has read whose it is, and whether the build names it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tools.strangers import Ran, _driven, _with_owners, strangers


def driven(**robot: str) -> Ran:
    found = {"robots": {"robot1": robot}, "wrong": []}
    return Ran(2, json.dumps(found), "", 0.0)


@pytest.mark.parametrize(
    ("told", "word"),
    [
        ("warning: controller c is of type a/B", "drive: unknown"),
        ("warning: a/B and lib.so are not known", "drive: the build says what is not known"),
    ],
)
def test_what_is_not_known_is_told_or_silent(told: str, word: str) -> None:
    assert _driven(driven(starts="unknown: a/B, lib.so"), told) == (word, "unknown: a/B, lib.so")


def test_what_is_not_known_has_an_owner(tmp_path: Path) -> None:
    package = tmp_path / "src" / "my_plugins"
    package.mkdir(parents=True)
    (package / "package.xml").write_text("<package/>")
    (package / "CMakeLists.txt").write_text("add_library(foot SHARED foot.cpp)")
    said = _with_owners("unknown: libfoot.so, libno_such.so", tmp_path)
    assert said == "libfoot.so (of my_plugins), libno_such.so (of no package here)"
    assert _with_owners("robot1 drives: no", tmp_path) == "robot1 drives: no"


def test_the_list_has_each_once() -> None:
    names = [it.name for it in strangers()]
    assert len(names) == len(set(names)) == 158
    assert {it.half for it in strangers()} == {
        *("work", "last", "fresh", "more", "kept", "more2", "kept2", "more3", "kept3"),
        *("more4", "kept4", "more5", "kept5", "more6", "kept6", "more7", "kept7"),
    }
