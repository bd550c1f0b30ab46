# SPDX-License-Identifier: Apache-2.0
"""Waiting for what another process does: the only place where a test reads a clock."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TypeVar

PATIENCE = 30.0
_PAUSE = 0.02
Found = TypeVar("Found")


def wait_until(look: Callable[[], Found], seconds: float = PATIENCE) -> Found:
    """Return the first true answer of ``look``; AssertionError if none comes in that time."""
    limit = time.monotonic() + seconds
    while not (found := look()):
        assert time.monotonic() < limit, f"it does not come within {seconds} s"
        time.sleep(_PAUSE)
    return found
