# SPDX-License-Identifier: Apache-2.0
"""Lint without workers where something else is tried: each would start a server of xacro of its own."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, NamedTuple

import pytest

from multibot_rewrite.base import workers


class Here(NamedTuple):
    """A pool whose work is done by who asks for its results."""

    work: Callable[[Any], Any]
    items: Sequence[Any]

    def results(self) -> Iterator[Any]:
        return map(self.work, self.items)


@contextmanager
def _pool(work: Callable[[Any], Any], items: Sequence[Any], *_: object) -> Iterator[Here]:
    yield Here(work, items)


def lint_in_this_process(patch: pytest.MonkeyPatch) -> None:
    """From now on, with no bound of time for a file as a whole."""
    patch.setattr(workers, "worker_pool", _pool)
    patch.setattr(workers, "limit_time", lambda _: None)
