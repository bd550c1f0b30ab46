# SPDX-License-Identifier: Apache-2.0
"""What is open in a robot: plan, remap and check say the same, and a verdict does not hide it."""

from __future__ import annotations

from pathlib import Path

import pytest
from closed_robot import FILES
from graph_cases import as_planned
from paths import fixture_text, write_files

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.system.json import from_yaml, to_json

pytestmark = pytest.mark.slow

CLOSED = FILES["ekf.yaml"]
OPEN = CLOSED.replace("imu0: imu/data", "imu0: imu_0/data")
SAID = (
    "MG303 /ekf_filter_node of robot1 subscribes to /imu_0/data, which no known node publishes; "
    "/ros_gz_bridge publishes /imu/data (pass the rule /imu_0/data:=/imu/data, or write /imu/data in "
    "its parameters; see "
)
BOTH = "; the same for robot2 (pass"


class Folder:
    """A fleet file, the plan made of it, and a graph that is as planned."""

    def __init__(self, folder: Path, ekf: str) -> None:
        write_files(folder, {**FILES, "ekf.yaml": ekf})
        self.fleet, self.plan = str(folder / "fleet.yaml"), str(folder / "plan.yaml")
        self.graph, self.json = str(folder / "graph.json"), str(folder / "plan.json")
        assert main(["plan", self.fleet, "-o", self.plan]) == 0
        plan = from_yaml(Path(self.plan).read_bytes(), "plan.yaml")
        Path(self.json).write_bytes(to_json(plan))
        Path(self.graph).write_bytes(to_json(as_planned(plan)))

    def check(self, plan: str, *words: str) -> int:
        return main(["check", plan, "--from", self.graph, *words])


@pytest.fixture
def open_(tmp_path: Path) -> Folder:
    return Folder(tmp_path, OPEN)


@pytest.mark.parametrize("form", ["plan", "table"])
def test_a_table_is_made_with_what_is_open(
    form: str, open_: Folder, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    capsys.readouterr()
    words = [
        "plan",
        open_.fleet,
        "--output-kind",
        form,
        "-o",
        str(tmp_path / "made"),
        "--select",
        "MG303",
    ]
    assert main(words) == 0
    said = capsys.readouterr().err
    assert said.count("MG303") == 1
    both = SAID.replace(" (pass", BOTH)
    assert f"{tmp_path}/ekf.yaml:4:1: warning: {both}{tmp_path}/bridge.yaml:1)" in said
    assert main([*words, "--fail-on", "warning"]) == 1


@pytest.mark.sample(3)
@pytest.mark.parametrize("of", ["plan", "json", "fleet"])
def test_a_graph_as_planned_of_a_plan_that_does_not_close(
    of: str, open_: Folder, capsys: pytest.CaptureFixture[str]
) -> None:
    capsys.readouterr()
    assert open_.check(vars(open_)[of]) == 0
    out, err = capsys.readouterr()
    assert SAID.replace(" (pass", BOTH) in out
    assert "1 finding: nothing wrong seen, but the plan has faults" in err
    assert open_.check(vars(open_)[of], "--fail-on", "warning") == 1
    assert open_.check(vars(open_)[of], "--fail-on", "warning", "--ignore", "MG303") == 0
    assert "0 findings: as planned (" in capsys.readouterr().err


def test_a_build_writes_the_same_plan_with_paths_from_the_fleet_file(
    open_: Folder, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir("/")
    assert main(["build", open_.fleet, "-o", str(tmp_path / "out")]) == 0
    (gap,) = from_yaml((tmp_path / "out" / "plan.yaml").read_bytes(), "plan.yaml").gaps
    assert (gap.code, gap.level, gap.file, gap.line) == ("MG303", "warning", "ekf.yaml", 4)
    assert gap.hint.endswith("write /imu/data in its parameters; see bridge.yaml:1")


def test_what_was_open_before_is_counted_where_it_is_asked_for(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    # Nobody knows what sends a second odometry, and no other topic is meant: a driver may.
    folder = Folder(tmp_path, f"{CLOSED}    twist0: visual/twist\n")
    assert "MG316 no known node sends /visual/twist" in capsys.readouterr().err
    assert folder.check(folder.plan) == 0
    out, err = capsys.readouterr()
    assert out == ""
    assert "0 findings: as planned (" in err
    assert "note: 1 note about topics that no known node sends; --verbose shows them" in err
    assert folder.check(folder.plan, "--fail-on", "note") == 1
    out, err = capsys.readouterr()
    assert "note: MG316 no known node sends /visual/twist" in out
    assert "1 note: as planned, with notes on the plan (" in err


ROVER = fixture_text("open_plan_rover.urdf")
FAULTY = """\
ekf_filter_node:
  ros__parameters:
    frequncy: 30.0
    odom0: 1odom
    base_link_frame: base_lnk
"""
FLEET = """\
description: rover.urdf
distro: humble
simulator: gazebo
node_sets: [robot_state, robot_localization]
related_files: {params: ekf.yaml}
robots: [{name: robot1}, {name: robot2}]
"""


def test_each_command_says_the_same_of_a_parameter_file(
    here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Expected by robot_localization (parameters), rcl (names of topics) and the links of the robot."""
    for name, text in (("rover.urdf", ROVER), ("ekf.yaml", FAULTY), ("fleet.yaml", FLEET)):
        (here / name).write_text(text)
    commands = [
        # Without the frame of its base the robot's tree is in pieces.
        ["build", "fleet.yaml", "-o", "out", "--ignore=MG406"],
        ["plan", "fleet.yaml", "-o", "plan.yaml"],
        ["check", "plan.yaml", "--from", "graph.json"],
        ["check", "out/plan.yaml", "--from", "graph.json"],
    ]
    said = []
    for words in commands:
        if words[0] == "check":
            plan = from_yaml((here / words[1]).read_bytes(), words[1])
            (here / "graph.json").write_bytes(to_json(as_planned(plan)))
        assert main(words) == 0
        lines = "".join(capsys.readouterr()).splitlines()
        said.append([it.partition(":")[2] for it in lines if "ekf.yaml:" in it])
    assert said[0] == said[1] == said[2] == said[3]
    codes = [(it.split(":")[0], it.split()[2]) for it in said[0]]
    assert codes == [("3", "MB110"), ("4", "MB312"), ("5", "MB853")]


@pytest.mark.parametrize("layout", ["postfix", "both"])
def test_inputs_that_nobody_chose_are_missed_once_by_build_and_launch(
    layout: str, here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """robot_localization ros_filter.cpp:1176: a filter without an input estimates nothing."""
    (here / "rover.urdf").write_text(ROVER)
    fleet = FLEET.replace("related_files: {params: ekf.yaml}", f"layout: {layout}")
    (here / "fleet.yaml").write_text(fleet)
    said = []
    for words in (["build", "fleet.yaml", "-o", "out"], ["check-launch", "out/fleet.launch.py"]):
        assert main(words) == 0
        lines = "".join(capsys.readouterr()).splitlines()
        said.append([it.partition(" note: ")[2] for it in lines if "MB115" in it])
    assert said[0] == said[1] and len(said[0]) == 1
    filters = {
        "postfix": "/ekf_filter_node_robot1, /ekf_filter_node_robot2",
        "both": "/robot1/ekf_filter_node, /robot2/ekf_filter_node",
    }
    told = f"MB115 {filters[layout]}: none of these is set: odom0, pose0, twist0, imu0 ("
    assert said[0][0].startswith(told)
