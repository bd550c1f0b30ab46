# SPDX-License-Identifier: Apache-2.0
"""Nav2 behavior trees for any number of robots: ports that hold services, topics and frames.

rcl remaps a name in a port like any other name of the BT navigator. ``{entry}`` is a blackboard
entry and stays; a value put into an entry is renamed like the ports of the subtrees that read it.
"""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.releases import has_release
from multibot_rewrite.companions.behavior_tree.ports import (
    character,
    is_model,
    node_name,
    port_data,
    ports_of,
)
from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.engine import with_slots
from multibot_rewrite.companions.kinds import TREE
from multibot_rewrite.companions.named_file import Companion, NamedFile
from multibot_rewrite.companions.names.by_kind import SPELLERS
from multibot_rewrite.companions.sites import Site
from multibot_rewrite.companions.yaml_text import Splice
from multibot_rewrite.description.steps.document import Document, read_document


def rewrite_behavior_tree(data: bytes, file: str, context: Context) -> Companion:
    """A behavior tree with slots for a robot.

    Raises InputError for a file that is not a behavior tree.
    """
    document = read_tree(data, file)
    # Written out even if a rule would do: rules do not reach the navigator's helper nodes.
    return with_slots(named_ports(document, context), {}, _default_splices(document, context))


def _default_splices(document: Document, context: Context) -> Iterator[Splice]:
    """Ports that are left out and whose default all robots would share: they are added."""
    for element, start in zip(document.root.iter("*"), document.starts, strict=True):
        name = node_name(element)
        for it in port_data()["defaults"] if not is_model(element) else ():
            if it["node"] != name or it["port"] in element.attrib or it["unless"] in element.attrib:
                continue
            new = SPELLERS[it["kind"]](context, it["value"])
            if has_release(it["releases"], context.distro) and new != it["value"]:
                at = character(document, start + 1 + len(str(element.tag).encode()))
                yield Splice(at, at, f' {it["port"]}="{new}"')


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
