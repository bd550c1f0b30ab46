# SPDX-License-Identifier: Apache-2.0
"""What an SRDF says: groups as MoveIt makes them, and the nodes and gaps that follow."""

from __future__ import annotations

from pathlib import Path

import pytest
from fleet_folder import planned_fleet
from lxml import etree

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.checks.build import make_outputs
from multibot_rewrite.checks.closed_plan import left_open
from multibot_rewrite.checks.robot_system import of_sources, with_controllers
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.outputs.output_file import OutputFile
from multibot_rewrite.fleet.robots.robot_nodes import node_sources
from multibot_rewrite.knowledge.parameters import load_known_nodes
from multibot_rewrite.producers.evidence.semantics import semantics
from multibot_rewrite.system.ownership import ALONE
from multibot_rewrite.system.records import System


def joint(name: str, parent: str, child: str, more: str = "", type_: str = "continuous") -> str:
    ends = f'<parent link="{parent}"/><child link="{child}"/>'
    return f'<joint name="{name}" type="{type_}">{ends}{more}</joint>'


URDF = f"""\
<robot name="arm">
  <link name="base_link"/><link name="upper"/><link name="lower"/><link name="tool"/>
  <link name="finger"/>
  {joint("shoulder", "base_link", "upper")}
  {joint("elbow", "upper", "lower")}
  {joint("flange", "lower", "tool", type_="fixed")}
  {joint("grip", "tool", "finger", '<mimic joint="elbow"/>')}
</robot>
"""
SRDF = """\
<robot name="arm">
  <virtual_joint name="v" type="TYPE" parent_frame="odom" child_link="base_link"/>
  <group name="arm"><chain base_link="base_link" tip_link="tool"/></group>
  <group name="hand"><link name="finger"/></group>
  <group name="all"><group name="arm"/><joint name="v"/></group>
  <passive_joint name="PASSIVE"/>
</robot>
"""
MOVEIT = """\
moveit_simple_controller_manager:
  controller_names: [a]
  a: {type: FollowJointTrajectory, action_ns: x, joints: [JOINTS]}
"""


def planned(
    folder: Path, joints: str, passive: str = "none", type_: str = "fixed", more: str = ""
) -> tuple[FleetPlan, list[Finding]]:
    (folder / "arm.urdf").write_text(URDF)
    (folder / "arm.srdf").write_text(SRDF.replace("PASSIVE", passive).replace("TYPE", type_))
    (folder / "m.yaml").write_text(MOVEIT.replace("JOINTS", joints))
    (folder / "fleet.yaml").write_text(
        f"layout: frames-per-robot\ndescription: arm.urdf\nsrdf: arm.srdf\n{more}"
        "related_files: {moveit: [m.yaml]}\nrobots: [{name: robot1}, {name: robot2}]\n"
    )
    plan = planned_fleet(folder / "fleet.yaml")
    found = make_outputs(plan).findings
    return plan, [it for it in found if it.code in ("MB229", "MG413")]


def test_groups_have_the_joints_that_a_plan_moves() -> None:
    srdf = etree.fromstring(SRDF.replace("PASSIVE", "shoulder"))
    found = semantics(srdf, etree.fromstring(URDF), "arm.srdf")
    assert [(it.name, it.joints, it.place.line) for it in found.groups] == [
        ("arm", ("elbow",), 3),
        ("hand", (), 4),
        ("all", ("elbow",), 5),
    ]
    (virtual,) = found.virtual
    assert (virtual.parent, virtual.child, virtual.place.line) == ("odom", "base_link", 2)


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("joints", "passive", "found"),
    [
        ("shoulder, elbow", "none", []),
        ("shoulder", "elbow", []),
        (
            "shoulder",
            "none",
            [("note", 3, "joint elbow,"), ("note", 5, "joint elbow,")],
        ),
        ("wrist", "none", [("note", 3, "shoulder and 1 more"), ("note", 5, "shoulder and 1 more")]),
    ],
)
def test_joints_that_no_controller_moves(
    joints: str, passive: str, found: list[tuple[str, int, str]], tmp_path: Path
) -> None:
    _, made = planned(tmp_path, joints, passive)
    assert [(it.level, it.line) for it in made] == [it[:2] for it in found]
    assert all(text in it.message for (*_, text), it in zip(found, made, strict=True))


def test_a_virtual_joint_that_moves_needs_a_sender(tmp_path: Path) -> None:
    _, made = planned(tmp_path, "shoulder, elbow", type_="planar")
    assert [(it.code, it.line) for it in made] == [("MG413", 2)]
    assert "odom -> base_link" in made[0].message
    # It is there, as the root.
    assert "did you mean" not in made[0].hint


@pytest.mark.more
def test_an_srdf_is_read_by_a_move_group_that_may_run(tmp_path: Path) -> None:
    plan, _ = planned(tmp_path, "shoulder, elbow")
    (found,) = (it for it in plan.fleet.facts if it.name == "move_group")
    assert found.when == "its SRDF is arm.srdf"
    assert (found.origin.place.line, found.origin.node_set) == (1, "")
    more, _ = planned(tmp_path, "shoulder, elbow", more="node_sets: moveit\n")
    (found,) = (it for it in more.fleet.facts if it.name == "move_group")
    assert found.origin.node_set == "moveit"


def test_a_joint_that_the_rewrite_takes_from_its_controller_is_an_error(tmp_path: Path) -> None:
    plan, _ = planned(tmp_path, "shoulder, elbow")
    robot = plan.robots[0]
    evidence = plan.evidence[node_sources(robot.spec)]
    before = of_sources(robot, evidence, plan.jobs[robot.spec.sources].srdf)
    # As if MoveIt's file had stayed as it is.
    same = OutputFile("robot1/m.yaml", (tmp_path / "m.yaml").read_bytes())
    known = load_known_nodes("", plan.file.distro)
    after = with_controllers(System(), robot, evidence, [same], known)
    found = [it for it in left_open(robot, before, after, ALONE) if it.code == "MB229"]
    assert [(it.level, it.line) for it in found] == [("error", 3), ("error", 5)]
    assert "shoulder_robot1" in found[0].message
