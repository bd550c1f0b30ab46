# SPDX-License-Identifier: Apache-2.0
"""Controllers that claim what another one claims, and names that only a prefix reaches."""

from __future__ import annotations

from pathlib import Path

import pytest
from open_findings import found
from paths import fixture_text

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.knowledge.node_sets import load_nodes
from multibot_rewrite.knowledge.parameters import built_in_nodes
from multibot_rewrite.planning.records import Run
from multibot_rewrite.producers.evidence.hardware import Exported, control_system
from multibot_rewrite.producers.evidence.parameter_files import given_nodes
from multibot_rewrite.related_files.yaml_text import read_yaml
from multibot_rewrite.rules.system.states import claims_any, interface_commanded_twice
from multibot_rewrite.system.index import index
from multibot_rewrite.system.ownership import ALONE
from multibot_rewrite.system.records import Place

FORWARD = "forward_command_controller/ForwardCommandController"
CONTROLLERS = f"""\
controller_manager:
  ros__parameters:
    one: {{type: {FORWARD}}}
    two: {{type: {FORWARD}}}
one:
  ros__parameters: {{joints: [a, b], interface_name: position}}
two:
  ros__parameters: {{joints: [b, a], interface_name: WORD}}
"""
KNOWN = load_nodes("jazzy")


def given(text: str) -> list[Run]:
    return given_nodes([read_yaml(text.encode(), "c.yaml")], built_in_nodes("jazzy"))


def commanded(text: str, active: set[str]) -> list[Finding]:
    system = control_system(given(text), KNOWN, (), active)
    assert interface_commanded_twice.check
    return list(interface_commanded_twice.check(index(system, ALONE)))


@pytest.mark.parametrize(
    ("word", "active", "names"),
    [
        ("position", {"one", "two"}, ["a/position", "b/position"]),
        ("velocity", {"one", "two"}, []),
        ("position", {"one"}, []),
        ("position", set(), []),
    ],
)
def test_an_interface_has_one_owner(word: str, active: set[str], names: list[str]) -> None:
    found = commanded(CONTROLLERS.replace("WORD", word), active)
    assert {it.names[0] for it in found} <= set(names)
    assert bool(found) is bool(names)
    for it in found:
        assert "one of /controller_manager" in it.message
        assert "two of /controller_manager" in it.message
        assert (it.file, it.line) == ("c.yaml", 8)
        assert "see c.yaml:6" in it.hint


def test_controllers_of_another_robot() -> None:
    text = CONTROLLERS.replace("WORD", "position")
    place = Place("r.urdf", 1)

    def claims(kind: str, name: str) -> bool:
        system = control_system(given(text), KNOWN, [Exported(kind, name, place)])
        return claims_any(system.interfaces)

    assert claims("command", "a/position")
    assert not claims("command", "c/position")
    assert not claims("state", "a/position")


UR = fixture_text("two_words_ur.urdf")
BROADCASTER = """\
controller_manager:
  ros__parameters:
    force: {type: force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster}
force:
  ros__parameters: {interface_names: {force: {x: tcp_fts_sensor/force.x}}, frame_id: tool0}
"""
FLEET = """\
distro: jazzy
description: ur.urdf
related_files: {params: controllers.yaml}
affix: AFFIX
robots: [{name: robot1}, {name: robot2}]
"""


@pytest.mark.parametrize(("affix", "codes"), [("postfix", {"MB229", "MB421"}), ("prefix", set())])
def test_names_that_only_a_prefix_reaches(affix: str, codes: set[str], tmp_path: Path) -> None:
    files = {"ur.urdf": UR, "controllers.yaml": BROADCASTER}
    built, _ = found(tmp_path, {**files, "fleet.yaml": FLEET.replace("AFFIX", affix)}, "postfix")
    errors = [it for it in built if it.level == "error"]
    assert {it.code for it in errors} == codes
    assert all(it.hint.endswith("set affix: prefix") for it in errors)


def test_another_hint_for_what_was_open_before(tmp_path: Path) -> None:
    """The description has no such interface, whatever the robot is called."""
    broken = BROADCASTER.replace("force.x}", "force.w}")
    files = {"ur.urdf": UR, "controllers.yaml": broken}
    built, _ = found(tmp_path, {**files, "fleet.yaml": FLEET.replace("AFFIX", "postfix")})
    hints = [it.hint for it in built if (it.code, it.level) == ("MB229", "warning")]
    assert hints
    assert not [it for it in hints if "affix: prefix" in it]
