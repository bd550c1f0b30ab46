# SPDX-License-Identifier: Apache-2.0
"""The tree of rewriters that every job starts from."""

from __future__ import annotations

from functools import lru_cache

from multibot_rewrite.base.model import VocabularyError
from multibot_rewrite.description.rewriters.tree import Tree
from multibot_rewrite.description.rewriters.vocabulary import advice, load_vocabulary


@lru_cache(maxsize=16)
def builtin_tree(vocabulary: tuple[str, ...], release: str) -> Tree:
    """The tree of a release: of the vocabulary built in, installed, and named in ``vocabulary``; made
    once."""
    sections = load_vocabulary(vocabulary, release)
    try:
        tree = Tree(sections)
        if sections.extended:
            tree.check()
        return tree
    except VocabularyError as error:
        raise VocabularyError(f"{error}{advice(str(error))}") from None
