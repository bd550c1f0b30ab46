"""The options of ``urdf-postfix``: how they are written, and which do not go together."""

from __future__ import annotations

import argparse
import os
import re
from typing import NoReturn

from multibot_rewrite.model import UsageError
from multibot_rewrite.naming import (
    DEFAULT_LAYOUT,
    LAYOUTS,
    SEPARATORS,
    SHARED_FRAMES,
    SHARED_TOPICS,
    Policy,
)
from multibot_rewrite.version import __version__

UNUSABLE = 2
USAGE = "%(prog)s INPUT ROBOT... [NAME:=VALUE...] [options]"
EXAMPLES = """\
examples:
  urdf-postfix rover.urdf robot1                        to standard output
  urdf-postfix rover.urdf robot1 -o robot1.urdf
  urdf-postfix rover.urdf.xacro robot1 robot2 -o 'out/{robot}.urdf' use_sim:=true
  urdf-postfix rover.urdf robot1 --affix prefix --layout frames-per-robot --separator link=_
  urdf-postfix rover.srdf robot1 --urdf rover.urdf      an SRDF in step with its URDF
  urdf-postfix robot1.urdf robot1 --strip               the inverse
  urdf-postfix --explain rover.urdf:34                  why is this (not) spelled?
  cat rover.urdf | urdf-postfix - robot1 --diff
exit codes: 0 done; 1 findings that stop the job (any, with --strict); 2 wrong use or unreadable input
"""


LAYOUT_HELP = "; ".join(f"{layout.name} ({layout.short}): {layout.about}" for layout in LAYOUTS)
_SEPARATORS = " ".join(f"{kind}={mark}" for kind, mark in SEPARATORS.items())
# Name, default, what stands for the value, help.
VALUES = (
    (
        "--layout",
        DEFAULT_LAYOUT,
        "NAME",
        f"where tf lives. {LAYOUT_HELP} (default: {DEFAULT_LAYOUT})",
    ),
    ("--affix", "postfix", "SIDE", "postfix (default) or prefix"),
    ("--topics", None, "HOW", "postfix, prefix or namespace (default: what the layout implies)"),
    ("--groups", "keep", "HOW", "groups and end effectors of an SRDF: keep (default) or rename"),
    ("--urdf", None, "FILE", "the URDF that an SRDF belongs to (with --strip: the rewritten one)"),
    ("--shared-frames", ",".join(SHARED_FRAMES), "A,B", "default: %(default)s"),
    ("--shared-topics", ",".join(SHARED_TOPICS), "A,B", "default: %(default)s"),
    ("--explain", None, "FILE:LINE", "say which rewriter claims what stands there, and why"),
    ("--changes", None, "FILE", "write every change as JSON"),
)
REPEATED = (
    ("--separator", "KIND=SEP", f"defaults: {_SEPARATORS}"),
    ("--vocabulary", "FILE", "more vocabulary"),
)
SWITCHES = (
    ("--in-place", "write the result over the input file"),
    ("--strip", "undo a rewrite made with the same options"),
    ("--again", "rewrite although it was rewritten for this robot"),
    ("--diff", "print a unified diff instead of the result"),
    ("--strict", "warnings stop the job"),
    ("--quiet", "no report, only findings"),
)


class Parser(argparse.ArgumentParser):
    """Says what is wrong in one line instead of listing every option."""

    def error(self, message: str) -> NoReturn:
        self.exit(UNUSABLE, f"{self.prog}: {message}; see {self.prog} --help\n")


def parser() -> argparse.ArgumentParser:
    """The command line; what it cannot read ends the process with one line."""
    result = Parser(
        prog="urdf-postfix",
        usage=USAGE,
        description="Rewrite a robot description for one robot or many, and prove nothing was missed.",
        epilog=EXAMPLES,
        formatter_class=_formatter,
        allow_abbrev=False,
    )
    result.add_argument(
        "input",
        nargs="?",
        metavar="INPUT",
        help="URDF, SDF model, SRDF, xacro of one (named *.xacro), or - for standard input",
    )
    result.add_argument(
        "words", nargs="*", metavar="ROBOT", help="robot names, and NAME:=VALUE for xacro"
    )
    result.add_argument(
        "-o", "--output", metavar="PATH", help="output file; {robot} stands for the robot's name"
    )
    for name, default, metavar, help_ in VALUES:
        result.add_argument(name, default=default, metavar=metavar, help=help_)
    for name, metavar, help_ in REPEATED:
        result.add_argument(name, action="append", default=[], metavar=metavar, help=help_)
    for name, help_ in SWITCHES:
        result.add_argument(name, action="store_true", help=help_)
    result.add_argument("--version", action="version", version=f"%(prog)s {__version__}")
    return result


def _formatter(prog: str) -> argparse.HelpFormatter:
    # A given width spares argparse the import of shutil at every start.
    return argparse.RawDescriptionHelpFormatter(prog, width=96)


def check_use(options: argparse.Namespace, robots: list[str]) -> None:
    """Raise UsageError for what cannot be meant."""
    if options.input == "":
        raise UsageError("the name of the input is empty")
    if options.input is None:
        raise UsageError("no INPUT and no ROBOT given; see urdf-postfix --help")
    if not robots:
        raise UsageError("no robot name given; for example: urdf-postfix rover.urdf robot1")
    _check_together(options)
    inputs = (options.input, options.urdf or "")
    if xacro_args(options) and not any(path.endswith(".xacro") for path in inputs):
        raise UsageError(f"NAME:=VALUE is for xacro, {input_name(options)} is not named *.xacro")
    if len(robots) > 1 and (options.strip or options.in_place):
        raise UsageError("--strip and --in-place take one robot at a time")
    _check_path("--output", options.output, "{robot}")
    _check_path("--changes", options.changes, "")
    if len(robots) > 1 and not options.diff and "{robot}" not in (options.output or ""):
        raise UsageError("several robots need one file each: -o 'out/{robot}.urdf'")
    _check_targets(
        options, [target_path(options.output, robot) for robot in robots if options.output]
    )


def _check_together(options: argparse.Namespace) -> None:
    """Options of which one would silently do nothing beside the other."""
    if options.output is not None and options.in_place:
        raise UsageError("--output and --in-place exclude each other")
    if options.diff and (options.output is not None or options.in_place):
        raise UsageError("--diff prints to standard output: leave out --output and --in-place")
    if options.strip and options.changes is not None:
        raise UsageError("--changes lists what a rewrite changes, it cannot go with --strip")
    if options.in_place and (options.input == "-" or options.input.endswith(".xacro")):
        raise UsageError("--in-place needs a URDF file, not standard input or xacro")


def _check_path(option: str, path: str | None, known: str) -> None:
    if path == "":
        raise UsageError(f"{option} is empty, give the name of a file")
    unknown = [word for word in re.findall(r"\{.*?\}", path or "") if word != known]
    if unknown:
        hint = f"only {known} is filled in" if known else "one file serves all robots"
        raise UsageError(f"{option} {path}: unknown placeholder {unknown[0]}, {hint}")


def _check_targets(options: argparse.Namespace, targets: list[str]) -> None:
    """No result may land on the input, nor the list of changes on a result."""
    changes = [options.changes] if options.changes else []
    for path in [*targets, *changes]:
        if os.path.isfile(path) and _same_file(path, options.input):
            raise UsageError(f"{path} is the input file; choose another name, or --in-place")
        if os.path.isfile(path) and _same_file(path, options.urdf or ""):
            raise UsageError(f"{path} is the file of --urdf; choose another name")
    if changes and os.path.realpath(changes[0]) in {os.path.realpath(path) for path in targets}:
        raise UsageError(f"{changes[0]}: the result and --changes need a file each")


def _same_file(path: str, other: str) -> bool:
    return os.path.isfile(other) and os.path.samefile(path, other)


def target_path(output: str, robot: str) -> str:
    """The output file of one robot."""
    return output.replace("{robot}", robot)


def input_name(options: argparse.Namespace) -> str:
    """The input as messages call it."""
    if options.input == "-":
        return "<stdin>"
    expanded = " (expanded)" if options.input.endswith(".xacro") else ""
    return f"{options.input}{expanded}"


def separators(options: argparse.Namespace) -> dict[str, str]:
    """``--separator`` as kind -> mark."""
    pairs = [pair.partition("=") for given in options.separator for pair in given.split(",")]
    wrong = next((kind for kind, equals, _ in pairs if not equals), None)
    if wrong is not None:
        raise UsageError(f"--separator {wrong}: write KIND=SEP, for example link=_")
    return {kind: mark for kind, _, mark in pairs}


def xacro_args(options: argparse.Namespace) -> dict[str, str]:
    """The words that are xacro arguments, as name -> value."""
    pairs = [word.partition(":=") for word in options.words if ":=" in word]
    return {name: value for name, _, value in pairs}


def policy(options: argparse.Namespace) -> Policy:
    """The naming policy that the options ask for, as ``make_naming`` takes it."""
    return {
        "layout": options.layout,
        "affix": options.affix,
        "topics": options.topics,
        "separators": separators(options),
        "shared_frames": options.shared_frames.split(","),
        "shared_topics": options.shared_topics.split(","),
        "groups": options.groups,
    }
