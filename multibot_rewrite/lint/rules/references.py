"""MB2: names that lead nowhere, or to two things."""

from __future__ import annotations

from bisect import bisect_left
from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping
from functools import lru_cache
from itertools import zip_longest
from typing import TYPE_CHECKING, NamedTuple

from lxml.etree import _Element

from multibot_rewrite.checks.audit import uses_xacro
from multibot_rewrite.checks.references import (
    COMPARED,
    HINTED,
    Loose,
    ambiguous,
    doubtful,
    fold,
    loose_ends,
    remarks,
    repeated,
    where,
)
from multibot_rewrite.checks.remarks import Remark
from multibot_rewrite.lint.records import NOTE, Problem, Subject, rule
from multibot_rewrite.lint.robot import Joint
from multibot_rewrite.model import ERROR, WARNING, Claim
from multibot_rewrite.naming import FRAME_KINDS
from multibot_rewrite.rewriters.spelling import must_be_declared, names_in
from multibot_rewrite.steps.collect import Inventory
from multibot_rewrite.steps.document import locate

if TYPE_CHECKING:
    from multibot_rewrite.sources.trace import Origin

# What may stand in a frame parameter though nothing in the file has it: it is made at run time.
MADE = ("odom", "map", "world")
# The values of a <gazebo> block that the URDF reader takes over, of which a link has one each
# (libsdformat parser_urdf.cc); two spellings of one have the same meaning.
SINGLE = {
    "material": "material",
    "mu1": "mu1",
    "mu2": "mu2",
    "kp": "kp",
    "kd": "kd",
    "maxVel": "max_vel",
    "max_vel": "max_vel",
    "minDepth": "min_depth",
    "min_depth": "min_depth",
    "maxContacts": "max_contacts",
    "max_contacts": "max_contacts",
    "laserRetro": "laser_retro",
    "laser_retro": "laser_retro",
    "selfCollide": "self_collide",
    "self_collide": "self_collide",
    "gravity": "gravity",
    "dampingFactor": "dampingFactor",
    "stopCfm": "stop_cfm",
    "stop_cfm": "stop_cfm",
    "stopErp": "stop_erp",
    "stop_erp": "stop_erp",
    "fudgeFactor": "fudge_factor",
    "fudge_factor": "fudge_factor",
    "implicitSpringDamper": "implicit_spring_damper",
    "implicit_spring_damper": "implicit_spring_damper",
    "provideFeedback": "provide_feedback",
    "provide_feedback": "provide_feedback",
}
# Its joints are those of the simulated robot, not of the URDF.
WEBOTS = "webots_ros2_control::"
# What moves by itself or is moved by no motor.
UNDRIVEN = ("fixed", "floating", "planar", "")
TWO = "<link name='a'/><link name='b'/>"
JOINT = '<link name="a"/><link name="b"/><joint name="j" type="continuous"><parent link="a"/>'
JOINT += '<child link="b"/>'
ARM = f"{JOINT}</joint>"
PAIR = ARM + '<link name="c"/><joint name="k" type="continuous"><parent link="b"/>'
PAIR += '<child link="c"/>{}</joint>'
SYSTEM = '<ros2_control name="s" type="system">{}</ros2_control>'
IMU = '<gazebo reference="{}"><sensor name="{}" type="imu"/></gazebo>'
PLUGIN = '<gazebo><plugin filename="lib{}.so" name="{}">{}</plugin></gazebo>'


class Held(NamedTuple):
    """An inventory as the key of a cache: equal to itself only."""

    inventory: Inventory

    def __hash__(self) -> int:
        """As fast as can be."""
        return id(self.inventory.claims)

    def __eq__(self, other: object) -> bool:
        """The same one, not one alike."""
        return isinstance(other, Held) and self.inventory.claims is other.inventory.claims


class References(NamedTuple):
    """What is worth a second look in a document; ``loose`` are the names nothing declares."""

    doubtful: list[Claim]
    loose: Mapping[str, list[Remark]]


@lru_cache(maxsize=1)
def references(held: Held, shared: Collection[str]) -> References:
    """One pass over the document for all rules of this page.

    What a part of a description names is declared elsewhere; and what xacro was not asked to make
    yet cannot be missed.
    """
    inventory = held.inventory
    claims = doubtful(inventory)
    by_code = defaultdict(list)
    if not uses_xacro(inventory.document):
        ends = loose_ends(claims, inventory.declared, shared)
        loose = [it for it in ends if not _elsewhere(it, inventory)]
        for remark in remarks(loose, inventory.declared):
            by_code[remark.code].append(remark)
    return References(claims, by_code)


def _is_part(inventory: Inventory) -> bool:
    """A file without a link, or a robot without a name: something else includes it."""
    root = inventory.document.root
    return not inventory.declared["link"] or (root.tag == "robot" and "name" not in root.attrib)


def _elsewhere(loose: Loose, inventory: Inventory) -> bool:
    """Is it declared after all: outside of this part, with the robot's own name as a scope, as
    Gazebo Classic takes it, or by the PROTO of a Webots robot?"""
    claim, part = loose
    if _is_part(inventory) and part.kinds[0] != "group":
        return True
    scope, _, name = part.text.rpartition("::")
    if scope and scope == inventory.document.root.get("name"):
        return any(name in inventory.declared.get(kind, ()) for kind in part.kinds)
    if claim.site.section != "element ros2_control":
        return False
    system = next(claim.element.iterancestors("ros2_control"), None)
    class_ = "" if system is None else system.findtext("hardware/plugin", "")
    return class_.strip().startswith(WEBOTS)


def undeclared(subject: Subject, code: str) -> Iterator[Problem]:
    """The names of one theme that nothing declares."""
    for it in _references(subject).loose.get(code, ()):
        yield Problem(it.element, it.message, it.attribute, it.hint)


def _references(subject: Subject) -> References:
    return references(Held(subject.inventory), subject.settings.naming.shared_frames)


def _first_at(subject: Subject, start: int) -> str:
    """Where the first of two stands; in an expanded document no line is one of a file."""
    if subject.origins:
        return ""
    return f", first at line {locate(subject.document.source, start)[0]}"


def _repeated(found: Iterable[tuple[object, _Element]]) -> Iterator[_Element]:
    """The elements whose key was there before."""
    seen = set()
    for key, element in found:
        if key in seen:
            yield element
        seen.add(key)


@rule(
    "MB201",
    "duplicate-name",
    ERROR,
    what="Two links or two joints of one model have the same name.",
    why="urdfdom refuses the file ('link ... is not unique'), and with it robot_state_publisher, "
    "MoveIt and Gazebo; libsdformat refuses an SDF model.",
    fix="Rename one of the two and what refers to it, or delete the copy.",
    bad='<link name="a"/><link name="a"/>',
    good='<link name="a"/>',
)
def duplicate_name(subject: Subject) -> Iterator[Problem]:
    """Every declaration but the first; all that one macro call repeats is told once."""
    calls: dict[object, list[tuple[Claim, Claim]]] = {}
    for claim, first in repeated(subject.inventory):
        cause = _repeating(subject, claim, first) or claim
        calls.setdefault(cause, []).append((claim, first))
    for (claim, first), *more in calls.values():
        text = f"{claim.site.kinds[0]} {claim.value!r} is declared twice"
        also = f", and so are {len(more)} more that the same call makes" if more else ""
        hint = "give each call a prefix of its own" if more else "rename one"
        message = text + _first_at(subject, first.start) + also
        yield Problem(claim.element, message, claim.attribute, hint)


def _repeating(subject: Subject, claim: Claim, first: Claim) -> object:
    """What made xacro write one element twice: the macro call, or the file that is included again."""
    one, other = (_origin(subject, it.start) for it in (first, claim))
    if one is None or other is None or (one.file, one.start) != (other.file, other.start):
        return None
    outer = zip_longest(reversed(other.calls), reversed(one.calls))
    return next((new for new, old in outer if new != old), (other.file, other.calls))


def _origin(subject: Subject, start: int) -> Origin | None:
    if not subject.origins:
        return None
    return subject.origins[bisect_left(subject.document.starts, start)]


@rule(
    "MB202",
    "undeclared-link",
    ERROR,
    what="A joint's parent or child link is not declared.",
    why="urdfdom refuses the file ('parent link ... not found'): no robot_state_publisher, no tf.",
    fix="Correct the name, or declare the link.",
    bad='<link name="b"/><joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>',
    good='<link name="a"/><link name="b"/><joint name="j" type="fixed"><parent link="a"/>'
    '<child link="b"/></joint>',
)
def undeclared_link(subject: Subject) -> Iterator[Problem]:
    """The two links of every joint."""
    return undeclared(subject, "MB202")


@rule(
    "MB203",
    "link-and-joint",
    WARNING,
    what="A <gazebo reference> is the name of a link and of a joint.",
    why="Both get the block where they can use it, and libsdformat refuses a model in which a link "
    "and a joint share a name: Gazebo does not spawn the robot.",
    fix="Rename the joint.",
    bad='<link name="a"/><link name="b"/><joint name="b" type="fixed"><parent link="a"/>'
    '<child link="b"/></joint><gazebo reference="b"/>',
    good='<link name="a"/><link name="b"/><joint name="b_joint" type="fixed"><parent link="a"/>'
    '<child link="b"/></joint><gazebo reference="b"/>',
)
def link_and_joint(subject: Subject) -> Iterator[Problem]:
    """Every such reference."""
    for it in ambiguous(subject.inventory):
        message = it.message.partition(";")[0]
        yield Problem(it.element, message, it.attribute, it.hint)


@rule(
    "MB204",
    "repeated-joint",
    WARNING,
    what="One <ros2_control> has a joint, sensor or gpio of the same name twice.",
    why="The hardware exports one set of interfaces a name: those of the second are mixed up with "
    "the first, or loading ends with 'Tried to insert StateInterface with already existing key'.",
    fix="Put all interfaces of the joint in one element.",
    bad=ARM + SYSTEM.format('<joint name="j"/><joint name="j"/>'),
    good=ARM + SYSTEM.format('<joint name="j"/>'),
)
def repeated_joint(subject: Subject) -> Iterator[Problem]:
    """Components of one kind and name in one system."""
    for system in subject.elements.every("ros2_control"):
        components = system.iterchildren("joint", "sensor", "gpio")
        keys = (((it.tag, _name(it)), it) for it in components if _name(it))
        for it in _repeated(keys):
            message = f"{it.tag} {_name(it)!r} is twice in this <ros2_control>"
            yield Problem(it, message, "name", "put its interfaces in one element")


@rule(
    "MB205",
    "duplicate-hardware",
    ERROR,
    what="Two <ros2_control> elements have one name.",
    why="ros2_control's resource manager refuses the second ('Hardware name ... is duplicated'): "
    "the controller manager does not come up.",
    fix="Give each system, sensor and actuator its own name.",
    bad=ARM + SYSTEM.format('<joint name="j"/>') + SYSTEM.format(""),
    good=ARM + SYSTEM.format('<joint name="j"/>'),
)
def duplicate_hardware(subject: Subject) -> Iterator[Problem]:
    """Every name that was there before."""
    systems = subject.elements.tops("ros2_control")
    for it in _repeated((_name(system), system) for system in systems if _name(system)):
        yield Problem(it, f"there is another <ros2_control> {_name(it)!r}", "name", "rename one")


@rule(
    "MB206",
    "duplicate-sensor",
    ERROR,
    what="Two simulated sensors of one link have the same name.",
    why="libsdformat refuses the model ('sensor with name[...] already exists'), so gz-sim does "
    "not load the robot.",
    fix="Give each sensor of a link its own name.",
    bad='<link name="a"/>' + IMU.format("a", "imu") * 2,
    good='<link name="a"/>' + IMU.format("a", "imu") + IMU.format("a", "imu2"),
)
def duplicate_sensor(subject: Subject) -> Iterator[Problem]:
    """Sensors in blocks for one link."""
    blocks = subject.elements.tops("gazebo")
    sensors = (
        ((block.get("reference"), _name(it)), it)
        for block in blocks
        if block.get("reference")
        for it in block.iterchildren("sensor")
        if _name(it)
    )
    for it in _repeated(sensors):
        link = it.getparent().get("reference")  # type: ignore[union-attr]
        message = f"{link!r} has another sensor {_name(it)!r}"
        yield Problem(it, message, "name", "rename one")


@rule(
    "MB207",
    "duplicate-material",
    ERROR,
    what="Two <material> elements of the robot have one name.",
    why="urdfdom refuses the file ('material ... is not unique'), the same colour or not.",
    fix="Define each material once; links refer to it by name.",
    bad='<link name="a"/>' + '<material name="m"><color rgba="1 0 0 1"/></material>' * 2,
    good='<link name="a"/><material name="m"><color rgba="1 0 0 1"/></material>',
)
def duplicate_material(subject: Subject) -> Iterator[Problem]:
    """Those right below the root; a link may repeat one."""
    materials = subject.elements.tops("material")
    for it in _repeated((it.get("name"), it) for it in materials if it.get("name")):
        message = f"material {it.get('name')!r} is defined twice"
        yield Problem(it, message, "name", "delete one: urdfdom refuses even the same colour")


@rule(
    "MB208",
    "one-node-twice",
    ERROR,
    what="Two plugins of Gazebo Classic have one name and one namespace, and both are ROS nodes.",
    why="gazebo_ros makes no node for the second ('Found multiple nodes with same name') but gives "
    "it a null pointer; plugins such as gazebo_ros_imu_sensor use it at once, and gzserver dies.",
    fix="Give each plugin its own name.",
    bad='<link name="a"/>' + PLUGIN.format("gazebo_ros_imu_sensor", "imu", "<ros/>") * 2,
    good='<link name="a"/>'
    + PLUGIN.format("gazebo_ros_imu_sensor", "imu", "<ros/>")
    + PLUGIN.format("gazebo_ros_imu_sensor", "imu2", "<ros/>"),
)
def one_node_twice(subject: Subject) -> Iterator[Problem]:
    """Plugins whose name is that of a node."""
    nodes = [it for it in subject.inventory.claims if it.site.kinds == ("node",)]
    found = (
        ((it.element.findtext("ros/namespace", "").strip("/ "), it.value.strip()), it.element)
        for it in nodes
        if it.site.path == "@name" and it.element.find("ros") is not None
    )
    for it in _repeated(found):
        message = f"another plugin is the node {_name(it)!r} already"
        yield Problem(it, message, "name", "rename one, or give them namespaces")


@rule(
    "MB209",
    "duplicate-transmission",
    WARNING,
    what="Two transmissions have one name.",
    why="Tools and messages cannot tell them apart; it is what a copy looks like whose name was "
    "forgotten, and its joint often was as well.",
    fix="Rename one, and see whether its joint is the right one.",
    bad=ARM + '<transmission name="t"><joint name="j"/></transmission>' * 2,
    good=ARM + '<transmission name="t"><joint name="j"/></transmission>',
)
def duplicate_transmission(subject: Subject) -> Iterator[Problem]:
    """Those of the robot; those of a <ros2_control> are its own."""
    found = subject.elements.tops("transmission")
    for it in _repeated((_name(it), it) for it in found if _name(it)):
        yield Problem(it, f"there is another transmission {_name(it)!r}", "name", "rename one")


@rule(
    "MB210",
    "contradicting-blocks",
    NOTE,
    what="Two <gazebo> blocks for one link or joint give one property two values.",
    why="Gazebo takes the later one, with a warning at most: which that is hangs on the order of "
    "the blocks.",
    fix="Keep the one that is meant.",
    bad='<link name="a"/><gazebo reference="a"><mu1>1</mu1></gazebo><gazebo reference="a">'
    "<mu1>0.2</mu1></gazebo>",
    good='<link name="a"/><gazebo reference="a"><mu1>1</mu1></gazebo><gazebo reference="a">'
    "<mu2>0.2</mu2></gazebo>",
)
def contradicting_blocks(subject: Subject) -> Iterator[Problem]:
    """The properties a link or joint has one of."""
    values: dict[tuple[str, str], str] = {}
    for block in subject.elements.tops("gazebo"):
        target = block.get("reference", "")
        for it in block if target else ():
            if it.tag not in SINGLE:
                continue
            text = " ".join((it.text or "").split())
            earlier = values.setdefault((target, SINGLE[it.tag]), text)
            if earlier != text:
                message = f"{it.tag} of {target!r} is {text!r} here and was {earlier!r} before"
                yield Problem(it, message, "", "keep one")


@rule(
    "MB211",
    "undeclared-mimic",
    ERROR,
    what="A joint mimics one that is not declared.",
    why="robot_state_publisher never sends the transform of the joint, so tf has no link behind "
    "it; joint_state_publisher stops with a KeyError, MoveIt ignores the mimic.",
    fix="Correct the name.",
    bad=f'{JOINT}<mimic joint="k"/></joint>',
    good=PAIR.format('<mimic joint="j"/>'),
)
def undeclared_mimic(subject: Subject) -> Iterator[Problem]:
    """Names in <mimic>."""
    return undeclared(subject, "MB211")


@rule(
    "MB212",
    "undeclared-reference",
    WARNING,
    what="A <gazebo reference> names neither a link nor a joint.",
    why="Gazebo drops the block without a word: no friction, no sensor, no plugin from it.",
    fix="Correct the name, or delete the block.",
    bad='<link name="wheel"/><gazebo reference="weel"><mu1>1</mu1></gazebo>',
    good='<link name="wheel"/><gazebo reference="wheel"><mu1>1</mu1></gazebo>',
)
def undeclared_reference(subject: Subject) -> Iterator[Problem]:
    """References of <gazebo> blocks."""
    return undeclared(subject, "MB212")


@rule(
    "MB213",
    "undeclared-transmission-joint",
    WARNING,
    what="A <transmission> names a joint that is not declared.",
    why="gazebo_ros_control of ROS 1 loads no hardware at all ('which is not in the gazebo "
    "model'); ROS 2 does not read these transmissions.",
    fix="Correct the name, or delete the transmission.",
    bad=f'{ARM}<transmission name="t"><joint name="jj"/></transmission>',
    good=f'{ARM}<transmission name="t"><joint name="j"/></transmission>',
)
def undeclared_transmission_joint(subject: Subject) -> Iterator[Problem]:
    """Joints of transmissions."""
    return undeclared(subject, "MB213")


@rule(
    "MB214",
    "undeclared-ros2-control-joint",
    ERROR,
    what="A <ros2_control> names a joint that is not declared.",
    why="From Jazzy on the controller manager refuses the description ('Joint ... not found in "
    "URDF'); before, gz_ros2_control left the joint out and its controllers could not start.",
    fix="Correct the name; a quantity that is no joint belongs in a <gpio>.",
    bad=ARM + SYSTEM.format('<joint name="jj"/>'),
    good=ARM + SYSTEM.format('<joint name="j"/>'),
)
def undeclared_ros2_control_joint(subject: Subject) -> Iterator[Problem]:
    """Joints of <ros2_control>, of its transmissions, and those they mimic."""
    return undeclared(subject, "MB214")


@rule(
    "MB215",
    "undeclared-joint-parameter",
    WARNING,
    what="A parameter of a plugin or hardware class names a joint that is not declared.",
    why="The plugin looks the joint up, finds nothing and does not run, or leaves the joint out: "
    "gazebo_ros_diff_drive says 'Joint ... not found, plugin will not work'.",
    fix="Correct the name.",
    bad=ARM + PLUGIN.format("gazebo_ros_diff_drive", "d", "<left_joint>k</left_joint>"),
    good=ARM + PLUGIN.format("gazebo_ros_diff_drive", "d", "<left_joint>j</left_joint>"),
)
def undeclared_joint_parameter(subject: Subject) -> Iterator[Problem]:
    """Parameters that the vocabulary knows for a joint's name."""
    return undeclared(subject, "MB215")


@rule(
    "MB216",
    "undeclared-link-parameter",
    WARNING,
    what="A parameter of a plugin or hardware class names a link that is not declared.",
    why="The plugin looks the link up, finds nothing and does not run: gazebo_ros_p3d says "
    "'body_name: ... does not exist' and publishes nothing.",
    fix="Correct the name.",
    bad='<link name="a"/>' + PLUGIN.format("gazebo_ros_p3d", "p", "<ros/><body_name>b</body_name>"),
    good='<link name="a"/>'
    + PLUGIN.format("gazebo_ros_p3d", "p", "<ros/><body_name>a</body_name>"),
)
def undeclared_link_parameter(subject: Subject) -> Iterator[Problem]:
    """Parameters that the vocabulary knows for a link's name."""
    return undeclared(subject, "MB216")


@rule(
    "MB217",
    "misspelled-frame",
    WARNING,
    what="A frame is not declared, and a link has almost the same name.",
    why="The data is stamped with a frame that tf does not have: every consumer drops it "
    "('frame does not exist').",
    fix="Correct the name; if another node publishes that frame, silence the finding.",
    bad='<link name="base_link"/>'
    + PLUGIN.format("gazebo_ros_p3d", "p", "<ros/><frame_name>base_lnik</frame_name>"),
    good='<link name="base_link"/>'
    + PLUGIN.format("gazebo_ros_p3d", "p", "<ros/><frame_name>base_link</frame_name>"),
)
def misspelled_frame(subject: Subject) -> Iterator[Problem]:
    """Frames one slip away from a link."""
    for claim, name, near in _frames(subject):
        if near:
            message = f"{where(claim)} names the frame {name!r}, which no link has"
            yield Problem(claim.element, message, claim.attribute, f"did you mean {near!r}?")


@rule(
    "MB218",
    "foreign-frame",
    NOTE,
    what="A sensor or plugin stamps its data with a frame that is no link of the robot.",
    why="Unless another node publishes that frame, tf does not have it and every consumer drops "
    "the data.",
    fix="Name a link, or be sure that somebody publishes the frame.",
    bad='<link name="a"/><gazebo reference="a"><sensor name="s" type="imu"><frame_id>imu_frame'
    "</frame_id></sensor></gazebo>",
    good='<link name="a"/><gazebo reference="a"><sensor name="s" type="imu"><frame_id>a</frame_id>'
    "</sensor></gazebo>",
)
def foreign_frame(subject: Subject) -> Iterator[Problem]:
    """Frames that the robot does not have, and that are none of a localisation."""
    for claim, name, near in _frames(subject):
        if not near and not claim.site.default and not name.endswith(MADE):
            message = f"{where(claim)} names the frame {name!r}, which no link has"
            yield Problem(claim.element, message, claim.attribute, "somebody else must publish it")


def _frames(subject: Subject) -> Iterator[tuple[Claim, str, str]]:
    """Frames that nothing declares, and the link that each was meant for, if that can be told."""
    declared = subject.inventory.declared
    links = declared["link"]
    meant: dict[str, str] = {}
    for claim in _references(subject).doubtful if links else ():
        site = claim.site
        if FRAME_KINDS.isdisjoint(site.kinds) or "frame" not in site.kinds:
            continue
        if must_be_declared(site) or site.form != "whole":
            continue
        for name in (part.text for part in names_in(claim, declared)):
            # A frame_prefix or namespace before a link's name is made when the robot is started.
            own = name.rpartition("/")[2]
            known = (it in declared[kind] for it in (own, name) for kind in ("link", *site.kinds))
            if own in MADE or f"/{own}" in links or any(known):
                continue
            if name not in meant:
                meant[name] = _meant(own, links) if len(meant) < HINTED else ""
            yield claim, name, meant[name]


def _meant(name: str, known: Iterable[str]) -> str:
    """The known name that ``name`` is but for one slip in one word of it."""
    folded = fold(name)
    for it, _ in zip(known, range(COMPARED), strict=False):
        other = fold(it)
        if folded == other or _one_slip(folded.split("_"), other.split("_")):
            return it
    return ""


def _one_slip(words: list[str], others: list[str]) -> bool:
    """Do they differ in one long word without digits, by a letter or two letters swapped?"""
    if len(words) != len(others):
        return False
    pairs = [pair for pair in zip(words, others, strict=True) if pair[0] != pair[1]]
    if len(pairs) != 1:
        return False
    one, two = pairs[0]
    if not (one.isalpha() and two.isalpha()) or max(len(one), len(two)) < 4:
        return False
    while one and two and one[0] == two[0]:
        one, two = one[1:], two[1:]
    while one and two and one[-1] == two[-1]:
        one, two = one[:-1], two[:-1]
    return max(len(one), len(two)) == 1 or (len(one) == 2 and one == two[::-1])


@rule(
    "MB219",
    "undeclared-sdf-name",
    WARNING,
    what="An SDF frame, joint or pose names what its model does not have, or a scope a::b leads "
    "nowhere.",
    why="libsdformat refuses the model for a frame, joint or link ('does not match a nested "
    "model, link, joint, or frame name'); a sensor's pose is not resolved.",
    fix="Correct the name; names of an included model need its scope.",
    bad='<link name="a"/><gazebo><frame name="f" attached_to="b"/></gazebo>',
    good='<link name="a"/><gazebo><frame name="f" attached_to="a"/></gazebo>',
)
def undeclared_sdf_name(subject: Subject) -> Iterator[Problem]:
    """Names in SDF's scopes."""
    return undeclared(subject, "MB219")


@rule(
    "MB220",
    "undeclared-name",
    WARNING,
    what="Another element names a link or joint that is not declared: a sensor, gripper, loop "
    "joint, drake or webots element.",
    why="The tool that reads the element looks the name up and finds nothing: it refuses the "
    "element or leaves it out.",
    fix="Correct the name.",
    bad='<link name="a"/><gazebo><gripper name="g"><palm_link>b</palm_link></gripper></gazebo>',
    good='<link name="a"/><gazebo><gripper name="g"><palm_link>a</palm_link></gripper></gazebo>',
)
def undeclared_name(subject: Subject) -> Iterator[Problem]:
    """All places that have no rule of their own."""
    return undeclared(subject, "MB220")


@rule(
    "MB221",
    "padded-reference",
    ERROR,
    what="A name in an attribute has white space before or behind it that the declared name does "
    "not have.",
    why="No reader strips attributes: urdfdom looks for 'base ' with the space, finds nothing and "
    "refuses the file; ros2_control does not find the joint.",
    fix="Delete the white space.",
    bad='<link name="a"/><link name="b"/><joint name="j" type="fixed"><parent link="a "/>'
    '<child link="b"/></joint>',
    good='<link name="a"/><link name="b"/><joint name="j" type="fixed"><parent link="a"/>'
    '<child link="b"/></joint>',
)
def padded_reference(subject: Subject) -> Iterator[Problem]:
    """Attributes that are the name of a link or joint."""
    declared = subject.inventory.declared
    for claim in _references(subject).doubtful:
        name = claim.value.strip()
        if not claim.attribute or name == claim.value or claim.site.form != "whole":
            continue
        found = [declared[kind][name] for kind in claim.site.kinds if name in declared[kind]]
        if found and all(it.value != claim.value for it in found):
            message = f"{where(claim)} is {claim.value!r}, the {claim.site.kinds[0]} is {name!r}"
            yield Problem(claim.element, message, claim.attribute, "delete the white space")


@rule(
    "MB223",
    "transmission-without-joint",
    WARNING,
    what="A <transmission> has no joint.",
    why="transmission_interface and gazebo_ros_control of ROS 1 leave it out ('has no associated "
    "joints'): nothing drives what it was made for.",
    fix="Name the joint, or delete the transmission.",
    bad='<transmission name="t"><actuator name="m"/></transmission>',
    good=f'{ARM}<transmission name="t"><joint name="j"/><actuator name="m"/></transmission>',
)
def transmission_without_joint(subject: Subject) -> Iterator[Problem]:
    """Those of the robot; PR2's have joints by other tags."""
    for it in subject.elements.tops("transmission"):
        if not any("joint" in str(child.tag).lower() for child in it.iterchildren("*")):
            message = f"transmission {it.get('name', '')!r} has no joint"
            yield Problem(it, message, None, "name its joint")


@rule(
    "MB224",
    "driven-fixed-joint",
    ERROR,
    what="A joint of a <ros2_control> is fixed.",
    why="From Jazzy on the controller manager refuses the description ('Fixed joints do not make "
    "sense in ros2_control'); Gazebo removes fixed joints before it looks for them.",
    fix="Take the joint out, or give it a type that moves.",
    bad='<link name="a"/><link name="b"/><joint name="j" type="fixed"><parent link="a"/>'
    '<child link="b"/></joint>' + SYSTEM.format('<joint name="j"/>'),
    good=ARM + SYSTEM.format('<joint name="j"/>'),
)
def driven_fixed_joint(subject: Subject) -> Iterator[Problem]:
    """Joints that ros2_control is to move and that cannot."""
    for it in _components(subject.document.root):
        joint = subject.robot.joint.get(it.get("name", ""))
        if joint is not None and joint.type == "fixed":
            yield Problem(it, f"joint {joint.name!r} is fixed", "name", "take it out")


@rule(
    "MB225",
    "fixed-transmission",
    WARNING,
    what="A transmission drives a fixed joint.",
    why="Gazebo removes fixed joints, so gazebo_ros_control finds none of that name and loads no "
    "hardware at all.",
    fix="Delete the transmission, or give the joint a type that moves.",
    bad='<link name="a"/><link name="b"/><joint name="j" type="fixed"><parent link="a"/>'
    '<child link="b"/></joint><transmission name="t"><joint name="j"/></transmission>',
    good=f'{ARM}<transmission name="t"><joint name="j"/></transmission>',
)
def fixed_transmission(subject: Subject) -> Iterator[Problem]:
    """Joints of transmissions that cannot move."""
    for transmission in subject.elements.tops("transmission"):
        for it in transmission.iterchildren("joint"):
            joint = subject.robot.joint.get(it.get("name", ""))
            if joint is not None and joint.type == "fixed":
                yield Problem(it, f"joint {joint.name!r} is fixed", "name", "nothing moves it")


@rule(
    "MB226",
    "commanded-mimic",
    WARNING,
    what="A joint that mimics another one has a command interface in <ros2_control>.",
    why="From Jazzy on the controller manager refuses the description ('Activated mimic joints "
    'cannot have command interfaces\'), unless the joint says mimic="false".',
    fix='Delete the command interface; mimic="false" if the hardware drives both.',
    bad=PAIR.format('<mimic joint="j"/>')
    + SYSTEM.format(
        '<joint name="j"/><joint name="k"><command_interface name="position"/></joint>'
    ),
    good=PAIR.format('<mimic joint="j"/>')
    + SYSTEM.format('<joint name="j"/><joint name="k"><state_interface name="position"/></joint>'),
)
def commanded_mimic(subject: Subject) -> Iterator[Problem]:
    """Mimicking joints that are commanded by themselves."""
    for it, other in _mimicking(subject):
        if it.find("command_interface") is not None:
            message = f"joint {it.get('name')!r} mimics {other!r} and has a command interface"
            yield Problem(it, message, "name", 'delete the interface, or say mimic="false"')


@rule(
    "MB227",
    "mimic-without-its-joint",
    WARNING,
    what="A joint in <ros2_control> mimics one that is not in the same <ros2_control>.",
    why="From Jazzy on the controller manager refuses the description ('Mimic joint ... not found "
    "in <ros2_control> tag').",
    fix='Put both joints in one <ros2_control>, or say mimic="false".',
    bad=PAIR.format('<mimic joint="j"/>') + SYSTEM.format('<joint name="k"/>'),
    good=PAIR.format('<mimic joint="j"/>') + SYSTEM.format('<joint name="j"/><joint name="k"/>'),
)
def mimic_without_its_joint(subject: Subject) -> Iterator[Problem]:
    """Mimicking joints whose leader is driven elsewhere."""
    beside: dict[_Element, set[str]] = {}
    for it, other in _mimicking(subject):
        system = it.getparent()
        assert system is not None
        if system not in beside:
            beside[system] = {_name(joint) for joint in system.iterchildren("joint")}
        if other not in beside[system]:
            message = f"joint {it.get('name')!r} mimics {other!r}, which is not in here"
            yield Problem(it, message, "name", "put both in one <ros2_control>")


@rule(
    "MB228",
    "undriven-joint",
    NOTE,
    what="Other joints are driven by <ros2_control>, transmissions or plugins, and this one is not.",
    why="Nothing moves it; unless somebody publishes its state all the same, "
    "robot_state_publisher does not send its transform and tf has no link behind it.",
    fix="Add it to <ros2_control>; if it is passive, let somebody publish its state.",
    bad=PAIR.format("") + SYSTEM.format('<joint name="j"/>'),
    good=PAIR.format("") + SYSTEM.format('<joint name="j"/><joint name="k"/>'),
)
def undriven_joint(subject: Subject) -> Iterator[Problem]:
    """One finding a robot: the joints that were forgotten, or are passive."""
    if not subject.elements.tops("ros2_control", "transmission"):
        return
    claims = subject.inventory.claims
    named = {it.value for it in claims if it.site.whole_value_kind == "joint" and _drives(it)}
    left = [it for it in subject.robot.joints if it.name not in named and _moves(it)]
    if left and len(left) < sum(map(_moves, subject.robot.joints)):
        names = ", ".join(it.name for it in left[:5]) + (", ..." if len(left) > 5 else "")
        message = f"{len(left)} joints that move are driven by nothing: {names}"
        yield Problem(left[0].element, message, "name", "passive joints need a state, too")


def _drives(claim: Claim) -> bool:
    return claim.site.role == "uses" and claim.site.section != "element joint"


def _moves(joint: Joint) -> bool:
    return joint.type not in UNDRIVEN and joint.element.find("mimic") is None


def _mimicking(subject: Subject) -> Iterator[tuple[_Element, str]]:
    """Joints in <ros2_control> that follow another one, and which."""
    for it in _components(subject.document.root):
        joint = subject.robot.joint.get(it.get("name", ""))
        mimic = None if joint is None else joint.element.find("mimic")
        if mimic is not None and it.get("mimic", "").strip().lower() not in ("false", "0"):
            yield it, mimic.get("joint", "")


def _components(root: _Element) -> Iterator[_Element]:
    """The joints in <ros2_control>."""
    for system in root.iterchildren("ros2_control"):
        yield from system.iterchildren("joint")


def _name(element: _Element) -> str:
    return element.get("name", "").strip()
