"""Which test calls which function of the package: a plugin of pytest for ``planted_bugs.py``.

With CALLED set it writes a file of JSON there: function, as ``file:line`` -> the tests that call it.
Under ``""`` are the tests that failed.
"""

from __future__ import annotations

import json
import os
import sys
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from types import CodeType, FrameType

import pytest

PACKAGE = f"{os.sep}multibot_rewrite{os.sep}"
_calls: dict[str, list[str]] = defaultdict(list)


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Iterator[None]:
    """Note the functions that a test and its fixtures call."""
    seen: set[CodeType] = set()

    def note(frame: FrameType, event: str, _: object) -> None:
        if event == "call":
            seen.add(frame.f_code)

    sys.setprofile(note)
    yield
    sys.setprofile(None)
    for code in seen:
        _, package, file = code.co_filename.rpartition(PACKAGE)
        if package:
            _calls[f"{file}:{code.co_firstlineno}"].append(item.nodeid)


def pytest_runtest_logreport(report: pytest.TestReport) -> None:
    """Note what fails."""
    if report.failed:
        _calls[""].append(report.nodeid)


def pytest_sessionfinish() -> None:
    """Write it down."""
    if "CALLED" in os.environ:
        Path(os.environ["CALLED"]).write_text(json.dumps(_calls))
