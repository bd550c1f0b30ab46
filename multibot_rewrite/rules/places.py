# SPDX-License-Identifier: Apache-2.0
"""Where a file says what a finding is about: the place of a record, and of what is beside it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Protocol

from multibot_rewrite.system.records import NOWHERE, Place


class Placed(Protocol):
    """A record with the place where a file has it."""

    @property
    def place(self) -> Place: ...


def where(records: Iterable[Placed]) -> dict[str, Any]:
    """The fields of a finding at the last record that a file has; nothing where none has any."""
    places = [it.place for it in records if it.place != NOWHERE]
    return {**places[-1]._asdict(), "column": places[-1].column or 1} if places else {}


def see(records: Iterable[Placed]) -> str:
    """``; see FILE:LINE and FILE:LINE``: the places of all but the last one."""
    places = dict.fromkeys(str(it.place) for it in records if it.place != NOWHERE)
    others = [*places][:-1]
    return f"; see {' and '.join(others)}" if others else ""
