"""A file beside a description as a list of names: what each is, where it is, what is known of it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import yaml

from multibot_rewrite.base.record import NamedTuple

if TYPE_CHECKING:
    from multibot_rewrite.companions.context import Context
    from multibot_rewrite.companions.params.name_sites import Page
    from multibot_rewrite.companions.rviz.read_config import RvizItem
    from multibot_rewrite.companions.yaml_text import YamlText
    from multibot_rewrite.knowledge.parameters import KnownNodes

# The name of a section of parameters, which is that of a node.
SECTION = "section"
# What Gazebo calls a topic.
GZ_TOPIC = "gz topic"


class Site(NamedTuple):
    """A text in a file: its kind (empty where its use is not known), the name as it is for one robot,
    what it stands at, and its place.

    ``is_sure`` is false for a kind that is only guessed; ``in_key`` is true for a name in a key.
    ``together`` is the same for names of one list. ``bare`` says that the reader takes a slash in
    front off; ``own`` that the node makes the name itself.
    """

    kind: str
    text: str
    key: str
    line: int
    column: int
    is_sure: bool = True
    in_key: bool = False
    together: int = 0
    bare: bool = False
    own: bool = False


class NamedFile(NamedTuple):
    """A file beside a description, as rules ask it.

    ``names`` are those of known kinds, ``others`` the texts of unknown use, ``twice`` the keys that
    are repeated in one map. ``context`` has what is declared: by the robot that the file is for where
    that ``is_certain``, else by any of a package, ``is_whole`` if all of these could be read.
    ``sent`` are frames that nodes send, ``robots`` the words that stand for robots. ``own`` stand for
    the one robot that a file is for. ``pages`` are the sections of a parameter file, ``known``
    the nodes that it may be for, ``shown`` the displays of RViz. ``roots`` are folders with packages,
    ``memo`` is what rules have found out of it.
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
    sent: frozenset[str] = frozenset()
    robots: frozenset[str] = frozenset()
    roots: tuple[str, ...] = ()

    @property
    def declared(self) -> Mapping[str, Mapping[str, object]]:
        """The names that the description declares, by kind; raises nothing."""
        return self.context.names.declared


def site_at(node: yaml.Node, kind: str, text: str, key: str = "", in_key: bool = False) -> Site:
    """The site of a node of YAML."""
    mark = node.start_mark
    return Site(kind, text, key, mark.line + 1, mark.column + 1, in_key=in_key)
