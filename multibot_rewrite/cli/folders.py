# SPDX-License-Identifier: Apache-2.0
"""A folder of results that changes as a whole: whoever looks sees the old files or the new ones.

The new folder is made next to the old one, of links to what stays, and one call of the kernel swaps
the two. Where that cannot be (a mount point, the working directory, no right to write next to it),
files are replaced one by one, all or none, and a note of what they are to be tells the next build
what a killed one has left."""

from __future__ import annotations

import ctypes
import os
import shutil
import stat
from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.cli.files import explained, make_folders, see_on_disk, write_all, write_new

STAGE = ".multibot-build"
# What a killed process may have left between files (see ``files``).
_LEFT = lazy_compile(r"\.urdf-postfix\.\d+\.\d+\.tmp(\.old)?")
# <linux/fcntl.h>, <linux/fs.h>
_HERE, _EXCHANGE = -100, 2


class _CannotSwapError(Exception):
    """The folder cannot be swapped here; ``reason`` is the cause."""


@contextmanager
def locked(folder: str) -> Iterator[None]:
    """Lock a folder: another build into it, or next to it, waits until this one is done."""
    import fcntl

    above = os.path.dirname(os.path.realpath(folder))
    while not os.path.isdir(above):
        above = os.path.dirname(above)
    try:
        handle = os.open(above, os.O_RDONLY)
    except OSError:
        yield
        return
    try:
        with suppress(OSError):
            fcntl.flock(handle, fcntl.LOCK_EX)
        yield
    finally:
        os.close(handle)


def check_inside(folder: str, paths: Iterable[str]) -> None:
    """Raise UsageError where a link or a file in a folder's place leads a path out of ``folder``."""
    every = (path.split("/") for path in paths)
    for part in sorted({"/".join(it[:end]) for it in every for end in range(1, len(it) + 1)}):
        full = os.path.join(folder, part)
        if os.path.islink(full):
            raise UsageError(
                f"{full}: it is a link, and a build writes nothing elsewhere; remove it"
            )


def change_folder(
    folder: str, write: Mapping[str, bytes], remove: Collection[str], note: tuple[str, bytes]
) -> None:
    """Make ``folder`` hold the files ``write``, without the files ``remove``, and what else it held.

    ``note`` is a file with what a build wants, for the time in which files are replaced one by one.
    Raises UsageError with path and cause; everything is as it was then.
    """
    real = os.path.realpath(folder)
    made: list[str] = []
    with _removed_unless_done(made):
        with explained(folder):
            make_folders(os.path.dirname(real), made)
        try:
            _swap(real, write, remove, note[0])
        except _CannotSwapError:
            _one_by_one(real, write, remove, note)
        made.clear()


@contextmanager
def _removed_unless_done(made: list[str]) -> Iterator[None]:
    try:
        yield
    finally:
        for folder in reversed(made):
            with suppress(OSError):
                os.rmdir(folder)


def clear_leftovers(folder: str) -> None:
    """Remove what builds that were killed have left, next to the folder and in it."""
    real = os.path.realpath(folder)
    above, name = os.path.split(real)
    with suppress(OSError):
        for left in os.listdir(above):
            if left.startswith(f".{name}.") and left.endswith(STAGE):
                shutil.rmtree(os.path.join(above, left), ignore_errors=True)
        for path, entry in list(_walk(real)):
            if _LEFT.fullmatch(entry.name):
                os.unlink(os.path.join(real, path))


def _swap(folder: str, write: Mapping[str, bytes], remove: Collection[str], note: str) -> None:
    """Make a new folder next to the old one and exchange them; raises if it is impossible."""
    above, name = os.path.split(folder)
    if os.path.ismount(folder) or (
        os.path.commonpath([os.path.realpath(os.getcwd()), folder]) == folder
    ):
        raise _CannotSwapError
    stage = os.path.join(above, f".{name}.{os.getpid()}{STAGE}")
    try:
        try:
            os.mkdir(stage)
        except OSError:
            raise _CannotSwapError from None
        if os.path.isdir(folder):
            _link_all(folder, stage, {*write, *remove, note})
            _prune(stage, remove)
        _write_all(folder, stage, write)
        _exchange(stage, folder)
        _bring_late(stage, folder, {*write, *remove, note})
    finally:
        shutil.rmtree(stage, ignore_errors=True)


def _link_all(folder: str, stage: str, but: Collection[str]) -> None:
    """Make a copy of a folder with links to its files, except the given paths."""
    _copy_attributes(stage, folder)
    for path, entry in _walk(folder):
        target = os.path.join(stage, path)
        try:
            if entry.is_dir(follow_symlinks=False):
                os.mkdir(target)
                _copy_attributes(target, entry.path)
            elif path not in but and not _LEFT.fullmatch(entry.name):
                os.link(entry.path, target, follow_symlinks=False)
        except OSError:
            raise _CannotSwapError from None


def _copy_attributes(folder: str, other: str) -> None:
    """Set mode, times and, where permitted, owner like those of another folder."""
    shutil.copystat(other, folder)
    there = os.stat(other)
    with suppress(OSError):
        os.chown(folder, there.st_uid, there.st_gid)


def _walk(folder: str, below: str = "") -> Iterator[tuple[str, os.DirEntry[str]]]:
    """Yield everything in a folder, by its path below it; a folder before what it holds."""
    for entry in os.scandir(os.path.join(folder, below)):
        path = os.path.join(below, entry.name)
        yield path, entry
        if entry.is_dir(follow_symlinks=False):
            yield from _walk(folder, path)


def _write_all(folder: str, stage: str, write: Mapping[str, bytes]) -> None:
    """Write all files, and then wait once until all of them are on the disk."""
    for path, data in write.items():
        with explained(os.path.join(folder, path)):
            os.makedirs(os.path.dirname(os.path.join(stage, path)), exist_ok=True)
            write_new(os.path.join(stage, path), data, _mode(os.path.join(folder, path)))
    for path in write:
        with explained(os.path.join(folder, path)):
            see_on_disk(os.path.join(stage, path))


def _mode(path: str) -> int:
    """Return the mode bits of an existing file; 0 for none."""
    try:
        return stat.S_IMODE(os.lstat(path).st_mode)
    except OSError:
        return 0


def _exchange(stage: str, folder: str) -> None:
    """Replace the old folder by the new one, in one step."""
    if not os.path.lexists(folder):
        with explained(folder):
            os.rename(stage, folder)
        return
    try:
        call = ctypes.CDLL(None, use_errno=True).renameat2
    except (OSError, AttributeError):
        raise _CannotSwapError from None
    if call(_HERE, os.fsencode(stage), _HERE, os.fsencode(folder), ctypes.c_uint(_EXCHANGE)):
        raise _CannotSwapError


def _bring_late(stage: str, folder: str, but: Collection[str]) -> None:
    """Move files into the new folder that were put into the old one meanwhile."""
    if not os.path.isdir(stage):
        return
    for path, entry in list(_walk(stage)):
        target = os.path.join(folder, path)
        ours = path in but or _LEFT.fullmatch(entry.name) or entry.is_dir(follow_symlinks=False)
        if not ours and not os.path.lexists(target):
            with suppress(OSError):
                os.makedirs(os.path.dirname(target), exist_ok=True)
                os.rename(entry.path, target)


def _one_by_one(
    folder: str, write: Mapping[str, bytes], remove: Collection[str], note: tuple[str, bytes]
) -> None:
    path, data = note
    full = os.path.join(folder, path)
    with _put_back(full):
        try:
            write_all([(full, data)])
        except UsageError as error:  # its name means nothing to the user
            raise UsageError(str(error).replace(full, folder)) from None
        write_all(((os.path.join(folder, it), data) for it, data in write.items()))
    for it in (*remove, path):
        with suppress(FileNotFoundError), explained(os.path.join(folder, it)):
            os.unlink(os.path.join(folder, it))
    _prune(folder, remove)


@contextmanager
def _put_back(path: str) -> Iterator[None]:
    """Restore the file if the block fails: it would describe a build that was not made."""
    # Named as what a build clears away that comes after one that was killed.
    before = os.path.join(os.path.dirname(path), f".urdf-postfix.{os.getpid()}.00.tmp.old")
    with suppress(OSError):
        os.link(path, before)
    try:
        yield
    except BaseException:
        with suppress(OSError):
            os.unlink(path)
        with suppress(OSError):
            os.rename(before, path)
        raise
    with suppress(OSError):
        os.unlink(before)


def _prune(folder: str, removed: Iterable[str]) -> None:
    """Take away the folders below ``folder`` in which nothing is left of what was removed."""
    for path in removed:
        above = os.path.dirname(path)
        with suppress(OSError):
            while above:
                os.rmdir(os.path.join(folder, above))
                above = os.path.dirname(above)
