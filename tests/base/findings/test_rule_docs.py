# SPDX-License-Identifier: Apache-2.0
"""Rules in words."""

from __future__ import annotations

from multibot_rewrite.base.findings.codes import listed
from multibot_rewrite.description.checks.robots import strip_other_robot


def test_a_list_has_the_first_sentence_of_each_rule() -> None:
    rule = strip_other_robot._replace(what="One thing. Another one. And more.")
    assert list(listed([rule])) == [("MB107", "error", "strip-other-robot", "One thing")]
