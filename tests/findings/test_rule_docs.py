"""Rules in words."""

from __future__ import annotations

from multibot_rewrite.checks.robots import strip_other_robot
from multibot_rewrite.findings.rule_docs import listed


def test_a_list_has_the_first_sentence_of_each_rule() -> None:
    rule = strip_other_robot._replace(what="One thing. Another one. And more.")
    assert list(listed([rule])) == [("MB107", "error", "strip-other-robot", "One thing")]
