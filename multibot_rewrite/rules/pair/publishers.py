"""Rules about topics without a publisher: is the data published under another name."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping

from multibot_rewrite.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.rules.declaration import graph_rule
from multibot_rewrite.rules.pair.causes import in_namespaces_above, use_absolute
from multibot_rewrite.rules.pair.comparison import View
from multibot_rewrite.rules.pair.similar_names import similar
from multibot_rewrite.system.conventions import EVERYBODYS
from multibot_rewrite.system.records import PUBLISHES, SUBSCRIBES, TOPIC, End

# In the names of Nav2's costmap nodes.
COSTMAP = "costmap"
# Publishers by their topic without the robot's name.
Publishers = dict[str, list[End]]


@graph_rule(
    "MG110",
    "topic-below-node-namespace",
    ERROR,
    absence=True,
    what="A relative topic is resolved below the node's own namespace, where nothing publishes it,"
    " as `/robot1/local_costmap/scan`.",
    why="The costmap gets no data, without an error message.",
    fix="Write the absolute topic (`/robot1/scan`) in the node's parameters.",
    bad="""\
as planned: /robot1/lidar publishes /robot1/scan
as planned: /robot1/local_costmap/local_costmap
running: /robot1/local_costmap/local_costmap subscribes /robot1/local_costmap/scan
""",
    good="""\
as planned: /robot1/lidar publishes /robot1/scan
as planned: /robot1/local_costmap/local_costmap
running: /robot1/local_costmap/local_costmap subscribes /robot1/scan
""",
    line=3,
)
def topic_below_node_namespace(view: View) -> Iterator[Finding]:
    """The usual case are the sensor topics of a costmap."""
    waiting = [
        (robot, end)
        for node, robot in _nodes_with_own_namespace(view)
        for end in _without_publisher(view, node)
    ]
    known = {name for _, _, _, name in view.planned} if waiting else set()
    for robot, end in waiting:
        node, published = end.node, view.published_topics
        own = (
            it for it in in_namespaces_above(node, end.name) if view.ownership.robot(it) == robot
        )
        planned = (node, end.kind, end.role, end.name) in view.planned
        allowed = (it for it in own if it in published or (it in known and not planned))
        meant = next(allowed, "")
        if meant:
            message = f"subscribes to {end.name}, which has no publisher; did you mean {meant}?"
            yield topic_below_node_namespace.finding(
                message, use_absolute(meant), robot=robot, node=node, names=(end.name, meant)
            )


def _nodes_with_own_namespace(view: View) -> Iterator[tuple[str, str]]:
    """The nodes in a namespace below their robot's, with the robot: planned nodes, and costmaps."""
    for node, robot in view.robot_of.items():
        if view.ownership.without_robot(node, robot).count("/") > 1:
            yield node, robot
    for node in view.unplanned:
        robot = view.ownership.robot(node) if COSTMAP in node.rpartition("/")[2] else ""
        if robot:
            yield node, robot


def _without_publisher(view: View, node: str) -> Iterator[End]:
    """A node's subscriptions without a publisher, each topic once. A costmap reads its robot's sensors;
    for other nodes the plan is right."""
    costmap = COSTMAP in node.rpartition("/")[2]
    endpoints = view.by_node if costmap else view.unplanned_endpoints
    topics = {
        end.name: end
        for end in endpoints.get(node, ())
        if (end.kind, end.role) == (TOPIC, SUBSCRIBES) and end.name not in view.published_topics
    }
    return iter(topics.values())


@graph_rule(
    "MG111",
    "no-publisher",
    WARNING,
    absence=True,
    what="A planned subscription has no publisher, while the topic without the robot's name, or a"
    " similar one, has.",
    why="The node waits for ever, as for `/robot1/cmd_vel` while `/cmd_vel` is published.",
    fix="Pass the remap rule of the hint to the publisher, or start it in the robot's namespace.",
    bad="""\
as planned: /robot1/driver subscribes /robot1/cmd_vel
running: /joystick publishes /cmd_vel
""",
    good="""\
as planned: /robot1/driver subscribes /robot1/cmd_vel
running: /joystick publishes /robot1/cmd_vel
""",
)
def no_publisher(view: View) -> Iterator[Finding]:
    """Each topic once; operator topics without any similar publisher are none."""
    waiting = [
        (node, name)
        for node, kind, role, name in view.planned
        if (kind, role) == (TOPIC, SUBSCRIBES)
        and name not in view.published_topics
        and (node, kind, role, name) in view.types
    ]
    planned = _planned_publishers(view) if waiting else {}
    unplanned = _unplanned_publishers(view) if waiting else {}
    reported = set()
    for node, name in waiting:
        robot = view.robot_of.get(node, "")
        # Where the planned publisher is in the graph, missing_endpoint reports it.
        running = any(publisher in view.seen for publisher in planned.get(name, ()))
        if not robot or name in reported or running:
            continue
        own, unowned = unplanned.get(robot, {}), unplanned.get("", {})
        plain = view.ownership.without_robot(name, robot)
        other = _similar_publisher(plain, own, unowned, name in planned)
        if other:
            reported.add(name)
            yield _published_as(robot, node, name, other)


def _published_as(robot: str, node: str, name: str, other: End) -> Finding:
    published = f"{other.node} publishes {other.name}"
    message = f"subscribes to {name}, which has no publisher; {published}"
    cause = f"if that is meant for {robot}, pass the rule {other.name}:={name} to {other.node}"
    return no_publisher.finding(message, cause, robot=robot, node=node, names=(name, other.name))


def _planned_publishers(view: View) -> Mapping[str, list[str]]:
    """The nodes that should publish each topic."""
    found: dict[str, list[str]] = defaultdict(list)
    for node, kind, role, name in view.planned:
        if (kind, role) == (TOPIC, PUBLISHES):
            found[name].append(node)
    return found


def _unplanned_publishers(view: View) -> Mapping[str, Publishers]:
    """Publishers that are not in the plan, by the robot of their node."""
    found: dict[str, Publishers] = defaultdict(dict)
    matches = set(view.probable_matches.values())
    for node, ends in view.unplanned_endpoints.items():
        for end in ends if node not in matches else ():
            if (end.kind, end.role) == (TOPIC, PUBLISHES) and end.name not in EVERYBODYS:
                plain = view.ownership.without_robot(end.name, view.ownership.robot(end.name))
                found[view.ownership.robot(node)].setdefault(plain, []).append(end)
    return found


def _similar_publisher(
    plain: str, own: Publishers, unowned: Publishers, planned: bool
) -> End | None:
    """The publisher that is probably meant.

    It publishes the topic without a robot's name or, where the plan has a publisher, a similar one.
    """
    same = [*own.get(plain, ()), *unowned.get(plain, ())]
    exact = next((end for end in same if end.name == plain), None)
    if exact or not planned:
        return exact
    near = own.get(similar(plain, own), ())
    return next(iter((*same, *near)), None)
