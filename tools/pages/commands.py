# SPDX-License-Identifier: Apache-2.0
"""The page of the commands."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.cli.declared.commands import COMMANDS, PROGRAMS
from multibot_rewrite.cli.declared.options import Command, Option
from tools.pages.markdown import ESCAPED

HEAD = """\
# Commands

What `--help` of each command says. Where ROS is sourced, `ros2 multibot` is `multibot`.
"""


def page() -> str:
    """Return the page, Markdown."""
    named = [
        *PROGRAMS.items(),
        *((f"multibot {name}", it) for name, it in COMMANDS.items()),
    ]
    return "\n".join((HEAD, *(line for it in named for line in _command(*it))))


def _paragraphs(text: str) -> Iterator[str]:
    """Paragraphs; one that is indented is code."""
    for it in text.split("\n\n"):
        code = it.startswith("  ")
        lines = it.splitlines() if code else [" ".join(it.translate(ESCAPED).split())]
        yield from (f"  {line}" if code else line for line in lines)
        yield ""


def _command(name: str, command: Command) -> Iterator[str]:
    yield from (f"## {name}", "", command.about, "")
    yield from ("```text", command.usage.replace("%(prog)s", name), "```", "")
    yield from ("```sh", *_examples(command), "```", "")
    if command.more:
        yield from _paragraphs(command.more)
    yield from ("| option | meaning |", "|---|---|")
    for group in command.groups:
        yield f"| **{group.title}** | |"
        yield from map(_row, group.options)
    yield from ("", f"Exit codes: {command.exit_codes.translate(ESCAPED)}.", "")


def _examples(command: Command) -> Iterator[str]:
    for it in command.examples:
        yield f"{it.command}{'    # ' * bool(it.about)}{it.about}"


def _row(option: Option) -> str:
    metavar = option.keywords.get("metavar", "")
    named = option.names[0].startswith("-")
    words = f"{', '.join(option.names)} {metavar}".strip() if named else metavar
    return f"| `{words}` | {' '.join(option.help.translate(ESCAPED).split())} |"
