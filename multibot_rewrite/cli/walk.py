# SPDX-License-Identifier: Apache-2.0
"""Which files a command reads when it is given files and folders."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import NoReturn

from multibot_rewrite.base.bounded import MAX_BYTES
from multibot_rewrite.base.model import InputError, UsageError


def _refuse(error: OSError) -> NoReturn:
    raise InputError(f"{error.filename}: cannot be read: {error.strerror}") from None


def find_files(
    paths: Sequence[str],
    suffixes: tuple[str, ...],
    unreadable: Callable[[OSError], None] = _refuse,
    wanted: Callable[[str], bool] = bool,
) -> list[str]:
    """The files named, and those with one of the suffixes below the folders named; each file once.

    ``unreadable`` is called for folders that cannot be read, ``wanted`` for each file in a folder.
    Raises UsageError where a path is not there or nothing is found; InputError for such a folder unless
    ``unreadable`` goes on.
    """
    found: dict[str, str] = {}
    for path in paths:
        if not os.path.exists(path):
            raise UsageError(f"{path}: there is no such file or folder")
        below = filter(wanted, _below(path, suffixes, unreadable))
        for file in below if os.path.isdir(path) else (path,):
            found.setdefault(os.path.realpath(file), file)
    if not found:
        names = " or ".join(f"*{suffix}" for suffix in suffixes)
        raise UsageError(f"{', '.join(paths)}: no {names} there; name a file or another folder")
    return list(found.values())


def _below(
    top: str, suffixes: tuple[str, ...], unreadable: Callable[[OSError], None]
) -> Iterator[str]:
    """In order of names, without hidden folders; links are followed, each folder is visited once."""
    seen = set()
    for folder, folders, files in os.walk(top, onerror=unreadable, followlinks=True):
        real = os.path.realpath(folder)
        if real in seen:
            folders.clear()
            continue
        seen.add(real)
        folders[:] = sorted(it for it in folders if not it.startswith("."))
        paths = [os.path.join(folder, name) for name in sorted(_named(files, suffixes))]
        # A dead link is reported when it is read; a pipe would never end.
        yield from (path for path in paths if os.path.isfile(path) or not os.path.exists(path))


def _named(files: Iterable[str], suffixes: tuple[str, ...]) -> Iterator[str]:
    return (name for name in files if name.lower().endswith(suffixes))


def standard_input() -> bytes:
    """All of standard input; raises InputError."""
    if sys.stdin is None:
        raise InputError("<stdin>: standard input is closed; name a file instead of -")
    try:
        data = sys.stdin.buffer.read(MAX_BYTES + 1)
    except OSError as error:
        raise InputError(f"<stdin>: cannot be read: {error.strerror}") from None
    if len(data) > MAX_BYTES:
        raise InputError(f"<stdin>: cannot be read: it is over the limit of {MAX_BYTES:,} bytes")
    return data


def check_target(target: str, inputs: Iterable[str], option: str = "--output") -> None:
    """Raise UsageError where writing ``target`` would replace one of the files that are read."""
    if any(is_same_file(target, path) for path in inputs):
        raise UsageError(f"{target} is a file that is read; choose another one for {option}")


def check_link(target: str) -> None:
    """Raise UsageError where ``target`` is a link out of its folder: a result would
    replace what nobody named. The links of the system, as /dev/stdout is, are what they lead to."""
    folder = os.path.realpath(os.path.dirname(target) or ".")
    if not os.path.islink(target) or folder.startswith(("/dev", "/proc")):
        return
    real = os.path.realpath(target)
    if os.path.commonpath((real, folder)) != folder:
        raise UsageError(f"{target} is a link to {real}; name that, if it is meant")


def is_same_file(path: str, other: str) -> bool:
    """Do two paths lead to one file, by links of either kind or not?"""
    if os.path.realpath(path) == os.path.realpath(other):
        return True
    return os.path.isfile(path) and os.path.isfile(other) and os.path.samefile(path, other)


def check_folder(target: str) -> None:
    """Raise UsageError where the folder of ``target`` cannot be made, before the work."""
    from multibot_rewrite.cli.files import existing_folder

    above = existing_folder(target)
    if not os.path.isdir(above):
        raise UsageError(f"{target}: cannot be written: {above} is a file, not a folder")
