# SPDX-License-Identifier: Apache-2.0
"""An SDF model -> links with shapes, and joints, as the view draws them."""

from __future__ import annotations

from collections.abc import Iterator
from math import pi
from typing import cast

from lxml.etree import _Element

from multibot_rewrite.base.model import InputError
from multibot_rewrite.description.checks.numbers import Vector, numbers, vector
from multibot_rewrite.description.checks.poses import HERE, Pose, inverse, placed, turned
from multibot_rewrite.description.checks.sdf_frames import (
    MODEL,
    Frames,
    JointEnds,
    Named,
    ends_of,
    named_in,
    seen_from,
    written_pose,
)
from multibot_rewrite.pages.view.models import (
    UNCOLOURED,
    Joint,
    Matrix,
    Model,
    Shape,
    matrix_of,
    mesh_shape,
)

_TURNING = ("revolute", "continuous")
# Of a joint without limits; SDF's own default is 1e16.
_LONGEST = 10.0


def load_sdf(root: _Element, source: str) -> Model:
    """Return the first model of an SDF; ``source`` is the file it was made from.

    A link's frame is that of the joint above it, as in a URDF, and so on tf (sdformat_urdf README.md).
    Raises InputError for an SDF without a model, or with poses that depend on each other.
    """
    model = next(root.iter("model"), None)
    if model is None:
        raise InputError(f"{source}: it has no <model> to show; name an SDF of a robot")
    frames = Frames({it.name: it for it in named_in(model, "")}, source)
    links = [it for it in frames.named.values() if it.tag == "link"]
    ends = ends_of(frames)
    at = {it.name: frames.pose(ends[it.name].joint if it.name in ends else it.name) for it in links}
    shapes = {it.name: tuple(_shapes(it, frames, at[it.name])) for it in links}
    joints = [_joint(frames, it, at) for it in ends.values()]
    loose = [name for name in at if name not in ends]
    if [at[it] for it in loose] == [HERE]:
        return Model(shapes, tuple(joints))
    # Where a link that no joint moves is.
    fixed = (
        Joint(f"{it} in {MODEL}", "fixed", MODEL, it, matrix_of(at[it]), (1, 0, 0), 0, 0, None)
        for it in loose
    )
    return Model({MODEL: (), **shapes}, (*fixed, *joints))


def lines_by_name(root: _Element) -> dict[str, int]:
    """Return the line of each link, joint, frame and nested model of the first model."""
    model = next(root.iter("model"))
    return {it.name: line_of(it.element) for it in named_in(model, "")}


def line_of(element: _Element) -> int:
    """Return the line where an element begins."""
    return cast("int", element.sourceline)


def _joint(frames: Frames, ends: JointEnds, at: dict[str, Pose]) -> Joint:
    it = frames.named[ends.joint]
    written = it.element.find("axis/xyz")
    axis = (None if written is None else vector(written.text or "")) or (0.0, 0.0, 1.0)
    within = "" if written is None else written.get("expressed_in", "")
    if within:
        turn = frames.pose(it.within(within)).matrix
        axis = turned(inverse(at[ends.child].matrix), turned(turn, axis))
    kind = it.element.get("type", "")
    pose = matrix_of(seen_from(at[ends.parent], at[ends.child]))
    return Joint(*ends[:1], kind, *ends[1:], pose, axis, *_limits(it, kind), None)


def _limits(it: Named, kind: str) -> tuple[float, float]:
    """Return the limits in metres or radians, lower and upper."""
    if kind not in (*_TURNING, "prismatic"):
        return 0.0, 0.0
    most = pi if kind in _TURNING else _LONGEST
    ends = (numbers(it.text(f"axis/limit/{end}")) for end in ("lower", "upper"))
    lower, upper = (end[0] if end else sign * most for sign, end in zip((-1, 1), ends, strict=True))
    return max(lower, -most), min(upper, most)


def _shapes(link: Named, frames: Frames, at: Pose) -> Iterator[Shape]:
    for visual in link.element.iterchildren("visual"):
        written = visual.find("pose")
        relative = "" if written is None else written.get("relative_to", "")
        base = frames.pose(link.within(relative) if relative else link.name)
        pose = matrix_of(seen_from(at, placed(base, written_pose(written))))
        colour = numbers(visual.findtext("material/diffuse") or "") or ()
        colour = colour if len(colour) == 4 else (*colour, 1.0) if len(colour) == 3 else UNCOLOURED
        for it in visual.iterfind("geometry/*"):
            yield from _shapes_of(it, pose, colour, frames.source)


def _shapes_of(
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
