# SPDX-License-Identifier: Apache-2.0
"""A topic that one system of gz-sim makes of names and another one is told as a text is one topic.

What the thruster listens to is said here as gz-sim's Thruster.cc does: ``/model/``, the namespace or
the name of the model, ``/joint/``, the joint, ``/cmd_thrust``.
"""

from __future__ import annotations

from itertools import product

import pytest
from lxml import etree

from multibot_rewrite import rewrite, strip

ROV = """<sdf version="1.9"><model name="rov"><link name="hull"/><link name="prop"/>
<joint name="fin" type="revolute"><parent>hull</parent><child>prop</child></joint>
<plugin filename="gz-sim-thruster-system" name="gz::sim::systems::Thruster">
{space}<joint_name>fin</joint_name></plugin>
<plugin filename="ArduPilotPlugin" name="ArduPilotPlugin"><control channel="0">
<jointName>fin</jointName><cmd_topic>{told}</cmd_topic></control></plugin></model></sdf>"""
LAYOUTS = ("tf-per-robot", "frames-per-robot", "both", "postfix", "frame-prefix")
SPACES = ("rov", "boat", "/boat", "a/b")


def heard(root: etree._Element) -> str:
    plugin = root.find("model/plugin")
    space = plugin.findtext("namespace") or root.find("model").get("name")
    return f"/model/{space}/joint/{plugin.findtext('joint_name')}/cmd_thrust".replace("//", "/")


@pytest.mark.parametrize(("layout", "space"), [*product(LAYOUTS, SPACES)])
@pytest.mark.parametrize("affix", ["prefix", "postfix"])
def test_a_thruster_hears_its_autopilot(layout: str, space: str, affix: str) -> None:
    if layout == "frame-prefix" and affix == "postfix":
        return
    told = f"/model/{space}/joint/fin/cmd_thrust".replace("//", "/")
    source = ROV.format(space=f"<namespace>{space}</namespace>", told=told)
    made = rewrite(source, "robot1", layout=layout, affix=affix)
    root = etree.fromstring(made.data)
    assert root.findtext(".//cmd_topic") == heard(root)
    assert "robot1" in heard(root)
    assert strip(made.data, "robot1", layout=layout, affix=affix) == source.encode()


@pytest.mark.parametrize("layout", ["frames-per-robot", "both", "postfix"])
def test_a_thruster_without_a_namespace_hears_it_where_the_model_is_renamed(layout: str) -> None:
    source = ROV.format(space="", told="/model/rov/joint/fin/cmd_thrust")
    root = etree.fromstring(rewrite(source, "robot1", layout=layout).data)
    assert root.findtext(".//cmd_topic") == heard(root) != "/model/rov/joint/fin/cmd_thrust"


@pytest.mark.parametrize(
    ("told", "new"),
    [
        # The model's, though a system has a word of the same text.
        ("/model/rov/odometry", "/model/rov_robot1/odometry"),
        (
            "/world/sea/model/rov/link/hull/sensor/sonar/scan",
            "/world/sea/model/rov_robot1/link/hull/robot1/sensor/sonar/scan",
        ),
        # Made of nothing that is named here.
        ("/model/ship/joint/fin/cmd_thrust", "/model/ship/joint/fin/cmd_thrust/robot1"),
        ("/gimbal/cmd_roll", "/gimbal/cmd_roll/robot1"),
        ("/model/rover/odometry", "/model/rover/odometry/robot1"),
    ],
)
def test_names_in_other_topics(told: str, new: str) -> None:
    source = ROV.format(space="<namespace>rov</namespace>", told=told)
    assert f"<cmd_topic>{new}</cmd_topic>" in rewrite(source, "robot1").data.decode()
