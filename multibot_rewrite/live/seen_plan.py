# SPDX-License-Identifier: Apache-2.0
"""What is seen -> a plan that the same graph fulfils: to draw it, and to begin a fleet with. Pure."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.conventions import EVERYBODYS, SENT_BY_EVERY_NODE, WORLD_FRAMES
from multibot_rewrite.base.findings.finding import ERROR
from multibot_rewrite.base.naming import DEFAULT_LAYOUT, TF_TOPICS
from multibot_rewrite.base.wording import unique
from multibot_rewrite.live.diagnose import Diagnosis
from multibot_rewrite.rules.check import RULES
from multibot_rewrite.system.guess import GuessedRobot
from multibot_rewrite.system.records import Edge, End, Node, Robot, System
from multibot_rewrite.system.tf_copies import tree_topic
from multibot_rewrite.system.words import OF_EVERY_NODE, is_tool

# The robot of a graph in which no name has a robot's.
NAMELESS = GuessedRobot("robot1", "")


def seen_plan(seen: Diagnosis) -> System:
    """Return the plan: all nodes but tools, all names but what every node has, and no errors."""
    nodes = unique(node.name for node in seen.graph.nodes if not is_tool(node.name))
    robots = {_own_name(it): it for it in robots_to_plan(seen)}
    names = {mine: it.name for mine, it in robots.items()}
    whose = {node: seen.whose.robot(node) for node in nodes}
    # What an error is about is nobody's plan: a check against this one finds it again.
    excused = (it for it in seen.findings if it.level == ERROR and RULES[it.code].options["meant"])
    wrong = {(it.node, name) for it in excused for name in it.names}
    ends = (it for it in seen.graph.ends if it.node in whose and "/_" not in it.name)
    ends = (it for it in ends if (it.node, it.name) not in wrong)
    made = (
        End(it.kind, it.role, it.name, it.type, node=it.node, code_name=seen.whose.plain(it.name))
        for it in ends
        if it.name not in SENT_BY_EVERY_NODE and not it.type.startswith(OF_EVERY_NODE)
    )
    topics = unique(end.name for end in seen.graph.ends if end.kind == "topic")
    # All is of the robot that has no name.
    bare = (it for it in topics if "" not in robots and not seen.whose.robot(it) and "/_" not in it)
    return System(
        tuple(Node(it, robot=names.get(whose[it], "")) for it in nodes),
        tuple(dict.fromkeys(made)),
        tuple(_edges_from_world(seen)),
        robots=tuple(
            _robot_record(seen, it) for mine, it in robots.items() if mine in whose.values()
        ),
        layout=seen.layout.name if seen.layout else DEFAULT_LAYOUT,
        shared_topics=tuple(sorted({*bare, *EVERYBODYS})),
        shared_frames=tuple(sorted(WORLD_FRAMES)),
    )


def _edges_from_world(seen: Diagnosis) -> Iterator[Edge]:
    """Yield the fixed transforms from a shared frame to robots, each with nodes of its robot."""
    for it in seen.graph.edges:
        robot = seen.whose.frame_robot(it.child)
        nodes = tuple(one for one in it.publishers if seen.whose.robot(one) == robot)
        if it.static and robot and it.parent in WORLD_FRAMES:
            yield Edge(it.child, it.parent, static=True, publishers=nodes)


def robots_to_plan(seen: Diagnosis) -> tuple[GuessedRobot, ...]:
    """Return the robots that nodes belong to; one for all nodes where no node shows whose it is."""
    return tuple(it for it in seen.robots if not it.only_frames) or (NAMELESS,)


def _own_name(robot: GuessedRobot) -> str:
    """Return the name of a guessed robot; empty where no name has a robot's."""
    return "" if robot is NAMELESS else robot.name


def _robot_record(seen: Diagnosis, robot: GuessedRobot) -> Robot:
    """Return the robot's record; frames without a name are of the robot on whose topic they are."""
    whose = seen.whose
    mine = _own_name(robot)
    topics = [it for it in seen.tf if whose.robot(it[0]) == mine]
    shared = f"/{TF_TOPICS[0]}"
    # A base may send its own on a topic beside, from where a node sends it again (TurtleBot 4).
    tf, _ = max(topics, key=lambda it: len(it[1]), default=(shared, ()))
    # tf2 takes a slash in front of a frame away.
    own = {
        it.removeprefix("/")
        for edge in seen.graph.edges
        for it in (edge.child, edge.parent)
        if whose.frame_robot(it) == robot.name
        or not mine
        or (not whose.frame_robot(it) and tree_topic(edge.topic) == tf != shared)
    }
    frames, space = tuple(sorted(own - set(WORLD_FRAMES))), robot.namespace.strip("/")
    return Robot(robot.name, frames, tf, namespace=space if space != robot.name else "")
