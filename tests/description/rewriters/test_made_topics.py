# SPDX-License-Identifier: Apache-2.0
"""A topic that one system of gz-sim makes of names and another one is told as a text is one topic.

What the thruster listens to is said here as gz-sim's Thruster.cc does: ``/model/``, the namespace or
the name of the model, ``/joint/``, the joint, ``/cmd_thrust``.
"""

from __future__ import annotations

import pytest

from multibot_rewrite import rewrite

ROV = """<sdf version="1.9"><model name="rov"><link name="hull"/><link name="prop"/>
<joint name="fin" type="revolute"><parent>hull</parent><child>prop</child></joint>
<plugin filename="gz-sim-thruster-system" name="gz::sim::systems::Thruster">
{space}<joint_name>fin</joint_name></plugin>
<plugin filename="ArduPilotPlugin" name="ArduPilotPlugin"><control channel="0">
<jointName>fin</jointName><cmd_topic>{told}</cmd_topic></control></plugin></model></sdf>"""


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
