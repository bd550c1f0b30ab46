# SPDX-License-Identifier: Apache-2.0
"""Options and commands as data, and how they are written down.

This module and ``declared`` import nothing heavy: a help text is made of them alone.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.cli import values

NOTHING: Mapping[str, Any] = MappingProxyType({})


class Option(NamedTuple):
    """An option or argument; ``keywords`` are those of argparse's ``add_argument``."""

    names: tuple[str, ...]
    help: str
    keywords: Mapping[str, Any] = NOTHING


class OptionGroup(NamedTuple):
    """Options that a help text shows together, under ``title``."""

    title: str
    options: tuple[Option, ...]


class Example(NamedTuple):
    """A command as it is typed, and what it is for."""

    command: str
    about: str = ""


class Command(NamedTuple):
    """A command line: how it is called, what it does, its options, what its exit codes mean.

    ``more`` are paragraphs; one that is indented is shown as it is.
    ``module`` is the one of this folder whose ``run(options)`` does it. ``fail_on`` is the default
    of ``--fail-on``, empty where there are no findings or a configuration decides; with
    ``findings_first`` they are the command's result, which ``-o`` writes.
    """

    name: str
    module: str
    usage: str
    about: str
    examples: tuple[Example, ...]
    groups: tuple[OptionGroup, ...]
    exit_codes: str
    more: str = ""
    fail_on: str = ""
    findings_first: bool = False


def argument(name: str, metavar: str, about: str, nargs: str | None = None) -> Option:
    """A word without a name; ``nargs`` as argparse has it."""
    more = {"nargs": nargs} if nargs else {}
    return Option((name,), about, {"metavar": metavar, **more})


def value(*names: str, metavar: str, about: str, **more: Any) -> Option:
    """An option with one value; ``more`` are further keywords of argparse."""
    return Option(names, about, {"metavar": metavar, **more})


def path_option(name: str, about: str, metavar: str = "FILE") -> Option:
    """An option with the name of a file or folder."""
    return value(name, metavar=metavar, about=about, type=values.path)


def switch(*names: str, about: str) -> Option:
    """An option without a value."""
    return Option(names, about, {"action": "store_true"})


def choice(name: str, metavar: str, known: tuple[str, ...], about: str, **more: Any) -> Option:
    """An option with one of the values that are known."""
    read = {"type": values.one_of(known), "choices": known}
    return Option((name,), about, {"metavar": metavar, **read, **more})


def several(
    name: str,
    metavar: str,
    about: str,
    default: list[str] | None = None,
    read: Callable[[str], list[Any]] = values.names,
) -> Option:
    """An option with a list: commas and repetition mean the same."""
    return Option(
        (name,), about, {"metavar": metavar, "action": "extend", "type": read, "default": default}
    )


def repeated(name: str, metavar: str, about: str) -> Option:
    """An option that is written once for each of its values."""
    return Option(
        (name,), about, {"metavar": metavar, "action": "append", "type": values.path, "default": []}
    )


def each(name: str, metavar: str, about: str) -> Option:
    """An option that is written once for each of several things, in their order; it may be empty."""
    return Option((name,), about, {"metavar": metavar, "action": "append", "default": []})


def output(about: str, **more: Any) -> Option:
    """``-o``; every command has it."""
    text = f"{about}; missing folders are made"
    return value("-o", "--output", metavar="PATH", about=text, type=values.path, **more)


def form(known: tuple[str, ...], about: str) -> Option:
    """``--form``: the shape of a command's result, the first one by default."""
    text = f"{about}: {', '.join(known)}; default: {known[0]}"
    return choice("--form", "FORM", known, text, default=known[0])


def output_group(*options: Option) -> OptionGroup:
    """The options about what is written."""
    return OptionGroup("output", options)
