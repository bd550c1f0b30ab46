# SPDX-License-Identifier: Apache-2.0
"""What a join must not make: a joined text with a fault planted in it is no proof's."""

from __future__ import annotations

import pytest
from lxml import etree
from paths import fixture_text

from multibot_rewrite import ProofError
from multibot_rewrite.description.joining.join import GivenPart, join_texts
from multibot_rewrite.description.joining.part import Part
from multibot_rewrite.description.joining.second_reading import check_read, prove
from multibot_rewrite.description.rewriters.tree import builtin_tree

BASE = """<robot name="base">
  <material name="grey"><color rgba="1 1 1 1"/></material>
  <link name="base"/><link name="plate"/>
  <joint name="up" type="fixed"><parent link="base"/><child link="plate"/></joint>
  <gazebo>
    <plugin filename="gz_ros2_control-system" name="c"><parameters>a</parameters></plugin>
  </gazebo>
</robot>
"""
ARM = fixture_text("join_proof_arm.urdf")
STAND = """<robot name="stand">
  <link name="world"/><link name="pole"/>
  <joint name="world" type="fixed">
    <origin xyz="1 0 0"/><parent link="world"/><child link="pole"/>
  </joint>
</robot>
"""
TREE = builtin_tree((), "jazzy")
PARTS = (
    Part(BASE, name="base"),
    Part(ARM, "plate", (0, 0, 0.5, 0, 0, 1), "a_", "arm"),
    Part(STAND, "plate", (0, 1, 0, 0, 0, 0), "s_", "stand"),
)
MADE = join_texts([GivenPart(it, str(it.description).encode(), it.name) for it in PARTS], TREE)
# What is changed in the joined text.
FAULTS = {
    "a mount at another pose": ("0 0 0.5", "0 0 0.6"),
    "a mount that turns": ('rpy="0 0 1"', 'rpy="0 0 1.1"'),
    "a mount on another link": ('<parent link="plate"/>\n    <child link="a_foot"/>', None),
    "a mount that moves": ('"arm_mount" type="fixed"', '"arm_mount" type="continuous"'),
    "a joint inside that changed": ('xyz="0 0 1"/><parent', 'xyz="0 0 2"/><parent'),
    "a joint inside of another type": ('"a_turn" type="continuous"', '"a_turn" type="fixed"'),
    "a mass that changed": ('mass value="2"', 'mass value="3"'),
    "a transmission that is gone": (
        '<transmission name="a_t"><joint name="a_turn"/></transmission>',
        "",
    ),
    "a block of a link that is gone": (
        '<gazebo reference="a_hand"><mu1>1</mu1></gazebo>',
        "",
    ),
    "a name without its prefix": ('child link="a_hand"', 'child link="hand"'),
    "a link twice": ('<link name="a_hand"/>', '<link name="a_hand"/><link name="a_hand"/>'),
    "a link that nobody gave": (" -->\n</robot>", ' -->\n<link name="new"/></robot>'),
    "a joint on the world on another link": (
        '<parent link="plate"/><child link="s_pole"/>',
        '<parent link="base"/><child link="s_pole"/>',
    ),
    "a joint on the world elsewhere": ('xyz="1 1 0', 'xyz="1 2 0'),
    "parameters that are gone": ("<parameters>b</parameters>", ""),
    "a material that is gone": ('<material name="grey"><color rgba="1 1 1 1"/></material>', ""),
}


def test_the_joined_text_is_proved() -> None:
    prove(MADE.data, MADE.parts, TREE)
    check_read(etree.fromstring(MADE.data), MADE.parts)


@pytest.mark.parametrize("name", FAULTS)
def test_the_second_reading_finds_it(name: str) -> None:
    old, new = FAULTS[name]
    new = old.replace("plate", "base") if new is None else new
    assert MADE.data.decode().count(old) in (1, 2), old
    with pytest.raises(ProofError):
        check_read(etree.fromstring(MADE.data.decode().replace(old, new, 1)), MADE.parts)


def test_a_loop_is_no_tree() -> None:
    loop = MADE.data.decode().replace(
        '<parent link="base"/><child link="plate"/>', '<parent link="a_hand"/><child link="plate"/>'
    )
    with pytest.raises(ProofError):
        check_read(etree.fromstring(loop), MADE.parts)


# Of these no reader knows: only the bytes are others.
HIDDEN = {
    "a kept text that changed": ("multibot was 0 <material", "multibot was 0  <material"),
    "a blank more in a part": ('<link name="a_hand"/>', '<link name="a_hand" />'),
    "a head that changed": ('<robot name="arm">', '<robot name="arn">'),
    "a tail that changed": ("multibot end arm </robot>", "multibot end arm </robot >"),
    "a kept element that is shown": ("multibot was 1  -->", "multibot was 0  -->"),
    "a part under another prefix": ("arm prefix=a_", "arm prefix=b_"),
    "a blank more in the first part": ('<link name="base"/>', '<link name="base" />'),
}


@pytest.mark.parametrize("name", HIDDEN)
def test_the_bytes_of_each_part_find_it(name: str) -> None:
    old, new = HIDDEN[name]
    assert old in MADE.data.decode()
    with pytest.raises(ProofError):
        prove(MADE.data.decode().replace(old, new, 1).encode(), MADE.parts, TREE)
