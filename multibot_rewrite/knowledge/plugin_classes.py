# SPDX-License-Identifier: Apache-2.0
"""The classes that pluginlib finds in public packages, as ``plugin_classes.schema`` has them."""

from __future__ import annotations

import os
from collections.abc import Mapping
from functools import cache

from multibot_rewrite.base.bounded import read_text
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.knowledge.declared import RELEASES

_FILE = os.path.join(os.path.dirname(__file__), "plugin_classes.schema")
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
    """Every base by its name."""
    _, *parts = read_text(_FILE).split("\n[")
    return {part[: part.index("]")]: _base(part) for part in parts}


def _base(section: str) -> Base:
    rows = [line.split() for line in section.splitlines()[1:] if line]
    older = {old: new for old, sign, new, *_ in rows if sign == _NOW}
    ended = frozenset(it[0] for it in rows if it[1] == _NOW and _ENDED in it[3])
    return Base({name: _releases(word) for name, word, *_ in rows if word != _NOW}, older, ended)


def _releases(word: str) -> str:
    return word.removeprefix(RELEASES) if word.startswith(RELEASES) else ""


@cache
def packages() -> frozenset[str]:
    """The packages of which all classes are known."""
    known = (it for base in plugin_bases().values() for it in base.classes)
    return frozenset(canonical(it).partition("::")[0] for it in known)


def canonical(name: str) -> str:
    """A class with its scopes written alike: older plugin descriptions have a slash."""
    return name.strip().replace("/", "::")
