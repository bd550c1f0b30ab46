# SPDX-License-Identifier: Apache-2.0
"""A fleet of several descriptions: it builds as it is written, and each robot has its own files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml
from paths import ROBOTS, ROOT, write_files
from small_robots import PACKAGE, robot

from multibot_rewrite.base.model import InputError
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.fleet.file.fleet_file import read_fleet
from multibot_rewrite.proposal.looking import Looked
from multibot_rewrite.proposal.owners import moveit_of_others
from multibot_rewrite.proposal.searching import Found

MODEL = '<robot name="{0}"><link name="{0}_base"/></robot>'
SECTION = "{}_node: {{ros__parameters: {{rate: 1}}}}\n"


def fleet_of(folder: Path, *words: str) -> dict[str, Any]:
    """Return the fleet file for these words, which init and build say builds."""
    file = folder / "made" / "fleet.yaml"
    assert main(["init", *words, "--yes", "-o", str(file), "--force"]) == 0
    assert main(["build", str(file), "-o", str(folder / "out"), "-q"]) == 0
    made = yaml.safe_load(file.read_text())
    assert isinstance(made, dict)
    return made


@pytest.mark.parametrize(
    "options",
    [[], ["-n", "1"], ["-n", "3", "--layout", "L4"], ["--layout", "L1"], ["--distro", "jazzy"]],
)  # fmt: skip
def test_what_is_tried_is_what_is_written(options: list[str], tmp_path: Path, capsys: Any) -> None:
    """Two robots of one description share its node set, which a YAML writer shortens to an alias."""
    write_files(tmp_path, {f"{it}/robot.urdf": MODEL.format(it) for it in ("a", "b", "c")})
    paths = [str(tmp_path / it / "robot.urdf") for it in ("a", "b", "c")]
    made = fleet_of(tmp_path, *paths, *options)
    assert {it["node_sets"][0] for it in made["robots"]} == {"robot_state"}
    assert {it["description"] for it in made["robots"]} == {
        f"../{it}/robot.urdf" for it in ("a", "b", "c")
    }
    told = capsys.readouterr().err
    assert "does not build" not in told
    assert ("9 robots, 3 of each, of robot.urdf" in told) is ("3" in options)


def test_values_that_robots_share_may_be_one_object(tmp_path: Path) -> None:
    write_files(tmp_path, {"a.urdf": MODEL.format("a")})
    own = {"description": str(tmp_path / "a.urdf"), "node_sets": ["robot_state"]}
    robots = [{"name": it, **own} for it in ("one", "two")]
    assert [it.name for it in read_fleet({"robots": robots}, "", {}).robots] == ["one", "two"]
    circle: list[Any] = []
    circle.append(circle)
    with pytest.raises(InputError, match="a value holds itself"):
        read_fleet({"robots": circle}, "", {})


def test_a_file_is_of_the_robot_in_whose_folder_it_is(tmp_path: Path) -> None:
    for name in ("left", "right"):
        write_files(
            tmp_path / f"{name}_description",
            {
                "package.xml": PACKAGE.format(f"{name}_description"),
                "urdf/robot.urdf": robot(name, "wheel"),
                "config/own.yaml": SECTION.format(name),
            },
        )
    paths = [str(tmp_path / f"{it}_description/urdf/robot.urdf") for it in ("left", "right")]
    made = fleet_of(tmp_path, *paths, "-n", "1")
    own = {it["name"]: it["related_files"]["params"] for it in made["robots"]}
    assert own == {f"{it}1": [f"../{it}_description/config/own.yaml"] for it in ("left", "right")}


EKF = "ekf_filter_node: {{ros__parameters: {{base_link_frame: {}}}}}\n"


@pytest.mark.parametrize(
    ("file", "text", "owners"),
    [
        # The rover alone has a wheel and a scan.
        ("nav2.yaml", "controller_server: {ros__parameters: {odom_topic: odom}}\n", {"rover1"}),
        ("amcl.yaml", "amcl: {ros__parameters: {scan_topic: scan}}\n", {"rover1"}),
        ("rows.yaml", "- ros_topic_name: scan\n  gz_topic_name: scan\n", {"rover1"}),
        ("ekf.yaml", EKF.format("lidar_link"), {"rover1"}),
        ("ekf.yaml", EKF.format("upper_link"), {"arm1"}),
        ("ekf.yaml", EKF.format("base_link"), {"arm1", "rover1"}),
    ],
)
def test_a_file_is_of_the_robot_that_it_fits(
    file: str, text: str, owners: set[str], tmp_path: Path
) -> None:
    for path in ("two_arms_moveit/arm.urdf", "launch_tutorial/rover.urdf"):
        write_files(tmp_path, {path.rpartition("/")[2]: (ROOT / "examples" / path).read_text()})
    write_files(tmp_path, {file: text})
    out, paths = tmp_path / "f.yaml", [str(tmp_path / it) for it in ("arm.urdf", "rover.urdf")]
    main(["init", *paths, "-n", "1", "--yes", "-o", str(out)])
    made = yaml.safe_load(out.read_text())
    robots = made.pop("robots")
    assert {it["name"] for it in robots if file in str({**made, **it})} == owners


@pytest.mark.parametrize("value", ["''", "office.yaml", None])
def test_a_robot_of_nav2_without_a_map_is_asked_for_one(value: str | None, tmp_path: Path) -> None:
    text = "amcl: {ros__parameters: {}}\ncontroller_server: {ros__parameters: {}}\n"
    text += f"map_server:\n  ros__parameters:\n    yaml_filename: {value}\n" if value else ""
    rover = (ROOT / "examples" / "launch_tutorial" / "rover.urdf").read_text()
    write_files(tmp_path, {"rover.urdf": rover, "nav2.yaml": text})
    main(["init", str(tmp_path / "rover.urdf"), "--yes", "-o", str(tmp_path / "f.yaml")])
    asked = "# Nav2 waits for a map: write its yaml_filename" in (tmp_path / "f.yaml").read_text()
    assert asked is (value != "office.yaml")


def test_kinematics_are_of_the_robot_that_has_the_groups(tmp_path: Path) -> None:
    group = '<robot name="{0}"><group name="{0}_group"><link name="{0}_base"/></group></robot>'
    write_files(tmp_path, {"rover.srdf": group.format("rover")})
    write_files(tmp_path, {"kinematics.yaml": "arm_group: {kinematics_solver: kdl}\n"})
    srdf, file = str(tmp_path / "rover.srdf"), str(tmp_path / "kinematics.yaml")
    found = Found(srdf=(srdf,), moveit=(file,))
    of_others = moveit_of_others(Looked(str(tmp_path / "rover.urdf")), srdf, found)
    assert of_others == {file: "it names no group of rover.srdf"}
    (tmp_path / "more").mkdir()
    own = tmp_path / "more" / "kinematics.yaml"
    own.write_text("rover_group: {kinematics_solver: kdl}\n")
    found = Found(srdf=(srdf,), moveit=(str(own),))
    assert moveit_of_others(Looked(str(tmp_path / "rover.urdf")), srdf, found) == {}


def test_what_another_robot_of_the_fleet_has_is_not_left_over(tmp_path: Path) -> None:
    """The files of other packages are nobody's business either."""
    write_files(
        tmp_path, {"arm.urdf": robot("arm", "lift_arm"), "rover.urdf": robot("rover", "turn")}
    )
    joints = {"a": {"ros__parameters": {"joints": ["lift_arm", "arm_base", "lift_arm_wheel"]}}}
    write_files(tmp_path, {"config.yaml": yaml.safe_dump(joints)})
    paths = [str(tmp_path / it) for it in ("arm.urdf", "rover.urdf")]
    made = fleet_of(tmp_path, *paths, "-n", "1")
    assert made["robots"][0]["related_files"] == {"params": ["../config.yaml"]}
    assert "config.yaml: it is for" not in (tmp_path / "made/fleet.yaml").read_text()


def test_robots_of_two_simulators_are_the_first_reason(tmp_path: Path, capsys: Any) -> None:
    """Both publish /clock, which says nothing to who has named two robots."""
    for name in ("rover.urdf", "rover_gz.urdf"):
        (tmp_path / name).write_bytes((ROBOTS / name).read_bytes())
    words = ["init", str(tmp_path / "rover.urdf"), str(tmp_path / "rover_gz.urdf")]
    assert main([*words, "--yes", "-o", str(tmp_path / "f.yaml")]) == 1
    first = capsys.readouterr().err.splitlines()[0]
    rover, other = tmp_path / "rover.urdf", tmp_path / "rover_gz.urdf"
    what = f"{rover} is for Gazebo Classic and {other} for gz-sim: no simulator runs both"
    assert f"It does not build yet: MG502 {what} (" in first
    assert main(["build", str(tmp_path / "f.yaml"), "-o", str(tmp_path / "out")]) == 1
    said = [it for it in capsys.readouterr().err.splitlines() if "MG502" in it]
    assert [what in it for it in said] == [True]
    assert main([*words, "--simulator", "none", "--yes", "-o", str(tmp_path / "g.yaml")]) == 1
    assert "MF843" in capsys.readouterr().err


def test_robots_of_other_descriptions_may_have_other_frames(tmp_path: Path, capsys: Any) -> None:
    """One of the two kinds has no laser, and that is right."""
    part = '<link name="{0}"/><joint name="{0}_joint" type="fixed"><parent link="base_link"/>'
    part += '<child link="{0}"/></joint>'
    for name, parts in {"rover": ("mast", "imu", "laser"), "scout": ("mast", "imu")}.items():
        own = "".join(map(part.format, parts))
        text = f'<robot name="{name}"><link name="base_link"/>{own}</robot>'
        write_files(tmp_path, {f"{name}.urdf": text})
    kinds = ("rover.urdf", "rover.urdf", "scout.urdf")
    robots = [{"name": f"r{number}", "description": it} for number, it in enumerate(kinds)]
    fleet = {"layout": "tf-per-robot", "node_sets": ["nav2", "robot_state"], "robots": robots}
    (tmp_path / "f.yaml").write_text(yaml.safe_dump(fleet))
    assert main(["build", str(tmp_path / "f.yaml"), "-o", str(tmp_path / "out")]) == 0
    assert "MG328" not in capsys.readouterr().err
