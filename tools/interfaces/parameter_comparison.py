# SPDX-License-Identifier: Apache-2.0
"""Compare our table of parameters with what the sources say.

Three kinds of difference: ``missing`` (a parameter of ours is in no source of a release that it is
claimed for), ``default`` (the sources have another one), ``unknown`` (a parameter of the sources looks
like a name and is not in our table).
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import lru_cache
from typing import NamedTuple

from multibot_rewrite.base.releases import has_release
from multibot_rewrite.knowledge.declared import YAML
from multibot_rewrite.knowledge.records import NodeParameters
from multibot_rewrite.rules.files.parameter_files import EMPTY, NO_DEFAULT
from tools.interfaces.parameter_facts import ParameterFact

ID = "<id>"
# What a node puts before the names of a YAML file's parameters.
_PREFIX = "<prefix>"
MISSING, DEFAULT, UNKNOWN = "missing", "default", "unknown"
_STRINGS = ("string", "string_array", "")
_WORDS = re.compile(
    r"(frame|topic|joint|link|node|interface|service|sensor|gpio|batterie)s?|namespace|ns|group|prefix|dof"
)
_FRAME = re.compile(r"odom|map|world|base_\w+")
_PATH = re.compile(r"[/~]?\w+(/\w+)+|/\w+")
# A segment of ours -> what it may be in a source.
_SEGMENTS = {"*": r".+", "<>": r"(?:<\w+>|\w+)", "<index>": r"(?:<id>|\d+)"}


# Package -> what stands before its parameters' names on the node.
Below = Mapping[str, str]


class OurParameter(NamedTuple):
    """A parameter of a known node; ``packages`` are those whose sources may have it."""

    node: str
    packages: tuple[str, ...]
    path: str
    kind: str
    default: str
    releases: str


class Difference(NamedTuple):
    """``subject`` is our node, or the source's package for what we do not have."""

    kind: str
    subject: str
    path: str
    release: str
    words: str

    @property
    def key(self) -> tuple[str, str, str]:
        """What exceptions are listed by."""
        return self.kind, self.subject, self.path


def our_parameters(nodes: Iterable[NodeParameters]) -> tuple[OurParameter, ...]:
    """Return the known parameters; one with several forms has a row for each."""
    return tuple(
        OurParameter(
            node.name,
            (node.package, *node.declared_in),
            it.path,
            it.kind,
            it.default,
            it.releases or node.releases,
        )
        for node in nodes
        for it in node.forms
    )


def differences(
    ours: Iterable[OurParameter], facts: Sequence[ParameterFact], release: str, below: Below
) -> Iterator[Difference]:
    """Where the table and the sources of a release differ."""
    ours = tuple(ours)
    by_package: dict[str, dict[str, list[ParameterFact]]] = {}
    for fact in facts:
        for path in _full(fact, below):
            by_package.setdefault(fact.package, {}).setdefault(path, []).append(fact)
    for row in ours:
        there = [by_package[it] for it in row.packages if it in by_package]
        if row.packages[0] in by_package and row.kind != "keep":
            yield from _of_row(row, there, release)
    claimed = _claimed(ours)
    for package, paths in by_package.items():
        yield from _unknown(package, paths, claimed.get(package, ()), release)


def _full(fact: ParameterFact, below: Below) -> tuple[str, ...]:
    """Return the paths on the node that it may have. In some packages the first ``<id>`` is a fixed
    word, or is left out; what a YAML file has may be below a prefix."""
    above = below.get(fact.package, "")
    if not above or fact.path.startswith(f"{above}."):
        return (fact.path, f"{_PREFIX}.{fact.path}") if fact.how == YAML else (fact.path,)
    return (f"{above}.{fact.path.removeprefix(f'{ID}.')}",)


def _of_row(
    row: OurParameter, there: Sequence[Mapping[str, list[ParameterFact]]], release: str
) -> Iterator[Difference]:
    found = [
        fact for paths in there for path, it in paths.items() if same(row.path, path) for fact in it
    ]
    if not has_release(row.releases, release):
        return
    if not found:
        yield Difference(MISSING, row.node, row.path, release, "no source of the release has it")
        return
    defaults = {EMPTY if it.default == "[]" else it.default for it in found}
    if _default(row) not in defaults and defaults - {NO_DEFAULT}:
        words = f"{_default(row)} here, {', '.join(sorted(defaults - {NO_DEFAULT}))} in the sources"
        yield Difference(DEFAULT, row.node, row.path, release, words)


def _default(row: OurParameter) -> str:
    return row.default or EMPTY


def same(ours: str, theirs: str) -> bool:
    """May both paths be one parameter? ``<id>`` of a source may stand for several segments."""
    if pattern(ours).fullmatch(theirs):
        return True
    if ID not in theirs:
        return False
    words = (re.escape(it) for it in theirs.split(ID))
    return bool(re.fullmatch(r"[\w<>.]+".join(words), ours))


@lru_cache(4096)
def pattern(path: str) -> re.Pattern[str]:
    """Return an expression for the paths of sources that a path of ours stands for."""
    words = re.split(r"(<index>|<\w+>|\*)", path)
    texts = (
        _SEGMENTS.get(it if it in _SEGMENTS else "<>", "")
        if it[:1] in ("<", "*")
        else re.escape(it)
        for it in words
    )
    return re.compile("".join(texts))


def _claimed(ours: Iterable[OurParameter]) -> dict[str, list[str]]:
    found: dict[str, list[str]] = {}
    for row in ours:
        for package in row.packages:
            found.setdefault(package, []).append(row.path)
    return found


def _unknown(
    package: str,
    paths: Mapping[str, list[ParameterFact]],
    claimed: Sequence[str],
    release: str,
) -> Iterator[Difference]:
    known = {
        fact for path, it in paths.items() for fact in it if any(same(own, path) for own in claimed)
    }
    for path, found in paths.items():
        fact = next((it for it in found if looks_like_a_name(it) and it not in known), None)
        if fact and not (fact.how == YAML and path.startswith(f"{_PREFIX}.")):
            words = f"{fact.type or 'untyped'} {fact.default} in {fact.place.path}".replace(
                "  ", " "
            )
            yield Difference(UNKNOWN, package, path, release, words)


def looks_like_a_name(fact: ParameterFact) -> bool:
    """Return whether the name or default of a text suggests a frame, topic, joint, link,
    node, namespace or interface."""
    if fact.type not in _STRINGS or not fact.package:
        return False
    words = re.split(r"[._]", fact.path)
    if any(_WORDS.fullmatch(it) for it in (words if fact.type else words[-1:])):
        return True
    return bool(_FRAME.fullmatch(fact.default) or _PATH.fullmatch(fact.default))
