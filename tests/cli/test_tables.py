# SPDX-License-Identifier: Apache-2.0
"""Tables on a terminal: no name is cut in two."""

from __future__ import annotations

import argparse
import re
from types import SimpleNamespace

import pytest

from multibot_rewrite.cli import tables
from multibot_rewrite.cli.tables import Grid, render

ROWS = (
    ("robot1", "waypoint_follower", "/robot1/waypoint_follower", "/cmd_vel -> cmd_vel_nav"),
    ("robot1", "local_costmap/local_costmap", "/robot1/local_costmap/local_costmap", "no rule"),
)
GRID = Grid(("robot", "node", "runs as", "rule"), ROWS)
WORDS = {word for row in ROWS for cell in row for word in re.findall(r"[^/ ]+", cell)}


@pytest.mark.parametrize("width", range(20, 130, 7))
def test_no_name_is_cut_at_any_width(width: int) -> None:
    text = render([GRID], width)
    assert set(re.findall(r"[^/\s]+", text)) >= WORDS


def test_a_table_is_as_wide_as_the_terminal_that_shows_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "50")
    terminal, file = SimpleNamespace(isatty=lambda: True), SimpleNamespace(isatty=lambda: False)
    for output, stream, wide in (
        (None, terminal, 50), ("-", terminal, 50), ("a.txt", terminal, None), (None, file, None),
        (None, None, None),
    ):  # fmt: skip
        monkeypatch.setattr(tables, "sys", SimpleNamespace(stdout=stream))
        assert tables._width(argparse.Namespace(output=output)) == wide
