"""What a description is linted with, whoever says so: a command, a configuration file, a test."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.naming import Naming, make_naming

ALL = ("MB",)
NO_LEVELS: Mapping[str, str] = {}
TARGETS = ("usd", "mjcf")
TIME_LIMIT = 60.0


class ArgumentSet(NamedTuple):
    """xacro arguments for the files whose path matches ``pattern`` (as ``fnmatch`` does)."""

    pattern: str
    arguments: tuple[tuple[str, str], ...]

    def __str__(self) -> str:
        return " ".join(f"{name}:={value}" for name, value in self.arguments)


class Settings(NamedTuple):
    """``select`` and ``ignore`` are codes or their beginnings; the longer one wins.

    ``levels`` maps them to levels. ``per_file`` are (pattern, codes). Each of ``arguments`` is one
    more expansion of a xacro file, beside the default one. ``robots`` are who will share a system,
    spelled by ``naming``; without robots nothing is asked that hangs on them. ``targets`` are other
    formats the names must suit (``TARGETS``). ``roots`` are folders in which ``package://NAME`` is
    looked for. ``urdf`` is the description that SRDF files belong to, where it is not the one with
    the same robot name. ``included`` are xacro files that are linted through those which include
    them. ``seconds`` is what one file may take.
    """

    select: tuple[str, ...] = ALL
    ignore: tuple[str, ...] = ()
    levels: Mapping[str, str] = NO_LEVELS
    per_file: tuple[tuple[str, tuple[str, ...]], ...] = ()
    arguments: tuple[ArgumentSet, ...] = ()
    robots: tuple[str, ...] = ()
    naming: Naming = make_naming("frames-per-robot")
    vocabulary: tuple[str, ...] = ()
    targets: tuple[str, ...] = ()
    roots: tuple[str, ...] = ()
    urdf: str = ""
    included: frozenset[str] = frozenset()
    seconds: float = TIME_LIMIT


def decides(codes: Sequence[str], code: str) -> int:
    """How much of ``code`` the longest of ``codes`` that it begins with tells; -1 for none."""
    return max((len(it) for it in codes if code.startswith(it)), default=-1)


def is_on(settings: Settings, code: str) -> bool:
    """Is a rule asked at all?"""
    return decides(settings.select, code) > decides(settings.ignore, code)


def level_of(settings: Settings, code: str, default: str) -> str:
    """The level that the configuration gives a rule, the longest beginning of its code first."""
    found = [it for it in settings.levels if code.startswith(it)]
    return settings.levels[max(found, key=len)] if found else default
