# SPDX-License-Identifier: Apache-2.0
"""With a stack and no further file two rovers in the simulator would start, drive, see and plan."""

from __future__ import annotations

import importlib.util
from itertools import groupby
from pathlib import Path

import fleet
import pytest
import rcl_names
import stack_cells
import verdict
from stack_cells import Cell

from multibot_rewrite.cli import multibot

pytestmark = [
    pytest.mark.live,
    pytest.mark.skipif(
        not importlib.util.find_spec("rclpy"),
        reason=f"names are resolved by the real rcl; install rclpy: {rcl_names.INSTALL}",
    ),
]
# Whose description has all that moves them; that of the others names a file of controllers.
DRIVEN = ("gz", "classic")
ROWS = [
    (name, tuple(its))
    for robot in DRIVEN
    for name, its in groupby(stack_cells.cells(robot), lambda it: it[:3])
]


@pytest.mark.sample(53)
@pytest.mark.parametrize("row", ROWS, ids=["-".join(name) for name, _ in ROWS])
def test_a_stack_alone_drives(
    row: tuple[tuple[str, ...], tuple[Cell, ...]], tmp_path: Path
) -> None:
    wrong = {}
    for cell in row[1]:
        if cell.simulator != "gazebo" or stack_cells.refused(cell):
            continue
        file, out = tmp_path / "fleet.yaml", tmp_path / cell.layout
        file.write_text(cell.fleet)
        assert multibot.main(["build", str(file), "-o", str(out), "-q"]) == 0
        found = fleet.read(out, cell.release)
        faults = verdict.judged(found)
        done = verdict.done(found)
        # What a program does of which no source was read is not known.
        drives = {it.get("drives", "no").partition(":")[0] for it in done.values()}
        if faults or not drives <= {"yes", "unknown"}:
            wrong[cell.layout] = faults or done
    assert not wrong
