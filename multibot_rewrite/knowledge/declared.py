"""The parameters that packages and plugins of Nav2 declare, as ``declared.schema`` has them.

It is made by ``python -m tools.interfaces.declared_table``; its first lines have its grammar.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping
from functools import lru_cache

from multibot_rewrite.base.bounded import read_text
from multibot_rewrite.base.record import NamedTuple

FILE = os.path.join(os.path.dirname(__file__), "declared.schema")
# How a source comes to a parameter: by a file of generate_parameter_library, in code, never declared.
YAML, DECLARED, READ = "yaml", "declared", "read"
ANY, CHECKS, RELEASES = "any", " ! ", "releases="
_WILD = re.compile(r"<[^>]*>")
# A name that is put together at run time says nothing.
_EVERY = re.compile(r"(?:<[^>]*>\.?)*")
_CHECK = re.compile(r"([\w:]+?)\((.*?)\)(?=\s[\w:]+\(|$)")


class Declared(NamedTuple):
    """A parameter as its package declares it: ``type`` is empty where it is not known, ``bounds`` are
    checks of generate_parameter_library, for those found there."""

    path: str
    type: str
    bounds: str
    releases: str
    how: str
    source: str

    @property
    def pattern(self) -> re.Pattern[str]:
        """What matches its names."""
        return _pattern(self.path)

    @property
    def checks(self) -> tuple[tuple[str, str], ...]:
        """Each of its checks with its arguments."""
        return tuple((it[1], it[2]) for it in _CHECK.finditer(self.bounds))


@lru_cache(maxsize=8192)
def _pattern(path: str) -> re.Pattern[str]:
    return re.compile(".+".join(map(re.escape, _WILD.split(path))))


@lru_cache(maxsize=512)
def declared_by(owner: str) -> tuple[Declared, ...]:
    """What a package or the class of a plugin declares; nothing for one that is not known."""
    text = _sections().get(owner, "")
    return tuple(it for it in _rows(text) if says_something(it.path)) if text else ()


def is_known(owner: str) -> bool:
    """Is there a section of that name?"""
    return owner in _sections()


def says_something(path: str) -> bool:
    """Has a path a word of its own?"""
    return _EVERY.fullmatch(path) is None


@lru_cache
def _sections() -> Mapping[str, str]:
    """The text of every section by its name; nothing is read of it yet."""
    _, *parts = read_text(FILE).split("\n[")
    return {part[: part.index("]")]: part for part in parts}


def _rows(section: str) -> Iterator[Declared]:
    head, *lines = section.splitlines()
    repository, tag, *folder = head.partition("] ")[2].split()
    for line in filter(None, lines):
        words, _, bounds = line.partition(CHECKS)
        path, type_, place, *more = words.split()
        releases, how, version = "", DECLARED, tag
        for word in more:
            if word.startswith(RELEASES):
                releases = word.removeprefix(RELEASES)
            elif word in (YAML, READ):
                how = word
            else:
                version = word
        source = f"{repository}@{version} {'/'.join((*folder, place))}"
        yield Declared(path, "" if type_ == ANY else type_, bounds, releases, how, source)
