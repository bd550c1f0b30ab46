"""A file beside a description, with the names that its package's descriptions declare."""

from __future__ import annotations

from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.formats import read_named
from multibot_rewrite.companions.kinds import MOVEIT
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.companions.names.rename_map import KINDS, CompanionNames
from multibot_rewrite.companions.yaml_text import YamlText
from multibot_rewrite.description.rewriters.forms import Declared
from multibot_rewrite.lint.beside.robots import robots_of
from multibot_rewrite.rules.settings import Settings
from multibot_rewrite.rules.subject import Robots

_AS_WRITTEN = make_naming("tf-per-robot")
# Kinds of names for which a file's robots have to be known.
_DECLARED = frozenset(KINDS)


def named_in_package(kind: str, document: YamlText, settings: Settings) -> NamedFile | None:
    """The file as rules ask it; None where its reader rejects it, which is told where it is built."""
    try:
        file = read_named(kind, document, _context({}, settings))
        looked = file.others or any(it.kind in _DECLARED for it in file.names)
        robots = robots_of(document.file, settings) if looked else None
        context = _context(robots.declared if robots else {}, settings)
        # Whether a key of MoveIt is a name rests on what is declared.
        file = read_named(kind, document, context) if kind == MOVEIT else file
    except InputError:
        return None
    return file._replace(
        context=context,
        memo={Robots: robots},
        is_certain=False,
        is_whole=robots is not None and robots.is_whole,
        robots=frozenset(settings.robots),
        roots=settings.roots,
    )


def _context(declared: Declared, settings: Settings) -> Context:
    every = {it: declared.get(it, {}) for kinds in KINDS.values() for it in kinds}
    names = CompanionNames(every, _AS_WRITTEN, "")
    return Context(names, names, {}, settings.distro)
