"""The joints that something in a description drives."""

from __future__ import annotations

from multibot_rewrite.base.model import Claim
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.subject import Subject


@memoized
def driven_joints(subject: Subject) -> frozenset[str]:
    """The joints that ``<ros2_control>``, transmissions and plugins name."""
    claims = subject.inventory.claims
    return frozenset(
        it.value for it in claims if it.site.whole_value_kind == "joint" and _drives_a_joint(it)
    )


def _drives_a_joint(claim: Claim) -> bool:
    return claim.site.role == "uses" and claim.site.section != "element joint"
