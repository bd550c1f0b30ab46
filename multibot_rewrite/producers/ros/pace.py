# SPDX-License-Identifier: Apache-2.0
"""How often something comes by its stamps, and whether they go back. Pure.

By stamps, since a busy machine receives late; by their median, since it loses some.
"""

from __future__ import annotations

from multibot_rewrite.base.record import NamedTuple

# So many times between two messages say how often they come, and more do not say more.
ENOUGH, MOST = 3, 50


class Pace(NamedTuple):
    """The last stamp in seconds, the times between the stamps so far, and how far one went back."""

    last: float = -1.0
    between: tuple[float, ...] = ()
    back: float = 0.0

    def after(self, stamp: float) -> Pace:
        """With one message more."""
        if self.last < 0 or stamp == self.last:
            return self._replace(last=stamp)
        if stamp < self.last:
            return self._replace(last=stamp, back=max(self.back, self.last - stamp))
        between = (*self.between, stamp - self.last) if len(self.between) < MOST else self.between
        return self._replace(last=stamp, between=between)

    def rate(self) -> float:
        """Messages a second; 0 if not known."""
        from statistics import median  # slow to import, and few messages are counted

        return round(1 / median(self.between), 1) if len(self.between) >= ENOUGH else 0.0
