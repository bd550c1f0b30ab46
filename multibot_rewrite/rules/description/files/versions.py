# SPDX-License-Identifier: Apache-2.0
"""Versions of URDF: what the declared one does not read, and what the release's programs do not."""

from __future__ import annotations

from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.model import Edit
from multibot_rewrite.description.checks.poses import quaternion
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.checks.rotation import length_of
from multibot_rewrite.rules.convert.capsules import capsule_edits, capsules
from multibot_rewrite.rules.convert.spans import Text, text_of
from multibot_rewrite.rules.convert.versions import (
    as_rpy,
    lowered,
    one_rotation,
    raised,
    rotated_origins,
)
from multibot_rewrite.rules.description.examples import a_joint, a_link, block
from multibot_rewrite.rules.facts.faults import faults, urdf_faults
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.schema.readers import (
    CAPSULE,
    RVIZ,
    URDFDOM,
    highest_version,
    reader_of,
)
from multibot_rewrite.rules.schema.versions import KNOWN, Version, read_version, version_of
from multibot_rewrite.rules.subject import Subject

QUATERNIONS = KNOWN[1]
# What makes another version another file than the one that is read now.
_REFUSED = ("word", "missing", "value", "range", "rotation-twice")
_TURNED = '<origin quat_xyzw="0 0 1 0"/>'
_LINKS = a_link("a") + a_link("b")


def _robot(version: str, *inside: str) -> str:
    """An example: a robot of a version, whose content begins in line 2."""
    return block(f'<robot name="r" version="{version}">', *inside)


def _joint(origin: str) -> str:
    return _LINKS + a_joint("j", "fixed", "a", "b", origin)


def _visual(shape: str, *more: str) -> str:
    return block('<link name="a">', f"<visual><geometry>{shape}</geometry></visual>", *more)


@rule(
    "MB126",
    "rotation-twice",
    ERROR,
    what="An <origin> has both rpy and quat_xyzw, in a file of URDF 1.1 or 1.2.",
    why="urdfdom rejects the file if it is in a joint ('Both rpy and quat_xyzw orientations are "
    "defined'). In a link it drops the inertial, or the remaining visuals and collisions.",
    fix="Keep one of them; --fix does where they are the same rotation.",
    bad=_robot("1.1", _joint('<origin rpy="0 0 0" quat_xyzw="0 0 0 1"/>')),
    good=_robot("1.1", _joint('<origin quat_xyzw="0 0 0 1"/>')),
    fixed=_robot("1.1", _joint('<origin quat_xyzw="0 0 0 1"/>')),
    line=6,
)
def rotation_twice(subject: Subject) -> Iterator[Problem]:
    """With a fix where both are the same."""
    for it in faults("rotation-twice", subject):
        yield it._replace(edits=one_rotation(_text(subject), it.element, "rpy"))


@rule(
    "MB127",
    "no-rotation",
    WARNING,
    what="A quat_xyzw has no length: four zeros, or numbers too small or too large to square.",
    why="urdfdom divides by the length, and takes what has none for no rotation, without a word.",
    fix="Write x, y, z and w of a quaternion of length 1; 0 0 0 1 is no rotation.",
    bad=_robot("1.1", _joint('<origin quat_xyzw="0 0 0 0"/>')),
    good=_robot("1.1", _joint('<origin quat_xyzw="0 0 0 1"/>')),
    line=6,
)
def no_rotation(subject: Subject) -> Iterator[Problem]:
    """Quaternions that cannot be made one of length 1."""
    if version_of(subject.document.root) < QUATERNIONS:
        return
    for origin in rotated_origins(subject.document.root):
        turn = quaternion(origin)
        if turn is not None and not 0 < length_of(turn) < float("inf"):
            message = f"quat_xyzw is {origin.get('quat_xyzw')!r}, which is no rotation"
            yield Problem(origin, message, "quat_xyzw")


@rule(
    "MB128",
    "needs-later-version",
    WARNING,
    what="A quat_xyzw or <capsule> in a file of URDF 1.0, which is one without a version, too.",
    why="urdfdom reads no rotation: the joint or shape is in another pose at run time, with a "
    "warning only. Of a link it drops the capsule and the visuals and collisions after it.",
    fix='Write version="1.1" in <robot> where the release reads it, else rpy, a cylinder and spheres. '
    "--fix does.",
    bad='<robot name="r">\n' + _joint(_TURNED) + "</robot>\n",
    good=_robot("1.1", _joint(_TURNED)),
    fixed='<robot version="1.1" name="r">\n' + _joint(_TURNED) + "</robot>\n",
    line=6,
)
def needs_later_version(subject: Subject) -> Iterator[Problem]:
    """With a fix that keeps the pose that is written."""
    for it in faults("needs-later-version", subject):
        yield it._replace(edits=_read_now(subject, it.element), hint=_hint(subject))


def _hint(subject: Subject) -> str:
    return 'write version="1.1" in <robot>' if _reads(subject) >= QUATERNIONS else ""


def _read_now(subject: Subject, element: _Element) -> tuple[Edit, ...]:
    """The edits that make the release's urdfdom read an element of a later version."""
    text = _text(subject)
    link = next(element.iterancestors("link"), None)
    if element.tag == CAPSULE:
        return () if link is None else capsule_edits(text, link)
    if element.get("rpy") is None and _reads(subject) >= QUATERNIONS:
        return _raised(subject)
    return as_rpy(text, element)


@rule(
    "MB129",
    "ignored-limit",
    NOTE,
    what="A <limit> has an acceleration, deceleration or jerk that is not read. The file is not of "
    "URDF 1.2, or the release does not read URDF 1.2.",
    why="urdfdom 6 warns ('Ignoring jerk attribute') and older ones say nothing: the joint has no such "
    "limit.",
    fix='Write version="1.2" in <robot>; joint_limits.yaml has such limits for MoveIt.',
    bad=_LINKS + a_joint("j", "continuous", "a", "b", '<limit effort="1" velocity="1" jerk="5"/>'),
    good=_robot(
        "1.2",
        _LINKS,
        a_joint("j", "continuous", "a", "b", '<limit effort="1" velocity="1" jerk="5"/>'),
    ),
    line=5,
)
def ignored_limit(subject: Subject) -> Iterator[Problem]:
    """Limits that came with version 1.2; one finding for a <limit>."""
    newest = KNOWN[-1]
    read = min(version_of(subject.document.root), _reads(subject)) >= newest
    for joint in subject.robot.joints if not read else ():
        limit = joint.parts.get("limit")
        given = () if limit is None else limit.keys()
        there = [it for it in ("acceleration", "deceleration", "jerk") if it in given]
        if limit is not None and there:
            verb = "are" if there[1:] else "is"
            message = f"joint {joint.name!r}: {' and '.join(there)} {verb} not read"
            yield Problem(limit, message, there[0], f"needs URDF {newest}")


@rule(
    "MB133",
    "version-of-release",
    ERROR,
    what="The file declares a version of URDF that the release's urdfdom does not read.",
    why="urdfdom rejects the whole file: robot_state_publisher ends, RViz and MoveIt have no robot.",
    fix="Write what URDF 1.0 has. --fix does where every pose and shape stays: rpy for quat_xyzw, a "
    "cylinder and two spheres for a capsule.",
    bad=_robot("1.1", _joint(_TURNED)),
    good=_robot("1.0", _joint('<origin rpy="0 0 3.14"/>')),
    fixed=_robot("1.0", _joint('<origin rpy="0 0 3.141592653589793"/>')),
    options={"distro": "jazzy"},
)
def version_of_release(subject: Subject) -> Iterator[Problem]:
    """With a fix where the file means the same in URDF 1.0."""
    root = subject.document.root
    declared, reads = read_version(root.get("version", "")), _reads(subject)
    if root.tag == "robot" and declared in KNOWN and declared > reads:
        reader = reader_of(subject.settings.distro, URDFDOM)
        message = f"URDF {declared} is not read by {reader}, which rejects the file"
        edits = _lowered(subject)
        more = "; --fix does it" if edits else " and what that version has"
        yield Problem(root, message, "version", f"write version {reads}{more}", edits)


@rule(
    "MB134",
    "capsule-in-gazebo",
    WARNING,
    what="A <capsule> in a robot for Gazebo.",
    why="sdformat's reader of URDF knows no capsules ('Unknown body type'): the visual or collision "
    "has no shape, and the link passes through others.",
    fix="Use a cylinder and two spheres, which is the same shape; --fix does where nothing refers to "
    "the collision by name.",
    bad=_robot("1.1", _visual('<capsule length="1" radius="0.1"/>'), '<gazebo reference="a"/>'),
    good=_robot("1.1", _visual('<sphere radius="0.1"/>'), '<gazebo reference="a"/>'),
    fixed=_robot(
        "1.1",
        _visual(
            '<cylinder length="1" radius="0.1"/>',
            '<visual><origin xyz="0 0 0.5"/><geometry><sphere radius="0.1"/></geometry></visual>',
            '<visual><origin xyz="0 0 -0.5"/><geometry><sphere radius="0.1"/></geometry></visual>',
        ),
        '<gazebo reference="a"/>',
    ),
    line=3,
)
def capsule_in_gazebo(subject: Subject) -> Iterator[Problem]:
    """One finding for a link, with a fix."""
    root = subject.document.root
    if next(root.iterchildren("gazebo"), None) is None:
        return
    for link, shapes in _links_with_capsules(subject):
        message = f"Gazebo reads no <capsule> of link {link.get('name')!r}"
        yield Problem(shapes[0], message, None, "", capsule_edits(_text(subject), link))


@rule(
    "MB135",
    "capsule-in-rviz",
    NOTE,
    what="A <visual> has a <capsule>, and the release's RViz draws none.",
    why="RViz says 'Unsupported geometry type for element: 4' and shows nothing for it.",
    fix="Use a cylinder and two spheres, or RViz 16.0.1 or later.",
    bad=_robot("1.1", _visual('<capsule length="1" radius="0.1"/>')),
    good=_robot("1.1", _visual('<cylinder length="1" radius="0.1"/>')),
    line=3,
)
def capsule_in_rviz(subject: Subject) -> Iterator[Problem]:
    """One finding for a link."""
    reader = reader_of(subject.settings.distro, RVIZ)
    for link, shapes in _links_with_capsules(subject, "visual"):
        if reader.reads != CAPSULE:
            message = f"{reader} draws no <capsule> of link {link.get('name')!r}"
            yield Problem(shapes[0], message)


@rule(
    "MB136",
    "quaternion-in-mujoco",
    WARNING,
    what="A quat_xyzw in a file of URDF 1.1 or 1.2 (checked with the target mjcf).",
    why="MuJoCo (4.0.0) reads rpy alone and says nothing: the joint or shape is not turned.",
    fix="Write rpy; --fix does.",
    bad=_robot("1.1", _joint(_TURNED)),
    good=_robot("1.1", _joint('<origin rpy="0 0 3.14"/>')),
    fixed=_robot("1.1", _joint('<origin rpy="0 0 3.141592653589793"/>')),
    line=6,
    options={"targets": ("mjcf",)},
)
def quaternion_in_mujoco(subject: Subject) -> Iterator[Problem]:
    """With a fix; what urdfdom does not read or refuses, other rules report."""
    root = subject.document.root
    if "mjcf" not in subject.settings.targets or version_of(root) < QUATERNIONS:
        return
    for origin in rotated_origins(root):
        if origin.get("rpy") is None:
            message = f"quat_xyzw is {origin.get('quat_xyzw')!r}, which MuJoCo does not read"
            edits = as_rpy(_text(subject), origin)
            yield Problem(origin, message, "quat_xyzw", "write rpy", edits)


def _links_with_capsules(
    subject: Subject, *holders: str
) -> Iterator[tuple[_Element, list[_Element]]]:
    """The links with capsules that urdfdom reads, and those in ``holders`` if any are named."""
    if version_of(subject.document.root) < QUATERNIONS or _reads(subject) < QUATERNIONS:
        return
    for link in subject.document.root.iterchildren("link"):
        shapes = [it for it, holder in capsules(link) if not holders or holder.tag in holders]
        if shapes:
            yield link, shapes


def _reads(subject: Subject) -> Version:
    """The highest version that the release's urdfdom reads."""
    return highest_version(subject.settings.distro)


@memoized
def _text(subject: Subject) -> Text:
    return text_of(subject.document)


@memoized
def _raised(subject: Subject) -> tuple[Edit, ...]:
    return raised(_text(subject), QUATERNIONS)


@memoized
def _lowered(subject: Subject) -> tuple[Edit, ...]:
    refused = any(it.kind in _REFUSED and it.level != WARNING for it in urdf_faults(subject))
    return () if refused else lowered(_text(subject))
