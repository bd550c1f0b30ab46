"""A description, its robots and the stacks they run -> their remap table and what to expect."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from multibot_rewrite.graph.expectation import Expectation, expect, named_frames
from multibot_rewrite.graph.transforms import Edge, Edges, edges_of, frames_of
from multibot_rewrite.library import Rewrite, rewrite_all
from multibot_rewrite.naming import Naming, make_naming
from multibot_rewrite.remap.known import stack_of
from multibot_rewrite.remap.plugins import plugin_nodes, plugin_places
from multibot_rewrite.remap.records import NodeFacts, NodeTable, Table
from multibot_rewrite.remap.stacks import built_in, user_stack
from multibot_rewrite.remap.table import build_table
from multibot_rewrite.rewriters.builtin import builtin_tree
from multibot_rewrite.rewriting.collect import Inventory, collect
from multibot_rewrite.rewriting.document import read_document
from multibot_rewrite.sources import Source

Plugins = dict[str, list[tuple[NodeFacts, NodeTable]]]
NOTHING: Mapping[str, str] = {}


class Fleet(NamedTuple):
    """A fleet's table, what each robot's rewritten description holds, and the transforms that each
    robot's nodes send. ``facts`` are of the stacks' nodes, ``sources`` where in its description
    (``file:line``) a plugin's node comes from."""

    table: Table
    inventories: dict[str, Inventory]
    naming: Naming
    edges: Edges
    facts: tuple[NodeFacts, ...]
    sources: dict[str, str]


def make_fleet(
    source: Source,
    robots: Sequence[str],
    stacks: Sequence[str],
    *,
    nodes: str | None = None,
    vocabulary: Sequence[str] = (),
    xacro_args: Mapping[str, str] = NOTHING,
    **policy: Any,
) -> Fleet:
    """Rewrite a description for every robot and make the fleet's table.

    ``nodes`` is a file of nodes and stacks beside the known ones; ``policy`` is that of
    ``make_naming``. Raises as ``rewrite_all``, and UsageError for an unknown stack.
    """
    library = user_stack(nodes) if nodes else built_in()
    facts = tuple(dict.fromkeys(node for name in stacks for node in stack_of(library, name)))
    naming = make_naming(**policy)
    more: dict[str, Any] = {"vocabulary": vocabulary, "xacro_args": xacro_args}
    rewritten = list(rewrite_all(source, robots, **more, **policy))
    tree = builtin_tree(tuple(vocabulary))
    file = rewritten[0].template.inventory.document.file
    inventories = {it.robot: collect(read_document(it.data, file), tree) for it in rewritten}
    plugins = {robot: list(plugin_nodes(found, robot)) for robot, found in inventories.items()}
    return Fleet(
        build_table(robots, facts, naming, plugins),
        inventories,
        naming,
        _edges(inventories, plugins, facts, naming),
        facts,
        _sources(rewritten[0], plugins),
    )


def _edges(
    inventories: Mapping[str, Inventory],
    plugins: Plugins,
    facts: Sequence[NodeFacts],
    naming: Naming,
) -> Edges:
    result: dict[tuple[str, str], list[Edge]] = {}
    for robot, found in inventories.items():
        own = [node for node, _ in plugins[robot]]
        result |= edges_of(robot, found, facts, own, naming)
    return result


def _sources(first: Rewrite, plugins: Plugins) -> dict[str, str]:
    """Lines of the source: those of a rewritten text are moved by what was inserted."""
    places = plugin_places(first.template.inventory)
    return {
        f"{node.namespace.rstrip('/')}/{node.name}": place
        for found in plugins.values()
        for (_, node), place in zip(found, places, strict=True)
    }


def expected(fleet: Fleet) -> Expectation:
    """What the graph of the fleet is to look like."""
    sent: dict[str, list[Edge]] = {robot: [] for robot in fleet.inventories}
    for (robot, _), edges in fleet.edges.items():
        sent[robot] += edges
    frames = {
        robot: frames_of(found, sent[robot], fleet.naming)
        for robot, found in fleet.inventories.items()
    }
    named = {robot: named_frames(found) for robot, found in fleet.inventories.items()}
    return expect(fleet.table, fleet.naming, frames, fleet.facts, named, fleet.sources)
