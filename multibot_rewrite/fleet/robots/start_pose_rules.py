# SPDX-License-Identifier: Apache-2.0
"""The rules about start poses that are not published."""

from __future__ import annotations

from multibot_rewrite.base.findings.finding import ERROR, WARNING
from multibot_rewrite.base.findings.rule import declare

LOCALISED_ALREADY = declare("MF701", "pose-of-localised-robot", WARNING, formats=("fleet",))
NO_SINGLE_ROOT = declare("MF702", "pose-without-root-frame", WARNING, formats=("fleet",))
POSE_ON_WORLD = declare("MF709", "pose-of-robot-on-world", ERROR, formats=("fleet",))
NO_SHARED_FRAME = declare("MF704", "pose-without-shared-frame", WARNING, formats=("fleet",))

OWN_ODOMETRY = declare("MF710", "pose-beside-own-odometry", WARNING, formats=("fleet",))
