"""A behavior tree as rules ask it: the names in its ports, and texts of unknown use."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.model import InputError
from multibot_rewrite.companions.behavior_tree.ports import port_data, ports_of
from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.kinds import TREE
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.companions.sites import Site
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
    return named_ports(read_tree(data, file), context)


def named_ports(document: Document, context: Context) -> NamedFile:
    """What was found in a tree."""
    every = list(ports_of(document))
    free = [it for element, it in every if element.tag != "include"]
    included = tuple(it for element, it in every if element.tag == "include")
    names = tuple(it for it in free if it.kind)
    others = tuple(site for it in free if not it.kind for site in _others(it))
    text = document.source.decode()
    return NamedFile(TREE, document.file, text, context, {}, names, others, included=included)


def _others(site: Site) -> Iterator[Site]:
    """What may be a name: the whole value, or the strings of a script."""
    known = port_data()
    if site.key in known["keep"]:
        return
    texts = [site.text]
    if site.key in known["scripts"]:
        texts = [it.strip() for it in site.text.replace('"', "'").split("'")[1::2]]
    yield from (site._replace(text=it) for it in texts)
