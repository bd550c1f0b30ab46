# SPDX-License-Identifier: Apache-2.0
"""Pages of rules: each rule has one, each page is of a rule, and what a page may look like."""

from __future__ import annotations

from pathlib import Path

import pytest
from paths import fixture_text

from multibot_rewrite.base.findings.finding import FOLDER, RulePage, read_page, rule_page
from multibot_rewrite.lint import catalogue
from multibot_rewrite.lint.registry import RULES
from multibot_rewrite.rules.launch.judge import RULES as LAUNCHED

PAGES = {it.stem for it in Path(FOLDER).glob("*.md")}
OTHER_EXAMPLES = {it.examples for it in (*RULES.values(), *LAUNCHED) if it.examples}
TEXT = fixture_text("rule_pages_text.txt")


def test_each_rule_has_a_page_and_each_page_a_rule() -> None:
    assert catalogue.rules().keys() == PAGES - OTHER_EXAMPLES
    assert OTHER_EXAMPLES <= PAGES


@pytest.mark.parametrize("code", sorted(catalogue.rules()))
def test_a_page_has_the_title_of_its_rule(code: str) -> None:
    text = (Path(FOLDER) / f"{code}.md").read_text()
    assert text.startswith(f"# {code} {catalogue.rules()[code].name}\n\n")
    assert all(rule_page(code)[:3])


def test_a_page_is_read_by_its_parts() -> None:
    assert read_page(TEXT) == RulePage(
        "It finds a thing.", "It hurts.", "Do this.", "<a>\n```\n</a>\n", "<a/>", "", 2,
        {"robot.urdf": "\n<robot/>\n"},
    )  # fmt: skip


def test_a_page_without_words_has_examples_alone() -> None:
    assert read_page("Bad:\n\n```\nx\n```\n") == RulePage(bad="x")
