"""``multibot``: the commands around the rewrite, one module of ``cli`` each.

A module has ``options(parser)``, which declares its options, and ``run(options)``, which gives the
exit code. Only the one that is called is imported: all of them cost more than most runs.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from functools import partial
from importlib import import_module
from types import MappingProxyType
from typing import Any

from multibot_rewrite.cli.process import PROGRAM, Parser, guarded
from multibot_rewrite.version import __version__

COMMANDS = MappingProxyType(
    {
        "build": "everything a fleet needs, from its fleet file",
        "check": "is the running system what was planned?",
        "coverage": "how much of a set of descriptions is known, and what is not",
        "learn": "nodes and stacks for remap and plan, from nodes that are running now",
        "plan": "what the graph of a fleet is to look like",
        "rehearse": "try a fleet's plan on a real graph, without robot or simulator",
        "remap": "what every node of every robot must be remapped to",
        "snapshot": "what runs in the ROS graph now: nodes, endpoints, tf, environment",
        "vocabulary": "what is known of a plugin, hardware class or element",
    }
)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command; returns the exit code."""
    given = sys.argv[1:] if arguments is None else arguments
    return guarded(PROGRAM, partial(_run, given), own_process=arguments is None)


def _run(arguments: Sequence[str]) -> int:
    name = next((word for word in arguments if word in COMMANDS), "")
    module: Any = import_module(f"{__package__}.{name}") if name else None
    options = parser(name, module).parse_args(arguments)
    code: int = module.run(options)
    return code


def parser(called: str, module: Any) -> argparse.ArgumentParser:
    """The command line, with the options of the command that is ``called``; what it cannot read
    ends the process with one line."""
    result = Parser(prog=PROGRAM, description="Commands around urdf-postfix.", allow_abbrev=False)
    result.add_argument("--version", action="version", version=f"%(prog)s {__version__}")
    below = result.add_subparsers(metavar="COMMAND", dest="command", required=True)
    for name, about in COMMANDS.items():
        one = below.add_parser(
            name,
            help=about,
            description=about,
            formatter_class=argparse.RawDescriptionHelpFormatter,
            allow_abbrev=False,
        )
        if name == called:
            module.options(one)
    return result


if __name__ == "__main__":
    sys.exit(main())
