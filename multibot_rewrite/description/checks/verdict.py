# SPDX-License-Identifier: Apache-2.0
"""What a rewrite may be called: verified, or rewritten and not verified, and why."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from multibot_rewrite.base.bounded import own_rows
from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.wording import plural
from multibot_rewrite.description.checks.meeting import ELSEWHERE
from multibot_rewrite.description.readback import meeting

# Code -> what is counted and what is said of it. A rewrite with one of these findings is not verified.
REASONS = {code: (what, why) for code, what, why in own_rows(__file__, "reasons.schema")}

# What is verified of a description and hangs on what starts it: a code, and how the summary says it.
GIVEN = {
    meeting.NOT_TAKEN: "where each controller is spawned with its rules",
    ELSEWHERE: "where what shows an image has the rule for its camera_info",
    meeting.NUMBERED: "where what each robot talks to has its number",
}


def given(findings: Iterable[Finding], of_world: Iterable[str] = ()) -> str:
    """Return the conditions of ``verified``: of controllers, and of systems that were left to the
    world; empty without any."""
    codes = {it.code for it in findings}
    said = [words for code, words in GIVEN.items() if code in codes]
    systems = ", ".join(sorted(set(of_world)))
    return " and ".join([*said, *([f"where the world loads {systems}"] if systems else [])])


def not_verified(findings: Iterable[Finding]) -> tuple[str, ...]:
    """Return why a rewrite with these findings is not verified, with counts; empty where it is."""
    counts = Counter(it.code for it in findings)
    found = ((counts[code], *words) for code, words in REASONS.items() if counts[code])
    return tuple(f"{plural(count, what)} {why}" for count, what, why in found)
