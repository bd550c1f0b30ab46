# SPDX-License-Identifier: Apache-2.0
"""Dangers of ``header.stamp``: what a robot measures is stamped with another time than now."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from math import isinf

from multibot_rewrite.base.conventions import CLOCK
from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.wording import only, shorten
from multibot_rewrite.rules.declaration import system_rule
from multibot_rewrite.system import words
from multibot_rewrite.system.index import Index, robots_of, sent_on
from multibot_rewrite.system.tool_nodes import last_word

# A costmap waits a part of a second for a transform, tf2 keeps ten seconds (buffer_core.h).
_OLD, _AHEAD = 3.0, 1.0
# Simulated time begins at 0: no clock of a machine is so far off.
_YEAR = 3.0e7
_MEASURED = ("sensor_msgs/", "nav_msgs/msg/Odometry")


@system_rule("MG417", "stamp-of-another-time", ERROR)
def stamp_of_another_time(seen: Index) -> Iterator[Finding]:
    """All topics of a sender that are wrong in one way are one; what a bag plays is of then."""
    clock = CLOCK in seen.published
    found: dict[tuple[tuple[str, ...], str], list[str]] = defaultdict(list)
    for topic, _, age, *_ in seen.system.heard:
        type_, senders = sent_on(seen, topic)
        played = any(last_word(it).startswith(words.PLAYER) for it in senders)
        measured = type_.startswith(_MEASURED)
        if senders and measured and not played and (what := _wrong(age, clock)):
            found[senders, what].append(topic)
    for (senders, what), topics in found.items():
        yield stamp_of_another_time.finding(
            f"the stamps on {shorten(topics)} are {what}",
            f"see the clock of {shorten(senders)}: use_sim_time, or that of its machine",
            level=WARNING if what == _ZERO else ERROR,
            robot=only(robots_of(seen, senders)), node=senders[0], names=tuple(topics),
        )  # fmt: skip


_ZERO = "0: its sender leaves them out"


def _wrong(age: float, clock: bool) -> str:
    """What is wrong with a message of this age; with a simulated clock the machine's time is."""
    if isinf(age):
        return _ZERO
    other = abs(age) > _YEAR
    if clock:
        # 0 is not known.
        return "of the machine's time, not of /clock" if age and not other else ""
    if other:
        return "of another clock: simulated time, which nothing here has?"
    if age >= _OLD:
        return f"{age:.0f} s old"
    return f"{-age:.0f} s in the future" if age <= -_AHEAD else ""
