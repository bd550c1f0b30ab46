# SPDX-License-Identifier: Apache-2.0
"""Topics that have a robot's name from an argument of its xacro, and once more from its namespace."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.description.sources.own_names import name_robot
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot, at_robot
from multibot_rewrite.rules.system.transforms import robots_name_twice

_KINDS = ("topic", "service")


def named_twice(robots: Sequence[RewrittenRobot]) -> Iterator[Finding]:
    """Once for each description, with the first of its names."""
    told = set()
    for it in robots:
        name = next(_twice(it), "")
        if name and it.spec.description not in told:
            told.add(it.spec.description)
            given = it.spec.arguments
            which = [key for key, text in given.items() if name_robot({key: text}, [it.spec.name])]
            message = f"{name} has the name of robot {it.spec.name!r} twice"
            hint = f"write {' or '.join(which)}: '' under arguments"
            yield at_robot(robots_name_twice, it, message, hint)


def _twice(robot: RewrittenRobot) -> Iterator[str]:
    spec = robot.spec
    if not name_robot(spec.arguments, [spec.name]):
        return
    starts = tuple(f"/{spec.namespace}/{spec.name}{it}" for it in "/_")
    for it in robot.member.reading.names:
        if it.kind in _KINDS and it.name.startswith(starts):
            yield it.name
