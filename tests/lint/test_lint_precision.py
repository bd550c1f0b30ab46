# SPDX-License-Identifier: Apache-2.0
"""The table of how often rules are right: enough was judged, and what is often wrong is a note."""

from __future__ import annotations

import pytest
from lint_precision import (
    IN_PACKAGES,
    PLANTED,
    Precision,
    hits,
    planted,
    precision_page,
    precisions,
)
from paths import CORPUS, ROOT

from multibot_rewrite.base.findings.finding import NOTE
from multibot_rewrite.lint.registry import RULES

JUDGED, RIGHT = 10, 0.95
LEAST_DEFECTS, LEAST_ODDITIES = 100, 60
TABLE = precisions()
REPOSITORIES, FALSE = ROOT / "fixtures" / "lint" / "repositories.tsv", 0.03


def test_every_rule_comes_once() -> None:
    assert sorted({it.code for it in TABLE}) == [it.code for it in TABLE]


@pytest.mark.parametrize("row", TABLE, ids=[it.code for it in TABLE])
def test_enough_was_judged_and_enough_is_true(row: Precision) -> None:
    assert min(row.hits, JUDGED) <= row.judged <= max(row.hits, row.judged)
    assert row.true <= row.judged
    assert row.referee, "what was run or read"
    if row.judged and RULES[row.code].level != NOTE:
        assert row.true / row.judged >= RIGHT


def test_few_findings_in_unseen_repositories_are_false() -> None:
    """The sums of the kept table are those of the page."""
    _, *rows = (
        it.split("\t") for it in REPOSITORIES.read_text().splitlines() if not it.startswith("#")
    )
    sums = [sum(int(row[column]) for row in rows) for column in range(1, 7)]
    assert sums[2] + sums[5] <= FALSE * sum(sums)
    page = (ROOT / "docs" / "contributing" / "measurements.md").read_text()
    for level, of_level in (("errors", sums[:3]), ("warnings", sums[3:])):
        assert f"| {level} | {' | '.join(map(str, of_level))} |" in page


HALVES = {
    "worked": "22 worked on, at first sight",
    "kept": "18 kept, once",
    "worked-3": "15 worked on, at first sight",
    "kept-3": "15 kept, once",
    "fresh-4": "16 more after the mends, once",
    "fresh-5": "8 more after those, once",
    "worked-6": "15 worked on, a sixth sample, at first sight",
    "kept-6": "15 kept of the sixth, once",
    "again-6": "15 more of its order, once",
    "worked-7": "8 worked on, a seventh sample, at first sight",
    "kept-7": "7 kept of the seventh, once",
}


def test_what_later_repositories_showed_is_on_the_page() -> None:
    """Of these more is false than is wanted, and the page says so."""
    table = REPOSITORIES.with_name("repositories_later.tsv").read_text().splitlines()
    _, *rows = (it.split("\t") for it in table if not it.startswith("#"))
    page = (ROOT / "docs" / "contributing" / "measurements.md").read_text()
    for half, words in HALVES.items():
        counts = [map(int, row[2:]) for row in rows if row[0] == half]
        sums = [sum(column) for column in zip(*counts, strict=True)]
        assert f"| {words} | {' | '.join(map(str, sums))} |" in page


@pytest.mark.deep
def test_the_page_is_up_to_date() -> None:
    """It has the planted defects and healthy oddities as the lint finds them now: each is a row of a
    test of its own, too."""
    page = (ROOT / "docs" / "contributing" / "measurements.md").read_text()
    assert f"#{precision_page().strip()}\n" in page


@pytest.mark.deep
def test_enough_defects_are_planted_and_found() -> None:
    counts = [planted(it) for it in PLANTED]
    assert sum(it.found for it in counts) >= LEAST_DEFECTS
    assert sum(it.found for it in counts) >= RIGHT * sum(it.defects for it in counts)
    assert sum(it.healthy for it in counts) >= LEAST_ODDITIES


@pytest.mark.deep
def test_the_hits_are_those_of_today() -> None:
    """After a change that is meant judge what is new: python tests/support/lint_precision.py counts."""
    if not CORPUS.exists():
        pytest.skip(f"no public files in {CORPUS}")
    now = hits()
    assert {it.code: it.hits for it in TABLE if it.code not in IN_PACKAGES} == {
        it.code: now[it.code] for it in TABLE if it.code not in IN_PACKAGES
    }
