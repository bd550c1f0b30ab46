"""Planning groups, their chains and end effectors."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import ERROR, WARNING
from multibot_rewrite.description.checks.planning_groups import chain, groups_of, links_of, text_of
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.description.srdf.shared import ARM, srdf_rule
from multibot_rewrite.rules.schema.srdf import ELEMENTS
from multibot_rewrite.rules.subject import Subject


@srdf_rule(
    "MB810",
    "broken-chain",
    ERROR,
    what="The base and tip of a chain are not connected, or are the same link.",
    why="srdfdom ignores the chain ('do not form a chain'), or it has no joint: MoveIt cannot plan "
    "for the group.",
    fix="Use two links of one tree.",
    bad='<group name="arm"><chain base_link="b" tip_link="b"/></group>',
    good='<group name="arm"><chain base_link="a" tip_link="b"/></group>',
)
def broken_chain(subject: Subject) -> Iterator[Problem]:
    """Chains whose links exist."""
    robot = subject.beside
    for it in subject.document.root.iterfind("group/chain") if robot else ():
        base, tip = text_of(it, "base_link"), text_of(it, "tip_link")
        assert robot is not None
        if base not in robot.link or tip not in robot.link:
            continue
        if not chain(robot, base, tip):
            fault = "are one link" if base == tip else "are not connected"
            yield Problem(it, f"{base!r} and {tip!r} {fault}", None, "use two links of one tree")


@srdf_rule(
    "MB811",
    "empty-group",
    WARNING,
    what="A group has no joint.",
    why="MoveIt does not add it ('must have at least one valid joint'): there is no planning for "
    "it, and its states and end effectors are lost.",
    fix="Add a joint, link, chain or group, or delete it.",
    bad='<group name="arm"/>',
    good=ARM,
)
def empty_group(subject: Subject) -> Iterator[Problem]:
    """Groups with nothing in them."""
    for it in subject.document.root.iterchildren("group"):
        if not any(child.tag in ELEMENTS["group"][2] for child in it.iterchildren("*")):
            yield Problem(it, f"group {text_of(it)!r} is empty", "name", "add a joint")


@srdf_rule(
    "MB816",
    "end-effector-parent",
    WARNING,
    what="The parent group of an end effector is its own group, or does not have its parent link.",
    why="MoveIt warns and uses another group that has the link, or none: grasps are planned for "
    "the wrong arm.",
    fix="Use the group that has the parent link.",
    bad=ARM
    + '<group name="hand"><link name="c"/></group>\n'
    + '<end_effector name="e" group="hand" parent_link="a" parent_group="arm"/>\n',
    good=ARM
    + '<group name="hand"><link name="c"/></group>\n'
    + '<end_effector name="e" group="hand" parent_link="b" parent_group="arm"/>\n',
    line=3,
)
def end_effector_parent(subject: Subject) -> Iterator[Problem]:
    """End effectors that name their parent group."""
    robot, groups = subject.beside, groups_of(subject.document.root)
    for it in subject.document.root.iterchildren("end_effector"):
        parent, link = text_of(it, "parent_group"), text_of(it, "parent_link")
        if parent and parent == text_of(it, "group"):
            message = f"group {parent!r} is its own parent"
            yield Problem(it, message, "parent_group", "use the group that carries it")
        elif (
            robot
            and parent in groups
            and link in robot.link
            and link not in links_of(parent, groups, robot)
        ):
            message = f"group {parent!r} does not have the parent link {link!r}"
            yield Problem(it, message, "parent_group", "use the group that has it")
