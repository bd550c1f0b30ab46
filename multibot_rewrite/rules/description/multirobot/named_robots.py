# SPDX-License-Identifier: Apache-2.0
"""What a rewrite for the named robots rejects or warns about."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import partial
from typing import TYPE_CHECKING

from multibot_rewrite.base.findings.finding import ERROR, WARNING
from multibot_rewrite.base.findings.rule import SRDF, URDF, rule
from multibot_rewrite.base.naming import Naming, make_naming, overlap
from multibot_rewrite.companions.kinds import MOVEIT, PARAMS
from multibot_rewrite.description.checks import hazards
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.rewriters.spelling import ROBOT_SLOT
from multibot_rewrite.description.steps.collect import Inventory
from multibot_rewrite.rules.description.multirobot.shared import AS_WRITTEN, ONE_TF, TWO
from multibot_rewrite.rules.subject import Subject

if TYPE_CHECKING:
    from multibot_rewrite.description.steps.renames import RenameMap


from typing import TYPE_CHECKING

from multibot_rewrite.rules.facts.memo import memoized

if TYPE_CHECKING:
    from multibot_rewrite.description.steps.renames import RenameMap

Hazard = Callable[[Inventory, "RenameMap"], Iterable[Problem]]
ByNaming = Callable[[Inventory, Naming], Iterable[Problem]]


def _by_naming(hazard: ByNaming) -> Hazard:
    """The same for a check that needs only the naming."""
    return lambda inventory, renames: hazard(inventory, renames.naming)


def _if_robots(hazard: Hazard, subject: Subject) -> Iterator[Problem]:
    """What a rewrite for the named robots warns about; nothing where none are named."""
    if subject.settings.robots:
        yield from hazard(subject.inventory, rename_map(subject))


joints_reordered = rule(
    "MB405",
    "joints-reordered",
    WARNING,
    what="With the robot's name at the end, the joints below one link sort in another order.",
    why="urdfdom sorts sibling joints by name, and pinocchio numbers its configuration vector in "
    "that order: the same code then moves other joints.",
    fix="Put the robot's name in front: affix prefix.",
    bad='<link name="a"/>\n'
    '<link name="b"/>\n'
    '<link name="c"/>\n'
    '<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>\n'
    '<joint name="j2" type="fixed"><parent link="a"/><child link="c"/></joint>\n',
    good='<link name="a"/>\n'
    '<link name="b"/>\n'
    '<link name="c"/>\n'
    '<joint name="i" type="fixed"><parent link="a"/><child link="b"/></joint>\n'
    '<joint name="j" type="fixed"><parent link="a"/><child link="c"/></joint>\n',
    line=5,
    options={"robots": TWO},
)(partial(_if_robots, hazards.reordered))


@rule(
    "MB420",
    "name-taken",
    ERROR,
    what="For one of the robots a name becomes the same as another name in the file.",
    why="The rewritten file would have two links or joints with one name, or an undeclared "
    "reference would get another meaning: urdf-postfix rejects it.",
    fix="Choose another separator or another robot name.",
    bad='<link name="a"/><gazebo reference="a/robot1"/>',
    good='<link name="a"/><gazebo reference="a"/>',
    options={"robots": TWO},
)
def name_taken(subject: Subject) -> Iterator[Problem]:
    """What a rewrite for the robots rejects as MB420."""
    names = subject.settings.robots
    if names:
        from multibot_rewrite.description.checks import robots  # most lints name none

        yield from robots.taken_names(subject.inventory, rename_map(subject), names)


@rule(
    "MB421",
    "robots-share-a-name",
    ERROR,
    what="Two different names in the file become the same name for two of the robots.",
    why="Both robots then publish one tf frame or subscribe to one topic of that name. Each is "
    "moved by the other's commands, and no namespace separates them.",
    fix="Rename a robot or choose another separator.",
    bad='<link name="arm"/><link name="arm_left"/>',
    good='<link name="arm"/><link name="tool"/>',
    options={
        "robots": ("left_b", "b"),
        "naming": make_naming("both", separators={"link": "_"}),
    },
)
def robots_share_a_name(subject: Subject) -> Iterator[Problem]:
    """What a rewrite for the robots rejects as MB421."""
    naming, names = subject.settings.naming, subject.settings.robots
    pairs = overlap(naming, names) if len(names) > 1 else []
    if pairs:
        from multibot_rewrite.description.checks import robots

        yield from robots.meeting(subject.inventory, rename_map(subject), pairs)


prefix_only = rule(
    "MB422",
    "prefix-only",
    WARNING,
    what="A parameter of hardware or of a node, or the link_prefix of an IKFast solver, is put in "
    "front of names. But the robot's name goes at the end of names.",
    why="The driver or node makes names of joints, sensors, gpios or frames from that prefix. A "
    "postfix cannot be added to them, so the second robot's are the same as the first one's.",
    fix="Put the robot's name in front: affix prefix.",
    bad='<ros2_control name="h" type="system">\n'
    "  <hardware>\n"
    "    <plugin>ur_robot_driver/URPositionHardwareInterface</plugin>\n"
    '    <param name="tf_prefix">a_</param>\n'
    "  </hardware>\n"
    "</ros2_control>\n",
    good='<ros2_control name="h" type="system">\n'
    "  <hardware><plugin>mock_components/GenericSystem</plugin></hardware>\n"
    "</ros2_control>\n",
    line=4,
    formats=(URDF, PARAMS, MOVEIT),
    options={"robots": TWO},
)(partial(_if_robots, _by_naming(hazards.prefix_only)))

off_the_shared_tf = rule(
    "MB423",
    "off-the-shared-tf",
    WARNING,
    what="A remap rule moves a plugin off the /tf topic that the robots share.",
    why="Its transforms are on a topic without a subscriber: the robot's odometry frame is missing "
    "from the tree.",
    fix="Delete the rule, or use the layout both.",
    bad="<gazebo>\n"
    '  <plugin name="d" filename="libgazebo_ros_diff_drive.so">\n'
    "    <ros><remapping>/tf:=tf</remapping></ros>\n"
    "  </plugin>\n"
    "</gazebo>\n",
    good='<gazebo><plugin name="d" filename="libgazebo_ros_diff_drive.so"><ros/></plugin></gazebo>',
    line=3,
    options={"robots": TWO, "naming": ONE_TF},
)(partial(_if_robots, _by_naming(hazards.moved_tf)))


@rule(
    "MB424",
    "collision-number-unstable",
    ERROR,
    what="The number in the name of a contact sensor's collision depends on how the robot's name "
    "sorts.",
    why="sdformat numbers merged collisions in the order of the joints' names: the sensor would "
    "listen to different parts for different robots.",
    fix="Put the robot's name in front (affix prefix), or keep the fixed joints separate with "
    "preserveFixedJoint.",
    bad='<link name="a">\n'
    '  <collision><geometry><sphere radius="1"/></geometry></collision>\n'
    "</link>\n"
    '<link name="b">\n'
    '  <collision><geometry><sphere radius="1"/></geometry></collision>\n'
    "</link>\n"
    '<link name="c">\n'
    '  <collision><geometry><sphere radius="1"/></geometry></collision>\n'
    "</link>\n"
    '<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>\n'
    '<joint name="j_n" type="fixed"><parent link="a"/><child link="c"/></joint>\n'
    '<gazebo reference="a">\n'
    '  <sensor name="s" type="contact">\n'
    "    <contact><collision>a_fixed_joint_lump__b_collision_1</collision></contact>\n"
    "  </sensor>\n"
    "</gazebo>\n",
    good='<link name="a">\n'
    '  <collision><geometry><sphere radius="1"/></geometry></collision>\n'
    "</link>\n"
    '<gazebo reference="a">\n'
    '  <sensor name="s" type="contact">\n'
    "    <contact><collision>a_collision</collision></contact>\n"
    "  </sensor>\n"
    "</gazebo>\n",
    line=14,
    options={"robots": TWO},
)
def collision_number_unstable(subject: Subject) -> Iterator[Problem]:
    """Contacts that a rewrite rejects as MB424."""
    if not subject.settings.robots or subject.document.root.find(".//contact") is None:
        return
    from multibot_rewrite.description.rewriters.contact import respell_collisions
    from multibot_rewrite.description.steps.plan import LAST
    from multibot_rewrite.description.steps.renames import respeller

    document, claims, _, declared, *_ = subject.inventory
    renames = rename_map(subject)
    first, last = (
        respell_collisions(document.root, claims, declared, respeller(renames, name))
        for name in (ROBOT_SLOT, LAST)
    )
    for (claim, text), (_, other) in zip(first, last, strict=False):
        if text != other.replace(LAST, ROBOT_SLOT):
            message = f"the number in {claim.value!r} would depend on how the robot's name sorts"
            yield Problem(claim.element, message, claim.attribute, "use affix prefix")


@rule(
    "MB426",
    "process-wide-rule",
    WARNING,
    what="A remap rule of a control plugin has an absolute target, or the robots' topics differ "
    "only by such rules.",
    why="On Humble gazebo_ros2_control and ign_ros2_control apply their remap rules to the whole "
    "Gazebo process. The first robot's rule also moves the second robot's topic, to the first "
    "one's name. Since Jazzy the controller manager of each robot has its own rules.",
    fix="Use a relative target, which ends in each robot's own namespace; separate the robots by "
    "namespaces.",
    bad="<gazebo>\n"
    '  <plugin name="c" filename="ign_ros2_control-system">\n'
    "    <ros><remapping>/tf:=/robot1/tf</remapping></ros>\n"
    "  </plugin>\n"
    "</gazebo>\n",
    good="<gazebo>\n"
    '  <plugin name="c" filename="ign_ros2_control-system">\n'
    "    <ros><remapping>/tf:=tf</remapping></ros>\n"
    "  </plugin>\n"
    "</gazebo>\n",
    line=3,
    options={"distro": "humble"},
)
def process_wide_rule(subject: Subject) -> Iterator[Problem]:
    """Rules that apply to other robots' nodes; if no robots are named, those with absolute targets."""
    settings = subject.settings
    naming = settings.naming if settings.robots else AS_WRITTEN
    yield from hazards.process_wide(subject.inventory, naming)


fixed_to_own_frame = rule(
    "MB427",
    "fixed-to-own-frame",
    WARNING,
    what="An SRDF fixes the robot to a frame that is renamed for each robot.",
    why="Each move_group then plans in its own frame, which no node publishes. The robots do not "
    "know each other's pose, and lookups from the world fail.",
    fix="Add the frame to the shared frames.",
    bad='<robot name="r">\n'
    '  <virtual_joint name="v" type="fixed" parent_frame="floor" child_link="a"/>\n'
    "</robot>\n",
    good='<robot name="r">\n'
    '  <virtual_joint name="v" type="fixed" parent_frame="world" child_link="a"/>\n'
    "</robot>\n",
    line=2,
    formats=(SRDF,),
    beside={"r.urdf": '<robot name="r"><link name="a"/></robot>'},
    options={"robots": TWO, "urdf": "r.urdf"},
)(partial(_if_robots, hazards.outside_frames))

hard_wired_name = rule(
    "MB428",
    "hard-wired-name",
    WARNING,
    what="A plugin's code, or PX4, looks for a fixed name, which is renamed for each robot.",
    why="It does not find the new name and stops, or moves nothing: it has no parameter for "
    "another name.",
    fix="Keep the names as they are and separate the robots by tf topics: layout tf-per-robot. Or take "
    "frame-prefix, where all robots would have the same text.",
    bad='<link name="a"/>\n'
    '<link name="b"/>\n'
    '<joint name="right_front" type="continuous">\n'
    '  <parent link="a"/>\n'
    '  <child link="b"/>\n'
    "</joint>\n"
    '<gazebo><plugin name="s" filename="libSkidSteerDrivePlugin.so"/></gazebo>\n',
    good='<link name="a"/>\n'
    '<link name="b"/>\n'
    '<joint name="wheel" type="continuous"><parent link="a"/><child link="b"/></joint>\n'
    '<gazebo><plugin name="s" filename="libSkidSteerDrivePlugin.so"/></gazebo>\n',
    line=7,
    options={"robots": TWO},
)(partial(_if_robots, hazards.hardwired))


@memoized
def rename_map(subject: Subject) -> RenameMap:
    """The rename map of a subject, made once."""
    from multibot_rewrite.description.steps.renames import make_renames  # most lints name no robots

    return make_renames(subject.inventory, subject.settings.naming)
