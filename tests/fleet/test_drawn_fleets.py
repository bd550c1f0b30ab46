# SPDX-License-Identifier: Apache-2.0
"""Fleets drawn by chance: each builds as its file says, or ends with an error that is in its input.

``--drawn-seed fresh`` draws others, ``python tests/support/drawn_builds.py`` does without pytest.
"""

from __future__ import annotations

import pytest
from drawn_builds import judge_many
from drawn_fleets import CAUSES, drawn, faulty

SEED = 51


@pytest.fixture
def first(pytestconfig: pytest.Config) -> int:
    """Return the number by which the first fleets are drawn."""
    return int(pytestconfig.option.drawn_seed or SEED)


@pytest.mark.slow
@pytest.mark.parametrize("part", range(3))
def test_fleets_build_or_have_a_cause(part: int, first: int) -> None:
    judge_many(drawn, 100, first + part)


@pytest.mark.deep
@pytest.mark.parametrize("part", range(50))
def test_many_fleets_build_or_have_a_cause(part: int, first: int) -> None:
    judge_many(drawn, 100, 1000 * first + part)


@pytest.mark.slow
@pytest.mark.parametrize("cause", sorted(CAUSES))
def test_each_cause_ends_with_an_error(cause: str) -> None:
    """``judge`` asserts that a fleet with a cause does not build."""
    judge_many(faulty(cause).filter(CAUSES[cause].holds), 3, SEED)
