# SPDX-License-Identifier: Apache-2.0
"""What packages and plugins of Nav2 declare, as tables: one in each ``.schema`` file.

``declared.schema`` has the parameters, ``demanded.schema`` what they demand of the values,
``plugin_classes.schema`` the classes that pluginlib finds. The first one is made by ``python -m
tools.interfaces.declared_table``; its first lines have the grammar."""

import os
import re
from collections.abc import Iterator, Mapping
from functools import cache, lru_cache
from typing import NamedTuple

from multibot_rewrite.base.bounded import own_text

FILE = os.path.join(os.path.dirname(__file__), "declared.schema")
# How a source comes to a parameter: by a file of generate_parameter_library, in code, never declared;
# or what its code demands of the value.
YAML, DECLARED, READ, DEMANDED = "yaml", "declared", "read", "demanded"
EVERY_NODE = "*"
ANY, CHECKS, RELEASES = "any", " ! ", "releases="
_WILD = re.compile(r"<[^<>]*>")
# A name that is put together at run time says nothing.
_EVERY = re.compile(r"(?:<[^<>]*>\.?)*")
_BETWEEN_CHECKS = re.compile(r"(?<=\))\s(?=[\w:]+\()")


class Declared(NamedTuple):
    """A parameter as its package declares it; ``bounds`` are checks of generate_parameter_library."""

    path: str
    type: str
    bounds: str
    releases: str
    how: str
    source: str

    def has_name(self, name: str) -> bool:
        """Return whether a name matches the path, with any text for each word in brackets."""
        if "<" not in self.path:
            return name == self.path
        # A pattern takes longer to compile than most paths to refuse.
        one = len(_fixed_parts(self.path)) == 2
        return _may_be(self.path, name) if one else _fillings(self.path, name) is not None

    @property
    def checks(self) -> tuple[tuple[str, str], ...]:
        """The names of its checks, each with the text of its arguments."""
        return checks_in(self.bounds)


def checks_in(bounds: str) -> tuple[tuple[str, str], ...]:
    """Return the name of each check in a text, with the text of its arguments."""
    if ")" not in bounds:
        return ()
    checks = (it.partition("(") for it in _BETWEEN_CHECKS.split(bounds) if it.endswith(")"))
    return tuple((name, arguments[:-1]) for name, _, arguments in checks)


@lru_cache(maxsize=8192)
def _fixed_parts(path: str) -> list[str]:
    """Return the parts of a path between its words in brackets."""
    return _WILD.split(path)


def _may_be(path: str, name: str) -> bool:
    """Return whether a name begins and ends as a path with words in brackets does."""
    pieces = _fixed_parts(path)
    head, tail = pieces[0], pieces[-1]
    return name.startswith(head) and name.endswith(tail) and len(head) + len(tail) < len(name)


def _fillings(path: str, name: str) -> list[str] | None:
    """Return what a name has for each word in brackets of a path, the first longest; or None."""
    if not _may_be(path, name):
        return None
    first, *middle, last = _fixed_parts(path)
    end, found = len(name) - len(last), []
    # From the end on, each piece where it comes last, with a character at least behind it.
    for piece in reversed(middle):
        at = name.rfind(piece, len(first) + 1, end - 1)
        if at < 0:
            return None
        found.append(name[at + len(piece) : end])
        end = at
    return [name[len(first) : end], *reversed(found)] if end > len(first) else None


@lru_cache(maxsize=512)
def declared_by(owner: str) -> tuple[Declared, ...]:
    """Return what a package or the class of a plugin declares and demands; empty for an unknown one."""
    every = _parameters_of(_sections("declared.schema").get(owner, ""))
    declared = [it for it in every if says_something(it.path)]
    demanded = _parameters_of(_sections("demanded.schema").get(owner, ""))
    return (*declared, *(it._replace(how=DEMANDED) for it in demanded))


def is_known(owner: str) -> bool:
    """Return whether the parameters of a package or plugin class are known."""
    return owner in _sections("declared.schema")


def stands_for(path: str, name: str) -> dict[str, str]:
    """Return by each word in brackets what a name of the path has there: ``<id>`` -> ``odom0``."""
    return dict(zip(_WILD.findall(path), _fillings(path, name) or (), strict=False))


def says_something(path: str) -> bool:
    """Return whether a path has more than words in brackets, so that not every name matches."""
    return _EVERY.fullmatch(path) is None


@lru_cache
def _sections(name: str) -> Mapping[str, str]:
    """Return the unparsed text of every section by its name."""
    _, *parts = own_text(__file__, name).split("\n[")
    return {part[: part.index("]")]: part for part in parts}


def _parameters_of(section: str) -> Iterator[Declared]:
    if not section:
        return
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


_NOW = "->"
# Where an older name of ROS 2 is from: Nav2's own migration guides.
_ENDED = "docs.nav2.org"
NODE = "node"


class Base(NamedTuple):
    """The classes of a base with the words of their releases, and older names with those of now.

    ``ended`` are those of the older names that a release of ROS 2 before Humble had.
    """

    classes: Mapping[str, str]
    older: Mapping[str, str]
    ended: frozenset[str]


@cache
def plugin_bases() -> Mapping[str, Base]:
    """Return the plugin classes known for each base class."""
    _, *parts = own_text(__file__, "plugin_classes.schema").split("\n[")
    return {part[: part.index("]")]: _base_of(part) for part in parts}


def _base_of(section: str) -> Base:
    rows = [line.split() for line in section.splitlines()[1:] if line]
    older = {old: new for old, sign, new, *_ in rows if sign == _NOW}
    ended = frozenset(it[0] for it in rows if it[1] == _NOW and _ENDED in it[3])
    return Base({name: _releases_of(word) for name, word, *_ in rows if word != _NOW}, older, ended)


def _releases_of(word: str) -> str:
    """Return the release words in a column; empty for another text."""
    return word.removeprefix(RELEASES) if word.startswith(RELEASES) else ""


@cache
def packages() -> frozenset[str]:
    """Return the packages of which all classes are known."""
    known = (it for base in plugin_bases().values() for it in base.classes)
    return frozenset(canonical(it).partition("::")[0] for it in known)


def canonical(name: str) -> str:
    """Return a class with its scopes written alike: older plugin descriptions have a slash."""
    return name.strip().replace("/", "::")
