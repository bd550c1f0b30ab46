# SPDX-License-Identifier: Apache-2.0
"""Options and commands as data, and the kinds of options that the pages next to this module have.

A kind is a function: first what the option is for, then the words behind its kind in the page. This
module and the reader of the pages import nothing heavy: a help text is made of them alone.
"""

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

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
    ``module`` is the one of ``cli`` whose ``run(options)`` does it. ``fail_on`` is the default
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

    def option(self, name: str) -> Option:
        """Return the option of that name; raises StopIteration where it has none."""
        every = (it for group in self.groups for it in group.options)
        return next(it for it in every if name in it.names)


def argument(about: str, name: str, metavar: str, nargs: str = "", default: str = "") -> Option:
    """Return a positional argument; ``nargs`` is that of argparse."""
    more = {"nargs": nargs} if nargs else {}
    return _option(name, about, metavar, **more, **({"default": default} if default else {}))


def value(about: str, name: str, metavar: str, read: str = "") -> Option:
    """Return an option with one value, which a function of ``values`` reads."""
    more = {"type": getattr(values, read)} if read else {}
    return _option(name, about, metavar, **more)


def path(about: str, name: str, metavar: str) -> Option:
    """Return an option with the name of a file or folder."""
    return value(about, name, metavar, "path")


def switch(about: str, name: str) -> Option:
    """Return an option without a value."""
    return Option(tuple(name.split(",")), about, {"action": "store_true"})


def choice(about: str, name: str, metavar: str, known: str, default: str = "") -> Option:
    """Return an option with one of the known values, ``a|b``."""
    words = tuple(known.split("|"))
    more = {"default": default} if default else {}
    return _option(name, about, metavar, type=values.one_of(words), choices=words, **more)


def several(about: str, name: str, metavar: str, read: str = "names", unset: str = "") -> Option:
    """Return an option with a list, by commas or repetition; with ``unset`` its default is None."""
    default: list[str] | None = None if unset else []
    return _option(
        name, about, metavar, action="extend", type=getattr(values, read), default=default
    )


def some(about: str, name: str, metavar: str, known: str) -> Option:
    """Return an option with a list of some of the known values, ``a|b``."""
    read = values.some_of(tuple(known.split("|")))
    return _option(name, about, metavar, action="extend", type=read, default=[])


def each(about: str, name: str, metavar: str) -> Option:
    """Return an option that is written once for each of several things, in order; it may be empty."""
    return _option(name, about, metavar, action="append", default=[])


def sources(about: str, name: str, metavar: str) -> Option:
    """Return the option for where a graph comes from; read by ``cli/live.py``."""
    return _option(
        name, about, metavar, dest="sources", action="append", type=values.source, default=[]
    )


def launch(about: str, name: str, metavar: str) -> Option:
    """Return an option with a launch file and its arguments in one value; it may be repeated."""
    words = metavar.replace("_", " ")
    return _option(name, about, words, action="append", type=values.path, default=[])


def launch_words(about: str, name: str, metavar: str) -> Option:
    """Return an option that takes a launch file and its arguments."""
    return _option(name, about, metavar.replace("_", " "), nargs="+", default=[])


def output(about: str, default: str = "") -> Option:
    """Return the option ``-o``; every command has it."""
    more = {"default": default} if default else {}
    text = f"{about}; missing folders are made"
    return _option("-o,--output", text, "PATH", type=values.path, **more)


def output_kind(about: str, known: str) -> Option:
    """Return the option ``--output-kind``: the kind of a command's result, the first one by default."""
    first, *_ = words = known.split("|")
    text = f"{about}: {', '.join(words)}; default: {first}"
    return choice(text, "--output-kind", "KIND", known, first)


def _option(names: str, about: str, metavar: str, **more: Any) -> Option:
    return Option(tuple(names.split(",")), about, {"metavar": metavar, **more})


KINDS: Mapping[str, Callable[..., Option]] = {
    it.__name__: it
    for it in (
        *(argument, value, path, switch, choice, several, some, each),
        *(sources, launch, launch_words, output, output_kind),
    )
}
