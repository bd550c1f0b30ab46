# SPDX-License-Identifier: Apache-2.0
"""All restrictions of a process, put up once what it needs is loaded.

With Landlock the kernel refuses this process every file but those named, every TCP port, and
signals to others. Without rules nothing of what the set handles is left. Source: Linux,
include/uapi/linux/landlock.h and Documentation/userspace-api/landlock.rst."""

import ctypes
import os
import resource
import signal
import stat
import struct
import sys
from collections.abc import Callable, Collection, Iterable, Mapping
from contextlib import suppress
from typing import NamedTuple, NoReturn

from multibot_rewrite.description.sources.child import frames, seccomp
from multibot_rewrite.description.sources.child.seccomp import SYSTEM, no_new_privileges, undumpable

# The same numbers on every architecture (since Linux 5.13).
CREATE_RULESET, _ADD_RULE, RESTRICT_SELF = 444, 445, 446
_ASK_VERSION, _BENEATH = 1, 1
# Bits of rights to files by the version of the interface that first has them all.
_FILES = {1: 0x1FFF, 2: 0x3FFF, 3: 0x7FFF, 5: 0xFFFF}
# Read a file, list a folder; write a file, change its length, remove, make and move files and folders.
_READ, _WRITE = 0b1100, 0b110000110111110
# What of it is said of a file.
_OF_FILE = 0b100000000000110
# Bind and connect of TCP; abstract sockets and signals of other processes.
_PORTS, _PORTS_SINCE = 0b11, 4
_SCOPES, _SCOPES_SINCE = 0b11, 6


def version() -> int:
    """Return the version of the kernel's Landlock interface, 0 without one."""
    found = SYSTEM.syscall(CREATE_RULESET, None, ctypes.c_size_t(0), _ASK_VERSION) if SYSTEM else 0
    return max(0, int(found))


def enclose(readable: Iterable[str] = (), writable: Iterable[str] = ()) -> bool:
    """Deny this process and its children all paths but these; return whether it worked."""
    known = version()
    if not known or not SYSTEM or not no_new_privileges():
        return False
    files = max(bits for since, bits in _FILES.items() if since <= known)
    ports = _PORTS if known >= _PORTS_SINCE else 0
    scopes = _SCOPES if known >= _SCOPES_SINCE else 0
    size = 24 if scopes else 16 if ports else 8
    rules = struct.pack("=QQQ", files, ports, scopes)[:size]
    ruleset = SYSTEM.syscall(CREATE_RULESET, rules, ctypes.c_size_t(size), 0)
    if ruleset < 0:
        return False
    for paths, rights in ((readable, _READ), (writable, _WRITE)):
        for path in paths:
            with suppress(OSError):  # what is not there needs no rule
                _allow_path(ruleset, path, rights & files)
    done = bool(SYSTEM.syscall(RESTRICT_SELF, ruleset, 0) == 0)
    os.close(ruleset)
    return done


def _allow_path(ruleset: int, path: str, rights: int) -> None:
    place = os.open(path, os.O_PATH | os.O_CLOEXEC)
    try:
        if not stat.S_ISDIR(os.fstat(place).st_mode):
            rights &= _OF_FILE
        assert SYSTEM is not None
        SYSTEM.syscall(_ADD_RULE, ruleset, _BENEATH, struct.pack("=Qi", rights, place), 0)
    finally:
        os.close(place)


# Beyond what the process has when it starts.
MOST_MEMORY = 2 * 2**30
# Of a process that may write files: bytes of one of them, and files that are open.
_LONGEST, _MOST_OPEN = 2**26, 256


class Files(NamedTuple):
    """Files and folders that a process may read below, and those that it may write below."""

    readable: Collection[str]
    writable: Collection[str]


def put_up(wanted: Collection[str], seconds: float, files: Files | None = None) -> list[str]:
    """Restrict this process for good; return the restrictions in force. Without ``files``: no file."""
    memory = _memory()
    ways: Mapping[str, Callable[[], bool]] = {
        frames.LIMITS: lambda: limit(seconds, memory, files is not None),
        frames.LANDLOCK: lambda: enclose(*(files or ())),
        frames.SECCOMP: lambda: seccomp.enclose(files is not None),
        frames.AUDIT: refuse_all,
    }
    return [name for name in frames.FENCES if name in wanted and ways[name]()]


def limit(seconds: float, memory: int, files: bool = False) -> bool:
    """Limit time and memory; no new process, and without ``files`` no file or byte is written."""
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
    """Return how many bytes of addresses the process has; 0 if unknown."""
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
                setattr(module, name, _refusing_function(name))
    sys.addaudithook(_refuse_event)
    return True


def _refusing_function(name: str) -> Callable[..., NoReturn]:
    def refuse(*arguments: object, **_: object) -> NoReturn:
        raise PermissionError(f"refused: os.{name}{str(arguments)[:80]}")

    return refuse


def _refuse_event(event: str, arguments: tuple[object, ...]) -> None:
    # Constants of the code alone: there is nothing that a file could change.
    if event not in {"compile", "exec", "builtins.id", "object.__getattr__", "array.__new__"}:
        raise PermissionError(f"refused: {event} {str(arguments)[:80]}")
