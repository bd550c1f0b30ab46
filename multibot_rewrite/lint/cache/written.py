"""Findings, and what a file has to know of the others, as JSON has them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import Edit
from multibot_rewrite.rules.settings import Settings

_EDITS = Finding._fields.index("edits")
_ENCODING = "latin-1"


def findings_written(findings: Iterable[Finding]) -> list[list[Any]]:
    """Findings as lists."""
    return [list(it._replace(edits=tuple(map(_edit_written, it.edits)))) for it in findings]


def _edit_written(it: Edit) -> Any:
    after = None if it.after is None else it.after.decode(_ENCODING)
    return [it.start, it.end, it.before.decode(_ENCODING), after]


def findings_from(value: Any) -> list[Finding] | None:
    """The findings; None where there are none kept, or it is something else."""
    try:
        return None if value is None else [_finding(it) for it in value]
    except (TypeError, ValueError, AttributeError):
        return None


def _finding(value: Any) -> Finding:
    words = [tuple(it) if isinstance(it, list) else it for it in value]
    words[_EDITS] = tuple(map(_edit, value[_EDITS]))
    return Finding._make(words)


def _edit(value: Any) -> Edit:
    start, end, before, after = value
    last = None if after is None else after.encode(_ENCODING)
    return Edit(int(start), int(end), before.encode(_ENCODING), last)


def among_written(settings: Settings, path: str = "") -> list[Any]:
    """What the settings say of the other files; with a ``path`` only what counts for that one."""
    part = [path in settings.included] if path else sorted(settings.included)
    known = settings.elsewhere
    return [part, settings.urdfs, None if known is None else [known.names, known.any]]


def among_from(value: Any, settings: Settings) -> Settings | None:
    """The settings with what was kept; None where nothing is."""
    from multibot_rewrite.description.sources.known_arguments import KnownArguments

    try:
        part, urdfs, known = value
        elsewhere = None if known is None else KnownArguments(tuple(known[0]), bool(known[1]))
        pairs = tuple((name, path) for name, path in urdfs)
    except (TypeError, ValueError, LookupError):
        return None
    return settings._replace(included=frozenset(part), urdfs=pairs, elsewhere=elsewhere)
