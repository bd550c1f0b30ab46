# SPDX-License-Identifier: Apache-2.0
"""A filter of system calls (seccomp): compute, ask for memory, read and write open files.

Calls that open files are left where Landlock says which. Sources: Linux,
Documentation/userspace-api/seccomp_filter.rst, arch/x86/entry/syscalls/syscall_64.tbl,
include/uapi/asm-generic/unistd.h. Arguments are restricted as in OpenSSH, sandbox-seccomp-filter.c,
and Chromium, sandbox/linux/seccomp-bpf-helpers."""

import ctypes
import errno
import os
import signal
import struct
import sys
from collections.abc import Mapping
from functools import cache
from itertools import islice
from typing import NamedTuple

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


_SET_SECCOMP, _MODE_FILTER = 22, 2
# Instructions: load a word, compare, compare bits, answer.
_LOAD, _EQUAL, _AT_LEAST, _ANY_BIT, _ANSWER = 0x20, 0x15, 0x35, 0x45, 0x06
_KILL, _ALLOW, _REFUSE = 0x80000000, 0x7FFF0000, 0x00050000 | errno.EPERM
# Offsets in the record of a call: its number, the architecture, the low halves of its arguments.
_NUMBER, _ARCHITECTURE, _FIRST, _SECOND, _THIRD, _FOURTH = 0, 4, 16, 24, 32, 40
# Numbers from here on are the other interface (x32) of the same processor.
_X32 = 0x40000000


# Flags of openat: to write, and to cut the file off, which older versions of Landlock let through.
_WRITING, _CUTTING = os.O_WRONLY | os.O_RDWR, os.O_TRUNC
# Bits that mmap and mprotect may not have: memory is read and written alone, and of usual pages.
_NEITHER = ((_THIRD, 0xFFFFFFFF & ~3), (_FOURTH, 0xFFFFFFFF & ~0x24833))
# What an argument may be. Of futex: to wait and to wake, without priorities, in which the kernel had
# faults (CVE-2014-3153). Of madvise: usual, random, not needed. Of clock_gettime: no other process's.
# Of getrandom: to wait or not. Of ioctl and fcntl: that no other program gets an open file, and a
# second number for it. Who gets signals for it is asked in the same way.
_ASKED = (
    (_SECOND, 0, 1, 3, 4, 5, 9, 10, 128, 129, 131, 132, 133, 137, 138, 265, 393),
    (_THIRD, 0, 1, 4, 8),
    (_FIRST, *range(8)),
    (_THIRD, 0, 1),
    (_SECOND, 0x5451),
    (_SECOND, 0, 1, 2, 3, 1030),
)
# So many of them are for whoever opens no files.
_COMPUTING = 4


class Machine(NamedTuple):
    """An architecture's audit number and allowed calls; ``memory``: mmap and mprotect.

    ``opens`` is openat; ``asks`` are those of which ``_ASKED`` has arguments."""

    audit: int
    calls: tuple[int, ...]
    memory: tuple[int, ...]
    files: tuple[int, ...]
    opens: int
    asks: tuple[int, ...]


def _numbers_in(text: str) -> tuple[int, ...]:
    return tuple(map(int, text.split()))


_CALLS = {
    # read write close lseek munmap brk rt_sigaction rt_sigprocmask rt_sigreturn sched_yield mremap
    # getpid exit gettimeofday sigaltstack gettid restart_syscall exit_group
    "x86_64": "0 1 3 8 11 12 13 14 15 24 25 39 60 96 131 186 219 231",
    "aarch64": "63 64 57 62 215 214 134 135 139 124 216 172 93 169 132 178 128 94",
}
_FILES = {
    # stat fstat lstat pread64 pwrite64 readv writev access dup nanosleep uname fsync fdatasync
    # ftruncate getdents getcwd chdir rename mkdir rmdir unlink readlink getrusage sysinfo times
    # getuid getgid geteuid getegid getppid sched_getaffinity getdents64 clock_getres
    # clock_nanosleep mkdirat newfstatat unlinkat renameat readlinkat faccessat renameat2 statx
    # faccessat2
    "x86_64": (
        "4 5 6 17 18 19 20 21 32 35 63 74 75 77 78 79 80 82 83 84 87 89 98 99"
        " 100 102 104 107 108 110 204 217 229 230 258 262 263 264 267 269 316 332 439"
    ),
    # The same but for those that only older processors have.
    "aarch64": (
        "80 67 68 65 66 23 101 160 82 83 46 17 49 165 179 153 174 176 175 177 173"
        " 123 61 114 115 34 79 35 38 78 48 276 291 439"
    ),
}
# The number of the architecture; mmap and mprotect; openat; those of which _ASKED has arguments.
_KINDS: Mapping[str, tuple[int, tuple[int, int], int, tuple[int, ...]]] = {
    "x86_64": (0xC000003E, (9, 10), 257, (202, 28, 228, 318, 16, 72)),
    "aarch64": (0xC00000B7, (222, 226), 56, (98, 233, 113, 278, 29, 25)),
}
MACHINES: Mapping[str, Machine] = {
    name: Machine(audit, _numbers_in(_CALLS[name]), memory, _numbers_in(_FILES[name]), opens, asks)
    for name, (audit, memory, opens, asks) in _KINDS.items()
}


class _Program(ctypes.Structure):
    _fields_ = (("length", ctypes.c_ushort), ("filter", ctypes.c_char_p))


def enclose(files: bool = False) -> bool:
    """Refuse all other system calls, except for ``files``; return whether it worked."""
    machine = MACHINES.get(os.uname().machine)
    if machine is None or struct.calcsize("P") != 8 or not no_new_privileges():
        return False
    program = filter_program(machine, files)
    record = _Program(len(program) // 8, program)
    return control(_SET_SECCOMP, _MODE_FILTER, ctypes.byref(record), 0, 0)


@cache
def filter_program(machine: Machine, files: bool = False) -> bytes:
    """Return the filter, eight bytes an instruction; ``files``: libraries can be loaded."""
    steps = [
        (_LOAD, 0, 0, _ARCHITECTURE),
        (_EQUAL, 1, 0, machine.audit),
        (_ANSWER, 0, 0, _KILL),
        (_LOAD, 0, 0, _NUMBER),
        (_AT_LEAST, 0, 1, _X32),
        (_ANSWER, 0, 0, _KILL),
    ]
    more = (*machine.files, *machine.memory) if files else ()
    for number in (*machine.calls, *more):
        steps += [(_EQUAL, 0, 1, number), (_ANSWER, 0, 0, _ALLOW)]
    for number, bits in () if files else zip(machine.memory, (_NEITHER, _NEITHER[:1]), strict=True):
        steps += [(_EQUAL, 0, 2 * len(bits) + 2, number)]
        for at, (place, mask) in enumerate(bits):
            steps += [(_LOAD, 0, 0, place), (_ANY_BIT, 2 * (len(bits) - at) - 1, 0, mask)]
        steps += [(_ANSWER, 0, 0, _ALLOW), (_ANSWER, 0, 0, _REFUSE)]
    if files:
        steps += [
            (_EQUAL, 0, 5, machine.opens),
            (_LOAD, 0, 0, _THIRD),
            (_ANY_BIT, 1, 0, _WRITING),
            (_ANY_BIT, 1, 0, _CUTTING),
            (_ANSWER, 0, 0, _ALLOW),
            (_ANSWER, 0, 0, _REFUSE),
        ]
    asked = zip(machine.asks, _ASKED, strict=True)
    for number, (place, *words) in islice(asked, None if files else _COMPUTING):
        steps += [(_EQUAL, 0, len(words) + 3, number), (_LOAD, 0, 0, place)]
        steps += [(_EQUAL, len(words) - at, 0, word) for at, word in enumerate(words)]
        steps += [(_ANSWER, 0, 0, _REFUSE), (_ANSWER, 0, 0, _ALLOW)]
    steps.append((_ANSWER, 0, 0, _REFUSE))
    return b"".join(struct.pack("=HBBI", *step) for step in steps)
