"""Rules about nodes: is every planned node running, only once, and is every running node planned."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.graph.expectation import EVERYWHERE, PlannedRobot
from multibot_rewrite.graph.rules.causes import plugin_of, why_other_name
from multibot_rewrite.graph.rules.comparison import GraphFinding, View
from multibot_rewrite.graph.tool_nodes import is_tool
from multibot_rewrite.graph.wording import shorten
from multibot_rewrite.model import ERROR, WARNING


def missing_nodes(view: View) -> Iterator[GraphFinding]:
    """A node of the plan that is not in the graph."""
    for robot in view.plan.robots:
        missing = [node for node in robot.nodes if _is_missing(view, robot, node)]
        if missing and view.seen.keys().isdisjoint(robot.nodes):
            yield _missing_robot(view, robot)
            continue
        for node in missing:
            match = view.probable_matches.get(node, "")
            cause = why_other_name(view, node, match) if match else _not_started(view, node)
            message = f"node {node} is in the plan, but not in the graph"
            yield GraphFinding("MG101", ERROR, robot.name, node, message, cause)
    for node in dict.fromkeys(view.plan.shared_nodes):
        if node not in view.seen:
            message = f"node {node} for all robots is in the plan, but not in the graph"
            yield GraphFinding("MG101", WARNING, "", node, message, "is it started?")


def _is_missing(view: View, robot: PlannedRobot, node: str) -> bool:
    """An optional node is missing only where it runs under another name."""
    return node not in view.seen and (node not in robot.optional or node in view.probable_matches)


def _not_started(view: View, node: str) -> str:
    plugin, place = plugin_of(view, node)
    if plugin:
        return f"{plugin} of the description should start it, see {place}; is the robot spawned?"
    return "is it started, or did it end with an error?"


def _missing_robot(view: View, robot: PlannedRobot) -> GraphFinding:
    message = f"none of the {len(robot.nodes)} nodes of {robot.name} is in the graph"
    matches = [
        (node, view.probable_matches[node]) for node in robot.nodes if node in view.probable_matches
    ]
    cause = "is the robot started, and with this ROS_DOMAIN_ID?"
    if matches:
        cause = why_other_name(view, *matches[0])
        cause += f"; the same for {len(matches) - 1} more of its nodes" if len(matches) > 1 else ""
    return GraphFinding("MG109", ERROR, robot.name, "", message, cause)


def duplicate_node_names(view: View) -> Iterator[GraphFinding]:
    """Two nodes with one name: half of the tools see only one of them."""
    for node, times in view.seen.items():
        robot = view.robot_of.get(node, "")
        if times == 1 or (not robot and is_tool(node, view.plan.ignored_nodes)):
            continue
        missing = [planned for planned, match in view.probable_matches.items() if match == node]
        cause = (
            "it was started twice, or two robots run without a namespace; a node that was killed"
            " stays visible for 20 s"
        )
        if len(missing) > 1:
            cause = f"{shorten(missing)} are missing: both were started without their robot's name"
        yield GraphFinding("MG105", ERROR, robot, node, f"{times} nodes have this name", cause)


def unexpected_nodes(view: View) -> Iterator[GraphFinding]:
    """A node that is not in the plan, although the plan has nodes of its robot."""
    matches = set(view.probable_matches.values())
    planned = {robot.name for robot in view.plan.robots if robot.nodes}
    without_robot = view.ownership.without_robot
    originals = {without_robot(node, robot): node for node, robot in view.robot_of.items()}
    for node in view.unplanned if planned else ():
        robot = view.ownership.robot(node)
        if node in matches or (robot and robot not in planned):
            continue
        if robot:
            message = (
                f"belongs to {robot}, but is not in the plan{_foreign_names(view, node, robot)}"
            )
            cause = "add it to the plan: with --stack or --nodes, or by hand"
        else:
            message = "belongs to no robot, and is not in shared_nodes of the plan"
            cause = "add it there if it serves all robots; otherwise give it its robot's namespace"
        if node in originals:
            cause = f"{originals[node]} runs as well: is this a second one without a robot's name?"
        yield GraphFinding("MG108", WARNING, robot, node, message, cause)


def _foreign_names(view: View, node: str, robot: str) -> str:
    """The names of a node that do not hold its robot's name: these may disturb other robots."""
    shared = {*view.plan.shared_topics, *EVERYWHERE}
    names = dict.fromkeys(e.name for e in view.by_node.get(node, ()) if "/_" not in e.name)
    foreign = [n for n in names if n not in shared and view.ownership.robot(n) != robot]
    return f"; it uses {shorten(foreign)}, without the name of {robot}" if foreign else ""
