# SPDX-License-Identifier: Apache-2.0
"""``ros2 multibot ...``: the commands of ``multibot`` under the command that ROS users have.

ros2cli finds the class by the entry point group ``ros2cli.command``, makes one and calls it; it asks
for no base class. Source: ros2cli jazzy (``ros2cli/command/__init__.py``, ``ros2cli/cli.py``).
"""

from __future__ import annotations

import argparse

from multibot_rewrite.cli.declared.commands import COMMANDS
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.version import __version__


class MultibotCommand:
    """Many robots in one ROS 2 system: rewrite, plan, build and check a fleet."""

    # Set by ros2cli to the name of the entry point.
    NAME = "multibot"

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        """Take every word as it is: the command that is called knows its own options."""
        parser.add_argument("--version", action="version", version=f"multibot {__version__}")
        parser.add_argument("command", metavar="COMMAND", choices=tuple(COMMANDS), help="see below")
        parser.add_argument("words", metavar="...", nargs=argparse.REMAINDER, help="its arguments")
        rows = [f"  {name:<12}{it.about}" for name, it in COMMANDS.items()]
        more = f"\n\n{cli_name} COMMAND --help shows the options of each"
        parser.epilog = "commands:\n" + "\n".join(rows) + more

    def main(self, *, parser: argparse.ArgumentParser, args: argparse.Namespace) -> int:
        """Run the command; returns its exit code."""
        return main([args.command, *args.words])
