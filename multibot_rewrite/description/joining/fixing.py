# SPDX-License-Identifier: Apache-2.0
"""What fixes a part to a link: a new joint, or in place of its link ``world`` the joints on that.

Source: urdfdom pose.h: a joint's origin is the child's frame in the parent's.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from multibot_rewrite.base.loose_xml import ESCAPES
from multibot_rewrite.base.model import Edit, InputError
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.checks.links_and_joints import WORLD, Joint, read_robot
from multibot_rewrite.description.checks.poses import HERE, Pose, placed, pose_of, pose_of_six
from multibot_rewrite.description.checks.rotation import rpy_of
from multibot_rewrite.description.joining.kept import left_out, was
from multibot_rewrite.description.joining.part import ZERO, Part, ReadPart
from multibot_rewrite.description.steps.apply import cut
from multibot_rewrite.description.steps.document import tag_end, value_slot
from multibot_rewrite.description.steps.spans import Spans

_FREE = ("floating", "planar")
_MOUNT = """
  <joint name="{name}" type="fixed">
    {origin}
    <parent link="{parent}"/>
    <child link="{child}"/>
  </joint>"""


class Fixed(NamedTuple):
    """The edits that fix a part, the joint that they make, and what a person should know."""

    edits: tuple[Edit, ...]
    joint: str
    notes: tuple[str, ...] = ()


def fixed(part: ReadPart, spec: Part, spans: Spans) -> Fixed:
    """A part fixed to ``spec.at``; raises InputError for one that its link ``world`` prevents."""
    robot = read_robot(spans.document.root)
    if part.root != WORLD:
        name = f"{part.name}_mount"
        origin = _origin(pose_of_six(spec.pose), spec.pose)
        names = (it.translate(ESCAPES) for it in (spec.at, part.root))
        words = dict(zip(("parent", "child"), names, strict=True))
        at, _ = spans.inside(spans.document.root)
        text = _MOUNT.format(name=name, origin=origin, **words)
        return Fixed((was(at, at, b"", text.encode()),), name)
    return _without_world(part, spec, spans, robot.below.get(WORLD, ()))


def _without_world(part: ReadPart, spec: Part, spans: Spans, joints: Sequence[Joint]) -> Fixed:
    root = spans.document.root
    link = next(it for it in root.iterchildren("link") if it.get("name") == WORLD)
    if len(link) or not joints:
        what = "has shapes of its own" if len(link) else "is all it has"
        raise InputError(f"{part.file}: its link {WORLD!r} {what}; give that another name")
    free = next((it for it in joints if it.type in _FREE), None)
    if free is not None:
        raise InputError(f"{part.file}: joint {free.name!r} is {free.type}: nothing fixes the part")
    blocks = [it for it in root.iterchildren("gazebo") if it.get("reference") == WORLD]
    gone = (left_out(spans, it) for it in (link, *blocks))
    notes = (f"{part.file}:{it.sourceline}: left out: it is about {WORLD!r}" for it in blocks)
    moved = (_moved(part, it, spec, spans) for it in joints)
    return Fixed((*gone, *moved), "", tuple(notes))


def _moved(part: ReadPart, joint: Joint, spec: Part, spans: Spans) -> Edit:
    """A joint on the world, on the part's link in its place."""
    element = joint.element
    start, end = spans.start_of(element), spans.end_of(element)
    parent = joint.parts["parent"]
    source = spans.document.source
    slot = value_slot(source, spans.start_of(parent), "link", joint.parent)
    if slot is None:
        raise InputError(f"{part.file}: <parent> of {joint.name!r}: write its link as plain text")
    edits = [Edit(*slot, spec.at.translate(ESCAPES).encode(), None)]
    edits += _turned(part, joint, spec.pose, spans)
    new = b"".join(cut(source[:end], sorted(edits, key=lambda it: it.start)))[start:]
    return was(start, end, source[start:end], new)


def _turned(part: ReadPart, joint: Joint, pose: Sequence[float], spans: Spans) -> Iterator[Edit]:
    """The origin of a joint as it is from the part's link."""
    if tuple(pose) == ZERO:
        return
    old = joint.parts.get("origin")
    inner = pose_of(old)
    if inner is None:
        raise InputError(f"{part.file}: the origin of {joint.name!r} is no six numbers")
    outer = pose_of_six(pose)
    text = _origin(outer, pose) if inner == HERE else _origin(placed(outer, inner))
    start = spans.start_of(joint.element if old is None else old)
    if old is None:
        start = end = tag_end(spans.document.source, start)
    else:
        end = spans.end_of(old)
    yield Edit(start, end, text.encode(), None)


def _origin(pose: Pose, given: Sequence[float] = ()) -> str:
    """``<origin>``, in the numbers that were given where they are."""
    six = given or [round(it, 15) for it in (*pose.at, *rpy_of(pose.matrix))]
    words = [repr(float(it) + 0.0).removesuffix(".0") for it in six]
    return f'<origin xyz="{" ".join(words[:3])}" rpy="{" ".join(words[3:])}"/>'
