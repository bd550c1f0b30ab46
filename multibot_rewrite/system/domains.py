# SPDX-License-Identifier: Apache-2.0
"""A plan of several ROS domains -> the plan of each; what was seen of them -> one view. Pure."""

from __future__ import annotations

import re
from collections.abc import Mapping

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.wording import only, unique
from multibot_rewrite.system.merging import WORST_LAST, joined
from multibot_rewrite.system.ownership import renamed, whose_by_plan
from multibot_rewrite.system.records import System

# That of nodes of all robots, where a plan does not say another.
USUAL_DOMAIN = 0
# What robots without names are called where those of several domains are in one view.
_WORD = "domain_"
_FULL, _SHORT = re.compile(rf"/{_WORD}(\d+)(/[\w/]+)"), re.compile(rf"\b{_WORD}(\d+)\b")


def domain_of(plan: System) -> dict[str, int]:
    """Return the domain by robot, with "" for all robots; empty for a plan of one domain."""
    if not plan.domains:
        return {}
    told = {it.robot: it.number for it in plan.domains}
    shared = told.get("", USUAL_DOMAIN)
    return {"": shared, **{it.name: told.get(it.name, shared) for it in plan.robots}}


def by_domain(plan: System) -> dict[int, System]:
    """Return the plan, without its gaps, of each domain with nodes; empty for a plan of one domain."""
    numbers = domain_of(plan)
    own = {it.name: numbers[it.robot] for it in plan.nodes} if numbers else {}
    return {it: _of_domain(plan, numbers, own, it) for it in sorted({*own.values()})}


def seen_by_domain(plan: System, seen: System) -> dict[int, System]:
    """Return a view of nodes in several domains as one view of each domain.

    A node is in the domain that the plan has for it, in that of its robot, by its name or all its
    ends, or in that of all robots; if nothing is planned there, in the first one."""
    numbers, robot = domain_of(plan), whose_by_plan(plan).robot
    planned = {it.name: it.robot for it in plan.nodes}
    in_use = {numbers[it] for it in planned.values()}
    theirs = lists_by_key((it.node, robot(it.name)) for it in seen.ends)

    def domain(node: str) -> int:
        if node in planned:
            return numbers[planned[node]]
        number = numbers[robot(node) or only(unique(filter(None, theirs[node])))]
        return number if number in in_use else min(in_use)

    own = {it.name: domain(it.name) for it in seen.nodes}
    return {at: _part_of_domain(seen, own, at) for at in sorted(in_use)}


def _part_of_domain(system: System, own: Mapping[str, int], at: int) -> System:
    """Return the part of a system that nodes of a domain have; a transform of several is in each."""
    nodes = {it for it, number in own.items() if number == at}
    ends = tuple(it for it in system.ends if it.node in nodes)
    sent = {it.name for it in ends}
    shared = (it for it in system.edges if not nodes.isdisjoint(it.publishers))
    edges = (
        it._replace(publishers=tuple(filter(nodes.__contains__, it.publishers))) for it in shared
    )
    return system._replace(
        nodes=tuple(it for it in system.nodes if it.name in nodes),
        ends=ends,
        edges=tuple(it._replace(several=len(it.publishers) > 1) for it in edges),
        heard=tuple(it for it in system.heard if it.topic in sent),
        descriptions=tuple(it for it in system.descriptions if it.topic in sent),
        parameters=tuple(it for it in system.parameters if it.node in nodes),
        controllers=tuple(it for it in system.controllers if it.manager in nodes),
        interfaces=tuple(it for it in system.interfaces if it.node in nodes),
        lookups=tuple(it for it in system.lookups if it.node in nodes),
        addresses=tuple(it for it in system.addresses if it.node in nodes),
    )


def _of_domain(plan: System, numbers: Mapping[str, int], own: Mapping[str, int], at: int) -> System:
    part, robot = _part_of_domain(plan, own, at), whose_by_plan(plan).robot
    nodes = {it.name for it in part.nodes}
    return part._replace(
        edges=tuple(it for it in plan.edges if nodes.issuperset(it.publishers)),
        robots=tuple(it for it in plan.robots if numbers[it.name] == at),
        topics=tuple(it for it in plan.topics if numbers[robot(it.name)] == at),
        gaps=(),
        domains=(),
    )


def side_by_side(seen: Mapping[int, System]) -> System:
    """Return the views of all domains as one, in which limitations name their domain."""
    views = tuple(seen.values())
    if len(views) == 1:
        return views[0]
    looks = [it.environment for it in seen.values()]
    return joined(*views)._replace(
        environment=looks[0]._replace(
            participants=sum(it.participants for it in looks),
            settled=max((it.settled for it in looks), key=WORST_LAST.index),
            seconds=max(it.seconds for it in looks),
            caveats=tuple(
                it._replace(message=f"domain {number}: {it.message}")
                for number, one in seen.items()
                for it in one.environment.caveats
            ),
        ),
    )


def space_of(domain: int) -> str:
    """Return the namespace for a robot without a name in this domain."""
    return f"/{_WORD}{domain}"


def named(view: System, domain: int) -> System:
    """Return the view of a robot without a name, below a name for its domain."""
    return renamed(view, lambda name: f"{space_of(domain)}{name}")


def unnamed(it: Finding) -> Finding:
    """Return a finding of ``named`` views in the names that run: ``/amcl of domain 11``."""
    return it._replace(
        message=_with_domain_last(it.message),
        hint=_with_domain_last(it.hint),
        robot=_with_domain_last(it.robot),
        node=_FULL.sub(r"\2", it.node),
        names=tuple(_FULL.sub(r"\2", name) for name in it.names),
    )


def _with_domain_last(text: str) -> str:
    """Return a text with ``NAME of domain 11`` where it has the name for that domain."""
    return _SHORT.sub(r"domain \1", _FULL.sub(r"\2 of domain \1", text))
