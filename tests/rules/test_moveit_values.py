# SPDX-License-Identifier: Apache-2.0
"""Values of MoveIt, filters, joysticks and SRDFs of Pinocchio: what the consumer's source says.

Of ``rules/files``: chains, controllers, costmaps, joystick, limits, moveit.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import pytest

from multibot_rewrite.base.findings.finding import ERROR, WARNING
from multibot_rewrite.lint.run import lint_files
from multibot_rewrite.rules.settings import Settings

ARM = """\
<robot name="arm">
  <link name="base"/><link name="upper"/><link name="hand"/>
  <joint name="lift" type="revolute">
    <parent link="base"/><child link="upper"/><limit lower="-1" upper="1" effort="9" velocity="2"/>
  </joint>
  <joint name="turn" type="continuous"><parent link="upper"/><child link="hand"/></joint>
</robot>
"""
SRDF = '<robot name="arm"><group name="arm"><joint name="lift"/></group>{}</robot>'
PACKAGE = "<package><name>arm</name><buildtool_depend>{}</buildtool_depend></package>"


def linted(
    folder: Path, name: str, text: str, select: Iterable[str], release: str = "jazzy"
) -> list[tuple[str, str]]:
    files = {
        "package.xml": PACKAGE.format("ament_cmake"),
        "arm.urdf": ARM,
        "arm.srdf": SRDF.format(""),
    }
    for file, content in {**files, name: text}.items():
        if not (folder / file).exists() or file == name:
            (folder / file).write_text(content)
    settings = Settings(select=tuple(select), distro=release)
    found = lint_files([str(folder / name)], settings, jobs=1)
    return [(it.code, it.level) for it in found]


def limits(joint: str, values: str) -> str:
    return f"joint_limits:\n  {joint}: {{{values}}}\n"


@pytest.mark.parametrize(
    ("joint", "values", "expected"),
    [
        ("lift", "has_velocity_limits: true, max_velocity: 1", [("MB120", ERROR)]),
        ("lift", "has_velocity_limits: false, max_velocity: 1", []),
        ("lift", "max_velocity: 9.0", []),
        ("lift", "has_velocity_limits: true, max_velocity: 9.0", [("MB898", WARNING)]),
        ("lift", "max_position: 0.5, min_position: -0.5", []),
        ("lift", "max_position: 1.5", [("MB898", WARNING)]),
        ("lift", "min_position: -1.5", [("MB898", WARNING)]),
        ("lift", "max_position: -0.5, min_position: 0.5", [("MB125", WARNING)]),
        ("lift", "has_jerk_limits: true", [("MB115", ERROR)]),
        ("$(arg prefix)a", "has_velocity_limits: true, max_velocity: 1", [("MB120", ERROR)]),
        # Tags of PyYAML, as launch files and xacro read them: the URDF has 1 rad and 2 rad/s.
        ("lift", "max_position: !degrees 57.0, min_position: !degrees -57", []),
        ("lift", "max_position: !degrees 60.0", [("MB898", WARNING)]),
        ("lift", "min_position: !degrees -60", [("MB898", WARNING)]),
        ("lift", "max_position: !radians 0.9", []),
        ("lift", "max_position: !radians 1.1", [("MB898", WARNING)]),
        ("lift", "has_velocity_limits: true, max_velocity: !degrees 110", []),
        ("lift", "has_velocity_limits: true, max_velocity: !degrees 120", [("MB898", WARNING)]),
        ("lift", "has_velocity_limits: true, max_velocity: !!float 1", []),
        # An expression, or a text for a launch file: there, and not known.
        ("lift", "has_velocity_limits: true, max_velocity: !degrees 180/2", []),
        ("lift", "has_velocity_limits: true, max_velocity: <velocity>", []),
        ("lift", "has_velocity_limits: true", [("MB115", ERROR)]),
        # A continuous joint has no range, and the URDF no velocity for it.
        ("turn", "has_velocity_limits: true, max_velocity: 99.0, max_position: 9.0", []),
    ],
)
def test_limits_of_a_joint(
    joint: str, values: str, expected: list[tuple[str, str]], tmp_path: Path
) -> None:
    codes = ("MB115", "MB120", "MB125", "MB898")
    assert linted(tmp_path, "joint_limits.yaml", limits(joint, values), codes) == expected


def test_a_package_of_ros_1_is_not_judged_by_ros_2(tmp_path: Path) -> None:
    (tmp_path / "package.xml").write_text(PACKAGE.format("catkin"))
    text = limits("lift", "has_velocity_limits: true, max_velocity: 1")
    assert linted(tmp_path, "joint_limits.yaml", text, ("MB120", "MB899")) == []


@pytest.mark.parametrize(
    ("release", "text", "expected"),
    [
        ("jazzy", "planning_plugin: ompl_interface/OMPLPlanner\n", [("MB894", WARNING)]),
        ("humble", "planning_plugin: ompl_interface/OMPLPlanner\n", []),
        ("jazzy", "planning_plugins: [ompl_interface/OMPLPlanner]\n", []),
        ("jazzy", "planning_plugins: [ompl_interface/OMPLPlaner]\n", [("MB124", ERROR)]),
        (
            "jazzy",
            "request_adapters: chomp/OptimizerAdapter\n",
            [("MB120", WARNING), ("MB124", WARNING)],
        ),
        ("humble", "request_adapters: chomp/OptimizerAdapter\n", []),
    ],
)
def test_a_pipeline_by_release(
    release: str, text: str, expected: list[tuple[str, str]], tmp_path: Path
) -> None:
    codes = ("MB120", "MB124", "MB894")
    # The pipeline is in the name of one file, and in the launch file for another.
    for name in ("ompl_planning.yaml", "pipeline.yaml"):
        assert linted(tmp_path, name, text, codes, release) == expected


@pytest.mark.parametrize(
    ("srdf", "expected"),
    [
        (SRDF.format(""), [("MB899", WARNING)]),
        (SRDF.format('<group name="hand"><link name="hand"/></group>'), []),
        # Groups that a macro makes may have any name.
        (SRDF.format('<group name="${prefix}hand"/>'), []),
        (SRDF.format('<xacro:hand name="hand"/>'), []),
    ],
)
def test_a_group_that_no_srdf_has(
    srdf: str, expected: list[tuple[str, str]], tmp_path: Path
) -> None:
    (tmp_path / "arm.srdf").write_text(srdf)
    text = "hand:\n  kinematics_solver: kdl_kinematics_plugin/KDLKinematicsPlugin\n"
    assert linted(tmp_path, "kinematics.yaml", text, ("MB899",)) == expected


FILTER = "name: {}, type: laser_filters/{}"


@pytest.mark.parametrize(
    ("filters", "expected"),
    [
        ({"filter1": FILTER.format("a", "InterpolationFilter")}, []),
        ({"filter2": FILTER.format("a", "InterpolationFilter")}, [("MB896", WARNING)]),
        ({"filter1": "type: laser_filters/InterpolationFilter"}, [("MB896", ERROR)]),
        (
            {f"filter{it}": FILTER.format("a", "InterpolationFilter") for it in (1, 2)},
            [("MB896", ERROR)],
        ),
        # A number without an end is no filter's.
        ({"filter1" + "0" * 900: FILTER.format("a", "InterpolationFilter")}, []),
    ],
)
def test_a_chain_of_filters(
    filters: dict[str, str], expected: list[tuple[str, str]], tmp_path: Path
) -> None:
    lines = "".join(f"    {name}: {{{body}}}\n" for name, body in filters.items())
    text = f"scan_to_scan_filter_chain:\n  ros__parameters:\n{lines}"
    assert linted(tmp_path, "filters.yaml", text, ("MB896",)) == expected


def told(folder: Path, name: str, text: str, code: str, release: str = "jazzy") -> list[str]:
    """Place, level, message and hint of each finding."""
    (folder / name).write_text(text)
    found = lint_files([str(folder / name)], Settings(select=(code,), distro=release), jobs=1)
    return [f"{it.line}:{it.column} {it.level} {it.message}; {it.hint}" for it in found]


def test_a_limit_that_is_nearly_called_so(tmp_path: Path) -> None:
    linted(tmp_path, "a.yaml", "", ())
    joint = "robot_description_planning.joint_limits.lift."
    text = limits("lift", "has_velocity_limit: true, max_velocity: 1.0")
    assert told(tmp_path, "joint_limits.yaml", text, "MB110") == [
        f"2:10 warning move_group has no parameter '{joint}has_velocity_limit'; did you mean"
        f" '{joint}has_velocity_limits'?"
    ]


def test_what_is_said_of_a_chain(tmp_path: Path) -> None:
    """filter_chain.hpp loads up to the first number that is not there, and needs name and type."""
    text = """\
scan_to_scan_filter_chain:
  ros__parameters:
    filter1: {name: a, type: laser_filters/InterpolationFilter}
    filter2: {name: a, type: laser_filters/InterpolationFilter}
    filter3: {label: c}
    filter5: {name: b, type: laser_filters/InterpolationFilter}
    filter: {name: c, type: laser_filters/InterpolationFilter}
    other:
      filter1: {name: a, type: laser_filters/InterpolationFilter}
"""
    chain, number = "scan_to_scan_filter_chain", "filters are called filter1, filter2 and so on"
    unset = "add it: the chain is not configured without"
    assert told(tmp_path, "filters.yaml", text, "MB896") == [
        f"4:21 error {chain}: filter2 has the name 'a', as filter1 has; give it another name",
        f"5:15 error {chain}: filter3 has no name; {unset}",
        f"5:15 error {chain}: filter3 has no type; {unset}",
        f"6:15 warning {chain}: filter5 is not loaded: there is no filter4; {number}, without a gap",
        f"7:14 warning {chain}: filter is not loaded: there is no filter4; {number}, without a gap",
    ]
    other = text.replace("scan_to_scan_filter_chain", "chain")
    assert told(tmp_path, "filters.yaml", other, "MB896") == []


COSTMAP = """\
local_costmap:
  local_costmap:
    ros__parameters:
      {}
      plugins: [inflation]
      inflation: {{plugin: "nav2_costmap_2d::InflationLayer", inflation_radius: 0.5}}
"""
SQUARE = 'footprint: "[[{0}, {0}], [{0}, -{0}], [-{0}, -{0}], [-{0}, {0}]]"'
SIZED = "local_costmap/local_costmap"
BESIDE = f"{SIZED}: robot_radius has no effect with a footprint, and is another size"


@pytest.mark.parametrize(
    "row",
    [
        ("robot_radius: 0.5",),
        ("robot_radius: 0.6",
         f"6:80 warning {SIZED}: inflation.inflation_radius is 0.5 m, less than the robot's"
         " 0.6 m; the robot is as large as robot_radius says; inflate further than that"),
        (SQUARE.format(0.5),),
        (SQUARE.format(0.6),
         f"6:80 warning {SIZED}: inflation.inflation_radius is 0.5 m, less than the robot's"
         " 0.6 m; the robot is as large as footprint says; inflate further than that"),
        # The footprint counts.
        ("robot_radius: 0.6\n      " + SQUARE.format(0.5),),
        # A tenth below its nearest edge, half above its farthest point.
        ("robot_radius: 0.45\n      " + SQUARE.format(0.5),),
        ("robot_radius: 0.44\n      " + SQUARE.format(0.5),
         f"4:21 warning {BESIDE}; leave out robot_radius"),
        ("robot_radius: 1.06\n      " + SQUARE.format(0.5),),
        ("robot_radius: 1.07\n      " + SQUARE.format(0.5),
         f"4:21 warning {BESIDE}; leave out robot_radius"),
        # Of two points nothing is a footprint.
        ('robot_radius: 0.4\n      footprint: "[[9, 9], [8, 8]]"',),
        ("robot_radius: 0.0",),
    ],
)  # fmt: skip
def test_what_is_said_of_the_size_in_a_costmap(row: tuple[str, ...], tmp_path: Path) -> None:
    size, *said = row
    found = told(tmp_path, "nav2.yaml", COSTMAP.format(size), "MB895")
    assert [it.replace(f"{7 + size.count(chr(10))}:", "6:") for it in found] == said


@pytest.mark.parametrize(
    "row",
    [
        ("robot_radius: 0.4",),
        ("robot_radius: 0.1",
         f"4:21 warning {SIZED}: robot_radius reaches 0.1 m from the middle alone; the"
         " description reaches 1 m; write metres"),
        ("robot_radius: 3.0",),
        ("robot_radius: 3.1",
         f"4:21 warning {SIZED}: robot_radius reaches 3.1 m from the middle; the description"
         " reaches 1 m; write metres"),
        # An eighth.
        ("robot_radius: 0.125",),
    ],
)  # fmt: skip
def test_the_size_in_a_costmap_beside_the_description(row: tuple[str, ...], tmp_path: Path) -> None:
    size, *said = row
    body = '<collision><geometry><box size="1.2 1.6 1"/></geometry></collision>'
    (tmp_path / "package.xml").write_text(PACKAGE.format("ament_cmake"))
    (tmp_path / "r.urdf").write_text(f'<robot name="r"><link name="a">{body}</link></robot>')
    text = COSTMAP.format(size).replace("0.5}", "9.5}")
    assert told(tmp_path, "nav2.yaml", text, "MB895") == said


TELEOP = "joy_teleop:\n  ros__parameters:\n    go: {{{}}}\n"
START, NAMED = "deadman_buttons: [1]", "interface_type: std_msgs/msg/Bool, topic_name: a"
TWIST = "type: topic, interface_type: geometry_msgs/msg/Twist, topic_name: a, deadman_axes: [1]"
AXIS = "{axis: 1, scale: 1.0, offset: 0.0}"


@pytest.mark.parametrize(
    "row",
    [
        ("type: topics, topic_name: a", "is of type 'topics'; write one of topic, service, action"),
        ("topic_name: a", "has no type; write one of topic, service, action"),
        (f"type: topic, {START}, message_value: {{a: 1}}",
         "has no interface_type; add interface_type", "has no topic_name; add topic_name"),
        ("type: service, interface_type: a/msg/B, axes: [1]",
         "has no service_name; add service_name",
         "has the interface_type 'a/msg/B'; write PACKAGE/srv/B"),
        ("type: service, interface_type: B, service_name: b, buttons: []",
         "has the interface_type 'B'; write PACKAGE/srv/B",
         "is started by nothing; add buttons, or axes or axes_negative"),
        (f"type: topic, {NAMED}, message_value: {{a: 1}}",
         "is started by nothing; add deadman_buttons, or deadman_axes or deadman_axes_negative"),
        ("type: action, interface_type: a/action/B, action_name: b, axes_negative: [1]",),
        ("type: service, interface_type: a/srv/B, service_name: b, axes: [1]",),
        (f"type: topic, {NAMED}, {START}",
         "has neither message_value nor axis_mappings; give it one of the two"),
        (f"type: topic, {NAMED}, {START}, message_value: {{a: 1}}, axis_mappings: {{a: {AXIS}}}",
         "has both message_value and axis_mappings; give it one of the two"),
        (f"type: topic, {NAMED}, {START}, axis_mappings: {{a: {{scale: 1.0}}, b: {{button: 1}}}}",
         "has no axis, button or value for a; add one of them"),
        (f"type: topic, {NAMED}, {START}, axis_mappings: {{a: {{axis: 1}}, b: {{value: 1}}}}",
         "has no scale and no offset for a; add scale and offset of the axis"),
        (f"type: topic, {NAMED}, {START}, axis_mappings: {{a: {{axis: 1, scale: 1.0}}}}",
         "has no offset for a; add scale and offset of the axis"),
        (f"{TWIST}, axis_mappings: {{linear-x: {AXIS}, -angular-z: {AXIS}}}",),
        (f"{TWIST}, axis_mappings: {{twist-linear-x: {AXIS}}}",
         "sets twist-linear-x of a geometry_msgs/msg/Twist, which has linear and angular; use"
         " one of these"),
        (f"{TWIST}, axis_mappings: {{linear-x: {AXIS}}}".replace("Twist,", "TwistStamped,"),
         "sets linear-x of a geometry_msgs/msg/TwistStamped, which has header and twist; use"
         " one of these"),
        (f"{TWIST}, axis_mappings: {{twist-linear-x: {AXIS}}}".replace("st,", "stStamped,"),),
        # Blocks of another node that is called so.
        ("x: 1, y: 2",),
    ],
)  # fmt: skip
def test_what_is_said_of_a_joysticks_command(row: tuple[str, ...], tmp_path: Path) -> None:
    command, *said = row
    """joy_teleop.py: what each type of a command asks for."""
    found = told(tmp_path, "joy.yaml", TELEOP.format(command), "MB897")
    assert found == [f"3:10 error joy_teleop: command 'go' {it}" for it in said]


def test_settings_of_qos_are_no_command_of_a_joystick(tmp_path: Path) -> None:
    text = TELEOP.replace("go", "qos_overrides").format("type: topics")
    assert told(tmp_path, "joy.yaml", text, "MB897") == []


COMMAND = "type: topic, interface_type: std_msgs/msg/Bool, topic_name: a, deadman_buttons: [1]"


@pytest.mark.parametrize(
    ("command", "count"),
    [
        (f"{COMMAND}, message_value: {{data: {{value: true}}}}", 0),
        (COMMAND, 1),
        (
            f"{COMMAND}, message_value: {{data: {{value: true}}}}, axis_mappings: {{a: {{axis: 1}}}}",
            2,
        ),
        (f"{COMMAND}, axis_mappings: {{data: {{}}}}", 1),
        ("type: action, interface_type: a/action/B, action_name: a, buttons: [1]", 0),
        ("type: action, interface_type: a/msg/B, buttons: []", 3),
        ("interface_type: a/msg/B", 1),
    ],
)
def test_a_command_of_a_joystick(command: str, count: int, tmp_path: Path) -> None:
    text = f"joy_teleop:\n  ros__parameters:\n    use_sim_time: true\n    go: {{{command}}}\n"
    assert linted(tmp_path, "joy.yaml", text, ("MB897",)) == [("MB897", ERROR)] * count


STATE = '<group_state name="home"{}><joint name="{}" value="0"/></group_state>'


@pytest.mark.parametrize(
    ("rest", "expected"),
    [
        (STATE.format(' group="arm"', "lift"), []),
        (STATE.format(' group="rest"', "lift"), [("MB805", ERROR)]),
        # Pinocchio takes no group from a state, and calls its free flyer root_joint.
        (STATE.format("", "lift"), []),
        (STATE.format(' group="rest"', "root_joint"), []),
        # The URDF was found beside it, and may be another variant.
        (STATE.format(' group="arm"', "lost"), [("MB804", WARNING)]),
        (STATE.format("", "lost"), [("MB804", WARNING)]),
        (
            STATE.format("", "lift") + '<group name="all"><link name="lost"/></group>',
            [("MB803", WARNING)],
        ),
        ('<rotor_params><joint name="lift" mass="1" gear_ratio="9"/></rotor_params>', []),
        (
            '<rotor_params><joint name="lost" mass="1" gear_ratio="9"/></rotor_params>',
            [("MB804", WARNING)],
        ),
    ],
)
def test_an_srdf_of_pinocchio(rest: str, expected: list[tuple[str, str]], tmp_path: Path) -> None:
    codes = ("MB115", "MB803", "MB804", "MB805", "MB812", "MB901")
    assert linted(tmp_path, "arm.srdf", SRDF.format(rest), codes) == expected


CONTROLLER = (
    "{}:\n  ros__parameters: {{joints: [left, right], command_interfaces: [position],"
    " state_interfaces: [position]}}\n"
)
JTC, DIFF = (
    "joint_trajectory_controller/JointTrajectoryController",
    "diff_drive_controller/DiffDriveController",
)
LOADED = "controller_manager:\n  ros__parameters: {{arm.type: {}}}\n"
OF_NONE = "has parameters of a controller that nothing declares; did you mean arm (c.yaml:2)?"


@pytest.mark.parametrize(
    ("type_", "sections", "said"),
    [
        (JTC, "arm", []),
        (JTC, "amr", [f"3:1 warning amr {OF_NONE}"]),
        # The one section of a kind, and the one controller of that kind that has none.
        (
            JTC,
            "joint_trajectory_controller",
            [f"3:1 warning joint_trajectory_controller {OF_NONE}"],
        ),
        (DIFF, "joint_trajectory_controller", []),
        (JTC, "joint_trajectory_controller right_joint_trajectory_controller", []),
        (JTC, "arm joint_trajectory_controller", []),
    ],
)
def test_a_section_that_is_of_no_controller(
    type_: str, sections: str, said: list[str], here: Path
) -> None:
    text = LOADED.format(type_) + "".join(CONTROLLER.format(it) for it in sections.split())
    assert told(here, "c.yaml", text, "MB878") == said


ROW = "type: {}, action_ns: {}, joints: [{}]"
FOLLOWS, ACTION = "FollowJointTrajectory", "follow_joint_trajectory"
NO_FILE = "which no parameter file of the robot has"


@pytest.mark.parametrize(
    ("name", "row", "said"),
    [
        ("arm", ROW.format(FOLLOWS, ACTION, "left"), []),
        (
            "arm",
            ROW.format(FOLLOWS, ACTION, "lefd"),
            [
                f"3:83 warning MoveIt uses joint lefd of arm, {NO_FILE}; did you mean left (c.yaml:4)?"
            ],
        ),
        (
            "arm",
            ROW.format(FOLLOWS, ACTION, "zzz"),
            [f"3:83 warning MoveIt uses joint zzz of arm, {NO_FILE}; see c.yaml:4"],
        ),
        (
            "arm",
            ROW.format(FOLLOWS, "follow_joint_trajectry", "left"),
            [
                f"3:49 warning MoveIt uses action arm/follow_joint_trajectry, {NO_FILE}; did you"
                " mean arm/follow_joint_trajectory (c.yaml:2)?"
            ],
        ),
        (
            "arm",
            ROW.format("GripperCommand", ACTION, "left"),
            [
                f"3:15 warning MoveIt uses arm/follow_joint_trajectory as GripperCommand, {NO_FILE};"
                " did you mean FollowJointTrajectory (c.yaml:2)?"
            ],
        ),
        (
            "arm2",
            ROW.format(FOLLOWS, ACTION, "left"),
            [f"3:3 warning MoveIt uses controller arm2, {NO_FILE}; did you mean arm (c.yaml:2)?"],
        ),
        (
            "leg",
            ROW.format(FOLLOWS, ACTION, "left"),
            [
                f"3:3 warning MoveIt uses controller leg, {NO_FILE}; use the controller's name, its"
                " joints and its action"
            ],
        ),
        # A launch file fills it in.
        ("$(var side)_arm", ROW.format(FOLLOWS, ACTION, "left"), []),
    ],
)
def test_a_controller_as_moveit_has_it(name: str, row: str, said: list[str], here: Path) -> None:
    (here / "c.yaml").write_text(LOADED.format(JTC) + CONTROLLER.format("arm"))
    text = f"moveit_simple_controller_manager:\n  controller_names: [{name}]\n  {name}: {{{row}}}\n"
    found = told(here, "moveit_controllers.yaml", text, "MB857")
    assert found == said
