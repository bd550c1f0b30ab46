# SPDX-License-Identifier: Apache-2.0
"""Names with gaps in them that anything fills: patterns that take no longer for a longer name."""

from __future__ import annotations

import re
from collections.abc import Sequence


def with_gaps(pieces: Sequence[str], gap: str) -> str:
    """Return a pattern for whole texts that have the pieces in this order, with one or more of the
    characters ``gap`` between each two.

    Each piece is taken where it comes first, and no other place is tried: what lies between it and the
    next one can always be longer.
    """
    first, *others = pieces
    *middle, last = others or [""]
    taken = (rf"(?=(?P<_{at}>{gap}+?{re.escape(it)}))(?P=_{at})" for at, it in enumerate(middle))
    end = f"{gap}+{re.escape(last)}" if others else ""
    return "".join((re.escape(first), *taken, end))
