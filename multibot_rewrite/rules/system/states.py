# SPDX-License-Identifier: Apache-2.0
"""Dangers of nodes: two of one name, two managers of one node; and of states, which nodes were
asked for: life cycle, controllers, clocks by parameter.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.wording import SEVERAL, and_then, shorten
from multibot_rewrite.rules.declaration import see, system_rule, where
from multibot_rewrite.rules.system.clocks import mixed_clocks, planned_clocks
from multibot_rewrite.system.index import Index, nodes_of
from multibot_rewrite.system.records import (
    CLAIMS,
    COMMAND,
    SERVICE,
    SIM_TIME,
    Controller,
    Interface,
    clocks,
)
from multibot_rewrite.system.tool_nodes import is_tool, is_viewer, last_word

ACTIVE = "active"


@system_rule("MG511", "not-active", ERROR)
def not_active(seen: Index) -> Iterator[Finding]:
    """One finding for the nodes of a robot that are in one state and have one manager. A plan may have
    another state for a node."""
    planned = seen.expected.system.nodes if seen.expected else ()
    states = {it.name: it.lifecycle for it in planned if it.lifecycle}
    found: dict[tuple[str, str, str, str], list[str]] = defaultdict(list)
    for it in seen.node.values():
        wanted = states.get(it.name, ACTIVE)
        if it.lifecycle not in ("", wanted):
            about = (seen.robot(it.name), it.lifecycle, wanted, _manager(seen, it.name))
            found[about].append(it.name)
    for (robot, state, wanted, manager), nodes in found.items():
        verb = "is" if len(nodes) == 1 else "are"
        message = f"{shorten(sorted(nodes), SEVERAL)} {verb} {state}, not {wanted}"
        is_planned = not states.keys().isdisjoint(nodes)
        cause = "no node activates it: is that meant?"
        if manager or is_planned:
            cause = f"see the log of {manager or 'its lifecycle manager'}"
        yield not_active.finding(
            message,
            f"{cause}; ros2 lifecycle get {nodes[0]}",
            level=ERROR if manager or is_planned else WARNING,
            robot=robot,
            node=nodes[0],
        )


def _manager(seen: Index, node: str) -> str:
    """The node that changes the state of another one; empty for none."""
    ends = seen.by_name.get((SERVICE, f"{node}/change_state"))
    clients = (end.node for end in ends.clients) if ends else ()
    return min((it for it in clients if not is_viewer(it) and not is_tool(it)), default="")


@system_rule("MG512", "interface-commanded-twice", ERROR)
def interface_commanded_twice(seen: Index) -> Iterator[Finding]:
    """A running manager refuses the second of its own controllers."""
    claims: dict[tuple[str, str], list[Controller]] = defaultdict(list)
    for it in (one for one in seen.system.controllers if one.state == ACTIVE):
        for interface in it.claims:
            claims[seen.robot(it.manager), interface].append(it)
    reported = set()
    for (robot, interface), found in claims.items():
        names = tuple((it.manager, it.name) for it in found)
        if len(set(names)) > 1 and (robot, names) not in reported:
            reported.add((robot, names))
            who = " and ".join(f"{name} of {node}" for node, name in names)
            message = f"{interface} is commanded by {who}"
            cause = "two controller managers for one robot: stop one, or unload its controller"
            if len({it.manager for it in found}) == 1:
                cause = "spawn one of them with --inactive"
            places = [it for it in seen.system.interfaces if _is_of(it, interface, found)]
            yield interface_commanded_twice.finding(
                message, cause + see(places),
                robot=robot, node=found[0].manager, names=(interface,), **where(places),
            )  # fmt: skip


def _is_of(claim: Interface, name: str, controllers: Iterable[Controller]) -> bool:
    """Is it the claim of an interface by one of these controllers?"""
    if (claim.role, claim.kind, claim.name) != (CLAIMS, COMMAND, name):
        return False
    return any(last_word(claim.node) == it.name for it in controllers)


@system_rule("MG513", "no-controller-active", WARNING)
def no_controller_active(seen: Index) -> Iterator[Finding]:
    """Some inactive ones beside active ones are usual."""
    kept: dict[str, list[Controller]] = defaultdict(list)
    for it in seen.system.controllers:
        kept[it.manager].append(it)
    for manager, own in kept.items():
        if all(it.state != ACTIVE for it in own):
            listed = shorten((f"{it.name} ({it.state})" for it in own), SEVERAL)
            message = f"none of its controllers is active: {listed}"
            cause = f"ros2 control list_controllers -c {manager}; see the log of the spawners"
            yield no_controller_active.finding(
                message, cause, robot=seen.robot(manager), node=manager
            )


@system_rule("MG514", "use-sim-time-differs", WARNING)
def use_sim_time_differs(seen: Index) -> Iterator[Finding]:
    """Tools and bridges have the machine's time beside any robot. MG503 says it of a whole robot, and
    of planned parameters ``parameter_not_planned``."""
    told, planned = {it.robot for it in mixed_clocks(seen)}, planned_clocks(seen)
    by_robot: dict[str, dict[bool, list[str]]] = defaultdict(lambda: defaultdict(list))
    for node, simulated in clocks(seen.system).items():
        if not is_tool(node) and node not in planned:
            by_robot[seen.robot(node)][simulated].append(node)
    for robot, found in by_robot.items():
        if len(found) < 2 or robot in told:
            continue
        odd = min((True, False), key=lambda it: len(found[it]))
        message = (
            f"{SIM_TIME} is {str(odd).lower()} for {shorten(sorted(found[odd]))}, and not for"
            f" {shorten(sorted(found[not odd]))}"
        )
        cause = "use_sim_time has to be the same for all nodes of a robot"
        yield use_sim_time_differs.finding(message, cause, robot=robot, node=min(found[odd]))


# So many doubled nodes are two robots rather than two nodes.
MANY = 3
_CHANGE_STATE = "/change_state"


@system_rule("MG301", "nodes-of-one-name", ERROR)
def nodes_of_one_name(seen: Index) -> Iterator[Finding]:
    """Many of them are one finding: two robots."""
    times = seen.nodes
    twins = [name for name, count in times.items() if count > 1 and _counts(seen, name)]
    by_robot: dict[str, list[str]] = defaultdict(list)
    for name in twins:
        by_robot[seen.robot(name)].append(name)
    for robot, names in by_robot.items():
        if len(names) >= MANY:
            yield _two_robots(robot, names)
            continue
        for name in names:
            message = f"{times[name]} nodes have the name {name}"
            cause = (
                "started twice, or two robots without a namespace of their own; a node that was"
                " killed stays visible for 20 s"
            )
            yield nodes_of_one_name.finding(message, cause, robot=robot, node=name)


def _counts(seen: Index, node: str) -> bool:
    """Tools may run twice. Of two containers each gets the components of the other."""
    return not seen.is_tool(node) or node.endswith("_container")


def _two_robots(robot: str, names: Sequence[str]) -> Finding:
    """``names`` are all there more than once."""
    message = f"{len(names)} nodes run more than once: {shorten(names, SEVERAL)}"
    if robot:
        cause = f"{robot} was started twice, or another robot was started with its namespace"
    else:
        cause = (
            "two robots were started without a namespace: give each its own (namespace:=robot1,"
            " PushRosNamespace in the launch file)"
        )
    return nodes_of_one_name.finding(message, cause, robot=robot, node=names[0], names=tuple(names))


@system_rule("MG302", "managed-twice", ERROR)
def managed_twice(seen: Index) -> Iterator[Finding]:
    """One finding for all nodes that the same managers have; an operator's tool is none."""
    managed: dict[tuple[str, ...], list[str]] = defaultdict(list)
    for (kind, name), ends in seen.by_name.items():
        if kind == SERVICE and name.endswith(_CHANGE_STATE):
            clients = nodes_of(end for end in ends.clients if not _asks_for_a_person(end.node))
            managed[clients].append(name.removesuffix(_CHANGE_STATE))
    for managers, nodes in managed.items():
        if len(managers) > 1:
            message = f"{and_then(managers)} all manage the life cycle of {shorten(sorted(nodes))}"
            cause = "one of them is too many, or its node_names has nodes of another robot"
            services = (f"{node}{end}" for node in nodes for end in (_CHANGE_STATE, "/get_state"))
            yield managed_twice.finding(
                message, cause,
                robot=seen.robot(nodes[0]), node=managers[0], names=(*managers, *services),
            )  # fmt: skip


def _asks_for_a_person(node: str) -> bool:
    return is_viewer(node) or is_tool(node)
