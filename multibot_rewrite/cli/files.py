# SPDX-License-Identifier: Apache-2.0
"""Writing results: all of them or none, each appearing whole.

All are written next to their targets, then all are seen onto the disk, then all are renamed: whenever
the machine stops, each file is whole, the old one or the new one. The disk writes them while more
are made, and has to finish only once.
"""

from __future__ import annotations

import os
import signal
import stat
import threading
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress

from multibot_rewrite.base.model import UsageError

# Windows has no SIGHUP.
_ENDS = [getattr(signal, it) for it in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, it)]


def write_all(items: Iterable[tuple[str, bytes]]) -> None:
    """Write every (path, data) next to its target, then rename; on an error everything is as it was.

    Missing folders are made. An existing file keeps its mode bits, a link stays a link. Raises
    UsageError with path, cause and remedy.
    """
    staged: dict[str, str] = {}
    made: list[str] = []
    try:
        for path, data in items:
            with explained(path):
                make_folders(os.path.dirname(path), made)
                _stage(path, data, staged)
        for target, temporary in staged.items():
            with explained(target):
                see_on_disk(temporary)
        changed = {os.path.dirname(path) for path in (*made, *staged)}
        with _signals_held():
            _commit(staged)
        made.clear()
    finally:
        for temporary in staged.values():
            # Not there, or on a disk that was never written to.
            with suppress(OSError):
                os.unlink(temporary)
        for folder in reversed(made):
            with suppress(OSError):
                os.rmdir(folder)
    for folder in changed:
        # Not every file system can do that for a folder; its files are whole all the same.
        with suppress(OSError):
            see_on_disk(folder or ".")


def make_folders(folder: str, made: list[str]) -> None:
    """Make a folder and those above it; what was not there is noted in ``made``."""
    missing = []
    while folder and not os.path.isdir(folder):
        missing.append(folder)
        folder = os.path.dirname(folder)
    for path in reversed(missing):
        os.mkdir(path)
        made.append(path)


@contextmanager
def _signals_held() -> Iterator[None]:
    """Delay Ctrl-C and the like: between two lines of the block it would leave copies."""
    # Python handles signals in its main thread, whichever thread gets them.
    came: list[int] = []
    is_main = threading.current_thread() is threading.main_thread()
    ends = [it for it in _ENDS if is_main and signal.getsignal(it) is not signal.SIG_IGN]
    before = {it: signal.signal(it, lambda number, _: came.append(number)) for it in ends}
    try:
        yield
    finally:
        for it, handler in before.items():
            signal.signal(it, handler or signal.SIG_DFL)
        for it in came:
            signal.raise_signal(it)


def _commit(staged: dict[str, str]) -> None:
    """Rename all staged files to their targets, or restore every target on an error."""
    done: list[tuple[str, str]] = []
    try:
        for target, temporary in list(staged.items()):
            with explained(target):
                backup = f"{temporary}.old" if os.path.lexists(target) else ""
                # Noted before it is done: an interrupt in between leaves nothing.
                done.append((target, backup))
                if backup:
                    os.link(target, backup)
                os.replace(temporary, target)
            del staged[target]
    except BaseException:
        for target, backup in reversed(done):
            with suppress(FileNotFoundError):
                os.replace(backup, target) if backup else os.unlink(target)
        raise
    finally:
        # Also one that was renamed onto its own file, which does nothing.
        for backup in [it for _, it in done if it]:
            with suppress(OSError):
                os.unlink(backup)


def _stage(path: str, data: bytes, staged: dict[str, str]) -> None:
    """Write the data next to its target and note it in ``staged``; devices and pipes at once."""
    target, mode = _target(path)
    if mode and not stat.S_ISREG(mode):
        with open(path, "wb") as file:
            file.write(data)
        return
    if target in staged:
        raise UsageError(f"{path}: two results would go to this one file, give each its own")
    name = f".urdf-postfix.{os.getpid()}.{len(staged)}.tmp"
    temporary = os.path.join(os.path.dirname(target), name)
    # Noted before it exists: an interrupt in between leaves nothing.
    staged[target] = temporary
    write_new(temporary, data, stat.S_IMODE(mode))


def _target(path: str) -> tuple[str, int]:
    """Return the file at ``path`` with links resolved, and its mode; 0 if there is none yet."""
    try:
        mode = os.lstat(path).st_mode
    except FileNotFoundError:
        return path, 0
    if not stat.S_ISLNK(mode):
        return path, mode
    try:
        return os.path.realpath(path), os.stat(path).st_mode
    except FileNotFoundError:
        return os.path.realpath(path), 0


def write_new(path: str, data: bytes, mode: int) -> None:
    """Write a file that is not there yet; ``mode`` 0 is the usual one."""
    # The disk starts on it, and ``see_on_disk`` waits until it is there.
    handle = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666)
    try:
        if mode:
            os.fchmod(handle, mode)
        view = memoryview(data)
        while view:
            view = view[os.write(handle, view) :]
        # The advice says that nobody will read it soon, and Linux begins to write it out.
        if hasattr(os, "posix_fadvise"):  # macOS has none
            os.posix_fadvise(handle, 0, 0, os.POSIX_FADV_DONTNEED)
    finally:
        os.close(handle)


def see_on_disk(path: str) -> None:
    """Wait until a file, or which files a folder holds, is on the disk."""
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


@contextmanager
def explained(path: str) -> Iterator[None]:
    """Turn an OSError of the block into a one-line UsageError about ``path``."""
    try:
        yield
    except OSError as error:
        above, why = existing_folder(path), f"{error.strerror or error}, choose another output"
        if not os.path.isdir(above):
            why = f"{above} is a file, not a folder; choose another output"
        elif os.path.isdir(path):
            why = "it is a folder, name a file in it"
        raise UsageError(f"{path}: cannot be written: {why}") from None


def existing_folder(path: str) -> str:
    """Return the nearest existing path above ``path``; it may turn out to be a file."""
    above = os.path.dirname(path) or "."
    while not os.path.lexists(above):
        above = os.path.dirname(above) or "."
    return above
