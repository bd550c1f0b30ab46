"""``multibot help [COMMAND]``."""

from __future__ import annotations

import argparse

from multibot_rewrite.cli.output import print_bytes
from multibot_rewrite.cli.process import DONE


def run(options: argparse.Namespace) -> int:
    """Print the help of a command, or the list of commands; returns the exit code."""
    from multibot_rewrite.cli.dispatch import find_command, overview
    from multibot_rewrite.cli.parser import make_parser

    if not options.words:
        print_bytes(overview(options.color).encode())
        return DONE
    command = find_command(options.words[0])
    parser = make_parser(command, f"multibot {command.name}")
    parser.colour = options.color
    print_bytes(parser.format_help().encode())
    return DONE
