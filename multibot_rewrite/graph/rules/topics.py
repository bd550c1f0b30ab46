"""Rules about the topics, services and actions of nodes.

Is each planned name used, does a name leak out of its robot, does a subscription have a publisher.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping

from multibot_rewrite.graph.expectation import EVERYWHERE, PlannedEndpoint
from multibot_rewrite.graph.rules.causes import (
    DOES,
    how_to_remap,
    name_without_rules,
    plugin_of,
    why_not_remapped,
)
from multibot_rewrite.graph.rules.comparison import GraphFinding, View
from multibot_rewrite.graph.rules.similar_names import similar
from multibot_rewrite.graph.snapshot import LISTENER, GraphEndpoint
from multibot_rewrite.graph.wording import SEVERAL, shorten
from multibot_rewrite.model import ERROR, WARNING
from multibot_rewrite.remap.records import CALLS, PUBLISHES, SERVES, SERVICE, SUBSCRIBES, TOPIC

TO_DO = {
    PUBLISHES: "publish",
    SUBSCRIBES: "subscribe to",
    SERVES: "offer",
    CALLS: "have a client for",
}
# In the names of Nav2's costmap nodes.
COSTMAP = "costmap"
# Publishers by their topic without the robot's name.
Publishers = dict[str, list[GraphEndpoint]]


def missing_endpoints(view: View) -> Iterator[GraphFinding]:
    """A planned endpoint that its node does not have, although the node is in the graph."""
    for key, planned in view.planned.items():
        robot = view.robot_of.get(planned.node)
        if robot is None or planned.node not in view.seen or key in view.types:
            continue
        # Of two nodes with one name, rcl shows the services of only one.
        if view.seen[planned.node] > 1 and planned.kind != TOPIC:
            continue
        message = f"should {TO_DO[planned.role]} {planned.kind} {planned.name}, but does not"
        cause = _why_missing(view, planned, robot)
        yield GraphFinding("MG102", ERROR, robot, planned.node, message, cause, (planned.name,))


def _why_missing(view: View, planned: PlannedEndpoint, robot: str) -> str:
    """Answers the most common question: why do we never get the topic /robot1/cmd_vel?"""
    used = _used_instead(view, planned, robot)
    if not used:
        managed = (planned.node, SERVICE, SERVES, f"{planned.node}/get_state") in view.planned
        state = f"; is it configured? ros2 lifecycle get {planned.node}" if managed else ""
        return f"it has no similar name; is it switched off by a parameter?{state}"
    instead = f"it {DOES[planned.role]} {used} instead"
    if used in _names_without_rules(view, planned, robot):
        return f"{instead}: {why_not_remapped(view, planned)}{how_to_remap(view, planned)}"
    if not view.ownership.robot(planned.name):
        return f"{instead}: a rule remaps it, but the plan has one {planned.name} for all robots"
    if used in _moved_down(view, planned):
        return f"{instead}: {_use_absolute(planned.name)}"
    other = view.ownership.robot(used)
    if other and other != robot:
        return f"{instead}, a name of {other}: a remap rule or parameter names the wrong robot"
    return f"{instead}: is the name misspelled in a remap rule or parameter?"


def _names_without_rules(view: View, planned: PlannedEndpoint, robot: str) -> tuple[str, ...]:
    """The names an endpoint may have where no remap rule and no namespace is applied."""
    in_root = f"/{planned.code_name.strip('/').removeprefix('~/')}"
    plain = view.ownership.without_robot(planned.name, robot)
    names = (name_without_rules(planned), in_root, plain)
    return tuple(name for name in names if name not in ("", "/", planned.name))


def _used_instead(view: View, planned: PlannedEndpoint, robot: str) -> str:
    """The name that the node probably uses in place of a planned one, or an empty string."""
    unplanned = _unplanned_names(view, planned)
    likely = [name for name in _names_without_rules(view, planned, robot) if name in unplanned]
    likely += _moved_down(view, planned)
    if likely:
        return likely[0]
    ownership = view.ownership
    plain = {
        ownership.without_robot(name, ownership.robot(name) or robot): name for name in unplanned
    }
    wanted = ownership.without_robot(planned.name, robot)
    return plain.get(wanted, "") or plain.get(similar(wanted, plain), "")


def _moved_down(view: View, planned: PlannedEndpoint) -> list[str]:
    """The unplanned names that are a relative name resolved below the node's own namespace."""
    return [
        name
        for name in _unplanned_names(view, planned)
        if planned.name in _in_namespaces_above(planned.node, name)
    ]


def _unplanned_names(view: View, planned: PlannedEndpoint) -> list[str]:
    """The names that the node uses in the role of a planned endpoint without being planned."""
    node, kind, role = planned.node, planned.kind, planned.role
    return [
        e.name
        for e in view.by_node.get(node, ())
        if (e.kind, e.role) == (kind, role) and (node, kind, role, e.name) not in view.planned
    ]


def leaks(view: View) -> Iterator[GraphFinding]:
    """A robot's node uses a name that belongs to no robot and is not shared: all robots meet there."""
    shared = {*view.plan.shared_topics, *EVERYWHERE}
    not_remapped = _missing_by_name_without_rules(view)
    for node, robot in view.robot_of.items():
        for name in dict.fromkeys(e.name for e in view.unplanned_endpoints.get(node, ())):
            if name in shared or view.ownership.robot(name):
                continue
            message = (
                f"uses {name}, which is not a name of {robot}: the same node of another robot uses"
                " it too"
            )
            cause = _why_leaked(view, node, name, not_remapped.get((node, name)))
            yield GraphFinding("MG103", ERROR, robot, node, message, cause, (name,))


def _missing_by_name_without_rules(view: View) -> dict[tuple[str, str], PlannedEndpoint]:
    """The planned endpoints that are missing, by node and the name they have without a rule."""
    return {
        (planned.node, name): planned
        for key, planned in view.planned.items()
        if key not in view.types and planned.node in view.robot_of
        for name in _names_without_rules(view, planned, view.robot_of[planned.node])
    }


def _why_leaked(view: View, node: str, name: str, planned: PlannedEndpoint | None) -> str:
    if planned:
        return why_not_remapped(view, planned)
    plugin, place = plugin_of(view, node)
    if plugin:
        return f"{plugin} has no namespace or remap rule for it, see {place}"
    robot = view.robot_of[node]
    target = f"{name}/{robot}" if view.ownership.robot_is_last else f"/{robot}{name}"
    return f"an absolute name in its code or parameters; pass --ros-args -r {name}:={target}"


def planned_leaks(view: View) -> Iterator[GraphFinding]:
    """A name that the plan itself has for several robots, because no remap rule changes it."""
    shared = {*view.plan.shared_topics, *EVERYWHERE, *_shared_tf(view)}
    nodes: dict[str, dict[str, None]] = defaultdict(dict)
    for node, kind, role, name in view.planned:
        own = node in view.robot_of and name not in shared and not view.ownership.robot(name)
        if own and (node, kind, role, name) in view.types:
            nodes[name][node] = None
    for name, users in nodes.items():
        robots = dict.fromkeys(view.robot_of[node] for node in users)
        for node in users if len(robots) > 1 else ():
            listed = shorten(robots, SEVERAL)
            message = f"uses {name}, which the plan has for several robots: {listed}"
            cause = "no remap rule changes it: set the node's parameter, or add it to shared_topics"
            yield GraphFinding("MG103", ERROR, view.robot_of[node], node, message, cause, (name,))


def _shared_tf(view: View) -> set[str]:
    """The tf topics that robots share in their layout."""
    times = Counter(robot.tf for robot in view.plan.robots)
    return {f"{tf}{end}" for tf, count in times.items() if count > 1 for end in ("", "_static")}


def wrong_tf_listeners(view: View) -> Iterator[GraphFinding]:
    """A tf listener in a robot's namespace that subscribes to /tf, which is not the robot's."""
    home = {robot.name: robot.tf for robot in view.plan.robots}
    for node in view.seen:
        robot = view.ownership.robot(node) if f"/{LISTENER}" in node else ""
        if robot and home[robot] != "/tf" and (node, TOPIC, SUBSCRIBES, "/tf") in view.types:
            message = f"this tf listener subscribes to /tf, but tf of {robot} is on {home[robot]}"
            cause = "pass the rule /tf:=tf to its whole process (--ros-args), not to one node in it"
            yield GraphFinding("MG103", ERROR, robot, node, message, cause, ("/tf",))


def cross_talk(view: View) -> Iterator[GraphFinding]:
    """A robot's node uses a name of another robot."""
    for node, robot in view.robot_of.items():
        for end in view.unplanned_endpoints.get(node, ()):
            other = view.ownership.robot(end.name)
            if other and other != robot:
                message = f"{DOES[end.role]} {end.name}, which belongs to {other}"
                cause = f"a remap rule or parameter of {robot} names {other}"
                yield GraphFinding("MG104", ERROR, robot, node, message, cause, (end.name,))


def topics_below_own_namespace(view: View) -> Iterator[GraphFinding]:
    """A relative topic resolved below the node's own namespace, where nothing is published.

    The usual case are the sensor topics of a costmap.
    """
    known = {*view.published_topics, *(name for _, _, _, name in view.planned)}
    for node, robot in _nodes_with_own_namespace(view):
        # A costmap reads its robot's sensors; for other nodes the plan is right.
        costmap = COSTMAP in node.rpartition("/")[2]
        endpoints = view.by_node if costmap else view.unplanned_endpoints
        for end in _without_publisher(view, endpoints, node):
            above = _in_namespaces_above(node, end.name)
            planned = (node, end.kind, end.role, end.name) in view.planned
            allowed = view.published_topics if planned else known
            own = (name for name in above if view.ownership.robot(name) == robot)
            meant = next((name for name in own if name in allowed), "")
            if meant:
                message = f"subscribes to {end.name}, which has no publisher; did you mean {meant}?"
                about = (end.name, meant)
                yield GraphFinding(
                    "MG110", ERROR, robot, node, message, _use_absolute(meant), about
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


def _without_publisher(
    view: View, endpoints: Mapping[str, list[GraphEndpoint]], node: str
) -> Iterator[GraphEndpoint]:
    """A node's subscriptions without a publisher, each topic once."""
    topics = {
        end.name: end
        for end in endpoints.get(node, ())
        if (end.kind, end.role) == (TOPIC, SUBSCRIBES) and end.name not in view.published_topics
    }
    return iter(topics.values())


def _use_absolute(name: str) -> str:
    return f"the node resolves a relative name in its own namespace: write {name} in its parameters"


def _in_namespaces_above(node: str, name: str) -> Iterator[str]:
    """A name directly in a node's namespace, moved to each of the namespaces above."""
    namespace = node.rpartition("/")[0]
    while namespace and name.startswith(f"{namespace}/"):
        rest = name.removeprefix(namespace)
        namespace = namespace.rpartition("/")[0]
        yield namespace + rest
        name = namespace + rest


def subscriptions_without_publisher(view: View) -> Iterator[GraphFinding]:
    """A planned subscription without a publisher, while a similar topic has one."""
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
        # Where the planned publisher is in the graph, missing_endpoints reports it.
        running = any(publisher in view.seen for publisher in planned.get(name, ()))
        if not robot or name in reported or running:
            continue
        own, unowned = unplanned.get(robot, {}), unplanned.get("", {})
        plain = view.ownership.without_robot(name, robot)
        other = _similar_publisher(plain, own, unowned, name in planned)
        if other:
            reported.add(name)
            yield _no_publisher(robot, node, name, other)


def _no_publisher(robot: str, node: str, name: str, other: GraphEndpoint) -> GraphFinding:
    published = f"{other.node} publishes {other.name}"
    message = f"subscribes to {name}, which has no publisher; {published}"
    cause = f"if that is meant for {robot}, pass the rule {other.name}:={name} to {other.node}"
    return GraphFinding("MG111", WARNING, robot, node, message, cause, (name, other.name))


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
            if (end.kind, end.role) == (TOPIC, PUBLISHES) and end.name not in EVERYWHERE:
                plain = view.ownership.without_robot(end.name, view.ownership.robot(end.name))
                found[view.ownership.robot(node)].setdefault(plain, []).append(end)
    return found


def _similar_publisher(
    plain: str, own: Publishers, unowned: Publishers, planned: bool
) -> GraphEndpoint | None:
    """The publisher that is probably meant.

    It publishes the topic without a robot's name or, where the plan has a publisher, a similar one.
    """
    same = [*own.get(plain, ()), *unowned.get(plain, ())]
    exact = next((end for end in same if end.name == plain), None)
    if exact or not planned:
        return exact
    near = own.get(similar(plain, own), ())
    return next(iter((*same, *near)), None)
