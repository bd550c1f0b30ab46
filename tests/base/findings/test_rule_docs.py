# SPDX-License-Identifier: Apache-2.0
"""Rules in words."""

from __future__ import annotations

from multibot_rewrite.base.findings.codes import listed
from multibot_rewrite.lint.registry import RULES

unused = RULES["MB002"]


def test_a_list_has_the_first_sentence_of_each_rule() -> None:
    said = "A `urdf-lint: ignore` comment names a code that it does not suppress"
    assert unused.what.startswith(f"{said}. ")
    assert list(listed([unused])) == [("MB002", "warning", "unused-suppression", said)]
