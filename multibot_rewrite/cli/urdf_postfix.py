"""``urdf-postfix``: rewrite a robot description for one robot or many."""

from __future__ import annotations

import argparse
import io
import os
import re
import signal
import sys
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from itertools import chain
from typing import NoReturn

from multibot_rewrite import __version__
from multibot_rewrite.cli.files import write_all
from multibot_rewrite.library import Rewrite, Source, read_source, rewrite_all, strip
from multibot_rewrite.model import (
    Finding,
    InputError,
    MultibotError,
    ProofError,
    RewriteRefused,
    UsageError,
)
from multibot_rewrite.naming import LAYOUTS, SEPARATORS, SHARED_FRAMES, SHARED_TOPICS, make_naming

DONE, STOPPED, UNUSABLE, INTERRUPTED = 0, 1, 2, 130
MANY = 20
USAGE = "%(prog)s INPUT ROBOT... [NAME:=VALUE...] [options]"
EXAMPLES = """\
examples:
  urdf-postfix rover.urdf robot1                        to standard output
  urdf-postfix rover.urdf robot1 -o robot1.urdf
  urdf-postfix rover.urdf.xacro robot1 robot2 -o 'out/{robot}.urdf' use_sim:=true
  urdf-postfix rover.urdf robot1 --affix prefix --layout frames-per-robot --separator link=_
  urdf-postfix robot1.urdf robot1 --strip               the inverse
  cat rover.urdf | urdf-postfix - robot1 --diff
exit codes: 0 done; 1 findings that stop the job (any, with --strict); 2 wrong use or unreadable input
"""


class _Parser(argparse.ArgumentParser):
    """Says what is wrong in one line instead of listing every option."""

    def error(self, message: str) -> NoReturn:
        self.exit(UNUSABLE, f"{self.prog}: {message}; see {self.prog} --help\n")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns the exit code."""
    # Closed by the caller: nobody wants to hear anything.
    sys.stderr = sys.stderr or io.StringIO()
    if arguments is None:
        signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        return _run(_parser().parse_intermixed_args(arguments))
    except RewriteRefused as error:
        _print_findings(error.findings)
        return STOPPED
    except ProofError as error:
        _say(f"the proof failed, nothing was written; this is a fault of the tool: {error}")
        return STOPPED
    except MultibotError as error:
        _say(str(error))
        return UNUSABLE
    except BrokenPipeError:
        _say("standard output was closed before everything was written")
        return STOPPED
    except KeyboardInterrupt:
        _say("interrupted; no half-written file is left")
        return INTERRUPTED


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(
        prog="urdf-postfix",
        usage=USAGE,
        description="Rewrite a robot description for one robot or many, and prove nothing was missed.",
        epilog=EXAMPLES,
        formatter_class=_formatter,
        allow_abbrev=False,
    )
    add = parser.add_argument
    add("input", metavar="INPUT", help="URDF, xacro (named *.xacro), or - for standard input")
    add("words", nargs="*", metavar="ROBOT", help="robot names, and NAME:=VALUE for xacro")
    add("-o", "--output", metavar="PATH", help="output file; {robot} stands for the robot's name")
    add("--in-place", action="store_true", help="write the result over the input file")
    layouts = "; ".join(f"{layout.name} ({layout.short}): {layout.about}" for layout in LAYOUTS)
    add("--layout", default="postfix", help=f"where tf lives. {layouts} (default: postfix)")
    add("--affix", default="postfix", help="postfix (default) or prefix")
    add("--topics", help="postfix, prefix or namespace (default: what the layout implies)")
    add(
        "--separator",
        action="append",
        default=[],
        metavar="KIND=SEP",
        help="defaults: " + " ".join(f"{kind}={mark}" for kind, mark in SEPARATORS.items()),
    )
    add(
        "--shared-frames",
        default=",".join(SHARED_FRAMES),
        metavar="A,B",
        help="default: %(default)s",
    )
    add(
        "--shared-topics",
        default=",".join(SHARED_TOPICS),
        metavar="A,B",
        help="default: %(default)s",
    )
    add("--vocabulary", action="append", default=[], metavar="FILE", help="more vocabulary")
    add("--strip", action="store_true", help="undo a rewrite made with the same options")
    add("--again", action="store_true", help="rewrite although it was rewritten for this robot")
    add("--diff", action="store_true", help="print a unified diff instead of the result")
    add("--changes", metavar="FILE", help="write every change as JSON")
    add("--strict", action="store_true", help="warnings stop the job")
    add("--quiet", action="store_true", help="no report, only findings")
    add("--version", action="version", version=f"%(prog)s {__version__}")
    return parser


def _formatter(prog: str) -> argparse.HelpFormatter:
    # A given width spares argparse the import of shutil at every start.
    return argparse.RawDescriptionHelpFormatter(prog, width=96)


def _run(options: argparse.Namespace) -> int:
    robots = [word for word in options.words if ":=" not in word]
    _check_use(options, robots)
    source: Source = _standard_input() if options.input == "-" else options.input
    if not options.strip:
        return _rewrite(options, source, robots)
    # Read once: it may be a pipe, and --diff shows it again.
    before, _ = read_source(source, _xacro_args(options))
    _deliver(options, [(robots[0], _strip(options, before, robots[0]))], [], before, 1)
    return _report(options, f"{robots[0]} taken out, proved by rewriting again")


def _check_use(options: argparse.Namespace, robots: list[str]) -> None:
    if not robots:
        raise UsageError("no robot name given; for example: urdf-postfix rover.urdf robot1")
    _check_together(options)
    if _xacro_args(options) and not options.input.endswith(".xacro"):
        raise UsageError(f"NAME:=VALUE is for xacro, {_name(options)} is not named *.xacro")
    if len(robots) > 1 and (options.strip or options.in_place):
        raise UsageError("--strip and --in-place take one robot at a time")
    _check_path("--output", options.output, "{robot}")
    _check_path("--changes", options.changes, "")
    if len(robots) > 1 and not options.diff and "{robot}" not in (options.output or ""):
        raise UsageError("several robots need one file each: -o 'out/{robot}.urdf'")
    _check_targets(options, [_target(options.output, robot) for robot in robots if options.output])


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
    if changes and os.path.realpath(changes[0]) in {os.path.realpath(path) for path in targets}:
        raise UsageError(f"{changes[0]}: the result and --changes need a file each")


def _same_file(path: str, other: str) -> bool:
    return os.path.isfile(other) and os.path.samefile(path, other)


def _target(output: str, robot: str) -> str:
    return output.replace("{robot}", robot)


def _standard_input() -> bytes:
    if sys.stdin is None:
        raise InputError("<stdin>: standard input is closed; name a file instead of -")
    try:
        return sys.stdin.buffer.read()
    except OSError as error:
        raise InputError(f"<stdin>: cannot be read: {error.strerror}") from None


def _name(options: argparse.Namespace) -> str:
    return "<stdin>" if options.input == "-" else str(options.input)


def _rewrite(options: argparse.Namespace, source: Source, robots: list[str]) -> int:
    rewrites = rewrite_all(
        source,
        robots,
        layout=options.layout,
        affix=options.affix,
        topics=options.topics,
        separators=_separators(options),
        shared_frames=options.shared_frames.split(","),
        shared_topics=options.shared_topics.split(","),
        xacro_args=_xacro_args(options),
        vocabulary=options.vocabulary,
        again=options.again,
        file=_name(options),
    )
    first = next(rewrites)
    _print_findings(first.findings)
    if options.strict and first.findings:
        _say("--strict: nothing was written")
        return STOPPED
    results = _results(first, rewrites)
    changes = [(options.changes, _changes_json(first, robots))] if options.changes else []
    before = first.template.inventory.document.source
    _deliver(options, results, changes, before, len(robots))
    return _report(options, _summary(first, robots))


def _results(first: Rewrite, others: Iterator[Rewrite]) -> Iterator[tuple[str, bytes]]:
    yield first.robot, first.data
    for other in others:
        yield other.robot, other.data


def _strip(options: argparse.Namespace, source: bytes, robot: str) -> bytes:
    naming = make_naming(
        options.layout,
        options.affix,
        options.topics,
        _separators(options),
        options.shared_frames.split(","),
        options.shared_topics.split(","),
    )
    name = _name(options)
    return strip(source, robot, naming=naming, vocabulary=options.vocabulary, file=name)


def _separators(options: argparse.Namespace) -> dict[str, str]:
    pairs = [pair.partition("=") for given in options.separator for pair in given.split(",")]
    wrong = next((kind for kind, equals, _ in pairs if not equals), None)
    if wrong is not None:
        raise UsageError(f"--separator {wrong}: write KIND=SEP, for example link=_")
    return {kind: mark for kind, _, mark in pairs}


def _xacro_args(options: argparse.Namespace) -> dict[str, str]:
    pairs = [word.partition(":=") for word in options.words if ":=" in word]
    return {name: value for name, _, value in pairs}


def _deliver(
    options: argparse.Namespace,
    results: Iterable[tuple[str, bytes]],
    more: list[tuple[str, bytes]],
    before: bytes,
    total: int,
) -> None:
    """Print or write the results as they are made, and ``more`` files with them."""
    target = options.input if options.in_place else options.output
    if target:
        files = ((_target(target, robot), data) for robot, data in results)
        write_all(_watched(chain(more, files), total))
        return
    write_all(more)
    for robot, data in results:
        _print(_diff(before, data, _name(options), robot) if options.diff else data)


def _watched(files: Iterable[tuple[str, bytes]], total: int) -> Iterable[tuple[str, bytes]]:
    """The same files, with a progress bar where there are many and somebody is looking."""
    if total < MANY or not sys.stderr.isatty():
        return files
    from rich.console import Console
    from rich.progress import track

    return track(files, "writing", total, console=Console(stderr=True), transient=True)


def _diff(old: bytes, new: bytes, name: str, robot: str) -> bytes:
    from difflib import diff_bytes, unified_diff

    # Unlike splitlines, this ends lines at line feeds only, as patch does.
    before, after = io.BytesIO(old).readlines(), io.BytesIO(new).readlines()
    there = os.fsencode(name)
    lines = diff_bytes(unified_diff, before, after, there, there + f" for {robot}".encode())
    cut_short = b"\n\\ No newline at end of file\n"
    return b"".join(line if line.endswith(b"\n") else line + cut_short for line in lines)


def _print(data: bytes) -> None:
    """Write to standard output, now: what fails must be told before the report."""
    if sys.stdout is None:
        raise UsageError("standard output is closed; name a file with -o")
    try:
        sys.stdout.buffer.write(data)
        sys.stdout.buffer.flush()
    except OSError as error:
        # Python would complain again when it closes standard output.
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        if isinstance(error, BrokenPipeError):
            raise
        raise UsageError(f"standard output: cannot be written: {error.strerror}") from None


def _changes_json(first: Rewrite, robots: list[str]) -> bytes:
    import json

    rewrites = [first._replace(robot=robot) for robot in robots]
    table = {
        "file": first.template.inventory.document.file,
        "robots": {r.robot: [change._asdict() for change in r.changes] for r in rewrites},
    }
    return json.dumps(table, indent=1, ensure_ascii=False).encode() + b"\n"


def _summary(first: Rewrite, robots: list[str]) -> str:
    inventory, plan = first.template.inventory, first.template.plan
    names = {
        (kind, claim.value)
        for claim, spelling in zip(inventory.claims, plan.spellings, strict=True)
        for kind, _ in spelling
    }
    counts = Counter(kind for kind, _ in names)
    known = [
        f"{counts[kind]} {kind}{'s' * (counts[kind] > 1)}" for kind in SEPARATORS if counts[kind]
    ]
    inserted = f", {len(plan.insertions)} inserted" if plan.insertions else ""
    who = robots[0] if len(robots) == 1 else f"{len(robots)} robots"
    return f"{who}: {', '.join(known) or 'nothing to rename'}{inserted}; proved"


def _report(options: argparse.Namespace, text: str) -> int:
    if not options.quiet:
        _say(text)
    return DONE


def _print_findings(findings: Sequence[Finding]) -> None:
    colorful = sys.stderr.isatty() and "NO_COLOR" not in os.environ
    paint = {"warning": "\033[33m", "error": "\033[31m"} if colorful else {}
    for finding in findings:
        color = paint.get(finding.level, "")
        sys.stderr.write(f"{color}{finding}{color and chr(27) + '[0m'}\n")


def _say(text: str) -> None:
    sys.stderr.write(f"urdf-postfix: {text}\n")


if __name__ == "__main__":
    sys.exit(main())
