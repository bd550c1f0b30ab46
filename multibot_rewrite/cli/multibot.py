# SPDX-License-Identifier: Apache-2.0
"""``multibot``: the commands around the rewrite; ``dispatch`` runs them."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from functools import partial

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.nearest import ALIKE, did_you_mean_one_of
from multibot_rewrite.cli.declared.commands import COMMANDS
from multibot_rewrite.cli.declared.options import Command
from multibot_rewrite.cli.output import AUTO, is_coloured, print_bytes
from multibot_rewrite.cli.parser import painted
from multibot_rewrite.cli.process import DONE, PROGRAM, guarded, start
from multibot_rewrite.version import __version__

# The same as --help behind the next word.
HELP_WORD = "help"
HELP, VERSION = ("-h", "--help"), ("-V", "--version")


def run(words: Sequence[str]) -> int:
    """Run the command of the first word; returns the exit code, raises UsageError."""
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
        raise UsageError(f"{word}: write the command first, for example: {_with_option(word)}")
    from multibot_rewrite.base.nearest import other_words  # a mistake alone needs it

    if meant := other_words("commands").get(word):
        raise UsageError(f"there is no command {word!r}; use {meant}")
    near = did_you_mean_one_of(word, COMMANDS, ALIKE)
    raise UsageError(f"unknown command {word!r}; {near or 'see multibot --help'}")


def _with_option(word: str) -> str:
    """Return a command line with the option, for the first command that has it."""
    option = word.partition("=")[0]
    groups = ((it, group) for it in COMMANDS.values() for group in it.groups)
    has = (it for it, group in groups if any(option in one.names for one in group.options))
    command = next(has, None)
    return f"multibot {command.name} {word}" if command else "multibot check"


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


if __name__ == "__main__":
    sys.exit(main())
