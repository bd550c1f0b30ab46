# SPDX-License-Identifier: Apache-2.0
"""Is a transform sent by one publisher, or by several? Pure.

tf messages do not say who sent them. A publisher numbers its messages, each higher than the last: where
the numbers of one transform go back again and again, several publishers count side by side.
"""

from __future__ import annotations

from multibot_rewrite.base.record import NamedTuple

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
