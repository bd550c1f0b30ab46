# SPDX-License-Identifier: Apache-2.0
"""An undo that lacks an option names it, where that option takes the rewrite back."""

from __future__ import annotations

import argparse
from pathlib import Path

import pytest
from paths import FIXTURES

from multibot_rewrite.cli.undo_options import more_to_undo
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
        ("--shared lidar_link", "", "--shared lidar_link"),
        (
            "--shared lidar_link,imu_link --separator _",
            "",
            "--separator _ --shared lidar_link,imu_link",
        ),
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


def test_of_options_that_take_back_as_much_the_fewest_are_named() -> None:
    none = argparse.Namespace(affix=None, separator=[], layout=None)
    made = b'<link name="robot1_arm"/>'
    undo = {"prefix": b'<link name="arm"/>', None: made}
    assert more_to_undo(made, none, lambda it: undo[it.affix], "robot1") == "--affix prefix"
