# SPDX-License-Identifier: Apache-2.0
"""Names that a consumer makes of another element, as its source says: a rewrite that loses them, or
that leaves one for all robots, is not verified."""

from __future__ import annotations

import pytest

from multibot_rewrite import rewrite

CAMERA = """<sdf version="1.9"><model name="rover"><link name="base">
<sensor name="c" type="camera"><topic>{}</topic></sensor></link></model></sdf>"""
MODEL = """<sdf version="1.9"><model name="rover"><link name="base"/><link name="lid"/>
<joint name="j" type="revolute"><parent>base</parent><child>lid</child></joint>
<plugin filename="gz-sim-{}-system" name="gz::sim::systems::{}">{}</plugin></model></sdf>"""


def codes(text: str, **options: str) -> list[str]:
    return [it.code for it in rewrite(text, "r1", distro="jazzy", **options).findings]


@pytest.mark.parametrize(
    ("topic", "options", "found"),
    [
        # camera_common.cpp getCameraInfoTopic: the last segment of the image's topic is replaced.
        ("/cam/image", {}, ["MB439"]),
        ("/cam/image", {"topics": "prefix"}, []),
        ("/cam/image", {"topics": "namespace"}, []),
        ("/cam/image", {"layout": "both"}, []),
    ],
)
def test_a_camera_keeps_its_info_beside_its_image(
    topic: str, options: dict[str, str], found: list[str]
) -> None:
    assert codes(CAMERA.format(topic), **options) == found


def test_what_is_found_of_any_robot_is_said_with_the_name_of_the_first() -> None:
    (said,) = rewrite(CAMERA.format("/cam/image"), "left", distro="jazzy").findings
    assert "/cam/image/left" in said.message and "/cam/camera_info/left" in said.hint


@pytest.mark.parametrize(
    ("name", "class_", "parameters"),
    [
        ("thruster", "Thruster", "<namespace/><joint_name>j</joint_name>"),
        ("buoyancy-engine", "BuoyancyEngine", "<namespace></namespace><link_name>base</link_name>"),
        (
            "multicopter-motor-model",
            "MulticopterMotorModel",
            "<robotNamespace/><jointName>j</jointName><linkName>lid</linkName>",
        ),
    ],
)
def test_an_empty_word_is_no_robots(name: str, class_: str, parameters: str) -> None:
    """HasElement is true for it, so it takes the model's place in the topics."""
    text = MODEL.format(name, class_, parameters)
    assert "MG320" in codes(text)
    full = text.replace("<namespace/>", "").replace("<namespace></namespace>", "")
    assert "MG320" not in codes(full.replace("<robotNamespace/>", ""))


def test_the_state_of_a_detachable_joint_is_of_one_robot() -> None:
    """DetachableJoint.cc: /model/<child_model>/detachable_joint/state, and the child is the world's."""
    child = "<child_model>box</child_model><child_link>l</child_link>"
    text = MODEL.format(
        "detachable-joint", "DetachableJoint", f"<parent_link>base</parent_link>{child}"
    )
    own = "<output_topic>/model/box/detachable_joint/state/r1</output_topic>"
    assert own in rewrite(text, "r1", distro="jazzy").text


def test_a_light_is_looked_up_in_the_whole_world() -> None:
    led = "<led name='a'><visual_name>base::v</visual_name></led>"
    text = MODEL.format("led-plugin", "LedPlugin", led)
    assert codes(text) == []
    assert codes(text, layout="tf-per-robot") == ["MB425"]


@pytest.mark.parametrize("where", ["input", "output"])
def test_a_name_in_a_message_is_a_mention(where: str) -> None:
    """TriggeredPublisher.cc parses the text as a message: what it names is not known."""
    given = {"input": ("<match>frame: 'base'</match>", ""), "output": ("", "frame: 'base'")}[where]
    ends = '<input type="t" topic="a">{}</input><output type="t" topic="b">{}</output>'
    text = MODEL.format("triggered-publisher", "TriggeredPublisher", ends.format(*given))
    assert codes(text) == ["MB901"]
    assert codes(text.replace("'base'", "'other'")) == []


UUV = """<robot name="r"><link name="base"/><gazebo>
<plugin name="p" filename="libuuv_joint_state_publisher.so">{}</plugin></gazebo></robot>"""


def test_nothing_of_ros_2_is_inserted_into_what_reads_none_of_it() -> None:
    """JointStatePublisher.cc of uuv_simulator: robotNamespace, and no <ros>."""
    old = UUV.format("<robotNamespace>r</robotNamespace><updateRate>5</updateRate>")
    for layout in ("postfix", "both", "tf-per-robot"):
        assert "<ros>" not in rewrite(old, "robot1", layout=layout).text
    made = rewrite(old, "robot1")
    assert "<robotNamespace>r_robot1</robotNamespace>" in made.text
    assert made.not_verified == ()
    made = rewrite(old, "robot1", layout="both")
    assert "<robotNamespace>robot1/r</robotNamespace>" in made.text
    assert made.not_verified == ()


@pytest.mark.parametrize("layout", ["frame-prefix", "frames-per-robot"])
def test_a_frame_that_is_fixed_in_code_is_shared_on_one_tf(layout: str) -> None:
    """kobuki's plugin sends odom -> base_footprint on /tf whatever its file says
    (kobuki_gazebo_plugins gazebo_ros_kobuki_loads.cpp)."""
    text = (
        '<robot name="k"><link name="base_footprint"/><gazebo>'
        '<plugin name="k" filename="libgazebo_ros_kobuki.so"/></gazebo></robot>'
    )
    made = rewrite(text, "r1", layout=layout, distro="humble")
    assert made.not_verified and "MG402" in {it.code for it in made.findings}


def test_a_rule_that_ros_1_does_not_read_keeps_nothing_apart() -> None:
    """LinearBatteryROSPlugin.cc of uuv_simulator advertises battery_state below its <namespace>; only
    its successor in Plankton, for ROS 2, reads rules."""
    text = (
        '<robot name="auv"><link name="base"/><gazebo>'
        '<plugin name="b" filename="liblinear_battery_ros_plugin.so"><namespace>/</namespace>'
        "<link_name>base</link_name></plugin></gazebo></robot>"
    )
    assert "MG320" in codes(text)
    assert codes(text, layout="both") == []
