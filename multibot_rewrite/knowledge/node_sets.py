# SPDX-License-Identifier: Apache-2.0
"""The known nodes and node sets of a release, from this package's YAML files and those of users."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from functools import lru_cache

from multibot_rewrite.base.bounded import read_text
from multibot_rewrite.base.conventions import SENT_FRAMES
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.releases import RELEASES, has_release, releases_with, since_version
from multibot_rewrite.knowledge.conditions import VERSION, condition_in_release, joined
from multibot_rewrite.knowledge.node_library import NodeLibrary, extend, nodes_of_set
from multibot_rewrite.knowledge.packages import older
from multibot_rewrite.knowledge.records import Endpoint, NodeFacts

HERE = os.path.dirname(__file__)
# What the others refer to is read first.
PARTS, NODE_SETS = "parts.yaml", "node_sets.yaml"


def load_nodes(release: str) -> dict[str, NodeFacts]:
    """Return every built-in node of a release by name."""
    return dict(built_in(release).nodes)


@lru_cache
def load_node_set(name: str, release: str) -> tuple[NodeFacts, ...]:
    """Return the nodes of a built-in node set or node; raises UsageError if the release has none."""
    return nodes_of_set(built_in(release), name)


@lru_cache
def built_in(release: str) -> NodeLibrary:
    """Return the nodes and node sets of a release that this package knows."""
    return in_release(every_release(), release)


def user_library(path: str, release: str) -> NodeLibrary:
    """Return the built-in library of a release with that of a file; raises UsageError with the line.

    A built-in node that the file changes is changed in the file's own node sets only."""
    return _extended_for_release(_text_of(path), path, release)


def with_file(path: str) -> NodeLibrary:
    """Return the built-in library of all releases with that of a file; raises as ``user_library``."""
    return _extended_library(_text_of(path), path)


# A command asks for what the same file says many times.
@lru_cache(maxsize=4)
def _extended_for_release(text: str, path: str, release: str) -> NodeLibrary:
    """Return the nodes of a release, with those that the text of a file adds."""
    return in_release(_extended_library(text, path), release)


@lru_cache(maxsize=4)
def _extended_library(text: str, path: str) -> NodeLibrary:
    return extend(every_release(), text, path)


def _text_of(path: str) -> str:
    """Return the text of a file of nodes."""
    try:
        return read_text(path)
    except OSError as error:
        raise UsageError(f"{path}: cannot be read: {error.strerror}") from None
    except UnicodeDecodeError:
        raise UsageError(f"{path}: cannot be read: it is not UTF-8; save it as UTF-8") from None


def is_apart(node: str, release: str) -> bool:
    """Return whether a node keeps its name in every layout, or is in the namespace of one that does."""
    above = node.rpartition("/")[0]
    known = apart_nodes(release)
    return any(_ends_in(node, it) or _ends_in(above, it.rpartition("/")[0]) for it in known)


def _ends_in(node: str, with_: str) -> bool:
    """Return whether the last segments of a node's name are another name."""
    return bool(with_) and f"/{node}".endswith(f"/{with_}")


@lru_cache
def apart_nodes(release: str) -> frozenset[str]:
    """Return the built-in nodes that keep their names in every layout."""
    return frozenset(it.name for it in built_in(release).nodes.values() if it.apart)


@lru_cache
def every_release() -> NodeLibrary:
    """Return the nodes and node sets that this package knows, of all releases."""
    library = NodeLibrary({}, {}, {}, sent=frozenset(SENT_FRAMES))
    folder = os.path.join(HERE, "nodes")
    names = sorted(os.listdir(folder), key=lambda it: (it != PARTS, it))
    for path in (*(os.path.join(folder, it) for it in names), os.path.join(HERE, NODE_SETS)):
        library = extend(library, read_text(path), os.path.basename(path), own=True)
    return library


def older_node(name: str, release: str, type_: str = "") -> str:
    """Return a note that a node was read in an older release; empty if not, or not with this type."""
    found = every_release().nodes.get(name) if name and release else None
    if found is None or (type_ and all(it.type != type_ for it in found.endpoints)):
        return ""
    return older(found.package, release)


def in_release(library: NodeLibrary, release: str) -> NodeLibrary:
    """Return the library of a release; what a later version of a package brought is conditional."""
    # Nodes and node sets that the release lacks, and the releases that have them.
    elsewhere = {
        name: ", ".join(releases_with(node.releases))
        for name, node in library.nodes.items()
        if name not in library.node_sets and not has_release(node.releases, release)
    }
    node_sets = {}
    for name, node_set in library.node_sets.items():
        if _has_set(library, name, release):
            include = (it for it in node_set.include if _has_set(library, it, release))
            nodes = tuple(_nodes_in_release(node_set.nodes, release))
            node_sets[name] = node_set._replace(include=tuple(include), nodes=nodes)
        else:
            elsewhere[name] = ", ".join(it for it in RELEASES if _has_set(library, name, it))
    return library._replace(
        parts={name: _endpoints_in_release(it, "", release) for name, it in library.parts.items()},
        nodes={it.name: it for it in _nodes_in_release(library.nodes.values(), release)},
        node_sets=node_sets,
        release=release,
        elsewhere=elsewhere,
    )


def _has_set(library: NodeLibrary, name: str, release: str) -> bool:
    """Return whether the release has a node of the node set, or the node set has none in any."""
    node_set = library.node_sets[name]
    if not has_release(node_set.releases, release):
        return False
    if not node_set.nodes and not node_set.include:
        return True
    nodes = any(has_release(it.releases, release) for it in node_set.nodes)
    return nodes or any(_has_set(library, it, release) for it in node_set.include)


def _nodes_in_release(nodes: Iterable[NodeFacts], release: str) -> Iterator[NodeFacts]:
    for node in nodes:
        if has_release(node.releases, release):
            frames = tuple(it for it in node.frames if has_release(it.releases, release))
            known = {it.parameter for it in frames}
            yield node._replace(
                endpoints=_endpoints_in_release(node.endpoints, node.package, release),
                when=_condition(node.when, node.releases, node.package, release),
                frames=frames,
                sends=tuple(it for it in node.sends if known.issuperset(it[:2])),
                claims=tuple(it for it in node.claims if has_release(it.releases, release)),
            )


def _endpoints_in_release(
    endpoints: Iterable[Endpoint], package: str, release: str
) -> tuple[Endpoint, ...]:
    there = ((it, condition_in_release(it.when, release)) for it in endpoints)
    return tuple(
        _endpoint_in_release(it if when == it.when else it._replace(when=when), package, release)
        for it, when in there
        if when is not None and has_release(it.releases, release)
    )


def _endpoint_in_release(it: Endpoint, package: str, release: str) -> Endpoint:
    """Return an endpoint with the condition, types and place that it has in a release."""
    if not (it.releases or it.above or it.types):
        return it
    above = it.above if it.above and has_release(it.above, release) else ""
    types = ((condition_in_release(condition, release), type_) for condition, type_ in it.types)
    return it._replace(
        when=_condition(it.when, it.releases, package, release),
        above=above,
        types=tuple((condition, type_) for condition, type_ in types if condition is not None),
    )


def _condition(when: str, words: str, package: str, release: str) -> str:
    """Return the condition of a fact, with the version that it came with in this release."""
    version = since_version(words, release) if words else ""
    newer = f"{VERSION}: {package or 'its package'} {version}"
    return joined(when, newer) if version else when
