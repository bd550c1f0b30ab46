"""A MoveIt file as rules ask it: its names, and the texts of unknown use."""

from __future__ import annotations

import re
from collections.abc import Iterator

from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.kinds import MOVEIT
from multibot_rewrite.companions.moveit.file_kind import find_kind
from multibot_rewrite.companions.moveit.name_sites import MoveitName, MoveitNames, find_names
from multibot_rewrite.companions.sites import NamedFile, Site, site_at
from multibot_rewrite.companions.yaml_text import YamlText, is_text

_EVALUATOR = re.compile(r"\s*(joint|link)s?\s*\(([^()]*)\)\s*")


def read_moveit(document: YamlText, context: Context) -> NamedFile:
    """The names of a file; raises InputError for one that is not MoveIt's."""
    kind = find_kind(document)
    return named(
        document, context, find_names(document.root, kind.names if kind else {}, context.names)
    )


def named(document: YamlText, context: Context, found: MoveitNames) -> NamedFile:
    """What was found in a file."""
    names = tuple(site for it in found.names for site in _sites(it))
    others = tuple(site_at(it, "", str(it.value)) for it in found.unclaimed if is_text(it))
    twice = tuple(site_at(it, "", str(it.value)) for it in found.twice)
    return NamedFile(
        MOVEIT, document.file, document.text, context, {}, names, others, twice, document
    )


def _sites(it: MoveitName) -> Iterator[Site]:
    """The names that the description must declare: those in ``joints(a, b)``, else the text."""
    found = _EVALUATOR.fullmatch(it.text) if it.word == "words" else None
    names = [(found[1], name.strip()) for name in found[2].split(",")] if found else []
    for kind, text in names or [(it.word, it.text)]:
        yield site_at(it.scalar, kind, text)
