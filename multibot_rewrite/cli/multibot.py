"""``multibot``: the commands around the rewrite, one module each."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence
from functools import partial
from typing import NamedTuple

from multibot_rewrite import __version__
from multibot_rewrite.cli import check, coverage, learn, plan, rehearse, remap, snapshot, vocabulary
from multibot_rewrite.cli.process import PROGRAM, Parser, guarded


class Command(NamedTuple):
    """``multibot NAME``: how its options are declared, and what runs it to an exit code."""

    name: str
    about: str
    options: Callable[[argparse.ArgumentParser], None]
    run: Callable[[argparse.Namespace], int]


COMMANDS = (
    Command("check", check.ABOUT, check.options, check.run),
    Command("coverage", coverage.ABOUT, coverage.options, coverage.run),
    Command("learn", learn.ABOUT, learn.options, learn.run),
    Command("plan", plan.ABOUT, plan.options, plan.run),
    Command("rehearse", rehearse.ABOUT, rehearse.options, rehearse.run),
    Command("remap", remap.ABOUT, remap.options, remap.run),
    Command("snapshot", snapshot.ABOUT, snapshot.options, snapshot.run),
    Command("vocabulary", vocabulary.ABOUT, vocabulary.options, vocabulary.run),
)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command; returns the exit code."""
    return guarded(PROGRAM, partial(_run, arguments), own_process=arguments is None)


def _run(arguments: Sequence[str] | None) -> int:
    options = parser().parse_args(arguments)
    code: int = options.run(options)
    return code


def parser() -> argparse.ArgumentParser:
    """The command line; what it cannot read ends the process with one line."""
    result = Parser(prog=PROGRAM, description="Commands around urdf-postfix.", allow_abbrev=False)
    result.add_argument("--version", action="version", version=f"%(prog)s {__version__}")
    below = result.add_subparsers(metavar="COMMAND", dest="command", required=True)
    for command in COMMANDS:
        one = below.add_parser(
            command.name,
            help=command.about,
            description=command.about,
            formatter_class=argparse.RawDescriptionHelpFormatter,
            allow_abbrev=False,
        )
        command.options(one)
        one.set_defaults(run=command.run)
    return result


if __name__ == "__main__":
    sys.exit(main())
