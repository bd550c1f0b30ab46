# SPDX-License-Identifier: Apache-2.0
"""What crosses from one ROS domain to another: the nodes of domain_bridge in a plan, and its files.

Source: ros2/domain_bridge c2523e1. Its process has a node ``NAME_DOMAIN`` in each domain, without
namespace and without the process's rules (domain_bridge.cpp, get_node_for_domain). A file names topics
alone, each once; services and actions do not cross (parse_domain_bridge_yaml_config.cpp). What is
latched keeps the last ten messages unless the file says more (qos_options.hpp).
"""

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.base.conventions import CLOCK, SENT_BY_EVERY_NODE, is_from_outside
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.nearest import did_you_mean_one_of
from multibot_rewrite.system.domains import domain_of
from multibot_rewrite.system.records import (
    CALLS,
    PUBLISHES,
    SERVES,
    SUBSCRIBES,
    TOPIC,
    End,
    Node,
    System,
    surely,
)

# What such a node is from, and the folder of the files.
DOMAIN_BRIDGE = "domain_bridge"
CLOCK_TYPE = "rosgraph_msgs/msg/Clock"
# Types of what is sent once and kept for who comes later, and the last part of such topics' names.
_LATCHED_TYPES = frozenset({"nav_msgs/msg/OccupancyGrid"})
_LATCHED_NAMES = ("tf_static", "robot_description")
# As many as a listener to tf_static keeps (tf2_ros qos.hpp).
_LATCHED_DEPTH = 100


class Crossing(NamedTuple):
    """A topic that goes from a robot's domain to that of all robots, or back."""

    robot: str
    name: str
    type: str
    out: bool


def bridge_name(robot: str) -> str:
    """Return the name of a robot's bridge."""
    return f"{robot.replace('/', '_')}_bridge"


def with_bridges(plan: System, given: Sequence[str] = ()) -> System:
    """Return the plan with a bridge for each robot that has topics to bridge.

    ``given`` are topics of each robot that cross in addition to the needs of nodes in the plan: to the
    domain of all robots, or from it operator topics such as ``cmd_vel``. Raises UsageError for one that
    no robot has.
    """
    # One without a type ends the bridge: it loads what its type is called (bridge_topic).
    found = [it for it in crossings(plan, given) if it.type]
    numbers, nodes, ends = domain_of(plan), [*plan.nodes], [*plan.ends]
    for robot in dict.fromkeys(it.robot for it in found):
        name, own = bridge_name(robot), [it for it in found if it.robot == robot]
        here, there = f"/{name}_{numbers[robot]}", f"/{name}_{numbers['']}"
        made = [Node(f"/{name}", robot=robot), Node(here, robot=robot), Node(there)]
        nodes += [it._replace(node_set=DOMAIN_BRIDGE, known=DOMAIN_BRIDGE) for it in made]
        for it in own:
            from_, to = (here, there) if it.out else (there, here)
            ends.append(End(TOPIC, SUBSCRIBES, it.name, it.type, node=from_, code_name=it.name))
            ends.append(End(TOPIC, PUBLISHES, it.name, it.type, node=to, code_name=it.name))
    return plan._replace(nodes=tuple(nodes), ends=tuple(ends))


def beyond(plan: System) -> dict[str, str]:
    """Return the nodes that robots' bridges have in the domain of all robots, each with its robot."""
    shared = domain_of(plan).get("")
    names = {f"/{bridge_name(it.name)}_{shared}": it.name for it in plan.robots}
    return {it.name: names[it.name] for it in plan.nodes if it.name in names}


def crossings(plan: System, given: Sequence[str]) -> list[Crossing]:
    """Return the topics that a node reads and no node of its domain sends, and those requested."""
    numbers = domain_of(plan)
    found = [*_needed_crossings(surely(plan), numbers), *_requested_crossings(plan, numbers, given)]
    return sorted(dict.fromkeys(found))


def _needed_crossings(plan: System, numbers: Mapping[str, int]) -> Iterator[Crossing]:
    """Yield the topics that a node reads and only nodes of another domain send, and the clock."""
    robot_of = _robot_by_node(plan)
    ends: dict[tuple[str, str], dict[str, End]] = defaultdict(dict)
    for it in plan.ends:
        if it.kind == TOPIC and it.name not in SENT_BY_EVERY_NODE:
            ends[it.name, it.role][robot_of[it.node]] = it
    for (name, role), readers in ends.items():
        senders = ends.get((name, PUBLISHES), {}) if role == SUBSCRIBES else {}
        at = {numbers[it] for it in senders}
        for reader, end in readers.items():
            if at and numbers[reader] not in at:
                for sender in (it for it in senders if "" in (reader, it)):
                    type_ = end.type or senders[sender].type
                    yield Crossing(reader or sender, name, type_, not reader)
    if any(it.name == CLOCK and PUBLISHES in it.bridge for it in plan.topics):
        apart = (it for it, number in numbers.items() if number != numbers[""])
        yield from (Crossing(it, CLOCK, CLOCK_TYPE, False) for it in apart)


def _robot_by_node(plan: System) -> Mapping[str, str]:
    """Return the robot of each node; empty for a node of all robots, and for nodes that it makes."""
    return defaultdict(str, {it.name: it.robot for it in plan.nodes})


def _requested_crossings(
    plan: System, numbers: Mapping[str, int], given: Sequence[str]
) -> Iterator[Crossing]:
    robot_of = _robot_by_node(plan)
    known: dict[str, dict[str, Crossing]] = defaultdict(dict)
    sent = {(robot_of[it.node], it.name) for it in plan.ends if it.role == PUBLISHES}
    for it in plan.ends:
        robot = robot_of[it.node]
        if it.kind == TOPIC and it.type and robot and numbers[robot] != numbers[""]:
            # A sensor's driver need not be in the plan.
            out = (robot, it.name) in sent or not is_from_outside(it.name)
            crossing = Crossing(robot, it.name, it.type, out)
            for word in (it.name, it.code_name.removeprefix("~").strip("/")):
                known[word].setdefault(robot, crossing)
    for word in given:
        own = known.get(word) or known.get(word.strip("/"))
        if own is None:
            names = [it for it in known if not it.startswith("/")]
            near = did_you_mean_one_of(word, names) or "add the node that has it"
            raise UsageError(f"crossing: no robot has a topic {word!r} by the plan; {near}")
        yield from own.values()


def services_apart(plan: System) -> Iterator[tuple[End, int, int]]:
    """Yield (end, own domain, other domain) of services and actions called across domains."""
    numbers = domain_of(plan)
    robot_of = _robot_by_node(plan)
    served: dict[tuple[str, str], set[int]] = defaultdict(set)
    ends = surely(plan).ends if numbers else ()
    for it in ends:
        if it.role == SERVES:
            served[it.kind, it.name].add(numbers[robot_of[it.node]])
    for it in ends:
        own = served.get((it.kind, it.name), ()) if it.role == CALLS else ()
        if own and (at := numbers[robot_of[it.node]]) not in own:
            yield it, at, min(own)


def bridge_files(plan: System) -> Iterator[tuple[str, bytes]]:
    """Yield path and bytes of the file of each robot's bridge, as the plan has it."""
    numbers = domain_of(plan)
    for robot, number in numbers.items():
        name = bridge_name(robot)
        own = [it for it in plan.ends if it.node == f"/{name}_{number}"]
        if not robot or not own:
            continue
        shared = numbers[""]
        rows = [f"name: {name}", f"from_domain: {number}", f"to_domain: {shared}", "topics:"]
        for it in own:
            rows += [f"  {it.name}:", f"    type: {it.type}"]
            if it.role == PUBLISHES:
                rows += [f"    from_domain: {shared}", f"    to_domain: {number}"]
            if it.type in _LATCHED_TYPES or it.name.rpartition("/")[2] in _LATCHED_NAMES:
                qos = f"reliability: reliable, durability: transient_local, depth: {_LATCHED_DEPTH}"
                rows.append(f"    qos: {{{qos}}}")
        yield bridge_path(robot), "\n".join((*rows, "")).encode()


def bridge_path(robot: str) -> str:
    """Return the path of the file of a robot's bridge."""
    return f"{DOMAIN_BRIDGE}/{bridge_name(robot)}.yaml"
