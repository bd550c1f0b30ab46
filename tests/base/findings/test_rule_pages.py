# SPDX-License-Identifier: Apache-2.0
"""Pages of rules: each rule has one, each page is of a rule, and what a page may look like."""

from __future__ import annotations

from pathlib import Path

from multibot_rewrite.base.findings.finding import FOLDER
from multibot_rewrite.lint import catalogue
from multibot_rewrite.lint.registry import RULES
from multibot_rewrite.rules.launch.judge import RULES as LAUNCHED

PAGES = {it.stem for it in Path(FOLDER).glob("*.md")}
OTHER_EXAMPLES = {it.examples for it in (*RULES.values(), *LAUNCHED) if it.examples}


def test_each_rule_has_a_page_and_each_page_a_rule() -> None:
    assert catalogue.rules().keys() == PAGES - OTHER_EXAMPLES
    assert OTHER_EXAMPLES <= PAGES
