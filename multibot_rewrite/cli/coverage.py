# SPDX-License-Identifier: Apache-2.0
"""``multibot inspect PATH...``: how much of descriptions is known, and what a xacro's arguments do."""

from __future__ import annotations

import argparse
import math
import shlex
from collections.abc import Callable, Iterable, Iterator, Sequence

from multibot_rewrite.base.config import configured_vocabulary
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.base.releases import facts_of_release, release_here
from multibot_rewrite.base.wording import clip, plural
from multibot_rewrite.cli.output import deliver, note, watched
from multibot_rewrite.cli.process import DONE
from multibot_rewrite.cli.tables import JSON, Grid, deliver_report, json_bytes
from multibot_rewrite.cli.usage import check_xacro, plain_words, xacro_args
from multibot_rewrite.cli.walk import check_target, find_files
from multibot_rewrite.description.reports.spawners import SpawnerRules, spawner_rules
from multibot_rewrite.description.reports.survey import (
    Loaded,
    MentionPlace,
    Survey,
    Tally,
    add,
    ranked,
    share,
    survey,
)
from multibot_rewrite.description.reports.xacro_arguments import (
    Argument,
    XacroArguments,
    find_arguments,
)
from multibot_rewrite.description.reports.xacro_arguments import as_json as xacro_json
from multibot_rewrite.description.rewriters.builtin import builtin_tree
from multibot_rewrite.description.rewriters.tree import Tree
from multibot_rewrite.description.sources.access import Reach
from multibot_rewrite.description.sources.own_names import filled
from multibot_rewrite.description.sources.read import is_xacro
from multibot_rewrite.description.sources.whole import read_whole
from multibot_rewrite.description.steps.collect import collect
from multibot_rewrite.description.steps.document import read_document

SUFFIXES = (".urdf", ".sdf")
# So many rows has a table.
TOP = 20
COLUMNS = ("argument", "default", "goes into", "as", "count", "example")


class Unreadable(NamedTuple):
    """A file that could not be read, and why."""

    file: str
    reason: str


class CoverageReport(NamedTuple):
    """Everything that is reported."""

    total: Survey
    unreadable: Sequence[Unreadable]
    release: str
    spawners: Sequence[SpawnerRules] = ()


def run(options: argparse.Namespace) -> int:
    """Read, add up, report; returns the exit code."""
    found_files = find_files(plain_words(options), SUFFIXES, options.no_default_excludes)
    paths = found_files.files
    if found_files.left_out:
        note(options, found_files.left_out)
    check_xacro(options, paths)
    if options.output:
        check_target(options.output, [*paths, *options.vocabulary])
    tree = builtin_tree(
        (*configured_vocabulary(paths[0]), *options.vocabulary), release_here(options.distro)
    )
    unreadable: list[Unreadable] = []
    arguments = filled(xacro_args(options))
    own = arguments_of(options, paths, tree)

    def read(path: str) -> tuple[bytes, str]:
        own = arguments if path.endswith(".xacro") else {}
        found = read_whole(path, own, options.trust)
        if options.output:
            check_target(options.output, found.read)
        return found.data, found.file

    rules: list[SpawnerRules] = []
    found = _surveys(watched(paths, len(paths), "reading"), tree, read, unreadable, rules)
    total = add(found)
    report = CoverageReport(total, unreadable, tree.vocabulary.release, rules)
    if options.form == JSON:
        more = {"xacro": xacro_json(own)} if own else {}
        deliver(options, json_bytes({**as_json(report), **more}))
    if not total.files:
        raise InputError(_first(unreadable))
    if options.form != JSON:
        above = (*xacro_parts(own), "") if own else ()
        deliver_report(options, (*above, *_parts(report)))
    return DONE


def _surveys(
    paths: Iterable[str],
    tree: Tree,
    read: Callable[[str], tuple[bytes, str]],
    unreadable: list[Unreadable],
    rules: list[SpawnerRules],
) -> Iterator[Survey]:
    """One survey a file; what cannot be read is put into ``unreadable``, what its controllers are
    spawned with into ``rules``."""
    for path in paths:
        try:
            data, name = read(path)
            yield survey(collect(read_document(data, name), tree), tree)
            rules += spawner_rules(data, name, tree)
        except InputError as error:
            unreadable.append(Unreadable(path, str(error)))


def _first(unreadable: Sequence[Unreadable]) -> str:
    """Why none of the files can be read."""
    others = f"; the other {len(unreadable) - 1} cannot be read, either" if unreadable[1:] else ""
    return f"{unreadable[0].reason}{others}"


def _percentage(count: int, known: int) -> float:
    """Rounded down, so that 100 means all; all of nothing is all."""
    return math.floor(1000 * known / count) / 10 if count else 100.0


def as_json(report: CoverageReport) -> dict[str, object]:
    """The report as ``--form json`` writes it; docs/stacks.md describes it."""
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
            "exact": [_mention_json(*pair) for pair in _of(report, exact=True)],
            "inside": [_mention_json(*pair) for pair in _of(report, exact=False)],
        },
        "spawners": [it._asdict() for it in report.spawners],
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


def _of(report: CoverageReport, exact: bool) -> list[tuple[MentionPlace, Tally]]:
    return ranked(it for it in report.total.mentions.items() if it[0].exact == exact)


def _parts(report: CoverageReport) -> Iterator[str | Grid]:
    """What is printed."""
    total = report.total
    read = f"{plural(total.files, 'file')} read, {len(report.unreadable)} cannot be read"
    yield f"{read}{facts_of_release(report.release)}"
    yield from (f"  {item.reason}" for item in report.unreadable)
    yield from _loaded_parts(total, "plugin", "plugins")
    yield from _loaded_parts(total, "hardware", "hardware classes")
    claims = sorted(total.claims.items(), key=lambda pair: (-pair[1], pair[0]))
    yield ""
    yield f"{plural(sum(total.claims.values()), 'value')} claimed"
    if claims:
        yield "  " + ", ".join(f"{kind} {count}" for kind, count in claims)
    yield from _mention_parts("unclaimed and exactly a link or joint", _of(report, exact=True))
    yield from _mention_parts("unclaimed with a link or joint inside", _of(report, exact=False))
    for it in report.spawners:
        yield ""
        yield f"{it.place} in layout {it.layout}: {it.advice}"


def _loaded_parts(total: Survey, type_: str, words: str) -> Iterator[str | Grid]:
    count, known = share(total, type_)
    names = [it.known for it in total.loaded if it.type == type_]
    percent = _percentage(count, known)
    yield ""
    yield f"{known} of {count} {words} known ({percent} %), {sum(names)} of {len(names)} names"
    unknown = _unknown(total, type_)
    rows = [(str(t.times), str(t.files), it.name, t.place) for it, t in unknown]
    if rows:
        yield Grid(("count", "files", "not known", "first seen"), rows[:TOP])
        yield from _rest(rows)


def _mention_parts(
    what: str, mentions: Sequence[tuple[MentionPlace, Tally]]
) -> Iterator[str | Grid]:
    yield ""
    yield f"{sum(row[1].times for row in mentions)} {what}"
    rows = [(str(t.times), str(t.files), m.path, clip(t.value), t.place) for m, t in mentions]
    if rows:
        yield Grid(("count", "files", "path", "value", "first seen"), rows[:TOP])
        yield from _rest(rows)


def _rest(rows: Sequence[object]) -> Iterator[str]:
    if len(rows) > TOP:
        yield f"  and {plural(len(rows) - TOP, 'more row')}; --form json shows all"


def arguments_of(
    options: argparse.Namespace, paths: Sequence[str], tree: Tree
) -> XacroArguments | None:
    """The arguments of a xacro that is looked at alone."""
    if len(paths) != 1 or not is_xacro(paths[0]):
        return None
    found = find_arguments(
        paths[0], filled(xacro_args(options)), tree, reach=Reach(trust=options.trust)
    )
    if options.output:
        check_target(options.output, found.read)
    return found


def xacro_parts(found: XacroArguments) -> Iterator[str | Grid]:
    """What is printed of them."""
    rows = [row for it in found.arguments for row in _rows(it)]
    if rows:
        yield Grid(COLUMNS, rows)
        yield ""
    without = [it.name for it in found.arguments if not it.uses and not it.fault]
    if without:
        yield f"go into no names: {', '.join(without)}"
    refused = [it.name for it in found.arguments if it.fault]
    if refused:
        yield f"take no name of a robot: {', '.join(refused)}"
    if found.untried:
        yield f"too many to try: {', '.join(found.untried)}"
    yield from _advice(found)


def _rows(it: Argument) -> Iterator[tuple[str, ...]]:
    first = it.name, clip(it.default)
    for use in it.uses:
        how = f"{use.how} {use.separator}".rstrip()
        yield *first, use.kind, how, f"{use.names} of {use.total}", use.example
        first = "", ""


def _advice(found: XacroArguments) -> Iterator[str]:
    """The command that uses the arguments for robots."""
    command = ["urdf-postfix", found.file, "robot1", "robot2", "-o", "out/{robot}.urdf"]
    line = shlex.join([*command, *found.words])
    if found.words:
        yield "each robot by its own argument, and everything else rewritten as usual:"
    else:
        yield "no argument gives each robot its own names; the rewrite does it:"
    yield f"  {line}"
