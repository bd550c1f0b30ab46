"""MB3: how names are spelled."""

from __future__ import annotations

import re
from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.lazy import lazy_compile
from multibot_rewrite.lint.records import NOTE, SRDF, URDF, Problem, Subject, rule
from multibot_rewrite.model import ERROR, WARNING, Claim, Edit
from multibot_rewrite.naming import FRAME_KINDS, NOT_PLAIN
from multibot_rewrite.rosnames import check_topic_name, propose_token, split_remap
from multibot_rewrite.steps.document import value_slot

WORLD = "world"
SPOKEN = frozenset({"topic", "service", "namespace"})
# What stands for other text is not looked at: its rule is MB105.
SUBSTITUTION = "$"
_BLANK = lazy_compile(r"\s")
_TOKEN = lazy_compile(r"[A-Za-z_]\w*", re.ASCII)
# ROS 1, ROS 2 and both Gazebos agree on these.
_SPOKEN = lazy_compile(r"[\w/~]*", re.ASCII)


def _named(subject: Subject) -> Iterator[tuple[str, str, _Element]]:
    """(kind, name, element) of the links and joints that have a name attribute."""
    for link in subject.robot.links:
        if SUBSTITUTION not in link.name and "name" in link.element.attrib:
            yield "link", link.name, link.element
    for joint in subject.robot.joints:
        if SUBSTITUTION not in joint.name and "name" in joint.element.attrib:
            yield "joint", joint.name, joint.element


def _robot_name(subject: Subject) -> str | None:
    """The robot's own name; None where it has none, or a substitution."""
    root = subject.document.root
    name = root.get("name") if root.tag == "robot" else None
    return None if name is None or SUBSTITUTION in name else name


@rule(
    "MB301",
    "leading-slash",
    WARNING,
    what="A frame is written with a slash in front.",
    why="tf2 look-ups throw: \"tf2 frame_ids cannot start with a '/'\"; robot_state_publisher sends a "
    "link's name as it is, so a link written like that is a frame that nobody can ask for.",
    fix="Drop the slash.",
    bad='<link name="lidar"/><gazebo><plugin name="p" filename="libgazebo_ros_imu_sensor.so">'
    "<frame_name>/lidar</frame_name></plugin></gazebo>",
    good='<link name="lidar"/><gazebo><plugin name="p" filename="libgazebo_ros_imu_sensor.so">'
    "<frame_name>lidar</frame_name></plugin></gazebo>",
    formats=(URDF, SRDF),
)
def leading_slash(subject: Subject) -> Iterator[Problem]:
    """The slash can go where the frame without it is a link of the robot. Plugins know /world."""
    shared = subject.settings.naming.shared_frames
    for claim in subject.inventory.claims:
        if claim.value[:1] != "/" or claim.site.form != "whole":
            continue
        name = claim.value[1:]
        if claim.site.kinds[0] in FRAME_KINDS and name and name not in shared:
            known = name in subject.inventory.declared["link"]
            message = f"frame {claim.value!r} starts with a slash"
            edits = _without_slash(subject, claim) if known else ()
            yield Problem(claim.element, message, claim.attribute, "drop the slash", edits)


def _without_slash(subject: Subject, claim: Claim) -> tuple[Edit, ...]:
    slot = value_slot(subject.document.source, claim.start, claim.attribute, claim.value)
    if slot is None or subject.document.source[slot[0] : slot[0] + 1] != b"/":
        return ()
    return (Edit(slot[0], slot[0] + 1, b"", None),)


@rule(
    "MB302",
    "empty-name",
    ERROR,
    what="A link or joint has an empty name.",
    why="urdfdom refuses a joint to a link without a name, sdformat refuses the empty name of a "
    "joint, and tf2 takes no transform whose frame is empty.",
    fix="Give it a name; in xacro see which argument or property is empty.",
    bad='<link name=""/>',
    good='<link name="a"/>',
)
def empty_name(subject: Subject) -> Iterator[Problem]:
    """Names of blanks alone, too."""
    for kind, name, element in _named(subject):
        if not name.strip():
            yield Problem(element, f"a {kind} has an empty name", "name")


@rule(
    "MB303",
    "blank-in-name",
    WARNING,
    what="The name of a link or joint holds white space.",
    why="No ROS name may hold any: topics, nodes and namespaces made of it are refused by rcl. "
    "Lists of names in plugins and hardware parameters are cut at blanks.",
    fix="Write an underscore, or delete the blank around it, at every use as well.",
    bad='<link name="left wheel"/>',
    good='<link name="left_wheel"/>',
)
def blank_in_name(subject: Subject) -> Iterator[Problem]:
    """Blanks within it or around it."""
    for kind, name, element in _named(subject):
        if name.strip() and _BLANK.search(name):
            where = "" if name == name.strip() else " around it"
            near = "_".join(name.split())
            yield Problem(
                element, f"{kind} {name!r} holds white space{where}", "name", f"write {near!r}"
            )


@rule(
    "MB304",
    "slash-in-joint",
    NOTE,
    what="The name of a joint, sensor or gpio in <ros2_control> holds a slash.",
    why="Its interfaces are called NAME/INTERFACE, and the controller manager cuts that at the "
    "first slash: arm/j1/position belongs to the controller 'arm' as soon as there is one.",
    fix="Write an underscore, in the URDF and in the controllers' parameters; or call no "
    "controller what stands before the slash.",
    bad='<ros2_control name="c" type="system"><hardware><plugin>p/P</plugin></hardware>'
    '<joint name="arm/j1"><state_interface name="position"/></joint></ros2_control>',
    good='<ros2_control name="c" type="system"><hardware><plugin>p/P</plugin></hardware>'
    '<joint name="arm_j1"><state_interface name="position"/></joint></ros2_control>',
)
def slash_in_joint(subject: Subject) -> Iterator[Problem]:
    """Every component that has interfaces."""
    for system in subject.elements.every("ros2_control"):
        for part in system.iterchildren("joint", "sensor", "gpio"):
            name = part.get("name", "")
            if "/" in name and SUBSTITUTION not in name:
                cut = name.partition("/")[0]
                message = f"{part.tag} {name!r} holds a slash: its interfaces seem to be of {cut!r}"
                yield Problem(part, message, "name", f"write {name.replace('/', '_')!r}")


@rule(
    "MB305",
    "double-colon",
    ERROR,
    what="The name of the robot, a link or a joint holds '::'.",
    why="SDF keeps '::' for names inside of models: sdformat 13 and later turn the URDF into SDF "
    "1.11 and refuse the whole model, older ones look for a model of the first part.",
    fix="Write an underscore.",
    bad='<link name="arm::hand"/>',
    good='<link name="arm_hand"/>',
)
def double_colon(subject: Subject) -> Iterator[Problem]:
    """Names of things that become names of SDF."""
    for kind, name, element in _named(subject):
        if "::" in name:
            hint = f"write {name.replace('::', '_')!r}"
            yield Problem(element, f"{kind} {name!r} holds '::', which SDF keeps", "name", hint)
    if "::" in (_robot_name(subject) or ""):
        yield Problem(subject.document.root, "the robot's name holds '::', which SDF keeps", "name")


@rule(
    "MB306",
    "reserved-name",
    ERROR,
    what="A link, a joint or the robot has a name that SDF keeps for itself: __x__, or world for a "
    "joint or the robot.",
    why="sdformat refuses the model: 'The supplied joint name [world] is reserved'. Gazebo spawns "
    "nothing.",
    fix="Give it another name.",
    bad='<link name="__base__"/>',
    good='<link name="_base_"/>',
)
def reserved_name(subject: Subject) -> Iterator[Problem]:
    """A link called world has a rule of its own."""
    for kind, name, element in _named(subject):
        if _is_reserved(name) or (kind == "joint" and name == WORLD):
            yield Problem(element, f"SDF keeps {name!r} for itself: no {kind} may have it", "name")
    robot = _robot_name(subject)
    if robot is not None and (_is_reserved(robot) or robot == WORLD):
        message = f"SDF keeps {robot!r} for itself: no model may have it"
        yield Problem(subject.document.root, message, "name")


def _is_reserved(name: str) -> bool:
    return len(name) >= 4 and name.startswith("__") and name.endswith("__")


@rule(
    "MB307",
    "world-link",
    WARNING,
    what="A link is called world and is more than the point to which the robot is fixed: it is not "
    "the root, or it has mass or shapes.",
    why="A root called world is the simulation's own world: sdformat leaves its mass and shapes out. "
    "Elsewhere the name is reserved, and a world that moves with the robot breaks every tf tree.",
    fix="Give a link with content another name; fix the robot to an empty root called world.",
    bad='<link name="world"><visual><geometry><sphere radius="1"/></geometry></visual></link>'
    '<link name="a"/><joint name="j" type="fixed"><parent link="world"/><child link="a"/></joint>',
    good='<link name="world"/>'
    '<link name="a"/><joint name="j" type="fixed"><parent link="world"/><child link="a"/></joint>',
)
def world_link(subject: Subject) -> Iterator[Problem]:
    """What is wrong with it, the worst first."""
    link = subject.robot.link.get(WORLD)
    if link is None:
        return
    above = subject.robot.above.get(WORLD, ())
    content = next(
        (it.tag for it in link.element.iterchildren("inertial", "visual", "collision")), ""
    )
    if above:
        message = f"link 'world' is not the root: joint {above[0].name!r} moves it with the robot"
        yield Problem(link.element, message, "name")
    elif content:
        message = f"link 'world' has <{content}>, which Gazebo leaves out"
        yield Problem(link.element, message, "name")


@rule(
    "MB308",
    "link-and-joint-alike",
    WARNING,
    what="A link and a joint have one name, and both become parts of the simulated model.",
    why="SDF has one set of names for them: sdformat says 'name collision' and refuses the model, "
    "so Gazebo does not spawn it.",
    fix="Rename the joint, to NAME_joint as a rule.",
    bad='<link name="a"/><link name="b"/><joint name="b" type="continuous"><parent link="a"/>'
    '<child link="b"/></joint>',
    good='<link name="a"/><link name="b"/><joint name="b_joint" type="continuous">'
    '<parent link="a"/><child link="b"/></joint>',
)
def link_and_joint_alike(subject: Subject) -> Iterator[Problem]:
    """A fixed joint goes when Gazebo merges its links, and so does its child's name."""
    robot = subject.robot
    for joint in robot.joints:
        if joint.name not in robot.link or joint.type == "fixed" or not joint.name.strip():
            continue
        if all(it.type != "fixed" or it.parent == WORLD for it in robot.above.get(joint.name, ())):
            message = f"{joint.name!r} is a joint and a link"
            yield Problem(joint.element, message, "name", f"call it {joint.name + '_joint'!r}")


@rule(
    "MB309",
    "case-twins",
    NOTE,
    what="Two links or two joints differ in nothing but capitals.",
    why="ROS and Gazebo tell them apart; a person, and files named after them on a disk that ignores "
    "capitals, do not.",
    fix="Give one another name.",
    bad='<link name="arm"/><link name="Arm"/>',
    good='<link name="arm"/><link name="arm_2"/>',
)
def case_twins(subject: Subject) -> Iterator[Problem]:
    """The second of each pair."""
    links = {it.name: it.element for it in subject.robot.links}
    joints = {it.name: it.element for it in subject.robot.joints}
    for kind, parts in (("link", links), ("joint", joints)):
        if len({name.lower() for name in parts}) == len(parts):
            continue
        seen: dict[str, str] = {}
        for name, element in parts.items():
            first = seen.setdefault(name.lower(), name)
            if first != name:
                message = f"{kind} {name!r} differs from {first!r} in capitals alone"
                yield Problem(element, message, "name")


@rule(
    "MB310",
    "name-not-ascii",
    NOTE,
    what="The name of a link or joint holds a letter that is not ASCII.",
    why="No ROS name may hold one: rcl refuses topics, nodes and namespaces made of it. Two letters "
    "that look alike are two names.",
    fix="Write letters from a to z.",
    bad='<link name="fühler"/>',
    good='<link name="fuehler"/>',
)
def name_not_ascii(subject: Subject) -> Iterator[Problem]:
    """With the letter, which may look like another one."""
    for kind, name, element in _named(subject):
        if not name.isascii():
            letter = next(it for it in name if not it.isascii())
            code = f"U+{ord(letter):04X}"
            yield Problem(element, f"{kind} {name!r} holds {letter!r} ({code})", "name")


@rule(
    "MB311",
    "robot-name",
    NOTE,
    what="The robot's name is no ROS name: empty, or with blanks, hyphens, dots or a digit in front.",
    why="Spawners take it for the model, and Gazebo puts it into topics like /model/NAME/odometry: "
    "bridged to ROS these are refused, and as a namespace or node name it is, too.",
    fix="Use letters, digits and underscores.",
    bad='<robot name="my-robot"><link name="a"/></robot>',
    good='<robot name="my_robot"><link name="a"/></robot>',
)
def robot_name(subject: Subject) -> Iterator[Problem]:
    """Names with a rule of their own ('::') are left to it."""
    name = _robot_name(subject)
    if name is None or "::" in name or _TOKEN.fullmatch(name):
        return
    hint = f"write {propose_token(name)!r}" if name.strip() else "give it one"
    yield Problem(subject.document.root, f"robot name {name!r} is no ROS name", "name", hint)


@rule(
    "MB312",
    "no-ros-name",
    WARNING,
    what="A topic, service, namespace or node name of a plugin is no name that ROS takes.",
    why="rcl throws InvalidTopicNameError, or the node is not made: the plugin does not load, or "
    "publishes nothing.",
    fix="Use letters, digits, underscores and slashes, no digit in front.",
    bad='<gazebo><plugin name="p" filename="libgazebo_ros_imu_sensor.so"><ros>'
    "<namespace>my-robot</namespace></ros></plugin></gazebo>",
    good='<gazebo><plugin name="p" filename="libgazebo_ros_imu_sensor.so"><ros>'
    "<namespace>my_robot</namespace></ros></plugin></gazebo>",
)
def no_ros_name(subject: Subject) -> Iterator[Problem]:
    """Claimed values that a ROS namespace reaches; what has a substitution in it is left alone."""
    for claim in subject.inventory.claims:
        site = claim.site
        if not site.namespaced or site.kinds[0] not in SPOKEN:
            continue
        for name in _spoken(claim):
            if fault := _name_fault(name, site.section):
                message = f"{site.kinds[0]} {name!r} is no ROS name: {fault}"
                yield Problem(claim.element, message, claim.attribute)


def _spoken(claim: Claim) -> list[str]:
    """The names in a value: itself, or both sides of a remap rule."""
    sides = [claim.value] if claim.site.form == "whole" else []
    if claim.site.form in ("remap", "argument"):
        rule = split_remap(claim.value)
        sides = [rule.source, rule.target] if rule and not rule.source.startswith("__") else []
    return [it for it in sides if it.strip("/") and NOT_PLAIN.isdisjoint(it.replace(" ", ""))]


def _name_fault(name: str, section: str) -> str:
    """What rcl says of a name; of a plugin that may be ROS 1's or Gazebo's, what none of them takes."""
    if _SPOKEN.fullmatch(name) and not section.startswith("block ros"):
        return ""
    fault = check_topic_name(name.rstrip("/"))
    return fault.reason if fault else ""


@rule(
    "MB313",
    "odd-interface-name",
    WARNING,
    what="A <ros2_control> component or interface has an empty name, or one with white space.",
    why="Controllers ask for NAME/INTERFACE, spelled exactly: the parser strips blanks around a "
    "name, those within it stay, and an empty one can be asked for by nobody.",
    fix="Write the name without blanks.",
    bad='<ros2_control name="c" type="system"><hardware><plugin>p/P</plugin></hardware>'
    '<joint name="j"><state_interface name=""/></joint></ros2_control>',
    good='<ros2_control name="c" type="system"><hardware><plugin>p/P</plugin></hardware>'
    '<joint name="j"><state_interface name="position"/></joint></ros2_control>',
)
def odd_interface(subject: Subject) -> Iterator[Problem]:
    """Components and their interfaces; a joint's own name is told where it is declared."""
    for system in subject.elements.every("ros2_control"):
        for it in system.iter(
            "ros2_control", "sensor", "gpio", "command_interface", "state_interface"
        ):
            name = it.get("name")
            if name is not None and (not name.strip() or _BLANK.search(name.strip())):
                yield Problem(it, f"<{it.tag}> has the name {name!r}", "name")


@rule(
    "MB320",
    "no-usd-name",
    WARNING,
    what="A name is no USD identifier (asked with the target usd).",
    why="A prim is called by letters, digits and underscores, no digit in front: converters to USD "
    "replace the rest, and what looks for the URDF's name in the stage finds nothing.",
    fix="Write underscores for what is not a letter or digit.",
    bad='<link name="left/wheel"/>',
    good='<link name="left_wheel"/>',
    options={"targets": ("usd",)},
)
def no_usd_name(subject: Subject) -> Iterator[Problem]:
    """With what a converter makes of it, where that is taken."""
    if "usd" not in subject.settings.targets:
        return
    names = {name for _, name, _ in _named(subject)}
    for kind, name, element in _named(subject):
        if name.strip() and not _TOKEN.fullmatch(name):
            made = re.sub(r"\W", "_", name, flags=re.ASCII)
            made = f"_{made}" if made[0].isdigit() else made
            taken = ", which is there already" if made in names else ""
            message = f"{kind} {name!r} is no USD identifier: it becomes {made!r}{taken}"
            yield Problem(element, message, "name", f"write {made!r}")


@rule(
    "MB321",
    "slash-for-mjcf",
    WARNING,
    what="The name of a link or joint holds a slash (asked with the target mjcf).",
    why="MuJoCo takes it; dm_control's mjcf does not: it keeps '/' for the names of attached models, "
    "and raises ValueError when the model is loaded.",
    fix="Write an underscore.",
    bad='<link name="left/wheel"/>',
    good='<link name="left_wheel"/>',
    options={"targets": ("mjcf",)},
)
def slash_for_mjcf(subject: Subject) -> Iterator[Problem]:
    """Links become bodies, joints stay joints."""
    if "mjcf" not in subject.settings.targets:
        return
    for kind, name, element in _named(subject):
        if "/" in name:
            hint = f"write {name.strip('/').replace('/', '_')!r}"
            yield Problem(element, f"{kind} {name!r} holds a slash", "name", hint)
