# SPDX-License-Identifier: Apache-2.0
"""``multibot inspect``: what is known of findings, plugins, a xacro's arguments."""

from __future__ import annotations

import argparse
import os
import re
import shlex
from collections.abc import Iterable, Iterator, Mapping, Sequence

from multibot_rewrite.base.config import configured_definitions
from multibot_rewrite.base.findings.codes import (
    examples,
    explained,
    find_rules,
    listed,
    near_name,
    no_rule,
)
from multibot_rewrite.base.findings.finding import Rule
from multibot_rewrite.base.model import SiteRow, UsageError
from multibot_rewrite.base.nearest import nearest
from multibot_rewrite.base.releases import release_here
from multibot_rewrite.base.wording import clip, shorten
from multibot_rewrite.cli import node_source
from multibot_rewrite.cli.output import deliver, note
from multibot_rewrite.cli.process import DONE
from multibot_rewrite.cli.tables import JSON, Grid, deliver_report, json_bytes
from multibot_rewrite.cli.usage import check_xacro, plain_words, xacro_args
from multibot_rewrite.cli.walk import check_target
from multibot_rewrite.description.reports.suggest import definitions_text, suggest
from multibot_rewrite.description.reports.xacro_arguments import (
    XacroArguments,
    as_json as arguments_json,
    find_arguments,
)
from multibot_rewrite.description.rewriters.lookup import block_of, facts, look_up, near_names
from multibot_rewrite.description.rewriters.plugin_definitions import (
    TYPES,
    Definitions,
    PluginDefinition,
    load_definitions,
)
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.description.sources.access import Reach
from multibot_rewrite.description.sources.job import read_whole
from multibot_rewrite.description.sources.own_names import filled
from multibot_rewrite.description.sources.read import is_xacro
from multibot_rewrite.description.steps.collect import collect
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.knowledge.declared import declared_by, plugin_bases
from multibot_rewrite.knowledge.node_sets import every_release
from multibot_rewrite.lint.catalogue import rules

# A word that ends so is a file, there or not.
_FILES = (".urdf", ".sdf", ".srdf", ".xacro", ".xml")


def run(options: argparse.Namespace) -> int:
    """Look up a code or name, try a xacro's arguments, or draft what is missing; returns the code."""
    if options.suggest is not None:
        return draft(options)
    words = plain_words(options)
    if len(words) == 1 and words[0].endswith((".yaml", ".yml")) and os.path.isfile(words[0]):
        from multibot_rewrite.cli import launched  # only a fleet needs it

        return launched.run(options, words[0])
    if len(words) == 1 and node_source.is_program(words[0]):
        return node_source.run(options, words[0])
    paths = any(map(_is_path, words))
    if not paths and any(map(_CODE.fullmatch, _split_codes(words))):
        return explain(options, words)
    if len(words) > 1 or xacro_args(options) or paths:
        return try_arguments(options, words)
    return show(options, next(iter(words), None))


def _is_path(word: str) -> bool:
    return os.path.lexists(word) or word.endswith(_FILES)


def show(options: argparse.Namespace, name: str | None) -> int:
    """List all sections, or show those of a name; returns the exit code."""
    files = (*configured_definitions("-"), *options.definitions)
    if options.output:
        check_target(options.output, files)
    builtin_tree(files, release_here(options.distro))
    # Without a release the rows of all are shown, each with its own.
    definitions = load_definitions(files, options.distro or "")
    if name is None:
        sections = definitions.sections(*TYPES)
        if options.output_kind == JSON:
            known = [as_json(it) for it in sections]
            deliver(options, json_bytes({"sections": known, "rules": rules_json()}))
        else:
            deliver_report(options, (*_section_table(sections), "", rule_grid()))
        return DONE
    found = look_up(definitions, name, TYPES)
    if not found and is_name(name):
        return explain(options, [name])
    node = None if found else every_release().nodes.get(name)
    if node:
        return node_source.run_known(options, node)
    bases = {base: it.classes[name] for base, it in plugin_bases().items() if name in it.classes}
    if not (found or bases):
        raise _unknown_name(definitions, name, TYPES)
    if not found:
        deliver_report(options, _class_lines(name, bases))
    elif options.output_kind == JSON:
        deliver(options, json_bytes({"sections": [as_json(it) for it in found]}))
    else:
        deliver_report(options, details(found))
    return DONE


def _class_lines(name: str, bases: Mapping[str, str]) -> Iterator[str | Grid]:
    """Yield what is known of a class registered for pluginlib, and its parameters."""
    for base, releases in bases.items():
        yield f"{name}  a plugin of {base}, in {releases or 'all releases'}"
    rows = [(it.path, it.type, it.releases, it.source) for it in declared_by(name)]
    if rows:
        yield Grid(("parameter", "type", "releases", "source"), rows)


def _unknown_name(definitions: Definitions, name: str, types: Sequence[str]) -> UsageError:
    others = [it for type_ in types for it in definitions.releases_elsewhere(type_, name)]
    if others:
        where = f"is not in {definitions.release}, only in {', '.join(dict.fromkeys(others))}"
        return UsageError(f"{name!r} {where}; name one of them with --distro")
    classes = (it for base in plugin_bases().values() for it in base.classes)
    other = nearest(name, (*every_release().nodes, *classes))
    near = near_names(definitions, name, types) or [other or near_name(name, rules())]
    hint = f"the nearest known: {', '.join(near)}" if any(near) else "multibot inspect lists all"
    what = "plugin, node, class, element, sensor type, rule or file"
    return UsageError(f"{name!r} is not known: no {what} has this name; {hint}")


def _section_table(sections: Sequence[PluginDefinition]) -> Iterator[str | Grid]:
    """Yield a table with one line a section."""
    rows = [
        (it.type, it.names[0], it.ros, shorten(it.names[1:], 1), str(len(it.sites)), it.source)
        for it in sections
    ]
    yield Grid(("type", "name", "ROS", "also called", "rows", "source"), rows)


def details(sections: Sequence[PluginDefinition]) -> Iterator[str | Grid]:
    """Yield everything known, a block of lines a section."""
    for number, section in enumerate(sections):
        yield from [""] * (number > 0)
        yield f"{section.name}  {section.file}:{section.line}"
        yield from (f"  {what}: {text}" for what, text in facts(section).items())
        rows = [_site_row(site, section) for site in section.sites]
        if rows:
            yield Grid(("path", "role", "kinds", "form", "default", "note", "from"), rows)


def _site_row(site: SiteRow, section: PluginDefinition) -> tuple[str, ...]:
    """Return a row of the table: path, role, kinds, form, default, note, place."""
    not_inserted = " (not inserted)" if site.default and not section.inserts else ""
    block = block_of(site)
    shared = f" [block {block}]" if block else ""
    here = f"in {site.releases}:" if site.releases else ""
    note = " ".join(filter(None, [here, site.note, f"(when {site.when})" if site.when else ""]))
    return (
        site.path,
        site.role,
        " ".join(site.kinds),
        "" if site.form == "whole" else site.form,
        f"{site.default}{not_inserted}",
        note,
        f"{site.file}:{site.line}{shared}",
    )


def as_json(section: PluginDefinition) -> dict[str, object]:
    """Return a section as ``--output-kind json`` writes it; docs/node-sets.md describes it."""
    return {
        "type": section.type,
        "names": section.names,
        "ros": section.ros,
        "about": section.about,
        "source": section.source,
        "releases": section.releases,
        "file": section.file,
        "line": section.line,
        "at": section.at,
        "blocks": section.blocks,
        "remap_only": section.topics,
        "topics": [it._asdict() for it in section.wired],
        "rows": [_row_json(site, section) for site in section.sites],
    }


def _row_json(site: SiteRow, section: PluginDefinition) -> dict[str, object]:
    return {
        "path": site.path,
        "role": site.role,
        "kinds": site.kinds,
        "form": site.form,
        "default": site.default,
        "inserted": bool(site.default) and section.inserts,
        "when": site.when,
        "note": site.note,
        "releases": site.releases,
        "block": block_of(site),
        "file": site.file,
        "line": site.line,
    }


def draft(options: argparse.Namespace) -> int:
    """Write plugin definitions for what a description loads and nothing knows; return the exit code."""
    if plain_words(options) or options.output_kind == JSON:
        raise UsageError("--suggest goes with --definitions only: leave out NAME and --output-kind")
    check_xacro(options, [options.suggest])
    if options.output:
        check_target(options.output, [options.suggest, *options.definitions])
    read = read_whole(options.suggest, filled(xacro_args(options)), options.trust)
    if options.output:
        check_target(options.output, read.read)
    files = (*configured_definitions(options.suggest), *options.definitions)
    tree = builtin_tree(files, release_here(options.distro))
    sections = suggest(collect(read_document(read.data, read.file), tree))
    text = definitions_text(sections, options.suggest)
    deliver(options, text.encode("utf-8", "backslashreplace"))
    if not sections:
        note(
            options, f"{options.suggest}: everything it loads is known, there is nothing to suggest"
        )
    return DONE


# More rules than these are listed, a line each.
MOST_EXPLAINED = 10
# MB202, as it begins (mb2), and what is nearly one.
_CODE = re.compile(r"M[A-Z](\d\w*)?", re.IGNORECASE)


def is_name(word: str) -> bool:
    """Return whether a rule has this name."""
    return any(it.name == word for it in rules().values())


def explain(options: argparse.Namespace, words: Sequence[str]) -> int:
    """Explain rules by codes, beginnings of codes or names; list many. Return the exit code."""
    known, found = rules(), dict[str, Rule]()
    for word in _split_codes(words):
        asked = find_rules(word, known) if word else []
        if not asked:
            raise UsageError(no_rule(word, known))
        found |= {it.code: it for it in asked}
    if options.output_kind == JSON:
        deliver(options, json_bytes({"rules": rules_json(found.values())}))
    elif len(found) > MOST_EXPLAINED:
        deliver_report(options, (rule_grid(found.values()),))
        note(options, "multibot inspect CODE explains one of them")
    else:
        deliver(options, "\n".join(map(explained, found.values())).encode())
    return DONE


def rule_grid(found: Iterable[Rule] | None = None) -> Grid:
    """Return rules (all by default) in a table."""
    shown = rules().values() if found is None else found
    return Grid(("code", "level", "name", "what it finds"), [*listed(shown)])


def rules_json(found: Iterable[Rule] | None = None) -> list[dict[str, object]]:
    """Return rules (by default all) as ``--output-kind json`` writes them (docs/node-sets.md)."""
    fields = ("code", "name", "level", "what", "why", "fix")
    return [
        {**{name: getattr(it, name) for name in fields}, "examples": dict(examples(it))}
        for it in (rules().values() if found is None else found)
    ]


def _split_codes(words: Iterable[str]) -> list[str]:
    return [code for word in words for code in word.split(",")]


ARGUMENT_COLUMNS = ("argument", "default", "goes into", "as", "count", "example")


def try_arguments(options: argparse.Namespace, words: Sequence[str]) -> int:
    """Try the arguments of a xacro file and report them; return the exit code."""
    path = _only_xacro(options, words)
    if options.output:
        check_target(options.output, [path, *options.definitions])
    tree = builtin_tree(
        (*configured_definitions(path), *options.definitions), release_here(options.distro)
    )
    reach = Reach(trust=options.trust)
    found = find_arguments(path, filled(xacro_args(options)), tree, reach=reach)
    if options.output:
        check_target(options.output, found.read)
    if options.output_kind == JSON:
        deliver(options, json_bytes({"xacro": arguments_json(found)}))
    else:
        deliver_report(options, arguments_report(found))
    return DONE


def _only_xacro(options: argparse.Namespace, words: Sequence[str]) -> str:
    """Return the only argument, a xacro file; raises UsageError."""
    missing = next((it for it in words if not os.path.lexists(it)), None)
    if missing is not None:
        raise UsageError(f"{missing}: there is no such file or folder; correct the path")
    if not words:
        raise UsageError(f"{options.words[0]} is an argument of a xacro file; name the file")
    check_xacro(options, words)
    other = next((it for it in words if not is_xacro(it)), None)
    if other is not None:
        linted = shlex.join(["urdf-lint", other])
        raise UsageError(f"{other} is no xacro; {linted} shows what is unknown in it")
    if len(words) > 1:
        raise UsageError(f"{words[1]}: the arguments of one xacro file are shown; leave it out")
    return words[0]


def arguments_report(found: XacroArguments) -> Iterator[str | Grid]:
    """Yield the lines and tables about a xacro's arguments."""
    rows: list[tuple[str, ...]] = []
    for it in found.arguments:
        first = it.name, clip(it.default)
        for use in it.uses:
            how = f"{use.how} {use.separator}".rstrip()
            many = f"{use.names} of {use.total}"
            rows.append((*first, use.kind, how, many, use.example))
            first = "", ""
    if rows:
        yield Grid(ARGUMENT_COLUMNS, rows)
        yield ""
    without = [it.name for it in found.arguments if not it.uses and not it.fault]
    if without:
        yield f"go into no names: {', '.join(without)}"
    refused = [it.name for it in found.arguments if it.fault]
    if refused:
        yield f"take no name of a robot: {', '.join(refused)}"
    if found.untried:
        yield f"too many to try: {', '.join(found.untried)}"
    command = ["urdf-postfix", found.file, "robot1", "robot2", "-o", "out/{robot}.urdf"]
    if found.words:
        yield "each robot by its own argument, and everything else rewritten as usual:"
    else:
        yield "no argument gives each robot its own names; the rewrite does it:"
    yield f"  {shlex.join([*command, *found.words])}"
