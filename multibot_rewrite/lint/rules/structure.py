"""MB5: the kinematic tree and its joints."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from math import hypot, pi

from lxml.etree import _Element

from multibot_rewrite.checks.audit import nearest
from multibot_rewrite.lint.facts.numbers import number, value_of, vector
from multibot_rewrite.lint.facts.robot import Joint, Robot, loops, reached, roots
from multibot_rewrite.lint.records import NOTE, Problem, Subject, rule
from multibot_rewrite.model import ERROR, WARNING

TYPES = ("fixed", "revolute", "continuous", "prismatic", "floating", "planar")
# The types with one position, which an axis belongs to; those that must say how far they go.
ONE_AXIS = frozenset(("revolute", "continuous", "prismatic"))
BOUNDED = frozenset(("revolute", "prismatic"))
# More than twice around and a whole number below two turns in degrees; what people write for
# "no limit" is no angle.
DEGREES = (4.5 * pi, 720.0)
ENDLESS = frozenset((50.0, 100.0, 200.0, 500.0, 999.0))
# Longer than a room: the way a gripper goes in millimetres.
LONG_WAY = 25.0
FAR = 50.0
UNIT = 1e-3
TOLD = 8
# Above this many a search for the nearest name is not worth its time.
MANY = 50
# Files of these alone are read by others than urdfdom, or by xacro.
WITHOUT_LINKS = frozenset(("material", "webots"))

A_B = '<link name="a"/><link name="b"/>'
ENDS = '<parent link="a"/><child link="b"/>'
LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'


def _pair(kind: str, inside: str = "") -> str:
    """An example: two links and a joint."""
    return f'{A_B}<joint name="j" type="{kind}">{ENDS}{inside}</joint>'


def _second(inside: str, first: str = "") -> str:
    """An example: a revolute joint, and another with something in it."""
    return (
        f'{_pair("revolute", LIMIT + first)}<link name="c"/><joint name="k" type="revolute">'
        f'<parent link="b"/><child link="c"/>{LIMIT}{inside}</joint>'
    )


def _fixed(name: str, parent: str, child: str) -> str:
    return f'<joint name="{name}" type="fixed"><parent link="{parent}"/><child link="{child}"/></joint>'


def _few(names: Iterable[str]) -> str:
    """The first of many names, quoted."""
    all_ = [repr(it) for it in names]
    more = f" and {len(all_) - TOLD} more" if len(all_) > TOLD else ""
    return ", ".join(all_[:TOLD]) + more


# ---------------------------------------------------------------- the tree


@rule(
    "MB501",
    "several-roots",
    ERROR,
    what="More than one link has no parent: the robot is in several pieces.",
    why="urdfdom refuses the file ('Two root links found'): no robot_state_publisher, no tf.",
    fix="Add the joint that holds the pieces together.",
    bad=A_B,
    good=_pair("fixed"),
)
def several_roots(subject: Subject) -> Iterator[Problem]:
    """Every root but the one that most links hang on; a joint with a misspelled child is MB202."""
    robot = subject.robot
    found = roots(robot)
    if len(found) < 2:
        return
    seen: set[str] = set()
    sizes = [len(reached(robot, [it.name], seen)) for it in found]
    main = found[sizes.index(max(sizes))]
    lost = [it for it in robot.above if it not in robot.link]
    search = lost if len(found) * len(lost) <= MANY else ()
    for link in found:
        if link is main or nearest(link.name, search):
            continue
        said = f"link {link.name!r} is a second root beside {main.name!r}: it is no joint's child"
        yield Problem(link.element, said, "name", "add the joint that it hangs on")


@rule(
    "MB502",
    "no-link",
    WARNING,
    what="The robot has no link. Files of materials alone or for Webots need none.",
    why="urdfdom refuses the file ('No link elements found in urdf file').",
    fix="Add the links, directly below <robot>.",
    bad='<robot name="r"/>',
    good='<link name="a"/>',
)
def no_link(subject: Subject) -> Iterator[Problem]:
    """A robot without links that no xacro file made: a library of macros has none of its own."""
    root = subject.document.root
    if root.tag != "robot" or subject.robot.links or subject.origins:
        return
    tags = [str(it.tag) for it in root.iterchildren("*")]
    if not any("xacro}" in it for it in tags) and (not tags or not WITHOUT_LINKS.issuperset(tags)):
        yield Problem(root, "the robot has no link")


@rule(
    "MB503",
    "kinematic-loop",
    ERROR,
    what="Joints close a loop: a link is below itself.",
    why="urdfdom accepts a loop beside the tree: nothing of it gets a frame in tf, and pinocchio "
    "leaves it out; where all links are on loops it refuses the file ('No root link found').",
    fix="Turn round or delete one joint; close a real loop in the simulator.",
    bad='<link name="a"/><link name="b"/><link name="c"/>'
    + _fixed("j", "b", "c")
    + _fixed("k", "c", "b"),
    good='<link name="a"/><link name="b"/><link name="c"/>'
    + _fixed("j", "a", "b")
    + _fixed("k", "b", "c"),
)
def kinematic_loop(subject: Subject) -> Iterator[Problem]:
    """Each loop, at the joint that is written last."""
    order: dict[_Element, int] = {}
    for joints in loops(subject.robot):
        order = order or {it.element: at for at, it in enumerate(subject.robot.joints)}
        last = max(joints, key=lambda it: order[it.element])
        at = joints.index(last) + 1
        names = [it.child for it in joints[at:] + joints[:at]]
        way = " -> ".join(repr(it) for it in names[:TOLD]) + (" -> ..." if names[TOLD:] else "")
        yield Problem(
            last.element,
            f"joint {last.name!r} closes a loop of {len(joints)} joints: {last.child!r} is below "
            f"itself ({names[-1]!r} -> {way})",
        )


@rule(
    "MB504",
    "several-parents",
    ERROR,
    what="A link is the child of two joints.",
    why="urdfdom keeps one of the joints, by name; sdformat refuses the file (two links of one "
    "name) and MuJoCo, too ('body has multiple parents').",
    fix="Delete one of the joints, or add a link of its own for it.",
    bad='<link name="a"/><link name="b"/>' + _fixed("j", "a", "b") + _fixed("k", "a", "b"),
    good='<link name="a"/><link name="b"/><link name="c"/>'
    + _fixed("j", "a", "b")
    + _fixed("k", "a", "c"),
)
def several_parents(subject: Subject) -> Iterator[Problem]:
    """Every joint but the first that has the link as its child; a copy of it has its own rule."""
    for name, joints in subject.robot.above.items():
        if len(joints) == 1:
            continue
        for joint in joints[1:]:
            if joint.name != joints[0].name and joint.parent != name:
                yield Problem(
                    joint.parts["child"],
                    f"link {name!r} is the child of {joint.name!r} and of {joints[0].name!r}",
                    "link",
                )


@rule(
    "MB505",
    "unreachable-link",
    ERROR,
    what="Links hang on a loop, or on a joint from a link to itself: no way leads to them from the "
    "root.",
    why="urdfdom accepts the file and nobody sees the links: they get no frame in tf, and Gazebo "
    "and pinocchio leave them out.",
    fix="Mend the loop that they hang on.",
    bad='<link name="a"/><link name="b"/><link name="c"/><link name="d"/>'
    + _fixed("j", "b", "c")
    + _fixed("k", "c", "b")
    + _fixed("l", "c", "d"),
    good='<link name="a"/><link name="b"/>' + _fixed("j", "a", "b"),
)
def unreachable_link(subject: Subject) -> Iterator[Problem]:
    """All of them at the first one; the links of the loops themselves are told there."""
    robot = subject.robot
    seen: set[str] = set()
    reached(robot, (it for it in (*robot.link, *robot.below) if it not in robot.above), seen)
    if not seen or all(it in seen for it in robot.link):
        return
    seen.update(it.child for joints in loops(robot) for it in joints)
    seen.update(it.child for it in robot.joints if it.child == it.parent)
    lost = [it for name, it in robot.link.items() if name not in seen]
    if lost:
        names = _few(it.name for it in lost)
        yield Problem(lost[0].element, f"no way from the root leads to {names}", "name")


@rule(
    "MB506",
    "joint-to-itself",
    ERROR,
    what="A joint's parent is its child.",
    why="For urdfdom the link has a parent and is no root: with the root it refuses the file ('No "
    "root link found'), any other link is left out of tf and Gazebo.",
    fix="Name the link that the joint hangs on as its parent.",
    bad='<link name="a"/>' + _fixed("j", "a", "a"),
    good=_pair("fixed"),
)
def joint_to_itself(subject: Subject) -> Iterator[Problem]:
    """Joints from a link to itself."""
    for joint in subject.robot.joints:
        if joint.parent == joint.child and joint.parent:
            message = f"joint {joint.name!r} has {joint.child!r} as its parent and as its child"
            yield Problem(joint.parts["child"], message, "link")


@rule(
    "MB507",
    "joint-without-ends",
    ERROR,
    what="A joint does not say its parent or its child link.",
    why="urdfdom refuses the file ('missing a parent and/or child link specification').",
    fix='Add <parent link="..."/> and <child link="..."/>.',
    bad='<link name="a"/><joint name="j" type="fixed"><parent link="a"/></joint>',
    good=_pair("fixed"),
)
def joint_without_ends(subject: Subject) -> Iterator[Problem]:
    """Joints without an end, each at the element that lacks it."""
    for joint in subject.robot.joints:
        if joint.parent and joint.child:
            continue
        for tag, name in (("parent", joint.parent), ("child", joint.child)):
            part = joint.parts.get(tag)
            if not name and part is None:
                yield Problem(joint.element, f"joint {joint.name!r} has no <{tag}>")
            elif not name and part is not None:
                yield Problem(part, f"<{tag}> of joint {joint.name!r} names no link", "link")


# ---------------------------------------------------------------- types and limits


@rule(
    "MB508",
    "joint-type",
    ERROR,
    what="A joint has no type, or one that URDF does not know.",
    why="urdfdom refuses the file ('has no known type'); it knows fixed, revolute, continuous, "
    "prismatic, floating and planar, in small letters.",
    fix="Write one of the six types.",
    bad=_pair("Fixed"),
    good=_pair("fixed"),
)
def joint_type(subject: Subject) -> Iterator[Problem]:
    """Types that are not one of the six, letter by letter."""
    for joint in subject.robot.joints:
        if joint.type in TYPES:
            continue
        if not joint.type:
            yield Problem(joint.element, f"joint {joint.name!r} has no type", "type")
            continue
        near = nearest(joint.type.strip().lower(), TYPES)
        hint = f"did you mean {near!r}?" if near else f"the types are {', '.join(TYPES)}"
        yield Problem(
            joint.element, f"joint {joint.name!r}: unknown type {joint.type!r}", "type", hint
        )


@rule(
    "MB509",
    "limit-missing",
    ERROR,
    what="A revolute or prismatic joint has no <limit>.",
    why="urdfdom refuses the file ('is of type REVOLUTE but it does not specify limits').",
    fix="Add <limit> with lower, upper, effort and velocity; a wheel's joint is continuous.",
    bad=_pair("revolute"),
    good=_pair("revolute", LIMIT),
)
def limit_missing(subject: Subject) -> Iterator[Problem]:
    """Joints that must be bounded and are not."""
    for joint in subject.robot.joints:
        if joint.type in BOUNDED and "limit" not in joint.parts:
            yield Problem(joint.element, f"{joint.type} joint {joint.name!r} has no <limit>")


@rule(
    "MB510",
    "limit-incomplete",
    ERROR,
    what="A <limit> says no effort or no velocity.",
    why="urdfdom refuses the whole file ('joint limit: no effort'), whatever the joint's type.",
    fix="Add the attribute, or delete a <limit> that the type does not need.",
    bad=_pair("revolute", '<limit lower="-1" upper="1" velocity="1"/>'),
    good=_pair("revolute", LIMIT),
)
def limit_incomplete(subject: Subject) -> Iterator[Problem]:
    """Limits without what urdfdom insists on."""
    for joint, limit in _with(subject.robot, "limit"):
        missing = [it for it in ("effort", "velocity") if limit.get(it) is None]
        if missing:
            yield Problem(
                limit, f"<limit> of joint {joint.name!r} has no {' and no '.join(missing)}"
            )


@rule(
    "MB511",
    "limits-inverted",
    ERROR,
    what="A joint's lower limit is above its upper one.",
    why="No position is inside: MoveIt finds every state out of bounds, MuJoCo drops the limits, "
    "sdformat swaps them.",
    fix="Swap them, or mend the sign.",
    bad=_pair("revolute", '<limit lower="1" upper="-1" effort="1" velocity="1"/>'),
    good=_pair("revolute", LIMIT),
)
def limits_inverted(subject: Subject) -> Iterator[Problem]:
    """Limits the wrong way round."""
    for joint, limit, lower, upper in _bounds(subject.robot):
        if lower > upper:
            message = f"joint {joint.name!r}: lower {lower:g} is above upper {upper:g}"
            yield Problem(limit, message, "lower")


@rule(
    "MB512",
    "limits-zero-range",
    NOTE,
    what="A joint's limits leave it no way to go.",
    why="robot_state_publisher still waits for its position in joint_states and sends no transform "
    "without; MuJoCo takes equal limits for none and lets the joint go round.",
    fix="Write the real limits, or make the joint fixed (<preserveFixedJoint> keeps its link in "
    "Gazebo).",
    bad=_pair("revolute", '<limit lower="0" upper="0" effort="1" velocity="1"/>'),
    good=_pair("revolute", LIMIT),
)
def limits_zero_range(subject: Subject) -> Iterator[Problem]:
    """Limits that are equal: a slip of an exporter, or a frame that Gazebo shall not merge."""
    for joint, limit, lower, upper in _bounds(subject.robot):
        if lower == upper:
            message = (
                f"{joint.type} joint {joint.name!r} cannot move: lower and upper are {lower:g}"
            )
            yield Problem(limit, message)


@rule(
    "MB513",
    "limit-without-bounds",
    WARNING,
    what="A revolute or prismatic joint's <limit> has no lower or no upper.",
    why="urdfdom reads 0; joint_state_publisher refuses the description and publishes no joint at "
    "all ('\"lower\" limit must be specified').",
    fix="Write both.",
    bad=_pair("revolute", '<limit upper="1" effort="1" velocity="1"/>'),
    good=_pair("revolute", LIMIT),
)
def limit_without_bounds(subject: Subject) -> Iterator[Problem]:
    """Bounds that are read as 0."""
    for joint, limit in _with(subject.robot, "limit"):
        if joint.type not in BOUNDED:
            continue
        missing = [it for it in ("lower", "upper") if limit.get(it) is None]
        if missing:
            words = " and no ".join(missing)
            yield Problem(limit, f"<limit> of {joint.type} joint {joint.name!r} has no {words}")


@rule(
    "MB514",
    "negative-limit",
    WARNING,
    what="The greatest effort or velocity of a joint is below 0.",
    why="pinocchio refuses the file ('Some components of min_effort are greater than max_effort'), "
    "sdformat documents a negative effort as not enforced, ros2_control and MoveIt drop the sign of a "
    "velocity.",
    fix="Write the greatest absolute value.",
    bad=_pair("revolute", '<limit lower="-1" upper="1" effort="-5" velocity="1"/>'),
    good=_pair("revolute", LIMIT),
)
def negative_limit(subject: Subject) -> Iterator[Problem]:
    """Each such attribute."""
    for joint, limit in _with(subject.robot, "limit"):
        for name in ("effort", "velocity"):
            if limit.get(name, "").lstrip().startswith("-") and (value_of(limit, name) or 0) < 0:
                message = f"joint {joint.name!r}: {name} {limit.get(name)} is negative"
                yield Problem(limit, message, name)


@rule(
    "MB515",
    "zero-limit",
    NOTE,
    what="The greatest effort or velocity of a joint that moves is 0.",
    why="ros2_control's joint limits take the 0 as it stands: no velocity is allowed; MoveIt takes "
    "a velocity of 0 for no limit.",
    fix="Write what the motor can do.",
    bad=_pair("revolute", '<limit lower="-1" upper="1" effort="0" velocity="1"/>'),
    good=_pair("revolute", LIMIT),
)
def zero_limit(subject: Subject) -> Iterator[Problem]:
    """One a joint; those that follow another, or cannot move, need no strength."""
    for joint, limit in _with(subject.robot, "limit"):
        if joint.type not in ONE_AXIS or "mimic" in joint.parts or _is_still(joint, limit):
            continue
        zero = [it for it in ("effort", "velocity") if value_of(limit, it) == 0]
        if zero:
            verb = "are" if zero[1:] else "is"
            message = f"joint {joint.name!r}: {' and '.join(zero)} {verb} 0"
            yield Problem(limit, message, zero[0])


@rule(
    "MB516",
    "continuous-limits",
    WARNING,
    what="A continuous joint has limits of less than a turn, which are ignored.",
    why="sdformat, MoveIt and ros2_control read no bounds of a continuous joint: it goes on "
    "turning.",
    fix="Make it revolute, or prismatic if it slides; delete lower and upper if it does turn on.",
    bad=_pair("continuous", LIMIT),
    good=_pair("revolute", LIMIT),
)
def continuous_limits(subject: Subject) -> Iterator[Problem]:
    """Bounds that somebody meant; a whole turn is what continuous means."""
    for joint, limit in _with(subject.robot, "limit"):
        if joint.type != "continuous" or limit.get("lower") is None:
            continue
        lower, upper = value_of(limit, "lower"), value_of(limit, "upper", 0.0)
        if lower is not None and upper is not None and 0 < upper - lower < 1.99 * pi:
            message = f"continuous joint {joint.name!r} ignores its limits {lower:g} to {upper:g}"
            yield Problem(limit, message, "lower")


@rule(
    "MB517",
    "prismatic-units",
    WARNING,
    what="The limits of a prismatic joint look like millimetres.",
    why="URDF is in metres: planners and simulators let the joint go out of the room.",
    fix="Divide by 1000.",
    bad=_pair("prismatic", '<limit lower="0" upper="40" effort="1" velocity="1"/>'),
    good=_pair("prismatic", '<limit lower="0" upper="0.04" effort="1" velocity="1"/>'),
)
def prismatic_units(subject: Subject) -> Iterator[Problem]:
    """Long ways; the same to both sides is a virtual joint without real limits."""
    for joint, limit, lower, upper in _bounds(subject.robot):
        far = max(abs(lower), abs(upper))
        if joint.type == "prismatic" and LONG_WAY <= far < 1e4 and lower != -upper:
            message = f"prismatic joint {joint.name!r} goes from {lower:g} m to {upper:g} m"
            name = "upper" if abs(upper) == far else "lower"
            yield Problem(limit, message, name, "are these millimetres?")


@rule(
    "MB518",
    "revolute-degrees",
    WARNING,
    what="A limit of a revolute joint looks like degrees.",
    why="URDF is in radians: the joint turns many times before it meets the limit.",
    fix="Multiply by pi/180; xacro has radians().",
    bad=_pair("revolute", '<limit lower="-90" upper="90" effort="1" velocity="1"/>'),
    good=_pair("revolute", '<limit lower="-1.5708" upper="1.5708" effort="1" velocity="1"/>'),
)
def revolute_degrees(subject: Subject) -> Iterator[Problem]:
    """Whole numbers between a few turns and what no angle in degrees is above."""
    for joint, limit, lower, upper in _bounds(subject.robot):
        if joint.type == "revolute" and (_is_degrees(lower) or _is_degrees(upper)):
            message = f"revolute joint {joint.name!r} turns from {lower:g} to {upper:g} radians"
            name = "upper" if _is_degrees(upper) else "lower"
            yield Problem(limit, message, name, "are these degrees?")


def _is_degrees(angle: float) -> bool:
    size = abs(angle)
    return DEGREES[0] < size <= DEGREES[1] and size % 0.5 == 0 and size not in ENDLESS


# ---------------------------------------------------------------- axis, origin, type


@rule(
    "MB519",
    "zero-axis",
    ERROR,
    what="The axis of a joint that moves is 0 0 0, or its <axis> has no xyz.",
    why="sdformat refuses the file ('The norm of the xyz vector cannot be zero') and MuJoCo, too; "
    "KDL divides by the length, so robot_state_publisher sends nan, which tf2 ignores.",
    fix='Write the axis: <axis xyz="0 0 1"/>; without <axis> it is 1 0 0.',
    bad=_pair("revolute", '<axis xyz="0 0 0"/>' + LIMIT),
    good=_pair("revolute", '<axis xyz="0 0 1"/>' + LIMIT),
)
def zero_axis(subject: Subject) -> Iterator[Problem]:
    """Axes without a direction."""
    for joint, axis, length in _axes(subject.robot):
        if length == 0:
            said = "is 0 0 0" if axis.get("xyz") else "has no xyz, which is 0 0 0"
            yield Problem(axis, f"<axis> of {joint.type} joint {joint.name!r} {said}", "xyz")


@rule(
    "MB520",
    "prismatic-axis-length",
    WARNING,
    what="The axis of a prismatic joint is not of length 1.",
    why="KDL (robot_state_publisher), sdformat and pinocchio make it 1, MoveIt and yourdfpy go as "
    "many times as far: the planner's robot is not the one in tf.",
    fix="Divide the axis by its length.",
    bad=_pair("prismatic", '<axis xyz="0 0 2"/>' + LIMIT),
    good=_pair("prismatic", '<axis xyz="0 0 1"/>' + LIMIT),
)
def prismatic_axis_length(subject: Subject) -> Iterator[Problem]:
    """Axes that stretch a way."""
    yield from _not_unit(subject.robot, ("prismatic",))


@rule(
    "MB521",
    "axis-length",
    NOTE,
    what="The axis of a revolute or continuous joint is not of length 1.",
    why="KDL, sdformat, MoveIt and pinocchio make it 1; a reader that takes it as it is turns the "
    "joint by another angle.",
    fix="Divide the axis by its length.",
    bad=_pair("revolute", '<axis xyz="0 1 1"/>' + LIMIT),
    good=_pair("revolute", '<axis xyz="0 0.7071 0.7071"/>' + LIMIT),
)
def axis_length(subject: Subject) -> Iterator[Problem]:
    """Axes that others make right."""
    yield from _not_unit(subject.robot, ("revolute", "continuous"))


def _not_unit(robot: Robot, types: tuple[str, ...]) -> Iterator[Problem]:
    for joint, axis, length in _axes(robot):
        if length and abs(length - 1) > UNIT and joint.type in types:
            message = f"axis of joint {joint.name!r} has the length {length:.4g}"
            yield Problem(axis, message, "xyz")


@rule(
    "MB522",
    "fixed-joint-ignores",
    NOTE,
    what="A fixed joint has a limit, a mimic or a safety controller.",
    why="urdfdom reads them, and a joint that cannot move has no use for them.",
    fix="Delete them, or give the joint the type that was meant.",
    bad=_pair("fixed", LIMIT),
    good=_pair("fixed"),
)
def fixed_joint_ignores(subject: Subject) -> Iterator[Problem]:
    """One a joint; <axis> and <dynamics> are what exporters write everywhere."""
    for joint in subject.robot.joints:
        if joint.type != "fixed":
            continue
        useless = [it for it in ("limit", "mimic", "safety_controller") if it in joint.parts]
        if useless:
            words = ", ".join(f"<{it}>" for it in useless)
            yield Problem(
                joint.parts[useless[0]], f"fixed joint {joint.name!r} ignores its {words}"
            )


@rule(
    "MB523",
    "floating-or-planar",
    WARNING,
    what="A joint is floating or planar.",
    why="robot_state_publisher sends no transform for a floating joint and a fixed one for a planar "
    "joint; sdformat makes no joint of either and then refuses the link that hangs on it.",
    fix="Make the link below the root: its pose comes from odometry or, in MoveIt, from a "
    "<virtual_joint> of the SRDF.",
    bad=_pair("floating"),
    good=_pair("fixed"),
)
def floating_or_planar(subject: Subject) -> Iterator[Problem]:
    """Joints of more than one position."""
    for joint in subject.robot.joints:
        if joint.type in ("floating", "planar"):
            tf = "gets no transform" if joint.type == "floating" else "is fixed in tf"
            yield Problem(joint.element, f"{joint.type} joint {joint.name!r} {tf}", "type")


@rule(
    "MB524",
    "joint-origin-units",
    WARNING,
    what="A joint stands very far from its parent link.",
    why="URDF is in metres: the child is drawn, planned and simulated where the number says.",
    fix="Divide by 1000 what is in millimetres.",
    bad=_pair("fixed", '<origin xyz="0 0 120"/>'),
    good=_pair("fixed", '<origin xyz="0 0 0.12"/>'),
)
def joint_origin_units(subject: Subject) -> Iterator[Problem]:
    """Origins that are farther than a robot is long."""
    for joint, origin in _with(subject.robot, "origin"):
        xyz = vector(origin.get("xyz"))
        if xyz and max(map(abs, xyz)) >= FAR:
            message = f"joint {joint.name!r} is {hypot(*xyz):.4g} m away from {joint.parent!r}"
            yield Problem(origin, message, "xyz", "are these millimetres?")


# ---------------------------------------------------------------- mimic


@rule(
    "MB525",
    "mimic-without-joint",
    ERROR,
    what="A <mimic> does not say which joint it follows.",
    why="urdfdom refuses the file ('joint mimic: no mimic joint specified').",
    fix='Add joint="...".',
    bad=_second("<mimic/>"),
    good=_second('<mimic joint="j"/>'),
)
def mimic_without_joint(subject: Subject) -> Iterator[Problem]:
    """Mimics of nothing."""
    for joint, mimic in _with(subject.robot, "mimic"):
        if not mimic.get("joint"):
            yield Problem(mimic, f"<mimic> of joint {joint.name!r} names no joint", "joint")


@rule(
    "MB526",
    "mimic-of-itself",
    ERROR,
    what="A joint mimics itself.",
    why="Current sdformat refuses the joint ('cannot mimic itself'), MoveIt ignores every mimic of the "
    "robot, joint_state_publisher ends ('Found an infinite recursive mimic chain').",
    fix="Name the joint that it follows.",
    bad=_second('<mimic joint="k"/>'),
    good=_second('<mimic joint="j"/>'),
)
def mimic_of_itself(subject: Subject) -> Iterator[Problem]:
    """Mimics of the joint they stand in."""
    for joint, mimic in _with(subject.robot, "mimic"):
        if mimic.get("joint") == joint.name and joint.name:
            yield Problem(mimic, f"joint {joint.name!r} mimics itself", "joint")


@rule(
    "MB527",
    "mimic-loop",
    ERROR,
    what="Joints mimic each other in a circle.",
    why="MoveIt ignores every mimic of the robot ('Cycle found in joint that mimic each other') "
    "and joint_state_publisher ends ('Found an infinite recursive mimic chain').",
    fix="Delete the <mimic> of the joint that is driven.",
    bad=_second('<mimic joint="j"/>', '<mimic joint="k"/>'),
    good=_second('<mimic joint="j"/>'),
)
def mimic_loop(subject: Subject) -> Iterator[Problem]:
    """Each circle, at its first mimic."""
    for circle in _circles(_leaders(subject.robot)):
        if len(circle) > 1:
            mimic = subject.robot.joint[circle[0]].parts["mimic"]
            yield Problem(mimic, f"joints mimic each other in a circle: {_few(circle)}", "joint")


@rule(
    "MB528",
    "mimic-chain",
    NOTE,
    what="A joint mimics a joint that is a mimic, too.",
    why="MoveIt and joint_state_publisher follow the chain. robot_state_publisher goes through the "
    "mimics once, by name: it sends no transform for one whose leader has the later name, unless "
    "joint_states has the leader.",
    fix="Name the first joint of the chain, and multiply the multipliers.",
    bad=_second('<mimic joint="j"/>')
    + '<link name="d"/><joint name="l" type="revolute"><parent link="c"/><child link="d"/>'
    + LIMIT
    + '<mimic joint="k"/></joint>',
    good=_second('<mimic joint="j"/>'),
)
def mimic_chain(subject: Subject) -> Iterator[Problem]:
    """Mimics of mimics; a circle has its own rule."""
    leader = _leaders(subject.robot)
    chained = {name: follows for name, follows in leader.items() if follows in leader}
    round_ = {name for circle in _circles(chained) for name in circle}
    for name, follows in chained.items():
        if name not in round_:
            late = "; robot_state_publisher is too early for it" if name < follows else ""
            message = f"joint {name!r} mimics {follows!r}, which mimics {leader[follows]!r}{late}"
            yield Problem(subject.robot.joint[name].parts["mimic"], message, "joint")


@rule(
    "MB529",
    "mimic-of-fixed",
    ERROR,
    what="A joint mimics one that has not one position: fixed, floating or planar.",
    why="joint_state_publisher ends with a KeyError, MoveIt ignores the mimic ('different number "
    "of DOF'), and no joint_states message ever has the leader.",
    fix="Name a joint that moves, or make this one fixed.",
    bad=_second('<mimic joint="j"/>').replace("revolute", "fixed", 1),
    good=_second('<mimic joint="j"/>'),
)
def mimic_of_fixed(subject: Subject) -> Iterator[Problem]:
    """Mimics without a position to follow; of a fixed joint itself nobody asks one."""
    for joint, mimic in _with(subject.robot, "mimic"):
        leader = subject.robot.joint.get(mimic.get("joint", ""))
        if (
            leader
            and leader.type in TYPES
            and leader.type not in ONE_AXIS
            and joint.type in ONE_AXIS
        ):
            message = f"joint {joint.name!r} mimics {leader.name!r}, which is {leader.type}"
            yield Problem(mimic, message, "joint")


@rule(
    "MB530",
    "mimic-multiplier-zero",
    WARNING,
    what="The multiplier of a <mimic> is 0.",
    why="The joint stands still, whatever the other one does.",
    fix="Write the ratio, or make the joint fixed.",
    bad=_second('<mimic joint="j" multiplier="0"/>'),
    good=_second('<mimic joint="j" multiplier="0.5"/>'),
)
def mimic_multiplier_zero(subject: Subject) -> Iterator[Problem]:
    """Mimics that never move."""
    for joint, mimic in _with(subject.robot, "mimic"):
        if value_of(mimic, "multiplier", 1.0) == 0 and joint.type in ONE_AXIS:
            message = f"joint {joint.name!r} mimics {mimic.get('joint')!r} 0 times: it never moves"
            yield Problem(mimic, message, "multiplier")


# ---------------------------------------------------------------- safety controller, dynamics


@rule(
    "MB531",
    "safety-without-k-velocity",
    ERROR,
    what="A <safety_controller> has no k_velocity.",
    why="urdfdom refuses the file ('joint safety: no k_velocity').",
    fix="Add it, or delete the element.",
    bad=_pair(
        "revolute", LIMIT + '<safety_controller soft_lower_limit="-1" soft_upper_limit="1"/>'
    ),
    good=_pair(
        "revolute",
        LIMIT + '<safety_controller soft_lower_limit="-1" soft_upper_limit="1" k_velocity="10"/>',
    ),
)
def safety_without_k_velocity(subject: Subject) -> Iterator[Problem]:
    """Safety controllers without what urdfdom insists on."""
    for joint, safety in _with(subject.robot, "safety_controller"):
        if safety.get("k_velocity") is None:
            message = f"<safety_controller> of joint {joint.name!r} has no k_velocity"
            yield Problem(safety, message)


@rule(
    "MB532",
    "soft-limits-empty",
    WARNING,
    what="The soft limits of a <safety_controller> leave the joint no way to go.",
    why="A missing soft limit is 0. MoveIt takes what is inside both kinds of limits: it cannot "
    "plan for a joint that may only stand at 0.",
    fix="Write soft_lower_limit and soft_upper_limit, or delete the element.",
    bad=_pair("revolute", LIMIT + '<safety_controller k_velocity="10"/>'),
    good=_pair(
        "revolute",
        LIMIT + '<safety_controller soft_lower_limit="-1" soft_upper_limit="1" k_velocity="10"/>',
    ),
)
def soft_limits_empty(subject: Subject) -> Iterator[Problem]:
    """Soft limits that are empty where the hard ones are not."""
    for joint, safety, soft, hard in _soft_and_hard(subject.robot):
        low, high = max(soft[0], hard[0]), min(soft[1], hard[1])
        if low >= high and hard[0] < hard[1]:
            message = (
                f"joint {joint.name!r}: the soft limits {soft[0]:g} to {soft[1]:g} leave no way"
            )
            yield Problem(safety, message)


@rule(
    "MB533",
    "soft-limits-outside",
    NOTE,
    what="A soft limit of a <safety_controller> is outside of the hard one.",
    why="It has no effect: MoveIt, ros2_control and joint_state_publisher take the narrower one.",
    fix="Put the soft limits inside of the hard ones.",
    bad=_pair(
        "revolute",
        LIMIT + '<safety_controller soft_lower_limit="-2" soft_upper_limit="1" k_velocity="10"/>',
    ),
    good=_pair(
        "revolute",
        LIMIT + '<safety_controller soft_lower_limit="-1" soft_upper_limit="1" k_velocity="10"/>',
    ),
)
def soft_limits_outside(subject: Subject) -> Iterator[Problem]:
    """One a joint."""
    for joint, safety, soft, hard in _soft_and_hard(subject.robot):
        if hard[0] < hard[1] and (soft[0] < hard[0] - UNIT or soft[1] > hard[1] + UNIT):
            message = (
                f"joint {joint.name!r}: the soft limits {soft[0]:g} to {soft[1]:g} are outside of "
                f"{hard[0]:g} to {hard[1]:g}"
            )
            yield Problem(safety, message)


@rule(
    "MB534",
    "dynamics-empty",
    ERROR,
    what="A <dynamics> has neither damping nor friction.",
    why="urdfdom refuses the file ('joint dynamics element specified with no damping and no "
    "friction').",
    fix="Add one of them, or delete the element.",
    bad=_pair("continuous", "<dynamics/>"),
    good=_pair("continuous", '<dynamics damping="0.1"/>'),
)
def dynamics_empty(subject: Subject) -> Iterator[Problem]:
    """Dynamics without a number."""
    for joint, dynamics in _with(subject.robot, "dynamics"):
        if dynamics.get("damping") is None and dynamics.get("friction") is None:
            message = f"<dynamics> of joint {joint.name!r} has neither damping nor friction"
            yield Problem(dynamics, message)


# ---------------------------------------------------------------- what rules look at


def _with(robot: Robot, tag: str) -> Iterator[tuple[Joint, _Element]]:
    """The joints that have such an element."""
    for joint in robot.joints:
        if tag in joint.parts:
            yield joint, joint.parts[tag]


def _bounds(robot: Robot) -> Iterator[tuple[Joint, _Element, float, float]]:
    """The joints that have both bounds and need them."""
    for joint, limit in _with(robot, "limit"):
        if joint.type in BOUNDED:
            lower, upper = number(limit.get("lower")), number(limit.get("upper"))
            if lower is not None and upper is not None:
                yield joint, limit, lower, upper


def _is_still(joint: Joint, limit: _Element) -> bool:
    return joint.type in BOUNDED and value_of(limit, "lower", 0.0) == value_of(limit, "upper", 0.0)


def _axes(robot: Robot) -> Iterator[tuple[Joint, _Element, float]]:
    """The joints that use an <axis>, and its length; one without xyz has none."""
    for joint, axis in _with(robot, "axis"):
        if joint.type in ONE_AXIS:
            xyz = vector(axis.get("xyz", "0 0 0"))
            if xyz is not None:
                yield joint, axis, hypot(*xyz)


def _leaders(robot: Robot) -> dict[str, str]:
    """Mimicking joint -> the joint it follows."""
    return {
        joint.name: mimic.get("joint", "")
        for joint, mimic in _with(robot, "mimic")
        if robot.joint[joint.name] is joint
    }


def _circles(leader: Mapping[str, str]) -> list[list[str]]:
    """The names that follow each other round and round."""
    done: set[str] = set()
    found = []
    for start in leader:
        way: dict[str, None] = {}
        name = start
        while name in leader and name not in done:
            done.add(name)
            way[name] = None
            name = leader[name]
        if name in way:
            found.append(list(way)[list(way).index(name) :])
    return found


Range = tuple[float, float]


def _soft_and_hard(robot: Robot) -> Iterator[tuple[Joint, _Element, Range, Range]]:
    """The bounded joints with a safety controller, and both pairs of limits as MoveIt reads them."""
    for joint, safety in _with(robot, "safety_controller"):
        limit = joint.parts.get("limit")
        if joint.type not in BOUNDED or limit is None:
            continue
        soft = (value_of(safety, f"soft_{it}_limit", 0.0) for it in ("lower", "upper"))
        hard = (value_of(limit, it, 0.0) for it in ("lower", "upper"))
        read = [it for it in (*soft, *hard) if it is not None]
        if len(read) == 4:
            yield joint, safety, (read[0], read[1]), (read[2], read[3])
