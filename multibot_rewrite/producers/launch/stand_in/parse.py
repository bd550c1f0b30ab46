# SPDX-License-Identifier: Apache-2.0
"""A text with ``$(name value ...)`` in it -> its parts.

Source: launch jazzy, share/launch/frontend/grammar.lark, frontend/parse_substitution.py, and ``parse``
of each substitution.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.producers.launch.stand_in import packages, paths, values

Parts = list[Any]
_NAME = lazy_compile(r"[A-Za-z][\w-]*")
_ESCAPED = lazy_compile(r"\\(.)", re.DOTALL)
# Text at the top or between these quotes, and a word of a substitution there.
_TEXTS, _WORDS = (
    {it: re.compile(rf"(?:[^\\${it}{ends}]|\\.|\$(?!\())+", re.DOTALL) for it in ("", "'", '"')}
    for ends in ("", " ()")
)
_WORDS[""] = re.compile(r"(?:[^\\$'\" ()]|\\.|\$(?!\())+", re.DOTALL)


_OF_ROS_1 = ("arg", "find", "optenv")
_KNOWN: Mapping[str, Callable[..., Any]] = MappingProxyType(
    {
        "all": values.AllSubstitution,
        "and": values.AndSubstitution,
        "anon": values.AnonName,
        "any": values.AnySubstitution,
        "command": lambda line, *_: values.Command(line),
        "dirname": paths.ThisLaunchFileDir,
        "env": values.EnvironmentVariable,
        "equals": values.EqualsSubstitution,
        "eval": lambda *words: values.PythonExpression([it for word in words for it in word]),
        "exec-in-pkg": packages.ExecutableInPackage,
        "file-content": paths.FileContent,
        "filename": paths.ThisLaunchFile,
        "find-exec": values.FindExecutable,
        "find-pkg-prefix": packages.FindPackagePrefix,
        "find-pkg-share": packages.FindPackageShare,
        "for-var": values.ForEachVar,
        "if": values.IfElseSubstitution,
        "index": values.ForLoopIndex,
        "launch_log_dir": paths.LaunchLogDir,
        "log_dir": paths.LaunchLogDir,
        "not": values.NotSubstitution,
        "not-equals": values.NotEqualsSubstitution,
        "or": values.OrSubstitution,
        "param": packages.ParameterSubstitution,
        "path-join": lambda *words: paths.PathJoinSubstitution(words),
        "string-join": lambda delimiter, *words: paths.StringJoinSubstitution(words, delimiter),
        "var": values.LaunchConfiguration,
    }
)


def parse_substitution(value: str) -> Parts:
    """The parts of a text; raises ValueError for one that is not well formed or not known."""
    parts, at = _parts(value, 0, _TEXTS[""], "")
    if at < len(value):
        raise ValueError(f"a substitution is not closed: {value[at : at + 40]!r}")
    return parts or [values.TextSubstitution(text="")]


def _parts(text: str, at: int, plain: re.Pattern[str], quote: str) -> tuple[Parts, int]:
    """Texts and substitutions from a place on, and where they end."""
    parts: Parts = []
    while True:
        found = plain.match(text, at)
        if found:
            parts.append(values.TextSubstitution(text=_ESCAPED.sub(r"\1", found[0])))
            at = found.end()
        elif text.startswith("$(", at):
            part, at = _placed(text, at + 2, quote)
            parts.append(part)
        else:
            return parts, at


def _placed(text: str, at: int, quote: str) -> tuple[Any, int]:
    """The substitution whose name begins here."""
    found = _NAME.match(text, at)
    name = found[0] if found else ""
    if name in _OF_ROS_1:
        raise ValueError(f"Unknown substitution: {name}")
    if name not in _KNOWN:
        raise ValueError(f"$({text[at : at + 40]}: this substitution needs launch itself")
    at += len(name)
    words = []
    while text.startswith(" ", at):
        word, at = _word(text, at + 1, quote)
        words.append(word)
    if not text.startswith(")", at):
        raise ValueError(f"$({name} is not closed")
    return _KNOWN[name](*words), at + 1


def _word(text: str, at: int, quote: str) -> tuple[Parts, int]:
    mark = text[at : at + 1]
    if quote or mark not in ("'", '"'):
        return _parts(text, at, _WORDS[quote], quote)
    parts, at = _parts(text, at + 1, _TEXTS[mark], mark)
    return parts or [values.TextSubstitution(text="")], at + 1
