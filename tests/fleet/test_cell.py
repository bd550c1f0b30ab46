# SPDX-License-Identifier: Apache-2.0
"""``cell`` of a fleet file: several arms as one robot for one move_group.

The consumers: urdfdom (yourdfpy's reading of the joined text), srdfdom, rcl's parameters, MoveIt's
simple controller manager, which asks for ``NAME/ACTION_NS`` below the namespace of its node.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml
from fleet_folder import planned_fleet
from lxml import etree
from plans import ends_of, own

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import InputError
from multibot_rewrite.checks.build import make_outputs
from multibot_rewrite.planning.plan import read_plan

URDF = """\
<robot name="arm">
  <material name="grey"><color rgba="0.5 0.5 0.5 1"/></material>
  <material name="paint"><color rgba="PAINT"/></material>
  <link name="base">
    <visual><geometry><box size="1 1 1"/></geometry><material name="paint"/></visual>
  </link>
  <link name="hand"/>
  <joint name="elbow" type="revolute">
    <parent link="base"/><child link="hand"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
</robot>
"""
SRDF = """\
<robot name="arm">
  <group name="arm"><joint name="place"/><joint name="elbow"/></group>
  <group_state name="home" group="arm"><joint name="elbow" value="0"/></group_state>
  <virtual_joint name="place" type="fixed" parent_frame="world" child_link="base"/>
  <disable_collisions link1="base" link2="hand" reason="Adjacent"/>
</robot>
"""
CONTROLLERS = """\
moveit_controller_manager: moveit_simple_controller_manager/MoveItSimpleControllerManager
moveit_simple_controller_manager:
  controller_names: [arm_controller]
  arm_controller: {type: FollowJointTrajectory, action_ns: follow_joint_trajectory, joints: [elbow]}
"""
RVIZ = """\
Visualization Manager:
  Class: ""
  Displays:
    - Class: moveit_rviz_plugin/MotionPlanning
      Name: MotionPlanning
      Move Group Namespace: ""
      Planned Path:
        Trajectory Topic: /display_planned_path
      Planning Request:
        Planning Group: arm
      Robot Description: robot_description
  Global Options:
    Fixed Frame: base
"""
FLEET = """\
cell: {groups: {both: [left_arm, right_arm]}}
layout: frames-per-robot
affix: prefix
distro: jazzy
srdf: arm.srdf
node_sets: moveit
simulator: none
related_files: {moveit: [limits.yaml, controllers.yaml, servo.yaml], rviz: moveit.rviz}
robots:
  - {name: left, description: arm.urdf, pose: {y: 0.5, yaw: 1.5}}
  - {name: right, description: other.urdf, pose: {y: -0.5}}
"""
FILES = {
    "arm.urdf": URDF.replace("PAINT", "1 0 0 1"),
    "other.urdf": URDF.replace("PAINT", "0 0 1 1"),
    "arm.srdf": SRDF,
    "limits.yaml": "joint_limits:\n  elbow: {has_velocity_limits: true, max_velocity: 1.0}\n",
    "controllers.yaml": CONTROLLERS,
    "servo.yaml": "move_group_name: arm\nplanning_frame: base\n",
    "moveit.rviz": RVIZ,
    "fleet.yaml": FLEET,
}


def built(folder: Path, **changed: str) -> tuple[dict[str, bytes], list[Finding]]:
    """Return the fleet's files and findings; ``changed`` are other texts, ``_`` for a dot in names."""
    for name, text in {
        **FILES,
        **{it.replace("_", "."): text for it, text in changed.items()},
    }.items():
        (folder / name).write_text(text)
    plan = planned_fleet(folder / "fleet.yaml")
    made = make_outputs(plan)
    return {it.path: it.data for it in made.files}, list(made.findings)


def fleet(old: str, new: str) -> str:
    assert old in FLEET
    return FLEET.replace(old, new)


def parameters(files: dict[str, bytes]) -> dict[str, Any]:
    found = yaml.safe_load(files["cell/moveit_parameters.yaml"])["/**"]["ros__parameters"]
    assert isinstance(found, dict)
    return found


def refused(folder: Path, **changed: str) -> str:
    with pytest.raises(InputError) as error:
        built(folder, **changed)
    return str(error.value).partition(": ")[2]


@pytest.mark.slow
def test_a_referee_reads_the_joined_description(tmp_path: Path) -> None:
    yourdfpy = pytest.importorskip("yourdfpy")
    (tmp_path / "cell.urdf").write_bytes(built(tmp_path)[0]["cell/cell.urdf"])
    robot = yourdfpy.URDF.load(str(tmp_path / "cell.urdf"), load_meshes=False)
    assert robot.base_link == "map"
    assert robot.actuated_joint_names == ["left_elbow", "right_elbow"]
    assert robot.get_transform("right/base", "map")[1][3] == -0.5


def test_feet_on_one_world_are_adjacent(tmp_path: Path) -> None:
    """compute_default_collisions.cpp: a link without geometry leaves those beside it adjacent."""
    shape = '<collision><geometry><box size="1 1 1"/></geometry></collision></link>'
    texts = {
        f"{it}_urdf": FILES[f"{it}.urdf"].replace("</link>", shape, 1) for it in ("arm", "other")
    }
    root = etree.fromstring(built(tmp_path, **texts)[0]["cell/cell.srdf"])
    last = root.findall("disable_collisions")[-1]
    assert dict(last.attrib) == {"link1": "left/base", "link2": "right/base", "reason": "Adjacent"}


@pytest.mark.more
def test_one_move_group_is_planned_and_started(tmp_path: Path) -> None:
    files, _ = built(tmp_path)
    plan = read_plan(files["plan.yaml"], "plan.yaml")
    assert own(plan) == ("/move_group",)
    assert plan.ignored_nodes == ("/move_group_private_*",)
    # Both arms send what it hears.
    assert {"/joint_states", "/clock", "/diagnostics"} <= {*plan.shared_topics}
    heard = [it for it in ends_of(plan, "/move_group") if it.role == "subscribes"]
    assert "/joint_states" in [it.name for it in heard]
    assert not [it for it in plan.nodes if it.robot and "move_group" in it.name]
    run = "move_group move_group --ros-args --params-file cell/moveit_parameters.yaml"
    assert files["commands.md"].decode().count("move_group move_group") == 1
    assert run in files["commands.md"].decode()
    given = "parameters=[file('cell/moveit_parameters.yaml'), CLOCK]"
    started = files["fleet.launch.py"].decode().partition("executable='move_group'")[2]
    assert given in started.partition("output=")[0]


@pytest.mark.more
def test_arms_that_their_descriptions_fix_to_the_world_share_its_link(tmp_path: Path) -> None:
    fixed = URDF.replace("PAINT", "1 0 0 1").replace(
        "</robot>",
        '<link name="world"/><joint name="foot" type="fixed"><origin xyz="PLACE"/>'
        '<parent link="world"/><child link="base"/></joint></robot>',
    )
    texts = {
        "arm_urdf": fixed.replace("PLACE", "1 0 0"),
        "other_urdf": fixed.replace("PLACE", "2 0 0"),
    }
    own = fleet("layout:", "shared_frames: [world]\nlayout:").replace(
        "pose: {y: 0.5, yaw: 1.5}", ""
    )
    own = own.replace(", }", "}").replace(", pose: {y: -0.5}", "")
    root = etree.fromstring(built(tmp_path, fleet_yaml=own, **texts)[0]["cell/cell.urdf"])
    assert [it.get("name") for it in root.iter("link")].count("world") == 1
    held = [
        it.get("name") for it in root.findall("joint") if it.find("parent").get("link") == "world"
    ]
    assert held == ["left_foot", "right_foot"]
    moved = own.replace("other.urdf", "other.urdf, pose: {x: 3}")
    assert "its description fixes it to 'world'" in refused(tmp_path, fleet_yaml=moved, **texts)


def test_values_that_disagree_are_said_and_the_first_counts(tmp_path: Path) -> None:
    own = fleet("pose: {y: -0.5}", "pose: {y: -0.5}, related_files: {moveit: [other.yaml]}")
    text = "default_velocity_scaling_factor: {}\njoint_limits: {{elbow: {{max_velocity: 1.0}}}}\n"
    files, findings = built(
        tmp_path, fleet_yaml=own, limits_yaml=text.format(0.5), other_yaml=text.format(0.1)
    )
    (said,) = (it for it in findings if it.code == "MF836")
    assert said.line == 11
    assert "default_velocity_scaling_factor is 0.1, before it 0.5" in said.message
    assert parameters(files)["robot_description_planning"]["default_velocity_scaling_factor"] == 0.5


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("frames-per-robot", "both", "layout both has a tf for each arm"),
        ("frames-per-robot", "tf-per-robot", "the joints of all arms have the same names"),
        ("frames-per-robot", "frame-prefix", "the joints of all arms have the same names"),
        ("srdf: arm.srdf\n", "", "robot 'left' has no srdf"),
        (", pose: {y: -0.5}", "", "robot 'right' has no pose"),
        ("[left_arm, right_arm]", "[left_arm, rigth_arm]", "did you mean 'right_arm'"),
        ("both: [", "left_arm: [", "is a group of one arm"),
        ("{groups:", "{name: left, groups:", "a robot is called 'left', too"),
        ("layout:", "groups: keep\nlayout:", "; set groups: rename"),
        (
            "cell: {groups: {both: [left_arm, right_arm]}}",
            "cell: {}\ngroups: keep",
            "robot 'right': group 'arm' is in ",
        ),
    ],
)
def test_what_cannot_be_joined_is_one_line(old: str, new: str, said: str, tmp_path: Path) -> None:
    line = refused(tmp_path, fleet_yaml=fleet(old, new))
    assert said in line
    assert ";" in line
    assert "\n" not in line


@pytest.mark.more
def test_an_arm_that_moves_or_has_no_single_root_is_refused(tmp_path: Path) -> None:
    floating = SRDF.replace('type="fixed"', 'type="floating"')
    assert "robot 'left': its virtual joint 'left_place' is floating" in refused(
        tmp_path, arm_srdf=floating
    )
    apart = FILES["arm.urdf"].replace("</robot>", '<link name="loose"/></robot>')
    assert "robot 'left': 2 of its links have no parent" in refused(tmp_path, arm_urdf=apart)


def test_a_manager_for_one_controller_manager_is_refused(tmp_path: Path) -> None:
    text = "moveit_controller_manager: moveit_ros_control_interface/Ros2ControlManager\n"
    line = refused(tmp_path, controllers_yaml=text)
    assert "Ros2ControlManager, which asks one controller manager" in line


@pytest.mark.more
def test_moveit_does_not_fit_layout_frame_prefix(tmp_path: Path) -> None:
    """It looks up its root link in tf by the name in the URDF (planning_scene_monitor.cpp)."""
    own = fleet("frames-per-robot", "frame-prefix").partition("\n")[2]
    _, findings = built(tmp_path, fleet_yaml=own)
    (said,) = (it for it in findings if it.code == "MF837")
    assert said.level == "error"
    assert "'left/base'" in said.message
    # Without its SRDF the robot runs no MoveIt.
    quiet = own.replace("node_sets: moveit", "node_sets: robot_state").splitlines(keepends=True)
    text = "".join(it for it in quiet if not it.startswith(("related_files", "srdf")))
    assert [it for it in built(tmp_path, fleet_yaml=text)[1] if it.code == "MF837"] == []
