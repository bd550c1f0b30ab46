# SPDX-License-Identifier: Apache-2.0
"""What a piece of work costs, without a clock: the lines of Python that it runs."""

from __future__ import annotations

import sys
from collections.abc import Callable
from types import FrameType
from typing import Any


def steps(work: Callable[[], object]) -> int:
    """How many lines run while ``work`` does; a loop within one line counts each turn."""
    count = 0

    def trace(frame: FrameType, event: str, _: object) -> Any:
        nonlocal count
        count += event == "line"
        return trace

    before = sys.gettrace()
    sys.settrace(trace)
    try:
        work()
    finally:
        sys.settrace(before)
    return count


def growth(prepared: Callable[[int], Callable[[], object]], small: int, large: int) -> float:
    """How much faster than its size the cost of work grows: 1 where it is linear.

    ``prepared`` makes the work of a size; what that costs is not counted, nor a first run, which may
    prepare for all others.
    """
    prepared(small)()
    cost = {size: steps(prepared(size)) for size in (small, large)}
    return cost[large] / cost[small] / (large / small)
