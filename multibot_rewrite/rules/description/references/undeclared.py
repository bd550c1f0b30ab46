"""Links, joints and other names that are used and not declared."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from multibot_rewrite.base.findings.finding import ERROR, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.checks.references import where
from multibot_rewrite.rules.description.examples import a_joint, a_link
from multibot_rewrite.rules.description.references.lookup import references, undeclared
from multibot_rewrite.rules.description.references.shared import (
    ARM,
    LINKS,
    a_pair,
    a_plugin,
    a_system,
)
from multibot_rewrite.rules.subject import Subject

undeclared_link = rule(
    "MB202",
    "undeclared-link",
    ERROR,
    what="A joint's parent or child link is not declared.",
    why="urdfdom rejects the file ('parent link ... not found'): no robot_state_publisher, no tf.",
    fix="Correct the name, or declare the link.",
    bad='<link name="b"/><joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>',
    good='<link name="a"/>\n'
    '<link name="b"/>\n'
    '<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>\n',
)(partial(undeclared, "MB202"))

undeclared_mimic = rule(
    "MB211",
    "undeclared-mimic",
    ERROR,
    what="A joint mimics one that is not declared.",
    why="robot_state_publisher never sends the transform of the joint, so the links below it have "
    "no frame in tf; joint_state_publisher stops with a KeyError, MoveIt ignores the mimic.",
    fix="Correct the name.",
    bad=LINKS + a_joint("j", "continuous", "a", "b", '<mimic joint="k"/>'),
    good=a_pair('<mimic joint="j"/>'),
    line=5,
)(partial(undeclared, "MB211"))

undeclared_reference = rule(
    "MB212",
    "undeclared-reference",
    WARNING,
    what="A <gazebo reference> names neither a link nor a joint.",
    why="Gazebo silently drops the block: no friction, no sensor, no plugin from it.",
    fix="Correct the name, or delete the block.",
    bad='<link name="wheel"/><gazebo reference="weel"><mu1>1</mu1></gazebo>',
    good='<link name="wheel"/><gazebo reference="wheel"><mu1>1</mu1></gazebo>',
)(partial(undeclared, "MB212"))

undeclared_transmission_joint = rule(
    "MB213",
    "undeclared-transmission-joint",
    WARNING,
    what="A <transmission> names a joint that is not declared.",
    why="gazebo_ros_control of ROS 1 loads no hardware at all ('which is not in the gazebo "
    "model'); ROS 2 does not read these transmissions.",
    fix="Correct the name, or delete the transmission.",
    bad=f'{ARM}<transmission name="t"><joint name="jj"/></transmission>',
    good=f'{ARM}<transmission name="t"><joint name="j"/></transmission>',
    line=6,
)(partial(undeclared, "MB213"))

undeclared_ros2_control_joint = rule(
    "MB214",
    "undeclared-ros2-control-joint",
    ERROR,
    what="A <ros2_control> names a joint that is not declared.",
    why="From Jazzy on the controller manager rejects the description ('Joint ... not found in "
    "URDF'); before Jazzy, gz_ros2_control left the joint out and its controllers could not start.",
    fix="Correct the name; a value that is not of a joint belongs in a <gpio>.",
    bad=ARM + a_system('<joint name="jj"/>'),
    good=ARM + a_system('<joint name="j"/>'),
    line=7,
)(partial(undeclared, "MB214"))

undeclared_joint_parameter = rule(
    "MB215",
    "undeclared-joint-parameter",
    WARNING,
    what="A parameter of a plugin or hardware class names a joint that is not declared.",
    why="The plugin looks the joint up, does not find it and does not run, or leaves the joint "
    "out: gazebo_ros_diff_drive reports 'Joint ... not found, plugin will not work'.",
    fix="Correct the name.",
    bad=ARM + a_plugin("gazebo_ros_diff_drive", "d", "<left_joint>k</left_joint>"),
    good=ARM + a_plugin("gazebo_ros_diff_drive", "d", "<left_joint>j</left_joint>"),
    line=8,
)(partial(undeclared, "MB215"))

undeclared_link_parameter = rule(
    "MB216",
    "undeclared-link-parameter",
    WARNING,
    what="A parameter of a plugin or hardware class names a link that is not declared.",
    why="The plugin looks the link up, does not find it and does not run: gazebo_ros_p3d reports "
    "'body_name: ... does not exist' and publishes nothing.",
    fix="Correct the name.",
    bad=a_link("a") + a_plugin("gazebo_ros_p3d", "p", "<ros/>", "<body_name>b</body_name>"),
    good=a_link("a") + a_plugin("gazebo_ros_p3d", "p", "<ros/>", "<body_name>a</body_name>"),
    line=5,
)(partial(undeclared, "MB216"))

undeclared_sdf_name = rule(
    "MB219",
    "undeclared-sdf-name",
    WARNING,
    what="An SDF frame, joint or pose names something that its model does not have, or a scoped "
    "name a::b is not found.",
    why="libsdformat rejects the model for a frame, joint or link ('does not match a nested model, "
    "link, joint, or frame name'); a sensor's pose is not resolved.",
    fix="Correct the name; names of an included model need its scope.",
    bad='<link name="a"/><gazebo><frame name="f" attached_to="b"/></gazebo>',
    good='<link name="a"/><gazebo><frame name="f" attached_to="a"/></gazebo>',
)(partial(undeclared, "MB219"))

undeclared_name = rule(
    "MB220",
    "undeclared-name",
    WARNING,
    what="Another element names a link or joint that is not declared: a sensor, gripper, loop "
    "joint, drake or webots element.",
    why="The program that reads the element looks the name up and does not find it: it rejects the "
    "element or leaves it out.",
    fix="Correct the name.",
    bad='<link name="a"/><gazebo><gripper name="g"><palm_link>b</palm_link></gripper></gazebo>',
    good='<link name="a"/><gazebo><gripper name="g"><palm_link>a</palm_link></gripper></gazebo>',
)(partial(undeclared, "MB220"))


@rule(
    "MB221",
    "padded-reference",
    ERROR,
    what="A name in an attribute has white space before or after it that the declared name does "
    "not have.",
    why="Parsers do not strip attributes: urdfdom looks for 'base ' with the space, does not find "
    "it and rejects the file; ros2_control does not find the joint.",
    fix="Delete the white space.",
    bad='<link name="a"/>\n'
    '<link name="b"/>\n'
    '<joint name="j" type="fixed"><parent link="a "/><child link="b"/></joint>\n',
    good='<link name="a"/>\n'
    '<link name="b"/>\n'
    '<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>\n',
    line=3,
)
def padded_reference(subject: Subject) -> Iterator[Problem]:
    """Attributes that are the name of a link or joint."""
    declared = subject.inventory.declared
    for claim in references(subject).doubtful:
        name = claim.value.strip()
        if not claim.attribute or name == claim.value or claim.site.form != "whole":
            continue
        found = [declared[kind][name] for kind in claim.site.kinds if name in declared[kind]]
        if found and all(it.value != claim.value for it in found):
            message = f"{where(claim)} is {claim.value!r}, the {claim.site.kinds[0]} is {name!r}"
            yield Problem(claim.element, message, claim.attribute, "delete the white space")
