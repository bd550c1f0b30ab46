# SPDX-License-Identifier: Apache-2.0
"""A user may write what stands for names in plugin definitions: then it is text like any other."""

from __future__ import annotations

import pytest

from multibot_rewrite import MultibotError, ProofError, rewrite, rewrite_all, strip
from multibot_rewrite.base.naming import LAYOUTS

WORDS = (
    *("{model}", "{model}/", "{model}/odom", "{link}", "{sensor}", "{robot}", "{name}", "{topic}"),
    *("{camera_name}", "{path:type}", "{", "}", "{}", "{{model}}", "a{link}b", "$", "ROBOT", "~"),
)
URDF = """<robot name="{word}"><link name="{word}"/><link name="w"/>
<joint name="j" type="continuous"><parent link="{word}"/><child link="w"/></joint>
<gazebo><plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
<left_joint>j</left_joint><odom_topic>{word}</odom_topic></plugin></gazebo>
<gazebo reference="w"><sensor name="{word}" type="camera"><topic>{word}</topic>
<plugin filename="libgazebo_ros_camera.so" name="{word}"><ros/><camera_name>{word}</camera_name>
</plugin></sensor></gazebo></robot>"""
SDF = """<sdf version="1.9"><model name="{word}"><link name="{word}">
<sensor name="{word}" type="imu"/></link>
<plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive"/></model></sdf>"""


@pytest.mark.parametrize("layout", [it.name for it in LAYOUTS])
@pytest.mark.parametrize("text", [URDF, SDF], ids=["urdf", "sdf"])
@pytest.mark.parametrize("word", WORDS)
def test_a_placeholder_of_a_user_is_a_text(word: str, text: str, layout: str) -> None:
    source = text.replace("{word}", word)
    try:
        (one, _) = rewrite_all(source, ["robot1", "robot2"], layout=layout)
    except ProofError:
        raise
    except MultibotError:
        return  # refused with a reason
    assert strip(one.text, "robot1", layout=layout).decode() == source


def test_a_frame_called_as_the_slot_of_the_model_is_one_of_the_file() -> None:
    """DiffDrive's default frames are below the spawned name; a link {model}/odom is none of them."""
    text = URDF.replace("{word}", "{model}")
    assert rewrite(text, "robot1").changes
    old = [it.old for it in rewrite(text, "robot1").changes if it.rule == "inserted"]
    assert "{model}/odom" in old


def test_a_substitution_in_a_text_of_sdf_is_a_text() -> None:
    """sdformat reads ${} as it stands; in a file of xacro, or with arguments, it is one of xacro."""
    material = "<visual name='v'><material>c${}</material></visual>"
    text = f'<sdf version="1.9"><model name="m"><link name="l">{material}</link></model></sdf>'
    assert rewrite(text, "robot1").not_verified == ()
