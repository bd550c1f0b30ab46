# SPDX-License-Identifier: Apache-2.0
"""Rules about what nodes answer by a plan: parameters, and the machines that they run on."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.wording import FEW, SEVERAL, shorten
from multibot_rewrite.rules.declaration import planned_rule
from multibot_rewrite.system.environment import machines
from multibot_rewrite.system.index import Index, once
from multibot_rewrite.system.parameters import parameter_value
from multibot_rewrite.system.records import SIM_TIME, UNTOLD, Parameter

# A planned parameter, and its value there.
Difference = tuple[Parameter, str]


@planned_rule("MG132", "parameter-not-planned", ERROR)
def parameter_not_planned(plan: Index, seen: Index) -> Iterator[Finding]:
    """Report parameters with another value than planned, one finding a node."""
    told = (it for it in seen.system.parameters if (it.name, it.value) != (SIM_TIME, UNTOLD))
    values = {(it.node, it.name): it.value for it in told}
    for node, planned in lists_by_key((it.node, it) for it in plan.system.parameters).items():
        known = [(it, values[node, it.name]) for it in planned if (node, it.name) in values]
        found = [(it, value) for it, value in known if not _is_same(it.value, value)]
        # What makes it an error comes first.
        found.sort(key=lambda it: not _is_serious(plan, it[0]))
        if not found:
            continue
        places = [f" ({it.place})" if it.place.file else "" for it, _ in found]
        listed = [
            f"{it.name} is {value}, planned is {it.value}{at}"
            for (it, value), at in zip(found, places, strict=True)
        ]
        robot, (first, _) = plan.robot_of.get(node, ""), found[0]
        file = first.place.file
        start = f"start it with {file}" if file else "change it, or states of the plan"
        # The robot whose node of that name is planned to have these values.
        plain, having = (
            plan.of_names.without_robot(node, plan.robot_of.get(node, "")),
            _robots_by_value(plan),
        )
        wanted = [having.get((plain, it.name, value), {}) for it, value in found]
        # What few have first: most have most values.
        few, *others = sorted(wanted, key=len)
        other = next((it for it in few if all(it in having for having in others)), "")
        hint = f"has it the parameters of {other}? {start}" if other else start
        more = f"; {len(found) - FEW} more" if len(found) > FEW else ""
        yield parameter_not_planned.finding(
            "; ".join(listed[:FEW]) + more, hint, level=ERROR if _is_serious(plan, first) else WARNING,
            robot=robot, node=node, names=tuple(it.name for it, _ in found),
        )  # fmt: skip


def _is_same(planned: str, value: str) -> bool:
    """Return whether two values are the same: 1 is 1.0, as people write either; true is not 1."""
    if planned == value or not {"true", "false"}.isdisjoint((planned, value)):
        return planned == value
    return bool(parameter_value(planned) == parameter_value(value))


def _is_serious(plan: Index, it: Parameter) -> bool:
    """Return whether a parameter has no file that sets it, or is a frame of its robot."""
    frames = plan.frames_of.get(plan.robot_of.get(it.node, ""), frozenset())
    named = [*frames, *(f"/{frame}" for frame in frames)]
    return not it.place.file or parameter_value(it.value) in named


@once
def _robots_by_value(plan: Index) -> Mapping[tuple[str, str, str], Mapping[str, None]]:
    """Return the robots whose node of a plain name is planned with a parameter's value, in order."""
    found: dict[tuple[str, str, str], dict[str, None]] = defaultdict(dict)
    for it in plan.system.parameters:
        if robot := plan.robot_of.get(it.node, ""):
            plain = plan.of_names.without_robot(it.node, robot)
            found[plain, it.name, it.value][robot] = None
    return found


@planned_rule("MG133", "host-not-planned", ERROR)
def host_not_planned(plan: Index, seen: Index) -> Iterator[Finding]:
    """Yield nodes that run away from most nodes of their host: snapshots know machines, not names."""
    machine_of = {node: it for it, nodes in machines(seen.system).items() for node in nodes}
    # Host of the plan -> machine -> the nodes that run there.
    hosts: dict[str, dict[str, list[str]]] = {}
    for it in plan.system.nodes:
        if it.host and it.name in machine_of:
            here = hosts.setdefault(it.host, {})
            here.setdefault(machine_of[it.name], []).append(it.name)
    homes = {
        host: max(sorted(found), key=lambda it: len(found[it])) for host, found in hosts.items()
    }
    for host, found in hosts.items():
        away = [node for it, nodes in found.items() if it != homes[host] for node in nodes]
        if away:
            message = f"not on {host}, where {shorten(found[homes[host]])} runs: {shorten(away)}"
            yield _on_wrong_host(plan, message, away, "start it there, or change host in the plan")
    for machine in dict.fromkeys(homes.values()):
        own = [host for host, home in homes.items() if home == machine]
        if len(own) > 1:
            message = f"hosts {shorten(own, SEVERAL)} are one machine"
            nodes = hosts[own[1]][machine]
            yield _on_wrong_host(plan, message, nodes, "is this a simulation? Then leave out host")


def _on_wrong_host(plan: Index, message: str, nodes: Sequence[str], hint: str) -> Finding:
    robot = plan.robot_of.get(nodes[0], "")
    return host_not_planned.finding(message, hint, robot=robot, node=nodes[0], names=tuple(nodes))
