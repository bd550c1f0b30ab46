# SPDX-License-Identifier: Apache-2.0
"""The page of known nodes and node sets, of all releases."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from multibot_rewrite.knowledge.conditions import readable
from multibot_rewrite.knowledge.controller_ways import CONTROLLER_WAYS, ControllerWay
from multibot_rewrite.knowledge.node_library import NodeLibrary, NodeSet
from multibot_rewrite.knowledge.node_sets import every_release
from multibot_rewrite.knowledge.records import Endpoint, NodeFacts
from tools.pages.markdown import plain

HEAD = """\
# Known nodes

The topics, services and actions of known nodes, and the node sets of nodes that are started together.
How they are used and what the columns say: [nodes and node sets](node-sets.md).

## Where a controller's rules stand

| releases | a controller's rules are given to | rules that it gets besides | source |
|---|---|---|---|
"""
REACH = """\

## Names that no remap rule reaches

| node | what | why |
|---|---|---|
"""
HELPER = "a helper node uses it: only a rule for the whole process reaches it"


def page() -> str:
    """Return the whole page as Markdown."""
    library = every_release()
    parts = [HEAD, *(_controllers(it) for it in CONTROLLER_WAYS), "\n## Node sets\n"]
    parts += [_node_set(name, node_set) for name, node_set in library.node_sets.items()]
    nodes = sorted(library.nodes.values(), key=lambda it: it.name.lower())
    parts.append(REACH)
    parts += [row for node in nodes for row in _reach(node)]
    parts.append("\n## Nodes\n")
    parts += [_node(node, library) for node in nodes]
    parts.append("\n## Parts\n\nGroups of names that many nodes have.\n")
    parts += [f"\n### {name}\n{_table(found)}" for name, found in library.parts.items()]
    return "".join(parts)


def _controllers(way: ControllerWay) -> str:
    given = "its spawner, `--controller-ros-args`" if way.spawner else "its manager's process"
    handed = "all of its process" if way.process_wide else "none"
    handed = "those of its manager, with a warning" if way.forwarded else handed
    return f"| {way.releases} | {given} | {handed} | {way.source} |\n"


def _node_set(name: str, node_set: NodeSet) -> str:
    lines = [f"\n### {name}\n\n{node_set.about}.\n\n"]
    within = f", in the container `{node_set.container}`" if node_set.container else ""
    lines += [f"- all nodes of {other}{within}\n" for other in node_set.include]
    lines += [f"- {_member(node)}\n" for node in node_set.nodes]
    return "".join(lines)


def _member(node: NodeFacts) -> str:
    notes = [f"`{e.name}` remapped to `{e.remapped}`" for e in node.endpoints if e.remapped]
    notes += [f"when: {readable(node.when)}"] * bool(node.when) + ["for all robots"] * node.shared
    notes += _in(node.releases)
    return f"`{node.name}`" + (f": {', '.join(dict.fromkeys(notes))}" if notes else "")


def _reach(node: NodeFacts) -> Iterator[str]:
    """Yield the rows of names that no rule reaches."""
    for text in node.fixed:
        yield _row([f"`{node.name}`", "", plain(text)])
    if node.prefix_switch:
        why = f"its namespace is put before its frames, unless `{node.prefix_switch}` is false"
        yield _row([f"`{node.name}`", "", why])
    for frame in node.frames:
        why = "; ".join((f"a frame: parameter `{frame.parameter}`", *_in(frame.releases)))
        yield _row([f"`{node.name}`", f"`{frame.default}`", why])
    for endpoint in node.endpoints:
        if endpoint.fixed or endpoint.helper:
            why = plain(endpoint.fixed or HELPER)
            yield _row([f"`{node.name}`", f"{endpoint.kind} `{endpoint.name}`", why])


def _node(node: NodeFacts, library: NodeLibrary) -> str:
    facts = [f"package {node.package}"] * bool(node.package)
    facts += [f"in the process of {node.host}"] * bool(node.host)
    facts += ["keeps its name, in its robot's namespace, in every layout"] * node.apart
    facts += (
        ["one for all robots"] * node.shared + _in(node.releases) + [node.note] * bool(node.note)
    )
    facts += [f"source: {it}" for it in node.source]
    # A part is listed by name; its own table has the rest.
    parts = {name: found for name, found in library.parts.items() if {*found} <= {*node.endpoints}}
    facts += [f"with {', '.join(parts)}"] * bool(parts)
    folded = {endpoint for found in parts.values() for endpoint in found}
    own = [endpoint for endpoint in node.endpoints if endpoint not in folded]
    return f"\n### {node.name}\n\n{plain('; '.join(facts))}\n{_table(own) if own else ''}"


def _table(endpoints: Iterable[Endpoint]) -> str:
    rows = [_row(_cells(endpoint)) for endpoint in endpoints]
    return (
        f"\n| | name | type | set by | only if | note |\n|---|---|---|---|---|---|\n{''.join(rows)}"
    )


def _cells(endpoint: Endpoint) -> list[str]:
    types = " or ".join(filter(None, (endpoint.type, *endpoint.also)))
    notes = [endpoint.note] * bool(endpoint.note) + ["image_transport"] * endpoint.transport
    notes += [f"remapped to {endpoint.remapped}"] * bool(endpoint.remapped)
    notes = [*_in(endpoint.releases), *notes, *(f"source: {it}" for it in endpoint.source)]
    parameter = f"`{endpoint.parameter}`" if endpoint.parameter else ""
    name = f"{endpoint.role} {endpoint.kind}", f"`{endpoint.name}`"
    return [*name, types, parameter, plain(readable(endpoint.when)), plain("; ".join(notes))]


def _in(releases: str) -> list[str]:
    """Return the only releases that have it, as a list of one; empty for all."""
    return [f"in {releases}"] * bool(releases)


def _row(cells: Iterable[str]) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |\n"
