"""The cache of one run: what is remembered, what is to be kept."""

from __future__ import annotations

import os
from typing import Any

from multibot_rewrite.base.outside import Asked, Question, answer_now, digest
from multibot_rewrite.lint.cache.shard import (
    MOST_BYTES,
    Entry,
    bound,
    read_shard,
    shard_bytes,
    write_shard,
)

FOLDER = os.path.join("multibot_rewrite", "lint")


def cache_folder() -> str:
    """Where the cache is: below XDG_CACHE_HOME, else ~/.cache."""
    told = os.environ.get("XDG_CACHE_HOME", "")
    # The specification: a relative path is not valid and is ignored.
    home = told if os.path.isabs(told) else os.path.expanduser("~/.cache")
    return os.path.join(home, FOLDER)


class Cache:
    """Results of earlier runs with one identity, a file for each ``group`` of them.

    A result is given only where all that was asked for it has the same answer now. Each question is
    asked once.
    """

    def __init__(self, folder: str, run: str) -> None:
        self.folder, self.run = folder, run
        self.shards: dict[str, dict[str, Entry]] = {}
        self.answers: dict[Question, str] = {}
        self.changed: dict[str, dict[str, Entry]] = {}

    def recall(self, group: str, key: str) -> Any:
        """The result that was kept, None where there is none that still holds."""
        path = self._path(group)
        if path not in self.shards:
            self.shards[path] = read_shard(path)
        entry = self.shards[path].get(key)
        return entry.value if entry and self._holds(entry.asked) else None

    def _holds(self, asked: Asked) -> bool:
        return all(self._answer(question) == answer for question, answer in asked.items())

    def _answer(self, question: Question) -> str:
        if question not in self.answers:
            try:
                self.answers[question] = answer_now(question)
            except (LookupError, ImportError):
                self.answers[question] = ""
        return self.answers[question]

    def keep(self, group: str, key: str, value: Any, asked: Asked | None) -> None:
        """Remember a result, unless it may be another one next time (``asked`` is None)."""
        if asked is not None:
            self.changed.setdefault(self._path(group), {})[key] = Entry(value, asked)

    def save(self) -> None:
        """Write what is new; raises OSError."""
        for path, new in self.changed.items():
            # Another run may have written since.
            data = shard_bytes({**read_shard(path), **new})
            data = data if len(data) <= MOST_BYTES else shard_bytes(new)
            if len(data) <= MOST_BYTES:
                write_shard(path, data)
        for path in self.shards.keys() - self.changed.keys():
            if self.shards[path]:
                os.utime(path)
        if self.changed and os.path.isdir(self.folder):
            bound(self.folder)

    def _path(self, group: str) -> str:
        return os.path.join(self.folder, f"{digest(f'{self.run} {group}'.encode())}.json")
