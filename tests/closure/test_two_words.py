"""Controllers that claim what another one claims, and names that only a prefix reaches."""

from __future__ import annotations

from pathlib import Path

import pytest
from closure_findings import found

from multibot_rewrite.closure.interfaces import claims_any, contested_gaps
from multibot_rewrite.companions.yaml_text import read_yaml
from multibot_rewrite.evidence.hardware import Exported
from multibot_rewrite.evidence.parameter_files import given_nodes
from multibot_rewrite.evidence.records import GivenNode
from multibot_rewrite.knowledge.parameters import built_in_nodes
from multibot_rewrite.knowledge.stacks import load_nodes
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


def given(text: str) -> list[GivenNode]:
    return given_nodes([read_yaml(text.encode(), "c.yaml")], built_in_nodes("jazzy"))


@pytest.mark.parametrize(
    ("word", "active", "names"),
    [
        ("position", {"one", "two"}, ["b/position"]),
        ("velocity", {"one", "two"}, []),
        ("position", {"one"}, []),
        ("position", set(), []),
    ],
)
def test_an_interface_has_one_owner(word: str, active: set[str], names: list[str]) -> None:
    gaps = list(contested_gaps(given(CONTROLLERS.replace("WORD", word)), KNOWN, active))
    assert [it.name for it in gaps] == names
    for it in gaps:
        assert (it.node, it.near) == ("two", "one")
        assert (it.place, it.near_place) == (Place("c.yaml", 8), Place("c.yaml", 6))


def test_a_state_is_read_by_many() -> None:
    type_ = "joint_trajectory_controller/JointTrajectoryController"
    text = CONTROLLERS.replace(FORWARD, type_).replace("WORD", "x")
    for word in ("position", "velocity"):
        own = f"command_interfaces: [{word}], state_interfaces: [position]"
        text = text.replace("interface_name: " + ("position" if word == "position" else "x"), own)
    assert list(contested_gaps(given(text), KNOWN, {"one", "two"})) == []


def test_two_managers_do_not_share_interfaces() -> None:
    text = CONTROLLERS.replace("WORD", "position")
    left, right = (text.replace("one", f"{it}/one").replace("two", f"{it}/two") for it in "lr")
    apart = [
        *(
            it._replace(manager="l/controller_manager")
            for it in given(left)
            if it.name[-3:] == "one"
        ),
        *(
            it._replace(manager="r/controller_manager")
            for it in given(right)
            if it.name[-3:] == "two"
        ),
    ]
    assert list(contested_gaps(apart, KNOWN, {"l/one", "r/two"})) == []


def test_controllers_of_another_robot() -> None:
    text = CONTROLLERS.replace("WORD", "position")
    place = Place("r.urdf", 1)
    assert claims_any(given(text), KNOWN, [Exported("command", "a/position", place)])
    assert not claims_any(given(text), KNOWN, [Exported("command", "c/position", place)])
    assert not claims_any(given(text), KNOWN, [Exported("state", "a/position", place)])


UR = """\
<robot name="ur">
  <link name="base_link"/><link name="tool0"/>
  <joint name="elbow" type="revolute"><parent link="base_link"/><child link="tool0"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <ros2_control name="ur" type="system">
    <hardware>
      <plugin>ur_robot_driver/URPositionHardwareInterface</plugin>
      <param name="tf_prefix"></param>
    </hardware>
    <sensor name="tcp_fts_sensor"><state_interface name="force.x"/></sensor>
  </ros2_control>
</robot>
"""
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
companions: {params: controllers.yaml}
affix: AFFIX
robots: [{name: robot1}, {name: robot2}]
"""


@pytest.mark.parametrize(("affix", "codes"), [("postfix", {"MF811", "MF601"}), ("prefix", set())])
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
    hints = [it.hint for it in built if (it.code, it.level) == ("MF811", "warning")]
    assert hints
    assert not [it for it in hints if "affix: prefix" in it]
