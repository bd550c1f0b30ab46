# SPDX-License-Identifier: Apache-2.0
"""Every rule of every command finds its bad example, once and in its line, and leaves the good one."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from paths import FIXTURES, ROOT
from rule_examples import WITHOUT_FILE, found, is_built

from multibot_rewrite.base.findings.finding import LEVELS, Rule
from multibot_rewrite.lint import catalogue

RULES = catalogue.rules()
# No text makes them: a fault of the lint, and a file that takes too long. Other tests raise them.
WITHOUT_EXAMPLES = {
    **dict.fromkeys(("MB001", "MB004"), "test_lint_robust.py"),
}
EXAMPLES = [code for code in RULES if code not in WITHOUT_EXAMPLES]
BUILT = [code for code in EXAMPLES if is_built(RULES[code])]
# Code -> level, and what the finding is about: judged by hand.
ROWS = (FIXTURES / "example_findings.tsv").read_text().splitlines()
TOLD = {code: told for code, *told in (it.split("\t") for it in ROWS)}


@pytest.mark.parametrize("code", [code for code in EXAMPLES if code not in BUILT])
def test_the_examples_of_a_rule(code: str, tmp_path: Path) -> None:
    """The bad one is found once, in its line, with edits where a fix is shown; the good one never."""
    judge_examples(RULES[code], tmp_path)


@pytest.mark.sample(4)
@pytest.mark.parametrize("code", BUILT)
def test_the_examples_of_a_rule_for_which_a_fleet_is_built(code: str, tmp_path: Path) -> None:
    judge_examples(RULES[code], tmp_path)


def judge_examples(rule: Rule, tmp_path: Path) -> None:
    (finding,) = found(rule, rule.page.bad, tmp_path)
    # What is found, and what to do.
    assert finding.message
    assert finding.hint
    assert bool(finding.edits) == bool(rule.page.fixed)
    (tmp_path / "good").mkdir()
    assert found(rule, rule.page.good, tmp_path / "good") == []
    if set(WITHOUT_FILE) & set(rule.formats):
        # The line names the node or one of the topics or frames, else the robot.
        about = [it for it in (finding.node, *finding.names) if it] or [finding.robot]
        assert any(it in rule.page.bad.splitlines()[rule.page.line - 1] for it in about if it)
        return
    assert finding.line == rule.page.line
    assert Path(finding.file).parent == tmp_path if finding.file else finding.place != "graph"


@pytest.mark.parametrize("code", [code for code in EXAMPLES if code in TOLD])
def test_the_level_of_an_example_and_what_it_is_about(code: str, tmp_path: Path) -> None:
    (it,) = found(RULES[code], RULES[code].page.bad, tmp_path)
    level, about = TOLD[code]
    assert it.level == level
    if set(WITHOUT_FILE) & set(RULES[code].formats):
        assert " ".join(filter(None, (it.robot, it.node, *it.names))) == about
    elif about:
        lines = Path(it.file).read_text().splitlines()
        assert lines[it.line - 1][it.column - 1 :].lstrip().startswith(about)


def test_the_words_of_a_rule_are_all_there() -> None:
    assert {code: it.level for code, it in RULES.items() if it.level not in LEVELS} == {}
    texts = {code: (it.what, it.why, it.fix) for code, it in RULES.items()}
    assert [code for code, it in texts.items() if not all(text.endswith(".") for text in it)] == []
    named = re.compile(r"[a-z]+(-[a-z0-9]+)*")
    assert [code for code, it in RULES.items() if not named.fullmatch(it.name)] == []


def test_names_are_no_two_rules() -> None:
    assert len({rule.name for rule in RULES.values()}) == len(RULES)


@pytest.mark.parametrize("code", WITHOUT_EXAMPLES)
def test_what_has_no_example_is_raised_in_another_test(code: str) -> None:
    (path,) = (ROOT / "tests").rglob(WITHOUT_EXAMPLES[code])
    assert code in path.read_text()


@pytest.mark.slow
def test_every_code_of_the_package_is_declared() -> None:
    sources = (path.read_text() for path in (ROOT / "multibot_rewrite").rglob("*.py"))
    codes = {code for text in sources for code in re.findall(r"\bM[BFGR]\d{3}\b", text)}
    assert codes - RULES.keys() == set()
