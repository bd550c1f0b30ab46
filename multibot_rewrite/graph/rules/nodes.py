"""Rules about nodes: is each there, once, and is it planned."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.graph.expectation import EVERYWHERE, WantedRobot
from multibot_rewrite.graph.rules.causes import not_named, plugin, some
from multibot_rewrite.graph.rules.comparison import GraphFinding, View
from multibot_rewrite.graph.tool_nodes import is_tool
from multibot_rewrite.model import ERROR, WARNING


def missing_nodes(view: View) -> Iterator[GraphFinding]:
    """A planned node that is not there."""
    for robot in view.plan.robots:
        missing = [node for node in robot.nodes if _is_missed(view, robot, node)]
        if missing and view.seen.keys().isdisjoint(robot.nodes):
            yield _silent(view, robot)
            continue
        for node in missing:
            stand_in = view.stand_ins.get(node, "")
            cause = not_named(view, node, stand_in) if stand_in else _not_started(view, node)
            message = f"expected node {node}, it is not there"
            yield GraphFinding("MG101", ERROR, robot.name, node, message, cause)
    for node in dict.fromkeys(view.plan.shared_nodes):
        if node not in view.seen:
            message = f"expected node {node} for all robots, it is not there"
            yield GraphFinding("MG101", WARNING, "", node, message, "is it started?")


def _is_missed(view: View, robot: WantedRobot, node: str) -> bool:
    """One that is started under a condition only is missed where it is there under another name."""
    return node not in view.seen and (node not in robot.optional or node in view.stand_ins)


def _not_started(view: View, node: str) -> str:
    which, place = plugin(view, node)
    if which:
        return f"is it started? {which} is in the description: see {place}; does the world load it?"
    return "is it started? did it end with an error?"


def _silent(view: View, robot: WantedRobot) -> GraphFinding:
    message = f"none of the {len(robot.nodes)} nodes of {robot.name} is there"
    there = {node: view.stand_ins[node] for node in robot.nodes if node in view.stand_ins}
    cause = "is the robot started? in this ROS_DOMAIN_ID?"
    if there:
        cause = not_named(view, *next(iter(there.items())))
        cause += f"; {len(there) - 1} more of its nodes likewise" if len(there) > 1 else ""
    return GraphFinding("MG109", ERROR, robot.name, "", message, cause)


def same_names(view: View) -> Iterator[GraphFinding]:
    """Two nodes of one name: half of the tools see one of them only."""
    for node, times in view.seen.items():
        robot = view.robot_of.get(node, "")
        if times == 1 or (not robot and is_tool(node, view.plan.ignored_nodes)):
            continue
        meant = [missing for missing, there in view.stand_ins.items() if there == node]
        cause = "started twice, or two robots without a namespace; a dead one stays for 20 s"
        if len(meant) > 1:
            cause = f"{some(meant)} are missing: both were started without their robot's name"
        yield GraphFinding("MG105", ERROR, robot, node, f"{times} nodes have this name", cause)


def unexpected_nodes(view: View) -> Iterator[GraphFinding]:
    """A node that the plan does not have, though it has the robot's other ones."""
    told = set(view.stand_ins.values())
    planned = {robot.name for robot in view.plan.robots if robot.nodes}
    bare = {view.owners.bare(node, robot): node for node, robot in view.robot_of.items()}
    for node in view.unplanned if planned else ():
        robot = view.owners.of(node)
        if node in told or (robot and robot not in planned):
            continue
        if robot:
            message = f"it is {robot}'s and not in the plan{_strays(view, node, robot)}"
            cause = "put it in the plan: by --stack or --nodes, or by hand"
        else:
            message = "it is no robot's, and not one of shared_nodes in the plan"
            cause = "add it there if it serves all robots; else it lacks its robot's namespace"
        if node in bare:
            cause = f"{bare[node]} is there as well: one more, started without a robot's name?"
        yield GraphFinding("MG108", WARNING, robot, node, message, cause)


def _strays(view: View, node: str, robot: str) -> str:
    """What it has under no robot's name or another's: with that it may disturb the others."""
    shared = {*view.plan.shared_topics, *EVERYWHERE}
    names = dict.fromkeys(e.name for e in view.by_node.get(node, ()) if "/_" not in e.name)
    astray = [name for name in names if name not in shared and view.owners.of(name) != robot]
    return f"; it has {some(astray)}, not {robot}'s own" if astray else ""
