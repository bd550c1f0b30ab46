# SPDX-License-Identifier: Apache-2.0
"""A remap table -> stub nodes, in a graph of their own, and what is seen there.

Each has the names of its node's code, rcl gets the remap rules. A stub has the rules that reach its
node in the table's release: a controller those that its manager hands on and those of its spawner, a
component those of its container, a plugin those of its tag. Pure; ``graph.live.stub_nodes`` runs them.
Parameters are taken to be set as the layout needs them, QoS is the default, and endpoints that depend
on a condition are left out."""

import json
import os
from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from typing import Any, NamedTuple, TypeAlias

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.rosnames import resolve_bound
from multibot_rewrite.knowledge.records import Endpoint
from multibot_rewrite.planning.domain_bridge import DOMAIN_BRIDGE
from multibot_rewrite.planning.of_runs import ACTION_PARTS
from multibot_rewrite.planning.records import Rules, Run, Table
from multibot_rewrite.planning.transforms import Edges
from multibot_rewrite.planning.way_checks import bound_to, is_controller_topic, running_nodes
from multibot_rewrite.planning.ways import ros_arguments
from multibot_rewrite.producers.ros.child import RUN_STUBS, observe, running
from multibot_rewrite.producers.ros.participants import participants_here
from multibot_rewrite.producers.ros.request import Request, to_text
from multibot_rewrite.system.environment import settings
from multibot_rewrite.system.records import (
    ACTION,
    BUSY_MACHINE,
    CALLS,
    PUBLISHES,
    RUNS,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    Edge,
    End,
    System,
    Topic,
    edge_of,
)

TF, EMPTY = "tf2_msgs/msg/TFMessage", "std_msgs/msg/Empty"
# The types used in place of one that is not installed; an action's is seen by its feedback.
SUBSTITUTE_TYPES = {TOPIC: EMPTY, SERVICE: "std_srvs/srv/Empty", ACTION: EMPTY}
# Types of an action's parts that are the same for every action.
PART_TYPES = {
    "_action/cancel_goal": "action_msgs/srv/CancelGoal",
    "_action/status": "action_msgs/msg/GoalStatusArray",
}
# Fast DDS finds only 32 participants under LOCALHOST: larger fleets share these processes.
PROCESSES = 8


# A node that is played, with the words that rcl gets and its ends as its code has them; and what it
# sends on tf.
Stub: TypeAlias = tuple[Run, Sequence[Edge]]


def played(
    name: str, ends: Iterable[Endpoint], robot: str = "", arguments: Sequence[str] = ()
) -> Run:
    """Return a node to be played; ``arguments`` are its words for rcl."""
    names = tuple((it, "") for it in ends)
    return Run(robot, name, "/", name, (), names=names, arguments=tuple(arguments))


def stub_nodes(table: Table, edges: Edges, left_out: Collection[str] = ()) -> Iterator[Stub]:
    """Yield each node to be played, with the transforms it sends.

    Rules at one of the ways ``left_out`` are not given; without any a node gets only its namespace
    and its name."""
    types = {name: end.type for _, end, name in table.ends if end.type}
    # What a node does that nobody knows is not played.
    names = lists_by_key(
        (run.full_name, (end, name))
        for run, end, name in table.ends
        if not end.when and (end.role or run.fact.is_known)
    )
    spaces = {(it.robot, it.node): it.namespace for it in table.runs}
    for _, node in running_nodes(table, left_out):
        own = names.get(node.full_name, [])
        space, other = node.namespace, node.other_name
        host = spaces.get((node.robot, node.fact.host)) if node.fact.apart else None
        if host is not None:
            # The code of a host that places the node itself (a costmap) asks nobody for either.
            space, other = f"{host.rstrip('/')}/{node.node.rpartition('/')[0]}", ""
        ends = {_stub_endpoint(end, name, types): name for end, name in own}
        arguments = tuple(ros_arguments(space, other, _rules_with_handed_on(node, own)))
        stub = node._replace(arguments=arguments, names=tuple(ends.items()))
        yield stub, edges.get((node.robot, node.node), ())


def without_doubles(stubs: Iterable[Stub], plan: System) -> Iterator[Stub]:
    """Yield the stubs, without nodes that may run where what surely runs sends a topic of theirs."""
    may = {it.name for it in plan.nodes if it.sure != RUNS}
    sure = (it for it in plan.ends if it.role == PUBLISHES and it.sure == RUNS)
    outputs = [it for it in sure if it.type != TF and it.name not in plan.shared_topics]
    sent = {it.name for it in outputs if it.node not in may}
    sent |= {it.name for it in plan.topics if PUBLISHES in it.bridge}
    doubles = {it.node for it in outputs if it.node in may and it.name in sent}
    yield from (it for it in stubs if it[0].full_name not in doubles)


def bridge_stub(topics: Iterable[Topic]) -> Iterator[Stub]:
    """Yield the stand-in of a bridge to a simulator, if the plan needs it, with the world's topics."""
    rows = [
        Endpoint(SERVICE if role == SERVES else TOPIC, role, topic.name, topic.type)
        for topic in topics
        for role in topic.bridge
    ]
    if rows:
        yield played("ros_gz_bridge", rows), ()


def domain_bridge_stubs(plan: System) -> Iterator[Stub]:
    """Yield the nodes of domain_bridge in a plan of one domain."""
    ends = lists_by_key((it.node, Endpoint(it.kind, it.role, it.name, it.type)) for it in plan.ends)
    for node in plan.nodes:
        if node.node_set == DOMAIN_BRIDGE:
            yield played(node.name[1:], ends.get(node.name, ()), node.robot), ()


def _rules_with_handed_on(node: Run, names: Iterable[tuple[Endpoint, str]]) -> Rules:
    """Return the rules of a node; a controller manager that plays its controllers has theirs."""
    theirs = {end.name for end, _ in names if is_controller_topic(node, end)}
    if not theirs:
        return node.rules
    bare = bound_to(node, ())
    full = {resolve_bound(it, TOPIC, bare) for it in theirs}
    own = (it for it in node.rules if resolve_bound(it[0], TOPIC, bare) not in full)
    return (*own, *node.handed_on)


def _stub_endpoint(end: Endpoint, name: str, types: Mapping[str, str]) -> Endpoint:
    """Return a stub's endpoint for one in the code; ``types`` are by name in the graph."""
    kind, role, own, type_, *_ = end
    # A topic without a role is nearly always a sensor's output.
    made = Endpoint(kind, role or PUBLISHES, own, type_ or types.get(name, ""))
    return made._replace(helper=end.helper, by=end.by, beside=end.beside)


def split_over_processes(nodes: Iterable[Stub]) -> list[list[Stub]]:
    """Return the stub nodes by process: one for each robot, but no more than PROCESSES.

    A participant of DDS refuses a topic under a second type: a stub with another type is in another
    process."""
    processes: dict[int, list[Stub]] = defaultdict(list)
    process_of: dict[str, int] = {}
    types: dict[tuple[int, str], str] = {}
    for stub in nodes:
        robot = stub[0].robot
        process = process_of.setdefault(robot, len(process_of) % PROCESSES)
        own = {name or it.name: it.type for it, name in stub[0].names if it.kind == TOPIC}
        while any(types.get((process, it), own[it]) != own[it] for it in own):
            process += PROCESSES
        types |= {(process, name): type_ for name, type_ in own.items()}
        processes[process].append(stub)
    return list(processes.values())


def with_substitutes(plan: System, replaced: Mapping[str, str]) -> System:
    """Return the plan with replaced types; an action whose type is missing becomes its parts."""
    endpoints = [end for planned in plan.ends for end in _substituted(planned, replaced)]
    topics = (it._replace(type=replaced.get(it.type, it.type)) for it in plan.topics)
    return plan._replace(ends=tuple(endpoints), topics=tuple(topics))


def _substituted(planned: End, replaced: Mapping[str, str]) -> Iterator[End]:
    """Yield the ends that stand for a planned one where its type is replaced."""
    if planned.kind == ACTION and planned.type in replaced:
        action = Endpoint(planned.kind, planned.role, planned.name, planned.type)
        for kind, role, name, type_, *_ in action_parts(action):
            code_name = planned.code_name + name.removeprefix(planned.name)
            yield End(kind, role, name, type_, node=planned.node, code_name=code_name)
    else:
        also = tuple(replaced.get(type_, type_) for type_ in planned.also)
        yield planned._replace(type=replaced.get(planned.type, planned.type), also=also)


def with_own_types(it: System, plan: System, replaced: Mapping[str, str]) -> System:
    """Return a snapshot of stub nodes with the types of the plan in place of their substitutes."""
    types: dict[tuple[str, ...], str] = {(TOPIC, one.name): one.type for one in plan.topics}
    for end in plan.ends:
        last = end.code_name.rpartition("/")[2]
        types.setdefault((end.node, end.kind, end.role, last), end.type)
        types.setdefault((end.kind, end.name), end.type)
        types[end.node, end.kind, end.role, end.name] = end.type

    def own(end: End) -> End:
        """Return the end with its planned type, if it has the substitute of that."""
        who, last = (end.node, end.kind, end.role), end.name.rpartition("/")[2]
        keys = ((*who, end.name), (end.kind, end.name), (*who, last))
        type_ = next((types[key] for key in keys if key in types), "")
        return end._replace(type=type_) if replaced.get(type_) == end.type else end

    return it._replace(ends=tuple(map(own, it.ends)), topics=plan.topics)


def action_parts(action: Endpoint) -> Iterator[Endpoint]:
    """Yield the services and topics that make up an action, for an action without its type."""
    roles = {
        (SERVES, SERVICE): SERVES, (SERVES, TOPIC): PUBLISHES,
        (CALLS, SERVICE): CALLS, (CALLS, TOPIC): SUBSCRIBES,
    }  # fmt: skip
    for suffix, kind in ACTION_PARTS:
        type_ = PART_TYPES.get(suffix, SUBSTITUTE_TYPES[kind])
        name = f"{action.name}/{suffix}"
        yield action._replace(kind=kind, role=roles[action.role, kind], name=name, type=type_)


def substitute_type(kind: str, type_: str) -> str:
    """Return the type that is used in place of one that is not installed."""
    return "geometry_msgs/msg/TransformStamped" if type_ == TF else SUBSTITUTE_TYPES[kind]


def to_order(nodes: Iterable[Stub]) -> tuple[Any, ...]:
    """Return stub nodes as plain values, the order of the process that runs them."""
    return tuple(
        (
            *(run.code_name, run.arguments, run.process_namespace, run.process_rules),
            [(*end[:4], end.helper, end.by, end.beside) for end, _ in run.names],
            edges,
        )
        for run, edges in nodes
    )


def from_order(value: Sequence[Any]) -> Iterator[Stub]:
    """Yield the stub nodes of an order as JSON gives it back, which ``to_order`` made."""
    for name, words, space, rules, rows, edges in value:
        ends = (
            Endpoint(*own)._replace(helper=helper, by=by, beside=beside)
            for *own, helper, by, beside in rows
        )
        run = played(name, ends, arguments=words)
        sent = [edge_of(parent, child, static) for child, parent, _, static, *_ in edges]
        yield run._replace(process_namespace=space, process_rules=rules), sent


# Below the ports that a system gives away by itself.
_DOMAINS = 100
_ELSEWHERE = ("ROS_STATIC_PEERS", "ROS_DISCOVERY_SERVER", "ROS_SUPER_CLIENT", "ROS_LOCALHOST_ONLY")
# Looks at nodes that do run until all that they have is seen.
LOOKS = 3


class Started(NamedTuple):
    """What stub nodes report: replaced types, their ends (node, role, name), the frames they send."""

    replaced: dict[str, str]
    ends: frozenset[tuple[str, str, str]]
    frames: frozenset[str]


def isolated_environment(domain: int | None) -> dict[str, str]:
    """Return an environment for ROS on this machine alone, in a domain without other nodes."""
    environ = {k: v for k, v in os.environ.items() if k not in _ELSEWHERE}
    asked = settings(os.environ).domain if os.environ.get("ROS_DOMAIN_ID") else None
    free = asked is not None and participants_here(asked) == 0
    other = asked if free else 1 + os.getpid() % _DOMAINS
    own = other if domain is None else domain
    return {**environ, "ROS_DOMAIN_ID": str(own), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}


def isolated_environments(domain: int | None, count: int) -> list[dict[str, str]]:
    """Return so many environments as of ``isolated_environment``, each in a free domain of its own."""
    first = isolated_environment(domain)
    numbers = [int(first["ROS_DOMAIN_ID"])]
    while len(numbers) < count:
        own = 1 + numbers[-1] % _DOMAINS
        while participants_here(own):
            own = 1 + own % _DOMAINS
        numbers.append(own)
    return [{**first, "ROS_DOMAIN_ID": str(it)} for it in numbers]


def graph_of_stubs(
    nodes: Iterable[Stub], environ: Mapping[str, str], seconds: float
) -> tuple[System, dict[str, str]]:
    """Return the graph of the stub nodes, and which types are replaced by which.

    A snapshot that lacks what the nodes announce is taken again. Raises Unusable where the nodes do
    not start or the graph is not read."""
    request = Request(seconds, substitutes=True)
    with _started(nodes, environ) as started:
        for _ in range(LOOKS):
            graph = observe(request, environ)
            ends = {(end.node, end.role, end.name) for end in graph.ends}
            if started.ends <= ends and started.frames <= {edge.child for edge in graph.edges}:
                # All nodes that run here were seen whole, so the machine is not too busy.
                here = graph.environment
                caveats = tuple(it for it in here.caveats if it.code != BUSY_MACHINE)
                return graph._replace(environment=here._replace(caveats=caveats)), started.replaced
    return graph, started.replaced


@contextmanager
def _started(nodes: Iterable[Stub], environ: Mapping[str, str]) -> Iterator[Started]:
    """Yield the stub nodes in the graph, and what they announce once all are running."""
    with ExitStack() as stack:
        children = [
            stack.enter_context(running(RUN_STUBS, to_text(to_order(own)), environ))
            for own in split_over_processes(nodes)
        ]
        said = [json.loads(child.next_message() or b"[{}, [], []]") for child in children]
        replaced = {old: new for own, _, _ in said for old, new in own.items()}
        ends = frozenset((node, role, name) for _, own, _ in said for node, role, name in own)
        yield Started(replaced, ends, frozenset(it for _, _, own in said for it in own))
