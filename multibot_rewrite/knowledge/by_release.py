# SPDX-License-Identifier: Apache-2.0
"""A library of all releases -> that of one: what it lacks is left out, what came late conditional."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from multibot_rewrite.base.releases import RELEASES, has_release, releases_with, since_version
from multibot_rewrite.knowledge.conditions import VERSION, joined, of_release
from multibot_rewrite.knowledge.node_library import NodeLibrary, Stack
from multibot_rewrite.knowledge.records import Endpoint, NodeFacts


def in_release(library: NodeLibrary, release: str) -> NodeLibrary:
    """What of ``library`` is in ``release``.

    What came into the release with a later version of its package has that as its condition, so an
    installed older version lacks nothing.
    """
    parts = {name: _endpoints(it, "", release) for name, it in library.parts.items()}
    return library._replace(
        parts=parts,
        nodes={it.name: it for it in _nodes(library.nodes.values(), release)},
        stacks=_stacks(library, release),
        release=release,
        elsewhere=dict(_elsewhere(library, release)),
    )


def _stacks(library: NodeLibrary, release: str) -> dict[str, Stack]:
    there = {name: it for name, it in library.stacks.items() if _has_stack(library, name, release)}
    return {
        name: it._replace(
            include=tuple(other for other in it.include if other in there),
            nodes=tuple(_nodes(it.nodes, release)),
        )
        for name, it in there.items()
    }


def _has_stack(library: NodeLibrary, name: str, release: str) -> bool:
    """Is a node of the stack in the release? A stack may have none in any."""
    stack = library.stacks[name]
    if not has_release(stack.releases, release):
        return False
    if not stack.nodes and not stack.include:
        return True
    nodes = any(has_release(it.releases, release) for it in stack.nodes)
    return nodes or any(_has_stack(library, it, release) for it in stack.include)


def _elsewhere(library: NodeLibrary, release: str) -> Iterator[tuple[str, str]]:
    """Nodes and stacks that the release lacks, and the releases that have them."""
    for name, node in library.nodes.items():
        if name not in library.stacks and not has_release(node.releases, release):
            yield name, ", ".join(releases_with(node.releases))
    for name in library.stacks:
        if not _has_stack(library, name, release):
            yield name, ", ".join(it for it in RELEASES if _has_stack(library, name, it))


def _nodes(nodes: Iterable[NodeFacts], release: str) -> Iterator[NodeFacts]:
    for node in nodes:
        if has_release(node.releases, release):
            yield _node(node, release)


def _node(node: NodeFacts, release: str) -> NodeFacts:
    frames = tuple(it for it in node.frames if has_release(it.releases, release))
    known = {it.parameter for it in frames}
    return node._replace(
        endpoints=_endpoints(node.endpoints, node.package, release),
        when=_condition(node.when, node.releases, node.package, release),
        frames=frames,
        sends=tuple(it for it in node.sends if known.issuperset(it[:2])),
        claims=tuple(it for it in node.claims if has_release(it.releases, release)),
    )


def _endpoints(endpoints: Iterable[Endpoint], package: str, release: str) -> tuple[Endpoint, ...]:
    return tuple(
        _endpoint(it, package, release) if it.releases or it.above or it.types else it
        for it in endpoints
        if has_release(it.releases, release)
    )


def _endpoint(it: Endpoint, package: str, release: str) -> Endpoint:
    above = it.above if it.above and has_release(it.above, release) else ""
    types = ((of_release(condition, release), type_) for condition, type_ in it.types)
    return it._replace(
        when=_condition(it.when, it.releases, package, release),
        above=above,
        types=tuple((condition, type_) for condition, type_ in types if condition is not None),
    )


def _condition(when: str, words: str, package: str, release: str) -> str:
    """The condition of a fact, with the version that it came with in this release."""
    version = since_version(words, release) if words else ""
    newer = f"{VERSION}: {package or 'its package'} {version}"
    return joined(when, newer) if version else when
