# SPDX-License-Identifier: Apache-2.0
"""Pages of rules: each rule has one, each page is of a rule, and what a page may look like."""

from __future__ import annotations

from pathlib import Path

from multibot_rewrite.base.findings.codes import listed
from multibot_rewrite.base.findings.finding import FOLDER
from multibot_rewrite.lint import catalogue
from multibot_rewrite.lint.registry import RULES
from multibot_rewrite.rules.launch.judge import RULES as LAUNCHED

PAGES = {it.stem for it in Path(FOLDER).glob("*.md")}
OTHER_EXAMPLES = {it.examples for it in (*RULES.values(), *LAUNCHED) if it.examples}


def test_each_rule_has_a_page_and_each_page_a_rule() -> None:
    assert catalogue.rules().keys() == PAGES - OTHER_EXAMPLES
    assert OTHER_EXAMPLES <= PAGES


# Rules in words.

unused = RULES["MB002"]


def test_a_list_has_the_first_sentence_of_each_rule() -> None:
    said = "A `urdf-lint: ignore` comment names a code that it does not suppress"
    assert unused.what.startswith(f"{said}. ")
    assert list(listed([unused])) == [("MB002", "warning", "unused-suppression", said)]
