"""What a rewrite for the named robots refuses or warns about."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import partial

from multibot_rewrite.checks import hazards, robots
from multibot_rewrite.checks.remarks import Remark
from multibot_rewrite.findings.finding import ERROR, WARNING
from multibot_rewrite.findings.rule import SRDF, rule
from multibot_rewrite.lint.records import Problem, Subject
from multibot_rewrite.lint.rules.multirobot.shared import AS_WRITTEN, ONE_TF, TWO
from multibot_rewrite.lint.rules.shared import problems
from multibot_rewrite.naming import Naming, make_naming, overlap
from multibot_rewrite.rewriters.spelling import ROBOT_SLOT
from multibot_rewrite.steps.collect import Inventory
from multibot_rewrite.steps.renames import RenameMap, make_renames

Hazard = Callable[[Inventory, RenameMap], Iterable[Remark]]
ByNaming = Callable[[Inventory, Naming], Iterable[Remark]]


def renames_of(subject: Subject) -> RenameMap:
    """How each name of the description is spelled for the named robots."""
    return make_renames(subject.inventory, subject.settings.naming)


def _by_naming(hazard: ByNaming) -> Hazard:
    """The same for what needs no spelled name."""
    return lambda inventory, renames: hazard(inventory, renames.naming)


def _if_robots(hazard: Hazard, subject: Subject) -> Iterator[Problem]:
    """What a rewrite for the named robots warns about; nothing where none are named."""
    if subject.settings.robots:
        yield from problems(hazard(subject.inventory, renames_of(subject)))


joints_reordered = rule(
    "MB405",
    "joints-reordered",
    WARNING,
    what="With the robot's name behind them, the joints below one link sort in another order.",
    why="urdfdom keeps sibling joints sorted by name and pinocchio numbers its configuration vector "
    "so: the same code then moves other joints.",
    fix="Spell the robot's name in front: affix prefix.",
    bad='<link name="a"/><link name="b"/><link name="c"/>'
    '<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>'
    '<joint name="j2" type="fixed"><parent link="a"/><child link="c"/></joint>',
    good='<link name="a"/><link name="b"/><link name="c"/>'
    '<joint name="i" type="fixed"><parent link="a"/><child link="b"/></joint>'
    '<joint name="j" type="fixed"><parent link="a"/><child link="c"/></joint>',
    options={"robots": TWO},
)(partial(_if_robots, hazards.reordered))


@rule(
    "MB420",
    "name-taken",
    ERROR,
    what="A name becomes, for one of the robots, what another name of the file is already.",
    why="The rewritten file would hold two links or joints of one name, or give a dangling "
    "reference another meaning: urdf-postfix refuses it.",
    fix="Choose another separator or another robot name.",
    bad='<link name="a"/><gazebo reference="a/robot1"/>',
    good='<link name="a"/><gazebo reference="a"/>',
    options={"robots": TWO},
)
def name_taken(subject: Subject) -> Iterator[Problem]:
    """What a rewrite for the robots refuses as MB420."""
    names = subject.settings.robots
    if names:
        yield from problems(robots.taken_names(subject.inventory, renames_of(subject), names))


@rule(
    "MB421",
    "robots-share-a-name",
    ERROR,
    what="Two different names of the file come out alike for two of the robots.",
    why="Both robots then publish one tf frame or obey one topic of that name: each is moved by "
    "the other, and no namespace shows it.",
    fix="Rename a robot or choose another separator.",
    bad='<link name="arm"/><link name="arm_left"/>',
    good='<link name="arm"/><link name="tool"/>',
    options={
        "robots": ("left_b", "b"),
        "naming": make_naming("both", separators={"link": "_"}),
    },
)
def robots_share_a_name(subject: Subject) -> Iterator[Problem]:
    """What a rewrite for the robots refuses as MB421."""
    naming, names = subject.settings.naming, subject.settings.robots
    pairs = overlap(naming, names) if len(names) > 1 else []
    for it in robots.meeting(subject.inventory, renames_of(subject), pairs):
        yield Problem(subject.document.root, it.message, None, it.hint)


prefix_only = rule(
    "MB422",
    "prefix-only",
    WARNING,
    what="A parameter is put in front of names in code, where the robots' names stand behind.",
    why="The driver makes its joint, sensor and gpio names from that prefix: a postfix cannot reach "
    "them, so the second robot's interfaces are called as the first one's.",
    fix="Spell the robot's name in front: affix prefix.",
    bad='<ros2_control name="h" type="system"><hardware><plugin>'
    "ur_robot_driver/URPositionHardwareInterface</plugin>"
    '<param name="tf_prefix">a_</param></hardware></ros2_control>',
    good='<ros2_control name="h" type="system"><hardware><plugin>'
    "mock_components/GenericSystem</plugin></hardware></ros2_control>",
    options={"robots": TWO},
)(partial(_if_robots, _by_naming(hazards.prefix_only)))

off_the_shared_tf = rule(
    "MB423",
    "off-the-shared-tf",
    WARNING,
    what="A remap rule takes a plugin off the one /tf that the robots share.",
    why="Its transforms are on a topic nobody hears: the robot's odometry frame is missing from the "
    "tree.",
    fix="Drop the rule, or use the layout both.",
    bad='<gazebo><plugin name="d" filename="libgazebo_ros_diff_drive.so"><ros><remapping>/tf:=tf'
    "</remapping></ros></plugin></gazebo>",
    good='<gazebo><plugin name="d" filename="libgazebo_ros_diff_drive.so"><ros/></plugin></gazebo>',
    options={"robots": TWO, "naming": ONE_TF},
)(partial(_if_robots, _by_naming(hazards.moved_tf)))


@rule(
    "MB424",
    "collision-number-unstable",
    ERROR,
    what="The number in a contact sensor's collision depends on how the robot's name sorts.",
    why="sdformat numbers lumped collisions in the order of the joints' names: for one robot the "
    "sensor would listen to another part than for the next.",
    fix="Spell the robot's name in front (affix prefix), or keep the fixed joints apart with "
    "preserveFixedJoint.",
    bad='<link name="a"><collision><geometry><sphere radius="1"/></geometry></collision></link>'
    '<link name="b"><collision><geometry><sphere radius="1"/></geometry></collision></link>'
    '<link name="c"><collision><geometry><sphere radius="1"/></geometry></collision></link>'
    '<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>'
    '<joint name="j_n" type="fixed"><parent link="a"/><child link="c"/></joint>'
    '<gazebo reference="a"><sensor name="s" type="contact"><contact>'
    "<collision>a_fixed_joint_lump__b_collision_1</collision></contact></sensor></gazebo>",
    good='<link name="a"><collision><geometry><sphere radius="1"/></geometry></collision></link>'
    '<gazebo reference="a"><sensor name="s" type="contact"><contact>'
    "<collision>a_collision</collision></contact></sensor></gazebo>",
    options={"robots": TWO},
)
def collision_number_unstable(subject: Subject) -> Iterator[Problem]:
    """Contacts that a rewrite refuses as MB424."""
    if not subject.settings.robots or subject.document.root.find(".//contact") is None:
        return
    from multibot_rewrite.rewriters.contact import respell_collisions
    from multibot_rewrite.steps.plan import LAST
    from multibot_rewrite.steps.renames import respeller

    document, claims, _, declared, *_ = subject.inventory
    renames = renames_of(subject)
    first, last = (
        respell_collisions(document.root, claims, declared, respeller(renames, name))
        for name in (ROBOT_SLOT, LAST)
    )
    for (claim, text), (_, other) in zip(first, last, strict=False):
        if text != other.replace(LAST, ROBOT_SLOT):
            message = f"the number in {claim.value!r} would depend on how the robot's name sorts"
            yield Problem(claim.element, message, claim.attribute, "use affix prefix")


sensor_names_meet = rule(
    "MB425",
    "sensor-names-meet",
    WARNING,
    what="Sensors are looked up by bare name in the whole world, and the robots' names for them do "
    "not differ.",
    why="gz_ros2_control takes the first IMU of that name, the realsense and kobuki plugins find "
    "none where two have it: the second robot reads the first one's data, or nothing.",
    fix="Use the layout both, which spells sensors for each robot.",
    bad='<link name="a"/><gazebo reference="a"><sensor name="imu" type="imu"/></gazebo>'
    '<ros2_control name="h" type="system"><hardware><plugin>gz_ros2_control/GazeboSimSystem'
    '</plugin></hardware><sensor name="imu"/></ros2_control>',
    good='<link name="a"/><gazebo reference="a"><sensor name="imu" type="imu"/></gazebo>',
    options={"robots": TWO, "naming": AS_WRITTEN},
)(partial(_if_robots, _by_naming(hazards.bare_lookups)))


@rule(
    "MB426",
    "process-wide-rule",
    WARNING,
    what="A remap rule of a control plugin leads to an absolute name, or the robots' topics differ "
    "by such rules only.",
    why="gazebo_ros2_control and gz_ros2_control hand their rules to the whole Gazebo process: the "
    "first robot's rule also moves the second robot's topic, to the first one's name.",
    fix="Write a relative target, it ends in each robot's own namespace; keep robots apart by "
    "namespaces.",
    bad='<gazebo><plugin name="c" filename="gz_ros2_control-system"><ros><remapping>/tf:=/robot1/tf'
    "</remapping></ros></plugin></gazebo>",
    good='<gazebo><plugin name="c" filename="gz_ros2_control-system"><ros><remapping>/tf:=tf'
    "</remapping></ros></plugin></gazebo>",
)
def process_wide_rule(subject: Subject) -> Iterator[Problem]:
    """Rules that apply to other robots' nodes; if no robots are named, those with absolute targets."""
    settings = subject.settings
    naming = settings.naming if settings.robots else AS_WRITTEN
    yield from problems(hazards.process_wide(subject.inventory, naming))


fixed_to_own_frame = rule(
    "MB427",
    "fixed-to-own-frame",
    WARNING,
    what="An SRDF fixes the robot to a frame that becomes another one for each robot.",
    why="Each move_group then plans in a frame of its own that nothing publishes: the robots do not "
    "see one another's place, and look-ups from the world fail.",
    fix="Add the frame to the shared ones.",
    bad='<robot name="r"><virtual_joint name="v" type="fixed" parent_frame="floor" child_link="a"/>'
    "</robot>",
    good='<robot name="r"><virtual_joint name="v" type="fixed" parent_frame="world" child_link="a"/>'
    "</robot>",
    formats=(SRDF,),
    beside={"r.urdf": '<robot name="r"><link name="a"/></robot>'},
    options={"robots": TWO, "urdf": "r.urdf"},
)(partial(_if_robots, hazards.outside_frames))

hard_wired_name = rule(
    "MB428",
    "hard-wired-name",
    WARNING,
    what="A plugin's code looks for a literal name that the robots' naming changes.",
    why="It finds nothing under the new name and stops, or drives nothing: no element tells it "
    "another one.",
    fix="Keep names as they are and part the robots by tf topics: layout tf-per-robot.",
    bad='<link name="a"/><link name="b"/><joint name="right_front" type="continuous"><parent link='
    '"a"/><child link="b"/></joint><gazebo><plugin name="s" filename="libSkidSteerDrivePlugin.so"/>'
    "</gazebo>",
    good='<link name="a"/><link name="b"/><joint name="wheel" type="continuous"><parent link='
    '"a"/><child link="b"/></joint><gazebo><plugin name="s" filename="libSkidSteerDrivePlugin.so"/>'
    "</gazebo>",
    options={"robots": TWO},
)(partial(_if_robots, hazards.hardwired))
