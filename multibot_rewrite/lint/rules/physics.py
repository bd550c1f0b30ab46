"""MB6: mass, inertia and shapes."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from math import acos, cos, hypot, pi, sqrt

from lxml.etree import _Element

from multibot_rewrite.lint.facts.elements import Elements
from multibot_rewrite.lint.facts.numbers import Vector, numbers, vector
from multibot_rewrite.lint.facts.robot import MOMENTS, WORLD, Inertial, Link, Robot, reached
from multibot_rewrite.lint.records import NOTE, Problem, Subject, rule
from multibot_rewrite.model import ERROR, WARNING

# What MuJoCo takes for nothing (mjMINVAL).
NOTHING = 1e-15
# Relative; CAD programs print four digits and more.
ROUNDING = 0.01
TINY_MASS = 1e-6
# Radius of gyration: no robot under HEAVY kg is so long, no part so compact, none of a known size
# so much larger or smaller than it. A mass below LIGHT is a stand-in.
LONG, SHORT, HEAVY, LIGHT = 5.0, 1e-4, 500.0, 0.01
LARGER, SMALLER, SMALL_SHAPE = 50.0, 0.01, 0.01
LONG_SHAPE = 50.0
LARGE_SCALE, SMALL_SCALE, UNEVEN = 50.0, 1e-5, 100.0
# What urdfdom takes without a <capsule>; it reads one from version 1.1 on.
OLD_VERSIONS = ("1.0", "1")
SHAPES = {"box": ("size",), "cylinder": ("radius", "length"), "sphere": ("radius",)}

INERTIA = '<inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/>'
BOX = '<geometry><box size="1 1 1"/></geometry>'


def _inertial(mass: str = "1", inertia: str = INERTIA) -> str:
    """An example's mass and inertia."""
    return f'<inertial><mass value="{mass}"/>{inertia}</inertial>'


def _diagonal(ixx: str, iyy: str, izz: str, ixy: str = "0") -> str:
    return f'<inertia ixx="{ixx}" ixy="{ixy}" ixz="0" iyy="{iyy}" iyz="0" izz="{izz}"/>'


def _link(inside: str) -> str:
    return f'<link name="a">{inside}</link>'


def _moving(inside: str) -> str:
    """An example: a link on a wheel's joint."""
    return (
        f'{_link(_inertial())}<link name="b">{inside}</link><joint name="j" type="continuous">'
        '<parent link="a"/><child link="b"/></joint>'
    )


def _visual(shape: str) -> str:
    return _link(f"<visual><geometry>{shape}</geometry></visual>")


# ---------------------------------------------------------------- mass


@rule(
    "MB601",
    "mass-missing",
    ERROR,
    what="An <inertial> has no mass.",
    why="urdfdom says 'Inertial element must have a mass element' and reads no further: the link "
    "has no visual and no collision; MuJoCo refuses the file.",
    fix='Add <mass value="..."/>, or delete the <inertial>.',
    bad=_link(f"<inertial>{INERTIA}</inertial>"),
    good=_link(_inertial()),
)
def mass_missing(subject: Subject) -> Iterator[Problem]:
    """Inertials without <mass value>."""
    for link, inertial in _inertials(subject.robot):
        if inertial.mass is None:
            mass = inertial.element.find("mass")
            if mass is None:
                yield Problem(inertial.element, f"<inertial> of link {link.name!r} has no <mass>")
            elif mass.get("value") is None:
                yield Problem(mass, f"<mass> of link {link.name!r} has no value", "value")


@rule(
    "MB602",
    "mass-negative",
    ERROR,
    what="A mass is below 0.",
    why="sdformat refuses the file ('has invalid inertia'); MuJoCo refuses a moving body.",
    fix="Write the mass in kg.",
    bad=_link(_inertial("-1")),
    good=_link(_inertial("1")),
)
def mass_negative(subject: Subject) -> Iterator[Problem]:
    """Masses that push."""
    for link, inertial in _inertials(subject.robot):
        if inertial.mass is not None and inertial.mass < 0:
            message = f"the mass of link {link.name!r} is {inertial.mass:g} kg"
            yield Problem(_part(inertial, "mass"), message, "value")


@rule(
    "MB603",
    "link-without-mass",
    WARNING,
    what="A link has no mass, nor has any link that is fixed to it, but the robot has.",
    why="Gazebo leaves out the link and all that hangs on it (sdformat: 'is not modeled in sdf'; "
    "its joint and child joints are 'ignored'); MuJoCo refuses the file.",
    fix="Add <inertial> with mass and inertia, or make the joint above it fixed.",
    bad=_moving(""),
    good=_moving(_inertial()),
)
def link_without_mass(subject: Subject) -> Iterator[Problem]:
    """The uppermost bodies without mass, in a robot that has masses and more than one body."""
    robot = subject.robot
    mass = _masses(robot)
    if len(mass) < 2 or not any(it > 0 for it in mass.values()):
        return
    lost: set[str] = set()
    for name, sum_ in mass.items():
        link = robot.link.get(name)
        if link is None or sum_ > 0 or name in lost or name == WORLD or _negative(link):
            continue
        if name not in robot.above and name not in robot.below:
            continue  # it hangs on nothing: that is MB501
        below = len(reached(robot, [name], lost)) - 1
        tail = f", with {below} links below it" if below else ""
        message = f"link {name!r} has no mass, nor anything fixed to it: Gazebo leaves it out{tail}"
        yield Problem(link.element, message, "name")


@rule(
    "MB604",
    "inertia-missing",
    ERROR,
    what="An <inertial> has no inertia, or not all six values of it.",
    why="urdfdom says 'Inertial element must have inertia element' and reads no further: the link "
    "has no visual and no collision; MuJoCo refuses the file.",
    fix="Write ixx, ixy, ixz, iyy, iyz and izz, or delete the <inertial>.",
    bad=_link(_inertial(inertia="")),
    good=_link(_inertial()),
)
def inertia_missing(subject: Subject) -> Iterator[Problem]:
    """Inertials without <inertia>, or with a part of it."""
    for link, inertial in _inertials(subject.robot):
        if inertial.moments is not None:
            continue
        inertia = inertial.element.find("inertia")
        missing = [] if inertia is None else [it for it in MOMENTS if inertia.get(it) is None]
        if inertia is None:
            yield Problem(inertial.element, f"<inertial> of link {link.name!r} has no <inertia>")
        elif missing:
            yield Problem(inertia, f"<inertia> of link {link.name!r} has no {', '.join(missing)}")


# ---------------------------------------------------------------- inertia


@rule(
    "MB605",
    "inertia-zero",
    WARNING,
    what="The inertia of a link that moves on its own is 0.",
    why="MuJoCo refuses the file ('mass and inertia of moving bodies must be larger than mjMINVAL'); "
    "sdformat lets it through to the physics engine, which has nothing to divide a torque by.",
    fix="Write the inertia of a box or a cylinder of that mass and size.",
    bad=_moving(_inertial(inertia=_diagonal("0", "0", "0"))),
    good=_moving(_inertial()),
)
def inertia_zero(subject: Subject) -> Iterator[Problem]:
    """Bodies of mass without inertia, where nothing fixed to them adds any."""
    robot = subject.robot
    parts: dict[str, int] | None = None
    for link, inertial in _inertials(robot):
        if not inertial.mass or inertial.mass < 0 or inertial.moments is None:
            continue
        if any(abs(it) >= NOTHING for it in inertial.moments) or not _moves(robot, link.name):
            continue
        parts = _parts(robot) if parts is None else parts
        if parts.get(link.name) == 1:
            message = f"the inertia of link {link.name!r} ({inertial.mass:g} kg) is 0"
            yield Problem(_part(inertial, "inertia"), message)


@rule(
    "MB606",
    "inertia-not-positive",
    ERROR,
    what="The inertia of a link is not positive definite: about some axis it is below 0.",
    why="No body has it: sdformat refuses the file ('has invalid inertia'), MuJoCo, too ('inertia "
    "must have positive eigenvalues').",
    fix="Look for a wrong sign, or for off-diagonal values in another unit; CAD programs differ in "
    "the sign of ixy, ixz and iyz.",
    bad=_link(_inertial(inertia=_diagonal("0.1", "0.1", "0.1", ixy="0.2"))),
    good=_link(_inertial(inertia=_diagonal("0.1", "0.1", "0.1", ixy="0.02"))),
)
def inertia_not_positive(subject: Subject) -> Iterator[Problem]:
    """Inertias of bodies with a negative principal moment."""
    for link, inertial, moments in _impossible(subject.robot, merged=False):
        if _is_negative(moments):
            message = f"inertia of link {link.name!r} {_fault(moments)}"
            yield Problem(_part(inertial, "inertia"), message)


@rule(
    "MB607",
    "inertia-triangle",
    ERROR,
    what="One principal moment of a link's inertia is larger than the two others together.",
    why="No body has it: sdformat refuses the file ('has invalid inertia'), MuJoCo, too ('inertia "
    "must satisfy A + B >= C').",
    fix="Take the values from the CAD program again: in kg m2, about the centre of mass.",
    bad=_link(_inertial(inertia=_diagonal("0.1", "0.1", "0.3"))),
    good=_link(_inertial(inertia=_diagonal("0.1", "0.1", "0.2"))),
)
def inertia_triangle(subject: Subject) -> Iterator[Problem]:
    """Inertias of bodies that no distribution of mass has, by more than rounding."""
    for link, inertial, moments in _impossible(subject.robot, merged=False):
        if not _is_negative(moments):
            message = f"inertia of link {link.name!r} {_fault(moments)}"
            yield Problem(_part(inertial, "inertia"), message)


@rule(
    "MB608",
    "inertia-scale",
    WARNING,
    what="An inertia does not fit the link's mass and size.",
    why="The simulator takes it as it is: such a link hardly turns, or spins at a touch.",
    fix="Write mass in kg and inertia in kg m2; 1 kg mm2 is 1e-6 kg m2.",
    bad=_link(_inertial(inertia=_diagonal("1000", "1000", "1000"))),
    good=_link(_inertial(inertia=_diagonal("0.001", "0.001", "0.001"))),
)
def inertia_scale(subject: Subject) -> Iterator[Problem]:
    """Radii of gyration of no robot, or far from the size of a link made of boxes and the like."""
    for link, inertial in _inertials(subject.robot):
        mass, moments = inertial.mass, inertial.moments
        if mass is None or moments is None or not LIGHT <= mass < HEAVY:
            continue
        largest = max(moments[0], moments[3], moments[5])
        if largest < NOTHING:
            continue
        radius = sqrt(largest / mass)
        said = f"inertia of link {link.name!r}: its {mass:g} kg would be {radius:.3g} m from the centre"
        if radius > LONG or radius < SHORT:
            yield Problem(_part(inertial, "inertia"), said, None, "is the unit right?")
        elif radius > LARGER * SMALL_SHAPE or radius < 0.1:
            size = _size(link.element)
            if size > SMALL_SHAPE and not SMALLER <= radius / size <= LARGER:
                said += f", its shapes end {size:.3g} m from the origin"
                yield Problem(_part(inertial, "inertia"), said, None, "is the unit right?")


@rule(
    "MB619",
    "merged-inertia",
    WARNING,
    what="A link with a fixed joint, or with links fixed to it, has an inertia that no body has: a "
    "principal moment is below 0 or larger than the two others together.",
    why="MuJoCo refuses the file. Gazebo merges the links first and refuses the sum, if that is "
    "impossible, too.",
    fix="Take the values from the CAD program again: in kg m2, about the centre of mass.",
    bad=_moving(_inertial(inertia=_diagonal("0.1", "0.1", "0.3"))).replace("continuous", "fixed"),
    good=_moving(_inertial()).replace("continuous", "fixed"),
)
def merged_inertia(subject: Subject) -> Iterator[Problem]:
    """Impossible inertias that are a part of a sum."""
    for link, inertial, moments in _impossible(subject.robot, merged=True):
        message = f"inertia of link {link.name!r} {_fault(moments)}"
        yield Problem(_part(inertial, "inertia"), message)


# ---------------------------------------------------------------- the robot as a whole


@rule(
    "MB609",
    "root-inertia",
    NOTE,
    what="The root link has an inertia.",
    why="KDL drops it, and robot_state_publisher says so at every start ('KDL does not support a "
    "root link with an inertia').",
    fix="Add a link without inertia above it, with a fixed joint.",
    bad=_link(_inertial()),
    good='<link name="base"/><link name="a">'
    + _inertial()
    + '</link><joint name="j" type="fixed"><parent link="base"/><child link="a"/></joint>',
)
def root_inertia(subject: Subject) -> Iterator[Problem]:
    """A root with <inertial>."""
    robot = subject.robot
    for link, inertial in _inertials(robot):
        if link.name not in robot.above:
            yield Problem(inertial.element, f"root link {link.name!r} has an inertia: KDL drops it")


@rule(
    "MB610",
    "no-inertia",
    NOTE,
    what="No link has a mass: the robot cannot be simulated.",
    why="Gazebo spawns nothing of it; MuJoCo refuses a moving body without mass. RViz and MoveIt "
    "do not mind.",
    fix="Add <inertial> to the links, if the robot is to be simulated.",
    bad='<link name="a"/><link name="b"/><joint name="j" type="continuous"><parent link="a"/>'
    '<child link="b"/></joint>',
    good=_moving(_inertial()),
)
def no_inertia(subject: Subject) -> Iterator[Problem]:
    """A robot with joints that move and without mass."""
    robot = subject.robot
    if any(it.inertial for it in robot.links) or not any(it.type != "fixed" for it in robot.joints):
        return
    yield Problem(subject.document.root, "no link has an <inertial>: the robot cannot be simulated")


@rule(
    "MB611",
    "visual-without-collision",
    NOTE,
    what="A link that moves is seen and touches nothing: it has <visual> and no <collision>, nor "
    "has any link that is fixed to it.",
    why="MoveIt plans through it, and in Gazebo it goes through everything.",
    fix="Add <collision>, with a simpler shape.",
    bad=_moving(f"{_inertial()}<visual>{BOX}</visual>"),
    good=_moving(f"{_inertial()}<visual>{BOX}</visual><collision>{BOX}</collision>"),
)
def visual_without_collision(subject: Subject) -> Iterator[Problem]:
    """Bodies; where no link has a collision, the robot is told once."""
    robot, root = subject.robot, subject.document.root
    if root.tag != "robot" or not robot.joints:
        return
    touch, seen = _bodies_with(subject, "collision"), _bodies_with(subject, "visual")
    bare = [it for it in seen if it not in touch and _moves(robot, it) and it in robot.link]
    if not touch and bare[1:]:
        yield Problem(root, "no link has a <collision>: the robot touches nothing")
        return
    for name in bare:
        message = f"link {name!r} has <visual> and no <collision>"
        yield Problem(robot.link[name].element, message, "name")


@rule(
    "MB612",
    "mass-tiny",
    NOTE,
    what="A link that moves on its own weighs less than a milligram.",
    why="Iterative solvers need many more steps where such a link carries or drives kilograms; MuJoCo "
    "refuses a body below 1e-15 kg.",
    fix="Write the real mass, or make the joint fixed.",
    bad=_moving(_inertial("1e-8")),
    good=_moving(_inertial("0.01")),
)
def mass_tiny(subject: Subject) -> Iterator[Problem]:
    """Bodies of nearly no mass."""
    robot = subject.robot
    if not any(it.mass is not None and 0 < it.mass < TINY_MASS for _, it in _inertials(robot)):
        return
    for name, mass in _masses(robot).items():
        inertial = robot.link[name].inertial if name in robot.link else None
        if 0 < mass < TINY_MASS and _moves(robot, name) and inertial is not None:
            message = f"link {name!r} moves and weighs {mass:g} kg"
            yield Problem(inertial.element, message)


# ---------------------------------------------------------------- shapes


@rule(
    "MB613",
    "shape-size",
    WARNING,
    what="A box, cylinder or sphere has a size of 0 or below.",
    why="sdformat warns and takes its default instead, half a metre or a metre; MuJoCo refuses the "
    "file ('size must be positive').",
    fix="Write the size in metres; delete a shape that is not there.",
    bad=_visual('<box size="0 0 0"/>'),
    good=_visual('<box size="0.1 0.1 0.1"/>'),
)
def shape_size(subject: Subject) -> Iterator[Problem]:
    """Shapes that are not there."""
    for shape, sizes in _shapes(subject.elements):
        if min(sizes) <= 0:
            words = " x ".join(f"{it:g}" for it in sizes)
            message = f"{shape.tag} of link {_owner(shape)!r} has the size {words}"
            yield Problem(shape, message)


@rule(
    "MB614",
    "shape-units",
    WARNING,
    what="A box, cylinder or sphere is larger than a house.",
    why="URDF is in metres: the robot stands inside of the shape, in collision with itself.",
    fix="Divide by 1000 what is in millimetres.",
    bad=_visual('<box size="300 200 100"/>'),
    good=_visual('<box size="0.3 0.2 0.1"/>'),
)
def shape_units(subject: Subject) -> Iterator[Problem]:
    """Shapes of more than fifty metres every way; a long and thin one may be a rail."""
    for shape, sizes in _shapes(subject.elements):
        if min(sizes) >= LONG_SHAPE / 5 and max(sizes) >= LONG_SHAPE:
            words = " x ".join(f"{it:g}" for it in sizes)
            message = f"{shape.tag} of link {_owner(shape)!r} has the size {words} m"
            yield Problem(shape, message, None, "are these millimetres?")


@rule(
    "MB615",
    "shape-missing",
    WARNING,
    what="A <visual> or <collision> has no geometry, or one that URDF does not know.",
    why="urdfdom says 'Could not parse visual element' and reads no further: visuals and collisions "
    "behind it are missing.",
    fix="Add <geometry> with a box, cylinder, sphere or mesh, or delete the element.",
    bad=_link("<visual/>"),
    good=_link(f"<visual>{BOX}</visual>"),
)
def shape_missing(subject: Subject) -> Iterator[Problem]:
    """Elements without a shape that urdfdom reads."""
    root = subject.document.root
    if root.tag != "robot":
        return
    later = () if root.get("version", "1.0") in OLD_VERSIONS else ("capsule",)
    known = {*SHAPES, "mesh", *later}
    for element in subject.elements.every("visual", "collision"):
        parent = element.getparent()
        if parent is None or parent.tag != "link":
            continue
        geometry = next(element.iterchildren("geometry"), None)
        shape = None if geometry is None else next(geometry.iterchildren("*"), None)
        if shape is None:
            lack = "<geometry>" if geometry is None else "shape in its <geometry>"
            message = f"<{element.tag}> of link {parent.get('name')!r} has no {lack}"
            yield Problem(element, message)
        elif shape.tag not in known:
            tag = str(shape.tag).rpartition("}")[2]
            message = f"<{element.tag}> of link {parent.get('name')!r}: unknown shape <{tag}>"
            yield Problem(shape, message)


@rule(
    "MB616",
    "mesh-flat",
    WARNING,
    what="A mesh is scaled by 0.",
    why="It is flat or a point: nothing is seen of it, and a collision with it has no inside.",
    fix="Write three scales that are not 0.",
    bad=_visual('<mesh filename="a.stl" scale="1 1 0"/>'),
    good=_visual('<mesh filename="a.stl" scale="1 1 1"/>'),
)
def mesh_flat(subject: Subject) -> Iterator[Problem]:
    """Scales with a 0."""
    for mesh, scale in _scales(subject.elements):
        if 0 in scale:
            words = mesh.get("scale")
            yield Problem(mesh, f"mesh of link {_owner(mesh)!r} is scaled by {words}", "scale")


@rule(
    "MB617",
    "mesh-mirrored",
    NOTE,
    what="A mesh is scaled by a negative number.",
    why="A mirror image turns the faces inside out: their normals point into the part, unless the "
    "reader turns them back.",
    fix="Export the mirrored mesh, where that matters.",
    bad=_visual('<mesh filename="a.stl" scale="1 -1 1"/>'),
    good=_visual('<mesh filename="a.stl" scale="1 1 1"/>'),
)
def mesh_mirrored(subject: Subject) -> Iterator[Problem]:
    """An odd number of negative scales; two of them are a turn."""
    for mesh, scale in _scales(subject.elements):
        if scale[0] * scale[1] * scale[2] < 0:
            words = mesh.get("scale")
            yield Problem(mesh, f"mesh of link {_owner(mesh)!r} is mirrored: {words}", "scale")


@rule(
    "MB618",
    "mesh-scale-units",
    NOTE,
    what="A mesh is scaled by a number that no unit asks for.",
    why="Meshes are in millimetres (0.001), centimetres, inches (0.0254) or metres: the part will "
    "be much too large, too small or stretched.",
    fix="Write the same scale three times: 0.001 for a mesh in millimetres.",
    bad=_visual('<mesh filename="a.stl" scale="1000 1000 1000"/>'),
    good=_visual('<mesh filename="a.stl" scale="0.001 0.001 0.001"/>'),
)
def mesh_scale_units(subject: Subject) -> Iterator[Problem]:
    """Very large, very small, or of very different scales."""
    for mesh, scale in _scales(subject.elements):
        low, high = min(map(abs, scale)), max(map(abs, scale))
        if low > 0 and (high >= LARGE_SCALE or low < SMALL_SCALE or high >= UNEVEN * low):
            words = mesh.get("scale")
            yield Problem(mesh, f"mesh of link {_owner(mesh)!r} is scaled by {words}", "scale")


# ---------------------------------------------------------------- what rules look at


def _inertials(robot: Robot) -> Iterator[tuple[Link, Inertial]]:
    for link in robot.links:
        if link.inertial is not None:
            yield link, link.inertial


def _part(inertial: Inertial, tag: str) -> _Element:
    found = inertial.element.find(tag)
    return inertial.element if found is None else found


def _negative(link: Link) -> bool:
    return link.inertial is not None and (link.inertial.mass or 0) < 0


def _masses(robot: Robot) -> dict[str, float]:
    """Body -> its mass with all that is fixed to it; what is no number counts as much."""
    mass = dict.fromkeys(robot.body.values(), 0.0)
    for link, inertial in _inertials(robot):
        body = robot.body.get(link.name)
        if body is not None:
            mass[body] += 1.0 if inertial.mass is None else max(inertial.mass, 0.0)
    return mass


def _moves(robot: Robot, name: str) -> bool:
    """Does a link hang on a joint that is not fixed?"""
    return name in robot.above and robot.above[name][0].type != "fixed"


def _parts(robot: Robot) -> dict[str, int]:
    """Body -> how many of its links have a mass."""
    count = dict.fromkeys(robot.body.values(), 0)
    for link, inertial in _inertials(robot):
        if link.name in robot.body and inertial.mass != 0:
            count[robot.body[link.name]] += 1
    return count


def _impossible(robot: Robot, merged: bool) -> Iterator[tuple[Link, Inertial, Vector]]:
    """The inertias that no body has and their principal moments, the smallest first.

    ``merged`` are those of links that are merged with others that have a mass, or with nothing
    that moves: ``world``.
    """
    parts: dict[str, int] | None = None
    for link, inertial in _inertials(robot):
        if inertial.moments is None or _is_plain(inertial.moments):
            continue
        low, middle, high = moments = _eigenvalues(inertial.moments)
        if high < NOTHING or (
            not _is_negative(moments) and high <= (low + middle) * (1 + ROUNDING)
        ):
            continue
        parts = _parts(robot) if parts is None else parts
        own = link.name != WORLD and parts.get(link.name) == 1
        if own != merged:
            yield link, inertial, moments


def _is_plain(moments: tuple[float, ...]) -> bool:
    """A quick look: is it surely possible? Off the diagonal ``off`` shifts the moments at most."""
    xx, xy, xz, yy, yz, zz = moments
    off = abs(xy) + abs(xz) + abs(yz)
    return min(xx, yy, zz) >= off and max(xx, yy, zz) + off <= (xx + yy + zz) / 2


def _is_negative(moments: Vector) -> bool:
    return moments[0] < -1e-6 * abs(moments[2])


def _fault(moments: Vector) -> str:
    low, middle, high = moments
    if _is_negative(moments):
        return f"is not positive definite: a principal moment is {low:.3g}"
    small = " + ".join(f"{it if it > 1e-9 * high else 0:.3g}" for it in (low, middle))
    return f"is impossible: the principal moment {high:.3g} is larger than {small}"


def _eigenvalues(moments: tuple[float, ...]) -> Vector:
    """Those of a symmetric 3x3 matrix, in order."""
    size = max(map(abs, moments))
    xx, xy, xz, yy, yz, zz = (it / size for it in moments)
    off = xy * xy + xz * xz + yz * yz
    if off == 0:
        low, middle, high = sorted((xx, yy, zz))
        return low * size, middle * size, high * size
    mean = (xx + yy + zz) / 3
    a, b, c = xx - mean, yy - mean, zz - mean
    spread = sqrt((a * a + b * b + c * c + 2 * off) / 6)
    det = a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz)
    angle = acos(max(-1.0, min(1.0, det / (2 * spread**3)))) / 3
    high = mean + 2 * spread * cos(angle)
    low = mean + 2 * spread * cos(angle + 2 * pi / 3)
    return low * size, (3 * mean - high - low) * size, high * size


def _bodies_with(subject: Subject, tag: str) -> dict[str, None]:
    """The bodies whose links have such an element."""
    parents = {it.getparent(): None for it in subject.elements.every(tag)}
    names = [it.get("name", "") for it in parents if it is not None and it.tag == "link"]
    return {subject.robot.body.get(name, name): None for name in names}


@lru_cache(maxsize=1)  # several rules look at the same ones
def _shapes(elements: Elements) -> list[tuple[_Element, tuple[float, ...]]]:
    """The boxes, cylinders and spheres of a URDF whose sizes are numbers, and those."""
    read = ((it, _sizes(it)) for it in _geometries(elements, *SHAPES))
    return [(shape, sizes) for shape, sizes in read if sizes]


def _geometries(elements: Elements, *tags: str) -> Iterator[_Element]:
    for shape in elements.every(*tags) if elements.root.tag == "robot" else ():
        parent = shape.getparent()
        if parent is not None and parent.tag == "geometry":
            yield shape


def _sizes(shape: _Element) -> tuple[float, ...]:
    """The sizes of a shape; none where one is missing or no number."""
    return numbers(" ".join([shape.get(name, "?") for name in SHAPES[str(shape.tag)]])) or ()


@lru_cache(maxsize=1)
def _scales(elements: Elements) -> list[tuple[_Element, Vector]]:
    """The meshes of a URDF that are scaled, and how."""
    read = ((it, vector(it.get("scale"))) for it in _geometries(elements, "mesh"))
    return [(mesh, scale) for mesh, scale in read if scale is not None]


def _owner(shape: _Element) -> str:
    """The name of the link that a shape stands in."""
    link = next(shape.iterancestors("link"), None)
    return "" if link is None else link.get("name", "")


def _size(link: _Element) -> float:
    """How far a link's shapes reach from its origin; 0 where that is not known: meshes."""
    far = 0.0
    for geometry in link.iter("geometry"):
        shape = next(geometry.iterchildren("*"), None)
        holder = geometry.getparent()
        if shape is None or holder is None or shape.tag not in SHAPES:
            return 0.0
        origin = holder.find("origin")
        xyz = vector(None if origin is None else origin.get("xyz")) or (0.0, 0.0, 0.0)
        sizes = _sizes(shape) or (0.0,)
        reach = hypot(*sizes) / 2 if shape.tag == "box" else max(sizes)
        far = max(far, hypot(*xyz) + reach)
    return far
