"""The table of how often rules are right: enough was judged, and what is often wrong is a note."""

from __future__ import annotations

import pytest
import test_lint_beside as beside
import test_lint_gazebo as gazebo
import test_lint_geometry as geometry
import test_lint_systems as systems
from lint_triage import Precision, precision_page, precisions
from paths import ROOT

from multibot_rewrite.findings.finding import NOTE
from multibot_rewrite.lint.registry import RULES

JUDGED, RIGHT = 10, 0.95
TABLE = precisions()


def test_every_rule_comes_once() -> None:
    assert sorted({it.code for it in TABLE}) == [it.code for it in TABLE]


@pytest.mark.parametrize("row", TABLE, ids=[it.code for it in TABLE])
def test_enough_was_judged_and_enough_is_true(row: Precision) -> None:
    assert min(row.hits, JUDGED) <= row.judged <= max(row.hits, row.judged)
    assert row.true <= row.judged
    assert row.referee, "what was run or read"
    if row.judged and RULES[row.code].level != NOTE:
        assert row.true / row.judged >= RIGHT


def test_the_page_is_up_to_date() -> None:
    assert (ROOT / "docs/lint-precision.md").read_text() == precision_page()


def test_the_page_counts_what_is_planted() -> None:
    for module in (gazebo, systems, geometry, beside):
        row = f"`{module.__name__.rpartition('.')[2]}.py`) | {len(module.PLANTED)} |"
        (line,) = [it for it in precision_page().splitlines() if row in it]
        assert line.endswith(f"| {len(module.PLANTED)} | {len(module.HEALTHY)} |")
