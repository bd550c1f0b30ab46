# SPDX-License-Identifier: Apache-2.0
"""What a node of all robots makes for itself, as a cell's move_group does, is in the domain of all."""

from __future__ import annotations

from multibot_rewrite.spelling.domain_bridge import crossings, services_apart
from multibot_rewrite.system.records import (
    CALLS,
    PUBLISHES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    Domain,
    End,
    Node,
    Robot,
    System,
)

HELPER = "/move_group_private_*"
TYPE = "sensor_msgs/msg/JointState"
PLAN = System(
    (Node("/move_group"), Node("/a/driver", robot="a")),
    (
        End(TOPIC, SUBSCRIBES, "/a/joint_states", TYPE, node=HELPER),
        End(TOPIC, PUBLISHES, "/a/joint_states", TYPE, node="/a/driver"),
        End(SERVICE, CALLS, "/a/reset", "std_srvs/srv/Empty", node=HELPER),
        End(SERVICE, SERVES, "/a/reset", "std_srvs/srv/Empty", node="/a/driver"),
    ),
    robots=(Robot("a"),),
    domains=(Domain("a", 11),),
)


def test_a_helper_of_all_robots_is_in_the_domain_of_all() -> None:
    (one,) = crossings(PLAN, ())
    assert (one.robot, one.name, one.type, one.out) == ("a", "/a/joint_states", TYPE, True)
    assert [(end.name, *numbers) for end, *numbers in services_apart(PLAN)] == [("/a/reset", 0, 11)]
