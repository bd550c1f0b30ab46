# SPDX-License-Identifier: Apache-2.0
"""With a node set and no further file a fleet builds for each release, layout and simulator; what its
own input lacks is refused in one line."""

from __future__ import annotations

from itertools import groupby
from pathlib import Path

import node_set_cells
import pytest
from node_set_cells import ROBOTS, Cell

from multibot_rewrite.cli.multibot import main

ROWS = [
    (name, tuple(its))
    for robot in ROBOTS
    for name, its in groupby(node_set_cells.cells(robot), lambda it: it[:3])
]


@pytest.mark.slow
@pytest.mark.sample(101)
@pytest.mark.parametrize("row", ROWS, ids=["-".join(name) for name, _ in ROWS])
def test_nothing_that_the_build_adds_refuses_a_robot(
    row: tuple[tuple[str, ...], tuple[Cell, ...]], tmp_path: Path
) -> None:
    """Those that drive are built and asked the same by the drive test."""
    cells = [it for it in row[1] if not node_set_cells.is_driven(it)]
    assert not {it[3:]: found for it in cells if (found := node_set_cells.faults(it, tmp_path))}


@pytest.mark.slow
@pytest.mark.sample(59)
@pytest.mark.parametrize("release", ["jazzy", "lyrical"])
@pytest.mark.parametrize("pair", [*node_set_cells.pairs()], ids="-".join)
def test_two_node_sets_fit_each_other(pair: tuple[str, str], release: str, tmp_path: Path) -> None:
    assert not node_set_cells.pair_faults(*pair, release, tmp_path)


@pytest.mark.parametrize(
    "pair", [("nav2", "teleop"), ("navigation", "rtabmap"), ("static_tf", "nav2")], ids="-".join
)
def test_node_sets_that_did_not_fit(pair: tuple[str, str], tmp_path: Path) -> None:
    assert not node_set_cells.pair_faults(*pair, "lyrical", tmp_path)


@pytest.mark.parametrize(
    "cell",
    [
        Cell("gz", "localization", "jazzy", "frame-prefix", "none"),
        Cell("sdf", "rtabmap", "humble", "postfix", "none"),
    ],
    ids="-".join,
)
def test_odometry_of_a_real_robots_driver_is_no_fault_of_its_localizer(
    cell: Cell, tmp_path: Path
) -> None:
    assert not node_set_cells.faults(cell, tmp_path)


FOUR = (
    Cell("gz", "nav2", "lyrical", "tf-per-robot", "gazebo"),
    Cell("gz", "nav2_composed", "lyrical", "postfix", "gazebo"),
    Cell("sdf", "nav2_slam", "jazzy", "both", "gazebo"),
    Cell("classic", "robot_localization_gps", "humble", "frames-per-robot", "gazebo"),
)


@pytest.mark.parametrize("cell", FOUR, ids="-".join)
def test_the_built_folder_agrees_with_its_plan(cell: Cell, tmp_path: Path) -> None:
    (tmp_path / "fleet.yaml").write_text(cell.fleet)
    out = tmp_path / "out"
    assert main(["build", str(tmp_path / "fleet.yaml"), "-o", str(out), "-q"]) == 0
    launched = ["check-launch", str(out / "fleet.launch.py")]
    assert main(launched) == 0
    assert main([*launched, "--plan", str(out / "plan.yaml")]) == 0


@pytest.mark.parametrize(
    "cell",
    [
        Cell("gz", "moveit", "lyrical", "both", "gazebo"),
        Cell("gz", "ros2_control", "humble", "both", "none"),
        Cell("gz", "controllers", "humble", "tf-per-robot", "gazebo"),
        Cell("arm", "gz_ros2_control", "humble", "tf-per-robot", "gazebo"),
        Cell("controlled", "controllers", "humble", "tf-per-robot", "none"),
    ],
    ids="-".join,
)
def test_what_the_input_lacks_is_one_line(cell: Cell, tmp_path: Path) -> None:
    """Of each robot; what follows from it is no second error."""
    errors = [it for it in node_set_cells.findings(cell, tmp_path) if it.level == "error"]
    assert {it.code for it in errors} == node_set_cells.refused(cell)
    assert len(errors) == len({it.robot or str(it) for it in errors}) <= 2


@pytest.mark.parametrize("layout", node_set_cells.LAYOUTS)
def test_hardware_that_no_plugin_of_the_simulator_loads_is_an_error(
    layout: str, tmp_path: Path
) -> None:
    """ros2_control_node cannot load a class of the simulator."""
    cell = Cell("controlled", "ros2_control", "jazzy", layout, "gazebo")
    source = node_set_cells.ROOT / ROBOTS["controlled"]
    text = source.read_text()
    at = text.index('  <gazebo>\n    <plugin name="gz_ros2_control')
    (tmp_path / "robot.urdf").write_text(f"{text[:at]}</robot>\n")
    fleet = tmp_path / "fleet.yaml"
    fleet.write_text(cell.fleet.replace(str(source), "robot.urdf"))
    assert main(["build", str(fleet), "-o", str(tmp_path / "out"), "-q"]) == 1
    assert not (tmp_path / "out").exists()
    found = [it for it in node_set_cells.of_file(fleet) if it.level == "error"]
    assert [it.code for it in found] == ["MF843"]
    assert "no plugin of robot 'robot1' loads it" in found[0].message


def test_a_fault_between_two_ends_of_the_build_is_seen(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without the settings that fit, the cells say so."""
    wrongs = {
        "fitting.fitted.of_one_type": (lambda nodes, *_: [*nodes], "MG306"),
        "fitting.fitted.without_second_senders": (lambda nodes, free, sent: nodes, "MG408"),
        "robot_nodes.fitting_frames": (lambda member, nodes, sent: {}, "MG413"),
    }
    for wrong, (nothing, said) in wrongs.items():
        with monkeypatch.context() as patch:
            patch.setattr(f"multibot_rewrite.fleet.robots.{wrong}", nothing)
            node_set = "robot_localization" if said == "MG408" else "nav2"
            cell = Cell("gz", node_set, "lyrical", "tf-per-robot", "gazebo")
            assert said in " ".join(node_set_cells.faults(cell, tmp_path))
