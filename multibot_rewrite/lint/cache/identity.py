"""What all results of a run rest on: this program, its libraries, the vocabulary, the settings."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Mapping
from importlib.util import find_spec

from multibot_rewrite.base.bounded import read_bytes
from multibot_rewrite.base.outside import digest
from multibot_rewrite.description.rewriters.vocabulary.installed import installed
from multibot_rewrite.rules.settings import Settings
from multibot_rewrite.version import __version__

# What reads descriptions; xacro may be that of a sourced ROS.
LIBRARIES = ("lxml", "xacro", "yaml")
_COMPILED = "__pycache__"
_HERE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def identity(settings: Settings) -> str:
    """A digest of the program, the vocabulary and the settings; raises VocabularyError, OSError."""
    where = (os.getcwd(), sys.version, os.uname().release, str(os.geteuid()))
    folders = [_HERE, *map(_folder_of, LIBRARIES)]
    programs = [_state(it) for folder in folders for it in _files(folder)]
    return digest(repr((__version__, where, programs, _vocabulary(settings), plain(settings))))


def plain(value: object) -> object:
    """A value with mappings and sets in order, so that the same value is written the same."""
    if isinstance(value, Mapping):
        return [(plain(key), plain(it)) for key, it in sorted(value.items())]
    if isinstance(value, frozenset):
        return sorted(value)
    if isinstance(value, (tuple, list)):
        return [plain(it) for it in value]
    return value


def _vocabulary(settings: Settings) -> list[tuple[str, str]]:
    """The files that are read beside those built in."""
    paths = [*(it.path for it in installed()), *settings.vocabulary]
    return [(path, digest(read_bytes(path))) for path in paths]


def _folder_of(library: str) -> str:
    spec = find_spec(library)
    return os.path.dirname(spec.origin) if spec and spec.origin else ""


def _files(folder: str) -> Iterator[str]:
    for top, folders, names in os.walk(folder):
        folders[:] = sorted(it for it in folders if it != _COMPILED)
        yield from (os.path.join(top, it) for it in sorted(names))


def _state(path: str) -> tuple[str, int, int]:
    it = os.stat(path)
    return path, it.st_mtime_ns, it.st_size
