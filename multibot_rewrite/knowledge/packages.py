# SPDX-License-Identifier: Apache-2.0
"""Packages of known nodes: versions by release, from ``python -m tools.interfaces.versions``."""

from collections.abc import Iterator, Mapping
from functools import cache, lru_cache
from typing import NamedTuple

from multibot_rewrite.base.bounded import own_text
from multibot_rewrite.base.releases import CAME, RELEASES

COMMENT, NONE = "#", "-"


class Versions(NamedTuple):
    """The versions of a package that a release began with and has now, and the source that was read."""

    first: str = ""
    now: str = ""
    commit: str = ""
    version: str = ""
    date: str = ""


class Package(NamedTuple):
    """A package: the repository that has it, and its versions by release."""

    repository: str
    versions: Mapping[str, Versions]


@cache
def packages() -> Mapping[str, Package]:
    """Return known packages by name, each with its repository and versions."""
    found: dict[str, Package] = {}
    rows: dict[str, Versions] = {}
    for line in own_text(__file__, "packages.schema").splitlines():
        if line.startswith("["):
            repository, _, names = line[1:].partition("] ")
            rows = {}
            found |= dict.fromkeys(names.split(), Package(repository, rows))
        elif line and not line.startswith(COMMENT):
            release, *columns = line.split()
            rows[release] = Versions(*("" if it == NONE else it for it in columns))
    return found


def number(version: str) -> tuple[int, ...]:
    """Return a version as numbers that can be compared."""
    return tuple(int(it) for it in version.split(".") if it.isdecimal())


@lru_cache(maxsize=1024)  # so many facts, so few words
def by_version(words: str) -> str:
    """Return release words, ``PACKAGE VERSION+`` as its releases (a condition where it came later)."""
    return ", ".join(it for term in words.split(",") for it in _terms_by_version(term.strip()))


def _terms_by_version(term: str) -> Iterator[str]:
    """Yield the release words that one ``PACKAGE VERSION+`` stands for."""
    name, _, since = term.removesuffix("+").partition(" ")
    if name in RELEASES or not since or name not in packages():
        yield term
        return
    for release, it in versions_of(name).items():
        if it.now and number(it.now) >= number(since):
            always = release not in CAME or (it.first and number(it.first) >= number(since))
            yield release if always else f"{release} {since}+"


def older(name: str, release: str) -> str:
    """Return a note that a package was read as an older release had it; empty if not or unknown."""
    it = versions_of(name).get(release, Versions())
    came = CAME.get(release, max(CAME.values()))
    if not it.date or it.date >= came or number(it.now)[:2] <= number(it.version)[:2]:
        return ""
    return f"{name} {it.version} of {it.date} was read, {release} has {it.now}"


def versions_of(name: str) -> Mapping[str, Versions]:
    """Return the versions of a package by release; empty for one that the table lacks."""
    return packages()[name].versions if name in packages() else {}
