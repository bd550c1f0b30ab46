# SPDX-License-Identifier: Apache-2.0
"""``urdf-lint``: find what is wrong with robot descriptions."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from importlib import import_module
from typing import TYPE_CHECKING, Any

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.findings.formats.plain import counts, in_words
from multibot_rewrite.base.findings.selection import fails
from multibot_rewrite.base.model import DefinitionsError, UsageError
from multibot_rewrite.base.releases import (
    ROS_2,
    facts_of_release,
    release_chosen_here,
    release_doubt,
    why_here,
)
from multibot_rewrite.base.wording import plural
from multibot_rewrite.cli.output import (
    detail,
    note,
    print_bytes,
    prints_colour,
    watched,
    write_files,
)
from multibot_rewrite.cli.parser import UNUSABLE
from multibot_rewrite.cli.process import DONE, STOPPED
from multibot_rewrite.cli.report import NO_RULES, TEXT, About, by_themselves, report_first
from multibot_rewrite.cli.usage import check_xacro, plain_words, policy, xacro_args
from multibot_rewrite.cli.walk import check_folder, check_target, find_files, standard_input
from multibot_rewrite.description.sources.own_names import filled
from multibot_rewrite.description.sources.release_said import release_of_all
from multibot_rewrite.lint.config.configured import (
    Configured,
    configured,
    is_excluded,
    with_options,
)
from multibot_rewrite.lint.run import among, lint_files
from multibot_rewrite.related_files.named_file import SUFFIXES as BESIDE, is_linted
from multibot_rewrite.rules.settings import Settings

if TYPE_CHECKING:
    from multibot_rewrite.lint.cache.cache import Cache


SUFFIXES = (".urdf", ".xacro", ".srdf", ".sdf", *BESIDE)
STDIN = "-"
# What says by what it loads which release it is for.
_TELLING = (".urdf", ".xacro", ".sdf", "_planning.yaml")
CRASHED = "MB001"
_LISTS = ("select", "ignore", "robots", "roots", "target", "definitions")
_NOT_FOR_EDITORS = ("fix", "diff", "output", "write_baseline", "changed_since")
_PLAIN = ("urdf", "baseline", "fail_on", "trust")


def run(options: argparse.Namespace) -> int:
    """Lint or fix; returns the exit code."""
    if options.lsp:  # a program of its own; pygls is an extra
        if plain_words(options) or any(getattr(options, it) for it in _NOT_FOR_EDITORS):
            others = ", ".join(f"--{it.replace('_', '-')}" for it in _NOT_FOR_EDITORS)
            raise UsageError(f"--lsp lints what an editor opens: leave out PATH, {others}")
        return int(import_module("multibot_rewrite.cli.lsp").run(options))
    check_use(options)
    config = configured(".", options.config)
    asked = options.distro or config.distro
    if doubt := release_doubt(asked):
        note(options, f"warning: {doubt}")
    alone = config
    config = with_options(config, **given(options))
    paths, unreadable = _files_to_lint(options, config)
    settings, why = of_release(asked, config.settings, paths)
    config = config._replace(settings=settings)
    _check_selecting(options, paths)
    # Before the work: nothing that is linted is written over.
    for option in ("--output", "--write-baseline"):
        target = getattr(options, option[2:].replace("-", "_"))
        if target and target != STDIN:
            check_target(target, paths, option)
            check_folder(target)
    findings = [*unreadable, *_lint(options, config.settings, paths)]
    if options.shared and paths != [STDIN] and not options.fix:
        _check_shared(options, alone, config.settings, paths, findings[len(unreadable) :])
    if options.write_baseline:
        from multibot_rewrite.lint.config.baseline import baseline_text

        text = baseline_text(findings, options.write_baseline)
        write_files(options, [(options.write_baseline, text)])
        counted = in_words(counts(findings)) or "no findings"
        note(options, f"{options.write_baseline}: {counted} are known from now on")
        return DONE
    return _conclude(options, config, paths, findings, why)


def of_release(asked: str, settings: Settings, paths: Sequence[str]) -> tuple[Settings, str]:
    """Return the settings for the release that the files are for, and why it is that one."""
    told = release_chosen_here(asked)
    said = release_of_all(told, (it for it in paths if it.endswith(_TELLING)))
    settings = settings._replace(distro=said.release, ros=ROS_2 if told else "")
    return settings, said.why or why_here(asked)


def _files_to_lint(
    options: argparse.Namespace, config: Configured
) -> tuple[list[str], list[Finding]]:
    """Return the files to lint, and findings for folders that cannot be read."""
    paths = plain_words(options)
    if paths == [STDIN]:
        return paths, []
    refused: list[Finding] = []

    def refuse(error: OSError) -> None:
        from multibot_rewrite.lint.registry import RULES

        level = RULES["MB102"].level
        message = f"cannot be read: {error.strerror}"
        refused.append(Finding("MB102", level, message, "", error.filename, 1, 1))

    read = find_files(paths, SUFFIXES, options.no_default_excludes, refuse, is_linted)
    found = read.files
    # What is found below "." is named as git names it.
    if "." in paths:
        found = [path if path in paths else path.removeprefix("./") for path in found]
    kept = [path for path in found if path in paths or not is_excluded(path, config)]
    if read.left_out:
        note(options, read.left_out)
    if not kept:
        raise UsageError(f"{', '.join(paths)}: exclude leaves no file to lint; name a file itself")
    if not options.changed_since:
        return kept, refused
    from multibot_rewrite.lint.config.changed import changed_since  # a plain run needs no git

    return changed_since(options.changed_since, kept), refused


def _check_selecting(options: argparse.Namespace, paths: Sequence[str]) -> None:
    """Raise UsageError for an option that does not apply to any of the files."""
    if STDIN in paths or not paths:
        return
    check_xacro(options, paths)
    alone = (".urdf", ".xacro", ".sdf")
    if options.urdf and all(it.endswith(alone) and ".srdf" not in it for it in paths):
        raise UsageError("--urdf is for an SRDF or a related file; no such file is given")


def _check_shared(
    options: argparse.Namespace,
    configured_alone: Configured,
    settings: Settings,
    paths: Sequence[str],
    findings: Sequence[Finding],
) -> None:
    """Raise UsageError for a name of ``--shared`` that is in none of the files and changes nothing."""
    from multibot_rewrite.cli.rewrite_use import check_shared  # few ask for it

    def linted(naming: Mapping[str, Any]) -> list[Finding]:
        changed = with_options(configured_alone, **{**given(options), **naming})
        return lint_files(paths, settings._replace(naming=changed.settings.naming))

    check_shared(options, findings, linted, {}, paths)


def _lint(options: argparse.Namespace, settings: Settings, paths: Sequence[str]) -> list[Finding]:
    """Return the findings in the files, or in standard input."""
    if list(paths) == [STDIN]:
        from multibot_rewrite.lint.check import lint_data

        return lint_data("<stdin>", standard_input(), settings)
    watch = partial(watched, total=len(paths), doing="linting")
    with cached(options, settings) as cache:
        findings = lint_files(paths, settings, watch=watch, cache=cache)
    if not options.fix or not _apply_fixes(options, among(paths, settings), findings):
        return findings
    # Anew, and all: what is written in one file is found through others.
    return lint_files(paths, settings)


def _apply_fixes(
    options: argparse.Namespace, settings: Settings, findings: list[Finding]
) -> list[str]:
    """Apply fixes and return the fixed files. With --diff print the changes and fix none."""
    from multibot_rewrite.cli.output import diff
    from multibot_rewrite.description.sources.read import read_file
    from multibot_rewrite.lint.fix import fix

    files = sorted({it.file for it in findings if it.edits})
    old = {file: read_file(file) for file in files}
    new = {file: fix(file, old[file], settings) for file in files}
    if options.diff and files:
        for file, (data, _) in new.items():
            print_bytes(diff(old[file], data, file, f"{file} fixed", prints_colour(options)))
        return []
    write_files(options, ((file, data) for file, (data, _) in new.items()))
    note(options, f"fixed {', '.join(files)}" if files else "nothing that --fix can fix")
    return files


def _conclude(
    options: argparse.Namespace,
    config: Configured,
    paths: Sequence[str],
    findings: Sequence[Finding],
    why: str,
) -> int:
    """Report the findings beyond the baseline; return the exit code."""
    stale = 0
    if config.baseline:
        from multibot_rewrite.lint.config.baseline import beyond, read_baseline

        known = read_baseline(config.baseline)
        findings, stale = beyond(findings, known, config.baseline, paths)
    options.fail_on = config.fail_on
    about = About(paths, by_themselves(config.settings.robots), config.settings.distro)
    if options.fix and options.diff:
        failed = fails(findings, config.fail_on)
    elif options.format == TEXT:
        failed = report_first(options, findings, about, NO_RULES)
    else:
        from multibot_rewrite.lint.registry import RULES  # where all is known from before

        failed = report_first(options, findings, about, RULES)
    end = facts_of_release(config.settings.distro, why)
    note(options, f"{_summary(options, paths, findings, stale)}{end}")
    if any(it.code == CRASHED for it in findings):
        return UNUSABLE
    return STOPPED if failed else DONE


def _summary(
    options: argparse.Namespace, paths: Sequence[str], findings: Sequence[Finding], stale: int
) -> str:
    files = plural(len(paths), "file")
    changed = f" changed since {options.changed_since}" if options.changed_since else ""
    fixable = sum(bool(it.edits) for it in findings)
    hint = f"; --fix fixes {fixable}" if fixable and not options.fix else ""
    old = f"; {stale} in the baseline are gone" if stale else ""
    counted = in_words(counts(findings)) or "no findings"
    return f"{files}{changed}: {counted}{hint}{old}"


def check_use(options: argparse.Namespace) -> None:
    """Raise UsageError for missing paths and for options that exclude each other."""
    paths = plain_words(options)
    if not paths:
        raise UsageError("no PATH given; for example: urdf-lint urdf/")
    if "" in paths:
        raise UsageError("the name of a file is empty; write its path")
    if "-" in paths and (len(paths) > 1 or options.fix or options.changed_since):
        raise UsageError("standard input is linted alone, without --fix and --changed-since")
    if options.diff and not options.fix:
        raise UsageError("--diff shows what --fix would change: give both")
    if options.diff and options.output:
        raise UsageError("--diff prints to standard output: leave out --output")
    if options.write_baseline and (options.fix or options.baseline or options.output):
        raise UsageError("--write-baseline takes neither --fix, --baseline nor --output")


@contextmanager
def cached(options: argparse.Namespace, settings: Settings) -> Iterator[Cache | None]:
    """Yield the cache, saved at the end; None with --trust or if it cannot be set up."""
    # What trusted files look at is not known.
    if options.trust:
        yield None
        return
    from multibot_rewrite.lint.cache.cache import Cache, cache_folder, identity

    try:
        cache = Cache(cache_folder(), identity(settings))
    except (OSError, ValueError, DefinitionsError):  # reported where it is read
        cache = None
    yield cache
    if cache:
        try:
            cache.save()
        except OSError as error:
            detail(options, f"the cache is not kept: {cache.folder}: {error.strerror}")


def given(options: argparse.Namespace) -> dict[str, object]:
    """Return the settings of the command line, by the names of ``with_options``."""
    said: dict[str, object] = {
        name: tuple(value) for name in _LISTS if (value := getattr(options, name))
    }
    said |= {name: value for name in _PLAIN if (value := getattr(options, name))}
    arguments = filled(xacro_args(options), *options.robots[:1])
    return {**policy(options), **said, "arguments": tuple(arguments.items())}
