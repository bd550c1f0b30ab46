"""``urdf-postfix``: rewrite a robot description for one robot or many."""

from __future__ import annotations

import argparse
import os
import sys
from collections import Counter
from collections.abc import Iterator, Sequence

from multibot_rewrite import __version__
from multibot_rewrite.cli.files import write_all
from multibot_rewrite.library import Rewrite, Source, read_file, rewrite_all, strip
from multibot_rewrite.model import (
    Finding,
    MultibotError,
    ProofError,
    RewriteRefused,
    UsageError,
)
from multibot_rewrite.naming import LAYOUTS, SEPARATORS, SHARED_FRAMES, SHARED_TOPICS, make_naming

DONE, STOPPED, UNUSABLE = 0, 1, 2
MANY = 20
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


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns the exit code."""
    options = _parser().parse_intermixed_args(arguments)
    try:
        return _run(options)
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
        # Python would complain again when it closes standard output.
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        _say("standard output was closed before everything was written")
        return STOPPED


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="urdf-postfix",
        description="Rewrite a robot description for one robot or many, and prove nothing was missed.",
        epilog=EXAMPLES,
        formatter_class=_formatter,
        allow_abbrev=False,
    )
    add = parser.add_argument
    add("input", help="URDF, or xacro if named ….xacro, or - for standard input")
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
    source: Source = sys.stdin.buffer.read() if options.input == "-" else options.input
    if options.strip:
        results = [(robots[0], _strip(options, source, robots[0]))]
        report = f"{robots[0]} taken out, proved by rewriting again"
        _deliver(options, results, [], source)
        return _report(options, report)
    return _rewrite(options, source, robots)


def _check_use(options: argparse.Namespace, robots: list[str]) -> None:
    if not robots:
        raise UsageError("no robot name given; for example: urdf-postfix rover.urdf robot1")
    if options.output and options.in_place:
        raise UsageError("--output and --in-place exclude each other")
    if options.in_place and (options.input == "-" or options.input.endswith(".xacro")):
        raise UsageError("--in-place needs a URDF file, not standard input or xacro")
    if len(robots) > 1 and (options.strip or options.in_place):
        raise UsageError("--strip and --in-place take one robot at a time")
    if len(robots) > 1 and not options.diff and "{robot}" not in (options.output or ""):
        raise UsageError("several robots need one file each: -o 'out/{robot}.urdf'")
    if options.output and os.path.realpath(options.output) == os.path.realpath(options.input):
        raise UsageError(f"{options.output} is the input file; --in-place writes over it")


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
        file="<stdin>" if options.input == "-" else "",
    )
    first = next(rewrites)
    _print_findings(first.findings)
    if options.strict and first.findings:
        _say("--strict: nothing was written")
        return STOPPED
    results = _results(first, rewrites)
    changes = [(options.changes, _changes_json(first, robots))] if options.changes else []
    _deliver(options, results, changes, first.template.inventory.document.source)
    return _report(options, _summary(first, robots))


def _results(first: Rewrite, others: Iterator[Rewrite]) -> Iterator[tuple[str, bytes]]:
    yield first.robot, first.data
    for other in others:
        yield other.robot, other.data


def _strip(options: argparse.Namespace, source: Source, robot: str) -> bytes:
    naming = make_naming(
        options.layout,
        options.affix,
        options.topics,
        _separators(options),
        options.shared_frames.split(","),
        options.shared_topics.split(","),
    )
    file = "<stdin>" if options.input == "-" else ""
    return strip(source, robot, naming=naming, vocabulary=options.vocabulary, file=file)


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
    results: Sequence[tuple[str, bytes]] | Iterator[tuple[str, bytes]],
    more: list[tuple[str, bytes]],
    before: Source,
) -> None:
    target = options.input if options.in_place else options.output
    if options.diff:
        write_all(more)
        old = before if isinstance(before, bytes) else read_file(os.fspath(before))
        for robot, data in results:
            _print_diff(old, data, options.input, robot)
    elif target:
        total = len(options.words)
        files = ((target.replace("{robot}", robot), data) for robot, data in results)
        write_all(
            [*more, *_watched(files, total)] if total < MANY else _watched((*more, *files), total)
        )
    else:
        write_all(more)
        for _, data in results:
            sys.stdout.buffer.write(data)
        sys.stdout.buffer.flush()


def _watched(
    files: Sequence[tuple[str, bytes]] | Iterator[tuple[str, bytes]], total: int
) -> Iterator[tuple[str, bytes]]:
    """The same files, with a progress bar where there are many and somebody is looking."""
    if total < MANY or not sys.stderr.isatty():
        yield from files
        return
    from rich.console import Console
    from rich.progress import track

    yield from track(files, "writing", total, console=Console(stderr=True), transient=True)


def _print_diff(old: bytes, new: bytes, name: str, robot: str) -> None:
    from difflib import unified_diff

    lines = unified_diff(
        old.decode().splitlines(keepends=True),
        new.decode().splitlines(keepends=True),
        name,
        f"{name} for {robot}",
    )
    for line in lines:
        ending = "" if line.endswith("\n") else "\n\\ No newline at end of file\n"
        sys.stdout.write(line + ending)
    sys.stdout.flush()


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
    paint = {"warning": "\033[33m", "error": "\033[31m"} if sys.stderr.isatty() else {}
    for finding in findings:
        color = paint.get(finding.level, "")
        sys.stderr.write(f"{color}{finding}{color and chr(27) + '[0m'}\n")


def _say(text: str) -> None:
    sys.stderr.write(f"urdf-postfix: {text}\n")


if __name__ == "__main__":
    sys.exit(main())
