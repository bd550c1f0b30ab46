"""Files that cannot be read, or are no robot description as they are."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Iterator
from itertools import accumulate, islice

from multibot_rewrite.checks.audit import leftover_xacro, worlds
from multibot_rewrite.checks.robots import already_rewritten
from multibot_rewrite.findings.finding import ERROR, WARNING
from multibot_rewrite.findings.rule import declare, rule
from multibot_rewrite.lint.records import Problem, Subject
from multibot_rewrite.model import Finding
from multibot_rewrite.steps.renames import make_renames

# These three are reported where a file is read or expanded: see ``failures``.
not_xml = declare(
    "MB101",
    "not-xml",
    ERROR,
    what="The file is not a robot description that can be read: broken XML, another encoding, "
    "DOCTYPE, empty, or another root element.",
    why="xacro, launch files and every other reader with a whole XML parser stop with an error. "
    "urdfdom's takes some of it, so half of the system may run without the other half.",
    fix="Mend the XML where the finding points; save the file as UTF-8.",
    bad='<robot name="r"><link name="a"></robot>',
    good='<robot name="r"><link name="a"/></robot>',
)

unreadable = declare(
    "MB102",
    "unreadable",
    ERROR,
    what="The file, or one that it includes, is not there or may not be read.",
    why="xacro and robot_state_publisher stop with an error, and the launch with them.",
    fix="Mend the path; where it has $(find PACKAGE), source the workspace with that package.",
    bad='<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
    '<xacro:include filename="nowhere.xacro"/><link name="a"/></robot>',
    good='<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="a"/></robot>',
)

xacro_failed = declare(
    "MB103",
    "xacro-failed",
    ERROR,
    what="xacro cannot expand the file: an argument, property, macro or package is missing, or an "
    "expression is wrong.",
    why="There is no URDF: the Command substitution of the launch file fails and nothing starts.",
    fix="Give every <xacro:arg> a default, or the lint the arguments to expand with; for the rest "
    "see the finding.",
    bad='<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
    '<link name="$(arg side)_arm"/></robot>',
    good='<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
    '<xacro:arg name="side" default="left"/><link name="$(arg side)_arm"/></robot>',
)


@rule(
    "MB105",
    "leftover-xacro",
    WARNING,
    what="A file that is not named .xacro holds xacro elements or ${...} and $(arg ...).",
    why="Who loads it as the URDF that its name promises gets no macros, and urdfdom refuses the "
    "joint, and with it the robot, where ${...} stands for a number.",
    fix="Name the file .urdf.xacro and load it through xacro, or write the expanded text.",
    bad='<link name="a"/><link name="${prefix}b"/>',
    good='<link name="a"/><link name="b"/>',
)
def leftover(subject: Subject) -> Iterator[Problem]:
    """One finding a file, at the first of them."""
    found = list(leftover_xacro(subject.inventory))
    return _placed(subject, found) if found else iter(())


@rule(
    "MB106",
    "already-rewritten",
    WARNING,
    what="The description is spelled for one of the robots already: every name that a rewrite "
    "spells has that robot's affix, or there is text that a rewrite inserted.",
    why="urdf-postfix refuses it: a second rewrite would make base_link/robot1/robot1. Given to "
    "several robots, all of them have the frames and topics of the one.",
    fix="Lint and rewrite the source; take the affix back with urdf-postfix --strip, or let "
    "exclude leave out what is generated.",
    bad='<robot name="r_robot1"><link name="base/robot1"/></robot>',
    good='<robot name="r"><link name="base"/></robot>',
    options={"robots": ("robot1", "robot2")},
)
def already(subject: Subject) -> Iterator[Problem]:
    """One finding a file, for the first robot whose name is in it."""
    settings = subject.settings
    renames = make_renames(subject.inventory, settings.naming)
    found = already_rewritten(subject.inventory, renames, settings.robots, False)
    for it in islice(found, 1):
        yield Problem(subject.document.root, it.message, None, "lint the source it was made from")


@rule(
    "MB109",
    "sdf-world",
    ERROR,
    what="The file is an SDF world, which holds several models.",
    why="Which of the models is the robot, nobody can tell: its names cannot be checked or spelled "
    "for one robot.",
    fix="Keep the robot in a model.sdf of its own and include it in the world.",
    bad='<?xml version="1.0"?><sdf version="1.9"><world name="w"/></sdf>',
    good='<?xml version="1.0"?><sdf version="1.9"><model name="r"><link name="a"/></model></sdf>',
)
def sdf_world(subject: Subject) -> Iterator[Problem]:
    """Every world of the file."""
    return (
        _placed(subject, worlds(subject.inventory))
        if subject.document.root.tag == "sdf"
        else iter(())
    )


def _placed(subject: Subject, findings: Iterable[Finding]) -> Iterator[Problem]:
    """Findings that know a line and a column -> problems at the elements there."""
    source = subject.document.source
    elements = subject.document.elements
    lines = [0, *accumulate(len(line) for line in source.splitlines(keepends=True))]
    for it in findings:
        line = source[lines[it.line - 1] :].decode("utf-8", "replace")
        start = lines[it.line - 1] + len(line[: it.column - 1].encode())
        element = elements[bisect_left(subject.document.starts, start)]
        yield Problem(element, it.message, None, it.hint)
