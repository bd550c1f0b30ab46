"""``multibot vocabulary``: what is known of a plugin, and a first vocabulary for what is not."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence

from multibot_rewrite.cli.files import write_all
from multibot_rewrite.cli.output import print_bytes, say
from multibot_rewrite.cli.process import DONE, PROGRAM
from multibot_rewrite.cli.tables import Grid, json_bytes, print_report
from multibot_rewrite.cli.walk import check_target
from multibot_rewrite.config import configured_vocabulary
from multibot_rewrite.model import Site, UsageError
from multibot_rewrite.reports.suggest import suggest, vocabulary_text
from multibot_rewrite.rewriters.builtin import builtin_tree
from multibot_rewrite.rewriters.lookup import block_of, look_up, near_names
from multibot_rewrite.rewriters.vocabulary import TYPES, Vocabulary, VocabularySection
from multibot_rewrite.rewriters.vocabulary.describe import facts
from multibot_rewrite.sources.read import read_source
from multibot_rewrite.steps.collect import collect
from multibot_rewrite.steps.document import read_document

MORE = """\
examples:
  multibot vocabulary                                  all sections
  multibot vocabulary libgazebo_ros_diff_drive.so      everything known of one
  multibot vocabulary --suggest rover.urdf > acme.vocab
exit codes: 0 done; 2 wrong use, an unknown name or unreadable input
"""


def options(parser: argparse.ArgumentParser) -> None:
    """Add the options of the command."""
    parser.epilog = MORE
    parser.add_argument(
        "name", nargs="?", metavar="NAME", help="a library file, a class, an element, a sensor type"
    )
    parser.add_argument("--type", choices=TYPES, help="only sections of this type")
    parser.add_argument("--json", metavar="FILE", help="write it as JSON (- is standard output)")
    parser.add_argument(
        "--vocabulary", action="append", default=[], metavar="FILE", help="more vocabulary"
    )
    parser.add_argument(
        "--suggest",
        metavar="FILE",
        help="print a vocabulary file for what this description loads and nothing knows",
    )


def run(options: argparse.Namespace) -> int:
    """List, show or suggest; returns the exit code."""
    if options.suggest is not None:
        return _suggest(options)
    files = (*configured_vocabulary("-"), *options.vocabulary)
    vocabulary = builtin_tree(files).vocabulary
    types = [options.type] if options.type else list(TYPES)
    if options.name is None:
        found = vocabulary.sections(*types)
    else:
        found = _found(vocabulary, options.name, types)
    if options.json is not None:
        _write_json(options.json, {"sections": [as_json(it) for it in found]}, files)
    if options.json != "-":
        print_report(_list(found) if options.name is None else _details(found))
    return DONE


def _found(vocabulary: Vocabulary, name: str, types: Sequence[str]) -> list[VocabularySection]:
    found = look_up(vocabulary, name, types)
    if found:
        return found
    near = near_names(vocabulary, name, types)
    hint = f"the nearest known: {', '.join(near)}" if near else "multibot vocabulary lists all"
    what = types[0] if len(types) == 1 else "plugin, class, element, sensor type or block"
    raise UsageError(f"{name!r} is no {what} of the vocabulary; {hint}")


def _write_json(path: str, value: object, inputs: Sequence[str]) -> None:
    if path == "-":
        print_bytes(json_bytes(value))
        return
    check_target(path, inputs)
    write_all([(path, json_bytes(value))])


def _list(sections: Sequence[VocabularySection]) -> Iterator[str | Grid]:
    """One line a section."""
    columns = ("type", "name", "ROS", "also called", "rows", "source")
    rows = [
        (it.type, it.names[0], it.ros, " ".join(it.names[1:]), str(len(it.sites)), it.source)
        for it in sections
    ]
    yield Grid(columns, rows)


def _details(sections: Sequence[VocabularySection]) -> Iterator[str | Grid]:
    """Everything known, a block of lines a section."""
    for number, section in enumerate(sections):
        yield f"{chr(10) * (number > 0)}{section.name}  {section.file}:{section.line}"
        yield from (f"  {what}: {text}" for what, text in facts(section).items())
        rows = [_row(site, section) for site in section.sites]
        if rows:
            yield Grid(("path", "role", "kinds", "form", "default", "note", "from"), rows)


def _row(site: Site, section: VocabularySection) -> tuple[str, ...]:
    not_inserted = " (not inserted)" if site.default and not section.inserts else ""
    block = block_of(site)
    shared = f" [block {block}]" if block else ""
    note = " ".join(filter(None, [site.note, f"(when {site.when})" if site.when else ""]))
    return (
        site.path,
        site.role,
        " ".join(site.kinds),
        "" if site.form == "whole" else site.form,
        f"{site.default}{not_inserted}",
        note,
        f"{site.file}:{site.line}{shared}",
    )


def as_json(section: VocabularySection) -> dict[str, object]:
    """A section as ``--json`` writes it; docs/coverage.md describes it."""
    return {
        "type": section.type,
        "names": section.names,
        "ros": section.ros,
        "about": section.about,
        "source": section.source,
        "file": section.file,
        "line": section.line,
        "at": section.at,
        "blocks": section.blocks,
        "remap_only": section.topics,
        "rows": [_row_json(site, section) for site in section.sites],
    }


def _row_json(site: Site, section: VocabularySection) -> dict[str, object]:
    return {
        "path": site.path,
        "role": site.role,
        "kinds": site.kinds,
        "form": site.form,
        "default": site.default,
        "inserted": bool(site.default) and section.inserts,
        "when": site.when,
        "note": site.note,
        "block": block_of(site),
        "file": site.file,
        "line": site.line,
    }


def _suggest(options: argparse.Namespace) -> int:
    if options.name is not None or options.type or options.json is not None:
        raise UsageError("--suggest goes with --vocabulary only: leave out NAME, --type and --json")
    data, name = read_source(options.suggest, {})
    tree = builtin_tree((*configured_vocabulary(options.suggest), *options.vocabulary))
    sections = suggest(collect(read_document(data, name), tree))
    text = vocabulary_text(sections, options.suggest)
    print_bytes(text.encode("utf-8", "backslashreplace"), "a shell's >")
    if not sections:
        say(
            f"{options.suggest}: everything it loads is known, there is nothing to suggest", PROGRAM
        )
    return DONE
