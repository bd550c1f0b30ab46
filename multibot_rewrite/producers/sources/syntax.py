# SPDX-License-Identifier: Apache-2.0
"""C++ -> its nodes of syntax. The only import of tree-sitter."""

from __future__ import annotations

from functools import cache
from importlib.util import find_spec
from typing import TYPE_CHECKING

from multibot_rewrite.base.model import UsageError

if TYPE_CHECKING:
    from tree_sitter import Node, Parser, QueryCursor


__all__ = ["Node", "nodes_of", "or_read"]
INSTALL = "pip install 'multibot_rewrite[sources]'"


def or_read() -> str:
    """What reads more nodes, as the rest of a hint; empty where nodes in C++ are read already."""
    here = find_spec("tree_sitter") and find_spec("tree_sitter_cpp")
    return "" if here else f", or read those in C++ from their source: {INSTALL}"


def nodes_of(text: str, kinds: tuple[str, ...]) -> list[Node]:
    """The nodes of these kinds, in the order of the text, an inner one before the one around it that
    begins with it; raises UsageError without tree-sitter."""
    parser, query = _tools(kinds)
    tree = parser.parse(text.encode())
    found = query.captures(tree.root_node).get("found", ())
    return sorted(found, key=lambda it: (it.start_byte, it.end_byte))


@cache
def _tools(kinds: tuple[str, ...]) -> tuple[Parser, QueryCursor]:
    """The parser, and the query for these kinds."""
    try:
        import tree_sitter
        import tree_sitter_cpp
    except ImportError:
        raise UsageError(f"reading C++ needs tree-sitter; {INSTALL}") from None
    language = tree_sitter.Language(tree_sitter_cpp.language())
    query = tree_sitter.Query(language, "\n".join(f"({kind}) @found" for kind in kinds))
    return tree_sitter.Parser(language), tree_sitter.QueryCursor(query)
