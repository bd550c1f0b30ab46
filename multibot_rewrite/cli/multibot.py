# SPDX-License-Identifier: Apache-2.0
"""``multibot``: the commands around the rewrite; ``dispatch`` runs them."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from functools import partial

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.nearest import ALIKE, did_you_mean_one_of
from multibot_rewrite.cli.declared.commands import COMMANDS, PROGRAMS
from multibot_rewrite.cli.declared.options import Command
from multibot_rewrite.cli.output import AUTO, is_coloured, print_bytes
from multibot_rewrite.cli.parser import painted
from multibot_rewrite.cli.process import DONE, PROGRAM, guarded, start
from multibot_rewrite.version import __version__

# The same as --help behind the next word.
HELP_WORD = "help"
HELP, VERSION = ("-h", "--help"), ("-V", "--version")


def run(words: Sequence[str]) -> int:
    """Run the command that is named first; returns the exit code, raises UsageError."""
    if not words:
        raise UsageError(f"no COMMAND given, use one of {', '.join(COMMANDS)}")
    first, *others = words
    if first in HELP:
        print_bytes(overview(AUTO).encode())
        return DONE
    if first in VERSION:
        print_bytes(f"{PROGRAM} {__version__}\n".encode())
        return DONE
    if first == HELP_WORD:
        return run([*others[:1], HELP[-1], *others[1:]])
    command = find_command(first)
    return start(command, others, f"{PROGRAM} {command.name}")


def find_command(word: str) -> Command:
    """Return the command of that name; raises UsageError with the nearest one."""
    if word in COMMANDS:
        return COMMANDS[word]
    if word.startswith("-"):
        raise UsageError(f"{word}: write the command first, for example: {_command_with(word)}")
    from multibot_rewrite.base.nearest import other_words  # a mistake alone needs it

    if meant := other_words("commands").get(word):
        raise UsageError(f"there is no command {word!r}; use {meant}")
    near = did_you_mean_one_of(word, COMMANDS, ALIKE)
    raise UsageError(f"unknown command {word!r}; {near or 'see multibot --help'}")


def _command_with(word: str) -> str:
    """Return a command line with the option, for the first command that has it."""
    from multibot_rewrite.cli.hints import commands_of  # a mistake alone needs it

    found = (it for it in commands_of().get(word.partition("=")[0], ()) if it not in PROGRAMS)
    return next((f"{it} {word}" for it in found), "multibot check")


def overview(colour: str) -> str:
    """Return the help of ``multibot`` itself."""
    rows = [f"  {it.name:<14}{it.about}" for it in COMMANDS.values()]
    text = "\n".join(
        (
            "usage: multibot COMMAND [options]",
            "Many robots in one ROS 2 system: rewrite, plan, build and check a fleet.",
            "",
            "examples:",
            "  multibot init rover.urdf",
            "  multibot build fleet.yaml",
            "",
            "commands:",
            *rows,
            "",
            "multibot COMMAND -h shows more. Also: urdf-postfix, urdf-lint.",
            "",
        )
    )
    return painted(text, is_coloured(colour, sys.stdout))


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command; returns the exit code."""
    words = sys.argv[1:] if arguments is None else arguments
    return guarded(PROGRAM, partial(run, words), own_process=arguments is None)


class MultibotCommand:
    """Many robots in one ROS 2 system: rewrite, plan, build and check a fleet."""

    # ros2cli finds the class by the entry point group ros2cli.command, makes one, sets NAME and calls
    # it; it asks for no base class (ros2cli jazzy, ros2cli/command/__init__.py and ros2cli/cli.py).
    NAME = "multibot"

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        """Accept all arguments: the command that is called checks them."""
        parser.add_argument("--version", action="version", version=f"multibot {__version__}")
        parser.add_argument("command", metavar="COMMAND", choices=tuple(COMMANDS), help="see below")
        parser.add_argument("words", metavar="...", nargs=argparse.REMAINDER, help="its arguments")
        rows = [f"  {name:<12}{it.about}" for name, it in COMMANDS.items()]
        more = f"\n\n{cli_name} COMMAND --help shows the options of each"
        parser.epilog = "commands:\n" + "\n".join(rows) + more

    def main(self, *, parser: argparse.ArgumentParser, args: argparse.Namespace) -> int:
        """Run the command; returns its exit code."""
        return main([args.command, *args.words])


if __name__ == "__main__":
    sys.exit(main())
