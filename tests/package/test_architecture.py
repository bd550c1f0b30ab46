# SPDX-License-Identifier: Apache-2.0
"""The page of the architecture: short, its paths are there, its figures are about those of today."""

from __future__ import annotations

import re
import subprocess
import sys

import pytest
from parsed import PACKAGE
from paths import ROOT

PAGE = (ROOT / "docs" / "contributing" / "architecture.md").read_text()
MOST_LINES, QUESTIONS = 200, 20
# So much may a figure differ, or by so many.
SHARE, FEW = 0.05, 3


def section(title: str) -> str:
    return PAGE.split(f"## {title}\n")[1].partition("\n## ")[0]


def between(word: str) -> str:
    return PAGE.split(f"<!-- {word} -->\n")[1]


def numbers(text: str) -> list[int]:
    return [int(it.replace(",", "")) for it in re.findall(r"\d[\d,]*", text)]


def test_it_is_one_page() -> None:
    assert len(PAGE.splitlines()) <= MOST_LINES


def test_what_is_asked_for_is_where_the_page_says() -> None:
    rows = [it for it in section("Where is X?").splitlines() if it.startswith("| ")][2:]
    assert len(rows) >= QUESTIONS
    for row in rows:
        question, answer = row.strip("| ").split(" | ")
        paths = re.findall(r"`([\w.]+(?:/[\w./]*|\.\w+))`", answer)
        assert paths, question
        gone = [it for it in paths if not ((PACKAGE / it).exists() or (ROOT / it).exists())]
        assert gone == [], question


def test_paths_in_the_rest_of_the_page_are_there() -> None:
    paths = re.findall(
        r"`([a-z_]+/[\w./*]*)`", section("What holds it") + section("Where to add what")
    )
    assert paths
    assert [it for it in paths if not (any(PACKAGE.glob(it)) or any(ROOT.glob(it)))] == []


@pytest.mark.deep
def test_the_figures_are_those_of_today() -> None:
    """Else: ``python benchmarks/house.py --write``."""
    line = [sys.executable, "benchmarks/house.py"]
    made = subprocess.run(line, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    packages, figures = made.split("\n\n")[:2]
    assert re.findall(r"`[a-z]+/`", between("packages")) == re.findall(r"`[a-z]+/`", packages)
    for said, now in zip(between("figures").splitlines(), figures.splitlines(), strict=True):
        for old, new in zip(numbers(said), numbers(now), strict=True):
            assert abs(old - new) <= max(FEW, SHARE * new), now
