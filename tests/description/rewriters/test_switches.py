# SPDX-License-Identifier: Apache-2.0
"""Switches of plugins: as sdformat reads booleans (src/Param.cc, ValueFromStringImpl)."""

from __future__ import annotations

import pytest
from lxml import etree

from multibot_rewrite import rewrite
from multibot_rewrite.description.rewriters.switches import is_false, is_true

PLUGIN = """<robot name="a"><link name="l"/><joint name="j" type="fixed"/><gazebo>
<plugin filename="gz-sim-joint-controller-system" name="gz::sim::systems::JointController">
<joint_name>j</joint_name><use_actuator_msg>{}</use_actuator_msg></plugin></gazebo></robot>"""


@pytest.mark.parametrize("text", ["false", "False", "FALSE", "0", " 0 "])
def test_off(text: str) -> None:
    assert is_false(text)
    assert not is_true(text)


@pytest.mark.parametrize(
    ("text", "inserted"), [("True", True), (" 1 ", True), ("false", False), ("yes", False)]
)
def test_a_default_that_depends_on_a_switch(text: str, inserted: bool) -> None:
    root = etree.fromstring(rewrite(PLUGIN.format(text), "robot1").data)
    assert (root.findtext(".//plugin/topic") == "/actuators/robot1") == inserted
