"""Rules about nodes and names: is all of it there, does it leak, do its ends meet."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from multibot_rewrite.graph.comparison import GraphFinding, View, nearest, owner
from multibot_rewrite.graph.expectation import ALWAYS, Wanted
from multibot_rewrite.graph.snapshot import GraphEndpoint
from multibot_rewrite.model import ERROR
from multibot_rewrite.remap.records import CALLS, PUBLISHES, SERVES, SUBSCRIBES, TOPIC

SHOULD = {PUBLISHES: "publish", SUBSCRIBES: "subscribe", SERVES: "serve", CALLS: "call"}


def missing_nodes(view: View) -> Iterator[GraphFinding]:
    """A planned node that is not there."""
    seen = {node.name for node in view.graph.nodes}
    for robot in view.plan.robots:
        if seen.isdisjoint(robot.nodes) and robot.nodes:
            message = f"none of the {len(robot.nodes)} nodes of {robot.name} is there"
            yield GraphFinding("MG109", ERROR, robot.name, "", message, "is the robot started?")
            continue
        for node in (node for node in robot.nodes if node not in seen):
            bare = f"/{node.rpartition('/')[2]}"
            near = bare if bare in seen and bare != node else nearest(node, seen)
            cause = f"{near} is there" if near else "is it started?"
            if near == bare:
                cause += ": it was started without the robot's namespace"
            message = f"expected node {node}, it is not there"
            yield GraphFinding("MG101", ERROR, robot.name, node, message, cause)


def missing_endpoints(view: View) -> Iterator[GraphFinding]:
    """A planned name that its node does not have, though the node is there."""
    seen = {node.name for node in view.graph.nodes}
    for wanted in view.plan.endpoints:
        robot = view.robot_of.get(wanted.node)
        if robot is None or wanted.node not in seen or _has(view, wanted):
            continue
        message = f"it should {SHOULD[wanted.role]} {wanted.kind} {wanted.name}, and does not"
        cause = _why_missing(view, wanted)
        yield GraphFinding("MG102", ERROR, robot, wanted.node, message, cause)


def _has(view: View, wanted: Wanted) -> bool:
    key = (wanted.kind, wanted.role, wanted.name)
    return any((e.kind, e.role, e.name) == key for e in view.by_node.get(wanted.node, ()))


def _why_missing(view: View, wanted: Wanted) -> str:
    """The first user question: we never get the topic /robot1/cmd_vel, why?"""
    others = [
        e.name
        for e in view.by_node.get(wanted.node, ())
        if (e.kind, e.role) == (wanted.kind, wanted.role)
    ]
    bare = f"/{wanted.asked.strip('/').removeprefix('~/')}"
    if bare in others:
        return f"it {wanted.role} {bare} instead: its rule {wanted.asked}:=... did not reach it"
    near = nearest(wanted.name, others)
    return f"it {wanted.role} {near} instead" if near else "no name of it comes near"


def leaks(view: View) -> Iterator[GraphFinding]:
    """A robot's node with a name that is no robot's and not shared: every robot would meet there."""
    shared = {*view.plan.shared_topics, *ALWAYS}
    for node, robot in view.robot_of.items():
        for name in dict.fromkeys(e.name for e in view.by_node.get(node, ())):
            if name in shared or owner(name, view.plan):
                continue
            message = f"{name} is not {robot}'s own: the same node of another robot has it too"
            cause = "an absolute name, or a rule that did not reach the node"
            yield GraphFinding("MG103", ERROR, robot, node, message, cause)


def cross_talk(view: View) -> Iterator[GraphFinding]:
    """A robot's node that speaks or listens under another robot's name."""
    for node, robot in view.robot_of.items():
        for endpoint in view.by_node.get(node, ()):
            other = owner(endpoint.name, view.plan)
            if other and other != robot:
                message = f"it {endpoint.role} {endpoint.name}, which is {other}'s"
                cause = f"a rule or parameter of {robot} names {other}"
                yield GraphFinding("MG104", ERROR, robot, node, message, cause)


def same_names(view: View) -> Iterator[GraphFinding]:
    """Two nodes of one name: half of the tools see one of them only."""
    for node, times in Counter(node.name for node in view.graph.nodes).items():
        if times > 1:
            robot = view.robot_of.get(node, "")
            message = f"{times} nodes have this name"
            cause = "started twice, or two robots without a namespace; a dead one stays for 20 s"
            yield GraphFinding("MG105", ERROR, robot, node, message, cause)


def type_clashes(view: View) -> Iterator[GraphFinding]:
    """A topic or service with more than one type: its ends never meet."""
    for name, endpoints in view.by_name.items():
        types = sorted({endpoint.type for endpoint in endpoints if endpoint.type})
        if len(types) > 1:
            first = endpoints[0]
            message = f"{first.kind} {name} has the types {' and '.join(types)}"
            who = view.robot_of.get(first.node, "")
            yield GraphFinding(
                "MG106", ERROR, who, first.node, message, "two nodes mean different things"
            )


def qos_clashes(view: View) -> Iterator[GraphFinding]:
    """A publisher that offers less than a subscription asks for: no message ever arrives."""
    for name, endpoints in view.by_name.items():
        told: set[tuple[str, str, tuple[str, str]]] = set()
        for giver in (e for e in endpoints if (e.kind, e.role) == (TOPIC, PUBLISHES)):
            for taker in (e for e in endpoints if (e.kind, e.role) == (TOPIC, SUBSCRIBES)):
                reason = _less(giver, taker)
                if reason and (giver.node, taker.node, reason) not in told:
                    told.add((giver.node, taker.node, reason))
                    offered, wanted = reason
                    message = f"{name}: {giver.node} offers {offered}, {taker.node} wants {wanted}"
                    robot = view.robot_of.get(taker.node, "")
                    yield GraphFinding(
                        "MG107", ERROR, robot, taker.node, message, "set the QoS of one"
                    )


def _less(giver: GraphEndpoint, taker: GraphEndpoint) -> tuple[str, str] | None:
    """What is offered and what is asked for where they cannot connect (DDS request-offered rules)."""
    if giver.qos is None or taker.qos is None:
        return None
    pairs = (
        (giver.qos.reliability, taker.qos.reliability, "BEST_EFFORT", "RELIABLE"),
        (giver.qos.durability, taker.qos.durability, "VOLATILE", "TRANSIENT_LOCAL"),
    )
    return next(((low, high) for a, b, low, high in pairs if (a, b) == (low, high)), None)
