# SPDX-License-Identifier: Apache-2.0
"""A built fleet is read back: faults planted in its files are found, and a whole one is silent.

Expectations: what launch does with a file that is not there, and tf2 with a frame that two robots send.
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from pathlib import Path

import pytest
from built_faults import FLEET, OUT, Edit, edited, fleet, in_file, in_launch, node, without
from fleet_folder import planned_fleet
from paths import ROOT

from multibot_rewrite.base.findings.finding import ERROR
from multibot_rewrite.checks.build import Outputs, make_outputs
from multibot_rewrite.checks.read_back import read_back
from multibot_rewrite.cli import build
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.fleet.fleet_plan import FleetPlan

EXAMPLE = ROOT / "examples" / "namespace_and_prefix" / "nav2.yaml"
EXAMPLES = sorted((ROOT / "examples").glob("*/fleet.yaml"))


@pytest.fixture(scope="module")
def built() -> tuple[FleetPlan, Outputs]:
    plan = planned_fleet(EXAMPLE, around=os.environ, trust=True)
    return plan, make_outputs(plan, OUT)


@pytest.mark.more
@pytest.mark.sample(4)
@pytest.mark.parametrize("release", ["humble", "jazzy", "lyrical"])
@pytest.mark.parametrize("example", EXAMPLES, ids=lambda it: it.parent.name)
def test_nothing_is_wrong_with_the_examples_in_any_release(example: Path, release: str) -> None:
    plan = planned_fleet(example, release, around=os.environ, trust=True)
    assert read_back(plan, make_outputs(plan, OUT), OUT) == []


@pytest.mark.more
def test_a_rule_that_a_rehearsal_would_miss_is_an_error() -> None:
    """Humble's controller manager asks for ~/robot_description (ros2_control 2,
    controller_manager.cpp), robot_state_publisher sends robot_description."""
    example = str(ROOT / "examples" / "two_arms_moveit" / "fleet.yaml")
    plan = planned_fleet(example, "humble", around=os.environ, trust=True)
    spoiled = edited(make_outputs(plan, OUT), in_launch(without("~/robot_description")))
    found = {
        it.node: it.code for it in read_back(plan, spoiled, OUT) if it.node and it.level == ERROR
    }
    assert found.keys() == {"/left/controller_manager", "/right/controller_manager"}


@pytest.mark.more
@pytest.mark.sample(1)
@pytest.mark.parametrize(
    "path", ["robot1/hexbase.urdf", "robot2/nav2_params.yaml", "robot1/bridge.yaml"]
)
def test_a_file_that_the_launch_file_names_and_is_not_there(
    path: str, built: tuple[FleetPlan, Outputs]
) -> None:
    left = tuple(it for it in built[1].files if it.path != path)
    found = read_back(built[0], built[1]._replace(files=left), OUT)
    named = [it for it in found if it.code == "MF823" and path in it.message]
    assert named and all(it.level == ERROR for it in named)
    assert all((it.file, it.line > 1) == ("fleet.launch.py", True) for it in named)


@pytest.mark.more
def test_a_robot_with_the_description_of_another_one(built: tuple[FleetPlan, Outputs]) -> None:
    other = next(it.data for it in built[1].files if it.path == "robot1/hexbase.urdf").decode()
    spoiled = edited(built[1], lambda path, text: other if path == "robot2/hexbase.urdf" else text)
    codes = {it.code: it.level for it in read_back(built[0], spoiled, OUT)}
    assert codes["MG208"] == ERROR


# Faults of one file, each with the code in front that `multibot check` has for it where the fleet runs.
PLANTED: Mapping[str, Edit] = {
    "MG311: a rule leads to the other robot": in_launch(
        lambda it: it.replace('"cmd_vel_nav")', '"/robot2/cmd_vel_nav")', 1)
    ),
    "MG405: tf goes to the other robot": node(
        "robot1", "amcl", lambda it: it.replace('"tf")', '"/robot2/tf")')
    ),
    "MG315: a rule is lost": node("robot1", "controller_server", without("cmd_vel")),
    "MG101: a node is lost": node("robot1", "velocity_smoother", lambda it: ""),
    "MG101: a node has another name": node(
        "robot1", "amcl", lambda it: it.replace('"amcl"', '"amcl_node"')
    ),
    "MG101: a node is not in its robot's namespace": node(
        "robot2", "amcl", lambda it: it.replace('namespace="/robot2",', "")
    ),
    "MG303: a parameter file has another topic": in_file(
        "robot2/nav2_params.yaml", "scan_topic: scan", "scan_topic: robot2/scan"
    ),
    "MG303: a costmap's source is misspelt": in_file(
        "robot1/nav2_params.yaml", "topic: /robot1/scan", "topic: /robot1/scn"
    ),
    "MF823: a parameter file is not given": node(
        "robot1", "collision_monitor", lambda it: it.replace("*params, ", "")
    ),
    "MG102: a lifecycle manager waits for nobody": in_launch(
        lambda it: it.replace('  "smoother_server",', '  "smother_server",', 1)
    ),
    "MG407: a frame of the other robot": in_file(
        "robot2/nav2_params.yaml", "odom_frame_id: odom", "odom_frame_id: robot1/odom"
    ),
    "MG503: a node is on the wrong clock": node(
        "robot1", "amcl", lambda it: it.replace("CLOCK]", 'CLOCK, {"use_sim_time": False}]')
    ),
    "MG126: a row of the bridge has another type": in_file(
        "robot1/bridge.yaml", "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/PointCloud2"
    ),
    "MG126: a row of the bridge goes the other way": in_file(
        "robot1/bridge.yaml", "GZ_TO_ROS", "ROS_TO_GZ"
    ),
    "MF823: a node has no description": in_launch(
        lambda it: it.replace('{"robot_description": text("robot1/hexbase.urdf")},', "", 1)
    ),
}


@pytest.mark.more
@pytest.mark.sample(3)
@pytest.mark.parametrize("name", PLANTED)
def test_a_planted_fault_is_an_error_of_its_code(name: str) -> None:
    code, edit = name.partition(":")[0], PLANTED[name]
    plan, made = fleet()
    found = read_back(plan, edited(made, edit), OUT)
    assert code in {it.code for it in found if it.level == ERROR}
    own = [it for it in found if it.code == code and it.file]
    # At the node, or at the parameter that names the topic.
    assert all(it.file.endswith(("fleet.launch.py", "/nav2_params.yaml")) for it in own)
    assert all(it.line for it in own)


# Faults that a launch file alone shows, and where each is told.
LAUNCHED: Mapping[str, tuple[Edit, str, str]] = {
    "a lifecycle node is in no list": (
        in_launch(lambda it: it.replace('  "smoother_server",', "", 1)),
        *("MG726", "fleet.launch.py"),
    ),
    "a row of the bridge has another type in Gazebo": (
        in_file("robot1/bridge.yaml", "gz.msgs.LaserScan", "gz.msgs.Image"),
        *("MB879", "robot1/bridge.yaml"),
    ),
}


@pytest.mark.more
@pytest.mark.parametrize("name", LAUNCHED)
def test_what_check_launch_finds_in_the_folder_is_an_error(name: str) -> None:
    edit, code, file = LAUNCHED[name]
    plan, made = fleet()
    found = [it for it in read_back(plan, edited(made, edit), OUT) if it.code == code]
    assert {(it.level, it.file, bool(it.line)) for it in found} == {(ERROR, file, True)}


@pytest.mark.more
@pytest.mark.sample(3)
@pytest.mark.parametrize(
    "name", ["MG315: a rule is lost", "MG101: a node is lost", "MF823: a node has no description"]
)
def test_the_command_ends_with_an_error_and_writes_nothing(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    code, edit = name.partition(":")[0], PLANTED[name]
    (tmp_path / "fleet.yaml").write_text(FLEET)
    monkeypatch.setattr(build, "make_outputs", lambda *given: edited(make_outputs(*given), edit))
    out = tmp_path / "out"
    assert main(["build", str(tmp_path / "fleet.yaml"), "-o", str(out)]) == 1
    assert not out.exists()
    said = capsys.readouterr().err
    assert f"error: {code} " in said and "nothing was written" in said


_SPAWNER = re.compile(
    r'(?s)        Node\(\n            package="controller_manager",\n'
    r'            executable="spawner",\n            namespace="/left",\n'
    r'            arguments=\["hand_controller"\].*?\n        \),\n'
)
CONTROLLERS: Mapping[str, tuple[Edit, str, str]] = {
    "declared and not spawned": (
        in_launch(lambda it: _SPAWNER.sub("", it)),
        "MG101",
        "/left/hand_controller",
    ),
    "spawned and not declared": (
        lambda path, it: (
            it.replace("hand_controller:", "hand:") if path == "left/controllers.yaml" else it
        ),
        "MG102",
        "/left/hand_controller",
    ),
    "spawned into the other robot": (
        in_launch(lambda it: _SPAWNER.sub(lambda one: one[0].replace('"/left"', '"/right"'), it)),
        "MG101",
        "/left/hand_controller",
    ),
    "without its manager": (
        in_launch(lambda it: it.replace('name="controller_manager"', 'name="manager"', 1)),
        "MG101",
        "/left/controller_manager",
    ),
}


@pytest.mark.more
@pytest.mark.sample(1)
@pytest.mark.parametrize("name", CONTROLLERS)
def test_a_controller_runs_as_it_is_declared(name: str) -> None:
    edit, code, lost = CONTROLLERS[name]
    example = str(ROOT / "examples" / "two_arms_moveit" / "fleet.yaml")
    plan = planned_fleet(example, around=os.environ, trust=True)
    found = read_back(plan, edited(make_outputs(plan, OUT), edit), OUT)
    errors = [it for it in found if it.level == ERROR and it.code == code]
    # Three missing nodes of a robot are one finding.
    assert any(lost in (it.node, *it.names) or f"{lost}" in it.message for it in errors)


@pytest.mark.more
def test_a_launch_file_that_cannot_be_read(built: tuple[FleetPlan, Outputs]) -> None:
    spoiled = edited(built[1], in_launch(lambda it: "import nothing_of_that_name\n"))
    (found,) = read_back(built[0], spoiled, OUT)
    assert (found.code, found.level, found.file) == ("MF823", ERROR, "fleet.launch.py")


@pytest.mark.slow
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
    assert "text(f'{name}/arm.urdf')" in (out / "fleet.launch.py").read_text()
    assert main(["check-launch", str(out / "fleet.launch.py")]) in (0, 3)


DRIVE = """<robot name="rover"><link name="base_link"/><link name="laser"/>
<joint name="to_laser" type="fixed"><parent link="base_link"/><child link="laser"/></joint></robot>"""
FILTER = "{}:\n  ros__parameters: {{odom_frame: odom, base_link_frame: base_link, odom0: wheels}}\n"
LATER = ["ax_max", "ax_min", "ay_max", "ay_min", "az_max"]


@pytest.mark.slow
@pytest.mark.parametrize("node_set", ["robot_localization, ", ""])
def test_a_filter_whose_file_is_there_runs_or_its_lack_is_told(
    node_set: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """odom -> base_link is sent by the filter alone (robot_localization ros_filter.cpp); Humble's MPPI
    has none of the five limits of Jazzy's (nav2_mppi_controller optimizer.cpp)."""
    (tmp_path / "config").mkdir()
    (tmp_path / "fleet").mkdir()
    (tmp_path / "config" / "rover.urdf").write_text(DRIVE)
    (tmp_path / "config" / "ukf.yaml").write_text(FILTER.format("ukf_filter_node"))
    mppi = "\n".join(f"      {it}: 3.0" for it in LATER)
    (tmp_path / "config" / "nav2.yaml").write_text(
        "controller_server:\n  ros__parameters:\n    controller_plugins: [FollowPath]\n"
        f"    FollowPath:\n      plugin: nav2_mppi_controller::MPPIController\n{mppi}\n"
    )
    files = "".join(f"../config/{it}, " for it in ("ukf.yaml", "nav2.yaml"))
    fleet = tmp_path / "fleet" / "fleet.yaml"
    fleet.write_text(
        f"distro: humble\nlayout: tf-per-robot\nsimulator: none\nnode_sets: [{node_set}navigation, "
        "slam_toolbox]\ndescription: ../config/rover.urdf\n"
        f"related_files: {{params: [{files}]}}\nrobots: [{{name: robot1}}, {{name: robot2}}]\n"
    )
    out = tmp_path / "out"
    assert main(["build", str(fleet), "-o", str(out)]) == 0
    said = capsys.readouterr().err
    started = "executable='ukf_node'" in (out / "fleet.launch.py").read_text()
    assert (started, "MG406" in said) == (bool(node_set), not node_set)
    assert f"{tmp_path}/config/nav2.yaml:" in said
    assert f"{tmp_path}/fleet/.." not in said
    assert "there are 2 more such notes in the file, at lines 9, 10 " in said
    assert max(map(len, (out / "fleet.launch.py").read_text().splitlines())) < 100


@pytest.mark.parametrize(("frame", "code"), [("odom", 0), ("odo", 1)])
def test_what_a_check_says_of_the_folder_alone_is_an_error(
    frame: str, code: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """amcl sends map -> odo, and the drive odom -> base_footprint: no tree has both (amcl_node.cpp)."""
    fleet, out = tmp_path / "fleet.yaml", tmp_path / "out"
    amcl = f"amcl: {{ros__parameters: {{odom_frame_id: {frame}, base_frame_id: base_footprint}}}}\n"
    (tmp_path / "amcl.yaml").write_text(amcl)
    fleet.write_text(
        "layout: tf-per-robot\ndistro: jazzy\nsimulator: none\nnode_sets: [nav2]\n"
        f"description: {ROOT / 'fixtures' / 'robots' / 'rover.urdf'}\n"
        "related_files: {params: amcl.yaml}\nrobots: [{name: robot1}, {name: robot2, pose: {y: 3}}]\n"
    )
    assert main(["build", str(fleet), "-o", str(out), "-q"]) == code
    said = capsys.readouterr().err
    assert ("error: MG415 " in said) == bool(code)
    words = () if not code else ("--ignore", "MG415")
    assert main(["build", str(fleet), "-o", str(out), "-q", *words]) == 0
    assert main(["check-launch", str(out / "fleet.launch.py")]) in (code, 3)
