# SPDX-License-Identifier: Apache-2.0
"""What an error may rest on: that nothing elsewhere, no argument and no other simulator makes it right.

What may be right all the same is a warning.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from multibot_rewrite.base.findings.finding import WARNING
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.releases import OF_OLD
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.subject import EXPANDED, Subject

# How a xacro file is called that is a whole robot: others may be parts of one.
WHOLE = (".urdf.xacro", ".urdf")
_CONDITIONAL = lazy_compile(rb"<xacro:(?:if|unless)\s")


@memoized
def is_whole(subject: Subject) -> bool:
    """Is what a description lacks in no other file, and behind no condition of xacro?"""
    if not subject.origins:
        return True
    if not subject.document.file.removesuffix(EXPANDED).endswith(WHOLE):
        return False
    return not any(_CONDITIONAL.search(it) for it in subject.sources.values())


def since_jazzy(subject: Subject) -> str:
    """The level of what ros2_control refuses since Jazzy: in Humble it goes on without."""
    return WARNING if subject.settings.distro == OF_OLD else ""


def as_sure_as_whole(subject: Subject, found: Iterable[Problem]) -> Iterator[Problem]:
    """What a description lacks: no error where that may be elsewhere."""
    for it in found:
        yield it if it.level or is_whole(subject) else it._replace(level=WARNING)
