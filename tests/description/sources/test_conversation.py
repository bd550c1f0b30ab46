# SPDX-License-Identifier: Apache-2.0
"""A child that lies: whatever it answers is one line, and leads to nothing that it was not given."""

from __future__ import annotations

import json
import signal
import socket
import struct
import threading
from array import array
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext, suppress
from functools import partial
from pathlib import Path

import pytest

from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.outside import recorded
from multibot_rewrite.description.sources import conversation
from multibot_rewrite.description.sources.child.frames import (
    CALLS,
    ORIGINS,
    PIECES,
    QUESTION,
    REPORT,
    TEXT,
    framed,
)
from multibot_rewrite.description.sources.expand import expand, expand_traced

SOURCE = b'<robot name="r"><link name="a"/></robot>'
GOOD = {
    "notes": "", "fences": [], "files": [["FILE", 2]], "macros": ["m"], "root": ["", "robot"],
    "words": [],
}  # fmt: skip
FAILED = {"reason": "r", "file": "f", "position": None, "place": None, "call": -1}


class Liar:
    """A child that sends the same bytes whatever it is asked."""

    def __init__(self, data: bytes) -> None:
        self.ours, self.theirs = socket.socketpair()
        ways = (self._talk, data), (self._listen,)
        self.threads = [threading.Thread(target=way, args=words) for way, *words in ways]
        for it in self.threads:
            it.start()

    def _talk(self, data: bytes) -> None:
        with suppress(OSError):
            self.theirs.sendall(data)
            self.theirs.shutdown(socket.SHUT_WR)

    def _listen(self) -> None:
        with suppress(OSError):
            while self.theirs.recv(1 << 16):
                pass

    def send(self, data: bytes) -> None:
        self.ours.sendall(data)

    def read(self, count: int) -> bytes:
        data = b""
        while len(data) < count:
            more = self.ours.recv(count - len(data))
            if not more:
                raise EOFError
            data += more
        return data

    def end(self, ended: bool = False) -> int:
        self.ours.close()
        for it in self.threads:
            it.join()
        self.theirs.close()
        return 0


@pytest.fixture
def file(tmp_path: Path) -> str:
    path = tmp_path / "r.xacro"
    path.write_bytes(SOURCE)
    return str(path)


def lie(monkeypatch: pytest.MonkeyPatch, data: bytes) -> None:
    @contextmanager
    def child(seconds: float) -> Iterator[Liar]:
        liar = Liar(data)
        try:
            yield liar
        finally:
            liar.end()

    monkeypatch.setattr(conversation, "child", child)


def told(report: object, text: bytes = SOURCE, origins: bytes = b"", calls: bytes = b"") -> bytes:
    head = framed(REPORT, json.dumps(report).encode())
    rows = framed(ORIGINS, origins) + framed(CALLS, calls) + framed(PIECES, b"")
    return head + framed(TEXT, text) + rows


LIES = {
    "nothing": b"",
    "half-a-head": b"J\0",
    "half-a-frame": b"J\0\0\1\0{}",
    "too-long": b"J\xff\xff\xff\xff",
    "unknown-frame": framed(b"!", b""),
    "no-json": framed(REPORT, b"\xff"),
    "nested": framed(REPORT, b"[" * 100_000),
    "a-list": framed(REPORT, b"[]"),
    "a-number": framed(REPORT, b"1" * 100_000),
    "empty-report": framed(REPORT, b"{}"),
    "no-text": framed(REPORT, json.dumps(GOOD).encode()),
    "text-too-long": framed(REPORT, json.dumps(GOOD).encode()) + struct.pack(">cI", TEXT, 1 << 25),
    "question-unknown": framed(QUESTION, b'["write", "/etc/passwd"]'),
    "question-no-pair": framed(QUESTION, b"1"),
    "question-no-text": framed(QUESTION, b'["read", 1]'),
    "question-a-list": framed(QUESTION, b"[[], []]"),
    "questions-only": framed(QUESTION, b'["env", "ROS_X"]') * 30_000,
    "notes-no-text": told({**GOOD, "notes": 1}),
    "files-no-list": told({**GOOD, "files": 1}),
    "file-no-text": told({**GOOD, "files": [[1, 2]]}),
    "count-no-number": told({**GOOD, "files": [["a", "b"]]}),
    "count-nested": told({**GOOD, "files": [["a", []]]}),
    "count-infinite": told({**GOOD, "files": [["a", 1e999]]}),
    "macros-no-text": told({**GOOD, "macros": [1]}),
    "root-no-pair": told({**GOOD, "root": []}),
    "failure-empty": told({**GOOD, "error": {"reason": "r"}}),
    "failure-place": told({**GOOD, "error": {**FAILED, "place": [1]}}),
    "numbers-odd": told(GOOD, origins=b"123"),
    "numbers-no-triple": told(GOOD, origins=array("i", [1]).tobytes()),
}


@pytest.mark.sample(1)
@pytest.mark.parametrize("name", LIES)
def test_a_lie_is_one_line(name: str, file: str, monkeypatch: pytest.MonkeyPatch) -> None:
    lie(monkeypatch, LIES[name])
    with pytest.raises(InputError) as caught:
        expand(file, {})
    assert str(caught.value).startswith(f"{file}: xacro failed: its process ")
    assert "\n" not in str(caught.value)


ENDS = (-(2**31), -2, -1, 0, 1, 2, 2**31 - 1)


@pytest.mark.parametrize("number", ENDS)
def test_numbers_lead_nowhere_else(number: int, file: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Origins and calls are looked up in the files that were read, or not at all."""
    report = {**GOOD, "files": [["r.xacro", 2], ["/etc/passwd", 2]]}
    numbers = array("i", [number] * 6).tobytes()
    calls = array("i", [number] * 8).tobytes()
    lie(monkeypatch, told(report, origins=numbers, calls=calls))
    found = expand_traced(file, SOURCE, {})
    origins = [found.origins.of(at) for at in range(2)]
    assert {it.file for it in origins if it} <= set(found.sources) <= {file}


def test_places_that_are_not_as_many_as_elements(
    file: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    lie(monkeypatch, told(GOOD, origins=array("i", [0] * 3).tobytes()))
    with pytest.raises(InputError, match="places that its process reported are wrong"):
        expand_traced(file, SOURCE, {})


@pytest.mark.parametrize("number", ENDS)
def test_a_failure_is_placed_where_something_is(
    number: int, file: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    error = {**FAILED, "file": file, "place": [number, number, "na(me"], "call": number}
    report = framed(REPORT, json.dumps({**GOOD, "error": error}).encode())
    lie(
        monkeypatch,
        report + framed(CALLS, array("i", [number] * 4).tobytes()) + framed(PIECES, b""),
    )
    with pytest.raises(InputError, match="xacro failed: r; run xacro"):
        expand(file, {})


def test_calls_that_go_in_a_circle(file: str, monkeypatch: pytest.MonkeyPatch) -> None:
    report = {**GOOD, "files": [[file, 2]]}
    calls = array("i", [1, 0, 0, 0, 0, 0, 0, 1]).tobytes()
    lie(monkeypatch, told(report, origins=array("i", [0, 0, 1, 0, 1, 1]).tobytes(), calls=calls))
    origin = expand_traced(file, SOURCE, {}).origins.of(1)
    assert origin is not None
    assert [it.start for it in origin.calls] == [16, 0]


def test_what_a_terminal_would_obey_is_not_printed(
    file: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    lie(monkeypatch, told({**GOOD, "notes": "a\x1b]0;x\x07\u009b1m\u202eb\n"}))
    expand(file, {})
    assert capsys.readouterr().err == "a?]0;x??1m?b\n"


class Gone:
    """A child that is asked and gives no answer."""

    def __init__(self, fault: type[Exception]) -> None:
        self.fault = fault

    def send(self, data: bytes) -> None:
        pass

    def read(self, count: int) -> bytes:
        raise self.fault

    def end(self, ended: bool = False) -> int:
        return signal.SIGKILL


def refusal(file: str) -> str:
    with pytest.raises(InputError) as caught:
        expand(file, {})
    return str(caught.value)


@pytest.mark.parametrize("fault", [TimeoutError, EOFError, ConnectionResetError])
def test_no_answer_may_be_an_answer_next_time(
    fault: type[Exception], file: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Time and memory decided, so nobody may keep the result."""
    monkeypatch.setattr(conversation, "child", lambda _: nullcontext(Gone(fault)))
    said, asked = recorded(partial(refusal, file))
    assert said.startswith(f"{file}: xacro failed: ")
    assert asked is None


def test_what_xacro_says_is_an_answer(file: str, monkeypatch: pytest.MonkeyPatch) -> None:
    report = json.dumps(GOOD | {"error": FAILED}).encode()
    lie(monkeypatch, framed(REPORT, report) + framed(CALLS, b"") + framed(PIECES, b""))
    said, asked = recorded(partial(refusal, file))
    assert "): r; " in said
    assert asked is not None
