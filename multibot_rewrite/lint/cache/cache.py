# SPDX-License-Identifier: Apache-2.0
"""The cache of one run: what is remembered, how it is written, and what all of it rests on."""

import os
import sys
from _thread import get_ident  # threading is slow to import
from collections.abc import Iterator, Mapping
from contextlib import suppress
from importlib.util import find_spec
from typing import Any, NamedTuple

from multibot_rewrite.base.bounded import load_json, read_bytes
from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import Edit
from multibot_rewrite.base.outside import Asked, Question, answer_now, digest
from multibot_rewrite.description.rewriters.installed import installed
from multibot_rewrite.rules.settings import Settings
from multibot_rewrite.version import __version__

# Of one file, and of all files of the cache; the oldest ones go.
MOST_BYTES, MOST_IN_ALL, MOST_FILES = 16 * 2**20, 256 * 2**20, 4096
FOLDER = os.path.join("multibot_rewrite", "lint")
# How bytes are texts, and the key of the map that holds one.
_BYTES = "latin-1"


class Entry(NamedTuple):
    """A result, which JSON can hold, and the answers that it rests on."""

    value: Any
    asked: Asked


def read_shard(path: str) -> dict[str, Entry]:
    """Return the entries of a file; empty if it is missing, damaged or no file of the cache."""
    try:
        with open(path, "rb") as file:
            data = file.read(MOST_BYTES + 1)
        told, _, body = data.partition(b"\n")
        if told.decode() != digest(body):
            return {}
        table, entries = load_json(body)
        asked = [
            (Question(name, _from_json(args), _from_json(named)), it)
            for name, args, named, it in table
        ]
        return {
            key: Entry(_from_json(value), dict(asked[number] for number in numbers))
            for key, (value, numbers) in entries.items()
        }
    except (OSError, ValueError, LookupError, TypeError, AttributeError, RecursionError):
        return {}


def shard_bytes(entries: Mapping[str, Entry]) -> bytes:
    """Return the bytes of a file; a question that several entries have is written once."""
    import json  # slow to import, and often nothing is new

    numbers: dict[tuple[Question, str], int] = {}
    written = {
        key: (it.value, [numbers.setdefault(pair, len(numbers)) for pair in it.asked.items()])
        for key, it in entries.items()
    }
    table = [(*question, answer) for question, answer in numbers]
    body = json.dumps(
        (table, written), separators=(",", ":"), default=lambda it: {_BYTES: it.decode(_BYTES)}
    ).encode()
    return f"{digest(body)}\n".encode() + body


def write_shard(path: str, data: bytes) -> None:
    """Replace the file as a whole, whoever reads or writes it at the same time; raises OSError."""
    os.makedirs(os.path.dirname(path), mode=0o700, exist_ok=True)
    temporary = f"{path}.{os.getpid()}.{get_ident()}"
    try:
        with open(temporary, "wb") as file:
            file.write(data)
        os.replace(temporary, path)
    except BaseException:
        with suppress(OSError):
            os.unlink(temporary)
        raise


def bound(folder: str) -> None:
    """Remove the files used longest ago from a cache that is too large, until it is half as large."""
    files = []
    with os.scandir(folder) as found:
        for it in found:
            with suppress(OSError):  # another run was faster
                state = it.stat(follow_symlinks=False)
                files.append((state.st_mtime_ns, state.st_size, it.path))
    files.sort(reverse=True)
    total = sum(size for _, size, _ in files)
    if total <= MOST_IN_ALL and len(files) <= MOST_FILES:
        return
    left = 0
    for number, (_, size, path) in enumerate(files):
        left += size
        if left > MOST_IN_ALL // 2 or number >= MOST_FILES // 2:
            with suppress(OSError):
                os.unlink(path)


def _from_json(value: Any) -> Any:
    """Return a value read from JSON with tuples for its lists, and bytes for its maps."""
    if isinstance(value, dict):
        return value[_BYTES].encode(_BYTES)
    return tuple(map(_from_json, value)) if isinstance(value, list) else value


def cache_folder() -> str:
    """Return the folder of the cache: below XDG_CACHE_HOME, else ~/.cache."""
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
        """Return the kept result, None if there is none that still holds."""
        path = self._path(group)
        if path not in self.shards:
            self.shards[path] = read_shard(path)
        entry = self.shards[path].get(key)
        asked = entry.asked.items() if entry else ()
        holds = all(self._answer(question) == answer for question, answer in asked)
        return entry.value if entry and holds else None

    def _answer(self, question: Question) -> str:
        """Return the digest of the answer to a question now, asked once; "" if it has none."""
        if question not in self.answers:
            try:
                self.answers[question] = answer_now(question)
            except (LookupError, ImportError):
                self.answers[question] = ""
        return self.answers[question]

    def keep(self, group: str, key: str, value: Any, asked: Asked | None) -> None:
        """Remember a result, unless it may change by itself (``asked`` is None)."""
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


def findings_from(value: Any) -> list[Finding] | None:
    """Return the findings in a kept value; None if none are kept, or the value is no such one."""
    try:
        rows = value if value is None else list(map(Finding._make, value))
        return rows and [it._replace(edits=tuple(map(Edit._make, it.edits))) for it in rows]
    except (TypeError, ValueError):
        return None


def among_written(settings: Settings, path: str = "") -> tuple[Any, ...]:
    """Return what the settings know of the other files, as plain values; of ``path`` only its part."""
    part = settings.included & {path} if path else settings.included
    return sorted(part), settings.urdfs, settings.elsewhere


def among_from(value: Any, settings: Settings) -> Settings | None:
    """Return the settings with the plain values that ``among_written`` gave; None for none."""
    from multibot_rewrite.description.sources.known_arguments import KnownArguments

    try:
        part, urdfs, known = _from_json(value)
        elsewhere = known and KnownArguments._make(known)
        pairs = tuple((name, path) for name, path in urdfs)
        return settings._replace(included=frozenset(part), urdfs=pairs, elsewhere=elsewhere)
    except (TypeError, ValueError):
        return None


# What reads descriptions; xacro may be that of a sourced ROS.
LIBRARIES = ("lxml", "xacro", "yaml")
_HERE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def identity(settings: Settings) -> str:
    """Return a digest of program, plugin definitions and settings; raises DefinitionsError, OSError."""
    where = (os.getcwd(), sys.version, os.uname().release, str(os.geteuid()))
    specs = filter(None, map(find_spec, LIBRARIES))
    folders = filter(None, (_HERE, *(os.path.dirname(it.origin or "") for it in specs)))
    programs = sorted(it for folder in folders for it in _file_states(folder))
    paths = [*(it.path for it in installed()), *settings.definitions]
    # What is read beyond what is built in.
    definitions = [(path, digest(read_bytes(path))) for path in paths]
    return digest(repr((__version__, where, programs, definitions, plain(settings))))


def plain(value: object) -> object:
    """Return a value with its mappings and sets sorted, so that equal values are written alike."""
    if isinstance(value, Mapping):
        return [(plain(key), plain(it)) for key, it in sorted(value.items())]
    if isinstance(value, frozenset):
        return sorted(value)
    if isinstance(value, (tuple, list)):
        return [plain(it) for it in value]
    return value


def _file_states(folder: str) -> Iterator[tuple[str, int, int]]:
    """Yield path, time and size of each file below a folder."""
    with os.scandir(folder) as found:
        for it in found:
            if not it.is_dir(follow_symlinks=False):
                of = it.stat()
                yield it.path, of.st_mtime_ns, of.st_size
            elif it.name != "__pycache__":
                yield from _file_states(it.path)
