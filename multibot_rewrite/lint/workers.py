"""Processes that work side by side. What kills one of them is reported, the rest is done.

A pool of the standard library waits forever, or gives up altogether, when one of its processes is
killed; and nothing but the end of a process stops an expression like 9**9**9.
"""

from __future__ import annotations

import gc
import os
import pickle
import select
import signal
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import BinaryIO, Generic, NamedTuple, NoReturn, TypeVar

from multibot_rewrite.model import UsageError

_Item = TypeVar("_Item")
_Made = TypeVar("_Made")
# Beyond what a worker has when it starts: a file that needs more would stop the machine.
MOST_MEMORY = 4 * 2**30
# So many objects may wait for the collector.
MOST_LEFT = 500_000


class _Worker(NamedTuple):
    """A process, the pipe that sends it numbers of items, and the pipe of its answers."""

    pid: int
    orders: BinaryIO
    answers: BinaryIO


class Crew(Generic[_Item, _Made]):
    """Some workers that all do ``work``.

    ``lost`` makes what stands for an item whose worker died, from the item and the number of the
    signal (0: it ended by itself).
    """

    def __init__(
        self,
        work: Callable[[_Item], _Made],
        items: Sequence[_Item],
        lost: Callable[[_Item, int], _Made],
    ) -> None:
        self.work, self.items, self.lost = work, items, lost
        self.workers: dict[int, _Worker] = {}

    def hire(self, count: int) -> None:
        """Start workers; raises UsageError where the system does not let a single one start."""
        for _ in range(count):
            try:
                worker = self._forked()
            except OSError as error:
                if self.workers:
                    return
                raise UsageError(f"no process can be started: {error.strerror}") from None
            self.workers[worker.answers.fileno()] = worker

    def _forked(self) -> _Worker:
        orders, answers = os.pipe(), os.pipe()
        pid = os.fork()
        if pid == 0:
            self._serve(orders, answers)
        os.close(orders[0])
        os.close(answers[1])
        return _Worker(pid, os.fdopen(orders[1], "wb", 0), os.fdopen(answers[0], "rb"))

    def _serve(self, orders: tuple[int, int], answers: tuple[int, int]) -> NoReturn:
        """The life of a worker. It ends with the pipe of its orders, whatever became of the parent."""
        try:
            # Ctrl-C reaches every process of a terminal; the parent decides what it means.
            signal.signal(signal.SIGINT, signal.SIG_IGN)
            signal.signal(signal.SIGTERM, signal.SIG_DFL)
            for fd in (orders[1], answers[0]):
                os.close(fd)
            for other in self.workers.values():
                os.close(other.orders.fileno())
                os.close(other.answers.fileno())
            _limit_memory()
            gc.freeze()
            gc.disable()
            requests, replies = os.fdopen(orders[0], "rb"), os.fdopen(answers[1], "wb")
            while True:
                pickle.dump(self.work(self.items[pickle.load(requests)]), replies)
                replies.flush()
                _collect()
        finally:
            os._exit(0)

    def results(self) -> Iterator[_Made]:
        """What is made of the items, in their order."""
        waiting = iter(range(len(self.items)))
        busy: dict[int, int] = {}
        done: dict[int, _Made] = {}
        for fd in tuple(self.workers):
            self._order(fd, waiting, busy)
        for number in range(len(self.items)):
            while number not in done:
                for fd in _ready(busy):
                    which = busy.pop(fd)
                    done[which], free = self._answer(fd, which)
                    self._order(free, waiting, busy)
            yield done.pop(number)

    def _order(self, fd: int, waiting: Iterator[int], busy: dict[int, int]) -> None:
        number = next(waiting, None)
        if number is None:
            return
        busy[fd] = number
        try:
            pickle.dump(number, self.workers[fd].orders)
        except BrokenPipeError:
            return  # it died idle: its answers end, too

    def _answer(self, fd: int, number: int) -> tuple[_Made, int]:
        """What a worker made of an item, and the worker for the next one: another if it died."""
        try:
            made: _Made = pickle.load(self.workers[fd].answers)
        except (EOFError, pickle.UnpicklingError):
            status = self._dismiss(fd)
            self.hire(1)
            return self.lost(self.items[number], status), next(reversed(self.workers))
        return made, fd

    def _dismiss(self, fd: int) -> int:
        """End a worker and wait for that; the signal that it died of."""
        worker = self.workers.pop(fd)
        worker.orders.close()
        worker.answers.close()
        _, status = os.waitpid(worker.pid, 0)
        return os.WTERMSIG(status) if os.WIFSIGNALED(status) else 0

    def dismiss(self) -> None:
        """End all workers, whatever they are doing."""
        for worker in self.workers.values():
            os.kill(worker.pid, signal.SIGKILL)
        for fd in tuple(self.workers):
            self._dismiss(fd)


@contextmanager
def crew(
    work: Callable[[_Item], _Made],
    items: Sequence[_Item],
    lost: Callable[[_Item, int], _Made],
    jobs: int,
) -> Iterator[Crew[_Item, _Made]]:
    """Workers, for as long as the ``with`` block lasts."""
    result = Crew(work, items, lost)
    try:
        result.hire(min(jobs, len(items)))
        yield result
    finally:
        result.dismiss()


def _ready(busy: dict[int, int]) -> list[int]:
    poll = select.poll()
    for fd in busy:
        poll.register(fd, select.POLLIN)
    return [fd for fd, _ in poll.poll()]


def _collect() -> None:
    """Free what xacro's trees leave, which refer to each other: seldom, and all at once."""
    if gc.get_count()[0] > MOST_LEFT:
        gc.collect()


def _limit_memory() -> None:
    import resource

    try:
        with open("/proc/self/statm") as file:
            now = int(file.read().split()[0]) * resource.getpagesize()
    except OSError:  # not on Linux: no limit
        return
    _, hard = resource.getrlimit(resource.RLIMIT_AS)
    most = now + MOST_MEMORY
    if hard == resource.RLIM_INFINITY or most < hard:
        resource.setrlimit(resource.RLIMIT_AS, (most, hard))


def limit_time(seconds: float) -> None:
    """From now on this process may compute for so long; then SIGXCPU ends it."""
    import resource

    used = resource.getrusage(resource.RUSAGE_SELF)
    most = int(used.ru_utime + used.ru_stime + seconds) + 1
    _, hard = resource.getrlimit(resource.RLIMIT_CPU)
    if hard == resource.RLIM_INFINITY or most < hard:
        resource.setrlimit(resource.RLIMIT_CPU, (most, hard))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
