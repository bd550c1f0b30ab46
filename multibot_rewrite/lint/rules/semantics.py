"""MB8: an SRDF against its URDF."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from math import isfinite

from lxml.etree import _Element

from multibot_rewrite.checks.references import nearest, repeated
from multibot_rewrite.lint.facts.robot import Joint, Robot
from multibot_rewrite.lint.groups import chain, groups_of, joints_of, links_of, text_of
from multibot_rewrite.lint.records import NOTE, SRDF, Problem, Subject, rule
from multibot_rewrite.lint.rules.references import undeclared
from multibot_rewrite.model import ERROR, WARNING

# What srdfdom (model.cpp) reads: an element, the attributes without which it is left out, the others
# and its children.
_PAIR = (("link1", "link2"), ("reason",), ())
ELEMENTS: Mapping[str, tuple[tuple[str, ...], tuple[str, ...], tuple[str, ...]]] = {
    "group": (("name",), (), ("link", "joint", "passive_joint", "chain", "group")),
    "group/link": (("name",), (), ()),
    "group/joint": (("name",), (), ()),
    "group/passive_joint": (("name",), (), ()),
    "group/chain": (("base_link", "tip_link"), (), ()),
    "group/group": (("name",), (), ()),
    "group_state": (("name", "group"), (), ("joint",)),
    "group_state/joint": (("name", "value"), (), ()),
    "end_effector": (("name", "group", "parent_link"), ("parent_group",), ()),
    "virtual_joint": (("name", "child_link", "parent_frame", "type"), (), ()),
    "passive_joint": (("name",), (), ()),
    "disable_collisions": _PAIR,
    "enable_collisions": _PAIR,
    "disable_default_collisions": (("link",), (), ()),
    "link_sphere_approximation": (("link",), (), ("sphere",)),
    "link_sphere_approximation/sphere": (("center", "radius"), (), ()),
    "joint_property": (("joint_name", "property_name", "value"), (), ()),
}
TOP = tuple(it for it in ELEMENTS if "/" not in it)
VIRTUAL_TYPES = ("fixed", "planar", "floating")
PROPERTIES = ("angular_distance_weight", "motion_model", "min_translational_distance")
# How many numbers a joint's state has; other types have one.
SIZES = {"fixed": 0, "planar": 3, "floating": 7}
LIMITED = ("revolute", "prismatic")
# State values are written with a few digits.
ROUNDING = 1e-4
SHOWN = 5
# The robot of the examples.
URDF = """<robot name="r"><link name="a"><collision/></link><link name="b"><collision/></link>
<link name="c"/><joint name="j" type="revolute"><parent link="a"/><child link="b"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="k" type="fixed"><parent link="b"/><child link="c"/></joint></robot>"""
BESIDE = {"r.urdf": URDF}
# Beside it: srdfdom needs no more than this.
ARM = '<group name="arm"><joint name="j"/></group>'
STATE = ARM + '<group_state name="home" group="arm">{}</group_state>'
VIRTUAL = '<virtual_joint name="v" type="{}" parent_frame="world" child_link="{}"/>'
APART = '<disable_collisions link1="a" link2="b" reason="Adjacent"/>'


@rule(
    "MB801",
    "srdf-without-urdf",
    NOTE,
    what="No URDF was found that has the SRDF's robot name and most of its links and joints, so "
    "they could not be checked.",
    why="An SRDF says nothing by itself; MoveIt leaves out all that its URDF does not have.",
    fix="Lint the URDF with it (the robot's name tells which), or give it with --urdf.",
    formats=(SRDF,),
    beside=BESIDE,
    bad=f'<robot name="other">{ARM}</robot>',
    good=ARM,
)
def srdf_without_urdf(subject: Subject) -> Iterator[Problem]:
    """One finding a file."""
    root = subject.document.root
    if subject.beside is None:
        message = f"no URDF of a robot {root.get('name', '')!r} with its links was found"
        yield Problem(root, message, "name", "give it with --urdf")


@rule(
    "MB802",
    "other-robot",
    WARNING,
    what="The SRDF is for a robot of another name than that of its URDF.",
    why="srdfdom logs 'Semantic description is not specified for the same robot as the URDF': the "
    "file may be that of another robot.",
    fix="Give both one name.",
    formats=(SRDF,),
    beside=BESIDE,
    options={"urdf": "r.urdf"},
    bad=f'<robot name="other">{ARM}</robot>',
    good=ARM,
)
def other_robot(subject: Subject) -> Iterator[Problem]:
    """The name on the root."""
    return undeclared(subject, "MB802")


@rule(
    "MB803",
    "srdf-link",
    ERROR,
    what="A group, chain, end effector or virtual joint names a link that the URDF does not have.",
    why="srdfdom leaves the link, chain, end effector or virtual joint out ('is not known to the "
    "URDF'): the group is too small, or is not there.",
    fix="Correct the name.",
    formats=(SRDF,),
    beside=BESIDE,
    bad='<group name="arm"><joint name="j"/><link name="bb"/></group>',
    good='<group name="arm"><joint name="j"/><link name="b"/></group>',
)
def srdf_link(subject: Subject) -> Iterator[Problem]:
    """Names of links, those in collision pairs aside."""
    return undeclared(subject, "MB803")


@rule(
    "MB804",
    "srdf-joint",
    ERROR,
    what="A group, state or passive joint names a joint that the URDF does not have.",
    why="srdfdom leaves the joint out ('is not known to the URDF'): the group does not move it, the "
    "state has no value for it.",
    fix="Correct the name.",
    formats=(SRDF,),
    beside=BESIDE,
    bad=ARM + '<passive_joint name="jj"/>',
    good=ARM + '<passive_joint name="j"/>',
)
def srdf_joint(subject: Subject) -> Iterator[Problem]:
    """Names of joints, those of virtual joints included."""
    return undeclared(subject, "MB804")


@rule(
    "MB805",
    "srdf-group",
    ERROR,
    what="A state, end effector or group names a group that the SRDF does not have.",
    why="srdfdom leaves out the state or end effector, and a group with such a subgroup as a whole "
    "('has unsatisfied subgroups').",
    fix="Correct the name.",
    formats=(SRDF,),
    beside=BESIDE,
    bad=ARM + '<group name="all"><group name="amr"/></group>',
    good=ARM + '<group name="all"><group name="arm"/></group>',
)
def srdf_group(subject: Subject) -> Iterator[Problem]:
    """Names of groups."""
    return undeclared(subject, "MB805")


@rule(
    "MB806",
    "srdf-duplicate",
    ERROR,
    what="Two groups, two end effectors or two virtual joints have one name.",
    why="MoveIt does not add the second ('A group named ... already exists'): what is in it is "
    "lost.",
    fix="Rename one, or put both into one.",
    formats=(SRDF,),
    beside=BESIDE,
    bad=ARM * 2,
    good=ARM,
)
def srdf_duplicate(subject: Subject) -> Iterator[Problem]:
    """Every declaration but the first."""
    for claim, _ in repeated(subject.inventory):
        message = f"there is another {claim.element.tag} {claim.value.strip()!r}"
        yield Problem(claim.element, message, claim.attribute, "rename one")


@rule(
    "MB807",
    "stale-pair",
    WARNING,
    what="A collision pair names a link that the URDF does not have.",
    why="srdfdom ignores the line; where the link was renamed, the pair is now checked, and a robot "
    "that touches itself there cannot plan.",
    fix="Delete the line, or correct the name.",
    formats=(SRDF,),
    beside=BESIDE,
    bad=ARM + '<disable_collisions link1="a" link2="bb" reason="Adjacent"/>',
    good=ARM + APART,
)
def stale_pair(subject: Subject) -> Iterator[Problem]:
    """One finding a name, at its first pair."""
    found = list(undeclared(subject, "MB807"))
    names = Counter(_link(it) for it in found)
    for it in found:
        more = names.pop(_link(it), 0) - 1
        if more >= 0:
            told = f"; {more} more pairs name it" if more else ""
            yield it._replace(message=it.message + told)


def _link(problem: Problem) -> str:
    return text_of(problem.element, problem.attribute or "")


@rule(
    "MB808",
    "duplicate-state",
    WARNING,
    what="Two states of one group have one name.",
    why="MoveIt keeps the values of the last one only.",
    fix="Rename one.",
    formats=(SRDF,),
    beside=BESIDE,
    bad=STATE.format("") + '<group_state name="home" group="arm"/>',
    good=STATE.format("") + '<group_state name="up" group="arm"/>',
)
def duplicate_state(subject: Subject) -> Iterator[Problem]:
    """Every state but the first of its name."""
    seen = set()
    for it in subject.document.root.iterchildren("group_state"):
        key = text_of(it), text_of(it, "group")
        if key in seen:
            yield Problem(
                it, f"group {key[1]!r} has another state {key[0]!r}", "name", "rename one"
            )
        seen.add(key)


@rule(
    "MB809",
    "duplicate-pair",
    NOTE,
    what="Pairs of links are disabled twice.",
    why="The second line changes nothing; a copy may have been meant for other links.",
    fix="Delete the second line.",
    formats=(SRDF,),
    beside=BESIDE,
    bad=APART + '<disable_collisions link1="b" link2="a" reason="Never"/>',
    good=APART,
)
def duplicate_pair(subject: Subject) -> Iterator[Problem]:
    """One finding a file; the order of the two does not matter."""
    first: dict[frozenset[str], _Element] = {}
    found = []
    for it in subject.document.root.iterchildren("disable_collisions"):
        pair = frozenset((text_of(it, "link1"), text_of(it, "link2")))
        if first.setdefault(pair, it) is not it:
            found.append(it)
    if found:
        names = [f"{text_of(it, 'link1')}-{text_of(it, 'link2')}" for it in found[:SHOWN]]
        more = ", ..." if len(found) > SHOWN else ""
        message = f"{len(found)} pairs are disabled before: {', '.join(names)}{more}"
        yield Problem(found[0], message, None, "delete the line")


@rule(
    "MB810",
    "broken-chain",
    ERROR,
    what="The base and tip of a chain are not connected, or are one link.",
    why="srdfdom leaves the chain out ('do not form a chain'), or it has no joint: the group cannot "
    "be planned for.",
    fix="Name two links of one tree.",
    formats=(SRDF,),
    beside=BESIDE,
    bad='<group name="arm"><chain base_link="b" tip_link="b"/></group>',
    good='<group name="arm"><chain base_link="a" tip_link="b"/></group>',
)
def broken_chain(subject: Subject) -> Iterator[Problem]:
    """Chains of links that are there."""
    robot = subject.beside
    for it in subject.document.root.iterfind("group/chain") if robot else ():
        base, tip = text_of(it, "base_link"), text_of(it, "tip_link")
        assert robot is not None
        if base not in robot.link or tip not in robot.link:
            continue
        if not chain(robot, base, tip):
            fault = "are one link" if base == tip else "are not connected"
            yield Problem(it, f"{base!r} and {tip!r} {fault}", None, "name two links of one tree")


@rule(
    "MB811",
    "empty-group",
    WARNING,
    what="A group has no joint.",
    why="MoveIt does not add it ('must have at least one valid joint'): planning for it and its "
    "states and end effectors are not there.",
    fix="Give it a joint, link, chain or group, or delete it.",
    formats=(SRDF,),
    beside=BESIDE,
    bad='<group name="arm"/>',
    good=ARM,
)
def empty_group(subject: Subject) -> Iterator[Problem]:
    """Groups with nothing in them."""
    for it in subject.document.root.iterchildren("group"):
        if not any(child.tag in ELEMENTS["group"][2] for child in it.iterchildren("*")):
            yield Problem(it, f"group {text_of(it)!r} is empty", "name", "give it a joint")


@rule(
    "MB812",
    "state-of-another-group",
    WARNING,
    what="A state has a value for a joint that is not in its group.",
    why="MoveIt leaves the value out ('that joint is not part of group').",
    fix="Take the joint out, or put it into the group.",
    formats=(SRDF,),
    beside=BESIDE,
    bad=STATE.format('<joint name="k" value="0"/>'),
    good=STATE.format('<joint name="j" value="0"/>'),
)
def state_of_another_group(subject: Subject) -> Iterator[Problem]:
    """Joints that are there, against those of the group."""
    robot = subject.beside
    if robot is None:
        return
    groups = groups_of(subject.document.root)
    joints: dict[str, frozenset[str]] = {}
    for it, group, joint in _states(subject.document.root):
        if group not in groups or joint not in robot.joint:
            continue
        if group not in joints:
            joints[group] = frozenset(joints_of(group, groups, robot))
        if joint not in joints[group]:
            yield Problem(it, f"joint {joint!r} is not in group {group!r}", "name", "take it out")


@rule(
    "MB813",
    "state-beyond-limits",
    WARNING,
    what="The value of a state is outside of the joint's limits.",
    why="MoveIt refuses the state as a goal, and a plan that starts there is invalid.",
    fix="Correct the value or the limit.",
    formats=(SRDF,),
    beside=BESIDE,
    bad=STATE.format('<joint name="j" value="1.5"/>'),
    good=STATE.format('<joint name="j" value="1"/>'),
)
def state_beyond_limits(subject: Subject) -> Iterator[Problem]:
    """Joints of one value that have limits."""
    robot = subject.beside
    for it, _, name in _states(subject.document.root) if robot else ():
        assert robot is not None
        joint, values = robot.joint.get(name), _numbers(it.get("value", ""))
        limits = _limits(joint) if joint and joint.type in LIMITED else None
        if limits is None or not values or len(values) > 1:
            continue
        lower, upper = limits
        if not lower - ROUNDING <= values[0] <= upper + ROUNDING:
            message = f"{name!r} is {values[0]:g}, its limits are {lower:g} to {upper:g}"
            yield Problem(it, message, "value", "correct the value")


@rule(
    "MB814",
    "state-value",
    ERROR,
    what="The value of a state is no number, or there are more or fewer than the joint has.",
    why="srdfdom takes what is no number for 0, and MoveIt leaves out a joint with the wrong count "
    "('requires ... variable values').",
    fix="Give one number; three for a planar joint (x y theta), seven for a floating one.",
    formats=(SRDF,),
    beside=BESIDE,
    bad=STATE.format('<joint name="j" value="half"/>'),
    good=STATE.format('<joint name="j" value="0.5"/>'),
)
def state_value(subject: Subject) -> Iterator[Problem]:
    """Values of joints in states."""
    root = subject.document.root
    types = {text_of(it): text_of(it, "type").lower() for it in root.iterchildren("virtual_joint")}
    if subject.beside is not None:
        types |= {name: joint.type for name, joint in subject.beside.joint.items()}
    for it, _, name in _states(root):
        text = it.get("value")
        numbers = None if text is None else _numbers(text)
        size = SIZES.get(types.get(name, ""), 1)
        if text is not None and numbers is None:
            yield Problem(it, f"the value of {name!r} is {text!r}, no number", "value", "a number")
        elif numbers is not None and name in types and size and len(numbers) != size:
            message = f"{name!r} has {len(numbers)} values, a {types[name]} joint has {size}"
            yield Problem(it, message, "value", "one number for each degree of freedom")


@rule(
    "MB815",
    "virtual-joint-not-at-root",
    WARNING,
    what="The child of a virtual joint is not the root link of the URDF.",
    why="MoveIt leaves the joint out ('does not match the URDF frame'): the robot stands at the "
    "origin of its model frame, which is the root link and not the frame that was meant.",
    fix="Name the root link.",
    formats=(SRDF,),
    beside=BESIDE,
    bad=ARM + VIRTUAL.format("fixed", "b"),
    good=ARM + VIRTUAL.format("fixed", "a"),
)
def virtual_joint_not_at_root(subject: Subject) -> Iterator[Problem]:
    """A fixed one beside a root link `world` without shape is what Gazebo wants."""
    robot = subject.beside
    root = _root(robot) if robot else ""
    for it in subject.document.root.iterchildren("virtual_joint") if root else ():
        child = text_of(it, "child_link")
        dummy = root == "world" and text_of(it, "type").lower() == "fixed"
        if robot and child in robot.link and child != root and not dummy:
            message = f"{child!r} is not the root link, which is {root!r}"
            yield Problem(it, message, "child_link", f"child_link={root!r}")


@rule(
    "MB816",
    "end-effector-parent",
    WARNING,
    what="The parent group of an end effector is its own group, or does not have its parent link.",
    why="MoveIt says so and takes another group that has the link, or none: grasps are planned for "
    "the wrong arm.",
    fix="Name the group whose link carries the end effector.",
    formats=(SRDF,),
    beside=BESIDE,
    bad=ARM + '<group name="hand"><link name="c"/></group><end_effector name="e" group="hand" '
    'parent_link="a" parent_group="arm"/>',
    good=ARM + '<group name="hand"><link name="c"/></group><end_effector name="e" group="hand" '
    'parent_link="b" parent_group="arm"/>',
)
def end_effector_parent(subject: Subject) -> Iterator[Problem]:
    """End effectors that say their parent group."""
    robot, groups = subject.beside, groups_of(subject.document.root)
    for it in subject.document.root.iterchildren("end_effector"):
        parent, link = text_of(it, "parent_group"), text_of(it, "parent_link")
        if parent and parent == text_of(it, "group"):
            message = f"group {parent!r} is its own parent"
            yield Problem(it, message, "parent_group", "name the group that carries it")
        elif (
            robot
            and parent in groups
            and link in robot.link
            and link not in links_of(parent, groups, robot)
        ):
            message = f"group {parent!r} does not have the parent link {link!r}"
            yield Problem(it, message, "parent_group", "name the group that has it")


@rule(
    "MB817",
    "srdf-incomplete",
    ERROR,
    what="An element lacks an attribute without which it means nothing.",
    why="srdfdom leaves the element out with an error; a joint_property without a joint_name ends "
    "move_group.",
    fix="Give the attribute.",
    formats=(SRDF,),
    beside=BESIDE,
    bad=ARM + '<end_effector name="e" group="arm"/>',
    good=ARM + '<end_effector name="e" group="arm" parent_link="b"/>',
)
def srdf_incomplete(subject: Subject) -> Iterator[Problem]:
    """Every attribute that srdfdom asks for."""
    for it, path in _elements(subject.document.root):
        for attribute in ELEMENTS[path][0]:
            if attribute not in it.attrib:
                yield Problem(it, f"<{it.tag}> has no {attribute}", None, f"give {attribute}")


@rule(
    "MB818",
    "self-pair",
    WARNING,
    what="A collision pair is one link twice.",
    why="A link never collides with itself, so the line does nothing; the pair that was meant is "
    "still checked.",
    fix="Name the other link.",
    formats=(SRDF,),
    beside=BESIDE,
    bad='<disable_collisions link1="a" link2="a" reason="Never"/>',
    good=APART,
)
def self_pair(subject: Subject) -> Iterator[Problem]:
    """Pairs to disable or to enable."""
    for it in subject.document.root.iterchildren("disable_collisions", "enable_collisions"):
        one = text_of(it, "link1")
        if one and one == text_of(it, "link2"):
            yield Problem(it, f"{one!r} is paired with itself", "link2", "name the other link")


@rule(
    "MB819",
    "pair-without-shape",
    NOTE,
    what="Collision pairs name links that have no collision geometry.",
    why="MoveIt has nothing to check there, so the lines do nothing: often the geometry was "
    "forgotten, or the lines were made for another version of the URDF.",
    fix="Give the links a <collision>, or delete the lines.",
    formats=(SRDF,),
    beside=BESIDE,
    bad=ARM + '<disable_collisions link1="a" link2="c" reason="Never"/>',
    good=ARM + APART,
)
def pair_without_shape(subject: Subject) -> Iterator[Problem]:
    """One finding a link, at its first pair."""
    robot = subject.beside
    told = set()
    for it in subject.document.root.iterchildren("disable_collisions") if robot else ():
        for attribute in ("link1", "link2"):
            name = text_of(it, attribute)
            if robot and name in robot.link and name not in told and not _has_shape(robot, name):
                told.add(name)
                message = f"{name!r} has no collision geometry"
                yield Problem(it, message, attribute, "the pair does nothing")


@rule(
    "MB820",
    "adjacent-links",
    NOTE,
    what="Links that a joint connects are checked for collision with each other.",
    why="Their shapes mostly touch, then every state of the robot is in collision and nothing can "
    "be planned.",
    fix="Disable the pair with the reason Adjacent, if it may touch.",
    formats=(SRDF,),
    beside=BESIDE,
    bad=ARM + '<disable_collisions link1="a" link2="c" reason="Never"/>',
    good=ARM + APART,
)
def adjacent_links(subject: Subject) -> Iterator[Problem]:
    """One finding a file, where pairs are disabled at all."""
    root, robot = subject.document.root, subject.beside
    pairs = list(root.iterchildren("disable_collisions"))
    if robot is None or not pairs:
        return
    apart = {frozenset((text_of(it, "link1"), text_of(it, "link2"))) for it in pairs}
    alone = {text_of(it, "link") for it in root.iterchildren("disable_default_collisions")}
    left = [it for it in robot.joints if _touch(it, robot, alone) and _ends(it) not in apart]
    if left:
        names = ", ".join(f"{it.parent}-{it.child}" for it in left[:SHOWN])
        more = ", ..." if len(left) > SHOWN else ""
        message = f"{len(left)} pairs of adjacent links are checked: {names}{more}"
        yield Problem(pairs[0], message, None, 'disable them with reason="Adjacent"')


@rule(
    "MB821",
    "srdf-misspelled",
    WARNING,
    what="An element or attribute is not known, and one that is has almost the same name.",
    why="srdfdom does not look at what it does not know, without a word: the group, pair or state "
    "is not there.",
    fix="Correct the name.",
    formats=(SRDF,),
    beside=BESIDE,
    bad=ARM + '<disable_collision link1="a" link2="b"/>',
    good=ARM + APART,
)
def srdf_misspelled(subject: Subject) -> Iterator[Problem]:
    """Elements and attributes close to a known one; others belong to other tools."""
    for parent, path in ((subject.document.root, ""), *_elements(subject.document.root)):
        children = ELEMENTS[path][2] if path else TOP
        for it in parent.iterchildren("*"):
            tag = str(it.tag)
            if tag not in children and (near := nearest(tag, children)):
                yield Problem(it, f"<{tag}> is not known", None, f"did you mean <{near}>?")
        known = (*ELEMENTS[path][0], *ELEMENTS[path][1]) if path else ("name", "version")
        for name in map(str, parent.attrib):
            if name not in known and (near := nearest(name, known)):
                message = f"{name} of <{parent.tag}> is not known"
                yield Problem(parent, message, name, f"did you mean {near}?")


@rule(
    "MB822",
    "joint-property",
    WARNING,
    what="A joint_property has a name that MoveIt does not know.",
    why="MoveIt logs 'Unknown joint property' and leaves it out.",
    fix="Use angular_distance_weight, motion_model or min_translational_distance.",
    formats=(SRDF,),
    beside=BESIDE,
    bad=ARM + '<joint_property joint_name="j" property_name="motion" value="holonomic"/>',
    good=ARM + '<joint_property joint_name="j" property_name="motion_model" value="holonomic"/>',
)
def joint_property(subject: Subject) -> Iterator[Problem]:
    """Names of properties."""
    for it in subject.document.root.iterchildren("joint_property"):
        name = text_of(it, "property_name")
        if name and name not in PROPERTIES:
            near = nearest(name, PROPERTIES)
            hint = f"did you mean {near!r}?" if near else f"one of {', '.join(PROPERTIES)}"
            yield Problem(it, f"property {name!r} is not known", "property_name", hint)


@rule(
    "MB823",
    "virtual-joint-type",
    ERROR,
    what="The type of a virtual joint is not fixed, planar or floating.",
    why="srdfdom takes it for fixed: a base that should drive stands still.",
    fix="Write fixed, planar or floating.",
    formats=(SRDF,),
    beside=BESIDE,
    bad=ARM + VIRTUAL.format("planer", "a"),
    good=ARM + VIRTUAL.format("planar", "a"),
)
def virtual_joint_type(subject: Subject) -> Iterator[Problem]:
    """Types, in whatever case."""
    for it in subject.document.root.iterchildren("virtual_joint"):
        type_ = text_of(it, "type")
        if "type" in it.attrib and type_.lower() not in VIRTUAL_TYPES:
            near = nearest(type_, VIRTUAL_TYPES)
            hint = f"did you mean {near!r}?" if near else f"one of {', '.join(VIRTUAL_TYPES)}"
            yield Problem(it, f"type {type_!r} is taken for fixed", "type", hint)


def _states(root: _Element) -> Iterator[tuple[_Element, str, str]]:
    """The joints of states, their groups and names."""
    for state in root.iterchildren("group_state"):
        for it in state.iterchildren("joint"):
            yield it, text_of(state, "group"), text_of(it)


def _numbers(text: str) -> list[float] | None:
    """The numbers of a value; None where one of them is none."""
    try:
        numbers = [float(word) for word in text.split()]
    except ValueError:
        return None
    return numbers if numbers and all(map(isfinite, numbers)) else None


def _limits(joint: Joint) -> tuple[float, float] | None:
    """The limits of a joint; None where they are not two numbers, or cannot be kept."""
    limit = joint.element.find("limit")
    if limit is None:
        return None
    found = [_numbers(limit.get(side, "0")) for side in ("lower", "upper")]
    lower, upper = (it[0] if it and len(it) == 1 else None for it in found)
    if lower is None or upper is None or lower > upper:
        return None
    return lower, upper


def _root(robot: Robot) -> str:
    """The root link; empty where there is none or there are several."""
    roots = [it.name for it in robot.links if it.name not in robot.above]
    return roots[0] if len(roots) == 1 else ""


def _has_shape(robot: Robot, link: str) -> bool:
    return robot.link[link].element.find("collision") is not None


def _ends(joint: Joint) -> frozenset[str]:
    return frozenset((joint.parent, joint.child))


def _touch(joint: Joint, robot: Robot, alone: set[str]) -> bool:
    """Are both of its links checked?"""
    ends = _ends(joint)
    return len(ends) == 2 and all(
        it in robot.link and it not in alone and _has_shape(robot, it) for it in ends
    )


def _elements(root: _Element) -> Iterator[tuple[_Element, str]]:
    """The elements that srdfdom reads and their places in ``ELEMENTS``."""
    for top in root.iterchildren(*TOP):
        tag = str(top.tag)
        yield top, tag
        for child in top.iterchildren("*"):
            if child.tag in ELEMENTS[tag][2]:
                yield child, f"{tag}/{child.tag}"
