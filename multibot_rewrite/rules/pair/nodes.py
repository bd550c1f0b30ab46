"""Rules about nodes: is every planned node running, only once, and is every running node planned."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.findings.finding import ERROR, INCONCLUSIVE, WARNING, Finding
from multibot_rewrite.graph.reach import hidden_from_here, why_not_seen
from multibot_rewrite.graph.tool_nodes import is_tool
from multibot_rewrite.graph.wording import shorten
from multibot_rewrite.rules.declaration import graph_rule
from multibot_rewrite.rules.pair.causes import Cause, caused, plugin_of, why_other_name
from multibot_rewrite.rules.pair.comparison import View
from multibot_rewrite.system.conventions import EVERYBODYS
from multibot_rewrite.system.records import Robot


@graph_rule(
    "MG101",
    "missing-node",
    ERROR,
    absence=True,
    drawn="missing",
    what="A node of the plan is not in the graph. For a node that serves all robots it is a"
    " warning.",
    why="All its topics, services and actions are missing. Where it runs under another name, it"
    " works for the wrong robot, or for all of them.",
    fix="Start it, with its namespace. The hint has the node that runs in its place, or the line"
    " of the description that starts it. Where something else than robot_state_publisher sends the"
    " tf of the description, plan with the stack `no_robot_state_publisher`.",
    bad="""\
planned: /robot1/driver
as planned: /robot1/planner
running: /driver
""",
    good="""\
as planned: /robot1/driver
as planned: /robot1/planner
""",
)
def missing_node(view: View) -> Iterator[Finding]:
    """Of the plan; a robot without any of its nodes is one finding of ``missing_robot``."""
    for robot in view.plan.robots:
        for node in () if _is_absent(view, robot) else _missing(view, robot):
            match = view.probable_matches.get(node, "")
            cause = why_other_name(view, node, match) if match else _not_started(view, node)
            message = f"node {node} is in the plan, but not in the graph"
            yield missing_node.finding(message, **cause._asdict(), robot=robot.name, node=node)
    for node in view.own[""]:
        if node not in view.seen and node not in view.may_miss:
            message = f"node {node} for all robots is in the plan, but not in the graph"
            yield missing_node.finding(message, "is it started?", level=WARNING, node=node)


def _missing(view: View, robot: Robot) -> list[str]:
    """An optional node is missing only where it runs under another name."""
    return [
        node
        for node in view.own[robot.name]
        if node not in view.seen and (node not in view.may_miss or node in view.probable_matches)
    ]


def _is_absent(view: View, robot: Robot) -> bool:
    return view.seen.keys().isdisjoint(view.own[robot.name]) and bool(_missing(view, robot))


def _not_started(view: View, node: str) -> Cause:
    plugin, place = plugin_of(view, node)
    if plugin:
        started = f"{plugin} of the description should start it, see {place}"
        return caused(f"{started}; is the robot spawned?", place)
    return Cause("is it started, or did it end with an error?")


@graph_rule(
    "MG105",
    "node-name-twice",
    ERROR,
    what="Two running nodes have the same name.",
    why="Parameters and services work for only one of them, and tools show only one.",
    fix="Give each node its namespace or its own name. A node that was killed stays visible for 20"
    " s.",
    bad="""\
as planned: /robot1/driver
running: /robot1/driver
""",
    good="as planned: /robot1/driver\n",
    line=2,
)
def node_name_twice(view: View) -> Iterator[Finding]:
    """Of planned nodes, and of those that are not ignored."""
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
        message = f"{times} nodes have this name"
        yield node_name_twice.finding(message, cause, robot=robot, node=node)


@graph_rule(
    "MG108",
    "unplanned-node",
    WARNING,
    drawn="unexpected",
    what="A running node is not in the plan.",
    why="It may be a second copy, a node without its namespace, or just missing in the plan.",
    fix="Add it to the plan, or to `shared_nodes` if it serves all robots. For tools that come and"
    " go add a pattern to `ignored_nodes`.",
    bad="""\
as planned: /robot1/driver
running: /robot1/gripper
""",
    good="""\
as planned: /robot1/driver
as planned: /robot1/gripper
""",
    line=2,
)
def unplanned_node(view: View) -> Iterator[Finding]:
    """Only where the plan has nodes of its robot."""
    if not view.unplanned:
        return
    matches = set(view.probable_matches.values())
    planned = {robot.name for robot in view.plan.robots if view.own[robot.name]}
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
        yield unplanned_node.finding(message, cause, robot=robot, node=node)


def _foreign_names(view: View, node: str, robot: str) -> str:
    """The names of a node that do not hold its robot's name: these may disturb other robots."""
    shared = {*view.plan.shared_topics, *EVERYBODYS}
    names = dict.fromkeys(e.name for e in view.by_node.get(node, ()) if "/_" not in e.name)
    foreign = [n for n in names if n not in shared and view.ownership.robot(n) != robot]
    return f"; it uses {shorten(foreign)}, without the name of {robot}" if foreign else ""


@graph_rule(
    "MG109",
    "missing-robot",
    ERROR,
    absence=True,
    drawn="missing",
    what="No node of a robot is in the graph.",
    why="The robot is off, in another domain, or its nodes run under other names. Where all that is"
    " seen runs on one machine, the network may hide it: then it is inconclusive, not an error.",
    fix="Start it, in its namespace, and check `ROS_DOMAIN_ID` on both sides. Look from its machine as"
    " well, and join both snapshots: `multibot snapshot --snapshot`.",
    bad="""\
as planned: /robot1/driver
planned: /robot2/driver
""",
    good="""\
as planned: /robot1/driver
as planned: /robot2/driver
""",
    line=2,
)
def missing_robot(view: View) -> Iterator[Finding]:
    """One finding in place of one for each node."""
    for robot in view.plan.robots:
        if _is_absent(view, robot):
            message = (
                f"none of the {len(view.own[robot.name])} nodes of {robot.name} is in the graph"
            )
            cause = _why_absent(view, robot)
            hidden = not _matches(view, robot) and hidden_from_here(view.graph)
            level = INCONCLUSIVE if hidden else ERROR
            yield missing_robot.finding(message, **cause._asdict(), robot=robot.name, level=level)


def _matches(view: View, robot: Robot) -> list[tuple[str, str]]:
    """Its nodes, and those that probably run in their place."""
    matches = view.probable_matches
    return [(node, matches[node]) for node in view.own[robot.name] if node in matches]


def _why_absent(view: View, robot: Robot) -> Cause:
    matches = _matches(view, robot)
    if not matches:
        return Cause(why_not_seen(view.graph, robot.name))
    cause = why_other_name(view, *matches[0])
    same = f"; the same for {len(matches) - 1} more of its nodes" if len(matches) > 1 else ""
    return cause._replace(hint=cause.hint + same)
