# SPDX-License-Identifier: Apache-2.0
"""The robot's own model in values, frames that code makes, and plugins that nothing loads."""

from __future__ import annotations

import pytest

from multibot_rewrite import MultibotError, ProofError, rewrite, rewrite_all, strip
from multibot_rewrite.base.naming import LAYOUTS

BODY = """<link name="base"/><link name="w"/><joint name="j" type="continuous">
<parent link="base"/><child link="w"/></joint>"""
JOINT = """<gazebo><plugin filename="gz-sim-detachable-joint-system"
 name="gz::sim::systems::DetachableJoint"><parent_link>base</parent_link><child_model>{}</child_model>
<child_link>w</child_link><detach_topic>d</detach_topic></plugin></gazebo>"""


def robot(inside: str, body: str = BODY) -> str:
    return f'<robot name="r">{body}{inside}</robot>'


@pytest.mark.parametrize("layout", ["postfix", "frames-per-robot", "both"])
@pytest.mark.parametrize(("model", "is_own"), [("r", True), ("__model__", True), ("box", False)])
def test_a_link_of_the_own_model_is_renamed_with_it(model: str, is_own: bool, layout: str) -> None:
    """DetachableJoint.cc:275: a link of that name in child_model."""
    text = rewrite(robot(JOINT.format(model)), "robot1", layout=layout).text
    assert ("<child_link>w</child_link>" not in text) == is_own


WAVES = """<gazebo><plugin filename="gz-waves1-hydrodynamics-system" name="h">
<enable>{}</enable></plugin>
</gazebo>"""
CONTAIN = """<gazebo><plugin name="c" filename="libContainPlugin.so"><entity>{}</entity>
<namespace>c</namespace></plugin></gazebo>"""


@pytest.mark.parametrize("plugin", [CONTAIN, WAVES], ids=["contain", "waves"])
@pytest.mark.parametrize(
    ("entity", "model"),
    [("r::base", "r_robot1"), ("other::base", "r"), ("base", "r")],
)
def test_the_own_model_in_front_of_a_link_is_another_one_for_each_robot(
    entity: str, model: str, plugin: str
) -> None:
    """ContainPlugin.cc:100 looks it up in the world, where each robot has a name of its own;
    asv_wave_sim's Hydrodynamics.cc, IsEnabled compares it with the scoped name of each link."""
    made = rewrite(robot(plugin.format(entity)), "robot1", layout="tf-per-robot")
    assert "1 name looked up in the whole world" not in made.not_verified
    assert f'<robot name="{model}">' in made.text
    assert f">{entity.replace('r::', f'{model}::', 1)}<" in made.text.replace("other_", "")


OWN = [
    JOINT.format("r"),
    CONTAIN.format("r::base"),
    """<gazebo><plugin filename="gz-sim-triggered-publisher-system"
 name="gz::sim::systems::TriggeredPublisher"><input type="a" topic="/model/r/odometry"/>
<output type="b" topic="/x"/></plugin></gazebo>""",
]


@pytest.mark.parametrize("layout", [it.name for it in LAYOUTS])
@pytest.mark.parametrize("text", OWN, ids=["child_model", "entity", "topic"])
def test_a_value_with_the_own_model_has_the_name_of_the_model(text: str, layout: str) -> None:
    """Both are what the spawner gives; the undo finds them without the source."""
    made = rewrite(robot(text), "robot1", layout=layout)
    model = "robot1_r" if layout == "frame-prefix" else "r_robot1"
    assert f'<robot name="{model}">' in made.text and made.text.count(model) == 2
    assert strip(made.data, "robot1", layout=layout) == robot(text).encode()


HAND = """<gazebo><plugin name="h" filename="libgazebo_ros_hand_of_god.so"><ros/>
<link_name>base</link_name>{}</plugin></gazebo>"""


@pytest.mark.parametrize("layout", [it.name for it in LAYOUTS])
@pytest.mark.parametrize("frame", ["", "world", "hand"])
def test_frames_that_code_makes_of_a_parameter(frame: str, layout: str) -> None:
    """gazebo_ros_hand_of_god.cpp:109 <value>_desired and <value>_actual, of world by default; :136 its
    listener is a node of its own on /tf."""
    given = f"<frame_id>{frame}</frame_id>" if frame else ""
    made = rewrite(robot(HAND.format(given)), "robot1", layout=layout)
    apart = frame == "hand" and layout != "tf-per-robot"
    assert (made.not_verified == ()) == apart


PLUGIN = """<plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
<left_joint>j</left_joint></plugin>"""
CONTROL = """<ros2_control name="a" type="system"><hardware>
<plugin>mock_components/GenericSystem</plugin></hardware>{}</ros2_control>"""


@pytest.mark.parametrize("layout", [it.name for it in LAYOUTS])
@pytest.mark.parametrize(
    "text",
    [
        robot(PLUGIN),
        robot("", BODY.replace('<link name="w"/>', f'<link name="w">{PLUGIN}</link>')),
        robot(CONTROL.format(PLUGIN)),
        robot('<gazebo><plugin name="gazebo_ros_control"/></gazebo>'),
    ],
    ids=["robot", "link", "ros2_control", "no library"],
)
def test_a_plugin_outside_of_gazebo_is_reported(text: str, layout: str) -> None:
    (one, _) = rewrite_all(text, ["robot1", "robot2"], layout=layout)
    found = [it for it in one.findings if it.code == "MB112"]
    assert len(found) == 1 and ("filename" if "gazebo_ros" in text else "<gazebo>") in found[0].hint
    assert "plugin not known" not in " ".join(one.not_verified)
    assert "multibot robot1" not in one.text
    inside = rewrite(robot(f"<gazebo>{PLUGIN}</gazebo>"), "robot1", layout=layout)
    assert "MB112" not in {it.code for it in inside.findings}


@pytest.mark.parametrize("affix", ["postfix", "prefix"])
def test_a_rewrite_for_another_robot_is_told(affix: str) -> None:
    """Also where nothing was inserted: every link has the name behind or before its slash."""
    first = rewrite(robot(""), "robot1", affix=affix).text
    assert [it.code for it in rewrite(robot(""), "robot2").findings] == []
    assert [it.code for it in rewrite(first, "robot2", affix=affix).findings] == ["MB106"]
    assert [it.code for it in rewrite(first.replace("robot1", "a_b"), "r2").findings] == ["MB106"]
    one_other = first.replace(">", '><link name="lidar"/>', 1)
    assert "MB106" not in [it.code for it in rewrite(one_other, "robot2", affix=affix).findings]


@pytest.mark.parametrize("name", ["{", "{robot", "}", "{robot}", "{model}", "{{robot}}"])
def test_braces_in_names_end_no_rewrite(name: str) -> None:
    plugin = f"""<gazebo><plugin filename="libgazebo_ros_diff_drive.so" name="{name}"><ros>
<namespace>{name}</namespace><remapping>odom:={name}</remapping></ros></plugin></gazebo>"""
    for text in (robot(plugin), robot("", BODY.replace("base", name))):
        try:
            assert rewrite(text, "robot1").text
        except MultibotError as error:
            assert not isinstance(error, ProofError)
