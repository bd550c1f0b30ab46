"""Writing results: all of them or none, each appearing whole."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterable

from multibot_rewrite.model import UsageError


def write_all(items: Iterable[tuple[str, bytes]]) -> None:
    """Write every (path, data) beside its target, then rename; on an error nothing is left behind.

    An existing file keeps its mode bits. Raises UsageError with path, cause and remedy.
    """
    staged: list[tuple[str, str]] = []
    try:
        for path, data in items:
            target = os.path.realpath(path)
            try:
                if not _write_special(target, data):
                    staged.append((_stage(target, data), target))
            except OSError as error:
                raise UsageError(f"{path}: cannot be written: {_reason(error, target)}") from None
        while staged:
            temporary, target = staged[-1]
            os.replace(temporary, target)  # noqa: PTH105
            staged.pop()
    finally:
        for temporary, _ in staged:
            os.unlink(temporary)  # noqa: PTH108


def _write_special(target: str, data: bytes) -> bool:
    """A device or pipe cannot be replaced, only written to; true if it was one."""
    try:
        mode = os.stat(target).st_mode  # noqa: PTH116
    except FileNotFoundError:
        return False
    if stat.S_ISDIR(mode):
        raise IsADirectoryError(21, "it is a folder")
    if stat.S_ISREG(mode):
        return False
    with open(target, "wb") as file:  # noqa: PTH123
        file.write(data)
    return True


def _stage(target: str, data: bytes) -> str:
    folder, name = os.path.split(target)
    temporary = f"{folder}/.{name}.{os.getpid()}.tmp"
    handle = os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666)
    try:
        if os.path.exists(target):  # noqa: PTH110
            os.fchmod(handle, stat.S_IMODE(os.stat(target).st_mode))  # noqa: PTH116
        view = memoryview(data)
        while view:
            view = view[os.write(handle, view) :]
        os.fsync(handle)
    except BaseException:
        os.unlink(temporary)  # noqa: PTH108
        raise
    finally:
        os.close(handle)
    return temporary


def _reason(error: OSError, target: str) -> str:
    folder = os.path.dirname(target)  # noqa: PTH120
    if not os.path.isdir(folder):  # noqa: PTH112
        return f"the folder {folder} does not exist, create it first"
    return f"{error.strerror or error}, choose another output"
