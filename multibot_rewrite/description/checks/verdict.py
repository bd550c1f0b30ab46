# SPDX-License-Identifier: Apache-2.0
"""What a rewrite may be called: verified, or rewritten and not verified, and why."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.wording import plural
from multibot_rewrite.description.checks.meeting import ELSEWHERE, NO_LINK, PARTED, SAME_TEXT
from multibot_rewrite.description.readback import meeting

SHARED = "shared by all robots"
# Code -> what is counted and what is said of it. A rewrite with one of these findings is not verified.
REASONS = {
    "MB901": ("name", "not understood"),
    "MB219": ("model", "not known"),
    "MB902": ("plugin", "not known"),
    "MB903": ("hardware class", "not known"),
    "MB906": ("included model", "not read"),
    meeting.DATA: ("topic", SHARED),
    meeting.COMMAND: ("command", SHARED),
    meeting.TWO_SERVERS: ("service", SHARED),
    meeting.TWO_NODES: ("node", SHARED),
    meeting.FRAMES: ("frame", SHARED),
    meeting.OPENED: ("resource", SHARED),
    SAME_TEXT: ("description", "the same for all robots"),
    PARTED: ("topic", "whose ends no longer match"),
    NO_LINK: ("robot", "without a link"),
    meeting.LOOKUP: ("name", "looked up in the whole world"),
    "MB410": ("description name", SHARED),
    "MB416": ("world system", "in every robot"),
    "MB436": ("remap rule", "matching no name any more"),
    "MB426": ("remap rule", "of the whole process"),
    "MB143": ("frame", "that an argument of the xacro misses"),
    "MB422": ("prefix parameter", "that no postfix reaches"),
    "MB430": ("topic", "below each robot's namespace that all should share"),
    "MB428": ("name", "fixed in a plugin's code"),
    "MB429": ("model namespace", "that not every Gazebo reads"),
}

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
    """Why a rewrite with these findings is not verified, with counts; empty where it is."""
    counts = Counter(it.code for it in findings)
    found = ((counts[code], *words) for code, words in REASONS.items() if counts[code])
    return tuple(f"{plural(count, what)} {why}" for count, what, why in found)
