# SPDX-License-Identifier: Apache-2.0
"""Sentences are short: in messages, rules, help and the pages that a user reads first."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
import said_texts
from paths import ROOT

from multibot_rewrite.lint import catalogue

MOST, MOST_OF_A_PARAGRAPH = 25, 120
# Tables of what was measured, and pages that programs write.
MEASURED = {"measurements", "strangers", "robots", "vendors", "nav2"}
PAGES = (
    *(ROOT / f"{it}.md" for it in ("README", "CONTRIBUTING", "SECURITY")),
    *sorted(ROOT.glob("examples/*/README.md")),
    *sorted((ROOT / "docs").glob("*.md")),
    *sorted((ROOT / "docs" / "tutorials").glob("*.md")),
    *(
        it
        for it in sorted((ROOT / "docs" / "contributing").glob("*.md"))
        if it.stem not in MEASURED
    ),
)
# Texts of the code that are no message: XML, Python, the examples of rules, a list of words.
NO_MESSAGE = re.compile(
    r"</|/>|<sdf|^def |^ankle arm |^(running|planned|as planned): |^[\d ]+$", re.MULTILINE
)


def test_a_long_sentence_is_seen() -> None:
    short, long = "one " * MOST, "one " * (MOST + 1)
    assert list(said_texts.long_sentences(f"{short}. {short}", MOST)) == []
    assert list(said_texts.long_sentences(f"`{long}` {short[4:]}", MOST)) == []
    assert list(said_texts.long_sentences(f"{short}. {long}. {short}", MOST)) == [f"{long}."]
    assert list(said_texts.long_parts(f"{short}; {short}", MOST)) == []
    assert list(said_texts.long_parts(f"{short}; {long}", MOST)) == [long.strip()]


def test_rules_have_short_sentences() -> None:
    found = {place: [*said_texts.long_sentences(it, MOST)] for place, it in said_texts.rule_words()}
    assert {place: it for place, it in found.items() if it} == {}


def test_help_has_short_sentences() -> None:
    found = {place: [*said_texts.long_parts(it, MOST)] for place, it in said_texts.help_words()}
    assert {place: it for place, it in found.items() if it} == {}


@pytest.mark.more
def test_messages_have_short_sentences() -> None:
    examples = {
        text
        for it in catalogue.rules().values()
        for text in (it.page.bad, it.page.good, it.page.fixed)
    }
    found = [
        (place, part)
        for place, text in said_texts.messages()
        if not NO_MESSAGE.search(text) and text not in examples
        for part in said_texts.long_parts(text, MOST)
    ]
    assert found == []


@pytest.mark.parametrize("page", PAGES, ids=lambda it: str(it.relative_to(ROOT)))
def test_a_page_has_short_sentences(page: Path) -> None:
    assert list(said_texts.long_sentences_of_a_page(page, MOST)) == []


# Pages that may have long paragraphs.
LONG_PARAGRAPHS: set[str] = set()
FENCE = re.compile(r"^( *)(`{3,}).*?^\1\2`*$", re.MULTILINE | re.DOTALL)


def long_paragraphs(text: str) -> list[str]:
    """Paragraphs, items and rows with too many words, each by its start."""
    parts = re.split(r"\n\s*\n|\n *- |\n *\d+\. |\n\|", FENCE.sub("\n\n", text))
    return [it[:60] for it in parts if len(it.split()) > MOST_OF_A_PARAGRAPH]


def test_a_long_paragraph_is_seen() -> None:
    half = "one " * (MOST_OF_A_PARAGRAPH // 2)
    assert long_paragraphs(f"{half}\n{half}\n\n{half}\n- {half}") == []
    assert len(long_paragraphs(f"{half}\n{half}more")) == 1
    assert long_paragraphs(f"{half}\n```sh\n{half}\n```\n{half}") == []


@pytest.mark.parametrize("page", PAGES, ids=lambda it: str(it.relative_to(ROOT)))
def test_a_page_has_short_paragraphs(page: Path) -> None:
    found = long_paragraphs(page.read_text())
    assert page.stem in LONG_PARAGRAPHS or found == []
    assert page.stem not in LONG_PARAGRAPHS or found, "this page is no exception any more"
