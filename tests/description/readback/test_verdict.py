# SPDX-License-Identifier: Apache-2.0
"""What a rewrite is called: verified, or not and why."""

from __future__ import annotations

from pathlib import Path

import pytest
from paths import ROBOTS
from postfix_command import run

from multibot_rewrite import RewriteRefused, rewrite, rewrite_all
from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.description.checks.meeting import REASONS, not_verified

LIDAR = """<robot name="r"><link name="a"/><gazebo reference="a">
<sensor name="lidar" type="gpu_lidar"><topic>{}</topic></sensor></gazebo></robot>"""
DRIVE = """<robot name="r"><link name="a"/><gazebo>
<plugin name="drive" filename="libgazebo_ros_diff_drive.so"><ros><namespace>{}</namespace></ros>
</plugin></gazebo></robot>"""


INCLUDED = "<gazebo><include><uri>model://x</uri></include></gazebo>"
BELOW_MODEL = """<robot name="r"><link name="a"/><gazebo>
<plugin name="l" filename="librotors_gazebo_lidar_plugin.so"/></gazebo></robot>"""
CLASS = 'name="a::Arm" filename="libacme_arm.so"'
UNKNOWN = ("1 plugin not known", "1 description the same for all robots")
NO_LINK = ("1 robot without a link",)


def of(*codes: str) -> tuple[str, ...]:
    return not_verified(Finding(code, "warning", "x") for code in codes)


@pytest.mark.parametrize(
    ("codes", "why"),
    [
        ((), ()),
        (("MB405", "MB301"), ()),
        (("MB901",), ("1 name not understood",)),
        (("MG320", "MB901", "MG320"), ("1 name not understood", "2 topics shared by all robots")),
        (("MG301", "MG402"), ("1 node shared by all robots", "1 frame shared by all robots")),
        (("MB902", "MB903"), ("1 plugin not known", "1 hardware class not known")),
    ],
)
def test_reasons_with_counts(codes: tuple[str, ...], why: tuple[str, ...]) -> None:
    assert of(*codes) == why


SIMULATED = (
    '<robot name="r"><link name="a"/><gazebo><plugin name="p" filename="{}"/></gazebo></robot>'
)


# What a summary says of two findings with a code.
SAID = {
    "MB901": "2 names not understood",
    "MB219": "2 models not known",
    "MB902": "2 plugins not known",
    "MB903": "2 hardware classes not known",
    "MB906": "2 included models not read",
    "MG320": "2 topics shared by all robots",
    "MG310": "2 commands shared by all robots",
    "MG305": "2 services shared by all robots",
    "MG301": "2 nodes shared by all robots",
    "MG402": "2 frames shared by all robots",
    "MB412": "2 resources shared by all robots",
    "MB437": "2 descriptions the same for all robots",
    "MB438": "2 topics whose ends no longer match",
    "MB502": "2 robots without a link",
    "MB425": "2 names looked up in the whole world",
    "MB410": "2 description names shared by all robots",
    "MB416": "2 world systems in every robot",
    "MB436": "2 remap rules matching no name any more",
    "MB426": "2 remap rules of the whole process",
    "MB143": "2 frames that an argument of the xacro misses",
    "MB422": "2 prefix parameters that no postfix reaches",
    "MB430": "2 topics below each robot's namespace that all should share",
    "MB428": "2 names fixed in a plugin's code",
    "MB429": "2 model namespaces that not every Gazebo reads",
}


def test_every_reason_has_its_words() -> None:
    assert {code: of(code, code) for code in SAID} == {code: (it,) for code, it in SAID.items()}
    assert SAID.keys() == REASONS.keys()


def test_every_reason_is_a_warning_of_a_rewrite() -> None:
    """--fail-on warning stops at warnings: a reason below would pass."""
    from multibot_rewrite.lint.catalogue import rules
    from multibot_rewrite.lint.registry import RULES

    known = {**rules(), **RULES}
    assert {code for code in REASONS if known[code].level not in ("warning", "note")} == set()


@pytest.mark.parametrize(
    ("text", "why"),
    [
        (LIDAR.format("scan"), ()),
        (LIDAR.format("{name}/scan"), ("1 topic shared by all robots",)),
        # gz-sim Contact.cc and Classic's ContactSensor.cc read the topic in <contact> alone: without
        # one it is below the model, whose name the spawner gives.
        (LIDAR.format("{name}/scan").replace("gpu_lidar", "contact"), ()),
        (LIDAR.format("x").replace("<topic>x</topic>", ""), ()),
        (BELOW_MODEL, ()),
        # A system's @name is its class, of which no node is called.
        (
            DRIVE.format("x").replace('name="drive" filename="libgazebo_ros_diff_drive.so"', CLASS),
            UNKNOWN,
        ),
        # A <link> of a plugin is no link of the robot.
        (LIDAR.format("x").replace('<link name="a"/>', "<own><link>a</link></own>"), NO_LINK),
        # webots_ros2_driver WebotsNode.cpp reads <webots>; the links are the world's.
        (
            '<robot name="r"><webots><plugin type="webots_ros2_driver::Ros2IMU"/></webots></robot>',
            (),
        ),
        # urdfdom's parsers read no <parent> that is in no joint.
        ('<robot name="r"><link name="a"/><parent link="a"/></robot>', ()),
        # MulticopterMotorModel.cc: below the model's name; LiftDragPlugin.cc opens what values name.
        (SIMULATED.format("gz-sim-multicopter-motor-model-system"), ()),
        (SIMULATED.format("libLiftDragPlugin.so"), ()),
        # Its links are those of the model that it includes (x500 of PX4).
        (LIDAR.format("x").replace('<link name="a"/>', INCLUDED), ("1 included model not read",)),
        (DRIVE.format("demo"), ()),
        (DRIVE.format(""), ()),
        (DRIVE.format("<!-- c -->demo"), ()),
        (
            DRIVE.format("{name}"),
            ("1 command shared by all robots", "1 node shared by all robots"),
        ),
        # sdformat plugin.sdf: without a filename nothing is loaded.
        (LIDAR.format("x").replace("<sensor", '<plugin name="gazebo_ros_control"/><sensor'), ()),
    ],
)
def test_a_rewrite_says_why_it_is_not_proved(text: str, why: tuple[str, ...]) -> None:
    assert rewrite(text, "robot1", layout="tf-per-robot").not_verified == why


@pytest.mark.parametrize(
    ("distro", "why"), [("", ("1 topic shared by all robots",)), ("humble", ())]
)
def test_ros_2_loads_no_plugin_that_gazebo_ros_pkgs_had_for_ros_1(
    distro: str, why: tuple[str, ...]
) -> None:
    """The branch ros2 of gazebo_ros_pkgs has no gazebo_ros_skid_steer_drive; ROS 1's sends on /tf."""
    text = DRIVE.replace("gazebo_ros_diff", "gazebo_ros_skid_steer")
    text = text.replace("<ros><namespace>{}</namespace></ros>", "<broadcastTF>true</broadcastTF>")
    made = rewrite(text, "robot1", layout="tf-per-robot", distro=distro)
    assert made.not_verified == why
    assert ("MB112" in {it.code for it in made.findings}) == bool(distro)


@pytest.mark.parametrize(
    ("layout", "shared"), [("postfix", ()), ("tf-per-robot", ("1 resource shared by all robots",))]
)
def test_images_of_a_camera_begin_with_its_name(layout: str, shared: tuple[str, ...]) -> None:
    """gz-sensors CameraSensor.cc: saveImagePrefix is the sensor's name."""
    text = LIDAR.format("x").replace("gpu_lidar", "camera").replace("<topic>x</topic>", "{}")
    text = text.format("<camera><save enabled='true'><path>/tmp/a</path></save></camera>")
    assert rewrite(text, "robot1", layout=layout).not_verified == shared


def test_ros_1_gives_no_plugin_a_node_of_its_own() -> None:
    """uuv_simulator has them for ROS 1, Plankton for ROS 2, which reads the <ros> that is inserted."""
    text = DRIVE.replace("gazebo_ros_diff_drive", "gazebo_ros_control").format("x")
    text = text.replace("<ros><namespace>x</namespace></ros>", "")
    uuv = '<gazebo><plugin name="{0}" filename="libuuv_{0}_plugin.so">{1}</plugin></gazebo></robot>'
    space = "<robot_namespace>a</robot_namespace><link_name>a</link_name>"
    for plugin in (("gazebo_ros_gps", space), ("underwater_object_ros", "")):
        text = text.replace("</robot>", uuv.format(*plugin))
    found = rewrite(text, "robot1", layout="tf-per-robot").findings
    assert "MG301" not in {it.code for it in found}


def test_a_sensor_below_its_own_model_is_no_other_robots() -> None:
    """kobuki's plugin looks for the bumper in the world, and for world::model::base_footprint::imu
    (kobuki_gazebo_plugins gazebo_ros_kobuki_loads.cpp)."""
    names = "<imu_name>imu</imu_name><bumper_name>bumper</bumper_name>"
    sensors = '<sensor name="imu" type="imu"/><sensor name="bumper" type="contact"/>'
    text = DRIVE.replace("gazebo_ros_diff_drive", "gazebo_ros_kobuki").format("x")
    text = text.replace("<ros><namespace>x</namespace></ros>", names)
    text = text.replace("</robot>", f'<gazebo reference="a">{sensors}</gazebo></robot>')
    found = rewrite(text, "robot1", layout="frame-prefix").findings
    assert ["'bumper'" in it.message for it in found if it.code == "MB425"] == [True]


@pytest.mark.more
def test_the_summary_and_strict(tmp_path: Path) -> None:
    file, out = tmp_path / "r.urdf", tmp_path / "out.urdf"
    file.write_text(LIDAR.format("{name}/scan"))
    done = run(tmp_path, "r.urdf", "robot1", "-o", str(out))
    assert done.code == 0
    end = ". Not verified: 1 topic shared by all robots (ROS 2 lyrical)\n"
    assert done.err.endswith(end)
    out.unlink()
    stopped = run(tmp_path, "r.urdf", "robot1", "-o", str(out), "--fail-on", "warning")
    assert stopped.code == 1
    assert not out.exists()
    assert "erified" not in stopped.err
    healthy = run(
        tmp_path, str(ROBOTS / "rover.urdf"), "robot1", "-o", str(out), "--fail-on", "warning"
    )
    assert healthy.code == 0
    assert healthy.err.endswith(". Verified (ROS 2 humble: it loads libgazebo_ros_diff_drive.so)\n")


@pytest.mark.more
def test_what_is_not_shown_is_a_reason_all_the_same(tmp_path: Path) -> None:
    file = tmp_path / "r.urdf"
    file.write_text(LIDAR.format("{name}/scan"))
    quiet = run(tmp_path, "r.urdf", "robot1", "-o", str(tmp_path / "o"), "--ignore", "MG320")
    assert "MG320" not in quiet.err
    assert "Not verified: 1 topic" in quiet.err


# odom of left_b and odom_left of b are both odom_left_b; the first is a default that was inserted.
OVERLAP = """<robot name="r"><link name="a"/>
<gazebo><plugin name="p" filename="libgazebo_ros_diff_drive.so">
<publish_odom>true</publish_odom><ros/></plugin></gazebo>
<gazebo><plugin name="q" filename="libgazebo_ros_planar_move.so">
<ros><remapping>odom:=odom_left</remapping></ros></plugin></gazebo></robot>"""


def test_two_robots_that_meet_in_what_was_inserted_are_refused() -> None:
    with pytest.raises(RewriteRefused) as refused:
        list(rewrite_all(OVERLAP, ["left_b", "b"], separators={"topic": "_"}))
    (finding,) = refused.value.findings
    assert finding.code == "MG320"
    assert "left_b and b would both have the topic '/odom_left_b'" in finding.message
    assert len(list(rewrite_all(OVERLAP, ["left_b", "c"], separators={"topic": "_"}))) == 2
    assert len(list(rewrite_all(OVERLAP, ["left_b", "b"]))) == 2


def test_what_all_robots_share_is_no_refusal_of_two() -> None:
    """It is a warning however the robots are called."""
    text = LIDAR.format("{name}/scan")
    first, second = rewrite_all(text, ["left_b", "b"], separators={"topic": "_"})
    assert first.not_verified == second.not_verified == ("1 topic shared by all robots",)
