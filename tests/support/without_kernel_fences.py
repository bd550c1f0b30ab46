# SPDX-License-Identifier: Apache-2.0
"""Run a module of Python in a process whose kernel has neither Landlock nor seccomp, as in a container
that forbids both: ``python tests/support/without_kernel_fences.py MODULE ARGUMENT...``.

A filter of its own answers the calls that would put them up: ENOSYS, and EPERM for ``prctl``.
"""

from __future__ import annotations

import ctypes
import errno
import os
import runpy
import struct
import sys

from multibot_rewrite.description.sources.child.fences import CREATE_RULESET, RESTRICT_SELF
from multibot_rewrite.description.sources.child.seccomp import MACHINES, control, no_new_privileges

# include/uapi/linux/filter.h, seccomp.h and prctl.h; prctl and seccomp have a number for each machine.
_LOAD, _EQUAL, _ANSWER, _ALLOW = 0x20, 0x15, 0x06, 0x7FFF0000
_NUMBER, _FIRST = 0, 16
_CALLS = {"x86_64": (157, 317), "aarch64": (167, 277)}
_SET_SECCOMP, _MODE_FILTER = 22, 2


def _refused(error: int) -> int:
    return 0x00050000 | error


def absent() -> None:
    """Take both from this process and from all that it starts."""
    prctl, seccomp = _CALLS[os.uname().machine]
    steps = [(_LOAD, 0, 0, _NUMBER)]
    for number in (CREATE_RULESET, CREATE_RULESET + 1, RESTRICT_SELF, seccomp):
        steps += [(_EQUAL, 0, 1, number), (_ANSWER, 0, 0, _refused(errno.ENOSYS))]
    steps += [(_EQUAL, 0, 3, prctl), (_LOAD, 0, 0, _FIRST), (_EQUAL, 0, 1, _SET_SECCOMP)]
    steps += [(_ANSWER, 0, 0, _refused(errno.EPERM)), (_ANSWER, 0, 0, _ALLOW)]
    program = b"".join(struct.pack("=HBBI", *step) for step in steps)

    class Program(ctypes.Structure):
        _fields_ = (("length", ctypes.c_ushort), ("filter", ctypes.c_char_p))

    record = Program(len(steps), program)
    assert no_new_privileges()
    assert control(_SET_SECCOMP, _MODE_FILTER, ctypes.byref(record), 0, 0)


if __name__ == "__main__":
    assert os.uname().machine in MACHINES
    absent()
    module, *arguments = sys.argv[1:]
    sys.argv = [module, *arguments]
    runpy.run_module(module, run_name="__main__", alter_sys=True)
