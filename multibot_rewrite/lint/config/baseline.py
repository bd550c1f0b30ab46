# SPDX-License-Identifier: Apache-2.0
"""Findings that a project has already: only new ones are reported.

A finding is recognised by its code, its file and its message, so lines may move.
"""

import json
import os
import re
from collections import Counter
from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.base.bounded import load_json
from multibot_rewrite.base.config import read
from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import UsageError

FORMAT = "urdf-lint-baseline"
VERSION = 1
# The number of a line in a message may change.
_LINE = re.compile(r"\bline \d+")
FIELDS = {"code": str, "file": str, "message": str, "count": int}


class Key(NamedTuple):
    """What a finding is recognised by; ``file`` is relative to the baseline's folder."""

    code: str
    file: str
    message: str


def read_baseline(path: str) -> Counter[Key]:
    """Return how many findings of each kind a baseline has; raises UsageError for another file."""
    try:
        content = load_json(read(path))
        if not isinstance(content, dict) or content.get(FORMAT) != VERSION:
            raise ValueError(f'"{FORMAT}": {VERSION} is not in it')
        listed = content.get("findings")
        if not isinstance(listed, list):
            raise ValueError('"findings" is not a list')
        counts: Counter[Key] = Counter()
        for number, entry in enumerate(listed, 1):
            if not isinstance(entry, dict) or set(entry) != set(FIELDS):
                raise ValueError(f"finding {number} does not have just {', '.join(FIELDS)}")
            for name, kind in FIELDS.items():
                if type(entry[name]) is not kind:
                    raise ValueError(f"{name!r} of finding {number} is {entry[name]!r}")
            if entry["count"] < 1:
                raise ValueError(f"'count' of finding {number} is {entry['count']}")
            counts[Key(entry["code"], entry["file"], entry["message"])] += entry["count"]
        return counts
    except ValueError as error:
        reason = " ".join(str(error).split())
        hint = f"write one with --write-baseline {path}"
        raise UsageError(f"{path}: not a baseline of urdf-lint: {reason}; {hint}") from None


def beyond(
    findings: Sequence[Finding],
    baseline: Mapping[Key, int],
    path: str,
    linted: Collection[str] | None = None,
) -> tuple[list[Finding], int]:
    """Return the findings that the baseline at ``path`` lacks, and how many of its own are gone.

    ``linted`` are the files that were checked, None for all: findings of an existing file that was not
    checked are not gone."""
    left = Counter(baseline)
    new = []
    for finding in findings:
        key = _key(finding, path)
        if left[key] > 0:
            left[key] -= 1
        else:
            new.append(finding)
    names = None if linted is None else {_relative_path(it, path) for it in linted}
    folder = os.path.dirname(path)
    gone = (
        count
        for key, count in left.items()
        if names is None or key.file in names or not os.path.exists(os.path.join(folder, key.file))
    )
    return new, sum(gone)


def baseline_text(findings: Iterable[Finding], path: str) -> bytes:
    """Return the text of the baseline at ``path`` with just these findings, sorted, a line each."""
    counts = Counter(_key(it, path) for it in findings)
    lines = [
        json.dumps({**key._asdict(), "count": count}, ensure_ascii=False)
        for key, count in sorted(counts.items(), key=lambda it: (it[0].file, it[0]))
    ]
    listed = ",\n  ".join(lines)
    listed = f"\n  {listed}\n" if lines else ""
    text = f'{{\n"{FORMAT}": {VERSION},\n"findings": [{listed}]\n}}\n'
    return text.encode("utf-8", "backslashreplace")


def _key(finding: Finding, path: str) -> Key:
    """Return what a finding is recognised by in the baseline at ``path``."""
    message = _LINE.sub("line N", finding.message)
    return Key(finding.code, _relative_path(finding.file, path), message)


def _relative_path(file: str, path: str) -> str:
    folder = os.path.dirname(os.path.abspath(path))
    return os.path.relpath(file, folder).replace(os.sep, "/")
