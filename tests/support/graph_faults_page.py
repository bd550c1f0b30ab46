"""The page of seeded faults: ``python tests/support/graph_faults_page.py > docs/graph-faults.md``."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from functools import cache
from typing import NamedTuple

from fault_changes import Fault, nav, shared_tf, simulation
from graph_faults import FAULTS, LIVE
from healthy_systems import SYSTEMS, plan

from multibot_rewrite.base.findings.finding import ERROR, Finding
from multibot_rewrite.base.plural import plural
from multibot_rewrite.live.diagnose import diagnose
from multibot_rewrite.producers.bags.recording import RECORDER, ROSBAG
from multibot_rewrite.rules.check import check
from multibot_rewrite.system.records import PUBLISHES, System

HEAD = """\
# Seeded faults

Made by `python tests/support/graph_faults_page.py > docs/graph-faults.md`. Each row is a fault that was
put into a system in which nothing was wrong (`tests/support/graph_faults.py`): what `multibot check`
finds without a plan, its exit code, whether the finding names who did it and what to do (*cause*),
which codes `multibot check` adds with the plan of the system, and which are found in a recording of it
without a plan. `-`: nothing more than in the healthy system; no entry: the system has no plan.
`check-launch` asks the same of the system that a launch file makes. With a plan nothing is hidden
(`tests/live/test_inclusion.py`): a name that a node lacks by its plan is MG102 or MG101 there. A
recording has neither nodes nor who reads: faults of these alone are not in it.
*Live*: played by real nodes as well (`tests/live/test_live_doctor.py`).
"""
# The systems that are those of a plan.
PLANS = {
    nav: lambda: plan(("nav2",), "L1"),
    shared_tf: lambda: plan(("nav2",), "L2"),
    simulation: lambda: plan(("nav2",), "L1", ("robot1", "robot2", "robot3")),
}


class Outcome(NamedTuple):
    """What came of a fault."""

    found: bool
    code: str
    level: str
    exit: int
    cause: bool
    checked: str
    recorded: str


def outcome(fault: Fault) -> Outcome:
    """Look at the faulty system with and without its plan."""
    graph = fault.change(fault.system())
    findings = diagnose(graph).findings
    hits = [it for it in findings if it.code == fault.code and it.level == fault.level]
    named = any(all(word in str(it) for word in fault.words) for it in hits)
    failed = any(it.level == ERROR for it in findings)
    both = _checked(fault, graph), _recorded(fault, graph)
    return Outcome(bool(hits), fault.code, fault.level, int(failed), named, *both)


def _checked(fault: Fault, graph: System) -> str:
    if fault.system not in PLANS:
        return ""
    planned = PLANS[fault.system]()
    before = _healthy_findings(planned, fault.system())
    new = {it.code for it in check(planned, graph) if it not in before}
    return ", ".join(sorted(new)) or "-"


def _recorded(fault: Fault, graph: System) -> str:
    before = {it.code for it in diagnose(recording(fault.system())).findings}
    new = {it.code for it in diagnose(recording(graph)).findings} - before
    return ", ".join(sorted(new)) or "-"


def recording(graph: System) -> System:
    """What a bag of the system holds: what was sent, and not by whom."""
    sent = (it._replace(node=RECORDER) for it in graph.ends if it.role == PUBLISHES)
    edges = (it._replace(publishers=(RECORDER,), several=False) for it in graph.edges)
    around = graph.environment._replace(rmw=ROSBAG)
    return System((), tuple(sent), tuple(edges), around, graph.heard)


@cache
def _healthy_findings(planned: System, graph: System) -> frozenset[Finding]:
    return frozenset(check(planned, graph))


def lines() -> Iterator[str]:
    """The page."""
    yield HEAD
    found = [(fault, outcome(fault)) for fault in FAULTS]
    causes = sum(it.cause for _, it in found)
    yield f"{plural(len(found), 'fault')}, {sum(it.found for _, it in found)} found, {causes} with the"
    yield f"cause; {len(LIVE)} of them live. {len(SYSTEMS)} healthy systems: 0 findings each."
    yield ""
    yield "| fault | no plan | level | exit | cause | live | with the plan | recorded |"
    yield "|---|---|---|--:|---|---|---|---|"
    for fault, it in found:
        code = it.code if it.found else "not found"
        live = "yes" if fault.name in LIVE else ""
        cause = "yes" if it.cause else "no"
        said = f"{code} | {it.level} | {it.exit} | {cause} | {live} | {it.checked} | {it.recorded}"
        yield f"| {fault.name} | {said} |"
    yield ""
    yield "Healthy systems:"
    yield ""
    yield from (f"- {name}" for name in SYSTEMS)


if __name__ == "__main__":
    sys.stdout.write("".join(f"{line}\n" for line in lines()))
