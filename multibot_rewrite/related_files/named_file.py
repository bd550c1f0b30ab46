# SPDX-License-Identifier: Apache-2.0
"""A related file: its kind, which its text tells, and its names as a list."""

from collections.abc import Collection, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from multibot_rewrite.base.bounded import MAX_BYTES, read_start
from multibot_rewrite.base.file_kinds import BESIDE, BRIDGE, LUA, MOVEIT, PARAMS, RVIZ, TREE

if TYPE_CHECKING:
    from multibot_rewrite.base.findings.finding import Finding
    from multibot_rewrite.knowledge.parameters import KnownNodes
    from multibot_rewrite.related_files.context import Context, FileTemplate
    from multibot_rewrite.related_files.params.name_sites import Page
    from multibot_rewrite.related_files.rviz.read_config import RvizItem
    from multibot_rewrite.related_files.sites import Site
    from multibot_rewrite.related_files.yaml_text import YamlText

__all__ = ["BRIDGE", "EVERY", "LUA", "MOVEIT", "PARAMS", "RVIZ", "SUFFIXES", "TREE"]

SUFFIXES = (".yaml", ".yml", ".rviz", ".lua", ".xml")
EVERY = (PARAMS, RVIZ, MOVEIT, BRIDGE, TREE, LUA)
_XML = ".xml"
_IS_TREE = dict(BESIDE)[TREE]


def has_related_name(path: str) -> bool:
    """Return whether a file has a name that only related files have."""
    return path.lower().endswith(SUFFIXES) and not path.lower().endswith(_XML)


def is_related_file(source: object) -> bool:
    """Return whether a source is a related file's path or text (a tree in XML), no description's."""
    if isinstance(source, bytes):
        start = source.lstrip(b"\xef\xbb\xbf \t\r\n")[:1]
        return bool(_IS_TREE.search(source)) if start == b"<" else True
    path = str(source)
    if not path.lower().endswith(_XML):
        return has_related_name(path)
    return bool(_IS_TREE.search(_text_of(path) or b""))


def is_linted(path: str) -> bool:
    """Return whether a file found in a folder is linted, as are few YAML and XML files."""
    # One that cannot be read is reported.
    if path.lower().endswith(_XML):
        return is_related_file(path)
    text = _text_of(path) if is_related_file(path) else None
    return text is None or bool(kind_of(text))


def _text_of(path: str) -> bytes | None:
    try:
        return read_start(path, MAX_BYTES)
    except OSError:
        return None


def kind_of(data: bytes) -> str:
    """Return the kind of a file by its contents; empty for all others."""
    return next((kind for kind, mark in BESIDE if mark.search(data)), "")


class NamedFile(NamedTuple):
    """A related file, as rules ask it.

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
    context: "Context"
    memo: dict[object, Any]
    names: "tuple[Site, ...]" = ()
    others: "tuple[Site, ...]" = ()
    twice: "tuple[Site, ...]" = ()
    document: "YamlText | None" = None
    pages: "tuple[Page, ...]" = ()
    known: "KnownNodes | None" = None
    shown: "tuple[RvizItem, ...]" = ()
    is_certain: bool = True
    is_whole: bool = True
    is_for_one: bool = False
    sent: frozenset[str] = frozenset()
    robots: frozenset[str] = frozenset()
    own: frozenset[str] = frozenset()
    roots: tuple[str, ...] = ()
    included: "tuple[Site, ...]" = ()
    computed: "tuple[Site, ...]" = ()

    @property
    def declared(self) -> Mapping[str, Collection[str]]:
        """The names that the description declares, by kind; raises nothing."""
        return self.context.names.declared


class RelatedFile(NamedTuple):
    """A related file as a template for any robot, what was read, and what only its rewrite finds."""

    template: "FileTemplate"
    file: NamedFile
    findings: "tuple[Finding, ...]" = ()
