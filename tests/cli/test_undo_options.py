# SPDX-License-Identifier: Apache-2.0
"""An undo that lacks an option names it, where that option takes the rewrite back."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from paths import FIXTURES

from multibot_rewrite.base.findings.finding import Finding, RewriteRefused
from multibot_rewrite.base.model import InputError
from multibot_rewrite.cli.undo_options import with_missing_options
from multibot_rewrite.cli.urdf_postfix import main

ROVER = FIXTURES / "robots" / "rover.urdf"


@pytest.mark.parametrize(
    ("made_with", "undone_with", "missing"),
    [
        ("--affix prefix", "", "--affix prefix"),
        ("--affix prefix --separator _", "", "--affix prefix --separator _"),
        ("--affix prefix --separator _", "--affix prefix", "--separator _"),
        ("--layout frames-per-robot", "", "--layout frames-per-robot"),
        ("--layout both --affix prefix", "--layout both", "--affix prefix"),
        # That of frame-prefix alone would be verified as well, and leave the links.
        (
            "--layout frames-per-robot --affix prefix",
            "",
            "--affix prefix --layout frames-per-robot",
        ),
    ],
)
def test_the_missing_options_are_named_and_take_it_back(
    made_with: str,
    undone_with: str,
    missing: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    made, back = str(tmp_path / "made.urdf"), tmp_path / "back.urdf"
    assert main([str(ROVER), "robot1", *made_with.split(), "-o", made]) == 0
    undo = [made, "robot1", "--undo", *undone_with.split(), "-o", str(back)]
    capsys.readouterr()
    assert main(undo) == 1
    assert f"(the file was made with {missing}: give that, too)" in capsys.readouterr().err
    assert not back.exists()
    assert main([*undo, *missing.split()]) == 0
    assert back.read_bytes() == ROVER.read_bytes()


def test_who_leaves_the_name_in_all_links_is_warned(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    made, back = str(tmp_path / "made.urdf"), str(tmp_path / "back.urdf")
    given = ["--layout", "frames-per-robot", "--affix", "prefix"]
    assert main([str(ROVER), "robot1", *given, "-o", made]) == 0
    for layout, is_warned in ((["--layout", "frame-prefix"], True), (given, False)):
        capsys.readouterr()
        assert main([made, "robot1", "--undo", *layout, "-o", back]) == 0
        told = (
            "in all links still; was the file made with --affix prefix --layout frames-per-robot?"
        )
        assert (told in capsys.readouterr().err) is is_warned


def test_what_no_option_takes_back_is_told_as_before(capsys: pytest.CaptureFixture[str]) -> None:
    """The source itself was not rewritten at all, and not for another robot."""
    assert main([str(ROVER), "robot1", "--undo"]) == 1
    assert "the robot and the options that the file was made with" in capsys.readouterr().err


def tried(takes_back: Callable[[dict[str, Any]], bool], **given: Any) -> tuple[list[int], str]:
    """Return how many options each try adds, and the hint at the end."""
    options = argparse.Namespace(**{"affix": None, "separator": [], "layout": None, **given})
    error = RewriteRefused((Finding("MB000", "error", "refused", "as before"),))
    counts: list[int] = []

    def undo(more: argparse.Namespace) -> bytes:
        added = {name: it for name, it in vars(more).items() if it and not given.get(name)}
        assert given.items() <= vars(more).items()
        counts.append(len(added))
        if not takes_back(added):
            raise InputError("no")
        return b"<robot/>"

    (found,) = with_missing_options(error, options, undo, "robot1").findings
    return counts, found.hint


def test_fewest_options_are_tried_first() -> None:
    counts, hint = tried(lambda added: False)
    assert counts == sorted(counts)
    # One of affix, three separators, all layouts but the usual one: each with and without the others.
    one, two, three = 1 + 3 + 4, 1 * 3 + 1 * 4 + 3 * 4, 1 * 3 * 4
    assert [counts.count(it) for it in (1, 2, 3)] == [one, two, three]
    assert (len(counts), hint) == (one + two + three, "as before")


def test_of_several_ways_back_the_one_with_fewest_options_is_named() -> None:
    _, hint = tried(lambda added: added.get("separator") == ["-"])
    assert "made with --separator -:" in hint
    _, hint = tried(lambda added: len(added) > 1 and "affix" in added and "separator" in added)
    assert "made with --affix prefix --separator _:" in hint


def test_an_option_that_was_given_is_not_tried() -> None:
    counts, _ = tried(lambda added: False, affix="postfix", layout="both")
    assert counts == [1, 1, 1]
