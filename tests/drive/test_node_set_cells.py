# SPDX-License-Identifier: Apache-2.0
"""With a node set and no further file two rovers in the simulator would start, drive, see and plan."""

from __future__ import annotations

from itertools import groupby
from pathlib import Path

import fleet
import node_set_cells
import pytest
import rcl_names
import verdict
from node_set_cells import Cell

from multibot_rewrite.cli import multibot

pytestmark = [pytest.mark.live, rcl_names.needed()]
# Whose description has all that moves them; arms have a test of their own.
DRIVEN = ("gz", "classic", "sdf", "controlled")
CONTROLLED = ("ros2_control", *node_set_cells.OF_MANAGERS)
CONTROLLERS = """\
controller_manager:
  ros__parameters:
    update_rate: 100
    joint_state_broadcaster: {type: joint_state_broadcaster/JointStateBroadcaster}
"""
ROWS = [
    (name, tuple(its))
    for robot in DRIVEN
    for name, its in groupby(node_set_cells.cells(robot), lambda it: it[:3])
]


def with_controllers(cell: Cell, folder: Path) -> str:
    """Return the text of its fleet file; a file of controllers that the description names is there."""
    if cell.robot != "controlled" or cell.node_set not in CONTROLLED:
        return cell.fleet
    (folder / "config").mkdir(exist_ok=True)
    (folder / "config" / "controllers.yaml").write_text(CONTROLLERS)
    source = node_set_cells.ROOT / node_set_cells.ROBOTS[cell.robot]
    (folder / "robot.urdf").write_text(source.read_text())
    text = cell.fleet.replace(str(source), "robot.urdf")
    return f"{text}related_files: {{params: config/controllers.yaml}}\n"


@pytest.mark.sample(106)
@pytest.mark.parametrize("row", ROWS, ids=["-".join(name) for name, _ in ROWS])
def test_a_node_set_alone_drives(
    row: tuple[tuple[str, ...], tuple[Cell, ...]],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    wrong = {}
    for cell in row[1]:
        if cell.simulator != "gazebo" or node_set_cells.refused(cell):
            continue
        file, out = tmp_path / "fleet.yaml", tmp_path / cell.layout
        file.write_text(with_controllers(cell, tmp_path))
        controlled = cell.robot == "controlled" and cell.node_set in CONTROLLED
        if controlled and node_set_cells.shares_rules(cell.release, cell.layout):
            assert multibot.main(["build", str(file), "-o", str(out), "-q"]) == 1
            assert "robot1 and robot2 publish on /joint_states/" in capsys.readouterr().err
            continue
        if node_set_cells.is_driven(cell):
            told, files = node_set_cells.built(file, out)
            assert not node_set_cells.wrong_in(cell, told)
            for it in files:
                (out / it.path).parent.mkdir(parents=True, exist_ok=True)
                (out / it.path).write_bytes(it.data)
        else:
            assert multibot.main(["build", str(file), "-o", str(out), "-q"]) == 0
        found = fleet.read(out, cell.release)
        faults = verdict.judged(found)
        done = verdict.done(found)
        # What a program does of which no source was read is not known.
        drives = {it.get("drives", "no").partition(":")[0] for it in done.values()}
        if cell[:2] in node_set_cells.LACKING:
            assert {it.what for it in faults} == {"sees"}
            faults = ()
        if faults or not drives <= {"yes", "unknown"}:
            wrong[cell.layout] = faults or done
    assert not wrong
