"""Writing results: all of them or none, each appearing whole."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterable

from multibot_rewrite.model import UsageError


def write_all(items: Iterable[tuple[str, bytes]]) -> None:
    """Write every (path, data) beside its target, then rename; on an error nothing is left behind.

    An existing file keeps its mode bits, a link stays a link. Raises UsageError with path, cause
    and remedy.
    """
    staged: list[tuple[str, str]] = []
    try:
        for path, data in items:
            try:
                staged += _stage(path, data)
            except OSError as error:
                raise UsageError(f"{path}: cannot be written: {_reason(error, path)}") from None
        while staged:
            os.replace(*staged[-1])
            staged.pop()
    finally:
        for temporary, _ in staged:
            os.unlink(temporary)


def _stage(path: str, data: bytes) -> list[tuple[str, str]]:
    """(temporary file, target), the data safely in the first; empty for a device or pipe, which is
    written at once."""
    try:
        mode = os.lstat(path).st_mode
        if stat.S_ISLNK(mode):
            path = os.path.realpath(path)
            mode = os.stat(path).st_mode
    except FileNotFoundError:
        mode = 0
    if mode and not stat.S_ISREG(mode):
        with open(path, "wb") as file:
            file.write(data)
        return []
    folder, name = os.path.split(path)
    temporary = os.path.join(folder, f".{name}.{os.getpid()}.tmp")
    _write(temporary, data, stat.S_IMODE(mode))
    return [(temporary, path)]


def _write(temporary: str, data: bytes, mode: int) -> None:
    handle = os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666)
    try:
        if mode:
            os.fchmod(handle, mode)
        view = memoryview(data)
        while view:
            view = view[os.write(handle, view) :]
        os.fsync(handle)
    except BaseException:
        os.unlink(temporary)
        raise
    finally:
        os.close(handle)


def _reason(error: OSError, path: str) -> str:
    folder = os.path.dirname(path) or "."
    if not os.path.isdir(folder):
        return f"the folder {folder} does not exist, create it first"
    return f"{error.strerror or error}, choose another output"
