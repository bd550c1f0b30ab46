"""``multibot explain CODE``, and ``--explain`` of other commands: what a finding is, why, the fix."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence

from multibot_rewrite.base.findings.codes import find_rules, no_rule
from multibot_rewrite.base.findings.rule import Rule
from multibot_rewrite.base.findings.rule_docs import explained, listed
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.cli.output import deliver
from multibot_rewrite.cli.process import DONE
from multibot_rewrite.lint.catalogue import rules

LISTING = "multibot explain"


def run(options: argparse.Namespace) -> int:
    """Explain the codes that are given, or list all; returns the exit code."""
    codes = [code for word in options.codes for code in word.split(",")]
    return _explain(options, codes, LISTING) if codes else list_rules(options, rules())


def of_option(options: argparse.Namespace) -> int:
    """The same for the codes of an option ``--explain``."""
    word = options.explain
    if ":" in word:
        raise UsageError(f"--explain {word}: give a code; for a line: urdf-postfix --why {word}")
    return _explain(options, word.split(","), "--explain")


def _explain(options: argparse.Namespace, codes: Sequence[str], where: str) -> int:
    known = rules()
    found = {it.code: it for code in codes for it in _asked(code, known, where)}
    deliver(options, "\n".join(map(explained, found.values())).encode())
    return DONE


def _asked(word: str, known: Mapping[str, Rule], where: str) -> list[Rule]:
    found = find_rules(word, known) if word else []
    if not found:
        raise UsageError(f"{where}: {no_rule(word, known, LISTING)}")
    return found


def list_rules(options: argparse.Namespace, known: Mapping[str, Rule]) -> int:
    """A line for each rule: code, level, name, what it finds."""
    rows = "".join(f"{' '.join(row)}\n" for row in listed(known.values()))
    deliver(options, rows.encode())
    return DONE
