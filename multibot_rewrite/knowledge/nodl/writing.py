# SPDX-License-Identifier: Apache-2.0
"""Endpoints of a node -> the text of its NoDL document, checked by reading it.

A document has no conditions and no endpoint of several types: two types are two entries.
"""

import re
from collections.abc import Callable, Iterable
from typing import NamedTuple, TypeAlias

from multibot_rewrite.base.model import ProofError, UsageError
from multibot_rewrite.knowledge.nodl.document import GROUP, SECTIONS, parse
from multibot_rewrite.knowledge.nodl.lookup import SUFFIXES
from multibot_rewrite.knowledge.records import Endpoint
from multibot_rewrite.system.records import TOPIC

DEFAULT = "SYSTEM_DEFAULT"
UNKNOWN_QOS: dict[str, object] = {"history": DEFAULT, "reliability": DEFAULT}
# What is known of the QoS of a topic.
QosOf: TypeAlias = Callable[[Endpoint], dict[str, object]]
_NAME = re.compile(r"[A-Za-z]|[/~A-Za-z][A-Za-z0-9_/]*[A-Za-z0-9_]")
_TYPE = re.compile(r"[A-Za-z][A-Za-z0-9_]*/(?:msg|srv|action)/[A-Z][A-Za-z0-9]*")


class NodlFile(NamedTuple):
    """A document: the node it is for, its text, and the endpoints that NoDL has no form for."""

    node: str
    text: str
    left_out: tuple[str, ...]


def file_name(node: str) -> str:
    """Return the file of a node below a folder; a namespace of the node is a folder there."""
    return f"{node}{SUFFIXES[0]}"


def document_of(
    node: str, description: str, ends: Iterable[Endpoint], qos_of: QosOf, json: bool = False
) -> NodlFile:
    """Return the document of a node; raises ProofError if reading it gives something else."""
    written = list(ends)
    fitting = [it for it in written if _fits(it)]
    document: dict[str, object] = {"nodl_version": 2, "description": description}
    for section, (kind, role) in SECTIONS.items():
        own = [it for it in fitting if (it.kind, it.role) == (kind, role)]
        if own:
            rows = []
            for it in own:
                row: dict[str, object] = {"name": it.name, "type": it.type}
                row |= {"qos": qos_of(it)} if it.kind == TOPIC else {}
                rows.append(row | ({"description": it.note} if it.note else {}))
            document[section] = rows
    if json:
        from json import dumps

        text = dumps(document, indent=2) + "\n"
    else:
        import yaml

        text = yaml.safe_dump(document, sort_keys=False, width=100, allow_unicode=True)
    try:
        read = parse(text, file_name(node)).endpoints
    except UsageError as error:
        raise ProofError(f"the document of {node} cannot be read back: {error}") from None
    if _names_and_types(read) != _names_and_types(fitting):
        raise ProofError(f"the document of {node} is read back differently")
    left = [f"{it.role} {it.name}" for it in written if not _fits(it)]
    return NodlFile(node, text, tuple(dict.fromkeys(left)))


def _fits(end: Endpoint) -> bool:
    """Return whether NoDL can hold an endpoint's name and type, as it cannot for an action's parts."""
    group = f"/{GROUP[end.kind]}/"
    return bool(_NAME.fullmatch(end.name) and _TYPE.fullmatch(end.type) and group in end.type)


def _names_and_types(ends: Iterable[Endpoint]) -> set[tuple[str, str, str, str]]:
    """Return (kind, role, name, type) of each end."""
    return {(it.kind, it.role, it.name, type_) for it in ends for type_ in (it.type, *it.also)}
