"""Wheels that find no grip in a simulator."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.description.physics.shared import a_rover
from multibot_rewrite.rules.facts.driven import driven_joints
from multibot_rewrite.rules.facts.sensors import number_at
from multibot_rewrite.rules.subject import Subject

_FRICTION = ("mu1", "mu", "mu2")


@rule(
    "MB636",
    "wheel-without-grip",
    WARNING,
    what="A driven wheel has a friction of 0 or less: mu1 and mu2 in its <gazebo> block.",
    why="The wheel turns and the robot stands still, or slides. Casters have no friction, wheels do.",
    fix="Write 1.0 or so for both.",
    bad=a_rover() + '<gazebo reference="left"><mu1>0</mu1></gazebo>\n',
    good=a_rover() + '<gazebo reference="left"><mu1>1</mu1></gazebo>\n',
    line=32,
)
def wheel_without_grip(subject: Subject) -> Iterator[Problem]:
    """Blocks of links on a continuous joint that something drives."""
    blocks = [it for it in subject.elements.tops("gazebo") if it.get("reference")]
    driven = driven_joints(subject) if blocks else ()
    wheels = {
        it.child for it in subject.robot.joints if it.type == "continuous" and it.name in driven
    }
    for block in blocks:
        name = block.get("reference", "")
        for tag in _FRICTION if name in wheels else ():
            value, element = number_at(block, tag), block.find(tag)
            if value is not None and value <= 0 and element is not None:
                message = f"{tag} of driven wheel {name!r} is {value:g}: it has no grip"
                yield Problem(element, message, "", "write 1.0 or so")
                break
