"""A built fleet is read back: faults planted in its files are found, and a whole one is silent.

Expectations: what launch does with a file that is not there, and tf2 with a frame that two robots send.
"""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from paths import ROOT

from multibot_rewrite.base.findings.finding import ERROR, WARNING
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.fleet.build import Outputs, make_outputs
from multibot_rewrite.fleet.checks.read_back import read_back
from multibot_rewrite.fleet.file.fleet_file import read_fleet
from multibot_rewrite.fleet.fleet_plan import FleetPlan, plan_fleet

EXAMPLE = ROOT / "examples" / "namespace_and_prefix" / "nav2.yaml"
OUT = "/anywhere/out"


@pytest.fixture(scope="module")
def built() -> tuple[FleetPlan, Outputs]:
    plan = plan_fleet(read_fleet(str(EXAMPLE), "", os.environ), trust=True)
    return plan, make_outputs(plan, OUT)


def test_nothing_is_wrong_with_a_whole_fleet(built: tuple[FleetPlan, Outputs]) -> None:
    assert read_back(built[0], built[1].files, OUT) == []


@pytest.mark.parametrize(
    "path", ["robot1/hexbase.urdf", "robot2/nav2_params.yaml", "robot1/bridge.yaml"]
)
def test_a_file_that_the_launch_file_names_and_is_not_there(
    path: str, built: tuple[FleetPlan, Outputs]
) -> None:
    left = [it for it in built[1].files if it.path != path]
    found = read_back(built[0], left, OUT)
    named = [it for it in found if it.code == "MF823" and path in it.message]
    assert named and all(it.level == ERROR for it in named)
    assert all((it.file, it.line > 1) == ("fleet.launch.py", True) for it in named)


def test_a_robot_with_the_description_of_another_one(built: tuple[FleetPlan, Outputs]) -> None:
    texts = {it.path: it for it in built[1].files}
    other = texts["robot1/hexbase.urdf"].data
    files = [
        it._replace(data=other) if it.path == "robot2/hexbase.urdf" else it for it in built[1].files
    ]
    found = read_back(built[0], files, OUT)
    assert any(it.code.startswith("MG") and it.level == WARNING for it in found)


def test_a_launch_file_that_cannot_be_read(built: tuple[FleetPlan, Outputs]) -> None:
    files = [
        it._replace(data=b"import nothing_of_that_name\n") if it.path == "fleet.launch.py" else it
        for it in built[1].files
    ]
    (found,) = read_back(built[0], files, OUT)
    assert (found.code, found.level, found.file) == ("MF823", ERROR, "fleet.launch.py")


def test_a_description_is_launched_by_the_name_that_is_written(tmp_path: Path) -> None:
    (tmp_path / "arm.xacro").write_text(
        '<robot name="arm" xmlns:xacro="http://wiki.ros.org/xacro"><link name="base_link"/></robot>'
    )
    robots = "robots:\n  - {name: robot1}\n  - {name: robot2}\n"
    fleet = tmp_path / "fleet.yaml"
    fleet.write_text(f"description: arm.xacro\nsimulator: none\n{robots}")
    out = tmp_path / "out"
    assert main(["build", str(fleet), "-o", str(out), "-q"]) == 0
    assert (out / "robot1" / "arm.urdf").exists()
    assert 'text("robot1/arm.urdf")' in (out / "fleet.launch.py").read_text()
    assert main(["check-launch", str(out / "fleet.launch.py")]) in (0, 3)
