# SPDX-License-Identifier: Apache-2.0
"""The page of seeded faults: ``python tests/support/graph_faults_page.py --write``."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

from built_faults import BUILT
from fault_changes import Fault, nav, shared_tf, simulation
from fault_sources import SOURCES
from graph_faults import FAULTS, LIVE, needed
from healthy_systems import SYSTEMS, plan
from paths import fixture_text

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.wording import plural
from multibot_rewrite.live.diagnose import diagnose
from multibot_rewrite.rules.check import check
from multibot_rewrite.system.records import System

HEAD = fixture_text("graph_faults_page_head.txt")
# The systems that are those of a plan.
PLANS = {
    nav: lambda: plan(("nav2",), "L1"),
    shared_tf: lambda: plan(("nav2",), "L2"),
    simulation: lambda: plan(("nav2",), "L1", ("robot1", "robot2", "robot3")),
}
# What a plan has and is not there: what reads it waits for that.
LACKS = {"MG101", "MG102", "MG109"}
Asked = Callable[[System], tuple[Finding, ...]]


class Cell(NamedTuple):
    """What one command finds of a fault: the codes, whether the finding of the fault's own code has its
    words, and what the source lacks if that code is not among them."""

    codes: tuple[str, ...]
    cause: bool
    lacks: str = ""

    @property
    def text(self) -> str:
        return ": ".join(filter(None, (", ".join(self.codes), self.lacks and f"no {self.lacks}")))


@cache
def cell(fault: Fault, column: str) -> Cell:
    """Return what is found of the fault in a source."""
    source = SOURCES[column]
    found = diagnose(source.read(fault.change(fault.system()))).findings
    lacks = next((it for it in needed(fault) if it in source.lacks), "")
    return _cell(fault, found, lacks, column == "check-launch")


def _cell(
    fault: Fault, found: tuple[Finding, ...], lacks: str = "", may_be_more: bool = False
) -> Cell:
    """``may_be_more``: an error may be a warning, as another launch file may start what is missing."""
    levels = {fault.level, WARNING} if may_be_more else {fault.level}
    own = [it for it in found if it.code == fault.code and it.level in levels]
    cause = any(all(word in str(it) for word in fault.words) for it in own)
    codes = sorted({it.code for it in found})
    return Cell(tuple(codes), cause, "" if fault.code in codes else lacks)


@cache
def planned_cell(fault: Fault) -> Cell | None:
    """Return what is found besides with the plan of the system; None for a system without one."""
    if fault.system not in PLANS:
        return None
    planned = PLANS[fault.system]()
    before = _healthy_findings(planned, fault.system())
    found = check(planned, fault.change(fault.system()))
    return _cell(fault, tuple(it for it in found if it not in before))


@cache
def _healthy_findings(planned: System, graph: System) -> frozenset[Finding]:
    return frozenset(check(planned, graph))


def lines() -> Iterator[str]:
    """Yield the page."""
    yield HEAD
    rows = {fault: {name: cell(fault, name) for name in SOURCES} for fault in FAULTS}
    causes = sum(it["file"].cause for it in rows.values())
    yield f"{plural(len(rows), 'fault')}, {causes} found with the cause; {len(LIVE)} of them live."
    yield f"{len(SYSTEMS)} healthy systems: 0 findings each, in each source."
    yield ""
    each = lists_by_key((it.code, it) for it in FAULTS)
    yield "| shown by | faults | of which codes none | of which codes some |"
    yield "|---|--:|---|---|"
    for name, is_shown in _ways():
        count = {code: sum(map(is_shown, own)) for code, own in each.items()}
        none = [code for code in each if not count[code]]
        some = [code for code in each if 0 < count[code] < len(each[code])]
        cells = (name, f"{sum(count.values())}", " ".join(none) or "-", " ".join(some) or "-")
        yield f"| {' | '.join(cells)} |"


def _ways() -> Iterator[tuple[str, Callable[[Fault], bool]]]:
    """Yield each way in which a fault may be shown, and whether a fault is."""
    yield "an error", lambda it: it.level == ERROR
    yield "live", lambda it: it.name in LIVE
    yield "with the plan", lambda it: bool((found := planned_cell(it)) and found.codes)
    for name in (name for name in SOURCES if name != "file"):
        yield name, lambda it, name=name: bool(cell(it, name).codes)
    yield "build", lambda it: it.name in BUILT


if __name__ == "__main__":
    text = "".join(f"{line}\n" for line in lines())
    sys.stdout.write(text)
    if sys.argv[1:] == ["--write"]:
        sys.path.append(str(Path(__file__).parents[2] / "benchmarks"))
        from one_page import write_section

        write_section(text)
