# SPDX-License-Identifier: Apache-2.0
"""All fences around a process, put up once what it needs is loaded."""

from __future__ import annotations

import os
import resource
import signal
import sys
from collections.abc import Callable, Collection, Mapping
from contextlib import suppress
from typing import NoReturn

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.sources.child import landlock, seccomp
from multibot_rewrite.description.sources.child.frames import (
    AUDIT,
    FENCES,
    LANDLOCK,
    LIMITS,
    SECCOMP,
)
from multibot_rewrite.description.sources.child.system import undumpable

# Beyond what the process has when it starts.
MOST_MEMORY = 2 * 2**30
# Of a process that may write files: bytes of one of them, and files that are open.
_LONGEST, _MOST_OPEN = 2**26, 256


class Files(NamedTuple):
    """Files and folders that a process may read below, and those that it may write below."""

    readable: Collection[str]
    writable: Collection[str]


def put_up(wanted: Collection[str], seconds: float, files: Files | None = None) -> list[str]:
    """Put up those fences, for good; the names of those that this system has. Without ``files`` none
    can be opened."""
    memory = _memory()
    ways: Mapping[str, Callable[[], bool]] = {
        LIMITS: lambda: limit(seconds, memory, files is not None),
        LANDLOCK: lambda: landlock.enclose(*(files or ())),
        SECCOMP: lambda: seccomp.enclose(files is not None),
        AUDIT: refuse_all,
    }
    return [name for name in FENCES if name in wanted and ways[name]()]


def limit(seconds: float, memory: int, files: bool = False) -> bool:
    """Bounds of time and memory; no new process, and without ``files`` no new file or byte in one."""
    undumpable()
    signal.setitimer(signal.ITIMER_REAL, seconds)
    whole = int(seconds) + 1
    bounds = {
        "RLIMIT_CPU": whole,
        "RLIMIT_AS": memory + MOST_MEMORY,
        "RLIMIT_CORE": 0,
        "RLIMIT_FSIZE": _LONGEST if files else 0,
        "RLIMIT_NPROC": 0,
        "RLIMIT_NOFILE": _MOST_OPEN if files else 0,
    }
    for name, most in bounds.items():
        kind = getattr(resource, name, None)
        if kind is None:  # a system has what it has
            continue
        _, hard = resource.getrlimit(kind)
        bound = most if hard == resource.RLIM_INFINITY else min(most, hard)
        with suppress(ValueError, OSError):  # macOS takes no bound of addresses
            resource.setrlimit(kind, (bound, bound))
    return True


def _memory() -> int:
    """How many bytes of addresses the process has; 0 where nothing tells."""
    try:
        with open("/proc/self/statm") as file:
            return int(file.read().split()[0]) * os.sysconf("SC_PAGESIZE")
    except OSError:
        return 0


# The fence that needs no kernel: Python tells a hook what is about to be done, and it says no.
# It is for good messages, and for systems without the fences of Linux. Alone it is no strong boundary:
# whoever gets at the memory of the process gets around it. Source: docs.python.org, "Audit events
# table".
# What remains of os: all else works on files, processes or descriptors, and some of it without event.
_KEPT = frozenset(
    ("environ", "environb", "error", "fsencode", "fsdecode", "fspath", "getcwd", "getenv", "path")
)


def refuse_all() -> bool:
    """Refuse everything but computing, for as long as the process lives."""
    for module in (os, sys.modules.get("posix")):
        for name, value in list(vars(module).items()) if module else ():
            if callable(value) and name not in _KEPT and not isinstance(value, type):
                setattr(module, name, _refusing(name))
    sys.addaudithook(_refuse)
    return True


def _refusing(name: str) -> Callable[..., NoReturn]:
    def refuse(*arguments: object, **_: object) -> NoReturn:
        raise PermissionError(f"refused: os.{name}{str(arguments)[:80]}")

    return refuse


def _refuse(event: str, arguments: tuple[object, ...]) -> None:
    # Constants of the code alone: there is nothing that a file could change.
    if event not in {"compile", "exec", "builtins.id", "object.__getattr__", "array.__new__"}:
        raise PermissionError(f"refused: {event} {str(arguments)[:80]}")
