# SPDX-License-Identifier: Apache-2.0
"""Results are written whole or not at all, whenever the program or the machine stops."""

from __future__ import annotations

import os
import shutil
import signal
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

from multibot_rewrite import UsageError
from multibot_rewrite.cli.files import write_all, write_new

# The calls by which files are changed.
CALLS = ("mkdir", "open", "write", "fsync", "link", "replace", "unlink")
OLD = {"a.urdf": b"old a", "b.urdf": b"old b"}
NEW = {"a.urdf": b"new a", "b.urdf": b"new b", "more/c.urdf": b"new c"}
Watch = Callable[[str, tuple[Any, ...], Callable[[], Any]], Any]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name, data in OLD.items():
        (tmp_path / name).write_bytes(data)
    return tmp_path


def write(folder: Path) -> None:
    write_all((str(folder / name), data) for name, data in NEW.items())


def held(folder: Path) -> dict[str, bytes]:
    files = (it for it in folder.rglob("*") if it.is_file())
    return {it.relative_to(folder).as_posix(): it.read_bytes() for it in files}


def watched(patch: pytest.MonkeyPatch, watch: Watch) -> None:
    """Each of ``CALLS`` goes through ``watch``: its name, what it is given, and the call itself."""
    for name in CALLS:
        real = getattr(os, name)

        def call(*given: Any, _name: str = name, _real: Any = real, **more: Any) -> Any:
            return watch(_name, given, lambda: _real(*given, **more))

        patch.setattr(os, name, call)


def counted(folder: Path) -> int:
    """How many calls one write takes."""
    seen: list[str] = []

    def note(name: str, given: tuple[Any, ...], go: Callable[[], Any]) -> Any:
        seen.append(name)
        return go()

    with pytest.MonkeyPatch.context() as patch:
        watched(patch, note)
        write(folder)
    return len(seen)


@pytest.fixture
def calls(tmp_path_factory: pytest.TempPathFactory) -> range:
    """Return the number of each call of a write over the old files."""
    beside = tmp_path_factory.mktemp("beside")
    for name, data in OLD.items():
        (beside / name).write_bytes(data)
    return range(1, counted(beside) + 1)


def at(number: int, stop: Callable[[], Any]) -> Watch:
    """In the place of a call, by its number, ``stop`` is called."""
    left = iter(range(1, 10**6))

    def watch(name: str, given: tuple[Any, ...], go: Callable[[], Any]) -> Any:
        return stop() if next(left) == number else go()

    return watch


def test_all_is_written(folder: Path) -> None:
    write(folder)
    assert held(folder) == NEW


@pytest.mark.more
@pytest.mark.parametrize("error", [OSError(28, "No space left on device"), KeyboardInterrupt()])
def test_a_call_that_fails_leaves_everything_as_it_was(
    error: BaseException, folder: Path, calls: range
) -> None:
    """But for what is done when all files are in place: removing backups, waiting for folders."""

    def fail() -> None:
        raise error

    whole = 0
    for number in calls:
        with pytest.MonkeyPatch.context() as patch:
            watched(patch, at(number, fail))
            try:
                write(folder)
            except (UsageError, KeyboardInterrupt) as stopped:
                assert isinstance(stopped, KeyboardInterrupt) or "No space left" in str(stopped)
        if held(folder) == OLD:
            assert sorted(it.name for it in folder.iterdir()) == sorted(OLD)
            continue
        whole += 1
        assert {name: held(folder).get(name) for name in NEW} == NEW
        for name in held(folder).keys() - OLD.keys():
            (folder / name).unlink()
        (folder / "more").rmdir()
        for name, data in OLD.items():
            (folder / name).write_bytes(data)
    assert 0 < whole < len(calls) / 2


def test_an_interrupt_at_any_call_leaves_no_copies(folder: Path, calls: range) -> None:
    for number in calls:
        left = iter(range(1, 10**6))

        def watch(_: str, __: tuple[Any, ...], go: Callable[[], Any], at: int = number) -> Any:
            if next(left) == at:  # noqa: B023
                os.kill(os.getpid(), signal.SIGINT)
            return go()

        with pytest.MonkeyPatch.context() as patch, suppress(KeyboardInterrupt):
            watched(patch, watch)
            write(folder)
        assert held(folder) in (OLD, NEW)
        shutil.rmtree(folder / "more", ignore_errors=True)
        for name, data in OLD.items():
            (folder / name).write_bytes(data)


@pytest.mark.slow
def test_a_process_that_is_killed_at_any_call_leaves_each_file_old_or_new(
    folder: Path, calls: range
) -> None:
    for number in calls:
        child = os.fork()
        if not child:
            watched(pytest.MonkeyPatch(), at(number, lambda: os.kill(os.getpid(), signal.SIGKILL)))
            write(folder)
            os._exit(0)
        _, status = os.waitpid(child, 0)
        assert os.WIFSIGNALED(status)
        for name, data in NEW.items():
            assert held(folder).get(name) in (OLD.get(name), data)


def stopped_disks(events: list[tuple[str, str, str]]) -> Iterator[str]:
    """Yield the targets that a disk may hold torn, after a stop of the machine at any event.

    Of what a file holds the disk has nothing for sure until the file was seen onto it; a new name of
    the file may be there at once.
    """
    sure: set[str] = set()
    for name, path, to in events:
        if name == "write":
            sure.discard(path)
        elif name == "fsync":
            sure.add(path)
        elif name == "replace" and path not in sure:
            yield to


def test_a_machine_that_stops_at_any_time_has_each_file_old_or_new(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    events: list[tuple[str, str, str]] = []
    names: dict[int, str] = {}

    def note(name: str, given: tuple[Any, ...], go: Callable[[], Any]) -> Any:
        made = go()
        if name == "open":
            names[made] = str(given[0])
        path = names[given[0]] if isinstance(given[0], int) else str(given[0])
        events.append((name, path, str(given[1]) if name == "replace" else ""))
        return made

    watched(monkeypatch, note)
    write(folder)
    assert list(stopped_disks(events)) == []
    renamed = [to for name, _, to in events if name == "replace"]
    assert renamed == [str(folder / name) for name in NEW]
    # What the command said to have written is there after a stop, too: its folders are on the disk.
    last = max(at for at, (name, *_) in enumerate(events) if name == "replace")
    seen = {path for name, path, _ in events[last:] if name == "fsync"}
    assert seen == {str(folder), str(folder / "more")}


def test_the_disk_finishes_once_for_all_files(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """No file is waited for while others are still to be written."""
    order: list[str] = []

    def note(name: str, given: tuple[Any, ...], go: Callable[[], Any]) -> Any:
        order.append(name)
        return go()

    watched(monkeypatch, note)
    write(folder)
    last = max(at for at, name in enumerate(order) if name == "write")
    assert order.index("fsync") > last


@pytest.mark.parametrize(("umask", "mode"), [(0o022, 0o644), (0o027, 0o640)])
def test_a_new_file_has_the_rights_that_the_umask_leaves(
    umask: int, mode: int, tmp_path: Path
) -> None:
    """As those of open(): read and write for all, and no program."""
    before = os.umask(umask)
    try:
        write_new(str(tmp_path / "new"), b"", 0)
    finally:
        os.umask(before)
    assert (tmp_path / "new").stat().st_mode & 0o777 == mode
