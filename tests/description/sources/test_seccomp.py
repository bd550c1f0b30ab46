# SPDX-License-Identifier: Apache-2.0
"""The filter of system calls, run here as the kernel runs it: for both processors, on either."""

from __future__ import annotations

import ctypes
import errno
import os
import signal
import struct
from collections.abc import Iterable
from typing import Any, NamedTuple

import pytest
from paths import FIXTURES

from multibot_rewrite.description.sources.child import seccomp
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
    first: int = 0,
    fourth: int = 0,
) -> int:
    """Return what the filter answers to a call; ``protection`` is its third argument."""
    words = first, second, protection, fourth, 0, 0
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
    machine = MACHINES[name]
    assert set(allowed) == {*machine.calls, *machine.memory, *machine.asks[:4]}


@pytest.mark.parametrize("name", MACHINES)
def test_memory_is_read_and_written_alone(name: str) -> None:
    for number in MEMORY[name].values():
        assert decide(MACHINES[name], number, READ | WRITE) == ALLOW
        for protection in (
            EXEC,
            READ | EXEC,
            READ | WRITE | EXEC,
            *(1 << it for it in range(3, 32)),
        ):
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


class Call(NamedTuple):
    """A system call: its number by processor, and the published filter that refuses it."""

    name: str
    numbers: dict[str, int]
    refused_by: str


def _calls() -> list[Call]:
    lines = (FIXTURES / "system_calls.tsv").read_text().splitlines()
    head, *rows = (it.split("\t") for it in lines if not it.startswith("#"))
    assert head[1:3] == ["x86_64", "aarch64"]
    return [
        Call(name, {key: int(it) for key, it in zip(head[1:3], its, strict=True) if it}, by)
        for name, *its, by in rows
    ]


CALLS = _calls()
# What a process does that computes and answers; with files also what reads and writes a folder.
COMPUTING_CALLS = """
read write close lseek brk mmap munmap mprotect mremap madvise rt_sigaction rt_sigprocmask rt_sigreturn
sigaltstack sched_yield getpid gettid gettimeofday clock_gettime futex restart_syscall exit exit_group
getrandom
"""
FILE_CALLS = """
stat fstat lstat newfstatat statx access faccessat faccessat2 readlink readlinkat getcwd chdir openat
pread64 pwrite64 readv writev dup ioctl fcntl fsync fdatasync ftruncate getdents getdents64 mkdir
mkdirat rmdir unlink unlinkat rename renameat renameat2 nanosleep clock_nanosleep clock_getres uname
sysinfo times getrusage getuid getgid geteuid getegid getppid sched_getaffinity
"""
COMPUTES = {*COMPUTING_CALLS.split()}
WITH_FILES = COMPUTES | {*FILE_CALLS.split()}
# Of those that others refuse: the time that this process took, which Python's modules ask for.
OPEN = {"getrusage", "times"}


@pytest.mark.parametrize("files", [False, True])
@pytest.mark.parametrize("name", MACHINES)
def test_each_call_is_refused_unless_it_computes(name: str, files: bool) -> None:
    """Each of Linux, by its number in the kernel's own tables."""

    def answer(call: Call) -> int:
        # What may be asked of a file by ioctl is one thing, 0 is none.
        second = 0x5451 if call.name == "ioctl" else 0
        return decide(MACHINES[name], call.numbers[name], files=files, second=second)

    answers = {it.name: answer(it) for it in CALLS if name in it.numbers}
    computing = {it for it in (WITH_FILES if files else COMPUTES) if it in answers}
    assert len(answers) > 300 and set(answers.values()) == {ALLOW, REFUSE}
    assert {call for call, it in answers.items() if it == ALLOW} == computing


def test_what_published_filters_refuse_is_refused() -> None:
    """Groups of systemd that a service does without; what flatpak and Docker keep from any program."""
    others = {it.name for it in CALLS if it.refused_by}
    published = {it.refused_by for it in CALLS}
    assert len(others) > 150 and published >= {"@debug", "@mount", "flatpak", "Docker"}
    assert others & WITH_FILES == OPEN and not others & COMPUTES


# include/uapi/linux/futex.h. Chromium's sandbox refuses those of priorities as well (RestrictFutex in
# syscall_parameters_restrictions.cc): CVE-2014-3153 was one of them.
WAIT, WAKE, FD, REQUEUE, CMP_REQUEUE, WAKE_OP, WAIT_BITSET, WAKE_BITSET = 0, 1, 2, 3, 4, 5, 9, 10
LOCK_PI, UNLOCK_PI, TRYLOCK_PI, WAIT_REQUEUE_PI, CMP_REQUEUE_PI, LOCK_PI2 = 6, 7, 8, 11, 12, 13
PRIVATE, REALTIME = 128, 256


@pytest.mark.parametrize("files", [False, True])
@pytest.mark.parametrize("name", MACHINES)
def test_a_lock_inherits_no_priority(name: str, files: bool) -> None:
    def answer(operation: int) -> int:
        number = COMPUTING[name]["futex"]
        return decide(MACHINES[name], number, files=files, second=operation)

    waits = (WAIT, WAKE, REQUEUE, CMP_REQUEUE, WAKE_OP, WAIT_BITSET, WAKE_BITSET)
    assert {answer(it | more) for it in waits for more in (0, PRIVATE)} == {ALLOW}
    # What Python's locks with a limit of time ask for: glibc, pthread_cond_clockwait.
    assert {answer(WAIT_BITSET | REALTIME | more) for more in (0, PRIVATE)} == {ALLOW}
    never = (FD, LOCK_PI, UNLOCK_PI, TRYLOCK_PI, WAIT_REQUEUE_PI, CMP_REQUEUE_PI, LOCK_PI2)
    for more in (0, PRIVATE, REALTIME, PRIVATE | REALTIME):
        assert {answer(it | more) for it in never} == {REFUSE}


# include/uapi/linux/time.h, random.h; include/uapi/asm-generic/mman-common.h, mman.h. What Chromium's
# sandbox allows is in baseline_policy.cc and syscall_parameters_restrictions.cc: normal, random, not
# needed, free; eight clocks of the system and its own; to wait or not; memory without huge, locked or
# populated pages, and without a stack that grows.
ARGUMENTS = (
    ("madvise", "protection", {0, 1, 4, 8}, (2, 3, 9, 10, 12, 14, 18, 20, 21, 25, 100, 101)),
    ("clock_gettime", "first", {*range(8)}, (8, 9, 11, 16, 2**32 - 6, 2**31)),
    ("getrandom", "protection", {0, 1}, (2, 3, 4)),
    ("mmap", "fourth", {1, 2, 0x22, 0x32, 0x4022, 0x20022}, (0x40022, 0x2022, 0x8022, 0x122)),
)


@pytest.mark.parametrize(("name", "files"), [(it, files) for it in MACHINES for files in (0, 1)])
@pytest.mark.parametrize(
    ("call", "which", "good", "bad"), ARGUMENTS, ids=[it[0] for it in ARGUMENTS]
)
def test_arguments_are_those_that_computing_needs(
    call: str, which: str, good: set[int], bad: tuple[int, ...], name: str, files: bool
) -> None:
    (number,) = (it.numbers[name] for it in CALLS if it.name == call)

    def answers(values: Iterable[int]) -> set[int]:
        given: list[Any] = [{which: it} for it in values]
        return {decide(MACHINES[name], number, files=files, **it) for it in given}

    assert answers(good) == {ALLOW}
    # Libraries are loaded into memory of any kind.
    assert answers(bad) == ({ALLOW} if files and call == "mmap" else {REFUSE})


@pytest.mark.more
@pytest.mark.parametrize("files", [False, True])
def test_the_kernel_refuses_each_of_them(files: bool) -> None:
    """Asked for in a process with the filter: whatever is refused does nothing, and says EPERM."""
    name = os.uname().machine
    if name not in MACHINES:
        pytest.skip(f"no filter for {name}")
    allowed = WITH_FILES if files else COMPUTES
    numbers = [it.numbers[name] for it in CALLS if name in it.numbers and it.name not in allowed]
    ask = ctypes.CDLL(None, use_errno=True).syscall
    ask.restype = ctypes.c_long
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            signal.alarm(20)
            if seccomp.enclose(files):
                for number in numbers:
                    answer = ask(number, 0, 0, 0, 0, 0, 0)
                    refused = answer == -1 and ctypes.get_errno() == errno.EPERM
                    os.write(writing, b"." if refused else b"%d " % number)
        finally:
            os._exit(0)
    os.close(writing)
    with os.fdopen(reading, "rb") as file:
        said = file.read()
    os.waitpid(child, 0)
    assert len(numbers) > 200 and said == b"." * len(numbers)
