# SPDX-License-Identifier: Apache-2.0
"""The fences around the reading of a launch file, and the files and variables that are left to it.

It may read what a xacro file of its package may, what a sourced ROS has, and what Python imports; it
writes in a folder of its own. The kernel has to hold that: what a launch file does, it does itself.
"""

from __future__ import annotations

import os
import sys
import sysconfig
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from multibot_rewrite.description.sources.access import VARIABLES, Access, Reach
from multibot_rewrite.description.sources.child.fences import Files, put_up
from multibot_rewrite.description.sources.child.frames import (
    KERNEL,
    LANDLOCK,
    LIMITS,
    SECCOMP,
)
from multibot_rewrite.producers.launch.records import LaunchOrder

# What the loader of Linux reads for a library.
_LIBRARIES = ("/lib", "/lib64", "/usr/lib", "/usr/lib64", "/usr/local/lib", "/etc/ld.so.cache")
_DEVICES = ("/dev/null", "/dev/urandom")
# Variables that are no secret, beside those that xacro sees.
_PLAIN = (
    "COLUMNS",
    "DISPLAY",
    "HOME",
    "HOSTNAME",
    "LANG",
    "LOGNAME",
    "PATH",
    "USER",
    "MULTIBOT_",
    "LD_LIBRARY_PATH",
    "LINES",
    "PYTHONPATH",
)
_THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
NOT_FENCED = (
    "a launch file is a program, and this system has not both Landlock and seccomp to fence it in;"
    " --trust runs it without (SECURITY.md)"
)


class NotFencedError(Exception):
    """The kernel has not the fences."""


def confine(order: LaunchOrder, folder: str, more: Sequence[str], seconds: float) -> None:
    """Put the fences around this process, for good: it may write in ``folder`` and read ``more``.

    Raises NotFencedError.
    """
    access = Access(order.file, Reach(order.roots), None)
    files = Files((*_readable(access), *more), (folder, os.devnull))
    hidden = {it for it in os.environ if not it.startswith((*VARIABLES, *_PLAIN))}
    held = put_up((LANDLOCK, LIMITS, SECCOMP), seconds, files)
    if not KERNEL.issubset(held):
        raise NotFencedError
    for name in hidden:
        del os.environ[name]
    os.environ.__class__ = type("Environ", (type(os.environ),), {"__getitem__": _asked(hidden)})
    # A library that may start no thread would end the process.
    os.environ |= dict.fromkeys(_THREADS, "1")
    # They would change files that are only read; what copies files asks for them.
    vars(os).update(dict.fromkeys(("chmod", "utime", "listxattr"), _nothing))


def _nothing(*_: object, **__: object) -> tuple[()]:
    """Nothing is done, and nothing is there."""
    return ()


def _asked(hidden: set[str]) -> Callable[[Any, str], str]:
    """The look-up of a variable: one that is set and hidden is not taken for one that is not."""
    look_up = type(os.environ).__getitem__

    def asked(environ: Any, name: str) -> str:
        if name in hidden:
            told = "is set, but a launch file sees ROS's variables alone; give --trust"
            raise PermissionError(f"the environment variable {name!r} {told}")
        return look_up(environ, name)

    return asked


def _readable(access: Access) -> Iterator[str]:
    yield from _beside(access)
    yield from access.roots
    for prefix in access.sourced:
        yield prefix
        # What ``colcon build --symlink-install`` links to.
        above, _, inside = prefix.rpartition("/install")
        if above and inside[:1] in ("", "/"):
            yield from (os.path.join(above, it) for it in ("src", "build"))
    yield from sys.path
    yield from (sysconfig.get_path(it) for it in ("stdlib", "platstdlib"))
    yield from (*_LIBRARIES, *_DEVICES)


def _beside(access: Access) -> Iterator[str]:
    """The files in the folder of the launch file, which may be a home."""
    for folder in access.beside:
        with os.scandir(folder or os.curdir) as found:
            yield from (it.path for it in found if it.name[0] != "." and it.is_file())
