# SPDX-License-Identifier: Apache-2.0
"""The filter of system calls, run here as the kernel runs it: for both processors, on either."""

from __future__ import annotations

import errno
import struct

import pytest

from multibot_rewrite.description.sources.child.seccomp import MACHINES, Machine, filter_program

KILL, ALLOW, REFUSE = 0x80000000, 0x7FFF0000, 0x00050000 | errno.EPERM
READ, WRITE, EXEC = 1, 2, 4
# Numbers of calls: arch/x86/entry/syscalls/syscall_64.tbl, include/uapi/asm-generic/unistd.h.
COMPUTING = {
    "x86_64": {"read": 0, "write": 1, "brk": 12, "futex": 202, "exit_group": 231, "getrandom": 318},
    "aarch64": {"read": 63, "write": 64, "brk": 214, "futex": 98, "exit_group": 94, "getrandom": 278},
}  # fmt: skip
ACTING = {
    "x86_64": {
        "open": 2, "stat": 4, "ioctl": 16, "dup": 32, "socket": 41, "connect": 42, "sendto": 44,
        "clone": 56, "fork": 57, "vfork": 58, "execve": 59, "kill": 62, "unlink": 87, "chmod": 90,
        "ptrace": 101, "prctl": 157, "setrlimit": 160, "mount": 165, "tkill": 200, "openat": 257,
        "process_vm_readv": 310, "memfd_create": 319, "bpf": 321, "execveat": 322,
        "io_uring_setup": 425, "pidfd_open": 434, "clone3": 435, "openat2": 437, "setitimer": 38,
    },
    "aarch64": {
        "openat": 56, "ioctl": 29, "dup": 23, "socket": 198, "connect": 203, "sendto": 206,
        "clone": 220, "execve": 221, "kill": 129, "unlinkat": 35, "fchmodat": 53, "ptrace": 117,
        "prctl": 167, "setrlimit": 164, "mount": 40, "tkill": 130, "process_vm_readv": 270,
        "memfd_create": 279, "bpf": 280, "execveat": 281, "io_uring_setup": 425, "clone3": 435,
        "openat2": 437, "setitimer": 103,
    },
}  # fmt: skip
MEMORY = {"x86_64": {"mmap": 9, "mprotect": 10}, "aarch64": {"mmap": 222, "mprotect": 226}}


def decide(
    machine: Machine,
    number: int,
    protection: int = 0,
    audit: int = 0,
    files: bool = False,
    second: int = 0,
) -> int:
    """What the filter answers to a call; ``protection`` is its third argument."""
    words = 0, second, protection, 0, 0, 0
    record = struct.pack("<IIQ6Q", number, audit or machine.audit, 0, *words)
    program = [step[:4] for step in struct.iter_unpack("<HBBI", filter_program(machine, files))]
    at, word = 0, 0
    while True:
        code, yes, no, value = program[at]
        at += 1
        if code == 0x06:
            return value
        if code == 0x20:
            (word,) = struct.unpack_from("<I", record, value)
            continue
        holds = {0x15: word == value, 0x35: word >= value, 0x45: bool(word & value)}[code]
        at += yes if holds else no


@pytest.mark.parametrize("name", MACHINES)
def test_computing_is_allowed_and_acting_is_refused(name: str) -> None:
    machine = MACHINES[name]
    computing = {call: decide(machine, number) for call, number in COMPUTING[name].items()}
    acting = {call: decide(machine, number) for call, number in ACTING[name].items()}
    assert set(computing.values()) == {ALLOW}
    assert {call for call, answer in acting.items() if answer != REFUSE} == set()


@pytest.mark.parametrize("name", MACHINES)
def test_no_more_is_allowed_than_was_written_down(name: str) -> None:
    allowed = [number for number in range(1000) if decide(MACHINES[name], number) == ALLOW]
    assert len(allowed) == 24
    assert set(allowed) == {*MACHINES[name].calls, *MACHINES[name].memory}


@pytest.mark.parametrize("name", MACHINES)
def test_memory_is_not_made_executable(name: str) -> None:
    for number in MEMORY[name].values():
        assert decide(MACHINES[name], number, READ | WRITE) == ALLOW
        for protection in (EXEC, READ | EXEC, READ | WRITE | EXEC, EXEC | 0x01000000):
            assert decide(MACHINES[name], number, protection) == REFUSE


# Beside the calls above, numbers of those that work on files.
ON_FILES = {
    "x86_64": {"openat": 257, "ioctl": 16, "fcntl": 72, "fstat": 5, "getdents64": 217, "unlink": 87},
    "aarch64": {"openat": 56, "ioctl": 29, "fcntl": 25, "fstat": 80, "getdents64": 61, "unlinkat": 35},
}  # fmt: skip
# Those of them that change what no path is asked for, or reach another process.
NEVER = {
    "x86_64": "socket connect sendto clone fork vfork execve kill chmod ptrace prctl setrlimit mount"
    " tkill process_vm_readv memfd_create bpf execveat io_uring_setup pidfd_open clone3 openat2",
    "aarch64": "socket connect sendto clone execve kill fchmodat ptrace prctl setrlimit mount tkill"
    " process_vm_readv memfd_create bpf execveat io_uring_setup clone3 openat2",
}
# truncate, link, symlink, utimensat, chown, setxattr, mknod, chroot.
ON_PATHS = {
    "x86_64": (76, 86, 88, 280, 92, 188, 133, 161),
    "aarch64": (45, 37, 36, 88, 54, 5, 33, 51),
}
CUT, TO_WRITE, OWNER, SIGNAL = 0o1000, 0o1, 8, 10


@pytest.mark.parametrize("name", MACHINES)
def test_files_can_be_opened_where_landlock_says_which(name: str) -> None:
    """A file that is opened to be read is not cut off; nobody gets signals for it."""
    machine, calls = MACHINES[name], ON_FILES[name]

    def answer(call: str, second: int = 0, third: int = 0) -> int:
        return decide(machine, calls[call], third, files=True, second=second)

    assert {answer(it) for it in calls.keys() - {"ioctl"}} == {ALLOW}
    assert (answer("openat", third=TO_WRITE | CUT), answer("openat", third=CUT)) == (ALLOW, REFUSE)
    assert {answer("fcntl", it) for it in (OWNER, SIGNAL, 15)} == {REFUSE}
    assert (answer("ioctl", 0x5451), answer("ioctl", 0x5412)) == (ALLOW, REFUSE)
    never = [*(ACTING[name][it] for it in NEVER[name].split()), *ON_PATHS[name]]
    assert {decide(machine, it, files=True) for it in never} == {REFUSE}
    assert {decide(machine, it, files=False) for it in calls.values()} == {REFUSE}


@pytest.mark.parametrize("name", MACHINES)
def test_another_interface_of_the_processor_is_the_end(name: str) -> None:
    machine = MACHINES[name]
    assert decide(machine, COMPUTING[name]["read"], audit=0x40000003) == KILL
    assert decide(machine, 0x40000000 | COMPUTING[name]["write"]) == KILL
