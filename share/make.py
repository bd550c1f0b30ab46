# SPDX-License-Identifier: Apache-2.0
"""Makes shell completions and manual pages here: ``python share/make.py``.

Needs shtab and argparse-manpage, which the extra ``test`` brings. The files are kept in the
repository, so that no build needs either; a test reports when they are out of date.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from pathlib import Path

import shtab
from argparse_manpage.manpage import Manpage

from multibot_rewrite.cli.declared.commands import COMMANDS, PROGRAMS
from multibot_rewrite.cli.declared.options import Option
from multibot_rewrite.cli.parser import Parser, declare, make_parser
from multibot_rewrite.knowledge.node_sets import every_release
from multibot_rewrite.version import __version__

HERE = Path(__file__).parent
BASH = "bash-completion/completions/{}"
FISH = "fish/vendor_completions.d/{}.fish"
ZSH = "zsh/site-functions/_{}"
MAN = "man/man1/{}.1"
ABOUT = "Many robots in one ROS 2 system: rewrite, plan, build and check a fleet."
# What an argument called so is completed with.
NODE_SET, NODE_SETS = "--node-set", tuple(every_release().node_sets)
COMPLETED = dict.fromkeys(("FILE", "PATH", "INPUT", "PLAN", "FLEET", "FILE:LINE"), shtab.FILE)


def made() -> dict[str, str]:
    """Every file, by its path below this folder."""
    parsers = {
        "multibot": multibot,
        **{name: lambda it=it: make_parser(it) for name, it in PROGRAMS.items()},
    }
    files = {}
    for name, parser in parsers.items():
        files[BASH.format(name)] = shtab.complete(completed(parser()), "bash")
        files[FISH.format(name)] = fish(name)
        files[ZSH.format(name)] = shtab.complete(completed(parser()), "zsh")
    for page in pages():
        files[MAN.format(page.prog)] = manual(page)
    return {path: f"{text.rstrip()}\n" for path, text in files.items()}


def fish(program: str) -> str:
    """Completions for fish, which shtab does not make."""
    lines = ["# Made by share/make.py.", f"complete -c {program} -l version -d 'show the version'"]
    for it in [PROGRAMS[program]] if program in PROGRAMS else COMMANDS.values():
        below = f" -n '__fish_seen_subcommand_from {it.name}'" * (program != it.name)
        if below:
            first = f"complete -c {program} -n __fish_use_subcommand -f -a {it.name}"
            lines.append(f"{first} -d {quoted(it.about)}")
        every = (one for group in it.groups for one in group.options)
        options = (one for one in every if one.names[0].startswith("-"))
        lines += [f"complete -c {program}{below}{fish_option(one)}" for one in options]
    return "\n".join(lines)


def fish_option(option: Option) -> str:
    """Return what fish is told of an option: its names, whether a value follows and which there are."""
    kinds = ((it.lstrip("-"), "l" if it.startswith("--") else "s") for it in option.names)
    names = "".join(f" -{kind} {it}" for it, kind in kinds)
    known = NODE_SETS if NODE_SET in option.names and "action" in option.keywords else ()
    choices = option.keywords.get("choices", known)
    value = " -r" * ("metavar" in option.keywords)
    one_of = f" -f -a {quoted(' '.join(choices))}" * bool(choices)
    return f"{names}{value}{one_of} -d {quoted(option.help.partition(';')[0])}"


def quoted(text: str) -> str:
    """Return a word for fish."""
    return "'" + " ".join(text.split()).replace("\\", "\\\\").replace("'", "\\'") + "'"


def multibot() -> argparse.ArgumentParser:
    """Return the command with all its commands, as nothing but this module needs it."""
    result = Parser(prog="multibot", description=ABOUT)
    result.add_argument("--version", action="version", version=__version__, help="show the version")
    below = result.add_subparsers(metavar="COMMAND", dest="command")
    for command in COMMANDS.values():
        declare(below.add_parser(command.name, help=command.about, add_help=False), command)
    return result


def completed(parser: argparse.ArgumentParser) -> argparse.ArgumentParser:
    """Return the same, with names of files or node sets where needed; a new set is named freely."""
    for action in parser._actions:
        if NODE_SET in action.option_strings and isinstance(action.default, list):
            action.choices = NODE_SETS
        if action.metavar in COMPLETED and not action.choices:
            action.complete = COMPLETED[action.metavar]  # type: ignore[attr-defined]
        if isinstance(action, argparse._SubParsersAction):
            for one in action.choices.values():
                completed(one)
    return parser


def pages() -> Iterator[argparse.ArgumentParser]:
    """Yield what has a manual page of its own: each program, and each command as ``multibot-NAME``."""
    yield Parser(prog="multibot", usage="multibot COMMAND [options]", description=_overview())
    yield from map(make_parser, PROGRAMS.values())
    for command in COMMANDS.values():
        page = make_parser(command, f"multibot-{command.name}")
        page.usage = command.usage.replace("%(prog)s", f"multibot {command.name}")
        yield page


def _overview() -> str:
    rows = [f"multibot {it.name}: {it.about}" for it in COMMANDS.values()]
    return "\n\n".join((ABOUT, *rows, "Each has a page of its own: man multibot-build."))


def manual(parser: argparse.ArgumentParser) -> str:
    """Return a page in the language of man; without a date, which would change every day."""
    about = str(parser.description).partition("\n")[0]
    known = {"project_name": "multibot_rewrite", "version": __version__, "date": " "}
    page = Manpage(parser, {**known, "description": about, "manual_title": "multibot_rewrite"})
    return str(page)


if __name__ == "__main__":
    for path, text in made().items():
        target = HERE / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text)
    sys.exit()
