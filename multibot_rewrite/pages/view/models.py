# SPDX-License-Identifier: Apache-2.0
"""What the view draws of a robot: links with shapes, joints, meshes, and a URDF as yourdfpy reads it.

The only import of yourdfpy and trimesh. Meshes are looked for as ROS does: package://, file://, and
paths next to the description. A material without a colour is that of its name in the robot (urdfdom
urdf_parser model.cpp)."""

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from copy import deepcopy
from importlib import import_module
from io import BytesIO
from math import isfinite, pi
from typing import Any, NamedTuple, cast

from lxml import etree
from lxml.etree import _Element

from multibot_rewrite.base.model import InputError, Unusable
from multibot_rewrite.description.checks.poses import HERE, Pose
from multibot_rewrite.description.sources.packages import package_folder

INSTALL = "the view needs yourdfpy and trimesh: pip install 'multibot_rewrite[view]'"
# Of larger meshes the bounding box is shown, or the page would not load.
MOST_FACES = 200_000
# A mesh file is read whole.
MOST_BYTES = 256 * 1024 * 1024
# A shape for which the file gives no colour: the page gives it the colour of its robot.
Colour = tuple[float, ...]
UNCOLOURED: Colour = ()
_LIBRARY_END = "THREE.GLTFLoader=GLTFLoader;})();"
Matrix = Sequence[Sequence[float]]
# What yourdfpy reads and nobody sees: a fault in it is none of the picture.
_SHAPES = "geometry/box | geometry/cylinder | geometry/sphere | geometry/mesh"
_NOT_DRAWN = ("inertial", "collision", "calibration", "safety_controller")


class Shape(NamedTuple):
    """A shape in its link's frame.

    ``kind`` is box, cylinder, sphere or mesh, ``size`` its sizes in metres (a mesh's scale).
    ``mesh`` is its file, ``missing`` why it is shown as a box. ``colour`` is red, green, blue,
    alpha, or empty where the description has none."""

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
    """Vertices and triangles, and the colours of the vertices where the file has materials.

    A vertex is x, y, z as 32-bit floats, a triangle three 32-bit numbers of vertices, a colour red,
    green, blue, a byte each."""

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
    """Load the readers once, for the workers that are forked from this process; raises Unusable."""
    try:
        import_module("trimesh")
        import_module("yourdfpy")
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


def three_js() -> str:
    """Return three.js with trackball controls, of trimesh's viewer.zip (MIT); raises Unusable."""
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
    """Return the model of a URDF as yourdfpy reads it; raises InputError, Unusable."""
    prepare_meshes()
    import yourdfpy

    drawn = deepcopy(root)
    etree.strip_elements(drawn, *_NOT_DRAWN, with_tail=False)
    for it in drawn.iter("capsule"):
        it.tag = "cylinder"
    for it in cast("list[Any]", drawn.xpath(f"link/visual[not({_SHAPES})]")):
        it.getparent().remove(it)
    text = BytesIO(etree.tostring(drawn))
    try:
        robot = yourdfpy.URDF.load(text, build_scene_graph=False).robot
        named = {it.name: _rgba(it) for it in robot.materials}
        links = {it.name: tuple(_shapes(it, named, source)) for it in robot.links}
        return Model(links, tuple(map(_joint, robot.joints)))
    except Exception as error:  # it has none of its own for most of them
        what = f"{source}: yourdfpy cannot read it: {str(error) or type(error).__name__}"
        raise InputError(f"{what}; urdf-lint finds the line") from None


def _finite(values: Iterable[float]) -> tuple[float, ...]:
    """Return numbers rounded to 9 digits; raises ValueError for NaN and infinity, which JSON lacks."""
    found = tuple(round(float(it), 9) for it in values)
    if not all(map(isfinite, found)):
        raise ValueError(f"{found} is not finite")
    return found


def _rgba(material: Any) -> Colour:
    """Return the colour of a material; ``UNCOLOURED`` if it has none."""
    found = material and material.color
    return _finite(found.rgba) if found and len(found.rgba) == 4 else UNCOLOURED


def _matrix(origin: Any) -> Matrix:
    """Return the matrix of an origin, in rows."""
    return matrix_of(HERE) if origin is None else [*map(_finite, origin)]


def _shapes(link: Any, named: Mapping[str, Colour], source: str) -> Iterator[Shape]:
    for it in link.visuals:
        colour = _rgba(it.material) or (it.material and named.get(it.material.name)) or UNCOLOURED
        pose, own = _matrix(it.origin), it.geometry
        if own.box:
            x, y, z = _finite(own.box.size)
            yield Shape("box", (x, y, z), pose, colour)
        elif own.cylinder:
            size = _finite((own.cylinder.radius, own.cylinder.length))
            yield Shape("cylinder", size, pose, colour)
        elif own.sphere:
            yield Shape("sphere", _finite([own.sphere.radius]), pose, colour)
        else:
            scale: Any = 1.0 if own.mesh.scale is None else own.mesh.scale
            size = _finite(scale if hasattr(scale, "__len__") else [scale] * 3)
            yield mesh_shape(own.mesh.filename, size, pose, colour, source)


def _joint(it: Any) -> Joint:
    kind, lower, upper = it.type or "", 0.0, 0.0
    if kind == "continuous":
        lower, upper = -round(pi, 4), round(pi, 4)
    elif it.limit and kind in ("revolute", "prismatic"):
        lower, upper = _finite((it.limit.lower or 0.0, it.limit.upper or 0.0))
    leader = it.mimic and it.mimic.joint
    factor, offset = _finite((it.mimic.multiplier, it.mimic.offset)) if leader else (1.0, 0.0)
    mimic = (leader, factor, offset) if leader else None
    pose, axis = _matrix(it.origin), _finite(it.axis)
    return Joint(it.name, kind, it.parent or "", it.child or "", pose, axis, lower, upper, mimic)
