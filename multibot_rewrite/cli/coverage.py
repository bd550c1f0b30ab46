"""``multibot coverage``: how much of a set of descriptions the vocabulary knows."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Iterable, Iterator, Sequence

from multibot_rewrite.cli.output import deliver, say, watched
from multibot_rewrite.cli.parser import UNUSABLE
from multibot_rewrite.cli.process import DONE, PROGRAM, STOPPED
from multibot_rewrite.cli.tables import JSON, Grid, clip, deliver_report, json_bytes
from multibot_rewrite.cli.usage import check_xacro, plain_words, xacro_args
from multibot_rewrite.cli.walk import check_target, find_files
from multibot_rewrite.config import configured_vocabulary
from multibot_rewrite.model import InputError
from multibot_rewrite.plural import plural
from multibot_rewrite.record import NamedTuple
from multibot_rewrite.releases import facts_of_release, release_here
from multibot_rewrite.reports.survey import (
    Explained,
    Loaded,
    MentionPlace,
    Reason,
    Survey,
    Tally,
    add,
    explain,
    ranked,
    read_reasons,
    share,
    survey,
)
from multibot_rewrite.rewriters.builtin import builtin_tree
from multibot_rewrite.rewriters.tree import Tree
from multibot_rewrite.sources.own_names import filled
from multibot_rewrite.sources.read import read_file, read_whole
from multibot_rewrite.steps.collect import collect
from multibot_rewrite.steps.document import read_document

SUFFIXES = (".urdf", ".sdf")


class Unreadable(NamedTuple):
    """A file that could not be read, and why."""

    file: str
    reason: str


class CoverageReport(NamedTuple):
    """Everything that is reported."""

    total: Survey
    unreadable: Sequence[Unreadable]
    exact: Explained
    release: str


def run(options: argparse.Namespace) -> int:
    """Read, add up, report; returns the exit code."""
    paths = find_files(plain_words(options), SUFFIXES)
    check_xacro(options, paths)
    reasons = _reasons(options.explained)
    if options.output:
        check_target(
            options.output, [*paths, *options.vocabulary, *filter(None, [options.explained])]
        )
    tree = builtin_tree(
        (*configured_vocabulary(paths[0]), *options.vocabulary), release_here(options.distro)
    )
    unreadable: list[Unreadable] = []
    arguments = filled(xacro_args(options))

    def read(path: str) -> tuple[bytes, str]:
        own = arguments if path.endswith(".xacro") else {}
        found = read_whole(path, own, options.trust)
        if options.output:
            check_target(options.output, found.read)
        return found.data, found.file

    found = _surveys(watched(paths, len(paths), "reading"), tree, read, unreadable)
    total = add(found)
    report = CoverageReport(total, unreadable, explain(total, reasons), tree.vocabulary.release)
    if options.form == JSON:
        deliver(options, json_bytes(as_json(report)))
    else:
        deliver_report(options, _parts(report, options.top or None))
    return _verdict(report, options)


def _reasons(path: str | None) -> list[Reason]:
    if path is None:
        return []
    try:
        text = read_file(path).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise InputError(f"{path}: cannot be read: it is not UTF-8; save it as UTF-8") from None
    return read_reasons(text, path)


def _surveys(
    paths: Iterable[str],
    tree: Tree,
    read: Callable[[str], tuple[bytes, str]],
    unreadable: list[Unreadable],
) -> Iterator[Survey]:
    """One survey a file; what cannot be read is put into ``unreadable``."""
    for path in paths:
        try:
            data, name = read(path)
            yield survey(collect(read_document(data, name), tree), tree)
        except InputError as error:
            unreadable.append(Unreadable(path, str(error)))


def _verdict(report: CoverageReport, options: argparse.Namespace) -> int:
    """The exit code, and why on standard error."""
    if not report.total.files:
        say("none of the files can be read", PROGRAM)
        return UNUSABLE
    failed = False
    count, known = share(report.total, "plugin")
    if options.min_known is not None and known * 100 < options.min_known * count:
        percent = _percentage(count, known)
        say(f"{percent} % of the plugins are known, wanted {options.min_known:g} %", PROGRAM)
        failed = True
    left = sum(tally.times for _, tally in report.exact.left)
    if options.explained is not None and left:
        say(f"{plural(left, 'exact mention')} not explained in {options.explained}", PROGRAM)
        failed = True
    return STOPPED if failed else DONE


def _percentage(count: int, known: int) -> float:
    """Rounded down, so that 100 means all; all of nothing is all."""
    return math.floor(1000 * known / count) / 10 if count else 100.0


def as_json(report: CoverageReport) -> dict[str, object]:
    """The report as ``--form json`` writes it; docs/coverage.md describes it."""
    exact = report.exact
    return {
        "distro": report.release,
        "files": {
            "read": report.total.files,
            "unreadable": [item._asdict() for item in report.unreadable],
        },
        "plugins": _loaded_json(report.total, "plugin"),
        "hardware": _loaded_json(report.total, "hardware"),
        "claims": dict(sorted(report.total.claims.items())),
        "mentions": {
            "exact": [_mention_json(*pair) for pair in ranked(exact.left)],
            "inside": [_mention_json(*pair) for pair in _inside(report)],
            "explained": [
                {**_mention_json(mention, tally), "reason": reason.text}
                for mention, tally, reason in exact.explained
            ],
            "stale": [{"path": stale.path, "line": stale.line} for stale in exact.stale],
        },
    }


def _loaded_json(total: Survey, type_: str) -> dict[str, object]:
    count, known = share(total, type_)
    names = [it for it in total.loaded if it.type == type_]
    return {
        "count": count,
        "known": known,
        "percent": _percentage(count, known),
        "names": len(names),
        "known_names": sum(it.known for it in names),
        "unknown": [
            {"name": it.name, "count": tally.times, "files": tally.files, "place": tally.place}
            for it, tally in _unknown(total, type_)
        ],
    }


def _mention_json(mention: MentionPlace, tally: Tally) -> dict[str, object]:
    return {
        "path": mention.path,
        "count": tally.times,
        "files": tally.files,
        "place": tally.place,
        "value": tally.value,
    }


def _unknown(total: Survey, type_: str) -> list[tuple[Loaded, Tally]]:
    return ranked((it, t) for it, t in total.loaded.items() if it.type == type_ and not it.known)


def _inside(report: CoverageReport) -> list[tuple[MentionPlace, Tally]]:
    return ranked(pair for pair in report.total.mentions.items() if not pair[0].exact)


def _parts(report: CoverageReport, top: int | None) -> Iterator[str | Grid]:
    """What is printed; ``top`` is how many rows a table has at most."""
    total, exact = report.total, report.exact
    read = f"{plural(total.files, 'file')} read, {len(report.unreadable)} cannot be read"
    yield f"{read}{facts_of_release(report.release)}"
    yield from (f"  {item.reason}" for item in report.unreadable)
    yield from _loaded_parts(total, "plugin", "plugins", top)
    yield from _loaded_parts(total, "hardware", "hardware classes", top)
    claims = sorted(total.claims.items(), key=lambda pair: (-pair[1], pair[0]))
    yield ""
    yield f"{plural(sum(total.claims.values()), 'value')} claimed"
    if claims:
        yield "  " + ", ".join(f"{kind} {count}" for kind, count in claims)
    yield from _mention_parts("unclaimed and exactly a link or joint", ranked(exact.left), top)
    yield from _mention_parts("unclaimed with a link or joint inside", _inside(report), top)
    if exact.explained:
        yield ""
        yield f"{plural(_times(exact.explained), 'exact mention')} explained"
        rows = [
            (str(t.times), str(t.files), m.path, reason.text) for m, t, reason in exact.explained
        ]
        yield Grid(("count", "files", "path", "reason"), rows[:top])
        yield from _rest(rows, top)
    for stale in exact.stale:
        yield f"stale: line {stale.line} explains nothing any more: {stale.path}"


def _loaded_parts(total: Survey, type_: str, words: str, top: int | None) -> Iterator[str | Grid]:
    count, known = share(total, type_)
    names = [it.known for it in total.loaded if it.type == type_]
    percent = _percentage(count, known)
    yield ""
    yield f"{known} of {count} {words} known ({percent} %), {sum(names)} of {len(names)} names"
    unknown = _unknown(total, type_)
    rows = [(str(t.times), str(t.files), it.name, t.place) for it, t in unknown]
    if rows:
        yield Grid(("count", "files", "not known", "first seen"), rows[:top])
        yield from _rest(rows, top)


def _mention_parts(
    what: str, mentions: Sequence[tuple[MentionPlace, Tally]], top: int | None
) -> Iterator[str | Grid]:
    yield ""
    yield f"{_times(mentions)} {what}"
    rows = [(str(t.times), str(t.files), m.path, clip(t.value), t.place) for m, t in mentions]
    if rows:
        yield Grid(("count", "files", "path", "value", "first seen"), rows[:top])
        yield from _rest(rows, top)


def _times(rows: Iterable[tuple[MentionPlace, Tally] | tuple[MentionPlace, Tally, Reason]]) -> int:
    return sum(row[1].times for row in rows)


def _rest(rows: Sequence[object], top: int | None) -> Iterator[str]:
    if top is not None and len(rows) > top:
        yield f"  and {plural(len(rows) - top, 'more row')}; --top 0 shows all"
