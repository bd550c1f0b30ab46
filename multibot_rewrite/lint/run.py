# SPDX-License-Identifier: Apache-2.0
"""Many files -> their findings, in parallel; the result does not depend on the number of workers."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from typing import TYPE_CHECKING

from multibot_rewrite.base.findings.finding import Finding, by_place
from multibot_rewrite.base.outside import Asked, digest, recorded
from multibot_rewrite.rules.settings import Settings

if TYPE_CHECKING:
    from multibot_rewrite.lint.cache.cache import Cache

# A worker costs more to start than a few files to lint.
FEW = 12
EACH = 4
# CPU seconds beyond the time of a file, after which a worker is ended.
GRACE = 1.0
AMONG = "among"
Watch = Callable[[Iterable["Linted"]], Iterable["Linted"]]
Linted = tuple[list[Finding], Asked | None]


def lint_files(
    paths: Sequence[str],
    settings: Settings,
    *,
    jobs: int = 0,
    watch: Watch = iter,
    cache: Cache | None = None,
) -> list[Finding]:
    """Return every finding of the files, each once, in the order of files and lines.

    ``jobs`` is the number of processes, 0 for one on each processor it may use; ``watch`` wraps the
    iteration over the files' findings, for a progress bar. With a ``cache`` only files are linted for
    which something changed; the caller saves it."""
    settings = among(paths, settings, cache)
    found = {path: _kept_findings(cache, path, settings) for path in paths} if cache else {}
    if unknown := [path for path in paths if found.get(path) is None]:
        # Plugin faulty definitions is reported before anything is linted.
        from multibot_rewrite.description.rewriters.tree import builtin_tree

        builtin_tree(settings.definitions, settings.distro)
        linted = _linted(unknown, settings, jobs, watch)
        for path, (its, asked) in zip(unknown, linted, strict=True):
            found[path] = its
            if cache:
                cache.keep(_group(path), _key(path, settings), its, asked)
    return _in_order(_once(it for path in paths for it in found[path] or ()), paths)


def _kept_findings(cache: Cache, path: str, settings: Settings) -> list[Finding] | None:
    from multibot_rewrite.lint.cache.cache import findings_from

    return findings_from(cache.recall(_group(path), _key(path, settings)))


def _group(path: str) -> str:
    """Return the group of a file: the files of one folder are kept together."""
    return os.path.dirname(os.path.abspath(path))


def _key(path: str, settings: Settings) -> str:
    """Return the key of a file's findings: its place among the others, beyond the run and its text."""
    from multibot_rewrite.lint.cache.cache import among_written

    return digest(repr((path, *among_written(settings, path))).encode())


def among(paths: Sequence[str], settings: Settings, cache: Cache | None = None) -> Settings:
    """Return the settings for one of several files: includes, URDFs of SRDFs, xacro arguments."""
    if len(paths) == 1 and not paths[0].endswith(".xacro"):
        return settings
    from multibot_rewrite.lint.cache.cache import among_from, among_written

    key = digest("\n".join(paths).encode("utf-8", "surrogateescape"))
    known = among_from(cache.recall(AMONG, key), settings) if cache else None
    if known is not None:
        return known
    found, asked = _settings_of_files(paths, settings)
    if cache:
        cache.keep(AMONG, key, among_written(found), asked)
    return found


def _settings_of_files(paths: Sequence[str], settings: Settings) -> tuple[Settings, Asked | None]:
    """Return the settings, made in a worker if there are xacro files: these may take long."""
    from multibot_rewrite.lint.files.included import set_among

    look = partial(recorded, partial(set_among, paths, settings))
    if not any(path.endswith(".xacro") for path in paths):
        return look()
    from multibot_rewrite.base.workers import limit_time, worker_pool

    def within(_: str) -> tuple[Settings, Asked | None]:
        limit_time(settings.seconds)
        return look()

    # Looked at alone, each file is linted all the same.
    with worker_pool(within, [AMONG], lambda *_: (settings, None), 1) as workers:
        return next(workers.results())


def _linted(paths: Sequence[str], settings: Settings, jobs: int, watch: Watch) -> Iterable[Linted]:
    """Return findings and questions of each file, linted in workers if there are many or xacros."""
    from multibot_rewrite.lint.check import lint_file

    # What a few lines of xacro expand to may be more than a process survives.
    in_this_process = not any(path.endswith(".xacro") for path in paths)
    if in_this_process and (jobs == 1 or len(paths) <= FEW):
        return list(watch(recorded(partial(lint_file, path, settings)) for path in paths))
    from multibot_rewrite.base.workers import limit_time, processors, worker_pool
    from multibot_rewrite.lint.failures import lost, too_long

    def lint(path: str) -> Linted:
        limit_time(settings.seconds + GRACE)
        return recorded(partial(lint_file, path, settings))

    def unfinished(path: str, died_of: int) -> Linted:
        if died_of == signal.SIGXCPU:
            return [too_long(path, settings.seconds)], None
        return [lost(path, died_of)], None

    many = min(jobs or processors(), -(-len(paths) // EACH))
    with worker_pool(lint, paths, unfinished, many) as workers:
        return list(watch(workers.results()))


def _once(found: Iterable[Finding]) -> list[Finding]:
    """Return one finding for each place in a macro, however many calls or files lead to it."""
    alike: dict[tuple[object, ...], dict[str, Finding]] = {}
    for it in found:
        place = (it.code, it.level, it.file, it.line, it.column)
        key = place if it.calls else (*place, it.message, it.hint)
        alike.setdefault(key, {}).setdefault(it.message, it)
    return [_with_others(*its.values()) for its in alike.values()]


def _with_others(first: Finding, *others: Finding) -> Finding:
    """Return the first of several findings at one place, whose hint counts the others."""
    if not others:
        return first
    also = f"and {len(others)} more from other calls of the macro"
    return first._replace(hint=f"{first.hint}; {also}" if first.hint else also)


def _in_order(found: Iterable[Finding], paths: Sequence[str]) -> list[Finding]:
    """Return findings by file, the files that were given first; then by line."""
    rank = {path: at for at, path in enumerate(paths)}
    for it in found:
        rank.setdefault(it.file, len(rank))
    return sorted(found, key=lambda it: (rank[it.file], by_place(it)))
