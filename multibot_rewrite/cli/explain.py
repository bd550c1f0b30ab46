# SPDX-License-Identifier: Apache-2.0
"""``multibot inspect CODE``: what a finding is, why, the fix."""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterable, Sequence

from multibot_rewrite.base.findings.codes import examples, explained, find_rules, listed, no_rule
from multibot_rewrite.base.findings.rule import Rule
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.cli.output import deliver, note
from multibot_rewrite.cli.process import DONE
from multibot_rewrite.cli.tables import JSON, Grid, deliver_report, json_bytes
from multibot_rewrite.lint.catalogue import rules

# More rules than these are listed, a line each.
MOST_EXPLAINED = 10
# MB202, as it begins (mb2), and what is nearly one.
_CODE = re.compile(r"M[A-Z](\d\w*)?", re.IGNORECASE)


def are_codes(words: Sequence[str]) -> bool:
    """Is a code among these words, or are they the name of a rule?"""
    return any(map(_CODE.fullmatch, _split(words)))


def is_name(word: str) -> bool:
    """Has a rule this name?"""
    return any(it.name == word for it in rules().values())


def run(options: argparse.Namespace, words: Sequence[str]) -> int:
    """Explain rules by their codes, how codes begin, or names; more than a few are listed. Returns the
    exit code."""
    found = {it.code: it for word in _split(words) for it in _asked(word)}
    if options.form == JSON:
        deliver(options, json_bytes({"rules": as_json(found.values())}))
    elif len(found) > MOST_EXPLAINED:
        deliver_report(options, (grid(found.values()),))
        note(options, "multibot inspect CODE explains one of them")
    else:
        deliver(options, "\n".join(map(explained, found.values())).encode())
    return DONE


def grid(found: Iterable[Rule] | None = None) -> Grid:
    """Return rules (all by default) in a table."""
    shown = rules().values() if found is None else found
    return Grid(("code", "level", "name", "what it finds"), [*listed(shown)])


def as_json(found: Iterable[Rule] | None = None) -> list[dict[str, object]]:
    """Rules (all by default) as ``--form json`` writes them; docs/stacks.md describes it."""
    fields = ("code", "name", "level", "what", "why", "fix")
    return [
        {**{name: getattr(it, name) for name in fields}, "examples": dict(examples(it))}
        for it in (rules().values() if found is None else found)
    ]


def _split(words: Iterable[str]) -> list[str]:
    return [code for word in words for code in word.split(",")]


def _asked(word: str) -> list[Rule]:
    known = rules()
    found = find_rules(word, known) if word else []
    if not found:
        raise UsageError(no_rule(word, known))
    return found
