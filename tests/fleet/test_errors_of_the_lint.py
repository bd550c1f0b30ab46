# SPDX-License-Identifier: Apache-2.0
"""Every error that the lint finds in a description is said by a fleet that has it, once."""

from __future__ import annotations

import inspect
import os
import re
from collections import Counter
from pathlib import Path

import pytest
from fleet_folder import planned_fleet
from paths import write_files
from support.rule_examples import DESCRIPTION, whole

from multibot_rewrite.base.findings.finding import ERROR, NOTE, URDF, Finding, Rule
from multibot_rewrite.base.model import MultibotError
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.lint.check import lint_file
from multibot_rewrite.lint.launched import may_stop
from multibot_rewrite.lint.registry import RULES
from multibot_rewrite.rules.settings import Settings

ROBOTS = "robots: [{name: robot1, pose: {y: 0}}, {name: robot2, pose: {y: 3}}]\n"
ASKED = [it for it in RULES.values() if it.level == ERROR and URDF in it.formats and it.page.bad]


def described(rule: Rule, folder: Path) -> Path:
    """Return the bad example of a rule; where it has a package beside it, in this package."""
    write_files(folder, rule.page.beside)
    home = next(folder.glob("*/package.xml"), folder / "package.xml").parent
    ending = "urdf.xacro" if "xmlns:xacro" in rule.page.bad else "urdf"
    file = home / f"example.{ending}"
    file.write_text(whole(rule.page.bad))
    return file


def said(file: Path, simulator: str = "gazebo", layout: str = "frames-per-robot") -> list[Finding]:
    """Return what the plan of two such robots says; nothing of one that is refused."""
    robots = [
        {"name": name, "description": str(file), "pose": {"y": 3 * at}}
        for at, name in enumerate(("robot1", "robot2"))
    ]
    data = {"layout": layout, "distro": "jazzy", "robots": robots}
    data = {**data, "simulator": simulator} if simulator else data
    found = planned_fleet(data, around=os.environ)
    return [*dict.fromkeys((*found.of_rewrites, *found.fleet.table.problems))]


@pytest.mark.parametrize("code", [it.code for it in ASKED])
def test_an_error_of_the_lint_is_one_of_the_fleet(code: str, tmp_path: Path) -> None:
    file = described(RULES[code], tmp_path)
    wrong = {it.code for it in lint_file(str(file), Settings()) if it.level == ERROR}
    try:
        told = Counter(it.code for it in said(file, layout="tf-per-robot") if it.level != NOTE)
    except MultibotError:
        return
    assert wrong <= told.keys()
    assert told[code] <= 1


GAZEBO = """\
<gazebo>
  <plugin name="gz_ros2_control::GazeboSimROS2ControlPlugin" filename="gz_ros2_control-system">
    {}<hold_joints>true</hold_joints>
  </plugin>
</gazebo>
"""
LINK = '<link name="base"><inertial><mass value="1"/>{}</inertial></link>'
SOLID = '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>'


MAY_BE = [it.code for it in RULES.values() if may_stop(it) and URDF in it.formats and it.page.bad]
# A system of the world is moved from the description to the world; a file of MuJoCo that a relative
# path names is next to the source alone.
ELSEWHERE = {"MB160", "MB245"}
# The rewrite refuses them, whatever is ignored.
REFUSED = {"MB101", "MB102", "MB103", "MB109", "MB201", "MB244", "MB420", "MB424"}


def errors(capsys: pytest.CaptureFixture[str], *words: str) -> tuple[int, set[str]]:
    """Return the exit code of a command, and the codes of its errors."""
    ended = main([*words, "-q"])
    return ended, set(re.findall(r" error: (M\w\d+)", "".join(capsys.readouterr())))


def built_all_the_same(
    fleet: Path, out: Path, capsys: pytest.CaptureFixture[str]
) -> set[str] | None:
    """Return the errors of a build that is made in spite of them; None where the rewrite refuses it."""
    build = ("build", str(fleet), "-o", str(out))
    ended, wrong = errors(capsys, *build)
    if ended and errors(capsys, *build, *(f"--ignore={it}" for it in wrong))[0]:
        return None
    return wrong


@pytest.mark.sample(12)
@pytest.mark.slow
@pytest.mark.parametrize("simulator", ["gazebo", "", "none"])
@pytest.mark.parametrize("code", MAY_BE)
def test_the_built_folder_has_the_errors_of_its_build(
    code: str, simulator: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Built in spite of what ``build`` calls wrong, ``check-launch`` calls the same wrong."""
    file, fleet, out = described(RULES[code], tmp_path), tmp_path / "fleet.yaml", tmp_path / "out"
    said = f"simulator: {simulator}\n" if simulator else ""
    fleet.write_text(
        f"{said}layout: frames-per-robot\ndistro: jazzy\ndescription: {file}\n{ROBOTS}"
    )
    wrong = built_all_the_same(fleet, out, capsys)
    if wrong is None:
        assert code in REFUSED
        return
    ended, found = errors(capsys, "check-launch", str(out / "fleet.launch.py"))
    assert found <= wrong
    assert {it for it in wrong if it.startswith("MB")} - ELSEWHERE <= found
    assert bool(found) == (ended == 1)


_OF_NODE = "{}: {{ros__parameters: {{{}}}}}\n"
_OF_FILES = [it for it in RULES.values() if "params" in it.formats and "ros__" in it.page.bad]
PARAMS = {
    **{it.code: (it.page.bad, it.page.beside) for it in _OF_FILES},
    # Of one code many values: what rclcpp and the nodes of Nav2 say of them.
    **{value: (_OF_NODE.format(node, value), {}) for node, value in (
        ("amcl", "max_beams: 60.5"),
        ("amcl", 'set_initial_pose: "yes"'),
        ("amcl", "laser_model_type: liklihood_field"),
        ("amcl", "odom_frame_id: odo"),
        ("amcl", "base_frame_id: base_lnk"),
        ("amcl", "scan_topic: 1scan"),
        ("amcl", "scan_topic: /robot2/scan"),
        ("controller_server", "controller_frequency: fast"),
        ("controller_server", "controller_plugins: [FollowPath]"),
        ("controller_server", "controller_plugins: [F], F: {plugin: dwb_core::Nope}"),
        ("bt_navigator", "odom_topic: /odometry/filtered"),
        ("velocity_smoother", "max_velocity: [0.5, 0.0]"),
        ("lifecycle_manager_navigation", "node_names: [controller_server]"),
    )},
}  # fmt: skip


@pytest.mark.sample(24)
@pytest.mark.slow
@pytest.mark.parametrize("layout", ["tf-per-robot", "postfix"])
@pytest.mark.parametrize("code", PARAMS)
def test_no_error_of_a_parameter_file_is_new_to_the_folder(
    code: str, layout: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """What ``check-launch`` calls wrong with or without the plan, ``build`` has called wrong."""
    (own, beside), fleet, out = PARAMS[code], tmp_path / "fleet.yaml", tmp_path / "out"
    write_files(tmp_path, {"robot.urdf": DESCRIPTION, **beside, "own.yaml": own})
    fleet.write_text(
        f"layout: {layout}\ndistro: jazzy\nsimulator: none\nnode_sets: [nav2]\n"
        f"description: robot.urdf\nrelated_files: {{params: own.yaml}}\n{ROBOTS}"
    )
    wrong = built_all_the_same(fleet, out, capsys)
    if wrong is None:
        assert code in REFUSED
        return
    for words in ((), ("--plan", str(out / "plan.yaml"))):
        assert errors(capsys, "check-launch", str(out / "fleet.launch.py"), *words)[1] <= wrong


MOVING = '<joint name="j" type="continuous"><parent link="base"/><child link="a"/></joint>'


@pytest.mark.parametrize(
    ("simulator", "text", "code", "told"),
    [
        ("", '<link name="a"/>' + GAZEBO.format(""), "MB610", True),
        ("gazebo", '<link name="a"/>' + GAZEBO.format(""), "MB610", False),
        ("", LINK.format(SOLID) + LINK.format(SOLID).replace("base", "a"), "MB501", False),
        ("", LINK.format(SOLID) + '<link name="a"/>' + MOVING, "MB603", False),
    ],
)
def test_an_error_of_a_simulator_says_how_to_say_that_there_is_none(
    simulator: str, text: str, code: str, told: bool, tmp_path: Path
) -> None:
    """Only where the fleet file does not say it, and where it would help."""
    file = tmp_path / "robot.urdf"
    file.write_text(f'<robot name="r">{text}</robot>')
    (found,) = [it for it in said(file, simulator) if it.code == code]
    assert found.hint.endswith("; for a real robot write simulator: none") == told


def test_a_name_that_the_rewrite_changes_is_no_error(tmp_path: Path) -> None:
    """sdformat reserves ``world`` for joints: robot1/world is none of these."""
    file = tmp_path / "robot.urdf"
    joint = '<joint name="world" type="fixed"><parent link="base"/><child link="a"/></joint>'
    file.write_text(f'<robot name="r">{LINK.format(SOLID)}<link name="a"/>{joint}</robot>')
    named = {"frames-per-robot": [], "tf-per-robot": [("MB306", ERROR)]}
    for layout, expected in named.items():
        found = [(it.code, it.level) for it in said(file, layout=layout) if it.code == "MB306"]
        assert found == expected


STATES = """\
<launch><node pkg="robot_state_publisher" exec="robot_state_publisher">
  <param name="robot_description" value="$(command 'cat $(dirname)/robot.urdf')"/></node>{}</launch>
"""
SPAWNS = '<node pkg="ros_gz_sim" exec="create" args="-name r -topic robot_description"/>'


@pytest.mark.parametrize(
    ("simulator", "started", "level"),
    [
        # sdformat src/Model.cc refuses the name, and gz-sim UserCommands.cc then creates nothing.
        ("gazebo", "", "error"),
        # The user's own launch file has the same error for one robot.
        ("gazebo", SPAWNS, "warning"),
        # Nobody has said that the robot is simulated.
        ("", "", "warning"),
    ],
)
def test_an_error_of_a_simulator_is_known_only_where_the_launch_file_spawns_the_robot(
    simulator: str, started: str, level: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = f'<robot name="world">{LINK.format(SOLID)}{GAZEBO.format("")}</robot>'
    fleet = "layout: tf-per-robot\ndistro: jazzy\ndescription: robot.urdf\nlaunch: up.launch.xml\n"
    fleet += ROBOTS + (f"simulator: {simulator}\n" if simulator else "")
    texts = {"robot.urdf": text, "up.launch.xml": STATES.format(started), "fleet.yaml": fleet}
    write_files(tmp_path, texts)
    main(["build", str(tmp_path / "fleet.yaml"), "-o", str(tmp_path / "out"), "--trust"])
    assert f" {level}: MB306" in capsys.readouterr().err


@pytest.mark.more
def test_a_rule_that_is_not_asked_makes_no_error() -> None:
    """``described`` asks those that are errors, and three that may be; a text of xacro is no robot's.
    MB219 shares its function with MB211."""
    others = [it for it in RULES.values() if it.check and URDF in it.formats and it.level != ERROR]
    sources = {it.code: inspect.getsource(getattr(it.check, "func", it.check)) for it in others}
    assert {it for it, text in sources.items() if "ERROR" in text} == {
        "MB146",
        "MB172",
        "MB219",
        "MB603",
        "MB610",
    }
