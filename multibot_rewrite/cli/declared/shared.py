# SPDX-License-Identifier: Apache-2.0
"""Options and commands as data, how they are written down, and the options that several commands share:
each means the same everywhere.

This module and those beside it import nothing heavy: a help text is made of them alone.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

from multibot_rewrite.base.conventions import SHARED_TOPICS, WORLD_FRAMES
from multibot_rewrite.base.findings.finding import LEVELS
from multibot_rewrite.base.findings.formats import FORMATS
from multibot_rewrite.base.naming import DEFAULT_LAYOUT, LAYOUTS, SEPARATORS
from multibot_rewrite.base.releases import NEWEST_LTS, RELEASES, VARIABLE
from multibot_rewrite.cli import values

NOTHING: Mapping[str, Any] = MappingProxyType({})


class Option(NamedTuple):
    """An option or argument; ``keywords`` are those of argparse's ``add_argument``."""

    names: tuple[str, ...]
    help: str
    keywords: Mapping[str, Any] = NOTHING


class OptionGroup(NamedTuple):
    """Options that a help text shows together, under ``title``."""

    title: str
    options: tuple[Option, ...]


class Example(NamedTuple):
    """A command as it is typed, and what it is for."""

    command: str
    about: str = ""


class Command(NamedTuple):
    """A command line: how it is called, what it does, its options, what its exit codes mean.

    ``more`` are paragraphs; one that is indented is shown as it is.
    ``module`` is the one of this folder whose ``run(options)`` does it. ``fail_on`` is the default
    of ``--fail-on``, empty where there are no findings or a configuration decides; with
    ``findings_first`` they are the command's result, which ``-o`` writes.
    """

    name: str
    module: str
    usage: str
    about: str
    examples: tuple[Example, ...]
    groups: tuple[OptionGroup, ...]
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


def path_option(name: str, about: str, metavar: str = "FILE") -> Option:
    """An option with the name of a file or folder."""
    return value(name, metavar=metavar, about=about, type=values.path)


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
    read: Callable[[str], list[Any]] = values.names,
) -> Option:
    """An option with a list: commas and repetition mean the same."""
    return Option(
        (name,), about, {"metavar": metavar, "action": "extend", "type": read, "default": default}
    )


def repeated(name: str, metavar: str, about: str) -> Option:
    """An option that is written once for each of its values."""
    return Option(
        (name,), about, {"metavar": metavar, "action": "append", "type": values.path, "default": []}
    )


def each(name: str, metavar: str, about: str) -> Option:
    """An option that is written once for each of several things, in their order; it may be empty."""
    return Option((name,), about, {"metavar": metavar, "action": "append", "default": []})


def output(about: str, **more: Any) -> Option:
    """``-o``; every command has it."""
    text = f"{about}; missing folders are made"
    return value("-o", "--output", metavar="PATH", about=text, type=values.path, **more)


def form(known: tuple[str, ...], about: str) -> Option:
    """``--form``: the shape of a command's result, the first one by default."""
    text = f"{about}: {', '.join(known)}; default: {known[0]}"
    return choice("--form", "FORM", known, text, default=known[0])


def output_group(*options: Option) -> OptionGroup:
    """The options about what is written."""
    return OptionGroup("output", options)


_LAYOUTS = "; ".join(f"{it.name} ({it.short}): {it.about}" for it in LAYOUTS)
LAYOUT_NAMES = tuple(name for it in LAYOUTS for name in (it.name, it.short))
_SEPARATORS = " ".join(f"{kind}={mark}" for kind, mark in SEPARATORS.items())

NAMING = OptionGroup(
    "names of a robot",
    (
        choice("--layout", "NAME", LAYOUT_NAMES, f"{_LAYOUTS}; default: {DEFAULT_LAYOUT}"),
        choice(
            "--affix",
            "SIDE",
            ("postfix", "prefix"),
            "put the robot's name after each name (postfix, the default) or before it (prefix)",
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
            "separator between a name and the robot's name; without KIND it is for all names of the"
            " description, not for ROS nodes and topics; group=SEP also renames the groups of an"
            f" SRDF; defaults: {_SEPARATORS}",
            [],
        ),
        several(
            "--shared",
            "FRAME,/TOPIC",
            "frames, and topics (with a slash in front), that all robots share; default:"
            f" {', '.join((*WORLD_FRAMES, *SHARED_TOPICS))}",
            [],
        ),
    ),
)
ROBOTS = several("--robots", "A,B", "names of robots", [])
COUNT = value(
    *("-n", "--count"),
    metavar="COUNT",
    about="number of robots, called robot1, robot2 and so on; of a fleet file the first ones, or more"
    " like the last one",
    type=values.count,
)
VOCABULARY = several(
    "--vocabulary",
    "FILE",
    "file with more plugin definitions: which parameters are names (docs/add-a-plugin.md)",
    [],
)
EVERYTHING = switch(
    "--no-default-excludes",
    about="in folders, also read build/, install/, log/, folders with COLCON_IGNORE or AMENT_IGNORE,"
    " and files that git ignores",
)
URDF = path_option("--urdf", "the URDF that an SRDF or another related file is for")
DISTRO = choice(
    "--distro",
    "NAME",
    RELEASES,
    f"the ROS 2 release that the robots run: {', '.join(RELEASES)}; default: that of the fleet file"
    f" or configuration, then {VARIABLE}, then {NEWEST_LTS}",
)
TRUST = switch(
    "--trust",
    about="run xacro and launch files without the sandbox; in it they can only compute and read files"
    " of their own package or repository (SECURITY.md)",
)
KNOWN_NODES = (
    several(
        "--nodes",
        "PATH",
        "YAML file with your own nodes and stacks; or NoDL files, or folders of them, in addition to"
        " those of installed packages (none: use no NoDL)",
        [],
    ),
)
ROOTS = several(
    *("--roots", "A,B", "folders to search for packages, in addition to the installed ones", []),
    read=values.folders,
)
FINDINGS = OptionGroup(
    "findings",
    (
        several(
            "--select",
            "CODES",
            "report only these rules: codes, beginnings of codes, or names; for example MB2,MG102",
            [],
        ),
        several(
            "--ignore",
            "CODES",
            "do not report these; if --select has the rule, too, the longer entry wins",
            [],
        ),
        choice(
            "--fail-on",
            "LEVEL",
            LEVELS,
            "exit with 1 if a finding has this level or a worse one: error (default; urdf-lint:"
            " warning), warning (also if something could not be verified) or note",
        ),
        choice(
            "--format",
            "FORMAT",
            tuple(FORMATS),
            f"output format of findings: {', '.join(FORMATS)}; default: text",
            default="text",
        ),
    ),
)
GENERAL = OptionGroup(
    "general",
    (
        switch("-q", "--quiet", about="print errors and warnings only: no notes, no summary"),
        switch(
            "-v",
            "--verbose",
            about="list the findings of each robot, the files written and the time taken",
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
LIVE = OptionGroup(
    "live graph",
    (
        value(
            "--timeout",
            metavar="S",
            about="watch the graph for up to S seconds (default: 15)",
            type=values.seconds,
        ),
        value(
            "--domain",
            metavar="N",
            about=f"ROS domain ID, instead of ROS_DOMAIN_ID: 0 to {values.MAX_DOMAIN}",
            type=values.domain,
        ),
    ),
)
# Where a graph comes from; read by ``cli/live.py``.
FROM = Option(
    ("--from",),
    "read the graph from there, without ROS: a file of multibot snapshot, or a rosgraph_msgs/Graph in"
    " YAML (repeat the option for snapshots from several machines); a recording of rosbag2 (a folder,"
    " .mcap or .db3); a Zenoh router (tcp/localhost:7447, or a session configuration .json5)",
    {
        "metavar": "SOURCE",
        "dest": "sources",
        "action": "append",
        "type": values.source,
        "default": [],
    },
)
SOURCE = OptionGroup("where the graph comes from", (FROM, *LIVE.options))


FINDINGS_OUTPUT = output("write the findings there, not to standard output")

LIVE_CODES = (
    "0 as planned as far as known; 1 findings at the level of --fail-on; 2 wrong use or unreadable"
    " input; 3 inconclusive: the view may be incomplete; 4 rclpy or its RMW, zenoh or rosbags is"
    " missing or does not start"
)
PICTURES = OptionGroup(
    "report",
    (path_option("--report", "write a report, one HTML file"),),
)


RESULT_OUTPUT = output("write the result there, not to standard output")
