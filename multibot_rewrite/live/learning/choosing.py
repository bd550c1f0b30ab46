# SPDX-License-Identifier: Apache-2.0
"""Which nodes of a graph to learn, and which of their ends are one in the code: an action, an image."""

import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.base.conventions import CLOCK, LISTENER
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.nearest import nearest_few
from multibot_rewrite.base.rosnames import check_full_name, check_namespace
from multibot_rewrite.knowledge.records import TRANSPORTS, Endpoint
from multibot_rewrite.system.records import ACTION, CALLS, PUBLISHES, SERVES, SERVICE, TOPIC, System
from multibot_rewrite.system.words import is_tool

# A tf2 listener without a node creates its own node, named after its address.
HELPER = re.compile(LISTENER + "[0-9a-f]+")
# Hidden nodes, launch and tf2 listeners: never part of a robot.
NEVER_MEANT = re.compile(rf".*/(_.*|launch_ros_\d+|{LISTENER}.*)", re.DOTALL)


class Helpers(NamedTuple):
    """Helper nodes in a node's process; ``sure`` if no other node is in that process."""

    names: tuple[str, ...] = ()
    sure: bool = True


def choose_nodes(graph: System, names: Sequence[str], namespace: str) -> tuple[str, ...]:
    """Return the full names of the nodes to learn, sorted: ``names``, or all below ``namespace``.

    Raises UsageError for a node that is not in the graph, not below the namespace, or in the graph
    twice, and if there is no node at all."""
    base = namespace_prefix(namespace)
    times = Counter(node.name for node in graph.nodes)
    for name in names:
        if name not in times:
            raise UsageError(f"{name}: no node has this name; {_suggestion(name, times)}")
        if not name.startswith(f"{base}/"):
            raise UsageError(f"{name}: it is not below --namespace {base}; leave that out")
    below = (name for name in times if name.startswith(f"{base}/") and not is_tool(name))
    chosen = sorted(set(names) or below)
    if not chosen:
        where = f"below {base}" if base else "in this graph"
        raise UsageError(f"there is no node to learn {where}; {_suggestion(base, times)}")
    for name in chosen:
        check_seen_name("node", name)
        if times[name] > 1:
            hint = "stop all but one; a node that was killed stays visible for 20 s"
            raise UsageError(f"{name}: {times[name]} nodes have this name; {hint}")
    return tuple(chosen)


def left_out(graph: System, chosen: Iterable[str], namespace: str) -> tuple[str, ...]:
    """Return tools below ``namespace`` that are not learned and that a user may miss."""
    base = namespace_prefix(namespace)
    below = {node.name for node in graph.nodes if node.name.startswith(f"{base}/")}
    tools = (name for name in below.difference(chosen) if is_tool(name))
    return tuple(sorted(name for name in tools if not NEVER_MEANT.fullmatch(name)))


def namespace_prefix(namespace: str) -> str:
    """Return a namespace without its last slash, empty for the root; UsageError if not valid."""
    base = namespace.rstrip("/")
    fault = check_namespace(base) if base else None
    if fault:
        raise UsageError(f"namespace {namespace!r}: {fault.reason}")
    return base


def check_seen_name(what: str, name: str) -> None:
    """Raise UsageError for a name that is not valid in a ROS graph."""
    fault = check_full_name(name)
    if fault:
        raise UsageError(f"{what} name {name!r} in the graph: {fault.reason}")


def _suggestion(name: str, known: Iterable[str]) -> str:
    """Return a hint with the running nodes that may be meant."""
    nodes = sorted(node for node in known if not is_tool(node))
    near = nearest_few(name, nodes, 3) or nodes[:3]
    return f"running are {', '.join(near)}" if near else "no nodes are running, or only tools"


def helpers_of(graph: System, names: Sequence[str]) -> dict[str, Helpers]:
    """Return the helper nodes in the process of each node; none of ``names`` counts as a helper."""
    inside, mains = _nodes_by_process(graph, names)
    return {
        node.name: Helpers(tuple(sorted(inside[node.process])), mains[node.process] == 1)
        for node in graph.nodes
        if node.name in names and node.process and node.process in inside
    }


def helpers_without_owner(graph: System, names: Sequence[str]) -> tuple[str, ...]:
    """Return the helper nodes that are alone in their process, so that their node is unknown."""
    inside, mains = _nodes_by_process(graph, names)
    alone = (helpers for process, helpers in inside.items() if not mains[process])
    return tuple(sorted(name for helpers in alone for name in helpers))


def _nodes_by_process(
    graph: System, names: Sequence[str]
) -> tuple[Mapping[str, list[str]], Counter[str]]:
    """Return by process its helper nodes, and how many others it has."""
    inside: dict[str, list[str]] = defaultdict(list)
    mains: Counter[str] = Counter()
    for node in graph.nodes:
        own = node.name.rpartition("/")[2]
        if HELPER.fullmatch(own) and node.name not in names:
            inside[node.process].append(node.name)
        elif node.process and not own.startswith("_"):
            mains[node.process] += 1
    return inside, mains


IMAGE = "sensor_msgs/msg/Image"
_HIDDEN = "/_action/"


class EndpointId(NamedTuple):
    """One endpoint of a node; ``name`` is fully qualified."""

    kind: str
    role: str
    name: str


# The types of each endpoint, sorted.
Seen = Mapping[EndpointId, tuple[str, ...]]


def fold_actions(seen: Seen) -> dict[EndpointId, tuple[str, ...]]:
    """Return ``seen`` with each action in place of the services and topics it is made of."""
    kinds = defaultdict(set)
    found = {}
    for key, types in seen.items():
        if _HIDDEN in key.name:
            kinds[_action_of(key)].add(key.kind)
        if key.kind == SERVICE and key.name.endswith(f"{_HIDDEN}send_goal") and types:
            goal = tuple(type_.removesuffix("_SendGoal") for type_ in types)
            found[EndpointId(ACTION, *_action_of(key))] = goal
    listed = {key: types for key, types in seen.items() if key.kind == ACTION and types}
    # rcl lists every subscriber of the feedback as a client.
    only_topics = {key for key in listed if kinds.get((key.role, key.name)) == {TOPIC}}
    actions = found | {key: types for key, types in listed.items() if key not in only_topics}
    whole = {(key.role, key.name) for key in actions}
    rest = {
        key: types
        for key, types in seen.items()
        if key.kind != ACTION and (_HIDDEN not in key.name or _action_of(key) not in whole)
    }
    return {**actions, **rest}


def _action_of(key: EndpointId) -> tuple[str, str]:
    """Return role and name of the action that a hidden endpoint belongs to."""
    role = SERVES if key.role in (SERVES, PUBLISHES) else CALLS
    return role, key.name.partition(_HIDDEN)[0]


def fold_images(seen: Seen) -> tuple[dict[EndpointId, tuple[str, ...]], frozenset[EndpointId]]:
    """Return ``seen`` without image_transport's topics, and the images that had them."""
    images: dict[EndpointId, set[EndpointId]] = {}
    for key, types in seen.items():
        siblings = {key._replace(name=f"{key.name}/{transport}") for transport in TRANSPORTS}
        if key.kind == TOPIC and types == (IMAGE,) and not siblings.isdisjoint(seen):
            images[key] = siblings
    folded = {key for siblings in images.values() for key in siblings}
    rest = {key: types for key, types in seen.items() if key not in folded}
    return rest, frozenset(images)


def fold_parts(
    endpoints: Iterable[Endpoint], parts: Mapping[str, tuple[Endpoint, ...]], in_root: bool
) -> tuple[list[Endpoint], tuple[str, ...]]:
    """Return ``endpoints`` without those of complete parts, and the names of these parts."""
    left = {_signature(end, end.name): end for end in endpoints}
    complete = []
    for name, part in parts.items():
        wanted = [_signatures(end, in_root) for end in part if end.name != CLOCK]
        if all(any(it in left for it in variants) for variants in wanted):
            complete.append(name)
            for end in part:
                for signature in _signatures(end, in_root):
                    left.pop(signature, None)
    return list(left.values()), tuple(complete)


_Signature = tuple[str, str, str, str, tuple[str, ...], bool]


def _signatures(end: Endpoint, in_root: bool) -> list[_Signature]:
    """Return how an endpoint of a part may appear in the graph."""
    relative = end.name[0] not in "/~"
    names = [end.name, f"/{end.name}"] if in_root and relative else [end.name]
    return [_signature(end, name) for name in names]


def _signature(end: Endpoint, name: str) -> _Signature:
    """Return what identifies an endpoint called ``name`` in the graph."""
    return end.kind, end.role, name, end.type, end.also, end.helper
