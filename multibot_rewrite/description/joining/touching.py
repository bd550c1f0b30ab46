# SPDX-License-Identifier: Apache-2.0
"""Pairs of links of two parts that never touch, or always, in random poses, by pinocchio.

As MoveIt's Setup Assistant has it: compute_default_collisions.cpp (``disableNeverInCollision``,
``disableAlwaysInCollision``) samples the whole robot within its limits. A joint that mimics another one
moves by itself here, so that a pair is rather called one that may touch.
"""

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from importlib import import_module
from itertools import product
from math import cos, isfinite, pi, sin
from random import Random
from typing import Any, NamedTuple
from urllib.parse import unquote

from lxml import etree
from lxml.etree import _Element

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.description.sources.packages import package_folder

NEVER, ALWAYS = "Never", "Always"
# For a joint without limits, metres or radians.
_FREE = pi
# Of a continuous joint pinocchio has the cosine and the sine.
_CIRCLE = 2
_SEED = 34
Pair = tuple[str, str]


class Touching(NamedTuple):
    """Pairs of links with ``NEVER`` or ``ALWAYS``, and links without a readable shape, and why."""

    reasons: Mapping[Pair, str]
    unknown: Mapping[str, str]


def touching(
    described: _Element, pairs: Iterable[Pair], files: Mapping[str, str], samples: int
) -> Touching:
    """Return which pairs of links always or never touch in ``samples`` random poses.

    ``files`` are the descriptions of links. Raises UsageError without pinocchio, InputError for
    a description that it does not read."""
    root = etree.fromstring(etree.tostring(described))
    unknown = dict(_with_files(root, files))
    text = etree.tostring(root).decode()
    asked = [it for it in pairs if not unknown.keys() & set(it)]
    scene = _scene(_import_pinocchio(), text, asked)
    # What two samples differ in is settled, and not looked at again.
    found: dict[Pair, bool] = {}
    left = list(asked)
    random = Random(_SEED)
    for number in range(samples):
        touch = scene(random, left)
        if number:
            left = [it for it in left if touch[it] == found[it]]
        else:
            found = dict(touch)
    return Touching({it: ALWAYS if found[it] else NEVER for it in left if it in found}, unknown)


def _import_pinocchio() -> Any:
    try:
        return import_module("pinocchio")
    except ImportError as error:
        what = "random poses need pinocchio, which is not installed"
        raise UsageError(f"{what}; pip install pin, or leave out samples ({error})") from None


def _scene(
    pin: Any, text: str, pairs: Sequence[Pair]
) -> Callable[[Random, Sequence[Pair]], Mapping[Pair, bool]]:
    """Return a function that tells which of some pairs touch in a random pose."""
    try:
        model = pin.buildModelFromXML(text)
        shapes = pin.buildGeomFromUrdfString(model, text, pin.GeometryType.COLLISION)
    except (ValueError, RuntimeError) as error:
        reason = " ".join(str(error).split())
        raise InputError(f"pinocchio refuses it, leave out samples: {reason}") from None
    numbers = _numbered(pin, model, shapes, pairs)
    data, placed = model.createData(), shapes.createData()

    def touch(random: Random, left: Sequence[Pair]) -> Mapping[Pair, bool]:
        """Return which of the pairs that are ``left`` touch in a new random pose."""
        pin.updateGeometryPlacements(model, data, shapes, placed, _pose(pin, model, random))
        return {
            it: any(pin.computeCollision(shapes, placed, at) for at in numbers.get(it, ()))
            for it in left
        }

    return touch


def _numbered(pin: Any, model: Any, shapes: Any, pairs: Iterable[Pair]) -> dict[Pair, list[int]]:
    """Return the numbers of the shape pairs of each pair of links, and add them to the shapes."""
    every = enumerate(shapes.geometryObjects)
    own = lists_by_key((model.frames[it.parentFrame].name, at) for at, it in every)
    numbers: dict[Pair, list[int]] = {}
    for one, other in pairs:
        for ends in product(own.get(one, ()), own.get(other, ())):
            numbers.setdefault((one, other), []).append(len(shapes.collisionPairs))
            shapes.addCollisionPair(pin.CollisionPair(*ends))
    return numbers


def _pose(pin: Any, model: Any, random: Random) -> Any:
    """Return a random pose within the limits."""
    pose = pin.neutral(model)
    for joint in list(model.joints)[1:]:
        at = joint.idx_q
        if joint.nq == _CIRCLE and joint.nv == 1:
            angle = random.uniform(-pi, pi)
            pose[at], pose[at + 1] = cos(angle), sin(angle)
        elif joint.nq == 1:
            ends = model.lowerPositionLimit[at], model.upperPositionLimit[at]
            known = all(map(isfinite, ends)) and max(map(abs, ends)) < 1e3
            pose[at] = random.uniform(*(ends if known else (-_FREE, _FREE)))
    return pose


def _with_files(root: _Element, files: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    """Set paths in collision meshes; yield (link, file) of missing ones, without these shapes."""
    for link in root.iterchildren("link"):
        name = link.get("name", "")
        for it in link.findall("visual"):
            link.remove(it)
        meshes = link.iterfind("collision/geometry/mesh")
        paths = [(it, _path(it.get("filename", ""), files.get(name, ""))) for it in meshes]
        lost = next((mesh for mesh, path in paths if not os.path.isfile(path)), None)
        if lost is not None:
            yield name, f"the mesh {lost.get('filename', '')} is not there"
            for it in link.findall("collision"):
                link.remove(it)
            continue
        for mesh, path in paths:
            mesh.set("filename", path)


def _path(name: str, file: str) -> str:
    """Return the file of a mesh that the description ``file`` names; empty if it is not known."""
    scheme, is_url, rest = name.partition("://")
    folder = os.path.dirname(file.removesuffix(" (expanded)"))
    if not is_url:
        return os.path.abspath(os.path.join(folder, name))
    if scheme == "file":
        return unquote(rest)
    package, _, path = rest.partition("/")
    found = package_folder(package, file, ()) if scheme == "package" else ""
    return os.path.join(found, path) if found else ""
