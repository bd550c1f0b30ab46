# SPDX-License-Identifier: Apache-2.0
"""``multibot inspect`` of a program's source (PACKAGE_FOLDER/PROGRAM) or a known NODE."""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterator

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.releases import RELEASES, has_release, release_here
from multibot_rewrite.base.wording import plural
from multibot_rewrite.cli.output import deliver
from multibot_rewrite.cli.process import DONE
from multibot_rewrite.cli.tables import JSON, Grid, deliver_report, json_bytes
from multibot_rewrite.description.sources.packages import MANIFEST, package_of
from multibot_rewrite.knowledge.conditions import readable
from multibot_rewrite.knowledge.node_sets import every_release
from multibot_rewrite.knowledge.packages import older, versions_of
from multibot_rewrite.knowledge.records import Endpoint, NodeFacts, NodeParameters, Param
from multibot_rewrite.producers.launch.source_packages import packages_for
from multibot_rewrite.producers.sources.facts import NodeSource, node_of_program


def is_program(word: str) -> bool:
    """Return whether a word is a program of an installed package, or a class of one."""
    folder, name = os.path.split(word)
    named = bool(folder and name) and not os.path.lexists(word)
    return named and os.path.isfile(os.path.join(folder, MANIFEST))


def run(options: argparse.Namespace, word: str) -> int:
    """Read the source of a program; returns the exit code, raises UsageError without a program."""
    folder, program = os.path.split(os.path.abspath(word))
    name, _ = package_of(os.path.join(folder, MANIFEST)) or ("", "")
    packages = packages_for(os.path.join(folder, MANIFEST), ())
    found = node_of_program(folder, name, program, packages, release_here(options.distro))
    if found is None:
        hint = "name what its setup.py or CMakeLists.txt installs, or the class of a component"
        raise UsageError(
            f"{word}: package {name!r} has no program {program!r} whose source is here; {hint}"
        )
    if options.output_kind == JSON:
        deliver(options, json_bytes({"nodes": [_as_json(found)]}))
    else:
        deliver_report(options, _printed_details(found, folder))
    return DONE


def run_known(options: argparse.Namespace, facts: NodeFacts) -> int:
    """Show a known node and its package in a release, or in all; return the exit code."""
    releases = [options.distro] if options.distro else [*RELEASES]
    of_package = versions_of(facts.package)
    rows = [
        (it, *of_package[it], older(facts.package, it) and "older than the release")
        for it in releases
        if it in of_package
    ]
    ends = (it for it in facts.endpoints if any(has_release(it.releases, one) for one in releases))
    known = every_release().parameters.get(facts.name.rpartition("/")[2], NodeParameters("", ""))
    params = (it for it in known.forms if any(has_release(it.releases, one) for one in releases))
    found = NodeSource(facts._replace(endpoints=tuple(ends)), tuple(params), (), facts.source)
    if options.output_kind == JSON:
        versions = {it: of_package[it]._asdict() for it in releases if it in of_package}
        deliver(options, json_bytes({"nodes": [{**_as_json(found), "versions": versions}]}))
    else:
        grid = Grid(("release", "came with", "has", "read at", "of version", "of", ""), rows)
        deliver_report(options, (*_printed_details(found, ""), *(("", grid) if rows else ())))
    return DONE


def _printed_details(found: NodeSource, folder: str) -> Iterator[str | Grid]:
    facts = found.facts
    yield f"node {facts.name} of {facts.package}, by {plural(len(found.files), 'file')} of its source"
    own = [
        (
            it.role,
            it.name,
            "; ".join((it.type, *(f"{type_} if {readable(when)}" for when, type_ in it.types))),
            it.parameter,
            readable(it.when),
            _source_text(it, folder),
        )
        for it in facts.endpoints
    ]
    if own:
        yield ""
        yield Grid(("role", "name", "type", "parameter", "only if", "source"), own)
    if found.params:
        yield ""
        rows = [(it.path, it.default, it.kind, _source_text(it, folder)) for it in found.params]
        yield Grid(("parameter", "default", "holds", "source"), rows)
    if found.frames:
        yield ""
        named = [
            (frame, what, _relative_place(f"{at}", folder)) for what, frame, at in found.frames
        ]
        yield Grid(("frame in the code", "as", "source"), named)
    for it in facts.untold:
        yield f"not known: {_relative_place(it.text, folder)}"


def _source_text(it: Endpoint | Param, folder: str = "") -> str:
    """Return where a fact can be read, otherwise the releases that have it."""
    return _relative_place(it.source[0], folder) if it.source else it.releases


def _relative_place(text: str, folder: str) -> str:
    """Return a place relative to the package."""
    return text.replace(os.path.join(os.path.realpath(folder), ""), "") if folder else text


def _as_json(found: NodeSource) -> dict[str, object]:
    facts = found.facts
    frames = {it.parameter: it.default for it in facts.frames}
    return {
        "name": facts.name,
        "package": facts.package,
        "ends": [
            {
                **{
                    key: getattr(it, key)
                    for key in ("role", "kind", "name", "type", "parameter", "when")
                },
                "source": _source_text(it),
            }
            for it in facts.endpoints
        ],
        "parameters": [
            {"name": it.path, "default": it.default, "holds": it.kind, "source": _source_text(it)}
            for it in found.params
        ],
        "frames": [
            {"as": what, "frame": frame, "source": f"{at}"} for what, frame, at in found.frames
        ],
        "sends": [[frames[it.parent], frames[it.child]] for it in facts.sends],
        "not_known": [it.text for it in facts.untold],
        "files": list(found.files),
    }
