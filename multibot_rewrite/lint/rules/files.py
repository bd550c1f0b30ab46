"""MB1: what a file is and how it is encoded."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.lint.records import Problem, Subject, rule
from multibot_rewrite.model import ERROR


@rule(
    "MB101",
    "not-xml",
    ERROR,
    what="The file is not a robot description that can be read: broken XML, another encoding, "
    "DOCTYPE, empty, or another root element.",
    why="Nothing loads it: robot_state_publisher and every spawner stop with an error.",
    fix="Mend the XML where the finding points; save the file as UTF-8.",
    bad='<robot name="r"><link name="a"></robot>',
    good='<robot name="r"><link name="a"/></robot>',
)
def not_xml(subject: Subject) -> Iterator[Problem]:
    """Found when the file is read: see ``failures``."""
    return iter(())
