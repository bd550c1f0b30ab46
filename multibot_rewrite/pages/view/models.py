# SPDX-License-Identifier: Apache-2.0
"""What the view draws of a robot: links with shapes, joints, meshes, and how a URDF says them. The only
import of trimesh.

Meshes are looked for as ROS does: package://, file://, and paths next to the description.

Source of a URDF: urdfdom urdf_parser: a material without a colour is that of its name in the robot; an
axis is x, a mimic's factor 1 where none is written. What is no number counts as missing: the lint
reports it.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from importlib import import_module
from math import pi
from typing import Any, NamedTuple

from lxml.etree import _Element

from multibot_rewrite.base.model import Unusable
from multibot_rewrite.description.checks.numbers import numbers, vector
from multibot_rewrite.description.checks.poses import HERE, Pose, X, origin_of
from multibot_rewrite.description.sources.packages import package_folder

INSTALL = "the view needs trimesh: pip install 'multibot_rewrite[view]'"
# Of larger meshes the bounding box is shown, or the page would not load.
MOST_FACES = 200_000
# A mesh file is read whole.
MOST_BYTES = 256 * 1024 * 1024
# A shape for which the file gives no colour: the page gives it the colour of its robot.
Colour = tuple[float, ...]
UNCOLOURED: Colour = ()
_LIBRARY_END = "THREE.GLTFLoader=GLTFLoader;})();"
Matrix = Sequence[Sequence[float]]


class Shape(NamedTuple):
    """A shape in its link's frame: ``kind`` is box, cylinder, sphere or mesh, ``size`` its sizes in
    metres (a mesh's scale). ``mesh`` is its file, ``missing`` why it is shown as a box. ``colour``
    is red, green, blue, alpha, or empty where the description has none."""

    kind: str
    size: tuple[float, ...]
    pose: Matrix
    colour: tuple[float, ...]
    mesh: str = ""
    missing: str = ""


class Joint(NamedTuple):
    """A joint; ``lower`` and ``upper`` in radians or metres, equal for one that cannot move."""

    name: str
    type: str
    parent: str
    child: str
    pose: Matrix
    axis: tuple[float, ...]
    lower: float
    upper: float
    mimic: tuple[str, float, float] | None


class Model(NamedTuple):
    """A robot: its links with their shapes, its joints."""

    links: dict[str, tuple[Shape, ...]]
    joints: tuple[Joint, ...]


class Mesh(NamedTuple):
    """Vertices (x, y, z as 32-bit floats) and triangles (three 32-bit numbers of vertices); the colours
    (red, green, blue, a byte each) of the vertices where the file has materials."""

    vertices: bytes
    faces: bytes
    colours: bytes = b""


def mesh_shape(
    name: str, scale: tuple[float, ...], pose: Matrix, colour: tuple[float, ...], source: str
) -> Shape:
    """Return a mesh of the file ``source``, or a small box in its place."""
    path = find_mesh(name, source)
    if path:
        return Shape("mesh", scale, pose, colour, path)
    return Shape("box", (0.1, 0.1, 0.1), pose, colour, "", f"{name} is not found")


def find_mesh(name: str, source: str) -> str:
    """Return the file of a mesh's name, or "". Gazebo finds model:// in the folders of packages."""
    scheme, _, below = name.partition("://")
    if scheme in ("package", "model"):
        package, _, rest = below.partition("/")
        folder = package_folder(package, source, ())
        path = os.path.join(folder, rest) if folder else ""
    elif name.startswith("file://"):
        path = name.removeprefix("file://")
    else:
        path = os.path.join(os.path.dirname(source), name)
    return path if path and os.path.isfile(path) else ""


def prepare_meshes() -> None:
    """Load the reader once, for the workers that are forked from this process; raises Unusable."""
    try:
        import_module("trimesh")
    except ImportError:
        raise Unusable(INSTALL) from None


def load_mesh(path: str) -> Mesh | str:
    """Return a mesh file, or the reason why it cannot be shown."""
    import numpy as np
    import trimesh

    name = os.path.basename(path)
    try:
        if os.path.getsize(path) > MOST_BYTES:
            return f"{name} is larger than {MOST_BYTES >> 20} MiB"
        made: Any = trimesh.load(path, force="mesh", process=False)
    except Exception as error:  # each format has errors of its own
        return f"{name}: {str(error) or type(error).__name__}"
    if not len(getattr(made, "faces", ())):
        return f"{name} has no triangles"
    if len(made.faces) > MOST_FACES:
        made = made.bounding_box
    vertices = np.asarray(made.vertices, dtype="<f4").tobytes()
    return Mesh(vertices, np.asarray(made.faces, dtype="<u4").tobytes(), _colours(made))


def _colours(mesh: Any) -> bytes:
    """Return the colours that the file gives its vertices, by a material, a picture or one each."""
    visual = mesh.visual
    with suppress(Exception):  # a picture that is not there, or of a format that nothing here reads
        if visual.kind == "texture" and visual.uv is None:
            return bytes(visual.material.main_color[:3]) * len(mesh.vertices)
        if visual.kind:
            coloured = visual.to_color() if visual.kind == "texture" else visual
            return bytes(coloured.vertex_colors[:, :3].astype("u1").tobytes())
    return b""


def matrix_of(pose: Pose) -> Matrix:
    """Return the four rows of a pose."""
    rows = zip(pose.matrix, pose.at, strict=True)
    return [*([*(round(it, 9) for it in row), round(at, 9)] for row, at in rows), [0, 0, 0, 1]]


def three() -> str:
    """Return three.js with its trackball controls, from trimesh; raises Unusable. Source: trimesh
    resources/templates/viewer.zip (three.js, MIT)."""
    import zipfile

    prepare_meshes()
    import trimesh

    path = os.path.join(os.path.dirname(trimesh.__file__), "resources", "templates", "viewer.zip")
    with zipfile.ZipFile(path) as archive:
        text = archive.read("viewer.html.template").decode()
    scripts = [part.partition("</script>")[0] for part in text.split("<script>")[1:]]
    # What follows the last part of the library is trimesh's own viewer.
    library, end, _ = "\n".join(scripts).partition(_LIBRARY_END)
    return library + end


def load_urdf(root: _Element, source: str) -> Model:
    """Return the model of a URDF; ``source`` is the file it was made from. Raises nothing."""
    named = {it.get("name", ""): _rgba(it) for it in root.iterchildren("material")}
    links = {
        it.get("name", ""): tuple(_shapes(it, named, source)) for it in root.iterchildren("link")
    }
    return Model(links, tuple(map(_joint, root.iterchildren("joint"))))


def _rgba(material: _Element | None) -> Colour:
    written = None if material is None else material.find("color")
    found = None if written is None else numbers(written.get("rgba", ""))
    return found if found and len(found) == 4 else UNCOLOURED


def _pose(element: _Element) -> Matrix:
    return matrix_of(origin_of(element) or HERE)


def _shapes(link: _Element, named: Mapping[str, Colour], source: str) -> Iterator[Shape]:
    for visual in link.iterchildren("visual"):
        material = visual.find("material")
        name = "" if material is None else material.get("name", "")
        colour = _rgba(material) or named.get(name, UNCOLOURED)
        for it in visual.iterfind("geometry/*"):
            yield from _shape(it, _pose(visual), colour, source)


def _shape(it: _Element, pose: Matrix, colour: Colour, source: str) -> Iterator[Shape]:
    size = vector(it.get("size", ""))
    radius, long = (numbers(it.get(name, "")) for name in ("radius", "length"))
    if it.tag == "box" and size:
        yield Shape("box", size, pose, colour)
    elif it.tag in ("cylinder", "capsule") and radius and long:
        yield Shape("cylinder", (radius[0], long[0]), pose, colour)
    elif it.tag == "sphere" and radius:
        yield Shape("sphere", radius[:1], pose, colour)
    elif it.tag == "mesh":
        scale = vector(it.get("scale", "")) or (1.0, 1.0, 1.0)
        yield mesh_shape(it.get("filename", ""), scale, pose, colour, source)


def _joint(it: _Element) -> Joint:
    parent, child = (_named(it, tag, "link") for tag in ("parent", "child"))
    axis = it.find("axis")
    kind, lower, upper = it.get("type", ""), 0.0, 0.0
    if kind == "continuous":
        lower, upper = -round(pi, 4), round(pi, 4)
    elif kind in ("revolute", "prismatic"):
        lower, upper = (_number(it, "limit", key, 0.0) for key in ("lower", "upper"))
    factor, offset = _number(it, "mimic", "multiplier", 1.0), _number(it, "mimic", "offset", 0.0)
    leader = _named(it, "mimic", "joint")
    return Joint(
        it.get("name", ""),
        kind,
        parent,
        child,
        _pose(it),
        X if axis is None else vector(axis.get("xyz", "")) or X,
        lower,
        upper,
        (leader, factor, offset) if leader else None,
    )


def _named(joint: _Element, tag: str, key: str) -> str:
    found = joint.find(tag)
    return "" if found is None else found.get(key, "")


def _number(joint: _Element, tag: str, key: str, default: float) -> float:
    found = numbers(_named(joint, tag, key))
    return found[0] if found else default
