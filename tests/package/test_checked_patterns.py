# SPDX-License-Identifier: Apache-2.0
"""A checker of regular expressions that others wrote finds nothing in those of the package."""

from __future__ import annotations

import warnings

import pytest
from regexes import UnresolvedError, calls, made_by

with warnings.catch_warnings():
    # It reads patterns by modules that Python calls deprecated since 3.11.
    warnings.simplefilter("ignore", DeprecationWarning)
    from regexploit.ast.sre import SreOpParser
    from regexploit.redos import find

# Patterns of fnmatch, which never goes back behind a star (Python 3.11 and later: an atomic group).
UNREAD = "from_ATOMIC_GROUP"


def attacks(pattern: str | bytes, flags: int) -> list[str]:
    """Return the texts on which the checker says that a pattern takes long."""
    text = pattern if isinstance(pattern, str) else pattern.decode("latin-1")
    return [it.example() for it in find(SreOpParser().parse_sre(text, flags))]


@pytest.mark.slow
def test_the_checker_finds_nothing() -> None:
    found = {}
    for module, call, inside in calls():
        try:
            patterns = made_by(module, call, inside)
        except UnresolvedError:
            continue
        for it in patterns:
            try:
                slow = attacks(it.pattern, 0 if isinstance(it.pattern, bytes) else it.flags)
            except AttributeError as error:
                assert UNREAD in str(error), it
                continue
            if slow:
                found[it.place] = it.pattern, slow[0]
    assert found == {}


def test_the_checker_works() -> None:
    assert attacks(r"(a+)+b", 0)
    assert attacks(rb"install\(\s*DIR\s+([^)]*?)\s+TO", 0)
