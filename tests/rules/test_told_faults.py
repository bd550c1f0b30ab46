# SPDX-License-Identifier: Apache-2.0
"""A hundred faults in words, each beside a healthy twin: told, with the words that were asked for."""

from __future__ import annotations

from collections.abc import Iterable

import pytest
from graph_calls import check, diagnose, seen_plan
from told_faults import by_check, by_doctor, faults, tells

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.findings.selection import grouped as by_robots

NAMED = {it.name: it for it in faults()}


@pytest.mark.more
@pytest.mark.sample(12)
@pytest.mark.parametrize("name", NAMED)
def test_the_twin_is_healthy_and_the_fault_is_told(name: str) -> None:
    fault = NAMED[name]
    bad, twin = fault.faulty(), fault.healthy()
    assert [str(it) for it in (*by_doctor(twin), *by_check(twin, twin))] == []
    told = {
        command
        for command, found in (("doctor", by_doctor(bad)), ("check", by_check(twin, bad)))
        if tells(fault, found)
    }
    assert told == {"doctor", "check"} - {*fault.unknown}
    without = grouped(by_doctor(bad))
    changed = check(seen_plan(diagnose(twin)), bad, before=twin)
    # One cause is one line, also with a plan or an earlier snapshot.
    for found in (grouped(by_check(twin, bad)), grouped(changed)):
        assert len(found) <= max(1, len(without)), [str(it) for it in found]
        assert bool(found) >= bool(without)


def grouped(found: Iterable[Finding]) -> list[Finding]:
    return by_robots(found, {f"robot{it}": f"robot{it}" for it in range(1, 4)})


def test_of_a_hundred_nearly_all_can_be_told() -> None:
    assert len(NAMED) == len(faults()) >= 100
    assert sum("doctor" not in it.unknown for it in faults()) >= 90
    assert sum("check" not in it.unknown for it in faults()) >= 97
