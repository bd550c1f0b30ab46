# SPDX-License-Identifier: Apache-2.0
"""A hundred faults in words, each beside a healthy twin: told, with the words that were asked for."""

from __future__ import annotations

import pytest
from told_faults import by_check, by_doctor, faults, tells

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


def test_of_a_hundred_nearly_all_can_be_told() -> None:
    assert len(NAMED) == len(faults()) >= 100
    assert sum("doctor" not in it.unknown for it in faults()) >= 90
    assert sum("check" not in it.unknown for it in faults()) >= 97
