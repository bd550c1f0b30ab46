# SPDX-License-Identifier: Apache-2.0
"""Help, messages and pages for users are in the words of ROS, without terms of this package alone."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import cache
from itertools import chain
from pathlib import Path
from typing import NamedTuple

import pytest
import said_texts
from parsed import sources
from paths import ROOT

from multibot_rewrite.base.nearest import other_words
from multibot_rewrite.cli.declared.commands import COMMANDS, PROGRAMS
from multibot_rewrite.cli.multibot import overview
from multibot_rewrite.cli.parser import make_parser
from multibot_rewrite.lint import catalogue

# Pages for users; those of measurements and for contributors name the code's own terms.
PAGES = (
    *(ROOT / it for it in ("README.md", "SECURITY.md")),
    *sorted(ROOT.glob("examples/*/README.md")),
    *sorted((ROOT / "docs").rglob("*.md")),
)
NOT_FOR_USERS = {it.name for it in (ROOT / "docs" / "contributing").glob("*.md")} - {"nav2.md"}
CODE = re.compile(r"^( *)(`{3,}).*?^\1\2`*$|`[^`]*`", re.MULTILINE | re.DOTALL)
LINKED = re.compile(r"\]\([^)]*\)")
TERMS = Path(__file__).parents[1] / "support" / "private_terms.tsv"
# Terms that the newest changes do not use either.
PAGE_TERMS = TERMS.with_name("page_terms.tsv")


class Term(NamedTuple):
    word: re.Pattern[str]
    instead: str
    plain: tuple[str, ...]


@cache
def terms(file: Path = TERMS) -> list[Term]:
    rows = [it.split("\t") for it in file.read_text().splitlines() if not it.startswith("#")]
    return [
        Term(
            re.compile(rf"\b({word})\b", re.IGNORECASE),
            instead,
            tuple(filter(None, plain.split("|"))),
        )
        for word, instead, plain in rows
    ]


def found_in(text: str, file: Path = TERMS) -> Iterator[str]:
    """Yield the terms in a text, each with what to write instead."""
    for it in terms(file):
        left = text
        for phrase in it.plain:
            left = left.replace(phrase, "")
        if word := it.word.search(left):
            yield f"{word[0]!r}, write {it.instead}: {' '.join(text.split())[:90]}"


def found_in_all(text: str) -> Iterator[str]:
    """Return the terms of both tables in a text."""
    yield from (it for file in (TERMS, PAGE_TERMS) for it in found_in(text, file))


def test_a_term_is_found_unless_it_is_plain_english() -> None:
    assert list(found_in("whom nobody hears"))
    assert list(found_in("the loop closes"))
    assert not list(found_in("Joints close a loop"))
    assert not list(found_in("the artefacts of rviz"))
    assert list(found_in("the files beside it", PAGE_TERMS))
    assert list(found_in("Stacks of nodes", PAGE_TERMS))
    assert not list(found_in("a stand-in for launch", PAGE_TERMS))


@pytest.mark.more
def test_messages_have_no_private_term() -> None:
    """Those of the code, the words of rules, and the notes of data files that messages show."""
    texts = chain(said_texts.messages(), said_texts.rule_words(), said_texts.notes())
    found = [f"{place}: {it}" for place, text in texts for it in found_in_all(text)]
    assert found == []


# So many docstrings still have a term of PAGE_TERMS; who mends some lowers it.
MOST_IN_DOCSTRINGS = 12


def _docstrings() -> Iterator[str]:
    for node in chain.from_iterable(map(ast.walk, sources().values())):
        if isinstance(node, ast.FunctionDef | ast.ClassDef | ast.Module):
            yield ast.get_docstring(node) or ""


def test_docstrings_have_fewer_private_terms() -> None:
    found = [it for text in _docstrings() for it in found_in(text, PAGE_TERMS)]
    assert len(found) <= MOST_IN_DOCSTRINGS, found


def test_a_docstring_names_what_is_returned() -> None:
    """Not ``whether it is``: before the signature is read, ``it`` may be anything."""
    vague = re.compile(r"(Return|Yield) (whether (it|this|that) (is|has)\b|its )|Its ")
    assert [it for it in _docstrings() if vague.match(it)] == []


def test_a_name_of_a_rule_has_no_private_term() -> None:
    names = [it.name.replace("-", " ") for it in catalogue.rules().values()]
    assert [it for name in names for it in found_in(name)] == []


@pytest.mark.more
def test_every_kind_of_text_is_looked_at() -> None:
    """A message with a value, a word of a rule, a note of a node, a plugin and a schema."""
    messages, notes = dict(said_texts.messages()), dict(said_texts.notes())
    assert any("did you mean" in it for it in messages.values())
    assert any(it.startswith("unknown option X") for it in messages.values())
    assert len(messages) > 4500
    kinds = {Path(it.partition(":")[0]).suffix for it in notes}
    assert kinds == {".yaml", ".vocab", ".schema", ".json", ".js"}


@pytest.mark.parametrize("name", [*COMMANDS, *PROGRAMS])
def test_a_help_has_no_private_term(name: str) -> None:
    command = {**COMMANDS, **PROGRAMS}[name]
    parser = make_parser(command)
    assert list(found_in_all(parser.format_help())) == []
    assert list(found_in_all(parser.short)) == []


@pytest.mark.parametrize("page", PAGES, ids=lambda it: str(it.relative_to(ROOT)))
def test_a_page_for_users_has_no_private_term(page: Path) -> None:
    parts = re.split(r"\n\s*\n|\n- |\n\|", CODE.sub("", page.read_text()))
    found = [it for part in parts for it in found_in(part)]
    assert page.name in NOT_FOR_USERS or found == []


@pytest.mark.parametrize("page", PAGES, ids=lambda it: str(it.relative_to(ROOT)))
def test_a_page_for_users_has_the_terms_of_the_glossary(page: Path) -> None:
    text = LINKED.sub("]", CODE.sub("", page.read_text()))
    parts = (" ".join(it.split()) for it in re.split(r"\n\s*\n|\n- |\n\|", text))
    found = [it for part in parts for it in found_in(part, PAGE_TERMS)]
    assert page.name in NOT_FOR_USERS or found == []


def test_the_newest_changes_have_the_terms_of_the_glossary() -> None:
    text = (ROOT / "CHANGELOG.rst").read_text()
    _, newest, *_ = re.split(r"\n\S+(?: \([\d-]+\))?\n-{3,}\n", text)
    lines = re.sub(r"``.*?``", "", newest).splitlines()
    assert [
        it for line in lines for file in (TERMS, PAGE_TERMS) for it in found_in(line, file)
    ] == []


def test_the_glossary_has_each_term_to_use() -> None:
    glossary = (ROOT / "docs" / "glossary.md").read_text()
    used = {it for term in terms(PAGE_TERMS) for it in term.instead.split(", ")}
    plain = {"is", "next to", "with", "in addition to", "compared with", "checked"}
    plain |= {"a snapshot", "reports"}
    assert {it for it in used - plain if it not in glossary} == set()


def test_the_overview_has_no_private_term() -> None:
    assert list(found_in(overview("never"))) == []


EVERY_OPTION = {
    name for it in (*COMMANDS.values(), *PROGRAMS.values()) for name in make_parser(it).known()
}
# Some commands have these; in the others they are taken for something else.
OF_SOME = {"--undo", "--prefix", "--namespace", "--plan", "-n", "--count", "--urdf", "--pose"}


def test_other_words_lead_to_what_there_is() -> None:
    """No word of the tables is a command or option, and each answer names what exists."""
    commands, options = other_words("commands"), other_words("options")
    assert not {*commands} & {*COMMANDS}
    assert {it.rpartition(" ")[2] for it in options} & EVERY_OPTION <= OF_SOME
    for answer in (*commands.values(), *options.values()):
        assert {*re.findall(r"(?<!\S)--[a-z-]+", answer)} <= EVERY_OPTION, answer
        assert {*re.findall(r"multibot (?!before|--)([a-z-]+)", answer)} <= {*COMMANDS}, answer
    programs = {*PROGRAMS}
    for answer in commands.values():
        first, second = answer.replace(",", "").split()[:2]
        known = {*COMMANDS, *EVERY_OPTION}
        assert first in programs or second in known or (first, second) == ("ros2", "launch")
