# SPDX-License-Identifier: Apache-2.0
"""The words behind a program's name -> what rcl makes of them.

Source: rcl arguments.c (what is between ``--ros-args`` and ``--`` is ROS's own)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import NamedTuple

_RULE, _VALUE, _FILE = ("-r", "--remap"), ("-p", "--param"), "--params-file"


class RosArguments(NamedTuple):
    """Name and namespace (empty for none), remap rules, parameter values and files, and the words
    that are not ROS's own."""

    name: str
    namespace: str
    rules: tuple[tuple[str, str], ...]
    values: tuple[tuple[str, str], ...]
    files: tuple[str, ...]
    own: tuple[str, ...]


def ros_arguments(words: Sequence[str]) -> RosArguments:
    """Return what rcl reads in these words."""
    own: list[str] = []
    given: list[str] = []
    inside = False
    for word in words:
        if word in ("--ros-args", "--"):
            inside = word == "--ros-args"
        else:
            (given if inside else own).append(word)
    flags = list(pairwise(given))
    rules = [_pair(text) for flag, text in flags if flag in _RULE and ":=" in text]
    named = dict(rules)
    return RosArguments(
        named.get("__node", named.get("__name", "")),
        named.get("__ns", ""),
        tuple(it for it in rules if not it[0].startswith("__")),
        tuple(_pair(text) for flag, text in flags if flag in _VALUE and ":=" in text),
        tuple(text for flag, text in flags if flag == _FILE),
        tuple(own),
    )


def ros2_run(words: Sequence[str]) -> tuple[str, str, tuple[str, ...]] | None:
    """Return package, executable and further words of a ``ros2 run`` line; None for another line."""
    if [it.rpartition("/")[2] for it in words[:2]] != ["ros2", "run"]:
        return None
    after = list(words[2:])
    while after and after[0].startswith("-"):
        # --prefix is the one option with a value.
        after = after[2:] if after[0] == "--prefix" else after[1:]
    return (after[0], after[1], tuple(after[2:])) if len(after) > 1 else None


def _pair(text: str) -> tuple[str, str]:
    old, _, new = text.partition(":=")
    return old, new


def params_text(values: Iterable[tuple[str, str]]) -> str:
    """Return a parameter file for any node with these values, each as YAML has it."""
    lines = "".join(f"    {name}: {value}\n" for name, value in values)
    return f"/**:\n  ros__parameters:\n{lines}" if lines else ""
