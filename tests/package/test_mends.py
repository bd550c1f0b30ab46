# SPDX-License-Identifier: Apache-2.0
"""A finding's sentence leads to its mend: provoked in a real file, mended by what it says, it is gone.

The rule by which these twenty were chosen: every 19th code of ``multibot inspect``, from the tenth on.
"""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import pytest
from paths import ROOT, fixture_text

from multibot_rewrite.cli.multibot import main as multibot
from multibot_rewrite.cli.urdf_lint import main as urdf_lint
from multibot_rewrite.cli.urdf_postfix import main as urdf_postfix

MAINS = {"multibot": multibot, "urdf-lint": urdf_lint, "urdf-postfix": urdf_postfix}
ROVER, GZ, GRAPHS = "fixtures/robots/rover.urdf", "fixtures/robots/rover_gz.urdf", "fixtures/graphs"
ARMS, HEX = "examples/two_arms_moveit", "examples/namespace_and_prefix"
ARM, CHECK = f"{ARMS}/arm.urdf", "multibot check plan.yaml --from"
ELBOW = '    <limit lower="-2.2" upper="2.2" effort="20" velocity="1.5"/>\n'
COMMAND, RULE = "<command_interface name=", "<remapping>%s</remapping>"
FIRST = f'<joint name="shoulder_joint">\n      {COMMAND}"position"/>'
CLIP, FOUND = "<near>%s</near><far>%s</far>", "file://$(find arm)"
BLOCKS = "".join(
    f'<gazebo reference="left_wheel"><mu1>{it}</mu1></gazebo>\n' for it in ("1", "0.2")
)
PAIR = '<disable_collisions link1="base_link" link2="tool_link" reason="Never"/>'
PANEL = "  - Class: slam_toolbox::SlamToolboxPlugin\n    Name: Slam\n"
HAND = "hand_controller: {type: %s}"
KNOWN, OWN = "joint_trajectory_controller/JointTrajectoryController", "acme/Hand"
NODES = f"nodes:\n  hand_controller: {{package: acme, types: [{OWN}], host: controller_manager}}\n"
FLEET = (
    "description: hexbase.urdf.xacro\nlayout: frames-per-robot\nrelated_files: {rviz: nav2.rviz}\n"
)
FLEET += "robots: [{name: robot1}, {name: robot2, pose: {y: 2.0}}]\n"
LAUNCH = fixture_text("mends_launch.txt")
CONTROLLER = '{"manager": "/robot1/controller_manager", "name": "arm", "state": "%s", "claims": []}'
TF = ', remappings=[("/tf", "tf"), ("/tf_static", "tf_static")],'
Edit = tuple[str, str, str]


class Row(NamedTuple):
    """The real files, what is done to them (file, old, new; of no file a command), the command that
    finds it, words of its sentence, and what these words say to do; ``then`` is another command."""

    code: str
    files: tuple[str, ...]
    wrong: tuple[Edit, ...]
    command: str
    says: str
    mend: tuple[Edit, ...] = ()
    then: str = ""


ROWS = (
    Row("MB106", (ROVER,), (("", "urdf-postfix rover.urdf robot1 -o made.urdf", ""),),
        "urdf-lint made.urdf --robots robot1,robot2", "lint the source it was made from", (),
        "urdf-lint rover.urdf --robots robot1,robot2"),
    Row("MB133", (ARM,), (("arm.urdf", '<robot name="arm">', '<robot name="arm" version="1.1">'),),
        "urdf-lint arm.urdf --distro jazzy", "write version 1.0",
        (("arm.urdf", 'version="1.1"', 'version="1.0"'),)),
    Row("MB210", (ROVER,), (("rover.urdf", "</robot>", f"{BLOCKS}</robot>"),),
        "urdf-lint rover.urdf", "keep one", (("rover.urdf", BLOCKS.splitlines(True)[1], ""),)),
    Row("MB238", (GZ,),
        (("rover_gz.urdf", f'{COMMAND}"velocity"', f'{COMMAND}"acceleration"'),),
        "urdf-lint rover_gz.urdf", "use one of position, velocity, effort",
        (("rover_gz.urdf", '"acceleration"', '"velocity"'),)),
    Row("MB401", (ROVER,),
        (("rover.urdf", "<left_joint>", f"<ros>{RULE % 'cmd_vel:=/cmd_vel'}</ros><left_joint>"),),
        "urdf-lint rover.urdf", "'cmd_vel' follows", (("rover.urdf", ":=/cmd_vel", ":=cmd_vel"),)),
    Row("MB421", (ARM,), (("arm.urdf", '"tool_link"', '"upper_link_left"'),),
        "urdf-lint arm.urdf --robots right,left_right --layout frames-per-robot --separator link=_",
        "rename a robot", (),
        "urdf-lint arm.urdf --robots right,middle --layout frames-per-robot --separator link=_"),
    Row("MB509", (ARM,), (("arm.urdf", ELBOW, ""),), "urdf-lint arm.urdf",
        "write lower, upper, effort and velocity",
        (("arm.urdf", '<child link="fore_link"/>\n', f'<child link="fore_link"/>\n{ELBOW}'),)),
    Row("MB538", (ARM,),
        (("arm.urdf", FIRST, f'{FIRST[:-2]}><param name="min">-9</param></command_interface>'),),
        "urdf-lint arm.urdf", "stay in its <limit>: -1.5 to 1.5", (("arm.urdf", ">-9<", ">-1.5<"),)),
    Row("MB629", (GZ,), (("rover_gz.urdf", "<camera>", f"<camera><clip>{CLIP % (10, 0.1)}</clip>"),),
        "urdf-lint rover_gz.urdf", "write a near above 0 and below far",
        (("rover_gz.urdf", CLIP % (10, 0.1), CLIP % (0.1, 10)),)),
    Row("MB712", (ARM,),
        (("arm.urdf", '<cylinder radius="0.08" length="0.1"/>', f'<mesh filename="{FOUND}/a.stl"/>'),),
        "urdf-lint arm.urdf", "write package://NAME/", (("arm.urdf", FOUND, "package://arm"),)),
    Row("MB819", (ARM, f"{ARMS}/arm.srdf"), (("arm.srdf", "</robot>", f"{PAIR}</robot>"),),
        "urdf-lint arm.srdf --urdf arm.urdf", "delete the line", (("arm.srdf", PAIR, ""),)),
    Row("MB874", (f"{HEX}/bridge.yaml",), (("bridge.yaml", "gz.msgs.Clock", "gz.msgs.IMU"),),
        "urdf-lint bridge.yaml", "with gz.msgs.IMU write sensor_msgs/msg/Imu",
        (("bridge.yaml", "rosgraph_msgs/msg/Clock", "sensor_msgs/msg/Imu"),)),
    Row("MB895", (f"{HEX}/nav2_params.yaml",),
        (("nav2_params.yaml", "robot_radius: 0.18", "robot_radius: 0.6"),),
        "urdf-lint nav2_params.yaml", "inflate further than that",
        (("nav2_params.yaml", "inflation_radius: 0.4", "inflation_radius: 0.7"),)),
    Row("MF202", (f"{HEX}/hexbase.urdf.xacro", f"{HEX}/nav2.rviz"),
        (("nav2.rviz", "Panels:\n", f"Panels:\n{PANEL}"), ("fleet.yaml", "", FLEET)),
        "multibot build", "delete it here", (("nav2.rviz", PANEL, ""),)),
    Row("MF802", tuple(f"{ARMS}/{it.name}" for it in (ROOT / ARMS).iterdir()),
        (("controllers.yaml", HAND % KNOWN, HAND % OWN),), "multibot build",
        "describe it in a file of nodes (docs/node-sets.md)",
        (("nodes.yaml", "", NODES), ("fleet.yaml", "layout:", "nodes: nodes.yaml\nlayout:"))),
    Row("MG320", (f"{GRAPHS}/MG320.json", f"{GRAPHS}/plan.yaml"), (), f"{CHECK} MG320.json",
        "it publishes /status instead", (("MG320.json", '"/status"', '"/robot2/status"'),)),
    Row("MG306", (f"{GRAPHS}/MG306.json", f"{GRAPHS}/plan.yaml"), (), f"{CHECK} MG306.json",
        "the plan has it as nav_msgs/msg/Odometry",
        (("MG306.json", "geometry_msgs/msg/PoseStamped", "nav_msgs/msg/Odometry"),)),
    Row("MG402", (ROVER,), (("two.launch.py", "", LAUNCH),), "multibot check-launch two.launch.py",
        "pass -r /tf:=tf -r /tf_static:=tf_static",
        (("mended.launch.py", "", LAUNCH.replace("namespace=it,", f"namespace=it{TF}")),),
        "multibot check-launch mended.launch.py"),
    Row("MG513", (f"{GRAPHS}/healthy.json",),
        (("healthy.json", '"edges"', f'"controllers": [{CONTROLLER % "inactive"}], "edges"'),),
        "multibot check --from healthy.json", "see the log of the spawners",
        (("healthy.json", '"inactive"', '"active"'),)),
    Row("MR103", (ROVER,), (("rover.urdf", "<ros>", f"<ros>{RULE % 'laser_scan:=scan'}"),),
        "multibot plan rover.urdf robot1 -o plan.yaml", "remove it",
        (("rover.urdf", RULE % "laser_scan:=scan", ""),)),
)  # fmt: skip


def edit(folder: Path, edits: Sequence[Edit]) -> None:
    for file, old, new in edits:
        if not file:
            program, *words = old.split()
            assert MAINS[program](words) == 0
            continue
        path = folder / file
        before = path.read_text() if old else ""
        assert old in before
        path.write_text(before.replace(old, new) if old else new)


def found(row: Row, command: str, capsys: pytest.CaptureFixture[str]) -> list[str]:
    """Return what the command says with the code of the row."""
    program, *words = command.split()
    capsys.readouterr()
    MAINS[program](words)
    said = capsys.readouterr()
    return [it for it in (said.out + said.err).splitlines() if f": {row.code} " in it]


@pytest.mark.more
@pytest.mark.sample(2)
@pytest.mark.parametrize("row", ROWS, ids=lambda it: it.code)
def test_a_finding_is_gone_where_its_sentence_is_followed(
    row: Row, here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for it in row.files:
        shutil.copy(ROOT / it, here)
    edit(here, row.wrong)
    said = found(row, row.command, capsys)
    assert any(row.says in it for it in said), said
    edit(here, row.mend)
    assert found(row, row.then or row.command, capsys) == []
