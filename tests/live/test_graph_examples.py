# SPDX-License-Identifier: Apache-2.0
"""The lines in which examples of graph rules are written say what they seem to say."""

from __future__ import annotations

import pytest
from graph_examples import read_example, read_system

from multibot_rewrite.lint import catalogue
from multibot_rewrite.rules.check import RULES, judge

# Rules that a lint of a description has as well.
OF_DESCRIPTIONS = {"MB229", "MB240", "MB412"}


@pytest.mark.parametrize(
    "line",
    [
        "/robot1/nav",
        "seen: /robot1/nav",
        "planned: robot1/nav",
        "planned: /robot1/nav subscribes to /robot1/scan",
        "running: transform odom to base_link on /tf",
        "running: /robot1/nav has use_sim_time yes",
        "planned: frames of robot1: base_link",
    ],
)
def test_a_line_of_another_language_is_refused(line: str) -> None:
    with pytest.raises(AssertionError):
        read_example(f"{line}\n")


def test_every_declared_rule_is_asked() -> None:
    """Those of launch files have a command of their own (`check-launch`), and its tests."""
    declared = {code for code in catalogue.rules() if code.startswith("MG")}
    launched = {code for code in declared if code.startswith("MG7")}
    assert launched and (declared - launched) | OF_DESCRIPTIONS == RULES.keys()


@pytest.mark.parametrize("code", sorted(OF_DESCRIPTIONS))
def test_a_rule_for_descriptions_finds_it_in_a_system(code: str) -> None:
    rule = RULES[code]
    (finding,) = (it for it in judge(read_system(rule.page.bad)) if it.code == code)
    assert finding.node in rule.page.bad.splitlines()[rule.page.line - 1]
    assert [it for it in judge(read_system(rule.page.good)) if it.code == code] == []
