# SPDX-License-Identifier: Apache-2.0
"""A file beside a description as a list of names."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import TYPE_CHECKING, Any

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.companions.sites import Site
from multibot_rewrite.companions.template import FileTemplate

if TYPE_CHECKING:
    from multibot_rewrite.companions.context import Context
    from multibot_rewrite.companions.params.name_sites import Page
    from multibot_rewrite.companions.rviz.read_config import RvizItem
    from multibot_rewrite.companions.yaml_text import YamlText
    from multibot_rewrite.knowledge.parameters import KnownNodes


class NamedFile(NamedTuple):
    """A file beside a description, as rules ask it.

    ``names`` are those of known kinds, ``others`` the texts of unknown use, ``twice`` the keys that
    are repeated in one map, ``included`` the files that it includes and ``computed`` the names that are
    only made when it runs. ``context`` has what is declared: by the robot that the file is for where
    that ``is_certain``, else by any of a package, ``is_whole`` if all of these could be read.
    ``sent`` are frames that nodes send, ``robots`` the words that stand for robots. ``is_for_one`` is
    true for a file that only one of them gets. ``pages`` are the sections of a parameter file,
    ``known`` the nodes that it may be for, ``shown`` the displays of RViz. ``roots`` are folders with
    packages, ``memo`` is what rules have found out of it.
    """

    kind: str
    file: str
    text: str
    context: Context
    memo: dict[object, Any]
    names: tuple[Site, ...] = ()
    others: tuple[Site, ...] = ()
    twice: tuple[Site, ...] = ()
    document: YamlText | None = None
    pages: tuple[Page, ...] = ()
    known: KnownNodes | None = None
    shown: tuple[RvizItem, ...] = ()
    is_certain: bool = True
    is_whole: bool = True
    is_for_one: bool = False
    sent: frozenset[str] = frozenset()
    robots: frozenset[str] = frozenset()
    own: frozenset[str] = frozenset()
    roots: tuple[str, ...] = ()
    included: tuple[Site, ...] = ()
    computed: tuple[Site, ...] = ()

    @property
    def declared(self) -> Mapping[str, Collection[str]]:
        """The names that the description declares, by kind; raises nothing."""
        return self.context.names.declared


class Companion(NamedTuple):
    """A companion file as a template for any robot, what was read, and what only its rewrite finds."""

    template: FileTemplate
    file: NamedFile
    findings: tuple[Finding, ...] = ()
