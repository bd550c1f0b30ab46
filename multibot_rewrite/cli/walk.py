# SPDX-License-Identifier: Apache-2.0
"""Which files a command reads when it is given files and folders."""

import os
import sys
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from typing import NamedTuple, NoReturn

from multibot_rewrite.base.bounded import MAX_BYTES
from multibot_rewrite.base.left_out import ignored_by_git, is_hidden, source_folders
from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.base.wording import plural, shorten, unique

EVERYTHING = "--no-default-excludes"


def _raise_unreadable(error: OSError) -> NoReturn:
    raise InputError(f"{error.filename}: cannot be read: {error.strerror}") from None


class FoundFiles(NamedTuple):
    """The files that a command reads, and what was left out below the folders that were named."""

    files: list[str]
    folders: Sequence[str] = ()
    ignored: Sequence[str] = ()

    @property
    def left_out(self) -> str:
        """What was left out, and how to include it; "" for nothing."""
        folders = f"{plural(len(self.folders), 'folder')} ({shorten(self.folders)})"
        files = f"{plural(len(self.ignored), 'file')} that git ignores"
        parts = [folders] * bool(self.folders) + [files] * bool(self.ignored)
        return f"left out: {' and '.join(parts)}; {EVERYTHING} reads them" if parts else ""


def find_files(
    paths: Sequence[str],
    suffixes: tuple[str, ...],
    everything: bool = False,
    unreadable: Callable[[OSError], None] = _raise_unreadable,
    wanted: Callable[[str], bool] = bool,
) -> FoundFiles:
    """Return the files named, and those with one of the suffixes below the folders named; each once.

    Without ``everything``, what a build made or colcon, ament or git ignores is left out below a folder
    that is none of it. ``unreadable`` is called for folders that cannot be read, ``wanted`` for each
    file in a folder. Raises UsageError where a path is not there or nothing is found; InputError for
    such a folder unless ``unreadable`` goes on.
    """
    left_out: list[str] = []
    every: list[str] = []
    for path in paths:
        if not os.path.exists(path):
            raise UsageError(f"{path}: there is no such file or folder; correct the path")
        kept = None if everything else left_out
        below = _files_below(path, suffixes, unreadable, kept)
        every += filter(wanted, below) if os.path.isdir(path) else (path,)
    ignored = set() if everything else _git_ignored(paths, every)
    found: dict[str, str] = {}
    for path in every:
        if path not in ignored:
            found.setdefault(os.path.realpath(path), path)
    result = FoundFiles(list(found.values()), unique(left_out), sorted(ignored))
    if not found:
        names = " or ".join(f"*{suffix}" for suffix in suffixes)
        hint = result.left_out or "name a file or another folder"
        raise UsageError(f"{', '.join(paths)}: no {names} there; {hint}")
    return result


def _git_ignored(named: Collection[str], every: Iterable[str]) -> set[str]:
    """Return the files that git ignores, but not those named, or in a named folder that git ignores."""
    found = ignored_by_git(it for it in every if it not in named)
    folders = [it for it in named if os.path.isdir(it)] if found else []
    meant = [f"{it.rstrip('/')}/" for it in ignored_by_git(folders)]
    return {it for it in found if not it.startswith(tuple(meant))}


def _files_below(
    top: str,
    suffixes: tuple[str, ...],
    unreadable: Callable[[OSError], None],
    left_out: list[str] | None,
) -> Iterator[str]:
    """Yield files in the order of names; links are followed, each folder is visited once.

    Hidden folders are not visited, nor are those that are no sources, which are noted in ``left_out``
    if it is given.
    """
    seen = set()
    for folder, folders, files in os.walk(top, onerror=unreadable, followlinks=True):
        real = os.path.realpath(folder)
        if real in seen:
            folders.clear()
            continue
        seen.add(real)
        shown = sorted(it for it in folders if not is_hidden(it))
        if left_out is not None:
            folders[:] = source_folders(folder, shown)
            left_out += (os.path.join(folder, it) for it in shown if it not in folders)
        else:
            folders[:] = shown
        found = [name for name in sorted(files) if name.lower().endswith(suffixes)]
        paths = [os.path.join(folder, name) for name in found]
        # A dead link is reported when it is read; a pipe would never end.
        yield from (path for path in paths if os.path.isfile(path) or not os.path.exists(path))


def standard_input() -> bytes:
    """Return all of standard input; raises InputError."""
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
    """Raise UsageError if ``target`` is a link: a result would replace what nobody named."""
    # Links of the system, as /dev/stdout, are what they lead to.
    folder = os.path.realpath(os.path.dirname(target) or ".")
    if os.path.islink(target) and not folder.startswith(("/dev", "/proc")):
        real = os.path.realpath(target)
        raise UsageError(f"{target} is a link to {real}; name that, if it is meant")


def is_same_file(path: str, other: str) -> bool:
    """Return whether two paths lead to one file, by links of either kind or not."""
    if os.path.realpath(path) == os.path.realpath(other):
        return True
    return os.path.isfile(path) and os.path.isfile(other) and os.path.samefile(path, other)


def check_folder(target: str) -> None:
    """Raise UsageError where the folder of ``target`` cannot be made, before the work."""
    from multibot_rewrite.cli.files import existing_folder

    above = existing_folder(target)
    if not os.path.isdir(above):
        raise UsageError(f"{target}: cannot be written: {above} is a file; name another folder")
