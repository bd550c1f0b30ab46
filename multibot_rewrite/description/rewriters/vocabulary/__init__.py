# SPDX-License-Identifier: Apache-2.0
"""The plugin definitions: which tag of which plugin holds which name. Data in ``*.vocab``, read lazily;
``README.md`` has the grammar.
"""

from __future__ import annotations

import os
from functools import lru_cache

from multibot_rewrite.base.bounded import read_text
from multibot_rewrite.base.model import VocabularyError
from multibot_rewrite.description.rewriters.vocabulary.grammar import (
    FORMS,
    KINDS,
    TYPES,
    VocabularySection,
    is_step,
    split_path,
    split_step,
)
from multibot_rewrite.description.rewriters.vocabulary.installed import advice, installed
from multibot_rewrite.description.rewriters.vocabulary.library import Vocabulary
from multibot_rewrite.description.rewriters.vocabulary.values import Value, Values

__all__ = [
    "FORMS",
    "KINDS",
    "TYPES",
    "Value",
    "Values",
    "Vocabulary",
    "VocabularySection",
    "advice",
    "check_vocabulary",
    "is_step",
    "load_vocabulary",
    "split_path",
    "split_step",
]
HERE = os.path.dirname(__file__)


@lru_cache(maxsize=16)
def load_vocabulary(
    extra: tuple[str, ...], release: str, *, packages: bool = True, ros: str = ""
) -> Vocabulary:
    """Return the built-in definitions, those of installed ``packages``, and the files in ``extra``, for
    a ``release``.

    With an empty one it is all of them, which no document can be read with; ``ros`` as for
    ``Vocabulary``. Raises VocabularyError, naming file and line, for a mistake: at once in what is not
    built in, otherwise in a section that is used.
    """
    builtin = sorted(name for name in os.listdir(HERE) if name.endswith(".vocab"))
    named = {file.name: file.path for file in (installed() if packages else ())}
    # A user's file may be called like a built-in one.
    named |= {os.path.join(".", path) if path in builtin else path: path for path in extra}
    # Name in messages -> path of the files beyond the built-in ones, each file once.
    first: dict[str, str] = {}
    for name, path in named.items():
        first.setdefault(os.path.realpath(path), name)
    more = {name: named[name] for name in first.values()}
    texts = {name: _text(name, f"{HERE}/{name}") for name in builtin}
    try:
        texts |= {name: _text(name, path) for name, path in more.items()}
        vocabulary = Vocabulary(texts, release, bool(more), ros)
        vocabulary.sections_in(more)
    except VocabularyError as error:
        raise VocabularyError(f"{error}{advice(str(error)) if packages else ''}") from None
    return vocabulary


def _text(name: str, path: str) -> str:
    try:
        return read_text(path)
    except OSError as error:
        raise VocabularyError(f"{name}: cannot be read: {error.strerror}") from None
    except UnicodeDecodeError:
        raise VocabularyError(
            f"{name}: cannot be read: it is not UTF-8; save it as UTF-8"
        ) from None


def check_vocabulary(vocabulary: Vocabulary) -> list[VocabularySection]:
    """Parse every section; raises VocabularyError for the first mistake."""
    return vocabulary.sections(*TYPES)
