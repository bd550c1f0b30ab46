# SPDX-License-Identifier: Apache-2.0
"""What a rewrite may be called: proved, or rewritten and not proved, and why."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping

from multibot_rewrite.base.bounded import own_rows
from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.wording import plural
from multibot_rewrite.description.checks.meeting import ELSEWHERE
from multibot_rewrite.description.readback import meeting

_ROWS = own_rows(__file__, "reasons.schema")
# Code -> what is counted and what is said of it, of a description and of another file. A rewrite with
# one of these findings is not proved.
REASONS, OF_FILES = (
    {code: (what, why) for whose, code, what, why in _ROWS if whose == one}
    for one in ("description", "file")
)

# What is proved of a description and hangs on what starts it: a code, and how the summary says it.
GIVEN = {
    meeting.NOT_TAKEN: "where each controller is spawned with its rules",
    ELSEWHERE: "where what shows an image has the rule for its camera_info",
    meeting.NUMBERED: "where what each robot talks to has its number",
}


def given(findings: Iterable[Finding], of_world: Iterable[str] = ()) -> str:
    """What the word ``proved`` takes for granted: of controllers, and of the systems that were left to
    the world; empty where that is nothing."""
    codes = {it.code for it in findings}
    said = [words for code, words in GIVEN.items() if code in codes]
    systems = ", ".join(sorted(set(of_world)))
    return " and ".join([*said, *([f"where the world loads {systems}"] if systems else [])])


def not_proved(
    findings: Iterable[Finding], reasons: Mapping[str, tuple[str, str]] = REASONS
) -> tuple[str, ...]:
    """Why a rewrite with these findings is not proved, with counts; empty where it is."""
    counts = Counter(it.code for it in findings)
    found = ((counts[code], *words) for code, words in reasons.items() if counts[code])
    return tuple(f"{plural(count, what)} {why}" for count, what, why in found)
