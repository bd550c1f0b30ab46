# SPDX-License-Identifier: Apache-2.0
"""The page of known parameters."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.knowledge.node_entries import PREFIX_KINDS, has_default
from multibot_rewrite.knowledge.parameters import KnownNodes, built_in_nodes
from multibot_rewrite.knowledge.records import NodeParameters, Param

HEAD = """\
# Known parameters

What nodes of public packages have in their parameter files that holds a name. How files are
rewritten, and how a node of your own is described: [parameter files](related-files.md).

| node | parameters that hold names | inserted where absent |
|---|---|---|
"""


def page() -> str:
    """Return the page, a row for each node that has names in its parameters."""
    return HEAD + "".join(_rows(built_in_nodes(NEWEST_LTS)))


def _rows(known: KnownNodes) -> Iterator[str]:
    for node in sorted(known.nodes.values(), key=lambda it: it.name):
        names = [it for it in node.params.values() if it.kind != "keep"]
        if names:
            yield f"| {_title(node)} | {_listed(names)} | {_inserted(node)} |\n"


def _title(node: NodeParameters) -> str:
    also = f"<br>also {', '.join(f'`{it}`' for it in node.aliases)}" if node.aliases else ""
    return f"`{node.name}` ({node.package}){also}"


def _listed(params: list[Param]) -> str:
    kinds = dict.fromkeys(it.kind for it in params)
    groups = (
        f"{kind}: " + ", ".join(f"`{it.path}`" for it in params if it.kind == kind)
        for kind in kinds
    )
    return "; ".join(groups)


def _inserted(node: NodeParameters) -> str:
    kinds = ("frame", "link", "stem", "off", "interface", *PREFIX_KINDS)
    found = (it for it in node.params.values() if it.kind in kinds and has_default(it))
    return ", ".join(f"`{it.path}`{it.releases and f' (in {it.releases})'}" for it in found)
