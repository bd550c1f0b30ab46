"""What is open in a robot, asked of each step alone. What needs and gives what is said here by hand."""

from __future__ import annotations

from lxml import etree

from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.companions.yaml_text import read_yaml
from multibot_rewrite.knowledge.records import Claim
from multibot_rewrite.knowledge.stacks import load_nodes
from multibot_rewrite.producers.evidence.hardware import exported
from multibot_rewrite.producers.evidence.records import Given, GivenNode
from multibot_rewrite.producers.interfaces import control_system
from multibot_rewrite.rules.closure.moveit import moveit_gaps
from multibot_rewrite.rules.system.interfaces import Missing, missing
from multibot_rewrite.system.records import Place

SYSTEM = """<robot name="r">
  <ros2_control name="a" type="system">
    <joint name="wheel">
      <command_interface name="velocity"/>
      <state_interface name="position"/>
    </joint>
    <sensor name="imu"><state_interface name="orientation.x"/></sensor>
    <gpio name="io"><command_interface name="led"/></gpio>
    <other name="no"><command_interface name="led"/></other>
  </ros2_control>
</robot>"""


def test_what_a_system_exports_by_kind_and_line() -> None:
    found = [tuple(it) for it in exported(etree.fromstring(SYSTEM), "r.urdf")]
    assert found == [
        ("command", "wheel/velocity", Place("r.urdf", 4)),
        ("state", "wheel/position", Place("r.urdf", 5)),
        ("state", "imu/orientation.x", Place("r.urdf", 7)),
        ("command", "io/led", Place("r.urdf", 8)),
    ]


FILE = Place("c.yaml", 3)
DRIVE = load_nodes(NEWEST_LTS)["ekf_filter_node"]._replace(
    claims=(Claim("command", "<joints>/velocity", ""), Claim("state", "<joints>/position", ""))
)
KNOWN = {"drive": DRIVE}


def controller(*joints: str, name: str = "base", manager: str = "controller_manager") -> GivenNode:
    values = {"joints": Given(list(joints), Place("c.yaml", 9))}
    return GivenNode(name, "drive", "acme/Drive", values, FILE, manager)


def lacking(*given: GivenNode, text: str = SYSTEM) -> list[Missing]:
    exports = exported(etree.fromstring(text), "r.urdf")
    return list(missing(control_system(given, KNOWN, exports).interfaces))


def claimed(found: list[Missing]) -> list[tuple[str, str]]:
    return [(it.kind, it.name) for one in found for it in one.claims]


def test_a_controller_whose_joints_the_hardware_has() -> None:
    assert lacking(controller("wheel")) == []


def test_an_interface_that_the_hardware_lacks_and_the_one_that_is_meant() -> None:
    (found,) = lacking(controller("whel"))
    assert claimed([found]) == [("command", "whel/velocity"), ("state", "whel/position")]
    assert {(it.node, it.place) for it in found.claims} == {("/base", Place("c.yaml", 9))}
    assert found.near
    assert (found.meant, found.near.place) == ("wheel/velocity", Place("r.urdf", 4))


def test_the_kind_of_an_interface_counts() -> None:
    text = SYSTEM.replace("command_interface", "state_interface")
    assert claimed(lacking(controller("wheel"), text=text)) == [("command", "wheel/velocity")]


def test_interfaces_of_another_controller_are_there() -> None:
    pid = controller("wheel", name="ns/pid")
    assert lacking(pid, controller("pid/wheel")) == []
    assert len(claimed(lacking(pid, controller("pi/wheel")))) == 2


def test_without_hardware_or_without_a_manager_nothing_is_said() -> None:
    assert lacking(controller("whel"), text='<robot name="r"/>') == []
    assert lacking(controller("whel", manager="")) == []


MOVEIT = """\
move_group:
  ros__parameters:
    moveit_simple_controller_manager:
      controller_names: [arm, hand, absent]
      arm:
        joints: [wheel, elbo]
      hand: {type: GripperCommand}
      unnamed: {joints: [x]}
"""


def test_what_moveit_sends_to_and_nobody_declares() -> None:
    values = {"joints": Given(["wheel", "elbow"], Place("c.yaml", 9))}
    given = [controller(name="ns/arm")._replace(values=values), controller(name="hands")]
    joint, missing = moveit_gaps([read_yaml(MOVEIT.encode(), "moveit.yaml")], given)
    assert (joint.kind, joint.name, joint.node) == ("joint", "joint elbo of arm", "MoveIt")
    assert (joint.place, joint.near, joint.near_place) == (
        Place("moveit.yaml", 6),
        "elbow",
        Place("c.yaml", 9),
    )
    assert (missing.kind, missing.name) == ("controller", "controller hand")
    assert (missing.place, missing.near, missing.near_place) == (
        Place("moveit.yaml", 7),
        "hands",
        FILE,
    )


def test_without_declared_controllers_nothing_is_said_of_moveit() -> None:
    document = read_yaml(MOVEIT.encode(), "moveit.yaml")
    assert list(moveit_gaps([document], [controller(name="arm", manager="")])) == []
