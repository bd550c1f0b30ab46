"""MB5: the kinematic tree and its joints."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.lint.records import Problem, Subject, rule
from multibot_rewrite.model import ERROR


@rule(
    "MB501",
    "several-roots",
    ERROR,
    what="More than one link has no parent: the robot is in several pieces.",
    why="urdfdom refuses the file ('Two root links found'): no robot_state_publisher, no tf.",
    fix="Add the joint that holds the pieces together.",
    bad='<link name="a"/><link name="b"/>',
    good='<link name="a"/><link name="b"/><joint name="j" type="fixed"><parent link="a"/>'
    '<child link="b"/></joint>',
)
def several_roots(subject: Subject) -> Iterator[Problem]:
    """Every root but the first."""
    roots = [it for it in subject.robot.links if it.name not in subject.robot.above]
    for link in roots[1:]:
        yield Problem(link.element, f"link {link.name!r} is a second root beside {roots[0].name!r}")
