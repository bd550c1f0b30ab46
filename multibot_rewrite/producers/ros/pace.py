# SPDX-License-Identifier: Apache-2.0
"""How often something comes by its stamps, whether they go back, and how many publishers
send it. Pure.

By stamps, since a busy machine receives late; by their median, since it loses some.

tf messages do not say who sent them. A publisher numbers its messages, each higher than the last: where
the numbers of one transform go back again and again, several publishers count side by side.
"""

from __future__ import annotations

from typing import NamedTuple

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


# A publisher that was started anew goes back once; of what is latched each publisher has one message.
BACK_MOVING, BACK_LATCHED = 2, 1
# The number of a message, or its sender's own mark where the middleware tells that.
Mark = int | bytes | None


class Voices(NamedTuple):
    """What was heard of one transform: the last mark, and how often it went back or was another."""

    last: Mark = None
    back: int = 0

    def after(self, mark: Mark) -> Voices:
        """With one message more."""
        if mark is None:
            return self
        return Voices(mark, self.back + _goes_back(self.last, mark))

    def several(self, latched: bool) -> bool:
        """Whether several publishers send it."""
        return self.back >= (BACK_LATCHED if latched else BACK_MOVING)


def _goes_back(last: Mark, mark: Mark) -> bool:
    if isinstance(last, bytes) and isinstance(mark, bytes):
        return last != mark
    return isinstance(last, int) and isinstance(mark, int) and mark <= last
