# SPDX-License-Identifier: Apache-2.0
"""Small descriptions: what is said of them in whole sentences, and what is right and stays unsaid.

Of ``rules/description``: duplicates, frames, inertia, limits, mass, sensors, tree; of spans.
"""

from __future__ import annotations

import pytest

from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.lint.check import lint_data
from multibot_rewrite.rules import convert
from multibot_rewrite.rules.settings import Settings

A, LASER = '<link name="a"/>', '<link name="laser"/>'
FRAME = (
    '<gazebo><plugin name="p" filename="libgazebo_ros_imu_sensor.so">'
    "<frame_name>robot1/laser</frame_name></plugin></gazebo>"
)
SENSOR = '<gazebo reference="a"><sensor name="s" type="imu"/></gazebo>'
NO_MASS = (
    '<link name="base"><inertial><mass value="1"/>'
    '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>'
    '<joint name="j" type="continuous"><parent link="base"/><child link="a"/></joint>'
)
GONE = "link 'a' and the links fixed to it have no mass: Gazebo leaves it out"
SDF = (
    '<sdf version="1.9"><model name="m"><link name="a"><inertial{}><mass>{}</mass><inertia>'
    "<ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial></link></model></sdf>"
)
MESH = '<visual><geometry><mesh filename="file:///home/me/{}.stl"/></geometry></visual>'
BOX = '<collision><origin xyz="2 0 0"/><geometry><box size="1 1 1"/></geometry></collision>'
JOINT = '<link name="b"/><joint name="j" type="revolute"><parent link="{}"/><child link="b"/>'
LIMIT = '<limit lower="-1" upper="1" effort="{}" velocity="{}"/></joint>'
DRIVE = (
    '<gazebo><plugin name="gz::sim::systems::DiffDrive" filename="gz-sim-diff-drive-system">'
    "<frame_id>odom</frame_id></plugin></gazebo>"
)
CLASSIC_DRIVE = (
    '<gazebo><plugin name="p" filename="libgazebo_ros_diff_drive.so">'
    "<robot_base_frame>a</robot_base_frame></plugin></gazebo>"
)
LIBRARY = '<gazebo><plugin name="gz::sim::systems::Imu" filename="{}"/></gazebo>'


@pytest.mark.parametrize(
    ("code", "text", "said"),
    [
        (
            "MB404",
            LASER + FRAME,
            "frame 'robot1/laser' has a robot's name in front, the link is called 'laser'",
        ),
        ("MB404", LASER + '<link name="robot1/laser"/>' + FRAME, ""),
        # Of two sensors of one name in one link the second one.
        ("MB201", A + SENSOR + SENSOR, "'a' has another sensor 's'"),
        ("MB201", A + SENSOR + SENSOR.replace('"s"', '"t"'), ""),
        ("MB201", A + LASER + SENSOR + SENSOR.replace('"a"', '"laser"'), ""),
        ("MB603", A + NO_MASS, GONE),
        ("MB603", A + NO_MASS + SENSOR, f"{GONE}; sensor 's' goes with it"),
        ("MB603", A + NO_MASS + SENSOR.replace('"a"', '"base"'), GONE),
        (
            "MB603",
            A + NO_MASS + '<ros2_control name="c" type="system"><joint name="j"/></ros2_control>',
            f"{GONE}; joint 'j' of ros2_control goes with it",
        ),
        (
            "MB603",
            A + NO_MASS + DRIVE.replace("frame_id>odom</frame_id", "left_joint>j</left_joint"),
            f"{GONE}; joint 'j' of a plugin goes with it",
        ),
        # sdformat parser.cc: with auto="true" or "1" the values are computed.
        ("MB606", SDF.format("", 0), "mass of link 'a' is 0, and has to be above 0"),
        ("MB606", SDF.format("", -1), "mass of link 'a' is -1, and has to be above 0"),
        ("MB606", SDF.format("", 1), ""),
        ("MB606", SDF.format(' auto="1"', 0), ""),
        ("MB606", SDF.format(' auto="TRUE"', 0), ""),
        (
            "MB606",
            SDF.format(' auto="false"', 0),
            "mass of link 'a' is 0, and has to be above 0",
        ),
        # What is not drawn is not apart from what bumps.
        ("MB631", f'<link name="a"><visual><geometry/></visual>{BOX}</link>', ""),
        (
            "MB704",
            f'<link name="a">{MESH.format("a")}</link>',
            "'file:///home/me/a.stl' is a path of one machine",
        ),
        (
            "MB704",
            f'<link name="a">{MESH.format("a")}{MESH.format("b")}</link>',
            "'file:///home/me/a.stl' is a path of one machine (and 1 more)",
        ),
        (
            "MB704",
            A + '<material name="m"><texture filename="file:///home/me/a.png"/></material>',
            "'file:///home/me/a.png' is a path of one machine",
        ),
        (
            "MB160",
            A + LIBRARY.format("gz-sim-imuu-system"),
            "no library of Gazebo is called 'gz-sim-imuu-system'; gz::sim::systems::Imu is in"
            " another one",
        ),
        ("MB160", A + LIBRARY.format("gz-sim-imu-system"), ""),
        *(
            (
                "MB637",
                A + LIBRARY.format("gz-sim-imu-system") + SENSOR.replace("imu", it),
                f"Gazebo simulates no sensor of type '{it}'" if it in ("ray", "lidar") else "",
            )
            for it in ("ray", "lidar", "gpu_ray", "gpu_lidar")
        ),
        (
            "MB406",
            A + CLASSIC_DRIVE,
            "without <odometry_frame> the plugin uses 'odom', the same for every robot",
        ),
        (
            "MB406",
            A + CLASSIC_DRIVE.replace("</pl", "<odometry_frame>a</odometry_frame></pl"),
            "",
        ),
        (
            "MB433",
            A + DRIVE,
            "without <child_frame_id> the frame is 'MODEL/a', which no robot has in tf",
        ),
        ("MB433", A + DRIVE.replace("</pl", "<child_frame_id>a</child_frame_id></pl"), ""),
        # Files of macros, of materials and for Webots need no link.
        *(
            ("MB502", it, said)
            for it, said in (
                ("", "the robot has no link"),
                ('<joint name="j" type="fixed"/>', "the robot has no link"),
                ('<material name="m"/><joint name="j" type="fixed"/>', "the robot has no link"),
                ('<material name="m"/><webots/>', ""),
            )
        ),
        ("MB221", A + JOINT.format("a ") + "</joint>", "parent@link is 'a ', the link is 'a'"),
        ("MB221", '<link name="a "/>' + JOINT.format("a ") + "</joint>", ""),
        ("MB515", A + JOINT.format("a") + LIMIT.format(1, 0), "joint 'j': velocity is 0"),
        (
            "MB515",
            A + JOINT.format("a") + LIMIT.format(0, 0),
            "joint 'j': effort and velocity are 0",
        ),
        ("MB515", A + JOINT.format("a") + LIMIT.format(1, 1), ""),
    ],
)
def test_what_is_said_of_a_description(code: str, text: str, said: str) -> None:
    whole = text if text.startswith("<sdf") else f'<robot name="r">{text}</robot>'
    found = lint_data("a.urdf", whole.encode(), Settings(select=(code,)))
    assert [it.message for it in found] == [said] * bool(said)


def limited(type_: str, lower: str, upper: str, rest: str = "") -> str:
    limit = f'<limit lower="{lower}" upper="{upper}" effort="1" velocity="1"/>'
    return (
        f'<link name="a"/><link name="b"/><joint name="j" type="{type_}"><parent link="a"/>'
        f'<child link="b"/>{limit}{rest}</joint>'
    )


SOFT = '<safety_controller soft_lower_limit="{}" soft_upper_limit="{}" k_velocity="1"/>'
INVERTED = "MB511 error lower=: joint 'j': lower 1 is above upper -1"
RADIANS = "MB170 warning {}=: revolute joint 'j' turns from {} to {} radians"
METRES = "MB517 warning {}=: prismatic joint 'j' goes from {} m to {} m"
WHOLE = "MB516 warning lower=: continuous joint 'j' ignores its limits {} to {}"
OUTSIDE = "MB532 note <safety_controller: joint 'j': the soft limits {} are outside of {}"
NO_RANGE = "MB532 warning <safety_controller: joint 'j': the soft limits {} leave no range"


@pytest.mark.parametrize(
    ("joint", "said"),
    [
        (limited("revolute", "-1", "1"), []),
        (limited("revolute", "1", "-1"), [INVERTED]),
        (limited("prismatic", "1", "-1"), [INVERTED]),
        # Before URDF 1.2 nobody reads those of other joints.
        (limited("continuous", "1", "-1"), []),
        (
            limited("revolute", "1", "1"),
            [
                "MB512 note <limit: revolute joint 'j' cannot move: lower and upper are 1",
            ],
        ),
        (limited("continuous", "1", "1"), []),
        (limited("continuous", "-1", "1"), [WHOLE.format("-1", "1")]),
        (limited("continuous", "0", "6.25"), [WHOLE.format("0", "6.25")]),
        # A turn but for a two hundredth is one.
        (limited("continuous", "0", "6.26"), []),
        (limited("prismatic", "0", "24.9"), []),
        (limited("prismatic", "0", "25"), [METRES.format("upper", "0", "25")]),
        (limited("prismatic", "-40", "0"), [METRES.format("lower", "-40", "0")]),
        # As far to both sides: a virtual joint. So far: no limit.
        (limited("prismatic", "-40", "40"), []),
        (limited("prismatic", "0", "10000"), []),
        (limited("revolute", "0", "14"), []),
        (limited("revolute", "0", "14.5"), [RADIANS.format("upper", "0", "14.5")]),
        (limited("revolute", "-90", "0"), [RADIANS.format("lower", "-90", "0")]),
        (limited("revolute", "-90", "90"), [RADIANS.format("upper", "-90", "90")]),
        (limited("revolute", "0", "720"), [RADIANS.format("upper", "0", "720")]),
        (limited("revolute", "0", "720.5"), []),
        # No round number, and those that stand for no limit.
        (limited("revolute", "0", "90.3"), []),
        *((limited("revolute", f"-{it}", it), []) for it in ("50", "100", "200", "500", "999")),
        (limited("revolute", "-1", "1", SOFT.format("-1", "1")), []),
        (
            limited("revolute", "-1", "1", SOFT.format("-2", "1")),
            [OUTSIDE.format("-2 to 1", "-1 to 1")],
        ),
        (
            limited("revolute", "-1", "1", SOFT.format("-1", "2")),
            [OUTSIDE.format("-1 to 2", "-1 to 1")],
        ),
        (limited("revolute", "-1", "1", SOFT.format("0", "0")), [NO_RANGE.format("0 to 0")]),
        (
            limited("revolute", "-1", "1", SOFT.format("1", "2")),
            [NO_RANGE.format("1 to 2"), OUTSIDE.format("1 to 2", "-1 to 1")],
        ),
        (limited("continuous", "-4", "4", SOFT.format("0", "0")), []),
        (
            limited("revolute", "-1", "1", "<dynamics/>"),
            ["MB534 error <dynamics/>: <dynamics> of joint 'j' has neither damping nor friction"],
        ),
        (limited("revolute", "-1", "1", '<dynamics damping="0"/>'), []),
        (limited("revolute", "-1", "1", '<dynamics friction="0"/>'), []),
    ],
)
def test_what_is_said_of_limits(joint: str, said: list[str]) -> None:
    """Code, level, what is at its place, and message."""
    body = "<visual/>"
    text = f'<robot name="r">{joint}</robot>'.replace('"b"/><joint', f'"b">{body}</link><joint')
    codes = ("MB170", "MB511", "MB512", "MB516", "MB517", "MB532", "MB534")
    found = lint_data("a.urdf", text.encode(), Settings(select=codes))
    assert sorted(
        f"{it.code} {it.level} {text[it.column - 1 :].split()[0].partition('=')[0].partition('</')[0]}"
        f"{'' if text[it.column - 1] == '<' else '='}: {it.message}"
        for it in found
    ) == sorted(said)


@pytest.mark.parametrize(
    ("version", "static", "values", "said"),
    [
        ("1.9", "", "<ixx>1</ixx>", []),
        # What is left out is 1, and 0 beside the diagonal.
        ("1.9", "", "<ixx>3</ixx>", ["error inertia of link 'a' "]),
        ("1.9", "", "<ixx>0</ixx><iyy>0</iyy><izz>0</izz>", ["error inertia of link 'a' is 0"]),
        ("1.9", "", "<ixx>-1</ixx>", ["error inertia of link 'a' "]),
        # Gazebo Classic goes on, and takes nothing of a static model.
        ("1.6", "", "<ixx>3</ixx>", ["warning inertia of link 'a' "]),
        ("1.6", "<static>1</static>", "<ixx>3</ixx>", ["note inertia of link 'a' "]),
        ("1.6", "<static> true </static>", "<ixx>3</ixx>", ["note inertia of link 'a' "]),
        ("1.6", "<static>false</static>", "<ixx>3</ixx>", ["warning inertia of link 'a' "]),
        ("1.9", "<static>true</static>", "<ixx>3</ixx>", ["error inertia of link 'a' "]),
    ],
)
def test_the_inertia_of_a_link_of_a_model(
    version: str, static: str, values: str, said: list[str]
) -> None:
    text = (
        f'<sdf version="{version}"><model name="m">{static}<link name="a"><inertial><mass>1</mass>'
        f"<inertia>{values}</inertia></inertial></link></model></sdf>"
    )
    found = lint_data("a.sdf", text.encode(), Settings(select=("MB606",), distro="jazzy"))
    assert len(found) == len(said)
    assert all(
        f"{it.level} {it.message}".startswith(one) for it, one in zip(found, said, strict=True)
    )


@pytest.mark.parametrize(
    ("text", "rest"),
    [
        ('<robot><link name="a"/><b/></robot>', "<b/></robot>"),
        ('<robot><link name="a"></link ><b/></robot>', "<b/></robot>"),
        ('<robot><link name="a"><c/></link>b</robot>', "b</robot>"),
        ("<robot><link><c><link/></c></link><b/></robot>", "<b/></robot>"),
        # An end tag in a comment is none.
        ("<robot><link><c/><!-- </link> --></link><b/></robot>", "<b/></robot>"),
        ("<robot><link><!-- </link> --><!-- </link> --></link></robot>", "</robot>"),
    ],
)
def test_where_an_element_ends(text: str, rest: str) -> None:
    document = read_document(text.encode(), "a.urdf")
    link = document.root[0]
    assert text[convert.end_of(convert.text_of(document), link) :] == rest
