"""Many files -> their findings, in parallel; the result does not depend on the number of workers."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Iterable, Sequence

from multibot_rewrite.findings.finding import Finding
from multibot_rewrite.lint.check import by_place, lint_file
from multibot_rewrite.lint.config.settings import Settings
from multibot_rewrite.lint.failures import lost, too_long
from multibot_rewrite.lint.files.included import included, known_elsewhere
from multibot_rewrite.lint.files.pairing import named_urdfs
from multibot_rewrite.rewriters.builtin import builtin_tree

# A worker costs more to start than a few files to lint.
FEW = 12
EACH = 4
# CPU seconds beyond the time of a file, after which a worker is ended.
GRACE = 1.0
Watch = Callable[[Iterable[list[Finding]]], Iterable[list[Finding]]]


def lint_files(
    paths: Sequence[str], settings: Settings, *, jobs: int = 0, watch: Watch = iter
) -> list[Finding]:
    """Every finding of the files, each once, in the order of files and lines.

    ``jobs`` is the number of processes, 0 for as many as there are processors; ``watch`` wraps the
    iteration over the files' findings, for a progress bar.
    """
    settings = among(paths, settings)
    # A faulty vocabulary is reported before anything is linted.
    builtin_tree(settings.vocabulary, settings.distro)
    found = _linted(paths, settings, jobs or os.cpu_count() or 1, watch)
    return _in_order(_once(it for its in found for it in its), paths)


def among(paths: Sequence[str], settings: Settings) -> Settings:
    """The settings for one of several files: what the others include, the URDFs of SRDFs, and
    the arguments that xacro files know."""
    settings = settings._replace(included=included(paths))
    known = known_elsewhere(paths) if settings.arguments else None
    return settings._replace(urdfs=named_urdfs(paths, settings.included), elsewhere=known)


def _linted(
    paths: Sequence[str], settings: Settings, jobs: int, watch: Watch
) -> Iterable[list[Finding]]:
    # What a few lines of xacro expand to may be more than a process survives.
    in_this_process = not any(path.endswith(".xacro") for path in paths)
    if in_this_process and (jobs == 1 or len(paths) <= FEW):
        return list(watch(lint_file(path, settings) for path in paths))
    from multibot_rewrite.lint.workers import limit_time, worker_pool

    def lint(path: str) -> list[Finding]:
        limit_time(settings.seconds + GRACE)
        return lint_file(path, settings)

    def unfinished(path: str, died_of: int) -> list[Finding]:
        if died_of == signal.SIGXCPU:
            return [too_long(path, settings.seconds)]
        return [lost(path, died_of)]

    with worker_pool(lint, paths, unfinished, min(jobs, -(-len(paths) // EACH))) as workers:
        return list(watch(workers.results()))


def _once(found: Iterable[Finding]) -> list[Finding]:
    """One place in a macro is one finding, however many calls, of however many files, reach it."""
    alike: dict[tuple[object, ...], dict[str, Finding]] = {}
    for it in found:
        place = (it.code, it.level, it.file, it.line, it.column)
        key = place if it.calls else (*place, it.message, it.hint)
        alike.setdefault(key, {}).setdefault(it.message, it)
    return [_with_others(*its.values()) for its in alike.values()]


def _with_others(first: Finding, *others: Finding) -> Finding:
    if not others:
        return first
    also = f"and {len(others)} more from other calls of the macro"
    return first._replace(hint=f"{first.hint}; {also}" if first.hint else also)


def _in_order(found: Iterable[Finding], paths: Sequence[str]) -> list[Finding]:
    """By file, those that were asked for first; then by line."""
    rank = {path: at for at, path in enumerate(paths)}
    for it in found:
        rank.setdefault(it.file, len(rank))
    return sorted(found, key=lambda it: (rank[it.file], by_place(it)))
