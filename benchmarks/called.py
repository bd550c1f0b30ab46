# SPDX-License-Identifier: Apache-2.0
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
from contextlib import contextmanager
from pathlib import Path
from types import CodeType

import pytest

PACKAGE = f"{os.sep}multibot_rewrite{os.sep}"
_calls: dict[str, list[str]] = defaultdict(list)


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Iterator[None]:
    """Note the functions that a test and its fixtures call."""
    with _noted() as seen:
        yield
    for code in seen:
        _, package, file = code.co_filename.rpartition(PACKAGE)
        if package:
            _calls[f"{file}:{code.co_firstlineno}"].append(item.nodeid)


@contextmanager
def _noted() -> Iterator[set[CodeType]]:
    """Yield what is called within the block. From Python 3.12 on each is noted once, which is quick."""
    seen: set[CodeType] = set()
    if sys.version_info < (3, 12):
        sys.setprofile(lambda frame, event, _: event == "call" and seen.add(frame.f_code))
        yield seen
        sys.setprofile(None)
        return
    watch, tool = sys.monitoring, sys.monitoring.PROFILER_ID

    def note(code: CodeType, _: int) -> object:
        seen.add(code)
        return watch.DISABLE

    watch.use_tool_id(tool, "called")
    watch.register_callback(tool, watch.events.PY_START, note)
    watch.set_events(tool, watch.events.PY_START)
    watch.restart_events()
    yield seen
    watch.set_events(tool, watch.events.NO_EVENTS)
    watch.free_tool_id(tool)


def pytest_runtest_logreport(report: pytest.TestReport) -> None:
    """Note what fails."""
    if report.failed:
        _calls[""].append(report.nodeid)


def pytest_sessionfinish() -> None:
    """Write it down."""
    if "CALLED" in os.environ:
        Path(os.environ["CALLED"]).write_text(json.dumps(_calls))
