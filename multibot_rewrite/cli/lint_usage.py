"""The options of ``urdf-lint``: how they are written, and which do not go together."""

from __future__ import annotations

import argparse

from multibot_rewrite.cli.usage import LAYOUT_HELP, Parser
from multibot_rewrite.findings.formats import FORMATS
from multibot_rewrite.model import UsageError
from multibot_rewrite.version import __version__

PROGRAM = "urdf-lint"
USAGE = "%(prog)s PATH... [NAME:=VALUE...] [options]"
MORE = """\
examples:
  urdf-lint urdf/                                      every .urdf, .xacro and .srdf below it
  urdf-lint rover.urdf --select MB2,MB5                names that lead nowhere, and the tree
  urdf-lint rover.urdf.xacro sim:=gz                   with xacro arguments, too
  urdf-lint rover.urdf --robots robot1,robot2 --layout L2
  urdf-lint urdf/ --format sarif --output lint.sarif
  urdf-lint rover.urdf --fix --diff                    show what --fix would change
  urdf-lint --explain MB202
exit codes: 0 nothing found (notes do not count); 1 findings; 2 wrong use, nothing to lint, or a
rule that crashed
"""
# Name, what stands for the value, help.
VALUES = (
    ("--output", "FILE", "write the findings there instead of to standard output"),
    ("--select", "CODES", "only these codes, or groups of them: MB2,MB501"),
    ("--ignore", "CODES", "not these"),
    ("--robots", "A,B", "what these robots would do to each other in one system"),
    (
        "--layout",
        "NAME",
        f"where tf lives, for --robots: {LAYOUT_HELP} (default: frames-per-robot)",
    ),
    ("--affix", "SIDE", "postfix or prefix, for --robots"),
    ("--target", "A,B", "names must suit these formats, too: usd, mjcf"),
    ("--roots", "A,B", "folders in which package://NAME and $(find NAME) are looked for"),
    ("--urdf", "FILE", "the URDF that SRDF files belong to (default: the one of that robot name)"),
    ("--config", "FILE", "urdf-lint.toml or pyproject.toml (default: the nearest one above)"),
    ("--baseline", "FILE", "findings that are known: only new ones are told"),
    ("--write-baseline", "FILE", "write what is found now, for --baseline"),
    ("--changed-since", "REV", "only files that git says changed since then"),
    (
        "--fail-on",
        "LEVEL",
        "what makes the exit code 1: error, warning (default) or note, and worse",
    ),
    ("--jobs", "N", "processes (default: as many as processors)"),
    ("--explain", "CODE", "what a rule is about, and stop"),
)
SWITCHES = (
    ("--fix", "mend what can be mended without a change of meaning"),
    ("--diff", "with --fix: print what would change, write nothing"),
    ("--list-rules", "all rules, and stop"),
    ("--quiet", "no summary"),
)


def parser() -> argparse.ArgumentParser:
    """The command line; what it cannot read ends the process with one line."""
    result = Parser(
        prog=PROGRAM,
        usage=USAGE,
        description="Find what is wrong with robot descriptions, alone and among other robots.",
        epilog=MORE,
        formatter_class=_formatter,
        allow_abbrev=False,
    )
    help_ = "files and folders of .urdf, .xacro, .srdf; - for standard input; NAME:=VALUE for xacro"
    result.add_argument("words", nargs="*", metavar="PATH", help=help_)
    result.add_argument("--format", choices=FORMATS, default="text", help="default: text")
    for name, metavar, text in VALUES:
        result.add_argument(name, metavar=metavar, help=text)
    vocabulary = {"action": "append", "default": [], "metavar": "FILE"}
    result.add_argument("--vocabulary", **vocabulary, help="more vocabulary")  # type: ignore[arg-type]
    for name, text in SWITCHES:
        result.add_argument(name, action="store_true", help=text)
    result.add_argument("--version", action="version", version=f"%(prog)s {__version__}")
    return result


def _formatter(prog: str) -> argparse.HelpFormatter:
    # A given width spares argparse the import of shutil at every start.
    return argparse.RawDescriptionHelpFormatter(prog, width=96)


def check_use(options: argparse.Namespace) -> None:
    """Raise UsageError for what cannot be meant."""
    paths = [word for word in options.words if ":=" not in word]
    if not paths:
        raise UsageError("no PATH given; for example: urdf-lint urdf/")
    if "" in paths:
        raise UsageError("the name of a file is empty")
    if "-" in paths and (len(paths) > 1 or options.fix or options.changed_since):
        raise UsageError("standard input is linted alone, without --fix and --changed-since")
    if options.diff and not options.fix:
        raise UsageError("--diff shows what --fix would change: give both")
    if options.diff and options.output:
        raise UsageError("--diff prints to standard output: leave out --output")
    if options.write_baseline and (options.fix or options.baseline or options.output):
        raise UsageError("--write-baseline takes neither --fix, --baseline nor --output")
    if options.jobs is not None and not options.jobs.isdecimal():
        raise UsageError(
            f"--jobs {options.jobs}: write a number of processes, 0 for all processors"
        )


def given(options: argparse.Namespace) -> dict[str, object]:
    """What the command line says about the settings, by the names of ``with_options``."""
    lists = ("select", "ignore", "robots", "roots", "target")
    said: dict[str, object] = {
        name: tuple(value.split(",")) for name in lists if (value := getattr(options, name))
    }
    plain = ("layout", "affix", "urdf", "baseline", "fail_on")
    said |= {name: value for name in plain if (value := getattr(options, name))}
    pairs = [word.partition(":=") for word in options.words if ":=" in word]
    return {
        **said,
        "vocabulary": tuple(options.vocabulary),
        "arguments": tuple((name, value) for name, _, value in pairs),
    }
