# SPDX-License-Identifier: Apache-2.0
"""An SDF model -> links with shapes, and joints, as the view draws them.

Source: sdformat.org, "Pose Frame Semantics": a pose is in the frame ``relative_to``; else that of a
joint is in its child, of a frame in what it is attached to, of all others in its model.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import pi, radians
from typing import cast

from lxml.etree import _Element

from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.checks.numbers import Vector, numbers, vector
from multibot_rewrite.description.checks.poses import HERE, Pose, minus, placed, sdf_pose
from multibot_rewrite.description.checks.rotation import inverse, matrix_of_quaternion, turned
from multibot_rewrite.pages.view.models import (
    UNCOLOURED,
    Joint,
    Matrix,
    Model,
    Shape,
    matrix_of,
    mesh_shape,
)

MODEL = "__model__"
_FRAMES = ("link", "joint", "frame", "model")
_TURNING = ("revolute", "continuous")
# Of a joint without limits; SDF's own default is 1e16.
_LONGEST = 10.0


def load_sdf(root: _Element, source: str) -> Model:
    """The first model of an SDF; ``source`` is the file it was made from. A link's frame is that of the
    joint above it, as in a URDF, and so on tf (sdformat_urdf README.md).

    Raises InputError for an SDF without a model, or with poses that depend on each other.
    """
    model = next(root.iter("model"), None)
    if model is None:
        raise InputError(f"{source}: it has no <model> to show")
    frames = _Frames({it.name: it for it in _named(model, "")}, source)
    links = [it for it in frames.named.values() if it.tag == "link"]
    ends = _ends(frames)
    at = {it.name: frames.pose(ends[it.name].joint if it.name in ends else it.name) for it in links}
    shapes = {it.name: tuple(_shapes(it, frames, at[it.name])) for it in links}
    joints = [_joint(frames, it, at) for it in ends.values()]
    loose = [name for name in at if name not in ends]
    if [at[it] for it in loose] == [HERE]:
        return Model(shapes, tuple(joints))
    return Model({MODEL: (), **shapes}, (*(_fixed(it, at[it]) for it in loose), *joints))


def declared(root: _Element) -> dict[str, int]:
    """The line of each link, joint, frame and nested model of the first model."""
    model = next(root.iter("model"))
    return {it.name: line_of(it.element) for it in _named(model, "")}


def line_of(element: _Element) -> int:
    """Where an element begins."""
    return cast("int", element.sourceline)


class _Named(NamedTuple):
    """A link, joint, frame or nested model; ``scope`` is the model that it is in, with its ``::``."""

    name: str
    element: _Element
    scope: str

    @property
    def tag(self) -> str:
        return str(self.element.tag)

    def text(self, path: str) -> str:
        """The text of an element below, without spaces around."""
        return (self.element.findtext(path) or "").strip()

    def within(self, name: str) -> str:
        """A name of its model, from the top."""
        if name == MODEL:
            return self.scope.removesuffix("::")
        return name if name == "world" else f"{self.scope}{name}"


def _named(model: _Element, scope: str) -> Iterator[_Named]:
    for it in model.iterchildren(*_FRAMES):
        name = f"{scope}{it.get('name', '')}"
        yield _Named(name, it, scope)
        if it.tag == "model":
            yield from _named(it, f"{name}::")


class _Frames(NamedTuple):
    """All that poses can be relative to, by its name from the top."""

    named: dict[str, _Named]
    source: str

    def pose(self, name: str, below: tuple[str, ...] = ()) -> Pose:
        """Where a frame is in the top model, whose own name is empty."""
        it = self.named.get(name)
        if it is None:
            return HERE
        if name in below:
            raise InputError(f"{self.source}: the pose of {name!r} depends on itself")
        written = it.element.find("pose")
        relative = "" if written is None else written.get("relative_to", "")
        base = it.within(relative or self._base(it))
        return placed(self.pose(base, (*below, name)), _pose(written))

    def _base(self, it: _Named) -> str:
        if it.tag == "joint":
            return it.text("child")
        return it.element.get("attached_to", "") or MODEL

    def link(self, name: str) -> str:
        """The link that a frame or joint belongs to."""
        for _ in self.named:
            it = self.named.get(name)
            if it is None or it.tag == "link":
                return name
            if it.tag == "model":
                first = next((n for n in self.named.values() if n.scope == f"{name}::"), it)
                canonical = it.element.get("canonical_link", "")
                name = f"{name}::{canonical}" if canonical else first.name
            else:
                name = it.within(self._base(it))
        return name


def _pose(written: _Element | None) -> Pose:
    """A ``<pose>``; one that is no pose counts as none, the lint reports it."""
    if written is None:
        return HERE
    values = numbers(written.text or "") or ()
    if written.get("rotation_format") == "quat_xyzw" and len(values) == 7:
        x, y, z, *turn = values
        return Pose((x, y, z), matrix_of_quaternion((turn[0], turn[1], turn[2], turn[3])))
    if written.get("degrees") in ("true", "1") and len(values) == 6:
        return sdf_pose(" ".join(map(repr, (*values[:3], *map(radians, values[3:]))))) or HERE
    return sdf_pose(written.text or "") or HERE


class _Ends(NamedTuple):
    """A joint, and the links that it is between."""

    joint: str
    parent: str
    child: str


def _ends(frames: _Frames) -> dict[str, _Ends]:
    """The joint above each link. A second joint of a link closes a loop, a tree has the first."""
    found: dict[str, _Ends] = {}
    for it in frames.named.values():
        if it.tag == "joint":
            parent, child = (frames.link(it.within(it.text(end))) for end in ("parent", "child"))
            if {parent, child} <= frames.named.keys():
                found.setdefault(child, _Ends(it.name, parent, child))
    return found


def _joint(frames: _Frames, ends: _Ends, at: dict[str, Pose]) -> Joint:
    it = frames.named[ends.joint]
    written = it.element.find("axis/xyz")
    axis = (None if written is None else vector(written.text or "")) or (0.0, 0.0, 1.0)
    within = "" if written is None else written.get("expressed_in", "")
    if within:
        turn = frames.pose(it.within(within)).matrix
        axis = turned(inverse(at[ends.child].matrix), turned(turn, axis))
    kind = it.element.get("type", "")
    pose = matrix_of(_relative(at[ends.parent], at[ends.child]))
    return Joint(*ends[:1], kind, *ends[1:], pose, axis, *_limits(it, kind), None)


def _limits(it: _Named, kind: str) -> tuple[float, float]:
    """Metres or radians, from one end to the other."""
    if kind not in (*_TURNING, "prismatic"):
        return 0.0, 0.0
    most = pi if kind in _TURNING else _LONGEST
    ends = (numbers(it.text(f"axis/limit/{end}")) for end in ("lower", "upper"))
    lower, upper = (end[0] if end else sign * most for sign, end in zip((-1, 1), ends, strict=True))
    return max(lower, -most), min(upper, most)


def _relative(above: Pose, below: Pose) -> Pose:
    back = Pose((0.0, 0.0, 0.0), inverse(above.matrix))
    return placed(back, Pose(minus(below.at, above.at), below.matrix))


def _fixed(link: str, pose: Pose) -> Joint:
    """Where a link that no joint moves is."""
    return Joint(f"{link} in {MODEL}", "fixed", MODEL, link, matrix_of(pose), (1, 0, 0), 0, 0, None)


def _shapes(link: _Named, frames: _Frames, at: Pose) -> Iterator[Shape]:
    for visual in link.element.iterchildren("visual"):
        written = visual.find("pose")
        relative = "" if written is None else written.get("relative_to", "")
        base = frames.pose(link.within(relative) if relative else link.name)
        pose = matrix_of(_relative(at, placed(base, _pose(written))))
        colour = numbers(visual.findtext("material/diffuse") or "") or ()
        colour = colour if len(colour) == 4 else (*colour, 1.0) if len(colour) == 3 else UNCOLOURED
        for it in visual.iterfind("geometry/*"):
            yield from _shape(it, pose, colour, frames.source)


def _shape(
    it: _Element, pose: Matrix, colour: Vector | tuple[float, ...], source: str
) -> Iterator[Shape]:
    size = [numbers(it.findtext(name) or "") for name in ("size", "radius", "length", "scale")]
    box, radius, long, scale = (values or () for values in size)
    if it.tag == "box" and len(box) == 3:
        yield Shape("box", box, pose, colour)
    elif it.tag in ("cylinder", "capsule") and radius and long:
        yield Shape("cylinder", (radius[0], long[0]), pose, colour)
    elif it.tag == "sphere" and radius:
        yield Shape("sphere", (radius[0],), pose, colour)
    elif it.tag == "mesh":
        uri = (it.findtext("uri") or "").strip()
        yield mesh_shape(uri, scale if len(scale) == 3 else (1.0, 1.0, 1.0), pose, colour, source)
