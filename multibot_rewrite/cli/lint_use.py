"""The options of ``urdf-lint``: which do not go together, and what they say of the settings."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from multibot_rewrite.base.model import UsageError, VocabularyError
from multibot_rewrite.cli.output import detail
from multibot_rewrite.cli.usage import plain_words, policy, xacro_args
from multibot_rewrite.description.sources.own_names import filled
from multibot_rewrite.rules.settings import Settings

if TYPE_CHECKING:
    from multibot_rewrite.lint.cache.cache import Cache

_LISTS = ("select", "ignore", "robots", "roots", "target", "vocabulary")
_PLAIN = ("urdf", "baseline", "fail_on", "trust")


def check_use(options: argparse.Namespace) -> None:
    """Raise UsageError for what cannot be meant."""
    paths = plain_words(options)
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
    if options.statistics and (options.format != "text" or options.diff or options.write_baseline):
        raise UsageError("--statistics is a table: leave out --format, --diff and --write-baseline")
    if options.write_baseline and (options.fix or options.baseline or options.output):
        raise UsageError("--write-baseline takes neither --fix, --baseline nor --output")


@contextmanager
def cached(options: argparse.Namespace, settings: Settings) -> Iterator[Cache | None]:
    """The cache for a lint, which is saved at the end; a folder that cannot be written is no error."""
    # What trusted files look at is not known.
    if options.no_cache or options.trust:
        yield None
        return
    from multibot_rewrite.lint.cache.cache import Cache, cache_folder
    from multibot_rewrite.lint.cache.identity import identity

    try:
        cache = Cache(cache_folder(), identity(settings))
    except (OSError, ValueError, VocabularyError):  # reported where it is read
        cache = None
    yield cache
    if cache:
        try:
            cache.save()
        except OSError as error:
            detail(options, f"the cache is not kept: {cache.folder}: {error.strerror}")


def given(options: argparse.Namespace) -> dict[str, object]:
    """What the command line says about the settings, by the names of ``with_options``."""
    said: dict[str, object] = {
        name: tuple(value) for name in _LISTS if (value := getattr(options, name))
    }
    said |= {name: value for name in _PLAIN if (value := getattr(options, name))}
    arguments = filled(xacro_args(options), *options.robots[:1])
    return {**policy(options), **said, "arguments": tuple(arguments.items())}
