"""A behavior tree as rules ask it: the names in its ports, and texts of unknown use."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from multibot_rewrite.base.model import InputError
from multibot_rewrite.companions.behavior_tree.ports import (
    GRAPH_KINDS,
    Port,
    place_of,
    port_data,
    ports_of,
)
from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.kinds import TREE
from multibot_rewrite.companions.names.placeholders import without_robot
from multibot_rewrite.companions.sites import NamedFile, Site
from multibot_rewrite.description.steps.document import Document, read_document


def read_tree(data: bytes, file: str) -> Document:
    """The document; InputError for a file that is not a behavior tree."""
    if not data.strip():
        raise InputError(f"{file}:1: the file is empty; a behavior tree starts with <root>")
    document = read_document(data, file)
    if document.root.tag != "root":
        place = f"{file}:{document.root.sourceline or 1}"
        raise InputError(f"{place}: not a behavior tree: the root is <{document.root.tag}>")
    return document


def named_tree(data: bytes, file: str, context: Context) -> NamedFile:
    """The names of a tree; raises as ``read_tree``."""
    document = read_tree(data, file)
    return named_ports(document, context, list(ports_of(document)))


def named_ports(document: Document, context: Context, ports: Iterable[Port]) -> NamedFile:
    """What was found in a tree."""
    free = [it for it in ports if it.element.tag != "include"]
    names = tuple(_site(document, it) for it in free if it.kind)
    others = tuple(site for it in free if not it.kind for site in _others(document, it))
    text = document.source.decode()
    return NamedFile(TREE, document.file, text, context, {}, names, others)


def _site(document: Document, port: Port) -> Site:
    kind = GRAPH_KINDS.get(port.kind, port.kind)
    text = without_robot(port.value, "/" if port.kind in GRAPH_KINDS else "")
    return Site(kind, text, port.attribute, *place_of(document, port))


def _others(document: Document, port: Port) -> Iterator[Site]:
    """What may be a name: the whole value, or the strings of a script."""
    known = port_data()
    if port.attribute in known["keep"]:
        return
    texts = [port.value]
    if port.attribute in known["scripts"]:
        texts = [it.strip() for it in port.value.replace('"', "'").split("'")[1::2]]
    place = place_of(document, port)
    yield from (Site("", it, port.attribute, *place) for it in texts)
