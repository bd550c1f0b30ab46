# SPDX-License-Identifier: Apache-2.0
"""What an error may rest on: that nothing elsewhere and no other release makes it right.

What may be right all the same is a warning, or a note.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING
from multibot_rewrite.base.releases import OF_OLD
from multibot_rewrite.description.checks.links_and_joints import roots
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.subject import Subject


@memoized
def level_of_absence(subject: Subject) -> str:
    """How bad it is that a description lacks something: a xacro file may be a part of a robot, or have
    it behind a condition. What is a part for certain has links that all hang on others."""
    robot = subject.robot
    is_part = robot.links and not roots(robot) and any(it not in robot.link for it in robot.below)
    levels = (WARNING, NOTE) if subject.origins else (ERROR, WARNING)
    return levels[bool(is_part)]


def lacking(subject: Subject, found: Iterable[Problem]) -> Iterator[Problem]:
    """What a description lacks, no louder than that it does may be told."""
    level = level_of_absence(subject)
    for it in found:
        yield it if level == ERROR or (it.level and level == WARNING) else it._replace(level=level)


def since_jazzy(subject: Subject) -> str:
    """The level of what ros2_control refuses since Jazzy: in Humble it goes on without."""
    return WARNING if subject.settings.distro == OF_OLD else ""
