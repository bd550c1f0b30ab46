# SPDX-License-Identifier: Apache-2.0
"""What a child has to ask its parent for: files, packages, variables of the environment."""

from __future__ import annotations

import io
import json
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

from multibot_rewrite.description.sources.child.frames import (
    ENVIRONMENT,
    FIND,
    GLOB,
    MOST_TEXT,
    QUESTION,
    READ,
    REFUSAL,
    VALUE,
    framed,
    received,
)

Ask = Callable[[str, str], bytes]
_ANSWERS = {VALUE: 2 * MOST_TEXT, REFUSAL: MOST_TEXT}


class RefusedError(Exception):
    """The parent said no; the text is its reason."""


_ERRORS: dict[str, Callable[..., Exception]] = {
    "os": OSError,
    "lookup": LookupError,
    "refused": RefusedError,
}


def asking(read: Callable[[int], bytes], write: Callable[[bytes], object]) -> Ask:
    """The function that asks; it raises what the parent says."""

    def ask(what: str, name: str) -> bytes:
        write(framed(QUESTION, json.dumps([what, str(name)]).encode()))
        kind, data = received(read, _ANSWERS)
        if kind == VALUE:
            return data
        error, *words = json.loads(data)
        raise _ERRORS[error](*words)

    return ask


def connect(xacro: Any, substitution: Any, ask: Ask) -> None:
    """From now on what xacro opens, looks for and reads of the environment comes from the parent."""
    xacro.open = _opener(ask)
    xacro.glob = SimpleNamespace(glob=lambda pattern: json.loads(ask(GLOB, pattern)))
    # Relative names stay relative: the parent knows the folder.
    xacro.root_dir = ""
    ways = {
        "find": lambda package: ask(FIND, package).decode(),
        "env": _known(substitution._eval_env, ask),
        "optenv": _known(substitution._eval_optenv, ask),
    }
    for name, way in ways.items():
        setattr(substitution, f"_eval_{name}", way)
    substitution._eval_dict.update(ways)


def _opener(ask: Ask) -> Callable[..., io.TextIOBase]:
    def opened(name: str, *_: object, **__: object) -> io.TextIOBase:
        return io.TextIOWrapper(io.BytesIO(ask(READ, name)), "utf-8")

    return opened


def _known(look_up: Callable[..., str], ask: Ask) -> Callable[..., str]:
    """The value that the parent has; else what ``look_up`` says of a variable that is not set."""

    def known(name: str, *more: str, **named: str) -> str:
        found = json.loads(ask(ENVIRONMENT, name))
        # A child has no variables: this one raises, or takes the default.
        return look_up(name, *more, **named) if found is None else str(found)

    return known
