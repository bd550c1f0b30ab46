"""Is a robot simulated? The fleet file says so, or its launch files do.

What a description has for a simulator does nothing on a real robot: plugins start no node, sensors and
drives need no bridge.
"""

from __future__ import annotations

from lxml import etree

from multibot_rewrite.base.findings.finding import NOTE, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.fleet.file.fleet_file import REAL
from multibot_rewrite.fleet.robots.member import Member
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot, at_robot
from multibot_rewrite.fleet.robots.robot_nodes import RobotEvidence

_AMCL = "structure:\n  nodes:\n    /amcl: {pkg: nav2_amcl, exec: amcl, node_name: amcl}\n"
_DRIVE = """\
<robot name="rover">
  <link name="base_link"/>
  <gazebo>
    <plugin name="drive" filename="libgazebo_ros_diff_drive.so"/>
  </gazebo>
</robot>
"""
_FLEET = """\
launch: system_model.yaml
robots:
  - {name: robot1, description: robot.urdf}
  - {name: robot2, description: robot.urdf}
"""
SIMULATED_OR_REAL = declare(
    "MF828",
    "simulated-or-real",
    NOTE,
    what="A description has plugins or sensors for a simulator, and the robot's launch files start "
    "neither a simulator nor a bridge to one.",
    why="They may be real robots, or the simulator is started elsewhere. So nodes of these plugins may "
    "be missing, and no topic has to be bridged: `check` does not find that a bridge is missing.",
    fix="Write `simulator: none` for real robots, `simulator: gazebo` for simulated ones.",
    bad=_FLEET,
    good=f"simulator: gazebo\n{_FLEET}",
    line=3,
    formats=("fleet",),
    beside={"system_model.yaml": _AMCL, "robot.urdf": _DRIVE},
)


def may_be_real(robot: RewrittenRobot, evidence: RobotEvidence) -> bool:
    """Has its description something for a simulator, and does nothing say that it runs in one?"""
    return evidence.unsimulated and not _said(robot) and _for_simulator(robot.member)


def is_chosen(robot: RewrittenRobot) -> bool:
    """Does its fleet file say that it runs in a simulator?"""
    return bool(_said(robot)) and robot.spec.simulator != REAL


def _said(robot: RewrittenRobot) -> object:
    return robot.spec.simulator or robot.spec.companions.get("bridge")


def note(robot: RewrittenRobot) -> Finding:
    """That nothing says it."""
    message = (
        "no launch file starts a simulator, and the description has plugins or sensors for one"
    )
    hint = "write simulator: none for real robots, simulator: gazebo for simulated ones"
    return at_robot(SIMULATED_OR_REAL, robot, message, hint)


def _for_simulator(member: Member) -> bool:
    root: etree._Element = member.inventory.document.root
    parts = [root] if root.tag == "sdf" else root.findall("gazebo")
    return any(it.find(f".//{tag}") is not None for it in parts for tag in ("plugin", "sensor"))
