# SPDX-License-Identifier: Apache-2.0
"""Calls of Linux that Python has no function for."""

from __future__ import annotations

import ctypes
import signal
import sys

_SET_PDEATHSIG, _SET_DUMPABLE, _SET_NO_NEW_PRIVS = 1, 4, 38

SYSTEM = ctypes.CDLL(None, use_errno=True) if sys.platform == "linux" else None


def control(*arguments: object) -> bool:
    """Call ``prctl``; return whether it succeeded."""
    numbers = [ctypes.c_ulong(it) if isinstance(it, int) else it for it in arguments[1:]]
    return SYSTEM is not None and SYSTEM.prctl(arguments[0], *numbers) == 0


def no_new_privileges() -> bool:
    """Give up new privileges: otherwise an unprivileged process may not restrict itself."""
    return control(_SET_NO_NEW_PRIVS, 1, 0, 0, 0)


def undumpable() -> bool:
    """Hide the memory of this process, and its files in /proc, from others of this user."""
    return control(_SET_DUMPABLE, 0, 0, 0, 0)


def die_with_parent() -> bool:
    """Let the kernel end this process with its parent; returns whether it does."""
    return control(_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0)
