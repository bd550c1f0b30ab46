# SPDX-License-Identifier: Apache-2.0
"""What sources say of a node -> its NoDL document.

What depends on a plugin, a mode or a parameter has the condition as its description; names that are
known at run time only have no form in NoDL and are named as left out.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.knowledge.nodl.writing import UNKNOWN_QOS, NodlFile, document_of
from multibot_rewrite.knowledge.records import Endpoint
from multibot_rewrite.system.records import (
    ACTION,
    CALLS,
    PUBLISHES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
)
from tools.interfaces.table import Fact

# What has no "/action/" in its type is a topic or a service.
KIND = {PUBLISHES: TOPIC, SUBSCRIBES: TOPIC, SERVES: SERVICE, CALLS: SERVICE}


def nodl_of(node: str, facts: Iterable[Fact]) -> NodlFile:
    """Return the document of a node; raises UsageError for a node that the sources do not have."""
    own = [it for it in facts if it.node == node]
    if not own:
        raise UsageError(f"{node}: these sources have no such node; name one of the printed table")
    place = own[0].place
    description = f"Read from the sources of {place.repository} {place.version}"
    return document_of(node, description, _endpoints(own), lambda it: dict(UNKNOWN_QOS))


def _endpoints(facts: Iterable[Fact]) -> Iterator[Endpoint]:
    """Each name and type once."""
    seen = set()
    for it in facts:
        if (it.role, it.name, it.type) in seen:
            continue
        seen.add((it.role, it.name, it.type))
        kind = ACTION if "/action/" in it.type else KIND[it.role]
        note = f"only if: {it.condition}" if it.condition else ""
        yield Endpoint(kind, it.role, it.name, it.type, note=note)
