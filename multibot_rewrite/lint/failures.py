"""Findings for files that no rule can look at."""

from __future__ import annotations

import re

from multibot_rewrite.lint.records import LintFinding, Rule, Subject
from multibot_rewrite.lint.registry import RULES
from multibot_rewrite.lint.settings import Settings, level_of
from multibot_rewrite.model import ERROR

_PLACE = re.compile(r"(?P<file>.*?)(?::(?P<line>\d+):(?P<column>\d+))?: (?P<said>.*)", re.DOTALL)
# What a reader says -> the rule that this is.
_CODES = (
    ("No such file", "MB102"),
    ("cannot be read", "MB102"),
    ("Is a directory", "MB102"),
    ("Permission denied", "MB102"),
    ("xacro failed", "MB103"),
)


def failure(path: str, message: str, settings: Settings) -> LintFinding:
    """The finding for a file that cannot be read; ``message`` is that of its InputError."""
    code = next((code for said, code in _CODES if said in message), "MB101")
    level = level_of(settings, code, RULES[code].level)
    it = _PLACE.fullmatch(message)
    assert it is not None, "an InputError names its file"
    line, column = int(it["line"] or 1), int(it["column"] or 1)
    what, _, hint = it["said"].rpartition("; ")
    file = it["file"].removesuffix(" (expanded)") or path
    return LintFinding(code, level, what or hint, hint if what else "", file, line, column)


def crash(rule: Rule, subject: Subject, error: Exception) -> LintFinding:
    """The finding for a rule that fell over a document: the rule did not look at all of it."""
    file = subject.document.file.removesuffix(" (expanded)")
    message = f"{rule.code} crashed: {type(error).__name__}: {error}"
    hint = "this is a fault of urdf-lint; --ignore it to go on"
    return LintFinding("MB001", ERROR, " ".join(message.split()), hint, file, 1, 1)


def too_long(path: str, seconds: float) -> LintFinding:
    """The finding for a file that was left before its end."""
    message = f"it took more than {seconds:g} s and was left"
    return LintFinding("MB004", ERROR, message, "is there a loop in its macros?", path, 1, 1)
