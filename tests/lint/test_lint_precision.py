"""The table of how often rules are right: enough was judged, and what is often wrong is a note."""

from __future__ import annotations

import pytest
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
