# SPDX-License-Identifier: Apache-2.0
"""A related file of a description -> what the rules for its kind find."""

from __future__ import annotations

import os
from collections.abc import Iterator

from multibot_rewrite.base.file_kinds import refuse_others
from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.findings.selection import is_on, level_of
from multibot_rewrite.base.model import Claim, InputError
from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.description.rewriters.forms import Declared
from multibot_rewrite.description.sources.packages import entries, package_of
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.lint.files.named import descriptions_below, robot_name
from multibot_rewrite.lint.files.pairing import described
from multibot_rewrite.lint.files.subjects import make_subject
from multibot_rewrite.related_files.context import Context
from multibot_rewrite.related_files.formats import read_named
from multibot_rewrite.related_files.named_file import MOVEIT, NamedFile, kind_of
from multibot_rewrite.related_files.names.rename_map import KINDS, RelatedNames
from multibot_rewrite.rules.files.judge import judged, rules_for
from multibot_rewrite.rules.settings import Settings
from multibot_rewrite.rules.subject import NO_ROBOTS, Robots, Subject

# How many descriptions are read.
_TRIED = 6
_KINDS = ("link", "frame", "joint", "sensor", "gpio", "hardware")
_AS_WRITTEN = make_naming("tf-per-robot")
# Kinds of names for which a file's robots have to be known.
_DECLARED = frozenset(KINDS)


def robots_of(file: str, settings: Settings) -> Robots:
    """Return the description that was named, otherwise those that the file may belong to.

    These are those of its package, otherwise of description packages next to it, otherwise those
    that are linted with it."""
    own = package_of(file)
    folder = own[1] if own else os.path.dirname(os.path.abspath(file))
    paths = [settings.urdf] if settings.urdf else _robot_descriptions(folder)
    if not paths and own:
        above = os.path.dirname(folder)
        others = sorted(it for it in entries(above) if it.endswith("_description"))
        paths = [path for it in others for path in _robot_descriptions(os.path.join(above, it))]
    paths = paths or [path for _, path in settings.urdfs]
    if not paths:
        return NO_ROBOTS
    found: dict[str, dict[str, Claim]] = {kind: {} for kind in _KINDS}
    subjects: list[Subject] = []
    for path in paths[:_TRIED]:
        try:
            data, name = described(path, settings)
            subjects.append(make_subject(read_document(data, name), settings))
        except InputError:  # it is told where it is linted
            continue
        for kind in _KINDS:
            found[kind] |= subjects[-1].inventory.declared.get(kind, {})
    return Robots(found, tuple(subjects), len(subjects) == len(paths))


def _robot_descriptions(folder: str) -> list[str]:
    """Return the files below a folder with a named robot: others are parts of these."""
    return [path for path in descriptions_below(folder) if robot_name(path)]


def named_in_package(kind: str, data: bytes, path: str, settings: Settings) -> NamedFile:
    """Return the file as rules ask it; raises InputError for one that its reader rejects."""
    file = read_named(kind, data, path, context_of({}, settings))
    looked = file.others or any(it.kind in _DECLARED for it in file.names)
    robots = robots_of(path, settings) if looked else None
    context = context_of(robots.declared if robots else {}, settings)
    # Whether a key of MoveIt is a name rests on what is declared.
    file = read_named(kind, data, path, context) if kind == MOVEIT else file
    return file._replace(
        context=context,
        memo={Robots: robots},
        is_certain=bool(settings.urdf),
        is_whole=robots is not None and robots.is_whole,
        robots=frozenset(settings.robots),
        roots=settings.roots,
    )


def context_of(declared: Declared, settings: Settings) -> Context:
    """Return the context in which a file is read: the declared names, renamed if robots are given."""
    every = {it: declared.get(it, {}) for kinds in KINDS.values() for it in kinds}
    naming = settings.naming if settings.robots else _AS_WRITTEN
    names = RelatedNames(every, naming, "")
    return Context(names, names, {}, settings.distro)


def related_file_findings(path: str, data: bytes, settings: Settings) -> Iterator[Finding]:
    """Yield what the active rules find in a file; raises InputError for one of no known kind."""
    kind = kind_of(data)
    if not kind:
        refuse_others(data, f"{path}:1:1")
        hint = (
            "name a description, or a file of parameters, RViz, MoveIt, ros_gz_bridge, Nav2 or Lua"
        )
        raise InputError(f"{path}:1:1: it is none of the files that are linted; {hint}")
    file = named_in_package(kind, data, path, settings)
    active = [it for it in rules_for(kind) if is_on(settings, it.code)]
    for it in judged(file, active):
        yield it._replace(level=level_of(settings, it.code, it.level))
