# SPDX-License-Identifier: Apache-2.0
"""Landlock: the kernel refuses this process every file but those that are named, every TCP port, and
signals to others.

Without rules nothing of what the set handles is left. Source: Linux, include/uapi/linux/landlock.h and
Documentation/userspace-api/landlock.rst.
"""

from __future__ import annotations

import ctypes
import os
import stat
import struct
from collections.abc import Iterable
from contextlib import suppress

from multibot_rewrite.description.sources.child.system import SYSTEM, no_new_privileges

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
    """The version of the kernel's interface, 0 where it has none."""
    found = SYSTEM.syscall(CREATE_RULESET, None, ctypes.c_size_t(0), _ASK_VERSION) if SYSTEM else 0
    return max(0, int(found))


def enclose(readable: Iterable[str] = (), writable: Iterable[str] = ()) -> bool:
    """Take all but what is below these paths from this process, and from what it starts; False where
    that is not possible. What is writable can be read as well."""
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
                _allow(ruleset, path, rights & files)
    done = bool(SYSTEM.syscall(RESTRICT_SELF, ruleset, 0) == 0)
    os.close(ruleset)
    return done


def _allow(ruleset: int, path: str, rights: int) -> None:
    place = os.open(path, os.O_PATH | os.O_CLOEXEC)
    try:
        if not stat.S_ISDIR(os.fstat(place).st_mode):
            rights &= _OF_FILE
        assert SYSTEM is not None
        SYSTEM.syscall(_ADD_RULE, ruleset, _BENEATH, struct.pack("=Qi", rights, place), 0)
    finally:
        os.close(place)
