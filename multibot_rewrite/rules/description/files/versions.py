# SPDX-License-Identifier: Apache-2.0
"""Versions of URDF: what the declared one does not read, and what the release's programs do not."""

from __future__ import annotations

from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, rule
from multibot_rewrite.base.model import Edit
from multibot_rewrite.description.checks.poses import length_of, quaternion
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules import convert
from multibot_rewrite.rules.facts.faults import faults, urdf_faults
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.schema import versions
from multibot_rewrite.rules.subject import Subject

QUATERNIONS = versions.KNOWN[1]
# What makes another version another file than the one that is read now.
_REFUSED = ("word", "missing", "value", "range", "rotation-twice")


@rule("MB126", "rotation-twice", ERROR)
def rotation_twice(subject: Subject) -> Iterator[Problem]:
    """Report a rotation that is written twice, with a fix if both are the same."""
    for it in faults("rotation-twice", subject):
        yield it._replace(edits=convert.one_rotation(_text(subject), it.element, "rpy"))


@rule("MB127", "no-rotation", WARNING)
def no_rotation(subject: Subject) -> Iterator[Problem]:
    """Report quaternions that cannot be made one of length 1."""
    if versions.version_of(subject.document.root) < QUATERNIONS:
        return
    for origin in convert.rotated_origins(subject.document.root):
        turn = quaternion(origin)
        if turn is not None and not 0 < length_of(turn) < float("inf"):
            message = f"quat_xyzw is {origin.get('quat_xyzw')!r}, which is no rotation"
            yield Problem(origin, message, "quat_xyzw")


@rule("MB128", "needs-later-version", WARNING)
def needs_later_version(subject: Subject) -> Iterator[Problem]:
    """Report what needs a later URDF version, with a fix that keeps the pose in the file."""
    hint = 'write version="1.1" in <robot>' if _version_read(subject) >= QUATERNIONS else ""
    for it in faults("needs-later-version", subject):
        yield it._replace(edits=_readable_edits(subject, it.element), hint=hint)


def _readable_edits(subject: Subject, element: _Element) -> tuple[Edit, ...]:
    """Return the edits that make the release's urdfdom read an element of a later version."""
    text = _text(subject)
    link = next(element.iterancestors("link"), None)
    if element.tag == versions.CAPSULE:
        return () if link is None else convert.capsule_edits(text, link)
    if element.get("rpy") is None and _version_read(subject) >= QUATERNIONS:
        return _raised_version(subject)
    return convert.as_rpy(text, element)


@rule("MB129", "ignored-limit", NOTE)
def ignored_limit(subject: Subject) -> Iterator[Problem]:
    """Report limits that came with version 1.2; one finding for a <limit>."""
    newest = versions.KNOWN[-1]
    reads = _version_read(subject)
    hint = (
        f'write version="{newest}" in <robot>'
        if reads >= newest
        else "delete it: this release ignores it"
    )
    read = min(versions.version_of(subject.document.root), reads) >= newest
    for joint in subject.robot.joints if not read else ():
        limit = joint.parts.get("limit")
        given = () if limit is None else limit.keys()
        there = [it for it in ("acceleration", "deceleration", "jerk") if it in given]
        if limit is not None and there:
            verb = "are" if there[1:] else "is"
            message = f"joint {joint.name!r}: {' and '.join(there)} {verb} not read"
            yield Problem(limit, message, there[0], hint)


@rule("MB133", "version-of-release", ERROR, options={"distro": "jazzy"})
def version_of_release(subject: Subject) -> Iterator[Problem]:
    """Report a URDF version that the release lacks, with a fix if 1.0 means the same."""
    root = subject.document.root
    declared, reads = versions.read_version(root.get("version", "")), _version_read(subject)
    if root.tag == "robot" and declared in versions.KNOWN and declared > reads:
        reader = versions.reader_of(subject.settings.distro, versions.URDFDOM)
        message = f"URDF {declared} is not read by {reader}, which rejects the file"
        edits = _lowered_version(subject)
        more = "; --fix does it" if edits else " and what that version has"
        yield Problem(root, message, "version", f"write version {reads}{more}", edits)


@rule("MB134", "capsule-in-gazebo", WARNING)
def capsule_in_gazebo(subject: Subject) -> Iterator[Problem]:
    """Report capsules, one finding for a link, with a fix."""
    root = subject.document.root
    if next(root.iterchildren("gazebo"), None) is None:
        return
    for link, shapes in _links_with_capsules(subject):
        message = f"Gazebo reads no <capsule> of link {link.get('name')!r}"
        yield Problem(shapes[0], message, None, "", convert.capsule_edits(_text(subject), link))


@rule("MB135", "capsule-in-rviz", NOTE)
def capsule_in_rviz(subject: Subject) -> Iterator[Problem]:
    """Report capsules, one finding for a link."""
    reader = versions.reader_of(subject.settings.distro, versions.RVIZ)
    for link, shapes in _links_with_capsules(subject, "visual"):
        if reader.reads != versions.CAPSULE:
            message = f"{reader} draws no <capsule> of link {link.get('name')!r}"
            yield Problem(shapes[0], message)


@rule("MB136", "quaternion-in-mujoco", WARNING, options={"targets": ("mjcf",)})
def quaternion_in_mujoco(subject: Subject) -> Iterator[Problem]:
    """Report quaternions that MuJoCo ignores, with a fix; other rules report what urdfdom refuses."""
    root = subject.document.root
    if "mjcf" not in subject.settings.targets or versions.version_of(root) < QUATERNIONS:
        return
    for origin in convert.rotated_origins(root):
        if origin.get("rpy") is None:
            message = f"quat_xyzw is {origin.get('quat_xyzw')!r}, which MuJoCo does not read"
            edits = convert.as_rpy(_text(subject), origin)
            yield Problem(origin, message, "quat_xyzw", "write rpy", edits)


def _links_with_capsules(
    subject: Subject, *holders: str
) -> Iterator[tuple[_Element, list[_Element]]]:
    """Yield the links with capsules that urdfdom reads; with ``holders`` only capsules inside those."""
    if (
        versions.version_of(subject.document.root) < QUATERNIONS
        or _version_read(subject) < QUATERNIONS
    ):
        return
    for link in subject.document.root.iterchildren("link"):
        shapes = [
            it for it, holder in convert.capsules(link) if not holders or holder.tag in holders
        ]
        if shapes:
            yield link, shapes


def _version_read(subject: Subject) -> versions.Version:
    """Return the highest version that the release's urdfdom reads."""
    return versions.highest_version(subject.settings.distro)


@memoized
def _text(subject: Subject) -> convert.Spanned:
    """Return the description's text, with where its elements start."""
    return convert.text_of(subject.document)


@memoized
def _raised_version(subject: Subject) -> tuple[Edit, ...]:
    return convert.raised(_text(subject), QUATERNIONS)


@memoized
def _lowered_version(subject: Subject) -> tuple[Edit, ...]:
    refused = any(it.code in _REFUSED and it.level != WARNING for it in urdf_faults(subject))
    return () if refused else convert.lowered(_text(subject))
