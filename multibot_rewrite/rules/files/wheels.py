# SPDX-License-Identifier: Apache-2.0
"""The size of a robot and its wheels by parameters, against the description.

Costmaps, and the wheels of a diff_drive_controller.

Sources: nav2_costmap_2d costmap_2d_ros.cpp (a valid footprint counts, the radius then has no
effect), inflation_layer.cpp ('The configured inflation radius is smaller than the computed
inscribed radius'); ros2_controllers diff_drive_controller/src/diff_drive_controller.cpp
(update_and_write_commands: the left wheels get (linear - angular * separation / 2) / radius, with
the multipliers on both)."""

from collections.abc import Iterator, Mapping, Sequence
from math import hypot
from typing import NamedTuple

import yaml

from multibot_rewrite.base.findings.finding import WARNING, Finding, rule
from multibot_rewrite.description.checks.shapes import reach_of
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.description.steps.collect import collect
from multibot_rewrite.description.steps.document import Document
from multibot_rewrite.knowledge.declared import canonical
from multibot_rewrite.related_files.named_file import MOVEIT, PARAMS, NamedFile
from multibot_rewrite.rules.declaration import remark_at
from multibot_rewrite.rules.facts.drives import (
    Wheel,
    are_opposite,
    are_swapped,
    radius,
    rolling_faults,
    separation,
    wheel_of,
)
from multibot_rewrite.rules.files.parameter_files import polygon_of
from multibot_rewrite.rules.files.section_facts import Section, Setting, sections
from multibot_rewrite.rules.settings import Settings
from multibot_rewrite.rules.subject import Robots, Subject, subject_of

CONTROLLER = "diff_drive_controller"
LEFT, _RIGHT = "left_wheel_names", "right_wheel_names"
_SEPARATION, _RADIUS = "wheel_separation", "wheel_radius"
_Values = Mapping[str, Setting]


def with_description(file: NamedFile, description: Document) -> NamedFile:
    """Return the file with its one description, which is read if the file has wheels or limits."""
    if LEFT not in file.text and not (file.kind == MOVEIT and "joint_limits" in file.text):
        return file
    release = file.context.distro
    tree = builtin_tree((), release)
    subject = subject_of(collect(description, tree), tree, Settings(distro=release))
    robots = Robots(subject.inventory.declared, (subject,), True)
    return file._replace(memo={**file.memo, Robots: robots})


@rule("MB856", "controller-wheels", WARNING, formats=(PARAMS,))
def controller_sizes_of(file: NamedFile) -> Iterator[Finding]:
    """Yield the sizes of a controller that fit no description of the package with these wheels."""
    for section in sections(file):
        if section.node is None or section.node.name != CONTROLLER:
            continue
        robots: Robots | None = file.memo.get(Robots)
        subjects = robots.subjects if robots else ()
        faults = [it for subject in subjects if (it := _wheel_faults(subject, section)) is not None]
        if faults and all(faults):
            yield from faults[0]


def _wheel_faults(subject: Subject, section: Section) -> list[Finding] | None:
    """Return where a description differs from a section; None if it lacks some of the wheels."""
    values = {it.name: it for it in section.given}
    left, right = (_wheels(subject, values.get(it)) for it in (LEFT, _RIGHT))
    if not left or not right:
        return None
    node = values[_RIGHT].node
    rolling = rolling_faults(subject.robot, left[0], right[0])
    hint = "correct it in the description, or name the wheels that roll"
    return [
        *_size_faults(subject, values, left, right),
        *_axis_faults(node, left, right),
        *(remark_at(node, words, hint) for words in rolling),
    ]


def _wheels(subject: Subject, given: Setting | None) -> list[Wheel]:
    names = given.value if given and isinstance(given.value, list) else []
    found = [wheel_of(subject, str(it), None) for it in names]
    known = [it for it in found if it is not None]
    return known if len(known) == len(names) else []


def _size_faults(
    subject: Subject, values: _Values, left: Sequence[Wheel], right: Sequence[Wheel]
) -> Iterator[Finding]:
    many = bool(left[1:])
    apart = separation(subject.robot, left[0], right[0], many)
    round_ = radius(subject.robot, (*left, *right))
    for name, measured, words in (
        (_SEPARATION, apart, "wheels are {:.4g} m apart"),
        (_RADIUS, round_, "wheels have {:.4g} m"),
    ):
        given = values.get(name)
        value = given.value if given else None
        if given is None or not isinstance(value, float) or value <= 0 or measured is None:
            continue
        # Who corrects a size by its multiplier may correct a wrong one.
        factors = [values.get(f"{side}{name}_multiplier") for side in ("", "left_")]
        factor = next((it.value for it in factors if it and isinstance(it.value, float)), 1.0)
        if not measured.holds(value) and not measured.holds(value * factor):
            robot = subject.document.root.get("name", "")
            message = f"{name} is {value:g} m, but the {words.format(measured.best)} in {robot!r}"
            yield remark_at(given.node, message, f"write {measured.best:.4g}")


def _axis_faults(
    node: yaml.Node, left: Sequence[Wheel], right: Sequence[Wheel]
) -> Iterator[Finding]:
    one, other = left[0], right[0]
    names = f"{one.joint.name!r} and {other.joint.name!r}"
    if are_opposite(one, other):
        message = f"the axes of wheels {names} point in opposite directions"
        yield remark_at(node, message, "turn one of them around: the robot would turn on the spot")
    if way := are_swapped(one, other):
        message = f"left wheel {one.joint.name!r} is {way:.3g} m right of {other.joint.name!r}"
        hint = "swap left and right, or turn the axes of both joints around"
        yield remark_at(node, message, hint)


_INFLATION = "nav2_costmap_2d::InflationLayer"
_ROBOT_RADIUS, _FOOTPRINT = "robot_radius", "footprint"
# A radius that is so many times the robot's reach is in other units, or of another robot.
_FAR = 3.0
# An arm may reach as many times as far as its base.
_TINY = 8.0


class Size(NamedTuple):
    """How near to the middle the edge of a robot is and how far it reaches, by a parameter."""

    given: Setting
    inscribed: float
    reach: float


@rule("MB895", "costmap-robot-size", WARNING, formats=(PARAMS,))
def robot_size(file: NamedFile) -> Iterator[Finding]:
    """Report what is wrong with the robot's size in each costmap of a file."""
    for section in sections(file):
        if section.node is not None and section.node.package == "nav2_costmap_2d":
            yield from _costmap_faults(file, section)


def _costmap_faults(file: NamedFile, section: Section) -> Iterator[Finding]:
    given, footprint = section.whole.get(_ROBOT_RADIUS), _footprint_size(section)
    value = given.value if given else None
    radius = Size(given, value, value) if given and isinstance(value, float) and value > 0 else None
    size = footprint or radius
    if size is None:
        return
    fits = (
        footprint and radius and footprint.inscribed * 0.9 <= radius.reach <= footprint.reach * 1.5
    )
    if radius and footprint and not fits:
        what = f"{_ROBOT_RADIUS} has no effect with a footprint, and is another size"
        message = f"{section.title}: {what}"
        yield remark_at(radius.given.node, message, f"leave out {_ROBOT_RADIUS}")
    yield from _inflation_faults(section, size)
    # How far the one description of the package reaches; 0 where that is not known.
    robots: Robots | None = file.memo.get(Robots)
    subjects = robots.subjects if robots else ()
    reach = reach_of(subjects[0].document.root) if len(subjects) == 1 else 0.0
    reaches = f"{section.title}: {size.given.name} reaches"
    hint = f"the description reaches {reach:.3g} m; write metres"
    if reach and size.inscribed > _FAR * reach:
        message = f"{reaches} {size.inscribed:g} m from the middle"
        yield remark_at(size.given.node, message, hint)
    elif size.reach * _TINY < reach:
        message = f"{reaches} {size.reach:g} m from the middle alone"
        yield remark_at(size.given.node, message, hint)


def _footprint_size(section: Section) -> Size | None:
    """Return the inner and outer radius of a costmap's footprint; None without a valid one."""
    given = section.whole.get(_FOOTPRINT)
    points = polygon_of(given.value) if given and isinstance(given.value, str) else None
    if not given or not points or len(points) < 3:
        return None
    return Size(given, _inscribed_radius(points), max(hypot(x, y) for x, y in points))


def _inscribed_radius(points: Sequence[tuple[float, float]]) -> float:
    """Return the distance of the nearest edge from the origin, as calculateMinAndMaxDistances."""
    edges = zip(points, [*points[1:], points[0]], strict=True)
    return min(_to_edge(one, other) for one, other in edges)


def _to_edge(one: tuple[float, float], other: tuple[float, float]) -> float:
    """Return the distance of the origin from the edge between two points."""
    (x, y), (u, v) = one, other
    length = hypot(u - x, v - y)
    along = max(0.0, min(1.0, -(x * (u - x) + y * (v - y)) / length**2)) if length else 0.0
    return hypot(x + along * (u - x), y + along * (v - y))


def _inflation_faults(section: Section, size: Size) -> Iterator[Finding]:
    for name, given in section.whole.items():
        layer, _, last = name.rpartition(".")
        class_ = section.whole.get(f"{layer}.plugin")
        value = given.value
        if last != "inflation_radius" or class_ is None or not isinstance(value, float):
            continue
        if canonical(str(class_.value)) == _INFLATION and value < size.inscribed:
            least = f"less than the robot's {size.inscribed:.3g} m"
            message = f"{section.title}: {name} is {value:g} m, {least}"
            hint = f"the robot is as large as {size.given.name} says; inflate further than that"
            yield remark_at(given.node, message, hint)
