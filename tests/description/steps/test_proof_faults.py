# SPDX-License-Identifier: Apache-2.0
"""The proof refuses wrong outputs, wrong plans and wrong readings, each by the check that is for it.

The faults are in ``fixtures/proof_faults.txt`` and ``tests/support/wrong_*.py``.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator

import pytest
from proof_faults import ARM, SOURCES, Fault, read_faults
from wrong_plans import PLANS, Fault as Step
from wrong_readings import READINGS

from multibot_rewrite import ProofError, rewrite
from multibot_rewrite.description import pipeline
from multibot_rewrite.description.steps import verify as proof

Check = Callable[[proof.Evidence], None]
CHECKS = proof.CHECKS
TEXTS = read_faults()
STEPS = [*PLANS, *READINGS]
FILL = "fill"
LEAST = 80
# What refuses a text that cannot be read, or a marker in it: no check comes after it.
UNREADABLE = "unreadable"


def planted(monkeypatch: pytest.MonkeyPatch, fault: Fault | Step) -> None:
    """Put the fault into the package."""
    if isinstance(fault, Step):
        monkeypatch.setattr(fault.module, fault.function, fault.planted())
        return
    right = getattr(pipeline, FILL)
    monkeypatch.setattr(pipeline, FILL, lambda pieces, robot: fault.planted(right(pieces, robot)))


def is_refused(
    monkeypatch: pytest.MonkeyPatch, source: str, layout: str, checks: Iterable[Check]
) -> bool:
    """Is the rewrite of a source refused by the proof, if it has no other checks than these?"""
    monkeypatch.setattr(proof, "CHECKS", tuple(checks))
    beside = {"urdf": ARM} if source == "groups" else {}
    try:
        rewrite(SOURCES[source], "robot1", layout=layout, **beside)
    except ProofError:
        return True
    return False


def refusing(monkeypatch: pytest.MonkeyPatch, fault: Fault | Step) -> Iterator[str]:
    """Yield the checks that refuse a fault, each by itself, in their order."""
    planted(monkeypatch, fault)
    if is_refused(monkeypatch, fault.source, fault.layout, ()):
        yield UNREADABLE
        return
    for check in CHECKS:
        if is_refused(monkeypatch, fault.source, fault.layout, [check]):
            yield check.__name__


@pytest.mark.sample(3)
@pytest.mark.parametrize("fault", [*TEXTS, *STEPS], ids=lambda fault: fault.about)
def test_a_fault_is_refused_by_the_check_that_is_for_it(
    monkeypatch: pytest.MonkeyPatch, fault: Fault | Step
) -> None:
    assert next(refusing(monkeypatch, fault), "") == fault.refused_by


@pytest.mark.parametrize("source", SOURCES)
@pytest.mark.parametrize("layout", ["both", "postfix"])
def test_without_a_fault_nothing_is_refused(
    monkeypatch: pytest.MonkeyPatch, source: str, layout: str
) -> None:
    assert not is_refused(monkeypatch, source, layout, CHECKS)


def test_no_fault_was_lost() -> None:
    every = Counter(it.about for it in (*TEXTS, *STEPS))
    assert [about for about, times in every.items() if times > 1] == []
    assert len(TEXTS) >= LEAST
    assert len(STEPS) >= LEAST


# For each check, faults that all others let pass.
ONLY = {
    "same_names": ["claims in another order", "the slot of the model's name in a marker"],
    "same_targets": ["a value without names", "a use that is not resolved"],
    "robots_own": ["an insertion without a separator"],
    "nothing_to_add": ["an insertion forgotten", "a rule for another topic"],
    "added_once": ["an insertion of what is there", "a rule twice"],
    "a_slot_each": ["an edit with the robot's name as it is"],
    "strips_to_source": [
        "an edit of a line end",
        "nothing is stripped",
        "a blank added",
        "no value is stripped",
    ],
    "as_decided": ["an insertion that is written otherwise"],
    "as_planned": ["a marker says something else", "an inserted element has another indentation"],
}


def test_every_check_is_tried_alone() -> None:
    assert [check.__name__ for check in CHECKS] == [*ONLY]


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("name", "about"), [(name, about) for name, abouts in ONLY.items() for about in abouts]
)
def test_without_one_check_a_fault_passes(
    monkeypatch: pytest.MonkeyPatch, name: str, about: str
) -> None:
    """A check that no such fault can be found for is not needed."""
    fault = next(it for it in (*TEXTS, *STEPS) if it.about == about)
    planted(monkeypatch, fault)
    others = [check for check in CHECKS if check.__name__ != name]
    assert not is_refused(monkeypatch, fault.source, fault.layout, others)
    assert is_refused(monkeypatch, fault.source, fault.layout, CHECKS)
