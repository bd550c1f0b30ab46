# SPDX-License-Identifier: Apache-2.0
"""The mass of links, with what is fixed to them, and their inertia: missing, impossible, odd unit."""

from __future__ import annotations

from collections.abc import Iterator
from math import acos, cos, hypot, pi, sqrt

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, rule
from multibot_rewrite.base.releases import OF_OLD
from multibot_rewrite.description.checks.links_and_joints import (
    WORLD,
    Inertial,
    Link,
    Robot,
    reached,
    weighs,
)
from multibot_rewrite.description.checks.numbers import Vector, numbers, vector
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.rewriters.text import text_of
from multibot_rewrite.rules.facts.memo import number_at
from multibot_rewrite.rules.facts.simulators import simulator_plugins
from multibot_rewrite.rules.schema.versions import may_be_classics
from multibot_rewrite.rules.subject import Subject

# What MuJoCo takes for nothing (mjMINVAL).
NOTHING = 1e-15
SHAPES = {"box": ("size",), "cylinder": ("radius", "length"), "sphere": ("radius",)}


def inertials(robot: Robot) -> Iterator[tuple[Link, Inertial]]:
    """Yield (link, inertial) for the links that have one."""
    for link in robot.links:
        if link.inertial is not None:
            yield link, link.inertial


def part_of(inertial: Inertial, tag: str) -> _Element:
    """Return a child of an inertial, or the inertial itself where it has none."""
    found = inertial.element.find(tag)
    return inertial.element if found is None else found


def moves(robot: Robot, name: str) -> bool:
    """Return whether a link is the child of a joint that is not fixed."""
    return name in robot.above and robot.above[name][0].type != "fixed"


def parts_with_mass(robot: Robot) -> dict[str, int]:
    """Return by body how many of its links have a mass."""
    count = dict.fromkeys(robot.body.values(), 0)
    for link, inertial in inertials(robot):
        if link.name in robot.body and inertial.mass != 0:
            count[robot.body[link.name]] += 1
    return count


def sizes_of(shape: _Element) -> tuple[float, ...]:
    """Return the sizes of a shape; empty if one is missing or not a number."""
    return numbers(" ".join([shape.get(name, "?") for name in SHAPES[str(shape.tag)]])) or ()


# Limits of the radius of gyration: no robot under HEAVY kg is LONG, no part as compact as SHORT; nor
# is it LARGER or SMALLER times the size of the shapes. A mass below LIGHT is a placeholder.
LONG, SHORT, HEAVY, LIGHT = 5.0, 1e-4, 500.0, 0.01
LARGER, FAR_LARGER, SMALLER, SMALL_SHAPE = 4.0, 50.0, 0.01, 0.01
# Of 1,523 links of public robots with simple shapes, 147 are LARGER, most of them frames of sensors
# with the inertia of an example; one that moves and has a mass counts.
FRAME = 0.05
# In kg/m3: more than osmium. Shapes of lighter links may be marks.
DENSEST, MASSIVE = 25_000.0, 5.0


@rule("MB605", "inertia-zero", WARNING)
def inertia_zero(subject: Subject) -> Iterator[Problem]:
    """Report bodies with mass and no inertia, also not from a link that is fixed to them."""
    robot = subject.robot
    parts: dict[str, int] | None = None
    for link, inertial in inertials(robot):
        if not inertial.mass or inertial.mass < 0 or inertial.moments is None:
            continue
        if any(abs(it) >= NOTHING for it in inertial.moments) or not moves(robot, link.name):
            continue
        parts = parts_with_mass(robot) if parts is None else parts
        if parts.get(link.name) == 1:
            message = f"the inertia of link {link.name!r} ({inertial.mass:g} kg) is 0"
            yield Problem(part_of(inertial, "inertia"), message)


@rule("MB606", "impossible-inertia", ERROR)
def impossible_inertia(subject: Subject) -> Iterator[Problem]:
    """Report inertias that no distribution of mass has, by more than rounding."""
    root, release = subject.document.root, subject.settings.distro
    parts: dict[str, int] | None = None
    for link, inertial in inertials(subject.robot):
        if inertial.moments is None or _is_possible(inertial.moments):
            continue
        low, middle, high = moments = eigenvalues(inertial.moments)
        if high < NOTHING or (not is_negative(moments) and high <= (low + middle) * (1 + ROUNDING)):
            continue
        parts = parts_with_mass(subject.robot) if parts is None else parts
        merged = link.name == WORLD or parts.get(link.name) != 1
        message = f"inertia of link {link.name!r} {fault_of(moments)}"
        level = WARNING if merged or may_be_classics(root, release) else ""
        yield Problem(part_of(inertial, "inertia"), message, level=level)
    if root.tag == "sdf":
        yield from _model_faults(subject)


def _model_faults(subject: Subject) -> Iterator[Problem]:
    """Yield the faults of masses and inertias in an SDF, whose links are not merged."""
    classics = may_be_classics(subject.document.root, subject.settings.distro)
    for link in subject.elements.every("link"):
        inertial = link.find("inertial")
        if inertial is None or inertial.get("auto", "").lower() in ("true", "1"):
            continue
        mass, inertia = number_at(inertial, "mass"), inertial.find("inertia")
        level = (NOTE if _is_static(link) else WARNING) if classics else ERROR
        if mass is not None and mass <= 0:
            message = f"mass of link {link.get('name')!r} is {mass:g}"
            yield Problem(inertial, f"{message}, and has to be above 0", None, level=level)
        found = [] if inertia is None else [_moment_or_default(inertia, it) for it in _MOMENTS]
        moments = tuple(it for it in found if it is not None)
        if len(moments) != len(_MOMENTS) or inertia is None:
            continue
        low, middle, high = own = eigenvalues(moments) if any(moments) else (0.0, 0.0, 0.0)
        if high < NOTHING or is_negative(own) or high > (low + middle) * (1 + ROUNDING):
            message = "is 0" if high < NOTHING else fault_of(own)
            words = f"inertia of link {link.get('name')!r} {message}"
            yield Problem(inertia, words, None, level=level)


def _is_static(link: _Element) -> bool:
    """Return whether a link is of a static model, whose masses Gazebo Classic ignores (Link.cc)."""
    model = link.getparent()
    static = "" if model is None else (model.findtext("static") or "").strip()
    return static in ("1", "true")


# With what sdformat takes where one is left out.
_MOMENTS = {"ixx": 1.0, "ixy": 0.0, "ixz": 0.0, "iyy": 1.0, "iyz": 0.0, "izz": 1.0}


def _moment_or_default(inertia: _Element, name: str) -> float | None:
    return number_at(inertia, name) if inertia.find(name) is not None else _MOMENTS[name]


@rule("MB608", "inertia-scale", WARNING)
def inertia_scale(subject: Subject) -> Iterator[Problem]:
    """Report radii of gyration that no robot has, or that do not fit the size of the shapes."""
    for link, inertial in inertials(subject.robot):
        mass, moments = inertial.mass, inertial.moments
        if mass is None or moments is None or mass < LIGHT:
            continue
        size = _reach(link.element) if mass >= MASSIVE else 0.0
        if size > SMALL_SHAPE and mass > DENSEST * size**3 * 4 / 3 * pi:
            message = f"mass of link {link.name!r}: no metal weighs {mass:g} kg within {size:.3g} m"
            yield Problem(part_of(inertial, "mass"), message, None, "is it in kilograms?")
            continue
        largest = max(moments[0], moments[3], moments[5])
        if mass >= HEAVY or largest < NOTHING:
            continue
        radius, level, shapes = sqrt(largest / mass), "", ""
        if SHORT <= radius <= LONG:
            size = size or _reach(link.element)
            if size <= SMALL_SHAPE or SMALLER <= radius / size <= LARGER:
                continue
            shapes = f", its shapes reach {size:.3g} m from the origin"
            counts = mass >= FRAME and moves(subject.robot, link.name)
            level = "" if counts or radius > FAR_LARGER * size else NOTE
        far = f"{radius:.3g} m from the centre{shapes}"
        message = f"inertia of link {link.name!r}: {mass:g} kg would be {far}"
        place = part_of(inertial, "inertia")
        yield Problem(place, message, None, "is the unit right?", level=level)


def _reach(link: _Element) -> float:
    """Return how far a link's shapes reach from its origin; 0 if it has a mesh of unknown size."""
    far = 0.0
    for geometry in link.iter("geometry"):
        shape = next(geometry.iterchildren("*"), None)
        holder = geometry.getparent()
        if shape is None or holder is None or shape.tag not in SHAPES:
            return 0.0
        origin = holder.find("origin")
        xyz = vector(None if origin is None else origin.get("xyz")) or (0.0, 0.0, 0.0)
        sizes = sizes_of(shape) or (0.0,)
        reach = hypot(*sizes) / 2 if shape.tag == "box" else max(sizes)
        far = max(far, hypot(*xyz) + reach)
    return far


# Relative; CAD programs print four digits and more.
ROUNDING = 0.01


def _is_possible(moments: tuple[float, ...]) -> bool:
    """Return whether moments are surely possible; off-diagonal ones shift them by ``off`` at most."""
    xx, xy, xz, yy, yz, zz = moments
    off = abs(xy) + abs(xz) + abs(yz)
    return min(xx, yy, zz) >= off and max(xx, yy, zz) + off <= (xx + yy + zz) / 2


def is_negative(moments: Vector) -> bool:
    """Return whether the smallest moment is below 0, by more than rounding."""
    return moments[0] < -1e-6 * abs(moments[2])


def fault_of(moments: Vector) -> str:
    """Return what is wrong with impossible moments, for a message."""
    low, middle, high = moments
    if is_negative(moments):
        return f"is not positive definite: a principal moment is {low:.3g}"
    small = " + ".join(f"{it if it > 1e-9 * high else 0:.3g}" for it in (low, middle))
    return f"is impossible: the principal moment {high:.3g} is larger than {small}"


def eigenvalues(moments: tuple[float, ...]) -> Vector:
    """Return the eigenvalues of a symmetric 3x3 matrix, in order."""
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


TINY_MASS = 1e-6


@rule("MB603", "link-without-mass", WARNING)
def link_without_mass(subject: Subject) -> Iterator[Problem]:
    """Yield the uppermost bodies without mass; errors in Gazebo, if something in use is lost."""
    robot = subject.robot
    mass = _masses(robot)
    if len(mass) < 2 or not any(it > 0 for it in mass.values()):
        return
    lost: set[str] = set()
    for name, sum_ in mass.items():
        link = robot.link.get(name)
        if link is None or sum_ > 0 or name in lost or name == WORLD:
            continue
        if link.inertial is not None and (link.inertial.mass or 0) < 0:
            continue
        if name not in robot.above and name not in robot.below:
            continue  # no joint has it: MB501
        gone = reached(robot, [name], lost)
        used = lost_with(subject, frozenset(gone))
        tail = f", with {len(gone) - 1} links below it" if gone[1:] else ""
        tail += f"; {', '.join(used)} {'goes' if len(used) == 1 else 'go'} with it" if used else ""
        level = ERROR if subject.settings.simulated and (used or name not in robot.above) else ""
        bare = f"link {name!r} and the links fixed to it have no mass"
        message = f"{bare}: Gazebo leaves it out{tail}"
        yield Problem(link.element, message, "name", level=level)


@rule("MB609", "root-inertia", NOTE)
def root_inertia(subject: Subject) -> Iterator[Problem]:
    """Yield a problem for a root link with <inertial>."""
    robot = subject.robot
    for link, inertial in inertials(robot):
        if link.name not in robot.above:
            yield Problem(inertial.element, f"root link {link.name!r} has an inertia: KDL drops it")


@rule("MB610", "no-inertia", NOTE)
def no_inertia(subject: Subject) -> Iterator[Problem]:
    """Yield a problem for a robot without mass that has moving joints or runs in Gazebo."""
    robot, chosen = subject.robot, subject.settings.simulated
    massless = bool(robot.links) and not weighs(robot)
    unweighed = not any(it.inertial for it in robot.links)
    moving = any(it.type != "fixed" for it in robot.joints)
    if not (massless and chosen) and not (unweighed and moving):
        return
    # Hardware of ros2_control has sensors, too.
    every = subject.elements.every("sensor")
    sensors = any(next(it.iterancestors("ros2_control"), None) is None for it in every)
    simulated = chosen or sensors or simulator_plugins(subject)
    what = "no link has an <inertial>" if unweighed else "no link has a mass"
    message = f"{what}: the robot cannot be simulated"
    yield Problem(subject.document.root, message, level=ERROR if simulated else "")


@rule("MB612", "mass-tiny", NOTE)
def mass_tiny(subject: Subject) -> Iterator[Problem]:
    """Report bodies of nearly no mass."""
    robot = subject.robot
    if not any(it.mass is not None and 0 < it.mass <= TINY_MASS for _, it in inertials(robot)):
        return
    for name, mass in _masses(robot).items():
        inertial = robot.link[name].inertial if name in robot.link else None
        if 0 < mass <= TINY_MASS and moves(robot, name) and inertial is not None:
            message = f"link {name!r} moves and weighs {mass:g} kg"
            level = WARNING if subject.settings.distro == OF_OLD else ""
            yield Problem(inertial.element, message, level=level)


def _masses(robot: Robot) -> dict[str, float]:
    """Return by body its mass with all that is fixed to it; what is no number counts as 1 kg."""
    mass = dict.fromkeys(robot.body.values(), 0.0)
    for link, inertial in inertials(robot):
        body = robot.body.get(link.name)
        if body is not None:
            mass[body] += 1.0 if inertial.mass is None else max(inertial.mass, 0.0)
    return mass


def lost_with(subject: Subject, gone: frozenset[str]) -> tuple[str, ...]:
    """Return the sensors and joints in use that are lost with these links, as a message names them."""
    joints = {it.name for it in subject.robot.joints if it.child in gone or it.parent in gone}
    blocks = subject.elements.tops("gazebo")
    lost = (it for it in blocks if it.get("reference") in gone | joints)
    sensors = (it.get("name") for block in lost for it in block.iterchildren("sensor"))
    found = [f"sensor {name!r}" for name in sensors]
    # Joints of which a plugin of the model, or ros2_control, knows the name.
    of_model = (it for it in blocks if not it.get("reference"))
    plugins = (it for block in of_model for it in block.iterchildren("plugin"))
    named = (text_of(it) for plugin in plugins for it in plugin.iterdescendants("*"))
    found += (f"joint {name!r} of a plugin" for name in named if name in joints)
    systems = subject.elements.tops("ros2_control")
    driven = (it.get("name", "") for system in systems for it in system.iterchildren("joint"))
    found += (f"joint {name!r} of ros2_control" for name in driven if name in joints)
    return tuple(dict.fromkeys(found))
