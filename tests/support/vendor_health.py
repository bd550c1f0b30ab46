# SPDX-License-Identifier: Apache-2.0
"""A healthy system of a vendor: the nodes that its launch files start, with what their sources declare.

Names and namespaces are those of ``launch_recorder.py``, remap rules those and, for what they do not
separate, those of the remap table; topics, services and actions are those of
``fixtures/interfaces/RELEASE.tsv.xz``. Only values of parameters are taken from the plan. What a
node without such a row has is not known here: it is left out of the plan that is compared, too.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from declared_graph import endpoints, facts
from nav2_graphs import environment
from vendor_systems import OTHER, ROBOT, Outcome, Started

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.planning.records import Rules, Run
from multibot_rewrite.rules.check import check
from multibot_rewrite.system.records import End, Node, System

TF = ("/tf", "/tf_static")
_EKF = "robot_localization/ekf_node"
_TWIST = "geometry_msgs/msg/Twist"


def findings(found: Outcome, release: str, kinds: Mapping[str, str]) -> tuple[Finding, ...]:
    """Return what ``check`` says of two robots that run as the vendor starts them."""
    known = {it.name: _unstamped(it) for it in found.fleet.facts}
    rules = {it.full_name: it.rules for it in found.fleet.table.runs}
    nodes: list[str] = []
    ends: list[End] = []
    declared: set[str] = set()
    for it in two(found.started.values()):
        nodes.append(it.name)
        short = it.name.removeprefix(f"/{ROBOT}/").removeprefix(f"/{OTHER}/")
        kind = kind_of(it, short, release, kinds)
        if kind and short in known:
            declared.add(it.name)
            table = placed(it, short, rules.get(it.name, ()))
            ends += _as_set(it, endpoints(kind, known[short], table, release))
    owners = dict.fromkeys([*nodes, *(it.node for it in ends)])
    seen = System(tuple(Node(it, it) for it in owners), tuple(ends), (), environment())
    return tuple(check(_of(found.launched, declared), seen))


def _unstamped(node: NodeFacts) -> NodeFacts:
    """Return the node without the plan's choice of the type of commands: ``_as_set`` makes its own."""
    ends = (it._replace(type=it.type.replace(f"{_TWIST}Stamped", _TWIST)) for it in node.endpoints)
    return node._replace(endpoints=tuple(ends))


def _as_set(node: Started, ends: Iterable[End]) -> Iterator[End]:
    """Its ends with the type of commands that its parameters choose (use_stamped, stamped_control). The
    filter reads commands with use_control alone (ros_filter.cpp)."""
    stamped = any("stamped" in it for it in node.parameters)
    controlled = "use_control" in node.parameters
    for it in ends:
        if it.role == "subscribes" and it.type == _TWIST and node.by == _EKF and not controlled:
            continue
        chosen = stamped and it.type == _TWIST
        yield it._replace(type=f"{_TWIST}Stamped") if chosen else it


def two(nodes: Iterable[Started]) -> Iterator[Started]:
    """Yield the nodes of the first robot, and of the second as the same launch files start them."""
    for it in nodes:
        yield it
        if it.name.startswith(f"/{ROBOT}/"):
            rules = tuple((old, new.replace(ROBOT, OTHER)) for old, new in it.rules)
            yield it._replace(name=it.name.replace(ROBOT, OTHER), rules=rules)


def kind_of(node: Started, short: str, release: str, kinds: Mapping[str, str]) -> str:
    """Return the node whose sources the facts are of; empty for none."""
    last = short.rpartition("/")[2]
    program = node.by.rpartition("/")[2].removesuffix("_driver")
    words = (short, last, "" if program == "spawner" else program)
    given = (kinds[last],) if last in kinds else words
    return next((it for it in given if it in facts(release)), "")


def placed(node: Started, short: str, more: Rules) -> Run:
    """Return the node under its name, with the remap rules that the launch gives it, then with
    those that it needs besides: vendors' launch files do not separate names that are absolute in
    the code."""
    namespace, _, name = node.name.rpartition("/")
    # tf is heard by a helper node in the namespace of the process, not in that of a costmap in it.
    rules = tuple(it for it in node.rules if "/" not in short or it[0] not in TF)
    return Run("", short, namespace or "/", name, (*rules, *more))


def _of(plan: System, nodes: Iterable[str]) -> System:
    """Return the plan without the endpoints of other nodes than these and those that they make."""
    mine = tuple(nodes)
    ends = tuple(it for it in plan.ends if it.node.startswith(mine))
    return plan._replace(ends=ends)
