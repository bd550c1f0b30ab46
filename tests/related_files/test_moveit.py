# SPDX-License-Identifier: Apache-2.0
"""MoveIt's YAML files: what each kind names, what stays, and what a person is told."""

from __future__ import annotations

import pytest
import yaml
from beside import findings_of
from hypothesis import given, strategies as st

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.knowledge.node_library import nodes_of_set
from multibot_rewrite.knowledge.node_sets import built_in
from multibot_rewrite.related_files.context import Context, fill_template, make_context
from multibot_rewrite.related_files.moveit.file_kind import (
    file_kind,
    find_kind,
    kinds,
    parameter_above,
)
from multibot_rewrite.related_files.moveit.rewrite import node_of, rewrite_moveit
from multibot_rewrite.related_files.names.rename_map import with_srdf
from multibot_rewrite.related_files.yaml_text import read_yaml

LINKS = ("base_link", "tool0", "camera_link")
JOINTS = ("j1", "j2", "finger.left", "y", "1")
GROUPS = ("arm", "gripper")
SRDF = {"group": dict.fromkeys(GROUPS), "joint": {"virtual_joint": None}}
LAYOUTS = ("L1", "L2", "L3", "L4")


def context(layout: str = "L2", affix: str = "", srdf: bool = True, **more: str) -> Context:
    declared = {"link": dict.fromkeys(LINKS), "joint": dict.fromkeys(JOINTS)}
    affix = affix or ("postfix" if layout == "L4" else "prefix")
    facts = nodes_of_set(built_in(NEWEST_LTS), "moveit")
    naming = make_naming(layout, affix, **more)
    known = with_srdf(declared, SRDF) if srdf else declared  # type: ignore[arg-type]
    return make_context(known, naming, facts, distro=NEWEST_LTS)  # type: ignore[arg-type]


def run(text: str, it: Context, file: str = "a.yaml") -> tuple[str, tuple[Finding, ...]]:
    made = rewrite_moveit(read_yaml(text.encode(), file), it)
    return fill_template(made.template, "amr", "sp"), findings_of(made)


def text_of(text: str, it: Context) -> str:
    return run(text, it)[0]


def codes(text: str, it: Context) -> list[tuple[str, int]]:
    return [(found.code, found.line) for found in run(text, it)[1]]


KINDS = {
    "kinematics": "arm:\n  kinematics_solver: kdl/KDL\n",
    "joint_limits": "default_velocity_scaling_factor: 0.1\njoint_limits:\n  j1: {max_velocity: 1.0}\n",
    "controllers": "controller_list:\n  - {name: arm_controller, joints: [j1]}\n",
    "planning": "planner_configs: {RRT: {type: g::RRT}}\narm: {planner_configs: [RRT]}\n",
    "initial_positions": "j1: 0.5\nj2: 0\n",
    "sensors": "sensors: [eye]\neye: {sensor_plugin: a/B, image_topic: /eye/image}\n",
    "servo": "move_group_name: arm\njoint_topic: /joint_states\n",
    "moveit_cpp": "planning_scene_monitor_options: {joint_state_topic: /joint_states}\n",
}


def test_every_kind_has_a_case() -> None:
    assert set(KINDS) == {kind.name for kind in kinds()}


@pytest.mark.parametrize("kind", KINDS)
def test_a_kind_is_found_from_the_content(kind: str) -> None:
    assert file_kind(read_yaml(KINDS[kind].encode(), "x.yaml")) == kind


@pytest.mark.parametrize(
    ("text", "file", "kind"),
    [
        ("", "kinematics.yaml", "empty"),
        ("# nothing\n", "x.yaml", "empty"),
        ("gripper:\n", "config/kinematics.yaml", "kinematics"),
        ("arm: {}\n", "my_ompl_planning.yaml", "planning"),
        ("j1: !degrees 90\n", "x.yaml", "initial_positions"),
        ("moveit_simple_controller_manager.controller_names: [a]\n", "x.yaml", "controllers"),
        ("arm.kinematics_solver: a/B\n", "x.yaml", "kinematics"),
        ("cartesian_limits: {max_trans_vel: 1}\n", "x.yaml", "joint_limits"),
        ("planning_plugin: chomp_interface/CHOMPPlanner\n", "x.yaml", "planning"),
    ],
)
def test_a_kind_by_name_or_by_dots(text: str, file: str, kind: str) -> None:
    assert file_kind(read_yaml(text.encode(), file)) == kind


@pytest.mark.parametrize(
    ("file", "text", "above"),
    [
        ("kinematics.yaml", KINDS["kinematics"], "robot_description_kinematics."),
        ("joint_limits.yaml", KINDS["joint_limits"], "robot_description_planning."),
        ("servo.yaml", KINDS["servo"], "moveit_servo."),
        ("a/ompl_planning.yaml", KINDS["planning"], "ompl."),
        ("planners.yaml", KINDS["planning"], ""),
        *(("p.yaml", f"{it}: x\n", "pipeline.") for it in
          ("planning_plugin", "planning_plugins", "request_adapters")),
        ("chomp_planning.yaml", "chomp: {planning_plugin: x}\n", ""),
        ("c.yaml", "controller_names: [a]\n", "moveit_simple_controller_manager."),
        ("m.yaml", "moveit_simple_controller_manager: {controller_names: [a]}\n", ""),
        ("sensors.yaml", KINDS["sensors"], ""),
    ],
)  # fmt: skip
def test_where_the_builder_puts_a_file(file: str, text: str, above: str) -> None:
    """moveit_configs_utils/moveit_configs_builder.py; a pipeline has the word of its file."""
    document = read_yaml(text.encode(), file)
    kind = find_kind(document)
    assert kind and parameter_above(kind, document) == above
    assert node_of(kind) == ("servo_node" if file == "servo.yaml" else "move_group")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("- a\n", "a.yaml:1: not a MoveIt file: it is not a map"),
        ("a\n", "a.yaml:1: not a MoveIt file: it is not a map"),
        (
            "/**:\n  ros__parameters:\n    a: 1\n",
            "a.yaml:2: ros__parameters makes it a parameter file",
        ),
        ("speed: fast\nheight: 1\n", "not a known kind of MoveIt file: it starts with speed"),
        ("{}\n", "it starts with nothing"),
        ("arm: {kinematics_solver: multibotTagSlot}\n", "reserved for this tool"),
        ("joint_limits: {? |\n  j1\n : 1}\n", "not valid YAML"),
        ("controller_list:\n  - joints: [*a]\n", "not valid YAML"),
    ],
)
def test_what_is_no_file_of_moveit_is_one_line(text: str, said: str) -> None:
    with pytest.raises(InputError) as raised:
        run(text, context())
    assert said in str(raised.value) and "\n" not in str(raised.value)


# The file of one robot, and what it becomes by layout; one that is not there leaves it as it is.
FILES = {
    "keys of joint limits": {
        "one": "default_velocity_scaling_factor: 0.1 # j1\njoint_limits:\n  j1: # j2\n"
        "    max_velocity: 1e-9\n  'j2':   {has_velocity_limits: y}\r\n",
        "L2": "default_velocity_scaling_factor: 0.1 # j1\njoint_limits:\n  sp_j1: # j2\n"
        "    max_velocity: 1e-9\n  'sp_j2':   {has_velocity_limits: y}\r\n",
        "L4": "default_velocity_scaling_factor: 0.1 # j1\njoint_limits:\n  j1_sp: # j2\n"
        "    max_velocity: 1e-9\n  'j2_sp':   {has_velocity_limits: y}\r\n",
    },
    "joints without joint_limits above": {
        "one": "default_acceleration_scaling_factor: 1\nj1: {has_velocity_limits: true}\n",
        "L2": "default_acceleration_scaling_factor: 1\nsp_j1: {has_velocity_limits: true}\n",
        "L4": "default_acceleration_scaling_factor: 1\nj1_sp: {has_velocity_limits: true}\n",
    },
    "names that need quotes": {
        "one": "joint_limits: {y: {max_velocity: 1}, 1: {max_velocity: 2}}\n",
        "L2": "joint_limits: {sp_y: {max_velocity: 1}, sp_1: {max_velocity: 2}}\n",
        "L4": 'joint_limits: {y_sp: {max_velocity: 1}, "1_sp": {max_velocity: 2}}\n',
    },
    "a joint with a dot": {
        "one": "joint_limits:\n  finger.left: {max_velocity: 1}\n  j1.max_velocity: 2\n",
        "L2": "joint_limits:\n  sp_finger.left: {max_velocity: 1}\n  sp_j1.max_velocity: 2\n",
        "L4": "joint_limits:\n  finger.left_sp: {max_velocity: 1}\n  j1_sp.max_velocity: 2\n",
    },
    "a simple controller manager": {
        "one": "moveit_controller_manager: "
        "moveit_simple_controller_manager/MoveItSimpleControllerManager\n"
        "moveit_simple_controller_manager:\n  controller_names: [arm_controller]\n"
        "  arm_controller:\n    type: FollowJointTrajectory\n    action_ns: follow_joint_trajectory\n"
        '    default: true\n    joints: [j1, "j2"]\n',
        "L2": "moveit_controller_manager: "
        "moveit_simple_controller_manager/MoveItSimpleControllerManager\n"
        "moveit_simple_controller_manager:\n  controller_names: [arm_controller]\n"
        "  arm_controller:\n    type: FollowJointTrajectory\n"
        "    action_ns: follow_joint_trajectory\n    default: true\n"
        '    joints: [sp_j1, "sp_j2"]\n',
        "L4": "moveit_controller_manager: "
        "moveit_simple_controller_manager/MoveItSimpleControllerManager\n"
        "moveit_simple_controller_manager:\n  controller_names: [arm_controller_amr]\n"
        "  arm_controller_amr:\n    type: FollowJointTrajectory\n"
        "    action_ns: follow_joint_trajectory\n    default: true\n"
        '    joints: [j1_sp, "j2_sp"]\n',
    },
    "dotted keys are nested maps": {
        "one": "moveit_simple_controller_manager.arm_controller.joints: [j1]\n",
        "L2": "moveit_simple_controller_manager.arm_controller.joints: [sp_j1]\n",
        "L4": "moveit_simple_controller_manager.arm_controller_amr.joints: [j1_sp]\n",
    },
    "a list of controllers": {
        "one": 'controller_list:\n  - name: /arm_controller\n    action_ns: ""\n'
        "    joints:\n      - j1\n",
        "L1": 'controller_list:\n  - name: /amr/arm_controller\n    action_ns: ""\n'
        "    joints:\n      - j1\n",
        "L2": 'controller_list:\n  - name: /amr/arm_controller\n    action_ns: ""\n'
        "    joints:\n      - sp_j1\n",
        "L4": 'controller_list:\n  - name: /arm_controller_amr\n    action_ns: ""\n'
        "    joints:\n      - j1_sp\n",
    },
    "controllers of ROS 1": {
        "one": "moveit_sim_hw_interface: {joint_model_group: arm, joint_model_group_pose: home}\n"
        "hardware_interface:\n  joints: [j1]\ngeneric_hw_control_loop: {loop_hz: 300}\n"
        "arm_controller:\n  type: effort_controllers/JointTrajectoryController\n  joints: [j1]\n"
        "  constraints: {goal_time: 1, j1: {goal: 1}}\n  gains: {j1: {p: 1}}\n",
        "L2": "moveit_sim_hw_interface: {joint_model_group: arm, joint_model_group_pose: home}\n"
        "hardware_interface:\n  joints: [sp_j1]\ngeneric_hw_control_loop: {loop_hz: 300}\n"
        "arm_controller:\n  type: effort_controllers/JointTrajectoryController\n"
        "  joints: [sp_j1]\n"
        "  constraints: {goal_time: 1, sp_j1: {goal: 1}}\n  gains: {sp_j1: {p: 1}}\n",
        "L4": "moveit_sim_hw_interface: {joint_model_group: arm, joint_model_group_pose: home}\n"
        "hardware_interface:\n  joints: [j1_sp]\ngeneric_hw_control_loop: {loop_hz: 300}\n"
        "arm_controller_amr:\n  type: effort_controllers/JointTrajectoryController\n"
        "  joints: [j1_sp]\n"
        "  constraints: {goal_time: 1, j1_sp: {goal: 1}}\n  gains: {j1_sp: {p: 1}}\n",
    },
    "controllers below a namespace of ROS 1": {
        "one": "cell:\n  hardware_interface: {joints: [j1]}\n  controller_list: []\n",
        "L2": "cell:\n  hardware_interface: {joints: [sp_j1]}\n  controller_list: []\n",
        "L4": "cell:\n  hardware_interface: {joints: [j1_sp]}\n  controller_list: []\n",
    },
    "ids of planners beside groups": {
        "one": "planner_configs:\n  arm: {type: geometric::RRT}\narm:\n  planner_configs: [arm]\n"
        "  projection_evaluator: joints(j1, j2)\n  longest_valid_segment_fraction: 0.005\n"
        "gripper: {planner_configs: [], projection_evaluator: link(tool0)}\n",
        "L2": "planner_configs:\n  arm: {type: geometric::RRT}\narm:\n  planner_configs: [arm]\n"
        '  projection_evaluator: "joints(sp_j1, sp_j2)"\n'
        "  longest_valid_segment_fraction: 0.005\n"
        'gripper: {planner_configs: [], projection_evaluator: "link(sp/tool0)"}\n',
        "L4": "planner_configs:\n  arm: {type: geometric::RRT}\narm:\n  planner_configs: [arm]\n"
        '  projection_evaluator: "joints(j1_sp, j2_sp)"\n'
        "  longest_valid_segment_fraction: 0.005\n"
        'gripper: {planner_configs: [], projection_evaluator: "link(tool0/sp)"}\n',
    },
    "servo": {
        "one": "move_group_name: arm\nplanning_frame: base_link\nee_frame_name: /tool0\n"
        "joint_topic: /joint_states\ncommand_out_topic: /arm_controller/joint_trajectory\n"
        "status_topic: ~/status\ncommand_out_type: trajectory_msgs/JointTrajectory\n",
        "L1": "move_group_name: arm\nplanning_frame: base_link\nee_frame_name: /tool0\n"
        "joint_topic: /amr/joint_states\n"
        "command_out_topic: /amr/arm_controller/joint_trajectory\n"
        "status_topic: ~/status\ncommand_out_type: trajectory_msgs/JointTrajectory\n",
        "L2": "move_group_name: arm\nplanning_frame: sp/base_link\nee_frame_name: /sp/tool0\n"
        "joint_topic: /amr/joint_states\n"
        "command_out_topic: /amr/arm_controller/joint_trajectory\n"
        "status_topic: ~/status\ncommand_out_type: trajectory_msgs/JointTrajectory\n",
        "L4": "move_group_name: arm\nplanning_frame: base_link/sp\nee_frame_name: /tool0/sp\n"
        # A rule of the node moves this one.
        "joint_topic: /joint_states\n"
        "command_out_topic: /arm_controller_amr/joint_trajectory\n"
        "status_topic: ~/status\ncommand_out_type: trajectory_msgs/JointTrajectory\n",
    },
    "servo with a private topic": {
        "one": "move_group_name: arm\ncommand_out_topic: ~/joint_trajectory\n",
        **dict.fromkeys(
            ("L1", "L2", "L4"), "move_group_name: arm\ncommand_out_topic: ~/joint_trajectory\n"
        ),
    },
    "sensors": {
        "one": "sensors:\n  - {sensor_plugin: a/B, point_cloud_topic: /eye/points, "
        "filtered_cloud_topic: f}\noctomap_frame: odom\n",
        "L1": "sensors:\n  - {sensor_plugin: a/B, point_cloud_topic: /amr/eye/points, "
        "filtered_cloud_topic: f}\noctomap_frame: odom\n",
        "L2": "sensors:\n  - {sensor_plugin: a/B, point_cloud_topic: /amr/eye/points, "
        "filtered_cloud_topic: f}\noctomap_frame: sp/odom\n",
        "L4": "sensors:\n  - {sensor_plugin: a/B, point_cloud_topic: /eye/points/amr, "
        "filtered_cloud_topic: f/amr}\noctomap_frame: odom/sp\n",
    },
    "start tolerances": {
        "one": "trajectory_execution:\n  allowed_start_tolerance: 0.1\n"
        "  allowed_start_tolerance_joints: {j1: 0.1}\n",
        "L2": "trajectory_execution:\n  allowed_start_tolerance: 0.1\n"
        "  allowed_start_tolerance_joints: {sp_j1: 0.1}\n",
        "L4": "trajectory_execution:\n  allowed_start_tolerance: 0.1\n"
        "  allowed_start_tolerance_joints: {j1_sp: 0.1}\n",
    },
    "a tag stays": {
        "one": "initial_positions:\n  j1: !degrees 90\n  !!str j2: 0\n",
        "L2": "initial_positions:\n  sp_j1: !degrees 90\n  !!str sp_j2: 0\n",
        "L4": "initial_positions:\n  j1_sp: !degrees 90\n  !!str j2_sp: 0\n",
    },
    "an alias is one place": {
        "one": "controller_list:\n  - name: &c a\n    joints: &j [&one j1, j2]\n"
        "  - {name: b, joints: *j}\n  - {name: d, joints: [*one]}\n",
        "L2": "controller_list:\n  - name: &c a\n    joints: &j [&one sp_j1, sp_j2]\n"
        "  - {name: b, joints: *j}\n  - {name: d, joints: [*one]}\n",
        "L4": "controller_list:\n  - name: &c a_amr\n    joints: &j [&one j1_sp, j2_sp]\n"
        "  - {name: b_amr, joints: *j}\n  - {name: d_amr, joints: [*one]}\n",
    },
    "merged maps": {
        "one": "base: &all {type: FollowJointTrajectory, joints: [j1]}\n"
        "moveit_simple_controller_manager:\n  one: {<<: *all}\n",
        "L2": "base: &all {type: FollowJointTrajectory, joints: [sp_j1]}\n"
        "moveit_simple_controller_manager:\n  one: {<<: *all}\n",
        "L4": "base_amr: &all {type: FollowJointTrajectory, joints: [j1_sp]}\n"
        "moveit_simple_controller_manager:\n  one_amr: {<<: *all}\n",
    },
    "what is no name": {
        "one": 'joint_limits: {}\nrequest_adapters: >-\n  a/B\n  c/D\ncapabilities: ""\n'
        'octomap_frame: ""\n'
    },
}


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("name", FILES)
def test_a_file_for_a_robot(name: str, layout: str) -> None:
    one = FILES[name]["one"]
    new = FILES[name].get("L2" if layout == "L3" else layout, one)
    assert text_of(one, context(layout)) == new


def test_groups_without_an_srdf_are_reported() -> None:
    text = "arm: {kinematics_solver: a/B}\n"
    new, found = run(text, context("L2", srdf=False, groups="rename"))
    assert new == text and [it.code for it in found] == ["MB892"]
    assert codes(text, context("L2", srdf=False)) == []
    assert codes(text, context("L2", groups="rename")) == []


def test_a_name_that_the_description_lacks_is_reported_once_with_the_nearest() -> None:
    text = "controller_list:\n  - name: a\n    joints: [j1, jj1]\n  - {name: b, joints: [jj1]}\n"
    (found,) = run(text, context("L1"))[1]
    assert (found.code, found.line, found.column) == ("MB854", 3, 18)
    assert "joint 'jj1'" in found.message and "did you mean 'j1'?" in found.hint
    assert codes("arn: {kinematics_solver: a/B}\n", context()) == [("MB854", 1)]
    evaluator = "arm: {planner_configs: [], projection_evaluator: 'joints(j1,j9)'}\n"
    assert codes(evaluator, context()) == [("MB854", 1)]


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("arm:\n  kinematics_solver: a/B\n  favourite: j1\n", [("MB901", 3)]),
        ("arm:\n  kinematics_solver: a/B\n  spot: /eye/points\n", [("MB901", 3)]),
        ("arm:\n  kinematics_solver: a/B\n  weights: [1, 2]\n  mode: global\n", []),
        ("arm: {kinematics_solver: a/B}\nsolver: fast\n", []),
        ("arm: {kinematics_solver: a/B}\nhand: {}\n", [("MB854", 2)]),
        ("arm: {kinematics_solver: a/B}\nhand:\n", [("MB854", 2)]),
        ("octomap_frame: $(arg p)map\nsensors: []\n", [("MB105", 1)]),
        ("joint_limits:\n  j1: {}\n  j2: {}\n  j1: {}\n", [("MB859", 4)]),
        ("joint_limits:\n  $(arg p)j1: {}\n", [("MB105", 2)]),
        ("hardware_interface:\n  joints:\n    - >-\n      j1\n", [("MB876", 3)]),
        ("sensors: [a]\na: {sensor_plugin: b/C, image_topic: a b/}\n", [("MB312", 2)]),
        ("sensors: [a]\na: {sensor_plugin: b/C, image_topic: 1/b}\n", [("MB312", 2)]),
    ],
)
def test_findings(text: str, found: list[tuple[str, int]]) -> None:
    assert codes(text, context()) == found


def test_an_alias_that_needs_two_new_names_is_refused() -> None:
    text = "octomap_frame: &x tool0\ncontroller_list:\n  - {name: a, joints: [*x]}\n"
    declared = context()
    both = {**declared.names.declared, "joint": {"tool0": None}}
    it = declared._replace(names=declared.names._replace(declared=both))
    with pytest.raises(
        InputError, match=r"a\.yaml:1: an alias uses 'tool0' as two kinds"
    ) as raised:
        run(text, it)
    assert "multibot" not in str(raised.value)


def test_a_circle_of_aliases_is_refused() -> None:
    with pytest.raises(InputError, match=r":2:15: not valid YAML: the alias is inside the value"):
        run("joint_limits: &a\n  j1: {again: *a}\n", context())


def test_a_prefix_of_links_is_put_before_what_is_there() -> None:
    text = 'arm: {kinematics_solver: a/IKFast, link_prefix: ""}\n'
    assert 'link_prefix: "sp/"' in text_of(text, context())
    new, found = run(text, context("L4"))
    assert new == text and [it.code for it in found] == ["MB422"]
    assert run(text, context("L1")) == (text, ())


MANAGED = "moveit_controller_manager: moveit_ros_control_interface/Ros2ControlManager\n"


def test_the_manager_that_moveit_asks_is_the_robots() -> None:
    assert text_of(MANAGED, context()) == f"ros_control_namespace: /amr\n{MANAGED}"
    set_ = f"{MANAGED}ros_control_namespace: /\n"
    assert text_of(set_, context()) == f"{MANAGED}ros_control_namespace: /amr\n"
    flow = "{moveit_controller_manager: moveit_ros_control_interface/Ros2ControlManager}"
    assert text_of(flow, context()) == f"{{ros_control_namespace: /amr, {flow[1:]}"
    for text, line in ((set_, 2), (MANAGED, 1), (flow, 1)):
        assert text_of(text, context("L4")) == text
        assert codes(text, context("L4")) == [("MB893", line)]


JOINT_LISTS = st.lists(st.sampled_from([*JOINTS[:2], "other", "a b", "0.5", "${x}j1", ""]))


@pytest.mark.slow
@given(JOINT_LISTS, st.sampled_from(LAYOUTS), st.sampled_from(["", "'", '"']), st.booleans())
def test_lists_of_joints(joints: list[str], layout: str, quote: str, flow: bool) -> None:
    written = [f"{quote}{it}{quote}" for it in joints if it or quote]
    body = f"[{', '.join(written)}]" if flow else "".join(f"\n    - {it}  # j1" for it in written)
    text = f"controller_list:\n  - name: c # j1\n    joints: {body}\n"
    if "$" in text and flow and not quote:
        return
    before, after = (yaml.safe_load(it) for it in (text, text_of(text, context(layout))))
    spell = {"L1": "{}", "L4": "{}_sp"}.get(layout, "sp_{}")
    old = before["controller_list"][0]["joints"] or []
    wanted = [spell.format(it) if it in JOINTS else it for it in old]
    assert (after["controller_list"][0]["joints"] or []) == wanted
    assert text_of(text, context(layout)).count("# j1") == text.count("# j1")


@pytest.mark.parametrize("prefix", ["$(var tf_prefix)", "<robot_namespace>_", "${prefix}"])
def test_what_a_launch_file_puts_in_front_is_the_robots_name(prefix: str) -> None:
    """launch_ros ParameterFile fills it in: such a file has no joint of the description in it."""
    limits = "joint_limits:\n  {}j1: {{has_velocity_limits: true}}\n"
    it = context()
    assert text_of(limits.format(prefix), it) == text_of(limits.format(""), it)
    joints = 'controller_list: []\narm:\n  joints: ["{}j1"]\ncontroller_names: [arm]\n'
    assert "j1" in text_of(joints.format(""), it)
    assert text_of(joints.format(prefix), it) == text_of(joints.format(""), it)
