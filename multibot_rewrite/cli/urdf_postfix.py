"""``urdf-postfix``: rewrite a robot description for one robot or many."""

from __future__ import annotations

import argparse
import gc
import sys
from collections.abc import Iterator, Sequence
from functools import partial

from multibot_rewrite.cli.output import changes_json, deliver, print_findings, say, summary
from multibot_rewrite.cli.process import DONE, STOPPED, guarded
from multibot_rewrite.cli.usage import check_use, input_name, parser, policy, xacro_args
from multibot_rewrite.config import configured_vocabulary
from multibot_rewrite.library import Rewrite, rewrite_all, strip
from multibot_rewrite.model import InputError
from multibot_rewrite.sources.read import Source, read_source


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns the exit code."""
    if arguments is None:
        # A short process of its own: nothing it makes needs the collector of cycles.
        gc.disable()
    run = partial(_start, arguments)
    return guarded("urdf-postfix", run, own_process=arguments is None)


def _start(arguments: Sequence[str] | None) -> int:
    return _run(parser().parse_intermixed_args(arguments))


def _run(options: argparse.Namespace) -> int:
    if options.explain is not None:
        from multibot_rewrite.cli import explain  # a rewrite does not need it

        return explain.run(options)
    robots = [word for word in options.words if ":=" not in word]
    check_use(options, robots)
    options.vocabulary = [*configured_vocabulary(options.input), *options.vocabulary]
    source: Source = standard_input() if options.input == "-" else options.input
    if not options.strip:
        return _rewrite(options, source, robots)
    # Read once: it may be a pipe, and --diff shows it again.
    before, _ = read_source(source, xacro_args(options))
    deliver(options, [(robots[0], _strip(options, before, robots[0]))], [], before, 1)
    if not options.quiet:
        say(f"{robots[0]} taken out, proved by rewriting again")
    return DONE


def standard_input() -> bytes:
    """All of standard input; raises InputError."""
    if sys.stdin is None:
        raise InputError("<stdin>: standard input is closed; name a file instead of -")
    try:
        return sys.stdin.buffer.read()
    except OSError as error:
        raise InputError(f"<stdin>: cannot be read: {error.strerror}") from None


def _rewrite(options: argparse.Namespace, source: Source, robots: list[str]) -> int:
    rewrites = rewrite_all(
        source,
        robots,
        **policy(options),
        urdf=options.urdf,
        xacro_args=xacro_args(options),
        vocabulary=options.vocabulary,
        again=options.again,
        file=input_name(options),
    )
    first = next(rewrites)
    print_findings(first.findings)
    if options.strict and first.findings:
        say("--strict: nothing was written")
        return STOPPED
    results = _results(first, rewrites)
    changes = [(options.changes, changes_json(first, robots))] if options.changes else []
    before = first.template.inventory.document.source
    deliver(options, results, changes, before, len(robots))
    if not options.quiet:
        say(summary(first, robots))
    return DONE


def _results(first: Rewrite, others: Iterator[Rewrite]) -> Iterator[tuple[str, bytes]]:
    yield first.robot, first.data
    for other in others:
        yield other.robot, other.data


def _strip(options: argparse.Namespace, source: bytes, robot: str) -> bytes:
    name, vocabulary = input_name(options), options.vocabulary
    extra = policy(options)
    return strip(source, robot, urdf=options.urdf, vocabulary=vocabulary, file=name, **extra)


if __name__ == "__main__":
    sys.exit(main())
