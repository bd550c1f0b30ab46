# SPDX-License-Identifier: Apache-2.0
"""Reads the options as the library takes them: robots, xacro arguments, the naming policy."""

from __future__ import annotations

import argparse
import os
import shlex
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.naming import ROS_SEPARATORS, SEPARATORS
from multibot_rewrite.base.rosnames import MOST, numbered_names
from multibot_rewrite.description.sources.read import is_xacro

if TYPE_CHECKING:
    from multibot_rewrite.base.naming import Policy

# Kinds that ``--separator SEP`` without a kind is for.
OF_DESCRIPTION = tuple(kind for kind in SEPARATORS if kind not in ROS_SEPARATORS)


def policy(options: argparse.Namespace) -> Policy:
    """Return the naming options that are given, as ``make_naming`` takes them."""
    given = {name: getattr(options, name) for name in ("layout", "affix", "topics")}
    words: Policy = {name: value for name, value in given.items() if value is not None}  # type: ignore[assignment]
    if options.separator:
        words["separators"] = separators(options)
    if any(it.startswith("group=") for it in options.separator):
        words["groups"] = "rename"
    topics = [it for it in options.shared if it.startswith("/")]
    if frames := [it for it in options.shared if it not in topics]:
        words["shared_frames"] = frames
    return {**words, "shared_topics": topics} if topics else words


def rewriting(options: argparse.Namespace) -> dict[str, Any]:
    """Return the options for every library call that rewrites, undoes or explains."""
    return {
        **policy(options),
        "urdf": options.urdf,
        "xacro_args": xacro_args(options),
        "definitions": options.definitions,
        "trust": options.trust,
        "distro": options.distro or "",
    }


def separators(options: argparse.Namespace) -> dict[str, str]:
    """Return ``--separator`` as kind -> mark; one with a kind overrides one without."""
    pairs = [it.partition("=") for it in options.separator]
    word = next((it for it, equals, _ in pairs if not equals and it.isalnum()), None)
    if word is not None:
        raise UsageError(f"--separator {word}: write KIND=SEP, for example link=_, or SEP alone: _")
    alone = {kind: it for it, equals, _ in pairs if not equals for kind in OF_DESCRIPTION}
    return {**alone, **{kind: mark for kind, equals, mark in pairs if equals}}


def plain_words(options: argparse.Namespace) -> list[str]:
    """Return the positional arguments that are not xacro arguments."""
    return [word for word in options.words if ":=" not in word]


def robots(options: argparse.Namespace) -> list[str]:
    """Return the robots: named, by ``--robots``, or numbered up to ``--count``."""
    named, count = named_robots(options), vars(options).get("count")
    if count is None:
        return named
    if named:
        raise UsageError(f"--count {count} and {named[0]}: give a number of robots, or their names")
    return list(numbered_names(asked_number(options)))


def check_order(program: str, first: str, words: Sequence[str]) -> None:
    """Raise UsageError if a file is named after another argument."""
    file = next(filter(os.path.isfile, words), "")
    if file and not os.path.exists(first):
        right = shlex.join([file, first, *(it for it in words if it != file)])
        raise UsageError(f"the file comes first: {program} {right}")


def asked_number(options: argparse.Namespace) -> int:
    """Return the number of robots that ``--count`` asks for, 0 without it; raises UsageError."""
    count = vars(options).get("count")
    if count is not None and not 0 < count <= MOST:
        raise UsageError(
            f"--count {count}: a fleet has at least one robot, and at most {MOST}: give such a number"
        )
    return count or 0


def named_robots(options: argparse.Namespace) -> list[str]:
    """Return the robots that are named, as arguments or by ``--robots``."""
    words = plain_words(options)
    wrong = next((word for word in words if "=" in word), None)
    if wrong is not None and options.separator:
        given = ",".join([*options.separator, wrong])
        raise UsageError(f"{wrong!r} is not a robot's name; write --separator {given}")
    return [*words, *options.robots]


def xacro_args(options: argparse.Namespace) -> dict[str, str]:
    """Return the xacro arguments, name -> value."""
    pairs = [word.partition(":=") for word in options.words if ":=" in word]
    return {name: value for name, _, value in pairs}


def arguments_alone(options: argparse.Namespace) -> dict[str, str]:
    """Return the xacro arguments; raises UsageError for any other argument."""
    if others := plain_words(options):
        raise UsageError(f"{others[0]!r} is one word too many; xacro arguments are NAME:=VALUE")
    return xacro_args(options)


def check_xacro(options: argparse.Namespace, paths: Sequence[str]) -> None:
    """Raise UsageError for xacro arguments that none of the files takes."""
    if xacro_args(options) and not any(is_xacro(path) for path in paths):
        raise UsageError(f"{paths[0]} is no xacro: leave out NAME:=VALUE")


def given_options(options: argparse.Namespace, names: Mapping[str, str]) -> list[str]:
    """Return the written names of those of the options that are given."""
    return [written for name, written in names.items() if getattr(options, name)]
