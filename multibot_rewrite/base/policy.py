# SPDX-License-Identifier: Apache-2.0
"""A naming policy as the words that ask for it; ``naming`` makes it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TypedDict


class Policy(TypedDict, total=False):
    """The options of ``make_naming`` as one value, for what is passed on to it."""

    layout: str
    affix: str
    topics: str | None
    separators: Mapping[str, str] | None
    shared_frames: Iterable[str]
    shared_topics: Iterable[str]
    groups: str
