# SPDX-License-Identifier: Apache-2.0
"""What is open in a robot, asked of each step alone. What needs and gives what is said here by hand."""

from __future__ import annotations

from lxml import etree

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.companions.names.rename_map import CompanionNames
from multibot_rewrite.companions.yaml_text import read_yaml
from multibot_rewrite.knowledge.records import Claim
from multibot_rewrite.knowledge.stacks import load_nodes
from multibot_rewrite.producers.evidence.hardware import exported
from multibot_rewrite.producers.interfaces import control_system
from multibot_rewrite.rules.files.controllers import undeclared_controller
from multibot_rewrite.rules.files.given import Beside
from multibot_rewrite.rules.system.interfaces import Missing, missing
from multibot_rewrite.spelling.records import Given, GivenNode
from multibot_rewrite.system.records import Interface, Place

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


def moved(*given: GivenNode) -> list[Finding]:
    """What is wrong with MoveIt's file beside what the parameter files set."""
    names = CompanionNames({}, make_naming("postfix"), "")
    document = read_yaml(MOVEIT.encode(), "moveit.yaml")
    context = Context(names, names, {}, NEWEST_LTS)
    memo: dict[object, object] = {Beside: Beside(given, {})}
    assert undeclared_controller.check
    file = NamedFile("moveit", "moveit.yaml", MOVEIT, context, memo, document=document)
    return list(undeclared_controller.check(file))


def test_what_moveit_sends_to_and_nobody_declares() -> None:
    values = {"joints": Given(["wheel", "elbow"], Place("c.yaml", 9))}
    given = [controller(name="ns/arm")._replace(values=values), controller(name="hands")]
    joint, hand = moved(*given)
    assert (joint.line, joint.column) == (6, 25)
    assert "joint elbo of arm" in joint.message
    assert joint.hint == "did you mean elbow (c.yaml:9)?"
    assert hand.line == 7
    assert "controller hand," in hand.message
    assert hand.hint == f"did you mean hands ({FILE})?"


def test_without_declared_controllers_nothing_is_said_of_moveit() -> None:
    assert moved(controller(name="arm", manager="")) == []


def planned(*exports: str) -> list[Missing]:
    """What a group of two joints lacks where controllers of MoveIt move some."""
    given = [Interface("joint", it, "/arm", "exports", FILE) for it in exports]
    group = [Interface("joint", it, "/move_group", "claims", FILE) for it in ("elbow", "wrist")]
    return list(missing([*given, *group]))


def test_a_group_needs_a_controller_for_each_joint() -> None:
    assert planned("elbow", "wrist") == []
    assert claimed(planned("elbow")) == [("joint", "wrist")]
    (both,) = planned("shoulder")
    assert [it.name for it in both.claims] == ["elbow", "wrist"]


def test_without_a_controller_of_moveit_nothing_is_said_of_groups() -> None:
    assert planned() == []
    wheel = Interface("command", "wheel/velocity", "/controller_manager", "exports")
    group = Interface("joint", "elbow", "/move_group", "claims")
    assert list(missing([wheel, group])) == []
