# SPDX-License-Identifier: Apache-2.0
"""seccomp: the kernel refuses this process every system call but a few.

What is left computes, asks for memory, and reads and writes what is open. Sources: Linux,
Documentation/userspace-api/seccomp_filter.rst, arch/x86/entry/syscalls/syscall_64.tbl,
include/uapi/asm-generic/unistd.h.
"""

from __future__ import annotations

import ctypes
import errno
import os
import struct
from collections.abc import Mapping
from functools import cache

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.sources.child.system import control, no_new_privileges

_SET_SECCOMP, _MODE_FILTER = 22, 2
# Instructions: load a word, compare, compare bits, answer.
_LOAD, _EQUAL, _AT_LEAST, _ANY_BIT, _ANSWER = 0x20, 0x15, 0x35, 0x45, 0x06
_KILL, _ALLOW, _REFUSE = 0x80000000, 0x7FFF0000, 0x00050000 | errno.EPERM
# Offsets in the record of a call: its number, the architecture, the low half of the third argument.
_NUMBER, _ARCHITECTURE, _THIRD = 0, 4, 32
_PROT_EXEC = 4
# Numbers from here on are the other interface (x32) of the same processor.
_X32 = 0x40000000


class Machine(NamedTuple):
    """The audit number of an architecture; its calls that are allowed, and those that are if they
    make no memory executable."""

    audit: int
    calls: tuple[int, ...]
    memory: tuple[int, ...]


_NUMBERS = {
    # read write close lseek munmap brk rt_sigaction rt_sigprocmask rt_sigreturn sched_yield mremap
    # madvise getpid exit gettimeofday sigaltstack gettid futex restart_syscall clock_gettime
    # exit_group getrandom
    "x86_64": "0 1 3 8 11 12 13 14 15 24 25 28 39 60 96 131 186 202 219 228 231 318",
    "aarch64": "63 64 57 62 215 214 134 135 139 124 216 233 172 93 169 132 178 98 128 113 94 278",
}
# The number of the architecture; mmap and mprotect.
_KINDS = {"x86_64": (0xC000003E, (9, 10)), "aarch64": (0xC00000B7, (222, 226))}
MACHINES: Mapping[str, Machine] = {
    name: Machine(audit, tuple(map(int, _NUMBERS[name].split())), memory)
    for name, (audit, memory) in _KINDS.items()
}


class _Program(ctypes.Structure):
    _fields_ = (("length", ctypes.c_ushort), ("filter", ctypes.c_char_p))


def enclose() -> bool:
    """Refuse all other calls from now on; False where that is not possible."""
    machine = MACHINES.get(os.uname().machine)
    if machine is None or struct.calcsize("P") != 8 or not no_new_privileges():
        return False
    program = filter_program(machine)
    record = _Program(len(program) // 8, program)
    return control(_SET_SECCOMP, _MODE_FILTER, ctypes.byref(record), 0, 0)


@cache
def filter_program(machine: Machine) -> bytes:
    """The filter as the kernel reads it: eight bytes an instruction."""
    steps = [
        (_LOAD, 0, 0, _ARCHITECTURE),
        (_EQUAL, 1, 0, machine.audit),
        (_ANSWER, 0, 0, _KILL),
        (_LOAD, 0, 0, _NUMBER),
        (_AT_LEAST, 0, 1, _X32),
        (_ANSWER, 0, 0, _KILL),
    ]
    for number in machine.calls:
        steps += [(_EQUAL, 0, 1, number), (_ANSWER, 0, 0, _ALLOW)]
    for number in machine.memory:
        steps += [
            (_EQUAL, 0, 4, number),
            (_LOAD, 0, 0, _THIRD),
            (_ANY_BIT, 1, 0, _PROT_EXEC),
            (_ANSWER, 0, 0, _ALLOW),
            (_ANSWER, 0, 0, _REFUSE),
        ]
    steps.append((_ANSWER, 0, 0, _REFUSE))
    return b"".join(struct.pack("=HBBI", *step) for step in steps)
