# SPDX-License-Identifier: Apache-2.0
"""The plugin definitions, read lazily from ``*.vocab``; ``README.md`` has the grammar."""

from __future__ import annotations

import os
from functools import lru_cache

from multibot_rewrite.base.bounded import read_text
from multibot_rewrite.base.model import DefinitionsError
from multibot_rewrite.description.rewriters.installed import advice, installed
from multibot_rewrite.description.rewriters.plugin_definitions.grammar import (
    FORMS,
    KINDS,
    TYPES,
    PluginDefinition,
    is_step,
    split_path,
    split_step,
)
from multibot_rewrite.description.rewriters.plugin_definitions.library import Definitions
from multibot_rewrite.description.rewriters.plugin_definitions.values import Value, Values

__all__ = [
    "FORMS",
    "KINDS",
    "TYPES",
    "Definitions",
    "PluginDefinition",
    "Value",
    "Values",
    "advice",
    "is_step",
    "load_definitions",
    "split_path",
    "split_step",
]
HERE = os.path.dirname(__file__)


@lru_cache(maxsize=16)
def load_definitions(
    extra: tuple[str, ...], release: str, *, packages: bool = True, ros: str = ""
) -> Definitions:
    """Return the definitions for a ``release``: built-in, of installed ``packages``, in ``extra``.

    An empty release gives all, which no document can be read with; ``ros`` as for
    ``Definitions``. Raises DefinitionsError, with file and line: at once for a mistake in what
    is not built in, otherwise in a section that is used."""
    builtin = sorted(name for name in os.listdir(HERE) if name.endswith(".vocab"))
    named = {file.name: file.path for file in (installed() if packages else ())}
    # A user's file may be called like a built-in one.
    named |= {os.path.join(".", path) if path in builtin else path: path for path in extra}
    # Name in messages -> path of the files beyond the built-in ones, each file once.
    first: dict[str, str] = {}
    for name, path in named.items():
        first.setdefault(os.path.realpath(path), name)
    more = {name: named[name] for name in first.values()}
    texts = {name: _file_text(name, f"{HERE}/{name}") for name in builtin}
    try:
        texts |= {name: _file_text(name, path) for name, path in more.items()}
        definitions = Definitions(texts, release, bool(more), ros)
        definitions.sections_in(more)
    except DefinitionsError as error:
        raise DefinitionsError(f"{error}{advice(str(error)) if packages else ''}") from None
    return definitions


def _file_text(name: str, path: str) -> str:
    try:
        return read_text(path)
    except OSError as error:
        raise DefinitionsError(f"{name}: cannot be read: {error.strerror}") from None
    except UnicodeDecodeError:
        raise DefinitionsError(
            f"{name}: cannot be read: it is not UTF-8; save it as UTF-8"
        ) from None
