"""MB4: what the second robot of one description stumbles over."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from lxml.etree import _Element

from multibot_rewrite.checks import hazards, robots
from multibot_rewrite.checks.remarks import Remark
from multibot_rewrite.lazy import lazy_compile
from multibot_rewrite.lint.records import NOTE, SRDF, XACRO, Problem, Subject, rule
from multibot_rewrite.lint.written import claim_is_fixed, is_fixed, starts_of
from multibot_rewrite.model import ERROR, WARNING, Claim, Site
from multibot_rewrite.naming import NOT_PLAIN, TF_TOPICS, make_naming, overlap
from multibot_rewrite.rewriters.insert import insertions
from multibot_rewrite.rewriters.spelling import ROBOT_SLOT
from multibot_rewrite.rewriters.switches import switched_off
from multibot_rewrite.rewriters.tree import library_key
from multibot_rewrite.rosnames import split_remap
from multibot_rewrite.steps.renames import RenameMap, make_renames

TWO = ("robot1", "robot2")
# Frames, tf and topics all per robot: whatever has to be inserted for that, copies share.
APART = make_naming("both")
AS_WRITTEN = make_naming("tf-per-robot")
SPOKEN = ("topic", "service")
RULES_OF_TEXT = ("remap", "argument")
GZ_SECTIONS = ("plugin gz-", "element sensor", "element gazebo", "sensor ")
GZ_LIBRARIES = ("gz-", "gz_", "ign_", "ignition-")
# gz systems that serve every entity of the world, whoever loads them (gz-sim src/systems).
WORLD_SYSTEMS = {
    "gz-sim-sensors-system": "Gazebo crashes when rendering is set up twice",
    "gz-sim-imu-system": "every IMU of the world is published once more for each copy",
    "gz-sim-physics-system": "two physics engines move the same links",
    "gz-sim-contact-system": "every contact sensor is published once more for each copy",
    "gz-sim-forcetorque-system": "every force sensor is published once more for each copy",
    "gz-sim-navsat-system": "every GPS of the world is published once more for each copy",
    "gz-sim-magnetometer-system": "every magnetometer is published once more for each copy",
    "gz-sim-altimeter-system": "every altimeter is published once more for each copy",
    "gz-sim-air-pressure-system": "every barometer is published once more for each copy",
    "gz-sim-scene-broadcaster-system": "every state of the world is sent once more for each copy",
}
DESCRIPTIONS = ("robot_param", "robotParam", "robot_param_node")
DEVICE = lazy_compile(
    r"/dev/\S+|v?can\d+|COM\d+|(?!127\.|0\.0\.0\.0|255\.)\d{1,3}\.\d{1,3}\.\d{1,3}\.\d{1,3}(:\d+)?"
)


def _renames(subject: Subject) -> RenameMap:
    return make_renames(subject.inventory, subject.settings.naming)


def _at(remarks: Iterable[Remark]) -> Iterator[Problem]:
    for it in remarks:
        yield Problem(it.element, it.message, it.attribute, it.hint)


def _claims(subject: Subject, kinds: tuple[str, ...]) -> list[Claim]:
    """Claims whose first kind is one of ``kinds``; only plugins, sensors and hardware have them."""
    if not subject.inventory.hosts:
        return []
    return [it for it in subject.inventory.claims if it.site.kinds[0] in kinds]


def _is_plain(text: str) -> bool:
    """A name, no placeholder and no empty text."""
    return bool(text.strip("/")) and NOT_PLAIN.isdisjoint(text) and not text.startswith("__")


def _tag(claim: Claim) -> str:
    name = claim.element.get("name") if claim.element.tag == "param" else None
    return f"parameter {name!r}" if name else f"<{claim.element.tag}>"


@rule(
    "MB401",
    "absolute-topic",
    NOTE,
    what="A plugin's topic or service is absolute, or its remap rule leads to an absolute one.",
    why="A ROS namespace moves relative names only (rcl expand_topic_name.c): both robots obey one "
    "/cmd_vel and their sensors are mixed on one topic.",
    fix="Leave out the leading slash and start each robot in its namespace; urdf-postfix spells it "
    "for each robot.",
    bad='<gazebo><plugin name="d" filename="libgazebo_ros_diff_drive.so"><ros><remapping>'
    "cmd_vel:=/cmd_vel</remapping></ros></plugin></gazebo>",
    good='<gazebo><plugin name="d" filename="libgazebo_ros_diff_drive.so"><ros><remapping>'
    "cmd_vel:=drive</remapping></ros></plugin></gazebo>",
)
def absolute_topic(subject: Subject) -> Iterator[Problem]:
    """ROS names that start with a slash and are not shared on purpose."""
    wide = _process_wide(subject)
    for claim in _claims(subject, SPOKEN):
        name = _target(claim)
        if name[:1] != "/" or not _is_plain(name) or _is_gz(claim):
            continue
        if name.strip("/") in subject.settings.naming.shared_topics | set(TF_TOPICS):
            continue
        # There MB426 says more.
        if claim.site.form in RULES_OF_TEXT and wide and wide.intersection(_above(claim)):
            continue
        if claim_is_fixed(subject, claim):
            message = f"{_tag(claim)} {name!r} is absolute: a namespace does not move it"
            hint = f"{name[1:]!r} follows the robot's namespace"
            yield Problem(claim.element, message, claim.attribute, hint)


def _above(claim: Claim) -> Iterator[_Element]:
    return claim.element.iterancestors("plugin")


def _target(claim: Claim) -> str:
    """The topic a claim names: of a remap rule where it leads to."""
    if claim.site.form not in RULES_OF_TEXT:
        return claim.value.strip()
    found = split_remap(claim.value)
    return found.target if found else ""


def _process_wide(subject: Subject) -> set[_Element]:
    hosts = subject.inventory.hosts
    return {it.element for it in hosts if it.node.section and it.node.section.process_wide}


def _is_gz(claim: Claim) -> bool:
    return claim.site.section.startswith(GZ_SECTIONS)


@rule(
    "MB402",
    "gz-topic-shared",
    NOTE,
    what="A sensor or system of gz-sim has a topic that is the same for every copy of the robot.",
    why="gz topics are global in their partition and no ROS namespace reaches them: one command "
    "drives both robots, both lidars publish on one topic and ros_gz_bridge cannot part them.",
    fix="Leave the element out, gz then puts the model's name into the topic, or give each robot its "
    "own through a xacro argument or urdf-postfix.",
    bad='<link name="a"/><gazebo reference="a"><sensor name="l" type="gpu_lidar">'
    "<topic>scan</topic></sensor></gazebo>",
    good='<link name="a"/><gazebo reference="a"><sensor name="l" type="gpu_lidar"/></gazebo>',
)
def gz_topic_shared(subject: Subject) -> Iterator[Problem]:
    """Literal gz topics."""
    claims = [it for it in _claims(subject, SPOKEN) if _is_gz(it)]
    if not claims or _is_classic(subject):
        return
    for claim in claims:
        topic = claim.value.strip()
        if not _is_plain(topic) or topic.strip("/") in subject.settings.naming.shared_topics:
            continue
        if not claim_is_fixed(subject, claim):
            continue
        message = f"{_tag(claim)} {topic!r} is one gz topic for every copy of the robot"
        yield Problem(claim.element, message, claim.attribute, "leave it out or spell it per robot")


def _is_classic(subject: Subject) -> bool:
    """Is it for Gazebo Classic, which puts the model's name before sensor topics itself?"""
    hosts = (it.element for it in subject.inventory.hosts)
    keys = [library_key(it.get("filename", "")) for it in hosts if it.tag == "plugin"]
    return bool(keys) and not any(key.startswith(GZ_LIBRARIES) for key in keys)


@rule(
    "MB403",
    "hard-coded-namespace",
    NOTE,
    what="A plugin's namespace is written out in the description.",
    why="Both copies put their nodes and topics under it: in Gazebo Classic of ROS 2 the second "
    "node of one name is refused (gazebo_ros node.hpp), in ROS 1 both answer on one topic.",
    fix="Make it a xacro argument, or let urdf-postfix put each robot's name in front; "
    "spawn_entity.py -robot_namespace overwrites it.",
    bad='<gazebo><plugin name="d" filename="libgazebo_ros_diff_drive.so"><ros><namespace>/demo'
    "</namespace></ros></plugin></gazebo>",
    good='<gazebo><plugin name="d" filename="libgazebo_ros_diff_drive.so"><ros/></plugin></gazebo>',
)
def hard_coded_namespace(subject: Subject) -> Iterator[Problem]:
    """Each literal namespace, where it stands first."""
    found: dict[str, list[Claim]] = {}
    for claim in _claims(subject, ("namespace",)):
        if _is_plain(claim.value) and claim_is_fixed(subject, claim):
            found.setdefault(claim.value, []).append(claim)
    for value, claims in found.items():
        where = f" in {len(claims)} plugins" if len(claims) > 1 else ""
        message = f"the namespace {value!r}{where} is the same for every copy of the robot"
        yield Problem(claims[0].element, message, claims[0].attribute, "make it a xacro argument")


@rule(
    "MB404",
    "robot-name-in-frame",
    WARNING,
    what="A frame is the name of a link with a robot's name in front, which the links do not have.",
    why="Only with that frame_prefix does the frame exist: the second robot's data is stamped with "
    "the first one's frame and placed on it, and a rewrite cannot know what was meant.",
    fix="Write the link's own name and let frame_prefix or urdf-postfix spell it, or make the "
    "name in front a xacro argument.",
    bad='<link name="laser"/><gazebo reference="laser"><sensor name="l" type="gpu_lidar">'
    "<gz_frame_id>robot1/laser</gz_frame_id></sensor></gazebo>",
    good='<link name="laser"/><gazebo reference="laser"><sensor name="l" type="gpu_lidar">'
    "<gz_frame_id>laser</gz_frame_id></sensor></gazebo>",
)
def robot_name_in_frame(subject: Subject) -> Iterator[Problem]:
    """Frames that are no link, but one with something and a slash in front."""
    links = subject.inventory.declared["link"]
    for claim in subject.inventory.claims if subject.inventory.hosts else ():
        value = claim.value.strip("/")
        if "/" not in value or "frame" not in claim.site.kinds or value in links:
            continue
        link = value.partition("/")[2].strip("/")
        if link in links and _is_plain(value) and claim_is_fixed(subject, claim):
            message = f"frame {claim.value!r} holds a robot's name, the link is called {link!r}"
            yield Problem(claim.element, message, claim.attribute, f"write {link!r}")


@rule(
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
)
def joints_reordered(subject: Subject) -> Iterator[Problem]:
    """Links whose joints change their order under the robots' naming."""
    if subject.settings.robots:
        yield from _at(hazards.reordered(subject.inventory, _renames(subject)))


@rule(
    "MB406",
    "default-frame-shared",
    NOTE,
    what="A plugin publishes a frame by its default, which is the same for every robot.",
    why="gazebo_ros_diff_drive and its like broadcast odom -> base_footprint without asking for a "
    "namespace or prefix: on one /tf two robots pull one base to two places.",
    fix="Say the frame and give each robot its own; urdf-postfix inserts it.",
    bad='<gazebo><plugin name="d" filename="libgazebo_ros_diff_drive.so"><robot_base_frame>base'
    "</robot_base_frame></plugin></gazebo>",
    good='<gazebo><plugin name="d" filename="libgazebo_ros_diff_drive.so"><robot_base_frame>base'
    "</robot_base_frame><odometry_frame>r1/odom</odometry_frame></plugin></gazebo>",
)
def default_frame_shared(subject: Subject) -> Iterator[Problem]:
    """Frames that would have to be inserted for a robot."""
    for element, item in _inserted(subject):
        if item[0] in ("frame", "link"):
            message = f"without <{item[2]}> the plugin uses {item[1]!r}, as every other robot's"
            yield Problem(element, message, None, f"say <{item[2]}> for each robot")


def _inserted(subject: Subject) -> Iterator[tuple[_Element, tuple[str, str, str]]]:
    """Kind, default and tag of what urdf-postfix would insert, but for namespaces."""
    declared = subject.inventory.declared
    for host in subject.inventory.hosts:
        section = host.node.section
        if section is None or not any(map(_may_insert, section.sites)):
            continue
        for it in insertions(host.element, section, declared, APART):
            tag = it.xml[1:].partition(">")[0].partition(" ")[0]
            if it.kind != "namespace" and tag != "remapping":
                yield host.element, (it.kind, it.old, tag)


def _may_insert(site: Site) -> bool:
    return bool(site.default) and "namespace" not in site.kinds


@rule(
    "MB407",
    "fixed-odometry-frame",
    NOTE,
    what="An odometry frame is written out, so that every copy of the robot has it.",
    why="Two robots on one /tf then have one frame odom between them: the trees grow together and "
    "every look-up through it is wrong for one of them.",
    fix="Spell it for each robot: a xacro argument, or urdf-postfix; with a tf topic for each robot "
    "it may stay.",
    bad='<gazebo><plugin name="d" filename="libgazebo_ros_diff_drive.so"><odometry_frame>odom'
    "</odometry_frame><robot_base_frame>b</robot_base_frame></plugin></gazebo>",
    good='<link name="b"/><gazebo><plugin name="p" filename="libgazebo_ros_p3d.so"><frame_name>'
    "world</frame_name><body_name>b</body_name></plugin></gazebo>",
)
def fixed_odometry_frame(subject: Subject) -> Iterator[Problem]:
    """Literal odometry frames that are no links and hold no robot's name."""
    if not subject.inventory.hosts:
        return
    links, shared = subject.inventory.declared["link"], subject.settings.naming.shared_frames
    for claim in subject.inventory.claims:
        if "frame" not in claim.site.kinds or claim.site.form != "whole":
            continue
        name = claim.value.strip("/")
        if "odom" not in _words(claim) or {name, name.rpartition("/")[2]} & (links.keys() | shared):
            continue
        if _is_plain(name) and claim_is_fixed(subject, claim):
            message = f"{_tag(claim)} {claim.value!r} is one frame for every copy of the robot"
            yield Problem(claim.element, message, claim.attribute, "spell it for each robot")


def _words(claim: Claim) -> str:
    return f"{claim.value} {claim.site.path}".lower()


@rule(
    "MB408",
    "tf-not-remapped",
    NOTE,
    what="A plugin publishes tf, and no rule takes it off the one /tf.",
    why="tf2's broadcaster publishes on the absolute /tf, which no namespace moves: with a tf topic "
    "for each robot this plugin's transforms are missing from it, and they meet on /tf.",
    fix="Add <remapping>/tf:=tf</remapping> to its <ros> block; urdf-postfix inserts it where each "
    "robot has its tf topic. Not needed where all share /tf and frames are spelled per robot.",
    bad='<gazebo><plugin name="d" filename="libgazebo_ros_diff_drive.so"><publish_odom_tf>true'
    "</publish_odom_tf></plugin></gazebo>",
    good='<gazebo><plugin name="d" filename="libgazebo_ros_diff_drive.so"><publish_odom_tf>true'
    "</publish_odom_tf><ros><remapping>/tf:=tf</remapping></ros></plugin></gazebo>",
)
def tf_not_remapped(subject: Subject) -> Iterator[Problem]:
    """Plugins with tf switched on and no rule for it, unless the robots share one /tf."""
    if subject.settings.robots and not subject.settings.naming.layout.tf_per_robot:
        return
    for host in subject.inventory.hosts:
        section = host.node.section
        if section is None or "/tf" not in section.publishes or not section.inserts:
            continue
        if "/tf" in switched_off(host.element, section) or _moves_tf(host.element):
            continue
        of = "the controllers it loads publish" if section.process_wide else "it publishes"
        message = f"plugin {host.element.get('name', '')!r}: {of} on /tf, which no namespace moves"
        yield Problem(host.element, message, None, "<remapping>/tf:=tf</remapping>")


def _moves_tf(plugin: _Element) -> bool:
    texts = (it.text or "" for it in plugin.iter("remapping", "argument"))
    rules = (split_remap(text.strip()) for text in texts)
    return any(it is not None and it.source.strip("/") == "tf" for it in rules)


@rule(
    "MB409",
    "no-namespace",
    NOTE,
    what="Plugins that make ROS nodes stand in no namespace.",
    why="The second robot's nodes have the same full names and topics: Gazebo Classic of ROS 2 gives "
    "the second plugin no node at all, and parameters and services answer for one robot only.",
    fix="Spawn each robot with -robot_namespace, or give the plugins a <namespace>: a xacro argument, "
    "or urdf-postfix. ros_gz_sim's create has no such option.",
    bad='<gazebo><plugin name="d" filename="libgazebo_ros_joint_state_publisher.so"><joint_name>j'
    "</joint_name></plugin></gazebo>",
    good='<gazebo><plugin name="d" filename="libgazebo_ros_joint_state_publisher.so"><ros>'
    "<namespace>r1/</namespace></ros></plugin></gazebo>",
)
def no_namespace(subject: Subject) -> Iterator[Problem]:
    """The first plugin without a namespace, and how many there are."""
    declared = subject.inventory.declared
    bare = []
    for host in subject.inventory.hosts:
        section = host.node.section
        if section is None or not any("namespace" in it.kinds for it in section.sites):
            continue
        items = insertions(host.element, section, declared, APART)
        if any(it.kind == "namespace" for it in items):
            bare.append(host.element)
    if bare:
        more = f" and {len(bare) - 1} more" if len(bare) > 1 else ""
        message = f"plugin {bare[0].get('name', '')!r}{more} in no namespace"
        yield Problem(bare[0], message, None, "give it one for each robot")


@rule(
    "MB410",
    "one-robot-description",
    NOTE,
    what="A plugin reads the robot description from an absolute name.",
    why="Every copy reads the first robot's description: its controllers then claim joints that the "
    "second robot, where it was renamed, does not have, and wait for a node outside their namespace.",
    fix="Name it relative to the plugin's namespace: robot_description, robot_state_publisher.",
    bad='<gazebo><plugin name="c" filename="libgazebo_ros_control.so"><robotParam>'
    "/robot_description</robotParam></plugin></gazebo>",
    good='<gazebo><plugin name="c" filename="libgazebo_ros_control.so"><robotParam>'
    "robot_description</robotParam></plugin></gazebo>",
)
def one_robot_description(subject: Subject) -> Iterator[Problem]:
    """Absolute names of descriptions and of the nodes that hold them."""
    found = [it for it in _children(subject, DESCRIPTIONS) if (it.text or "").strip()[:1] == "/"]
    starts = starts_of(subject, found)
    for element in found:
        if is_fixed(subject, starts[element], ""):
            message = f"<{element.tag}> {(element.text or '').strip()!r} is the same for all robots"
            yield Problem(element, message, "", "leave out what stands before the last slash")


def _children(subject: Subject, tags: tuple[str, ...]) -> list[_Element]:
    plugins = [it.element for it in subject.inventory.hosts if it.element.tag == "plugin"]
    return [child for plugin in plugins for child in plugin.iterchildren(*tags)]


@rule(
    "MB411",
    "one-controller-file",
    NOTE,
    what="The file of the controllers' parameters is fixed in a control plugin.",
    why="Both robots' controller managers read it: its keys fit only nodes of the names in it, so in "
    "another namespace without /** no controller has a type, and its joints are the first robot's.",
    fix="Write the keys as /**/controller_manager, and where joints are renamed give each robot its "
    "own file through a xacro argument.",
    bad='<gazebo><plugin name="gz_ros2_control::GazeboSimROS2ControlPlugin" '
    'filename="gz_ros2_control-system"><parameters>/opt/c.yaml</parameters></plugin></gazebo>',
    good='<gazebo><plugin name="gz_ros2_control::GazeboSimROS2ControlPlugin" '
    'filename="gz_ros2_control-system"/></gazebo>',
)
def one_controller_file(subject: Subject) -> Iterator[Problem]:
    """Literal ``<parameters>`` of plugins that load a controller manager."""
    plugins = _process_wide(subject)
    found = [it for plugin in plugins for it in plugin.iterchildren("parameters")]
    starts = starts_of(subject, found)
    for element in found:
        text = (element.text or "").strip()
        if text and is_fixed(subject, starts[element], ""):
            message = f"every robot's controllers read {text.rpartition('/')[2]!r}"
            yield Problem(element, message, "", "give each robot its file")


@rule(
    "MB412",
    "one-device",
    NOTE,
    what="A ros2_control hardware component has a fixed serial port, CAN interface or IP address.",
    why="Two robots would open one device: the second driver fails to connect, or both command the "
    "same motors.",
    fix="Make it a xacro argument that each robot's launch sets.",
    bad='<ros2_control name="h" type="system"><hardware><plugin>a/B</plugin>'
    '<param name="device">/dev/ttyUSB0</param></hardware></ros2_control>',
    good='<ros2_control name="h" type="system"><hardware><plugin>a/B</plugin>'
    '<param name="rate">100</param></hardware></ros2_control>',
)
def one_device(subject: Subject) -> Iterator[Problem]:
    """Literal parameters that name a device or an address of another machine."""
    params = subject.document.root.iterfind("ros2_control/hardware/param")
    found = [it for it in params if DEVICE.fullmatch((it.text or "").strip())]
    starts = starts_of(subject, found)
    for element in found:
        if is_fixed(subject, starts[element], ""):
            text = (element.text or "").strip()
            message = f"parameter {element.get('name', '')!r} is {text!r} for every robot"
            yield Problem(element, message, "", "make it a xacro argument")


@rule(
    "MB413",
    "default-topic-shared",
    NOTE,
    what="A plugin or hardware class uses a topic or name by its default, which a namespace does "
    "not move.",
    why="All robots' components of that class talk on the one absolute topic: each joint command "
    "reaches every robot.",
    fix="Say the name and give each robot its own; urdf-postfix inserts it.",
    bad='<ros2_control name="h" type="system"><hardware><plugin>'
    "topic_based_ros2_control/TopicBasedSystem</plugin>"
    '<param name="joint_states_topic">states</param></hardware></ros2_control>',
    good='<ros2_control name="h" type="system"><hardware><plugin>'
    "topic_based_ros2_control/TopicBasedSystem</plugin>"
    '<param name="joint_states_topic">states</param>'
    '<param name="joint_commands_topic">commands</param></hardware></ros2_control>',
)
def default_topic_shared(subject: Subject) -> Iterator[Problem]:
    """Topics, services and stems that would have to be inserted for a robot."""
    for element, (kind, old, _) in _inserted(subject):
        if kind in ("topic", "service", "stem"):
            message = f"without being told another {kind} it uses {old!r}, as every other robot's"
            yield Problem(element, message, None, "say it for each robot")


@rule(
    "MB415",
    "sensor-found-by-bare-name",
    NOTE,
    what="Something in the file looks sensors up by their bare name in the whole world.",
    why="gz_ros2_control takes the first IMU of that name, the realsense and kobuki plugins find "
    "none where two have it: the second robot reads the first one's data, or nothing.",
    fix="Make sensor names differ between robots: a xacro prefix, or urdf-postfix with the layout "
    "both.",
    bad='<link name="a"/><gazebo reference="a"><sensor name="imu" type="imu"/></gazebo>'
    '<ros2_control name="h" type="system"><hardware><plugin>gz_ros2_control/GazeboSimSystem'
    '</plugin></hardware><sensor name="imu"/></ros2_control>',
    good='<link name="a"/><ros2_control name="h" type="system"><hardware><plugin>'
    "gz_ros2_control/GazeboSimSystem</plugin></hardware></ros2_control>",
)
def sensor_found_by_bare_name(subject: Subject) -> Iterator[Problem]:
    """Asked as long as no robots are named; then MB425 knows whether their names differ."""
    if subject.settings.robots or not _has_fixed_sensor(subject):
        return
    for it in hazards.bare_lookups(subject.inventory, AS_WRITTEN):
        yield Problem(it.element, it.message, None, "give sensors a prefix for each robot")


def _has_fixed_sensor(subject: Subject) -> bool:
    declared = subject.inventory.declared["sensor"].values()
    return any(claim_is_fixed(subject, it) for it in declared)


@rule(
    "MB416",
    "world-system-in-robot",
    WARNING,
    what="The robot brings a gz system along that serves the whole world.",
    why="gz-sim loads it once more with every copy: two Sensors systems crash it (gz-sensors issue "
    "497), and two Imu systems each publish every IMU of the world (gz-sim Imu.cc).",
    fix="Load it in the world's SDF and take it out of the robot.",
    bad='<gazebo><plugin filename="gz-sim-sensors-system" name="gz::sim::systems::Sensors"/>'
    "</gazebo>",
    good='<gazebo><plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive"/>'
    "</gazebo>",
)
def world_system_in_robot(subject: Subject) -> Iterator[Problem]:
    """Plugins whose library is one of the world's systems."""
    for host in subject.inventory.hosts:
        if host.element.tag != "plugin":
            continue
        key = library_key(host.element.get("filename", ""))
        if key in WORLD_SYSTEMS:
            message = f"{key} comes once more with every robot: {WORLD_SYSTEMS[key]}"
            yield Problem(host.element, message, "filename", "load it in the world")


@rule(
    "MB417",
    "prefix-forgotten",
    WARNING,
    what="A name lacks the prefix that the other names of its macro or file have.",
    why="With an empty prefix nobody notices; with the second robot's the name is there twice, or "
    "refers to a link or joint that is called otherwise, and urdfdom refuses the robot.",
    fix="Put the prefix in front.",
    bad='<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
    '<xacro:macro name="arm" params="prefix"><link name="${prefix}base"/><link name="tool"/>'
    '<joint name="${prefix}j" type="fixed"><parent link="${prefix}base"/><child link="${prefix}tip"'
    "/></joint></xacro:macro></robot>",
    good='<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
    '<xacro:macro name="arm" params="prefix parent"><link name="${prefix}base"/>'
    '<joint name="${prefix}j" type="fixed"><parent link="${parent}"/><child link="${prefix}base"/>'
    "</joint></xacro:macro></robot>",
    formats=(XACRO,),
)
def prefix_forgotten(subject: Subject) -> Iterator[Problem]:
    """Literal names where others have the prefix, and literal uses of names that have it."""
    from multibot_rewrite.lint.prefixes import forgotten  # what only xacro files need

    yield from forgotten(subject)


@rule(
    "MB418",
    "prefix-unused",
    WARNING,
    what="A macro or file takes a prefix and uses it nowhere.",
    why="Whoever gives it believes that two copies differ: the second one brings every name again, "
    "and urdfdom refuses the robot for links that are not unique.",
    fix="Put it in front of the names, or take the parameter away.",
    bad='<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
    '<xacro:macro name="arm" params="prefix"><link name="base"/></xacro:macro></robot>',
    good='<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
    '<xacro:macro name="arm" params="prefix"><link name="${prefix}base"/></xacro:macro></robot>',
    formats=(XACRO,),
)
def prefix_unused(subject: Subject) -> Iterator[Problem]:
    """Parameters and arguments that nothing in sight reads and nothing out of sight can."""
    from multibot_rewrite.lint.prefixes import unused

    yield from unused(subject)


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
    """What a rewrite for the robots would refuse as MB420."""
    names = subject.settings.robots
    if names:
        yield from _at(robots.taken_names(subject.inventory, _renames(subject), names))


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
    """What a rewrite for the robots would refuse as MB421."""
    naming, names = subject.settings.naming, subject.settings.robots
    pairs = overlap(naming, names) if len(names) > 1 else []
    for it in robots.meeting(subject.inventory, _renames(subject), pairs):
        yield Problem(subject.document.root, it.message, None, it.hint)


@rule(
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
)
def prefix_only(subject: Subject) -> Iterator[Problem]:
    """Prefix parameters under a naming that puts names behind."""
    if subject.settings.robots:
        yield from _at(hazards.prefix_only(subject.inventory, subject.settings.naming))


@rule(
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
    options={"robots": TWO},
)
def off_the_shared_tf(subject: Subject) -> Iterator[Problem]:
    """Rules for /tf under a layout with one /tf."""
    if subject.settings.robots:
        yield from _at(hazards.moved_tf(subject.inventory, subject.settings.naming))


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
    """Contacts that a rewrite would refuse as MB424."""
    if not subject.settings.robots or subject.document.root.find(".//contact") is None:
        return
    from multibot_rewrite.rewriters.contact import respell_collisions
    from multibot_rewrite.steps.plan import LAST
    from multibot_rewrite.steps.renames import respeller

    document, claims, _, declared, *_ = subject.inventory
    renames = _renames(subject)
    first, last = (
        respell_collisions(document.root, claims, declared, respeller(renames, name))
        for name in (ROBOT_SLOT, LAST)
    )
    for (claim, text), (_, other) in zip(first, last, strict=False):
        if text != other.replace(LAST, ROBOT_SLOT):
            message = f"the number in {claim.value!r} would depend on how the robot's name sorts"
            yield Problem(claim.element, message, claim.attribute, "use affix prefix")


@rule(
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
)
def sensor_names_meet(subject: Subject) -> Iterator[Problem]:
    """World-wide look-ups under a naming that leaves sensors as they are."""
    if subject.settings.robots:
        yield from _at(hazards.bare_lookups(subject.inventory, subject.settings.naming))


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
    """Rules that reach other robots' nodes; without robots named, those with absolute targets."""
    settings = subject.settings
    naming = settings.naming if settings.robots else AS_WRITTEN
    yield from _at(hazards.process_wide(subject.inventory, naming))


@rule(
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
)
def fixed_to_own_frame(subject: Subject) -> Iterator[Problem]:
    """Fixed virtual joints whose parent frame is spelled for each robot."""
    if subject.settings.robots:
        yield from _at(hazards.outside_frames(subject.inventory, _renames(subject)))


@rule(
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
)
def hard_wired_name(subject: Subject) -> Iterator[Problem]:
    """Literal names of plugins that the naming spells."""
    if subject.settings.robots:
        yield from _at(hazards.hardwired(subject.inventory, _renames(subject)))
