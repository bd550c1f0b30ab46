# SPDX-License-Identifier: Apache-2.0
"""Processes that work in parallel. If one of them is killed that is reported, and the rest is done.

A pool of the standard library waits forever, or gives up altogether, when one of its processes is
killed; and nothing but the end of a process stops an expression like 9**9**9.
"""

import gc
import os
import pickle
import resource
import select
import signal
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import BinaryIO, Generic, NamedTuple, NoReturn, TypeVar, cast

from multibot_rewrite.base.model import UsageError

_Item = TypeVar("_Item")
_Made = TypeVar("_Made")
# Beyond what a worker has when it starts: a file that needs more would stop the machine.
MOST_MEMORY = 4 * 2**30
# What a container may use in a period: cgroup v2, as Docker, Podman and Kubernetes mount it.
QUOTA = "/sys/fs/cgroup/cpu.max"
# So many objects may wait for the garbage collector.
MOST_LEFT = 500_000


class _Worker(NamedTuple):
    """A process, the pipe that sends it the numbers of items, and the pipe of its answers."""

    pid: int
    requests: BinaryIO
    answers: BinaryIO


class WorkerPool(Generic[_Item, _Made]):
    """Workers that run ``work``; ``lost`` returns the result for an item whose worker died."""

    def __init__(
        self,
        work: Callable[[_Item], _Made],
        items: Sequence[_Item],
        lost: Callable[[_Item, int], _Made],
    ) -> None:
        self.work, self.items, self.lost = work, items, lost
        self.workers: dict[int, _Worker] = {}

    def start(self) -> None:
        """Start a worker; raises UsageError where the system lets none start and there is no other."""
        requests, answers = os.pipe(), os.pipe()
        try:
            pid = os.fork()
        except OSError as error:
            for fd in (*requests, *answers):
                os.close(fd)
            if not self.workers:
                raise UsageError(f"no process starts, end others: {error.strerror}") from None
            return
        if pid == 0:
            self._serve(requests, answers)
        os.close(requests[0])
        os.close(answers[1])
        one = _Worker(pid, os.fdopen(requests[1], "wb", 0), os.fdopen(answers[0], "rb"))
        self.workers[answers[0]] = one

    def _serve(self, requests: tuple[int, int], answers: tuple[int, int]) -> NoReturn:
        """Answer requests until their pipe is closed, also if the parent died."""
        try:
            # Ctrl-C reaches every process of a terminal; the parent handles it.
            signal.signal(signal.SIGINT, signal.SIG_IGN)
            signal.signal(signal.SIGTERM, signal.SIG_DFL)
            for fd in (requests[1], answers[0]):
                os.close(fd)
            for other in self.workers.values():
                os.close(other.requests.fileno())
                os.close(other.answers.fileno())
            _limit_memory()
            gc.freeze()
            gc.disable()
            inbox, outbox = os.fdopen(requests[0], "rb"), os.fdopen(answers[1], "wb")
            while True:
                pickle.dump(self.work(self.items[pickle.load(inbox)]), outbox)
                outbox.flush()
                # Free xacro's trees, whose nodes refer to each other: rarely, and all at once.
                if gc.get_count()[0] > MOST_LEFT:
                    gc.collect()
        finally:
            os._exit(0)

    def results(self) -> Iterator[_Made]:
        """Yield the results for the items, in their order."""
        waiting = iter(range(len(self.items)))
        busy: dict[int, int] = {}
        done: dict[int, _Made] = {}
        for number in range(len(self.items)):
            while number not in done:
                for fd, item in zip(self.workers.keys() - busy.keys(), waiting, strict=False):
                    busy[fd] = item
                    with suppress(BrokenPipeError):  # it died while idle: its answers end as well
                        pickle.dump(item, self.workers[fd].requests)
                poll = select.poll()
                for fd in busy:
                    poll.register(fd, select.POLLIN)
                for fd, _ in poll.poll():
                    which = busy.pop(fd)
                    done[which] = self._answer(fd, which)
            yield done.pop(number)

    def _answer(self, fd: int, number: int) -> _Made:
        """Return a worker's result for an item; another worker takes the place of one that died."""
        try:
            return cast("_Made", pickle.load(self.workers[fd].answers))
        except (EOFError, pickle.UnpicklingError):
            died_of = _ended(self.workers.pop(fd))
            self.start()
            return self.lost(self.items[number], died_of)


def _ended(worker: _Worker) -> int:
    """Wait for the end of a worker; return the signal that killed it."""
    worker.requests.close()
    worker.answers.close()
    _, status = os.waitpid(worker.pid, 0)
    return os.WTERMSIG(status) if os.WIFSIGNALED(status) else 0


def processors() -> int:
    """Return how many processors this process may use, by its affinity and its container's quota."""
    if not hasattr(os, "sched_getaffinity"):  # not on Linux
        return os.cpu_count() or 1
    try:
        with open(QUOTA) as file:
            quota, period = map(int, file.read().split())
    except (OSError, ValueError):  # "max 100000" is no quota
        quota, period = 0, 1
    allowed = len(os.sched_getaffinity(0))
    return min(allowed, -(-quota // period)) if quota else allowed


@contextmanager
def worker_pool(
    work: Callable[[_Item], _Made],
    items: Sequence[_Item],
    lost: Callable[[_Item, int], _Made],
    jobs: int,
) -> Iterator[WorkerPool[_Item, _Made]]:
    """Yield workers, for as long as the ``with`` block lasts."""
    pool = WorkerPool(work, items, lost)
    try:
        for _ in range(min(jobs, len(items))):
            pool.start()
        yield pool
    finally:
        for it in pool.workers.values():
            os.kill(it.pid, signal.SIGKILL)
            _ended(it)


def _limit_memory() -> None:
    try:
        with open("/proc/self/statm") as file:
            now = int(file.read().split()[0]) * resource.getpagesize()
    except OSError:  # not on Linux: no limit
        return
    _limit(resource.RLIMIT_AS, now + MOST_MEMORY)


def limit_files(most: int) -> None:
    """Let this process make no file of more bytes: a write beyond raises OSError."""
    _limit(resource.RLIMIT_FSIZE, most)


def limit_time(seconds: float) -> None:
    """Limit the CPU time of this process from now on; after it SIGXCPU ends the process."""
    used = resource.getrusage(resource.RUSAGE_SELF)
    _limit(resource.RLIMIT_CPU, int(used.ru_utime + used.ru_stime + seconds) + 1)
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def _limit(kind: int, most: int) -> None:
    """Lower a resource limit of this process to ``most``."""
    _, hard = resource.getrlimit(kind)
    if hard == resource.RLIM_INFINITY or most < hard:
        resource.setrlimit(kind, (most, hard))
