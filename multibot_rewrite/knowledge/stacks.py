# SPDX-License-Identifier: Apache-2.0
"""Known nodes and stacks of nodes, from ``nodes/*.yaml``, ``stacks.yaml`` and files of users."""

from __future__ import annotations

import os
from functools import lru_cache

from multibot_rewrite.base.bounded import read_text
from multibot_rewrite.base.conventions import SENT_FRAMES
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.knowledge.by_release import in_release
from multibot_rewrite.knowledge.node_library import NodeLibrary, extend, stack_of
from multibot_rewrite.knowledge.records import NodeFacts

HERE = os.path.dirname(__file__)
# What the others refer to is read first.
PARTS, STACKS = "parts.yaml", "stacks.yaml"


def load_nodes(release: str) -> dict[str, NodeFacts]:
    """Every built-in node of a release by name."""
    return dict(built_in(release).nodes)


@lru_cache
def load_stack(name: str, release: str) -> tuple[NodeFacts, ...]:
    """The nodes of a built-in stack, or a built-in node.

    Raises UsageError for an unknown name, and for a stack that the release lacks.
    """
    return stack_of(built_in(release), name)


@lru_cache
def built_in(release: str) -> NodeLibrary:
    """The nodes and stacks of a release that this package knows."""
    return in_release(every_release(), release)


def user_stack(path: str, release: str) -> NodeLibrary:
    """The built-in nodes and stacks and those of a file; ``stack_of`` selects a stack.

    A built-in node that the file changes is changed in the file's own stacks only. Raises UsageError
    with file and line for errors in the file.
    """
    return in_release(with_file(path), release)


def with_file(path: str) -> NodeLibrary:
    """The built-in nodes and stacks of all releases and those of a file; raises as ``user_stack``."""
    try:
        text = read_text(path)
    except OSError as error:
        raise UsageError(f"{path}: cannot be read: {error.strerror}") from None
    except UnicodeDecodeError:
        raise UsageError(f"{path}: cannot be read: it is not UTF-8; save it as UTF-8") from None
    return extend(every_release(), text, path)


def is_apart(node: str, release: str) -> bool:
    """Does this node keep its name in every layout (``NodeFacts.apart``), as far as built-in nodes say?

    What is in the namespace of such a node, as the helpers of costmaps, goes with it.
    """
    above = node.rpartition("/")[0]
    known = apart_nodes(release)
    return any(_ends(node, it) or _ends(above, it.rpartition("/")[0]) for it in known)


def _ends(node: str, with_: str) -> bool:
    return bool(with_) and f"/{node}".endswith(f"/{with_}")


@lru_cache
def apart_nodes(release: str) -> frozenset[str]:
    """The built-in nodes that keep their names in every layout."""
    return frozenset(it.name for it in built_in(release).nodes.values() if it.apart)


@lru_cache
def every_release() -> NodeLibrary:
    """The nodes and stacks that this package knows, of all releases."""
    library = NodeLibrary({}, {}, {}, sent=frozenset(SENT_FRAMES))
    for path in _files():
        library = extend(library, read_text(path), os.path.basename(path), own=True)
    return library


def _files() -> list[str]:
    folder = os.path.join(HERE, "nodes")
    names = sorted(os.listdir(folder), key=lambda it: (it != PARTS, it))
    return [*(os.path.join(folder, it) for it in names), os.path.join(HERE, STACKS)]
