# SPDX-License-Identifier: Apache-2.0
"""What the named robots would share in the running system, as the programs read the rewritten file."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from multibot_rewrite.base.conventions import SHARED_TOPICS
from multibot_rewrite.base.findings.finding import ERROR, WARNING
from multibot_rewrite.base.findings.rule import URDF, Rule, rule
from multibot_rewrite.base.naming import Naming, make_naming
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.description.multirobot.shared import APART, AS_WRITTEN, TWO
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.subject import Subject
from multibot_rewrite.rules.system import commands, names, nodes, sharing, transforms
from multibot_rewrite.spelling import way_checks

ODOMETRY_APART = make_naming("tf-per-robot", shared_topics=[*SHARED_TOPICS, "tf_static"])

IN_FRONT = make_naming("postfix", affix="prefix")


@memoized
def _shared(subject: Subject) -> tuple[Problem, ...]:
    """What a rewrite for the named robots would report; nothing where it would be refused."""
    if not subject.settings.robots:
        return ()
    # Without robots a lint loads none of it.
    from multibot_rewrite.description.checks.meeting import shared_by_all
    from multibot_rewrite.description.steps.apply import cut
    from multibot_rewrite.description.steps.collect import collect
    from multibot_rewrite.description.steps.plan import make_plan

    naming, document = subject.settings.naming, subject.document
    inventory = subject.inventory
    if not naming.read_as.namespaced:
        inventory = collect(document, subject.tree, layout=naming.read_as)
    plan = make_plan(inventory, naming)
    if any(it.level == ERROR for it in plan.findings):
        return ()
    pieces = cut(document.source, plan.edits)
    return tuple(shared_by_all(document, pieces, naming, subject.tree.vocabulary))


def _of_code(code: str, subject: Subject) -> Iterator[Problem]:
    return (it for it in _shared(subject) if it.code == code)


def _left(known: Rule, bad: str, good: str, line: int = 2, naming: Naming = APART) -> Rule:
    """A rule of running systems, for what a rewrite would leave so; the examples are descriptions."""
    options = {"robots": TWO, "naming": naming}
    own = known._replace(bad=bad, good=good, line=line, formats=(URDF,), options=options)
    return own._replace(level=WARNING, check=partial(_of_code, known.code))


_LIDAR = """\
<link name="a"/>
<gazebo reference="a">
  <sensor name="lidar" type="gpu_lidar"><topic>{}</topic></sensor>
</gazebo>
"""
_DRIVE = """\
<gazebo>
  <plugin name="drive" filename="{}">{}</plugin>
</gazebo>
"""
_CLASSIC, _GZ = "libgazebo_ros_diff_drive.so", "gz-sim-diff-drive-system"
_JOINTS = "<left_joint>l</left_joint><right_joint>r</right_joint>"
shared_topic = _left(
    sharing.topic_of_several_robots, _LIDAR.format("{name}/scan"), _LIDAR.format("scan"), 3
)
shared_node = _left(
    nodes.nodes_of_one_name,
    _DRIVE.format(_CLASSIC, "<ros><namespace>{name}</namespace></ros>"),
    _DRIVE.format(_CLASSIC, "<ros><namespace>demo</namespace></ros>"),
)
shared_frame = _left(
    transforms.robots_frames_collide,
    _DRIVE.format(_CLASSIC, "<odometry_frame>__odom__</odometry_frame>"),
    _DRIVE.format(_CLASSIC, "<odometry_frame>odom</odometry_frame>"),
)
shared_command = _left(
    commands.command_for_several_robots,
    _DRIVE.format(_GZ, f"{_JOINTS}<topic>{{name}}/cmd_vel</topic>"),
    _DRIVE.format(_GZ, f"{_JOINTS}<topic>cmd_vel</topic>"),
)
shared_service = _left(
    names.service_of_two_nodes,
    _DRIVE.format("gz-sim-camera-video-recorder-system", "<service>{name}/record</service>"),
    _DRIVE.format("gz-sim-camera-video-recorder-system", "<service>record</service>"),
)
controllers_apart = _left(
    way_checks.NOT_TAKEN,
    _DRIVE.format(
        "gz_ros2_control-system",
        "<parameters>controllers.yaml</parameters><ros><remapping>/tf:=tf</remapping></ros>",
    ),
    _DRIVE.format(_GZ, _JOINTS),
    naming=ODOMETRY_APART,
)

sensor_names_collide = rule(
    "MB425",
    "lookup-in-the-world",
    WARNING,
    what="A plugin looks up a sensor, link or light by its bare name in the whole world, and "
    "each robot has one of that name.",
    why="gz_ros2_control takes the first IMU with that name. The realsense and kobuki plugins "
    "find none if two have it: the second robot reads the first one's data, or nothing.",
    fix="Use the layout called both (L3), which renames sensors for each robot.",
    bad='<link name="a"/>\n'
    '<gazebo reference="a"><sensor name="imu" type="imu"/></gazebo>\n'
    '<ros2_control name="h" type="system">\n'
    "  <hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware>\n"
    '  <sensor name="imu"/>\n'
    "</ros2_control>\n",
    good='<link name="a"/><gazebo reference="a"><sensor name="imu" type="imu"/></gazebo>',
    line=3,
    options={"robots": TWO, "naming": AS_WRITTEN},
)(partial(_of_code, "MB425"))

lost_rule = rule(
    "MB436",
    "lost-remap-rule",
    WARNING,
    what="A remap rule of a plugin would match no name after the rewrite that it matched before.",
    why="rcl compares the left side with the full name of a topic. Where both get the robot's name "
    "in different places, the rule does nothing. The topic keeps the name of the plugin's code.",
    fix="Write the topic and the left side of its rule the same way, best without a slash in front.",
    bad="<gazebo>\n"
    '  <plugin name="imu" filename="libhector_gazebo_ros_imu.so">\n'
    "    <ros><namespace>a</namespace><remapping>imu:=imu/raw</remapping></ros>\n"
    "    <topicName>/a/imu</topicName>\n"
    "  </plugin>\n"
    "</gazebo>\n",
    good="<gazebo>\n"
    '  <plugin name="imu" filename="libhector_gazebo_ros_imu.so">\n'
    "    <ros><namespace>a</namespace><remapping>imu:=imu/raw</remapping></ros>\n"
    "    <topicName>imu</topicName>\n"
    "  </plugin>\n"
    "</gazebo>\n",
    line=2,
    options={"robots": TWO, "naming": IN_FRONT},
)(partial(_of_code, "MB436"))

same_text = rule(
    "MB437",
    "same-text-for-all",
    WARNING,
    what="All robots would get the same description, and a plugin, sensor or driver runs in it.",
    why="Nothing in the text keeps the robots apart: what it opens is apart only if everything that is "
    "known of it is right.",
    fix="Use a layout that gives each robot names of its own, as --layout both.",
    bad='<link name="a"/>\n<gazebo><plugin name="p" filename="libacme_arm.so"/></gazebo>',
    good='<link name="a"/>\n<gazebo><plugin name="p" filename="libgazebo_grasp_fix.so"/></gazebo>',
    line=2,
    options={"robots": TWO, "naming": AS_WRITTEN},
)(partial(_of_code, "MB437"))

_HEARD = """\
<link name="a"/>
<gazebo reference="a"><sensor name="c" type="contact"><topic>{}</topic></sensor></gazebo>
<gazebo>
  <plugin filename="gz-sim-triggered-publisher-system" name="gz::sim::systems::TriggeredPublisher">
    <input type="gz.msgs.Contacts" topic="hit"/><output type="gz.msgs.Empty" topic="stop"/>
  </plugin>
</gazebo>
"""

parted_topic = rule(
    "MB438",
    "parted-topic",
    WARNING,
    what="Two parameters that held one topic would hold two after the rewrite.",
    why="One of them sends what the other listens to: after the rewrite nothing arrives.",
    fix="Write both the same way, best without a slash in front.",
    bad=_HEARD.format("~/hit"),
    good=_HEARD.format("hit"),
    line=2,
    options={"robots": TWO, "naming": APART},
)(partial(_of_code, "MB438"))

_CAMERA = """\
<link name="a"/>
<gazebo reference="a"><sensor name="c" type="camera">{}</sensor></gazebo>
"""

camera_info_elsewhere = rule(
    "MB439",
    "camera-info-elsewhere",
    WARNING,
    what="The camera_info of a camera would no longer stand beside its image.",
    why="RViz and image_transport replace the last segment of an image's topic to find its "
    "camera_info (image_common camera_common.cpp). They find none, as no robot sends under that "
    "name.",
    fix="Start what shows the image with the rule of the hint, or use --topics namespace.",
    bad=_CAMERA.format("<topic>cam/image</topic>"),
    good=_CAMERA.format(""),
    line=2,
    options={"robots": TWO, "naming": make_naming("postfix")},
)(partial(_of_code, "MB439"))
