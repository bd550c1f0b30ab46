# SPDX-License-Identifier: Apache-2.0
"""The text and JSON formats, and what all formats need: escaped text, paths, lasting identities."""

import os
import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from multibot_rewrite.base.findings.finding import (
    ERROR,
    INCONCLUSIVE,
    LEVELS,
    NOTE,
    WARNING,
    Finding,
    same_for,
)
from multibot_rewrite.base.findings.formats import Report
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.wording import in_json, one_line, plural

_SURROGATE = lazy_compile("[\ud800-\udfff]")
_CALL = lazy_compile(r"(?P<file>.*):(?P<line>\d+): (?P<macro>.*)", re.DOTALL)
_PAINT = {ERROR: "\033[31m", WARNING: "\033[33m", INCONCLUSIVE: "\033[35m", NOTE: "\033[36m"}
_NO_PAINT = "\033[0m"
# Grows when a key goes or means something else; a new key is no new version.
VERSION = 3
_COMMANDS = {ERROR: "error", INCONCLUSIVE: "warning", WARNING: "warning", NOTE: "notice"}
_DATA = str.maketrans({"%": "%25", "\r": "%0D", "\n": "%0A"})
_PROPERTY = _DATA | str.maketrans({":": "%3A", ",": "%2C"})
_SEVERITIES = {ERROR: "critical", INCONCLUSIVE: "minor", WARNING: "major", NOTE: "info"}
# A comment on GitHub holds 65,536 characters.
ROOM = 60_000
_MARKUP = lazy_compile(r"([\\`*_{}\[\]<>|~#&!$])")
COLUMNS = ("count", "files", "fixable", "code", "level", "rule")
_NUMBERS = COLUMNS[:3]


class MacroCall(NamedTuple):
    """One of a finding's ``calls``, in its parts."""

    file: str
    line: int
    macro: str


def json_text(value: object) -> str:
    r"""Return JSON that strict readers take: a lone surrogate is text, ``\\udcff``, and no escape."""
    import json

    text = in_json(json.dumps(value, indent=1, ensure_ascii=False)) + "\n"
    return _SURROGATE.sub(lambda found: f"\\\\u{ord(found[0]):04x}", text)


def path_given(path: str) -> str:
    """Return a path as it was given, with ``/``."""
    return path.replace(os.sep, "/")


def inside(path: str) -> str | None:
    """Return a path below the working directory, relative to it, with ``/``; None for another."""
    here = os.path.join(os.getcwd(), "")
    whole = os.path.abspath(path)
    return path_given(whole[len(here) :]) if whole.startswith(here) else None


def path_below(path: str) -> str:
    """Return a path as ``inside``, or as it was given: what CI services find in the repository."""
    return inside(path) or path_given(path)


def said(finding: Finding) -> str:
    """Return message, further robots and hint, in one line."""
    hint = f" ({finding.hint})" if finding.hint else ""
    return one_line(f"{finding.message}{same_for(finding)}{hint}")


def said_of(finding: Finding) -> str:
    """Return message and hint with the robot or node in front, for formats that show files only."""
    who = f"{finding.place}: " if finding.robot or finding.node else ""
    return f"{one_line(who)}{said(finding)}"


def title(finding: Finding, report: Report) -> str:
    """Return the code and, if the rule is known, its name."""
    rule = report.rules.get(finding.code)
    return f"{finding.code} {rule.name}" if rule else finding.code


def file_of(finding: Finding, report: Report) -> str:
    """Return the file to show a finding at: its own, or the first that was read (a plan, a fleet)."""
    return finding.file or next(iter(report.files), "")


def circumstances(finding: Finding) -> str:
    """Return the xacro arguments under which it is found, after a space; empty for the defaults."""
    return one_line(f" [with {finding.arguments}]") if finding.arguments else ""


def calls(finding: Finding) -> Iterator[MacroCall]:
    """Yield the xacro macro calls that made the faulty element, the innermost first."""
    for call in finding.calls:
        parts = _CALL.fullmatch(call)
        assert parts is not None, "a call is written file:line: name"
        yield MacroCall(parts["file"], int(parts["line"]), parts["macro"])


def via(finding: Finding, shown: Callable[[str], str]) -> Iterator[str]:
    """Yield a line for each macro call; ``shown`` formats its path."""
    for call in calls(finding):
        yield one_line(f"via {shown(call.file)}:{call.line}: {call.macro}")


def counts(findings: Iterable[Finding]) -> dict[str, int]:
    """Return how many findings there are of each level, from the worst on."""
    found = Counter(it.level for it in findings)
    return {level: found[level] for level in (*LEVELS, *(found.keys() - set(LEVELS)))}


def in_words(levels: Mapping[str, int]) -> str:
    """Return ``2 errors, 1 warning``; empty without findings."""
    words = (
        f"{number} {level}" if level == INCONCLUSIVE else plural(number, level)
        for level, number in levels.items()
        if number
    )
    return ", ".join(words)


def by_file(findings: Iterable[Finding], report: Report) -> dict[str, list[Finding]]:
    """Return the findings of each file, first of the files that were read, also those without any."""
    result: dict[str, list[Finding]] = {file: [] for file in report.files}
    for finding in findings:
        result.setdefault(file_of(finding, report), []).append(finding)
    return result


def fingerprints(findings: Sequence[Finding]) -> list[str]:
    """Return a text for each finding that stays the same from run to run, also if lines move."""
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


def as_text(findings: Sequence[Finding], report: Report, *, colour: bool = False) -> str:
    """Return compilers' lines, ``file:line:column: level: CODE message (hint)``, and macro calls."""
    return "".join(f"{line}\n" for it in findings for line in lines_of(it, colour=colour))


def lines_of(finding: Finding, *, colour: bool = False) -> Iterator[str]:
    """Yield the lines of one finding."""
    it = finding._replace(file=path_given(finding.file))
    paint, plain = (_PAINT.get(it.level, ""), _NO_PAINT) if colour else ("", "")
    head = f"{one_line(it.place)}: {paint}{it.level}: {it.code}{plain}"
    yield f"{head} {said(it)}{circumstances(it)}"
    yield from (f"    {line}" for line in via(it, path_given))


def as_json(findings: Sequence[Finding], report: Report) -> str:
    """Return one JSON object, the same from release to release (docs/lint.md), indented."""
    table = {
        "version": VERSION,
        "tool": report.tool,
        "distro": report.release or None,
        "files": len(report.files),
        **({"coverage": report.coverage} if report.coverage else {}),
        "counts": counts(findings),
        "findings": [_json_finding(it, report) for it in findings],
    }
    return json_text(table)


def _json_finding(finding: Finding, report: Report) -> dict[str, Any]:
    it, edits = finding, []
    for edit in it.edits:
        text = (edit.before + (edit.after or b"")).decode("utf-8", "replace")
        edits.append({"start": edit.start, "end": edit.end, "text": text})
    return {
        "code": it.code,
        "name": report.rules[it.code].name if it.code in report.rules else "",
        "level": it.level,
        "message": it.message,
        "hint": it.hint,
        "file": path_given(it.file) or None,
        "line": it.line or None,
        "column": it.column or None,
        "calls": [call._replace(file=path_given(call.file))._asdict() for call in calls(it)],
        "arguments": it.arguments,
        "robot": it.robot,
        "robots": list(it.robots or filter(None, (it.robot,))),
        "node": it.node,
        "names": list(it.names),
        "edits": edits,
    }


def as_github(findings: Sequence[Finding], report: Report) -> str:
    """Return a workflow command for each finding, which GitHub shows at its line."""
    text = ""
    for it in findings:
        file = one_line(path_below(file_of(it, report)))
        line, column = str(it.line or 1), str(it.column or 1)
        place = {"file": file, "line": line, "col": column} if file else {}
        properties = {**place, "title": title(it, report)}.items()
        pairs = ",".join(f"{key}={value.translate(_PROPERTY)}" for key, value in properties)
        message = "\n".join((f"{said_of(it)}{circumstances(it)}", *via(it, path_below)))
        text += f"::{_COMMANDS[it.level]} {pairs}::{message.translate(_DATA)}\n"
    return text


def as_gitlab(findings: Sequence[Finding], report: Report) -> str:
    """Return a Code Quality report; GitLab recognises known findings by their fingerprints."""
    entries = [
        {
            "description": f"{it.code}: {said_of(it)}{circumstances(it)}",
            "check_name": title(it, report),
            "fingerprint": fingerprint,
            "severity": _SEVERITIES[it.level],
            "location": {"path": path_below(file_of(it, report)), "lines": {"begin": it.line or 1}},
        }
        for it, fingerprint in zip(findings, fingerprints(findings), strict=True)
    ]
    return json_text(entries)


def as_markdown(findings: Sequence[Finding], report: Report) -> str:
    """Return counts, then a table for each file with findings, as many as a comment holds."""
    found = in_words(counts(findings)) or "no findings"
    files = plural(len(report.files), "file")
    held = f" ({_without_markup(str(report.coverage['text']))})" if report.coverage else ""
    text = f"**{report.tool}**: {found} in {files}{held}\n"
    shown = 0
    for is_row, part in _markdown_parts(findings, report):
        if len(text) + len(part) > ROOM:
            return f"{text}\n{len(findings) - shown} more are not shown here.\n"
        text += part
        shown += is_row
    return text


def _markdown_parts(findings: Sequence[Finding], report: Report) -> Iterator[tuple[bool, str]]:
    """Yield (is it the row of a finding, text) for each part of the text."""
    for file, found in by_file(findings, report).items():
        if not found:
            continue
        head = "| line | level | code | finding |\n| ---: | --- | --- | --- |\n"
        yield False, f"\n#### {_without_markup(path_below(file))}\n\n{head}"
        for it in found:
            calls_of = "".join(f"<br>{_without_markup(line)}" for line in via(it, path_below))
            what = f"{_without_markup(said_of(it) + circumstances(it))}{calls_of}"
            yield True, f"| {it.line or ''} | {it.level} | {title(it, report)} | {what} |\n"


def _without_markup(text: str) -> str:
    return _MARKUP.sub(r"\\\1", one_line(text))


def as_statistics(findings: Sequence[Finding], report: Report) -> str:
    """Return how often each rule found something, in how many files, the most frequent first."""
    alike: dict[tuple[str, str], list[Finding]] = {}
    for it in findings:
        alike.setdefault((it.code, it.level), []).append(it)
    rows = []
    for (code, level), its in alike.items():
        files, fixable = len({it.file for it in its}), sum(bool(it.edits) for it in its)
        name = title(its[0], report).removeprefix(code).lstrip()
        rows.append((str(len(its)), str(files), str(fixable or ""), code, level, name))
    rows.sort(key=lambda it: (-int(it[0]), it[3:]))
    columns = []
    for name, *cells in zip(COLUMNS, *rows, strict=True) if rows else ():
        width = max(map(len, (name, *cells)))
        adjust = str.rjust if name in _NUMBERS else str.ljust
        columns.append([adjust(it, width) for it in (name, *cells)])
    return "".join(f"{'  '.join(row).rstrip()}\n" for row in zip(*columns, strict=True))
