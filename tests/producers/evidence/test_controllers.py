# SPDX-License-Identifier: Apache-2.0
"""Controllers of arms whose code puts a prefix before names, in a fleet of two.

Expected from the sources: ur_controllers (tf_prefix + name), franka_ros2 (arm_prefix + "_" + name),
controller_manager.cpp (a claimed interface has to be exported, and one active controller has it).
"""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml
from fleet_folder import built_fleet, planned_fleet
from given_parameters import given_in
from lxml import etree
from named_ends import named_ends
from paths import fixture_text

from multibot_rewrite.base.model import InputError
from multibot_rewrite.checks.build import Outputs
from multibot_rewrite.knowledge.node_sets import load_node_set, load_nodes
from multibot_rewrite.planning.records import Table
from multibot_rewrite.planning.transforms import sent_by
from multibot_rewrite.planning.ways import deliveries, started
from multibot_rewrite.producers.evidence.hardware import exported
from multibot_rewrite.producers.evidence.nodes import nodes_of
from multibot_rewrite.system.records import HOST

LAYOUTS = ("tf-per-robot", "frames-per-robot", "both", "postfix")
ARM = fixture_text("controllers_arm.urdf")
FRANKA = ARM.format(
    plugin="franka_hardware/FrankaHardwareInterface",
    param='<param name="prefix"></param><param name="robot_type">fr3</param>',
)
MOCK = ARM.format(plugin="mock_components/GenericSystem", param="")
CONTROLLERS = """\
controller_manager:
  ros__parameters:
    scaling: {type: ur_controllers/SpeedScalingStateBroadcaster}
    gravity: {type: ur_controllers/GravityUpdateController}
    one: {type: forward_command_controller/ForwardCommandController}
    other: {type: forward_command_controller/ForwardCommandController}
scaling:
  ros__parameters:
    tf_prefix: ""
one:
  ros__parameters: {joints: [fr3_joint1], interface_name: position}
other:
  ros__parameters: {joints: [fr3_joint1], interface_name: velocity}
"""
STATE = """\
controller_manager:
  ros__parameters:
    state: {type: franka_robot_state_broadcaster/FrankaRobotStateBroadcaster}
"""


def made(folder: Path, arm: str, controllers: str, layout: str, more: str = "") -> Outputs:
    (folder / "arm.urdf").write_text(arm)
    (folder / "controllers.yaml").write_text(controllers)
    fleet = folder / "fleet.yaml"
    fleet.write_text(
        f"layout: {layout}\naffix: prefix\ndistro: jazzy\n{more}description: arm.urdf\n"
        "robots: [{name: left}, {name: right}]\nrelated_files: {params: [controllers.yaml]}\n"
    )
    return built_fleet(fleet)


def found(outputs: Outputs, *codes: str) -> list[tuple[str, str]]:
    return [(it.code, it.message) for it in outputs.findings if it.code in codes]


def parameters(outputs: Outputs, robot: str) -> dict[str, dict[str, object]]:
    """Return the parameters of each controller, by the names without the robot."""
    path = f"{robot}/controllers.yaml"
    (text,) = (it.data.decode() for it in outputs.files if it.path == path)
    words = yaml.safe_load(text)
    return {
        key.rpartition("/")[2].removeprefix(f"{robot}_"): it["ros__parameters"]
        for key, it in words.items()
    }


@pytest.mark.sample(1)
@pytest.mark.parametrize("layout", LAYOUTS)
def test_prefixes_follow_the_description(layout: str, tmp_path: Path) -> None:
    outputs = made(tmp_path, MOCK, CONTROLLERS, layout)
    assert found(outputs, "MB882", "MB229") == []
    bare = layout == "tf-per-robot"
    sections = parameters(outputs, "right")
    assert sections["scaling"]["tf_prefix"] == ("" if bare else "right_")
    # A controller without a section has an empty prefix, too.
    assert sections.get("gravity") == (None if bare else {"tf_prefix": "right_"})


@pytest.mark.sample(1)
@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_prefix_that_its_code_ends(layout: str, tmp_path: Path) -> None:
    outputs = made(tmp_path, FRANKA, STATE, layout)
    assert found(outputs, "MB229") == []
    section = parameters(outputs, "left").get("state")
    assert section == (None if layout == "tf-per-robot" else {"arm_prefix": "left"})


def test_a_prefix_that_cannot_be_said_is_an_error(tmp_path: Path) -> None:
    """The code of Franka's controllers puts _ behind the prefix, whatever the separator is."""
    outputs = made(tmp_path, FRANKA, STATE, "both", 'separators: {joint: "-", sensor: "-"}\n')
    (problem,) = (it for it in outputs.findings if it.code == "MB229")
    assert problem.level == "error"
    assert "fr3/robot_state" in problem.message


def test_an_interface_that_the_name_of_another_robot_has_is_not_there(tmp_path: Path) -> None:
    wrong = CONTROLLERS.replace('tf_prefix: ""', "tf_prefix: arm_")
    outputs = made(tmp_path, MOCK, wrong, "both")
    ((_, message),) = found(outputs, "MB229")
    assert "scaling of left claims state interface arm_speed_scaling/" in message


def test_code_of_hardware_exports_what_no_description_names() -> None:
    """franka_hardware_interface.cpp export_state_interfaces: prefix, type of robot, interface."""
    text = FRANKA.replace('"prefix"></param>', '"prefix">l_</param>')
    names = {it.name for it in exported(etree.fromstring(text), "arm.urdf") if it.kind == "state"}
    assert names >= {"l_fr3/robot_state", "l_fr3/robot_time", "l_15/cartesian_pose_state"}
    mock = {it.name for it in exported(etree.fromstring(MOCK), "arm.urdf")}
    assert not any("robot_state" in it for it in mock)


def planned(text: str) -> dict[str, str]:
    given = given_in(text, file="c.yaml")
    nodes = nodes_of(load_node_set("ros2_control", "jazzy"), given, load_nodes("jazzy")).nodes
    return {it.name: it.when for it in nodes}


def test_of_controllers_of_one_joint_none_has_to_be_there() -> None:
    when = planned(CONTROLLERS)
    assert when["one"] == "other does not command the same joints"
    assert when["other"] == "one does not command the same joints"
    assert (when["scaling"], when["gravity"]) == ("", "")
    alone = planned(
        CONTROLLERS.replace("joints: [fr3_joint1], interface_name: velocity", "joints: [b]")
    )
    assert alone["one"] == ""


def test_controllers_of_two_managers_are_no_alternatives() -> None:
    text = "".join(
        f"{it}/controller_manager:\n  ros__parameters:\n"
        "    arm: {type: joint_trajectory_controller/JointTrajectoryController}\n"
        f"{it}/arm:\n  ros__parameters: {{joints: [a], command_interfaces: [position]}}\n"
        for it in ("l", "r")
    )
    when = planned(text)
    assert (when["l/arm"], when["r/arm"]) == ("", "")


def test_what_an_unknown_controller_seems_to_claim_is_said() -> None:
    text = """\
controller_manager:
  ros__parameters:
    own: {type: acme/Own}
    arm: {type: joint_trajectory_controller/JointTrajectoryController}
own:
  ros__parameters: {joints: [a, b, c, d], interface_name: effort}
arm:
  ros__parameters: {joints: [a], command_interfaces: [position]}
"""
    given = given_in(text, file="c.yaml")
    nodes = nodes_of((), given, load_nodes("jazzy"))
    (unknown,) = nodes.findings
    assert unknown.code == "MF802"
    assert "seems to claim a/effort, b/effort, c/effort and 1 more" in unknown.hint
    assert {it.name: bool(it.when) for it in nodes.nodes if it.host} == {"own": True, "arm": True}


@pytest.mark.parametrize(
    ("release", "type_"),
    [
        ("humble", "battery_state_broadcaster/BatteryStateBroadcaster"),
        ("humble", "ur_controllers/GravityUpdateController"),
        ("kilted", "position_controllers/GripperActionController"),
        ("lyrical", "ur_controllers/ScaledJointTrajectoryController"),
    ],
)
def test_a_type_that_a_release_lacks(release: str, type_: str) -> None:
    """From the plugin files of the branches of ros2_controllers and ur_controllers."""
    text = f"controller_manager:\n  ros__parameters:\n    one: {{type: {type_}}}\n"
    given = given_in(text, release, "c.yaml")
    (lacking,) = nodes_of((), given, load_nodes(release)).findings
    assert (lacking.code, lacking.line) == ("MF802", 3)
    assert "which this release lacks" in lacking.message
    given = given_in(text, file="c.yaml")
    assert nodes_of((), given, load_nodes("jazzy")).findings == ()


def frames_of(release: str, text: str) -> list[tuple[str, str, str]]:
    """Who sends which transform, as parent and child."""
    given = given_in(text, release, "c.yaml")
    nodes = nodes_of((), given, load_nodes(release)).nodes
    return [(node.name, edge.parent, edge.child) for node in nodes for edge in sent_by(node, "")]


@pytest.mark.parametrize(
    ("more", "sent"),
    [
        ("tf: {child_frame_id: tool}", [("pose", "base", "tool")]),
        ("tf: {enable: false, child_frame_id: tool}", []),
        # An empty child is the name of the pose, whatever the frames of the robot are.
        ("tf: {child_frame_id: ''}", [("pose", "base", "tcp")]),
    ],
)
def test_the_pose_broadcaster_sends_a_transform(
    more: str, sent: list[tuple[str, str, str]]
) -> None:
    """pose_broadcaster.cpp: frame_id -> tf.child_frame_id, unless tf.enable is false."""
    text = f"""\
controller_manager:
  ros__parameters:
    pose: {{type: pose_broadcaster/PoseBroadcaster}}
pose:
  ros__parameters: {{frame_id: base, pose_name: tcp, {more}}}
"""
    assert frames_of("jazzy", text) == sent


XARM = ARM.format(plugin="uf_robot_hardware/UFRobotSystemHardware", param="")
ONE = "controller_manager:\n  ros__parameters:\n    update_rate: 100\n"


def nodes_with(folder: Path, arm: str, layout: str, more: str = "") -> Table:
    (folder / "arm.urdf").write_text(arm)
    (folder / "controllers.yaml").write_text(ONE)
    fleet = folder / "fleet.yaml"
    fleet.write_text(
        f"layout: {layout}\naffix: prefix\ndistro: jazzy\n{more}description: arm.urdf\n"
        "robots: [{name: left}, {name: right}]\n"
    )
    return planned_fleet(fleet).fleet.table


MANAGED = "node_sets: ros2_control\nrelated_files: {params: [controllers.yaml]}\n"


def test_nodes_that_hardware_makes(tmp_path: Path) -> None:
    """franka_hardware_interface.cpp: service_server and action_server, in the manager's process."""
    table = nodes_with(tmp_path, FRANKA, "both", MANAGED)
    names = {it.name for it in named_ends(table) if it.robot == "left"}
    assert {"/left/service_server/set_load", "/left/action_server/error_recovery"} <= names
    mock = nodes_with(tmp_path, MOCK, "both", MANAGED)
    assert "service_server" not in {it.node for it in mock.runs}
    # Without a controller manager nothing loads the hardware.
    alone = nodes_with(tmp_path, FRANKA, "both")
    assert "service_server" not in {it.node for it in alone.runs}


@pytest.mark.parametrize(
    ("layout", "target"), [("both", "controller_manager"), ("postfix", "/left_controller_manager")]
)
def test_hardware_asks_its_own_controller_manager(layout: str, target: str, tmp_path: Path) -> None:
    """uf_robot_system_hardware.cpp:254 names /controller_manager/list_controllers: the process of the
    manager, where the hardware is, gets the rule, and no spawner is started for it."""
    table = nodes_with(tmp_path, XARM, layout, MANAGED)
    (at,) = (
        it
        for it in deliveries(table)
        if (it.node.robot, it.node.node) == ("left", "ufactory_robot_hw") and it.rules
    )
    assert (at.way, at.taker) == (HOST, "controller_manager")
    name = "/controller_manager/list_controllers"
    lead = next(old for old, _ in at.rules if old.endswith(name))
    assert dict(at.rules)[lead] == f"{target}/list_controllers"
    spawned = [it for it in started(table) if it.node.node.startswith("ufactory")]
    assert spawned == []


def test_a_type_below_a_second_ros_parameters() -> None:
    """controller_manager.cpp reads NAME.type; this one is NAME.ros__parameters.type."""
    inside = "    drive:\n      ros__parameters: {type: some/Drive}\n"
    text = f"controller_manager:\n  ros__parameters:\n{inside}"
    said = r"^c\.yaml:4: the type of 'drive' is below a second ros__parameters, .*; write type: "
    with pytest.raises(InputError, match=said):
        given_in(text, file="c.yaml")


@pytest.mark.parametrize("name", ["3drive", "base drive"])
def test_a_controller_whose_name_no_node_can_have(name: str) -> None:
    """rcl validate_node_name: letters, digits and underscores, no digit first."""
    text = f"controller_manager:\n  ros__parameters:\n    {name}: {{type: some/Drive}}\n"
    with pytest.raises(InputError, match=rf"^c\.yaml:3: controller '{name}': "):
        given_in(text, file="c.yaml")
    # A launch file fills in the placeholder.
    made = text.replace(name, '"<robot>_drive"')
    assert given_in(made, file="c.yaml")
