# SPDX-License-Identifier: Apache-2.0
"""The page of recipes: every command runs, prints what is shown, and every known question has one."""

from __future__ import annotations

import re
from pathlib import Path

import page_commands
import pytest
from paths import ROOT

pytestmark = pytest.mark.live

PAGE = (ROOT / "docs" / "recipes.md").read_text()
RECIPES = page_commands.sections(PAGE)
USUAL = [*RECIPES][::3]
THREADS = {
    heading: threads
    for it in (ROOT / "tests" / "support" / "recipe_threads.tsv").read_text().splitlines()
    if not it.startswith("#")
    for heading, threads in [it.split("\t")]
}
# Questions of users, numbered, with the threads they come from.
QUESTIONS = ROOT.parent / "shared" / "field" / "systems.md"
THREAD = re.compile(r"([\w.-]+)(?: PR)?#(\d+)")


@pytest.fixture(scope="module")
def tried(tmp_path_factory: pytest.TempPathFactory, tf2: dict[str, str]) -> page_commands.Tried:
    """Return what the commands of a third of the recipes do, side by side."""
    usual = {it: RECIPES[it] for it in USUAL}
    return page_commands.tried(usual, tmp_path_factory.mktemp("recipes"), 60, tf2)


@pytest.mark.parametrize("name", USUAL)
def test_a_recipe_prints_what_it_shows(name: str, tried: page_commands.Tried) -> None:
    page_commands.assert_as_shown(name, tried)


@pytest.mark.deep
@pytest.mark.parametrize("name", [it for it in RECIPES if it not in USUAL])
def test_another_recipe_prints_what_it_shows(
    name: str, tmp_path: Path, tf2: dict[str, str]
) -> None:
    found = page_commands.tried({name: RECIPES[name]}, tmp_path, 60, tf2)
    page_commands.assert_as_shown(name, found)


def test_every_recipe_has_a_question_an_answer_and_a_command() -> None:
    parts = re.split(r"^### ", PAGE, flags=re.MULTILINE)[1:]
    assert len(parts) == len(RECIPES) >= 30
    assert [it.split("\n", 1)[0] for it in parts] == [*THREADS]
    for part in parts:
        heading, rest = part.split("\n", 1)
        answer = rest.strip().split("\n\n")[0]
        assert heading.count('"') >= 2, heading
        sentences = re.split(r"(?<=[.:])\s+(?=[A-Z`])", answer.strip())
        assert 1 <= len(sentences) <= 5, (heading, sentences)


def test_links_of_the_page_lead_somewhere() -> None:
    for target in re.findall(r"\]\(([^)#]+)", PAGE):
        assert (ROOT / "docs" / target).exists(), target


def test_every_question_that_is_known_has_a_recipe() -> None:
    if not QUESTIONS.exists():
        pytest.skip(f"no list of questions: looked for {QUESTIONS}")
    text = QUESTIONS.read_text().partition("## (c)")[2].partition("## (d)")[0]
    entries = re.findall(r"^(\d+)\. (.*(?:\n(?!\d+\. |#).*)*)", text, re.MULTILINE)
    assert len(entries) == 55
    answered = {number for it in THREADS.values() for number in re.findall(r"#(\d+)", it)}
    missing = [
        number
        for number, entry in entries
        if (asked := {found[1] for found in THREAD.findall(entry)}) and not asked & answered
    ]
    assert missing == []
