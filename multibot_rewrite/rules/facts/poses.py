"""Where the links of a URDF are, with every joint at 0: computed once for all rules."""

from __future__ import annotations

from collections.abc import Mapping

from multibot_rewrite.description.checks import poses
from multibot_rewrite.description.checks.poses import Pose
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.subject import Subject


@memoized
def link_poses(subject: Subject) -> Mapping[str, Pose]:
    """Each link's pose in the root of its tree; those below an origin that is no number are left
    out."""
    return poses.link_poses(subject.robot)
