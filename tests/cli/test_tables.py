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


@pytest.mark.parametrize("width", [70, 80, 100])
def test_what_can_be_folded_fits(width: int) -> None:
    lines = render([GRID], width).splitlines()
    assert max(map(len, lines)) <= width
    assert lines[0].split() == ["robot", "node", "runs", "as", "rule"]


def test_a_name_is_folded_behind_a_slash() -> None:
    lines = render([Grid(("name", "x"), [("/robot1/waypoint_follower", "y")])], 20).splitlines()
    assert lines == ["name               x", "/robot1/           y", "waypoint_follower"]


def test_what_cannot_be_folded_is_a_line_for_each_cell() -> None:
    grid = Grid(("count", "name"), [("1", "a" * 30), ("2", "b")])
    assert render([grid], 20) == f"count  1\nname   {'a' * 30}\n\ncount  2\nname   b\n"


def test_nothing_is_folded_for_a_file() -> None:
    text = render([GRID])
    assert text.count("\n") == 3
    assert all(cell in text for row in ROWS for cell in row)


def test_an_empty_table_is_its_heading() -> None:
    assert render([Grid(("a", "b"), [])], 40) == "a  b\n"


def test_a_table_is_as_wide_as_the_terminal_that_shows_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "50")
    terminal, file = SimpleNamespace(isatty=lambda: True), SimpleNamespace(isatty=lambda: False)
    for output, stream, wide in (
        (None, terminal, 50), ("-", terminal, 50), ("a.txt", terminal, None), (None, file, None),
        (None, None, None),
    ):  # fmt: skip
        monkeypatch.setattr(tables, "sys", SimpleNamespace(stdout=stream))
        assert tables._width(argparse.Namespace(output=output)) == wide


def test_the_heading_is_bold_in_colour() -> None:
    assert render([Grid(("a",), [("x",)])], colour=True) == "\033[1ma\033[0m\nx\n"
