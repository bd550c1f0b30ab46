# SPDX-License-Identifier: Apache-2.0
"""Links, joints and other names that are used and not declared."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from multibot_rewrite.base.findings.finding import ERROR, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.checks.references import where
from multibot_rewrite.rules.description.examples import a_joint
from multibot_rewrite.rules.description.references.lookup import references, undeclared
from multibot_rewrite.rules.description.references.shared import (
    LINKS,
    a_pair,
)
from multibot_rewrite.rules.subject import Subject

undeclared_link = rule(
    "MB202",
    "undeclared-link",
    ERROR,
    what="A name that has to be a link is not declared. It is in a joint's parent or child, a "
    "<gazebo reference>, a sensor, a gripper, a model, or a parameter of a plugin. It is an error "
    "in a joint.",
    why="urdfdom rejects the file ('parent link ... not found'): no robot_state_publisher, no tf."
    " Gazebo silently drops the block, with its friction, sensors and plugins. A plugin looks"
    " the link up and does not run: gazebo_ros_p3d reports 'body_name: ... does not exist'.",
    fix="Correct the name, declare the link, or delete the block.",
    bad='<link name="b"/><joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>',
    good='<link name="a"/>\n'
    '<link name="b"/>\n'
    '<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>\n',
)(partial(undeclared, "MB202"))

undeclared_joint = rule(
    "MB211",
    "undeclared-joint",
    ERROR,
    what="A name that has to be a joint is not declared. It is in a <mimic>, <ros2_control> or "
    "<transmission>, or in a parameter of a plugin or hardware class. It is an error in the first "
    "two.",
    why="robot_state_publisher never sends the transform of a joint that mimics it, and "
    "joint_state_publisher stops with a KeyError. From Jazzy on the controller manager rejects the "
    "description ('Joint ... not found in URDF'). A plugin leaves the joint out or does not run, and "
    "gazebo_ros_control of ROS 1 loads no hardware at all.",
    fix="Correct the name; write a value that is not of a joint into a <gpio>.",
    bad=LINKS + a_joint("j", "continuous", "a", "b", '<mimic joint="k"/>'),
    good=a_pair('<mimic joint="j"/>'),
    line=5,
)(partial(undeclared, "MB211"))

undeclared_sdf_name = rule(
    "MB219",
    "undeclared-sdf-name",
    WARNING,
    what="An SDF frame, joint or pose names something that its model does not have, or a scoped "
    "name a::b is not found.",
    why="libsdformat rejects the model for a frame, joint or link ('does not match a nested "
    "model, link, joint, or frame name'). A sensor's pose is not resolved.",
    fix="Correct the name; names of an included model need its scope.",
    bad='<link name="a"/><gazebo><frame name="f" attached_to="b"/></gazebo>',
    good='<link name="a"/><gazebo><frame name="f" attached_to="a"/></gazebo>',
)(partial(undeclared, "MB219"))


@rule(
    "MB221",
    "padded-reference",
    ERROR,
    what="A name in an attribute has white space before or after it that the declared name does "
    "not have.",
    why="Parsers do not strip attributes. urdfdom looks for 'base ' with the space, does not find "
    "it and rejects the file. ros2_control does not find the joint.",
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
