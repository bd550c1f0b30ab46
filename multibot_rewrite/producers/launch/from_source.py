# SPDX-License-Identifier: Apache-2.0
"""What a launch starts and no table knows -> what its source says, where that is here."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from contextlib import suppress

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.producers.launch.known_node import known_node
from multibot_rewrite.producers.launch.of_robot import passes
from multibot_rewrite.producers.launch.records import LaunchedNode, LaunchOrder
from multibot_rewrite.producers.launch.source_packages import packages_for
from multibot_rewrite.producers.sources.facts import node_of_program


def with_sources(
    known: Mapping[str, NodeFacts],
    nodes: Iterable[LaunchedNode],
    orders: Iterable[LaunchOrder],
    release: str,
) -> dict[str, NodeFacts]:
    """The known nodes and, by ``package program``, those of launched ``nodes`` that are not among them
    and whose source is found: below the roots of the ``orders``, or beside their launch files. Raises
    nothing."""
    wanted = {(it.package, it.executable): it for it in nodes if not passes(it)}
    unknown = [it for it in wanted.values() if known_node(it, (), known) is None]
    if not unknown:
        return dict(known)
    folders: dict[str, str] = {}
    for order in orders:
        folders = {**packages_for(order.file, order.roots), **folders}
    found = {f"{it.package} {it.executable}": _read(it, folders, release) for it in unknown}
    return {**known, **{name: it for name, it in found.items() if it is not None}}


def _read(it: LaunchedNode, folders: Mapping[str, str], release: str) -> NodeFacts | None:
    found = None
    if it.package in folders:
        with suppress(
            UsageError
        ):  # C++ without its reader: who says that a node is not known, says so
            found = node_of_program(
                folders[it.package], it.package, it.executable, folders, release
            )
    return found.facts._replace(known=f"{it.package} {it.executable}") if found else None
