"""Options as data, and those that several commands share: each means the same everywhere.

This module and ``commands`` import nothing heavy: a help text is made of them alone.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

from multibot_rewrite.cli import values
from multibot_rewrite.findings.finding import LEVELS
from multibot_rewrite.findings.formats import FORMATS
from multibot_rewrite.naming import (
    DEFAULT_LAYOUT,
    LAYOUTS,
    SEPARATORS,
    SHARED_FRAMES,
    SHARED_TOPICS,
)

NOTHING: Mapping[str, Any] = MappingProxyType({})


class Option(NamedTuple):
    """An option or argument; ``keywords`` are those of argparse's ``add_argument``."""

    names: tuple[str, ...]
    help: str
    keywords: Mapping[str, Any] = NOTHING


class Group(NamedTuple):
    """Options that a help text shows together, under ``title``."""

    title: str
    options: tuple[Option, ...]


class Example(NamedTuple):
    """A command as it is typed, and what it is for."""

    command: str
    about: str = ""


class Command(NamedTuple):
    """A command line: how it is called, what it does, its options, what its exit codes mean.

    ``module`` is the one of this folder whose ``run(options)`` does it. ``fail_on`` is the default
    of ``--fail-on``, empty where there are no findings or a configuration decides; with
    ``findings_first`` they are the command's result, which ``-o`` writes.
    """

    name: str
    module: str
    usage: str
    about: str
    examples: tuple[Example, ...]
    groups: tuple[Group, ...]
    exit_codes: str
    more: str = ""
    fail_on: str = ""
    findings_first: bool = False


def argument(name: str, metavar: str, about: str, nargs: str | None = None) -> Option:
    """A word without a name; ``nargs`` as argparse has it."""
    more = {"nargs": nargs} if nargs else {}
    return Option((name,), about, {"metavar": metavar, **more})


def value(*names: str, metavar: str, about: str, **more: Any) -> Option:
    """An option with one value; ``more`` are further keywords of argparse."""
    return Option(names, about, {"metavar": metavar, **more})


def switch(*names: str, about: str) -> Option:
    """An option without a value."""
    return Option(names, about, {"action": "store_true"})


def choice(name: str, metavar: str, known: tuple[str, ...], about: str, **more: Any) -> Option:
    """An option with one of the values that are known."""
    read = {"type": values.one_of(known), "choices": known}
    return Option((name,), about, {"metavar": metavar, **read, **more})


def several(
    name: str,
    metavar: str,
    about: str,
    default: list[str] | None = None,
    read: Callable[[str], list[str]] = values.names,
) -> Option:
    """An option with a list: commas and repetition mean the same."""
    return Option(
        (name,), about, {"metavar": metavar, "action": "extend", "type": read, "default": default}
    )


def output(about: str, **more: Any) -> Option:
    """``-o``; every command has it."""
    text = f"{about}; missing folders are made"
    return value("-o", "--output", metavar="PATH", about=text, type=values.path, **more)


_LAYOUTS = ", ".join(f"{it.name} ({it.short}: {it.about})" for it in LAYOUTS)
_LAYOUT_NAMES = tuple(name for it in LAYOUTS for name in (it.name, it.short))
_SEPARATORS = " ".join(f"{kind}={mark}" for kind, mark in SEPARATORS.items())

NAMING = Group(
    "how names become a robot's own (the options a description was rewritten with)",
    (
        choice("--layout", "NAME", _LAYOUT_NAMES, f"{_LAYOUTS}; default: {DEFAULT_LAYOUT}"),
        choice(
            "--affix",
            "SIDE",
            ("postfix", "prefix"),
            "the robot's name goes behind names (postfix, the default) or in front (prefix)",
        ),
        choice(
            "--topics",
            "HOW",
            ("postfix", "prefix", "namespace"),
            "postfix, prefix or namespace; default: what the layout implies",
        ),
        several(
            "--separator",
            "KIND=SEP",
            "what stands between a name and the robot's; SEP alone is for all names of the"
            f" description, not for ROS nodes and topics; defaults: {_SEPARATORS}",
            [],
        ),
        several(
            "--shared-frames",
            "A,B",
            f"frames that all robots share; default: {','.join(SHARED_FRAMES)}",
        ),
        several(
            "--shared-topics",
            "A,B",
            f"topics that all robots share; default: {','.join(SHARED_TOPICS)}",
        ),
        choice(
            "--groups",
            "HOW",
            ("keep", "rename"),
            "groups and end effectors of an SRDF: keep (default) or rename",
        ),
    ),
)
ROBOTS = several("--robots", "A,B", "names of robots", [])
VOCABULARY = several(
    "--vocabulary", "FILE", "what more plugins mean by their parameters (docs/add-a-plugin.md)", []
)
URDF = value("--urdf", metavar="FILE", about="the URDF that an SRDF belongs to", type=values.path)
FINDINGS = Group(
    "findings",
    (
        several("--select", "CODES", "only these codes, or codes that begin so: MB2,MG102", []),
        several("--ignore", "CODES", "not these; the longer of two that match wins", []),
        choice(
            "--fail-on",
            "LEVEL",
            LEVELS,
            "the lowest level that makes the exit code 1: error (default; urdf-lint: warning),"
            " warning or note",
        ),
        choice(
            "--format",
            "FORMAT",
            tuple(FORMATS),
            f"how findings are written: {', '.join(FORMATS)}; default: text",
            default="text",
        ),
    ),
)
GENERAL = Group(
    "general",
    (
        switch("-q", "--quiet", about="findings and errors only: no summary, no notes"),
        switch(
            "-v",
            "--verbose",
            about="each robot's findings by themselves, the files written, the time it took",
        ),
        choice(
            "--color",
            "WHEN",
            ("auto", "always", "never"),
            "auto (default: on a terminal, unless NO_COLOR is set), always or never",
            default="auto",
        ),
    ),
)
LIVE = Group(
    "live graph",
    (
        value(
            "--timeout",
            metavar="S",
            about="look S seconds (default: 15)",
            type=values.seconds,
        ),
        value(
            "--domain",
            metavar="N",
            about=f"instead of ROS_DOMAIN_ID, 0 to {values.MAX_DOMAIN}",
            type=values.domain,
        ),
    ),
)


def form(known: tuple[str, ...], about: str) -> Option:
    """``--form``: the shape of a command's result, the first one by default."""
    text = f"{about}: {', '.join(known)}; default: {known[0]}"
    return choice("--form", "FORM", known, text, default=known[0])
