# SPDX-License-Identifier: Apache-2.0
"""A text with ``$(name value ...)`` in it -> its parts.

Source: launch jazzy, share/launch/frontend/grammar.lark, frontend/parse_substitution.py, and ``parse``
of each substitution.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from functools import cache
from typing import Any

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.producers.launch.stand_in import packages, values
from multibot_rewrite.producers.launch.stand_in.names import names

Parts = list[Any]
_NAME = lazy_compile(r"[A-Za-z][\w-]*")
_ESCAPED = lazy_compile(r"\\(.)", re.DOTALL)
# Text at the top or between these quotes, and a word of a substitution there.
_TEXTS, _WORDS = (
    {it: re.compile(rf"(?:[^\\${it}{ends}]|\\.|\$(?!\())+", re.DOTALL) for it in ("", "'", '"')}
    for ends in ("", " ()")
)
_WORDS[""] = re.compile(r"(?:[^\\$'\" ()]|\\.|\$(?!\())+", re.DOTALL)


# Those that are not made of their words one by one.
_OTHERWISE: Mapping[str, Callable[..., Any]] = {
    "command": lambda line, *_: values.Command(line),
    "eval": lambda *words: values.PythonExpression([it for word in words for it in word]),
    "path-join": lambda *words: packages.PathJoinSubstitution(words),
    "string-join": lambda delimiter, *words: packages.StringJoinSubstitution(words, delimiter),
}


@cache
def known() -> Mapping[str, Callable[..., Any]]:
    """Return what makes each substitution."""
    classes = {**vars(values), **vars(packages)}
    plain = {word: classes[it] for word, it in names().substitutions.items()}
    return {**plain, **_OTHERWISE}


def parse_substitution(value: str) -> Parts:
    """Return the parts of a text; raises ValueError if it is malformed or unknown."""
    parts, at = _parts(value, 0, _TEXTS[""], "")
    if at < len(value):
        raise ValueError(f"a substitution is not closed: {value[at : at + 40]!r}")
    return parts or [values.TextSubstitution(text="")]


def _parts(text: str, at: int, plain: re.Pattern[str], quote: str) -> tuple[Parts, int]:
    """Return texts and substitutions from a place on, and where they end."""
    parts: Parts = []
    while True:
        if found := plain.match(text, at):
            parts.append(values.TextSubstitution(text=_ESCAPED.sub(r"\1", found[0])))
            at = found.end()
        elif text.startswith("$(", at):
            part, at = _placed(text, at + 2, quote)
            parts.append(part)
        else:
            return parts, at


def _placed(text: str, at: int, quote: str) -> tuple[Any, int]:
    """Return the substitution whose name begins here, and the offset behind it."""
    found = _NAME.match(text, at)
    name = found[0] if found else ""
    if name in ("arg", "find", "optenv"):
        raise ValueError(f"Unknown substitution: {name}")
    if name not in known():
        raise ValueError(f"$({text[at : at + 40]}: this substitution needs launch itself")
    at += len(name)
    words = []
    while text.startswith(" ", at):
        word, at = _word(text, at + 1, quote)
        words.append(word)
    if not text.startswith(")", at):
        raise ValueError(f"$({name} is not closed")
    return known()[name](*words), at + 1


def _word(text: str, at: int, quote: str) -> tuple[Parts, int]:
    mark = text[at : at + 1]
    if quote or mark not in ("'", '"'):
        return _parts(text, at, _WORDS[quote], quote)
    parts, at = _parts(text, at + 1, _TEXTS[mark], mark)
    return parts or [values.TextSubstitution(text="")], at + 1
