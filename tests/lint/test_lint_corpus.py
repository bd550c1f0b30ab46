# SPDX-License-Identifier: Apache-2.0
"""The lint on public files: no rule falls over one, what it calls an error is counted and judged."""

from __future__ import annotations

from collections import Counter
from functools import cache

import pytest
from lint_triage import LEAST, errors, linted_corpus, linted_wheels
from paths import CORPUS
from real_robots import corpus_files, wheel_files

from multibot_rewrite.base.findings.finding import ERROR, Finding
from multibot_rewrite.lint.registry import RULES
from tools.pages import upstream
from tools.pages.lint_triage import Judged, committed, judgements

pytestmark = pytest.mark.deep

UNFINISHED = {"MB001", "MB004"}
JUDGED = [it for it in judgements() if RULES[it.code].level == ERROR]
Found = dict[str, list[Finding]]


@cache
def linted() -> Found:
    if not corpus_files():
        pytest.skip(f"no public files in {CORPUS}")
    return linted_corpus()


@cache
def packaged() -> Found:
    return linted_wheels()


def test_no_rule_falls_over_a_public_file_and_none_takes_too_long() -> None:
    for found in (linted(), packaged()):
        assert [it for its in found.values() for it in its if it.code in UNFINISHED] == []


def test_places_are_in_the_files() -> None:
    for file, found in linted().items():
        home = CORPUS if file.startswith("srdf/") else CORPUS / "urdf"
        lines = (home / file).read_text(errors="replace").split("\n")
        assert all(it.column <= len(lines[it.line - 1]) + 1 for it in found), file


def test_the_errors_are_those_that_were_counted() -> None:
    """After a meant change: python tests/support/lint_triage.py > fixtures/lint_triage_counts.tsv,
    and judge what is new in fixtures/lint_triage_MB*.tsv."""
    known = committed()
    assert len(linted()) == known["files"][0]
    counts = {code: corpus for code, (corpus, _) in known.items() if corpus and code != "files"}
    assert errors(linted()) == Counter(counts)


def test_the_errors_in_packages_are_those_that_were_counted() -> None:
    known = committed()
    if len(wheel_files()) != known["files"][1]:
        pytest.skip(f"{len(wheel_files())} files in the installed wheels, counted in others")
    counts = {code: wheels for code, (_, wheels) in known.items() if wheels and code != "files"}
    assert errors(packaged()) == Counter(counts)


def test_of_every_rule_enough_errors_are_judged() -> None:
    judged = Counter(it.code for it in JUDGED if it.true)
    counts = {code: sum(both) for code, both in committed().items() if code != "files"}
    assert {code: n for code, n in counts.items() if judged[code] < min(LEAST, n)} == {}


def test_no_place_is_judged_twice() -> None:
    assert [it for it, n in Counter(it[:3] for it in judgements()).items() if n > 1] == []


def _here(it: Judged) -> bool:
    """Judged in a file of the corpus, as the lint sees it without settings."""
    elsewhere = it.file.startswith(("wheel:", "github:")) or it.file.endswith(".yaml")
    return not elsewhere and it.code[:3] != "MB4"


@pytest.mark.parametrize("code", sorted({it.code for it in JUDGED if _here(it)}))
def test_what_is_judged_true_is_found_and_what_is_false_is_not(code: str) -> None:
    wrong = []
    for it in JUDGED:
        if it.code == code and _here(it):
            there = any(
                (at.code, at.line) == (code, it.line) and (it.true or at.level == ERROR)
                for at in linted().get(it.file, ())
            )
            wrong += [] if there == it.true else [it]
    assert wrong == []


# What the lint says of a description alone; the others need a package's meshes or its xacro files.
ERRORS_HERE = [it for it in upstream.errors() if it.rule in ("MB201", "MB501", "MB606")]


def test_enough_errors_for_maintainers_are_in_the_public_files() -> None:
    assert len(ERRORS_HERE) >= 15


@pytest.mark.parametrize(
    "error", ERRORS_HERE, ids=lambda it: f"{it.file.rpartition('/')[2]}:{it.line}"
)
def test_an_error_for_its_maintainers_is_still_found(error: upstream.Error) -> None:
    owner = error.repository.replace("/", "+")
    found = {
        (it.code, it.level, it.message)
        for file, its in linted().items()
        if file.startswith(f"{owner}/")
        for it in its
    }
    assert (error.rule, ERROR, error.finding) in found
