"""``urdf-lint``: find what is wrong with robot descriptions."""

from __future__ import annotations

import argparse
import gc
import os
import sys
from collections import Counter
from collections.abc import Sequence
from functools import partial

from multibot_rewrite.cli.files import write_all
from multibot_rewrite.cli.lint_usage import PROGRAM, check_use, given, parser
from multibot_rewrite.cli.output import diff, print_bytes, say, watched
from multibot_rewrite.cli.process import DONE, STOPPED, UNUSABLE, guarded
from multibot_rewrite.cli.walk import check_folder, check_target, find_files
from multibot_rewrite.findings.finding import LEVELS, Finding
from multibot_rewrite.lint.config.configured import (
    Configured,
    check_codes,
    configured,
    is_excluded,
    with_options,
)
from multibot_rewrite.lint.config.settings import Settings
from multibot_rewrite.lint.registry import RULES
from multibot_rewrite.lint.run import among, lint_files
from multibot_rewrite.model import UsageError

SUFFIXES = (".urdf", ".xacro", ".srdf")
STDIN = "-"
CRASHED = "MB001"


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns the exit code."""
    if arguments is None:
        # A short process of its own: nothing it makes needs the collector of cycles.
        gc.disable()
    return guarded(PROGRAM, partial(_start, arguments), own_process=arguments is None)


def _start(arguments: Sequence[str] | None) -> int:
    options = parser().parse_intermixed_args(arguments)
    if options.list_rules or options.explain:
        return _tell(options)
    check_use(options)
    config = with_options(configured(".", options.config), **given(options))
    paths, unreadable = _files(options, config)
    _check_targets(options, paths)
    findings = [*unreadable, *_lint(options, config.settings, paths)]
    if options.write_baseline:
        return _write_baseline(options, findings)
    return _conclude(options, config, paths, findings)


def _tell(options: argparse.Namespace) -> int:
    from multibot_rewrite.findings.rule_docs import explained, listed

    if options.explain:
        check_codes((options.explain,), "--explain")
        asked = [it for it in RULES.values() if it.code.startswith(options.explain)]
        text = "\n".join(explained(it) for it in asked)
    else:
        text = "".join(f"{' '.join(row)}\n" for row in listed(RULES.values()))
    print_bytes(text.encode(), "--output")
    return DONE


def _files(options: argparse.Namespace, config: Configured) -> tuple[list[str], list[Finding]]:
    """What is to be linted, and findings for folders that cannot be looked into."""
    paths = [word for word in options.words if ":=" not in word]
    if paths == [STDIN]:
        return paths, []
    refused: list[Finding] = []
    level = RULES["MB102"].level

    def refuse(error: OSError) -> None:
        message = f"cannot be read: {error.strerror}"
        refused.append(Finding("MB102", level, message, "", error.filename, 1, 1))

    found = find_files(paths, SUFFIXES, refuse)
    # What is found below "." is named as git names it.
    if "." in paths:
        found = [path if path in paths else path.removeprefix("./") for path in found]
    kept = [path for path in found if path in paths or not is_excluded(path, config)]
    if not kept:
        raise UsageError(f"{', '.join(paths)}: exclude leaves no file to lint")
    if not options.changed_since:
        return kept, refused
    from multibot_rewrite.lint.config.changed import changed_since  # a plain run needs no git

    return changed_since(options.changed_since, kept), refused


def _check_targets(options: argparse.Namespace, paths: Sequence[str]) -> None:
    """Before the work: nothing that is linted is written over."""
    for option in ("--output", "--write-baseline"):
        target = getattr(options, option[2:].replace("-", "_"))
        if target:
            check_target(target, paths, option)
            check_folder(target)


def _lint(options: argparse.Namespace, settings: Settings, paths: Sequence[str]) -> list[Finding]:
    if list(paths) == [STDIN]:
        from multibot_rewrite.cli.urdf_postfix import standard_input
        from multibot_rewrite.lint.check import lint_data

        return lint_data("<stdin>", standard_input(), settings)
    watch = partial(watched, total=len(paths), doing="linting")
    findings = lint_files(paths, settings, jobs=int(options.jobs or 0), watch=watch)
    if not options.fix or not _mended(options, among(paths, settings), findings):
        return findings
    # Anew, and all: what is written in one file is found through others.
    return lint_files(paths, settings, jobs=int(options.jobs or 0))


def _mended(options: argparse.Namespace, settings: Settings, findings: list[Finding]) -> list[str]:
    """The files that are mended. With --diff none is, and the changes are printed."""
    from multibot_rewrite.lint.fix import fix
    from multibot_rewrite.sources.read import read_file

    files = sorted({it.file for it in findings if it.edits})
    old = {file: read_file(file) for file in files}
    new = {file: fix(file, old[file], settings) for file in files}
    if options.diff:
        for file, (data, _) in new.items():
            print_bytes(diff(old[file], data, file, f"{file} mended"), "--output")
        return []
    write_all((file, data) for file, (data, _) in new.items())
    if files:
        say(f"mended {', '.join(files)}", PROGRAM)
    return files


def _write_baseline(options: argparse.Namespace, findings: Sequence[Finding]) -> int:
    from multibot_rewrite.lint.config.baseline import baseline_text

    write_all([(options.write_baseline, baseline_text(findings, options.write_baseline))])
    if not options.quiet:
        say(f"{options.write_baseline}: {_count(findings)} are known from now on", PROGRAM)
    return DONE


def _conclude(
    options: argparse.Namespace,
    config: Configured,
    paths: Sequence[str],
    findings: Sequence[Finding],
) -> int:
    stale = 0
    if config.baseline:
        from multibot_rewrite.lint.config.baseline import beyond, read_baseline

        known = read_baseline(config.baseline)
        findings, stale = beyond(findings, known, config.baseline, paths)
    if not (options.fix and options.diff):
        _deliver(options, paths, findings)
    if not options.quiet:
        say(_summary(options, paths, findings, stale), PROGRAM)
    if any(it.code == CRASHED for it in findings):
        return UNUSABLE
    failing = LEVELS[: LEVELS.index(config.fail_on) + 1]
    return STOPPED if any(it.level in failing for it in findings) else DONE


def _deliver(
    options: argparse.Namespace, paths: Sequence[str], findings: Sequence[Finding]
) -> None:
    from multibot_rewrite.findings.formats import Report, rendered

    terminal = not options.output and sys.stdout is not None and sys.stdout.isatty()
    colour = terminal and "NO_COLOR" not in os.environ
    data = rendered(options.format, findings, Report(PROGRAM, paths, RULES), colour=colour).encode()
    if options.output:
        write_all([(options.output, data)])
    else:
        print_bytes(data, "--output")


def _summary(
    options: argparse.Namespace, paths: Sequence[str], findings: Sequence[Finding], stale: int
) -> str:
    files = f"{len(paths)} file{'s' * (len(paths) != 1)}"
    changed = f" changed since {options.changed_since}" if options.changed_since else ""
    mendable = sum(bool(it.edits) for it in findings)
    hint = f"; --fix mends {mendable}" if mendable and not options.fix else ""
    old = f"; {stale} in the baseline are gone" if stale else ""
    return f"{files}{changed}: {_count(findings)}{hint}{old}"


def _count(findings: Sequence[Finding]) -> str:
    counts = Counter(it.level for it in findings)
    told = [f"{counts[it]} {it}{'s' * (counts[it] != 1)}" for it in LEVELS if counts[it]]
    return ", ".join(told) or "no findings"


if __name__ == "__main__":
    sys.exit(main())
