# SPDX-License-Identifier: Apache-2.0
"""The page of errors in public descriptions: what it says of each is whole, and it is up to date."""

from __future__ import annotations

import re

import pytest

from multibot_rewrite.lint.registry import RULES
from tools.pages import upstream

ERRORS = upstream.errors()
HUNK = re.compile(r"@@ -(\d+)(?:,(\d+))? \+(\d+)(?:,(\d+))? @@")


def test_there_are_thirty_and_none_is_a_note() -> None:
    assert len(ERRORS) == 30
    assert all(RULES[it.rule].level in ("error", "warning") for it in ERRORS)
    assert {it.rule for it in ERRORS} == upstream.BREAKS.keys()


@pytest.mark.parametrize("error", ERRORS, ids=lambda it: f"{it.file.rpartition('/')[2]}:{it.line}")
def test_a_patch_is_one_that_can_be_applied(error: upstream.Error) -> None:
    """The counts of each hunk are those of its lines."""
    assert re.fullmatch(r"[0-9a-f]{40}", error.revision)
    heads = [it for it in error.patch.splitlines() if it.startswith("@@")]
    parts = re.split(r"(?m)^@@.*@@\n", error.patch)[1:]
    assert len(heads) == len(parts) > 0
    for head, part in zip(heads, parts, strict=True):
        found = HUNK.fullmatch(head)
        assert found
        lines = part.splitlines()
        for count, sign in ((found[2], "-"), (found[4], "+")):
            assert sum(it.startswith(sign) for it in lines) == int(count or 1)
        assert all(it[0] in "+-" for it in lines)
