# SPDX-License-Identifier: Apache-2.0
"""Damaged real files: each is refused with a reason, or rewritten and verified."""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Mapping
from pathlib import Path

import pytest
from expected_names import ROBOT, graph_problems
from mutants import MUTATIONS, SAMPLE, Mutation, fixtures, mutant, read_all
from real_robots import spread

from multibot_rewrite import MultibotError, ProofError, rewrite, strip
from multibot_rewrite.base.loose_xml import well_formed

pytestmark = pytest.mark.slow

OPTIONS: tuple[dict[str, str], ...] = (
    {},
    {"layout": "L1"},
    {"layout": "L2", "affix": "prefix"},
    {"affix": "prefix"},
)
FEW, MANY = 250, 4_000
# So many of the mutants at least must get past the parser and be rewritten, or nothing is tested.
LEAST_REWRITTEN = 0.15


def outcome(data: bytes, options: Mapping[str, str]) -> str:
    """``rewritten``, or the kind of error; AssertionError says what is wrong with a result."""
    try:
        result = rewrite(data, ROBOT, **options).data
    except ProofError:
        raise
    except MultibotError as error:
        assert str(error)
        return type(error).__name__
    # Some mutants are what only TinyXML-2 reads.
    assert graph_problems(well_formed(data).text, well_formed(result).text, options) == []
    assert strip(result, ROBOT, **options) == data, "strip does not give the mutant back"
    return "rewritten"


def hunt(sources: list[bytes], seeds: range) -> Counter[str]:
    """Return what becomes of each mutant; fails with every seed that went wrong and why."""
    found: Counter[str] = Counter()
    wrong = []
    for seed in seeds:
        try:
            found[outcome(mutant(seed, sources), OPTIONS[seed % len(OPTIONS)])] += 1
        except Exception as error:
            wrong.append(f"seed {seed}: {type(error).__name__}: {str(error)[:200]}")
    assert not wrong, f"{len(wrong)} of {len(seeds)} mutants:\n" + "\n".join(wrong[:20])
    assert found["rewritten"] >= LEAST_REWRITTEN * len(seeds), found
    return found


def test_mutants_of_fixtures() -> None:
    hunt(fixtures(), range(FEW))


def test_mutants_of_real_files(corpus: dict[str, Path]) -> None:
    hunt(read_all(spread(corpus, SAMPLE)), range(FEW, 2 * FEW))


@pytest.mark.parametrize("mutation", MUTATIONS, ids=lambda mutation: mutation.__name__)
def test_every_mutation_mutates(mutation: Mutation) -> None:
    data = fixtures()[0]
    assert sum(mutation(random.Random(seed), data) != data for seed in range(20)) >= 10


@pytest.mark.deep
@pytest.mark.parametrize("part", range(4))
def test_many_mutants(corpus: dict[str, Path], part: int) -> None:
    share = MANY // 4
    start = 10_000 + part * share
    hunt([*fixtures(), *read_all(spread(corpus, 4 * SAMPLE))], range(start, start + share))
