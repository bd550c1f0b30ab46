# SPDX-License-Identifier: Apache-2.0
"""Where the links, joints and frames of an SDF model are.

Source: sdformat.org, "Pose Frame Semantics": a pose is in the frame ``relative_to``; else that of a
joint is in its child, of a frame in what it is attached to, of all others in its model.
"""

from collections.abc import Iterator
from math import radians
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.base.model import InputError
from multibot_rewrite.description.checks.numbers import numbers
from multibot_rewrite.description.checks.poses import (
    HERE,
    Pose,
    inverse,
    matrix_of_quaternion,
    minus,
    placed,
    sdf_pose,
)

MODEL = "__model__"


class Named(NamedTuple):
    """A link, joint, frame or nested model; ``scope`` is the model that it is in, with its ``::``."""

    name: str
    element: _Element
    scope: str

    @property
    def tag(self) -> str:
        """Return the element's tag."""
        return str(self.element.tag)

    def text(self, path: str) -> str:
        """Return the text of an element below, without spaces around."""
        return (self.element.findtext(path) or "").strip()

    def within(self, name: str) -> str:
        """Return the full name, from the top, of a name in its model."""
        if name == MODEL:
            return self.scope.removesuffix("::")
        return name if name == "world" else f"{self.scope}{name}"


def named_in(model: _Element, scope: str) -> Iterator[Named]:
    """Yield the named elements of a model and of those in it, with their scopes."""
    for it in model.iterchildren("link", "joint", "frame", "model"):
        name = f"{scope}{it.get('name', '')}"
        yield Named(name, it, scope)
        if it.tag == "model":
            yield from named_in(it, f"{name}::")


class Frames(NamedTuple):
    """All that poses can be relative to, by its name from the top."""

    named: dict[str, Named]
    source: str

    def pose(self, name: str, below: tuple[str, ...] = ()) -> Pose:
        """Return the pose of a frame in the top model, whose own name is empty."""
        it = self.named.get(name)
        if it is None:
            return HERE
        if name in below:
            raise InputError(
                f"{self.source}: the pose of {name!r} depends on itself; correct relative_to"
            )
        written = it.element.find("pose")
        relative = "" if written is None else written.get("relative_to", "")
        base = it.within(relative or self._attached_to(it))
        return placed(self.pose(base, (*below, name)), written_pose(written))

    def _attached_to(self, it: Named) -> str:
        """Return what a joint or frame moves with: a joint's child, or ``attached_to``."""
        if it.tag == "joint":
            return it.text("child")
        return it.element.get("attached_to", "") or MODEL

    def link(self, name: str) -> str:
        """Return the link that a frame or joint is attached to."""
        for _ in self.named:
            it = self.named.get(name)
            if it is None or it.tag == "link":
                return name
            if it.tag == "model":
                first = next((n for n in self.named.values() if n.scope == f"{name}::"), it)
                canonical = it.element.get("canonical_link", "")
                name = f"{name}::{canonical}" if canonical else first.name
            else:
                name = it.within(self._attached_to(it))
        return name


def written_pose(written: _Element | None) -> Pose:
    """Return the pose in a ``<pose>``; an invalid one counts as none, and the lint reports it."""
    if written is None:
        return HERE
    values = numbers(written.text or "") or ()
    if written.get("rotation_format") == "quat_xyzw" and len(values) == 7:
        x, y, z, *turn = values
        return Pose((x, y, z), matrix_of_quaternion((turn[0], turn[1], turn[2], turn[3])))
    if written.get("degrees") in ("true", "1") and len(values) == 6:
        return sdf_pose(" ".join(map(repr, (*values[:3], *map(radians, values[3:]))))) or HERE
    return sdf_pose(written.text or "") or HERE


class JointEnds(NamedTuple):
    """A joint, and the links that it is between."""

    joint: str
    parent: str
    child: str


def ends_of(frames: Frames) -> dict[str, JointEnds]:
    """Return the joint above each link; a second one closes a loop and is left out."""
    found: dict[str, JointEnds] = {}
    for it in frames.named.values():
        if it.tag == "joint":
            parent, child = (frames.link(it.within(it.text(end))) for end in ("parent", "child"))
            if {parent, child} <= frames.named.keys():
                found.setdefault(child, JointEnds(it.name, parent, child))
    return found


def seen_from(above: Pose, below: Pose) -> Pose:
    """Return the pose ``below`` in the frame of ``above``."""
    back = Pose((0.0, 0.0, 0.0), inverse(above.matrix))
    return placed(back, Pose(minus(below.at, above.at), below.matrix))
