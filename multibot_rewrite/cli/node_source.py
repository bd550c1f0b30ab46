# SPDX-License-Identifier: Apache-2.0
"""``multibot inspect PACKAGE_FOLDER/PROGRAM``: what the source of a node says, with file and line."""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterator

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.releases import release_here
from multibot_rewrite.base.wording import plural
from multibot_rewrite.cli.output import deliver
from multibot_rewrite.cli.process import DONE
from multibot_rewrite.cli.tables import JSON, Grid, deliver_report, json_bytes
from multibot_rewrite.description.sources.packages import MANIFEST, package_of
from multibot_rewrite.knowledge.conditions import said
from multibot_rewrite.producers.launch.source_packages import packages_for
from multibot_rewrite.producers.sources.facts import NodeSource, node_of_program


def is_program(word: str) -> bool:
    """Is it a program of a package that is here, or a class of one?"""
    folder, name = os.path.split(word)
    named = bool(folder and name) and not os.path.lexists(word)
    return named and os.path.isfile(os.path.join(folder, MANIFEST))


def run(options: argparse.Namespace, word: str) -> int:
    """Read the source of a program; returns the exit code. Raises UsageError where there is none."""
    folder, program = os.path.split(os.path.abspath(word))
    name, _ = package_of(os.path.join(folder, MANIFEST)) or ("", "")
    packages = packages_for(os.path.join(folder, MANIFEST), ())
    found = node_of_program(folder, name, program, packages, release_here(options.distro))
    if found is None:
        hint = "name what its setup.py or CMakeLists.txt installs, or the class of a component"
        raise UsageError(
            f"{word}: package {name!r} has no program {program!r} whose source is here; {hint}"
        )
    if options.form == JSON:
        deliver(options, json_bytes({"nodes": [_as_json(found)]}))
    else:
        deliver_report(options, _details(found, folder))
    return DONE


def _details(found: NodeSource, folder: str) -> Iterator[str | Grid]:
    facts = found.facts
    yield f"node {facts.name} of {facts.package}, by {plural(len(found.files), 'file')} of its source"
    own = [
        (it.role, it.name, it.type, it.parameter, said(it.when), _near(it.source[0], folder))
        for it in facts.endpoints
    ]
    if own:
        yield ""
        yield Grid(("role", "name", "type", "parameter", "only if", "source"), own)
    if found.params:
        yield ""
        rows = [(it.path, it.default, it.kind, _near(it.source[0], folder)) for it in found.params]
        yield Grid(("parameter", "default", "holds", "source"), rows)
    if found.frames:
        yield ""
        named = [(frame, what, _near(f"{at}", folder)) for what, frame, at in found.frames]
        yield Grid(("frame in the code", "as", "source"), named)
    for it in facts.untold:
        yield f"not known: {_near(it.text, folder)}"


def _near(text: str, folder: str) -> str:
    """A place as it is below the package."""
    return text.replace(os.path.join(os.path.realpath(folder), ""), "")


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
                "source": it.source[0],
            }
            for it in facts.endpoints
        ],
        "parameters": [
            {"name": it.path, "default": it.default, "holds": it.kind, "source": it.source[0]}
            for it in found.params
        ],
        "frames": [
            {"as": what, "frame": frame, "source": f"{at}"} for what, frame, at in found.frames
        ],
        "sends": [[frames[it.parent], frames[it.child]] for it in facts.sends],
        "not_known": [it.text for it in facts.untold],
        "files": list(found.files),
    }
