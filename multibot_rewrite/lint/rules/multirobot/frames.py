"""Frames and tf that two robots of one description would share."""

from __future__ import annotations

from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.findings.finding import NOTE, WARNING
from multibot_rewrite.findings.rule import rule
from multibot_rewrite.lint.facts.source_values import claim_is_fixed
from multibot_rewrite.lint.records import Problem, Subject
from multibot_rewrite.lint.rules.multirobot.shared import inserted, is_plain, tag_of
from multibot_rewrite.model import Claim
from multibot_rewrite.rewriters.switches import switched_off
from multibot_rewrite.rosnames import split_remap


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
    """Frames that are a link with something and a slash in front."""
    links = subject.inventory.declared["link"]
    for claim in subject.inventory.claims if subject.inventory.hosts else ():
        value = claim.value.strip("/")
        if "/" not in value or "frame" not in claim.site.kinds or value in links:
            continue
        link = value.partition("/")[2].strip("/")
        if link in links and is_plain(value) and claim_is_fixed(subject, claim):
            message = f"frame {claim.value!r} holds a robot's name, the link is called {link!r}"
            yield Problem(claim.element, message, claim.attribute, f"write {link!r}")


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
    for element, item in inserted(subject):
        if item[0] in ("frame", "link"):
            message = f"without <{item[2]}> the plugin uses {item[1]!r}, as every other robot's"
            yield Problem(element, message, None, f"say <{item[2]}> for each robot")


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
        if is_plain(name) and claim_is_fixed(subject, claim):
            message = f"{tag_of(claim)} {claim.value!r} is one frame for every copy of the robot"
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
        rewriter = host.node.section
        if rewriter is None or "/tf" not in rewriter.publishes or not rewriter.inserts:
            continue
        if "/tf" in switched_off(host.element, rewriter) or _moves_tf(host.element):
            continue
        of = "the controllers it loads publish" if rewriter.process_wide else "it publishes"
        message = f"plugin {host.element.get('name', '')!r}: {of} on /tf, which no namespace moves"
        yield Problem(host.element, message, None, "<remapping>/tf:=tf</remapping>")


def _moves_tf(plugin: _Element) -> bool:
    texts = (it.text or "" for it in plugin.iter("remapping", "argument"))
    rules = (split_remap(text.strip()) for text in texts)
    return any(it is not None and it.source.strip("/") == "tf" for it in rules)
