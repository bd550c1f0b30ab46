# SPDX-License-Identifier: Apache-2.0
"""What crosses between domains, and the files of ros2/domain_bridge."""

from __future__ import annotations

import pytest

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.planning.domain_bridge import (
    beyond,
    bridge_files,
    crossings,
    services_apart,
    with_bridges,
)
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
    Topic,
)

STRING, MAP = "std_msgs/msg/String", "nav_msgs/msg/OccupancyGrid"


def end(node: str, role: str, name: str, type_: str = STRING, kind: str = TOPIC) -> End:
    return End(kind, role, name, type_, "", node, None, "", name.rpartition("/")[2])


def plan(*ends: End, topics: tuple[Topic, ...] = ()) -> System:
    """Robot ``a/b`` in domain 5, ``c`` in 6, and ``d`` with a node of all in 4."""
    nodes = (
        Node("/a/n", robot="a/b"), Node("/c/n", robot="c"), Node("/d/n", robot="d"), Node("/all"),
    )  # fmt: skip
    domains = Domain("", 4), Domain("a/b", 5), Domain("c", 6)
    robots = tuple(map(Robot, ("a/b", "c", "d")))
    return System(nodes, ends, robots=robots, domains=domains, topics=topics)


def sent(name: str, by: str, to: str, types: tuple[str, str] = (STRING, STRING)) -> list[End]:
    return [end(by, PUBLISHES, name, types[0]), end(to, SUBSCRIBES, name, types[1])]


@pytest.mark.parametrize(
    ("word", "told"), [("odon", "did you mean 'odom'?"), ("zzz", "add the node that has it")]
)
def test_what_is_asked_for_and_no_robot_has_is_refused(word: str, told: str) -> None:
    with pytest.raises(UsageError) as refused:
        crossings(plan(end("/a/n", PUBLISHES, "/a/odom")), [word])
    said = f"crossing: no robot has a topic {word!r} by the plan; {told}"
    assert str(refused.value) == said


def test_a_bridge_has_a_node_in_each_domain_and_a_file() -> None:
    """What is latched says so: the map and the fixed transforms. What has no type stays."""
    made = with_bridges(
        plan(
            *sent("/map", "/all", "/a/n", (MAP, MAP)), *sent("/a/tf_static", "/a/n", "/all"),
            *sent("/a/odom", "/a/n", "/all"), *sent("/y", "/c/n", "/all", ("", "")),
        )
    )  # fmt: skip
    assert [(it.name, it.robot, it.node_set) for it in made.nodes[4:]] == [
        ("/a_b_bridge", "a/b", "domain_bridge"), ("/a_b_bridge_5", "a/b", "domain_bridge"),
        ("/a_b_bridge_4", "", "domain_bridge"),
    ]  # fmt: skip
    assert [(it.node, it.role, it.name) for it in made.ends[8:]] == [
        ("/a_b_bridge_5", SUBSCRIBES, "/a/odom"), ("/a_b_bridge_4", PUBLISHES, "/a/odom"),
        ("/a_b_bridge_5", SUBSCRIBES, "/a/tf_static"), ("/a_b_bridge_4", PUBLISHES, "/a/tf_static"),
        ("/a_b_bridge_4", SUBSCRIBES, "/map"), ("/a_b_bridge_5", PUBLISHES, "/map"),
    ]  # fmt: skip
    assert beyond(made) == {"/a_b_bridge_4": "a/b"}
    kept = "    qos: {reliability: reliable, durability: transient_local, depth: 100}"
    text = [
        "name: a_b_bridge", "from_domain: 5", "to_domain: 4", "topics:",
        "  /a/odom:", f"    type: {STRING}",
        "  /a/tf_static:", f"    type: {STRING}", kept,
        "  /map:", f"    type: {MAP}", "    from_domain: 4", "    to_domain: 5", kept, "",
    ]  # fmt: skip
    assert [*bridge_files(made)] == [("domain_bridge/a_b_bridge.yaml", "\n".join(text).encode())]


# What a node of all robots makes for itself, as a cell's move_group does, is in the domain of
# all.

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
