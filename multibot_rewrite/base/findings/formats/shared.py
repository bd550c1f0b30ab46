# SPDX-License-Identifier: Apache-2.0
"""What several formats need: text that no reader stumbles over, paths, identities that last."""

from __future__ import annotations

import os
import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

from multibot_rewrite.base.findings.finding import INCONCLUSIVE, LEVELS, Finding, same_for
from multibot_rewrite.base.findings.formats import Report
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.base.wording import in_json, one_line, plural

_SURROGATE = lazy_compile("[\ud800-\udfff]")
_CALL = lazy_compile(r"(?P<file>.*):(?P<line>\d+): (?P<macro>.*)", re.DOTALL)


class MacroCall(NamedTuple):
    """One of a finding's ``calls``, in its parts."""

    file: str
    line: int
    macro: str


def json_text(value: object) -> str:
    r"""JSON that strict readers take: a lone surrogate is text, ``\\udcff``, and no escape."""
    import json

    text = in_json(json.dumps(value, indent=1, ensure_ascii=False)) + "\n"
    return _SURROGATE.sub(lambda found: f"\\\\u{ord(found[0]):04x}", text)


def path_given(path: str) -> str:
    """A path as it was given, with ``/``."""
    return path.replace(os.sep, "/")


def inside(path: str) -> str | None:
    """A path relative to the working directory, with ``/``; None where it is not below it."""
    here = os.path.join(os.getcwd(), "")
    whole = os.path.abspath(path)
    return path_given(whole[len(here) :]) if whole.startswith(here) else None


def path_below(path: str) -> str:
    """As ``inside``, or as it was given: what CI services look for in the repository."""
    return inside(path) or path_given(path)


def said(finding: Finding) -> str:
    """Message, further robots and hint, in one line."""
    hint = f" ({finding.hint})" if finding.hint else ""
    return one_line(f"{finding.message}{same_for(finding)}{hint}")


def said_of(finding: Finding) -> str:
    """The same with the robot or node in front: for formats that show files only."""
    who = f"{finding.place}: " if finding.robot or finding.node else ""
    return f"{one_line(who)}{said(finding)}"


def title(finding: Finding, report: Report) -> str:
    """The code and, where the rule is known, its name."""
    rule = report.rules.get(finding.code)
    return f"{finding.code} {rule.name}" if rule else finding.code


def file_of(finding: Finding, report: Report) -> str:
    """The file to show a finding at: its own, else the first that was read (a plan, a fleet)."""
    return finding.file or next(iter(report.files), "")


def circumstances(finding: Finding) -> str:
    """The xacro arguments under which it is found, behind a space; empty for the default ones."""
    return one_line(f" [with {finding.arguments}]") if finding.arguments else ""


def calls(finding: Finding) -> Iterator[MacroCall]:
    """The xacro macro calls that made what is at fault, the innermost first."""
    for call in finding.calls:
        parts = _CALL.fullmatch(call)
        assert parts is not None, "a call is written file:line: name"
        yield MacroCall(parts["file"], int(parts["line"]), parts["macro"])


def via(finding: Finding, spelled: Callable[[str], str]) -> Iterator[str]:
    """A line for each of the calls, with its path so spelled."""
    for call in calls(finding):
        yield one_line(f"via {spelled(call.file)}:{call.line}: {call.macro}")


def counts(findings: Iterable[Finding]) -> dict[str, int]:
    """How many there are of each level, from the worst on."""
    found = Counter(it.level for it in findings)
    return {level: found[level] for level in (*LEVELS, *(found.keys() - set(LEVELS)))}


def in_words(levels: Mapping[str, int]) -> str:
    """``2 errors, 1 warning``; empty without findings."""
    words = (
        f"{number} {level}" if level == INCONCLUSIVE else plural(number, level)
        for level, number in levels.items()
        if number
    )
    return ", ".join(words)


def by_file(findings: Iterable[Finding], report: Report) -> dict[str, list[Finding]]:
    """The findings of each file; the files that were read come first, with findings or without."""
    result: dict[str, list[Finding]] = {file: [] for file in report.files}
    for finding in findings:
        result.setdefault(file_of(finding, report), []).append(finding)
    return result


def fingerprints(findings: Sequence[Finding]) -> list[str]:
    """What each finding is known by from run to run: no two are equal, and lines may move."""
    from hashlib import sha256

    seen: Counter[tuple[str, ...]] = Counter()
    result = []
    for it in findings:
        where = path_below(it.file) if it.file else it.place
        known = (it.code, where, it.message, it.arguments)
        seen[known] += 1
        whole = "\0".join((*known, str(seen[known])))
        result.append(sha256(whole.encode("utf-8", "backslashreplace")).hexdigest())
    return result
