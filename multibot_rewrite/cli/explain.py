# SPDX-License-Identifier: Apache-2.0
"""``multibot explain CODE``: what a finding is, why, the fix."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping

from multibot_rewrite.base.findings.codes import explained, find_rules, listed, no_rule
from multibot_rewrite.base.findings.rule import Rule
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.cli.output import deliver
from multibot_rewrite.cli.process import DONE
from multibot_rewrite.lint.catalogue import rules

LISTING = "multibot explain"


def run(options: argparse.Namespace) -> int:
    """Explain the codes that are given, or list all; returns the exit code."""
    known = rules()
    words = [code for word in options.codes for code in word.split(",")]
    found = {it.code: it for word in words for it in _asked(word, known)}
    texts = map(explained, found.values()) if words else _list(known)
    deliver(options, "\n".join(texts).encode())
    return DONE


def _asked(word: str, known: Mapping[str, Rule]) -> list[Rule]:
    found = find_rules(word, known) if word else []
    if not found:
        raise UsageError(no_rule(word, known, LISTING))
    return found


def _list(known: Mapping[str, Rule]) -> Iterator[str]:
    """A line for each rule: code, level, name, what it finds."""
    yield from (" ".join(row) for row in listed(known.values()))
    yield ""
