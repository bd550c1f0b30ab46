# SPDX-License-Identifier: Apache-2.0
"""A command as argparse reads it: options in groups, help with an example first, "did you mean"."""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Collection, Sequence
from functools import partial
from itertools import pairwise, takewhile
from typing import NoReturn

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.base.wording import one_line
from multibot_rewrite.cli.declared.options import Command, Example, OptionGroup
from multibot_rewrite.cli.output import AUTO, is_coloured
from multibot_rewrite.cli.values import SOURCES
from multibot_rewrite.version import __version__

UNUSABLE = 2
# A short help fits a terminal of this size.
ROWS, COLUMNS = 24, 80
# Help is not wider than this, however wide the terminal: long lines are hard to read.
WIDEST = 120
_HEADING = lazy_compile(r"^([a-z][^\n:]*:)(?=$| )", re.MULTILINE)
_NAME = lazy_compile(r"^(  (?:-\w, )?--[\w-]+)", re.MULTILINE)
# A word that is meant as an option: -0.5 is a number, and what has a space is a value.
_OPTION = lazy_compile(r"--?[A-Za-z][^\s=]*(=.*)?", re.DOTALL)


class Parser(argparse.ArgumentParser):
    """Reports a mistake in one line, with the nearest word that is known."""

    colour = AUTO
    short = ""

    def error(self, message: str) -> NoReturn:
        """Exit with a usage error in one line."""
        self.exit(UNUSABLE, f"{self.prog}: {one_line(message)}; see {self.prog} --help\n")

    def format_help(self) -> str:
        """Return the help text, as wide as the terminal."""
        import shutil  # only a help text needs the terminal's width

        width = min(shutil.get_terminal_size().columns, WIDEST)
        self.formatter_class = partial(_Formatter, width=width)
        return painted(super().format_help(), is_coloured(self.colour, sys.stdout))

    def known(self) -> list[str]:
        """Return the names of all options."""
        return [name for action in self._actions for name in action.option_strings]

    def arguments(self) -> list[str]:
        """Return the names of all arguments without a dash."""
        return [action.dest for action in self._actions if not action.option_strings]


class _Short(argparse.Action):
    """``-h``: the help that fits a screen."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        assert isinstance(parser, Parser)
        parser._print_message(
            painted(parser.short, is_coloured(parser.colour, sys.stdout)), sys.stdout
        )
        parser.exit()


class _Formatter(argparse.RawDescriptionHelpFormatter):
    """``-o, --output PATH`` on one line, the same in every release of Python."""

    def _format_action_invocation(self, action: argparse.Action) -> str:
        if not action.option_strings or action.nargs == 0:
            return super()._format_action_invocation(action)
        value = self._format_args(action, str(action.metavar))
        return f"{', '.join(action.option_strings)} {value}"


# argparse asks for a formatter at every option; a given width spares it the import of shutil.
_plain = partial(_Formatter, width=96)


def painted(text: str, colour: bool) -> str:
    """Return a help text with bold headings and coloured names of options."""
    if not colour:
        return text
    return _NAME.sub("\033[36m\\1\033[0m", _HEADING.sub("\033[1m\\1\033[0m", text))


def make_parser(command: Command, prog: str = "") -> Parser:
    """Return the parser of a command; ``prog`` is the name it is called by, if not its own."""
    result = Parser(
        prog=prog or command.name,
        usage=command.usage,
        formatter_class=_plain,
        allow_abbrev=False,
        add_help=False,
    )
    declare(result, command)
    return result


def declare(parser: Parser, command: Command) -> None:
    """Give a parser the options and the help text of a command."""
    parser.short = short_help(command, parser.prog)
    head = [command.about, "examples:\n" + "\n".join(map(_example_text, command.examples))]
    more = command.more.split("\n\n") if command.more else ()
    head += (it if it.startswith("  ") else wrapped(it) for it in more)
    parser.description = "\n\n".join(head)
    parser.epilog = "exit codes:\n  " + command.exit_codes.replace("; ", "\n  ")
    for group in command.groups:
        section = parser.add_argument_group(group.title)
        for option in group.options:
            text = option.help.replace("%", "%%")
            made = section.add_argument(*option.names, help=text, **option.keywords)
            if made.nargs == argparse.ZERO_OR_MORE:
                made.required = False  # else a message about another one asks for it, too
    general = parser._action_groups[-1]
    version = f"{parser.prog} {__version__}"
    general.add_argument("--version", action="version", version=version, help="show the version")
    general.add_argument("-h", action=_Short, nargs=0, help="show a short summary")
    general.add_argument("--help", action="help", help="show this help")
    parser.set_defaults(command=command.name, findings_first=command.findings_first)
    if command.fail_on:
        parser.set_defaults(fail_on=command.fail_on)


def short_help(command: Command, prog: str) -> str:
    """Return usage, purpose, examples as far as they fit on a screen, and names of the options."""
    head = [f"usage: {command.usage.replace('%(prog)s', prog)}", "", command.about, ""]
    names = [it for group in command.groups for it in _option_names(group)]
    end = ["", *names, "", f"{prog} --help explains them."]
    fitting = (it for it in map(_fitted, command.examples) if it)
    examples = [*fitting][: ROWS - len(head) - len(end) - 1]
    return "\n".join([*head, "examples:", *examples, *end, ""])


def _fitted(example: Example) -> str:
    """Return an example in one line; empty if the line is too long."""
    lines = (
        f"  {example.command}    # {example.about}" * bool(example.about),
        f"  {example.command}",
    )
    return next((it for it in lines if it and len(it) <= COLUMNS), "")


def _option_names(group: OptionGroup) -> list[str]:
    """Return the options of a group by name, wrapped."""
    title = group.title.partition(",")[0]
    words = [
        it.names[-1] if it.names[0].startswith("-") else it.keywords["metavar"]
        for it in group.options
    ]
    lines = wrapped(f"{title}: {' '.join(words)}", COLUMNS - 2).split("\n")
    return [lines[0], *(f"  {it}" for it in lines[1:])]


def _example_text(example: Example) -> str:
    about = f"    # {example.about}" if example.about else ""
    one = f"  {example.command}{about}"
    return one if len(one) <= 80 or not about else f"  # {example.about}\n  {example.command}"


def wrapped(text: str, width: int = 80) -> str:
    """Return a paragraph in lines of that width."""
    lines = [""]
    for word in text.split():
        if len(lines[-1]) + len(word) >= width:
            lines.append("")
        lines[-1] += f" {word}" if lines[-1] else word
    return "\n".join(lines)


def parsed(parser: Parser, words: Sequence[str]) -> argparse.Namespace:
    """Return the parsed options; a mistake ends the process with one line."""
    parser.colour = _colour_asked(words)
    if wrong := _first_unknown_option(words, parser.known()):
        from multibot_rewrite.cli.hints import option_hint  # a mistake alone needs it

        command = parser.prog.rpartition(" ")[2]
        has_fleet = command == "init" or "fleet" in parser.arguments()
        hint = option_hint(wrong, command, parser.known(), has_fleet)
        parser.error(f"unknown option {wrong}{hint}")
    options, unknown = parser.parse_known_intermixed_args(words)
    if unknown:
        # Is the nearest option before a word one that takes a list?
        word = unknown[0]
        before = words[: words.index(word)] if word in words else words
        name = next((it for it in reversed(before) if it.startswith("-")), "")
        lists = (it for it in parser._actions if isinstance(it, argparse._ExtendAction))
        hint = "; a list is written A,B" if any(name in it.option_strings for it in lists) else ""
        if word.isdigit() and "-n" in parser.known():
            hint = f"; the number of robots is -n {word}"
        what = _kind_of(unknown[0], parser.prog) or f"{' '.join(unknown)}{hint}"
        parser.error(f"unexpected {what}")
    options.program = parser.prog.partition(" ")[0]
    if "sources" in options:
        _set_sources(options)
    return options


def _set_sources(options: argparse.Namespace) -> None:
    """Set the options for a graph's sources by kind; raises UsageError for several kinds."""
    saved, *others = ([it for of, it in options.sources if of == kind] for kind in SOURCES)
    single = [it for its in others for it in its]
    if len(single) + bool(saved) > 1:
        two = " and ".join([*saved[:1], *single][:2])
        raise UsageError(f"--from: {two} are two sources; give one of them")
    options.snapshot, options.bag, options.zenoh = saved, *((its or [None])[0] for its in others)


def _kind_of(word: str, program: str) -> str:
    """Return what a refused file is, and the command that takes it."""
    from multibot_rewrite.base.bounded import read_bytes
    from multibot_rewrite.base.file_kinds import refuse_others

    try:
        refuse_others(read_bytes(word), word)
    except InputError as error:
        return "" if program in str(error) else str(error)
    except (OSError, ValueError):
        return ""
    return ""


def _first_unknown_option(words: Sequence[str], known: Collection[str]) -> str:
    """Return the first option that is not known, without its value; "" where all are known."""
    before_end = takewhile(lambda word: word != "--", words)
    names = (it.partition("=")[0] for it in before_end if _OPTION.fullmatch(it))
    unknown = (it for it in names if it not in known)
    # A short option may have others behind it, or its value, as ``-qv`` or ``-n3``; ``-quiet`` is none.
    return next((it for it in unknown if it[:2] not in known or f"-{it}" in known), "")


def _colour_asked(words: Sequence[str]) -> str:
    """Return the value of ``--color``, which may be behind ``--help``."""
    asked = [it for name, it in pairwise(words) if name == "--color"]
    asked += [it.partition("=")[2] for it in words if it.startswith("--color=")]
    return asked[-1] if asked else AUTO
