# SPDX-License-Identifier: Apache-2.0
"""What is open in a robot, asked of each step alone. What needs and gives what is said here by hand."""

from __future__ import annotations

from given_parameters import run_given
from lxml import etree
from paths import fixture_text

from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.knowledge.records import Claim
from multibot_rewrite.knowledge.stacks import load_nodes
from multibot_rewrite.producers.evidence.hardware import control_system, exported
from multibot_rewrite.rules.system.states import Missing, missing
from multibot_rewrite.spelling.records import Given, Run
from multibot_rewrite.system.records import Place

SYSTEM = fixture_text("gaps_system.urdf")


FILE = Place("c.yaml", 3)
DRIVE = load_nodes(NEWEST_LTS)["ekf_filter_node"]._replace(
    claims=(Claim("command", "<joints>/velocity", ""), Claim("state", "<joints>/position", ""))
)
KNOWN = {"drive": DRIVE}


def controller(*joints: str, name: str = "base", manager: str = "controller_manager") -> Run:
    values = {"joints": Given(list(joints), Place("c.yaml", 9))}
    return run_given(name, "drive", "acme/Drive", values, FILE, manager)


def lacking(*given: Run, text: str = SYSTEM) -> list[Missing]:
    exports = exported(etree.fromstring(text), "r.urdf")
    return list(missing(control_system(given, KNOWN, exports).interfaces))


def claimed(found: list[Missing]) -> list[tuple[str, str]]:
    return [(it.kind, it.name) for one in found for it in one.claims]


def test_a_controller_whose_joints_the_hardware_has() -> None:
    assert lacking(controller("wheel")) == []


def test_the_kind_of_an_interface_counts() -> None:
    text = SYSTEM.replace("command_interface", "state_interface")
    assert claimed(lacking(controller("wheel"), text=text)) == [("command", "wheel/velocity")]


def test_interfaces_of_another_controller_are_there() -> None:
    pid = controller("wheel", name="ns/pid")
    assert lacking(pid, controller("pid/wheel")) == []
    assert len(claimed(lacking(pid, controller("pi/wheel")))) == 2
