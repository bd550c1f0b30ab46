"""Many files -> their findings, side by side; the same whatever the number of workers."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial

from multibot_rewrite.lint.check import lint_file
from multibot_rewrite.lint.included import included
from multibot_rewrite.lint.pairing import named_urdfs
from multibot_rewrite.lint.records import LintFinding
from multibot_rewrite.lint.settings import Settings

# A worker costs more to start than a few files to lint.
FEW = 12
Watch = Callable[[Iterable[list[LintFinding]]], Iterable[list[LintFinding]]]


def lint_files(
    paths: Sequence[str], settings: Settings, *, jobs: int = 0, watch: Watch = iter
) -> list[LintFinding]:
    """Every finding of the files, each once, in the order of files and lines.

    ``jobs`` is the number of processes, 0 for as many as there are processors; ``watch`` sees the
    files' findings pass, for a progress bar.
    """
    settings = _with_urdfs(paths, settings._replace(included=included(paths)))
    found = watch(_linted(paths, settings, jobs or os.cpu_count() or 1))
    # An included file may be reached from several.
    return list(dict.fromkeys(finding for findings in found for finding in findings))


def _linted(paths: Sequence[str], settings: Settings, jobs: int) -> Iterator[list[LintFinding]]:
    lint = partial(lint_file, settings=settings)
    if jobs == 1 or len(paths) <= FEW:
        yield from map(lint, paths)
        return
    from concurrent.futures import ProcessPoolExecutor

    with ProcessPoolExecutor(jobs) as pool:
        yield from pool.map(lint, paths, chunksize=4)


def _with_urdfs(paths: Sequence[str], settings: Settings) -> Settings:
    """SRDF files find their URDF among the files, whoever lints which."""
    return settings._replace(urdfs=named_urdfs(paths, settings.included))
