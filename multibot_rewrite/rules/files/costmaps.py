# SPDX-License-Identifier: Apache-2.0
"""The size of a robot as its costmaps have it: against the inflation, and against the description.

Sources: nav2_costmap_2d costmap_2d_ros.cpp (a valid footprint counts, the radius then has no effect),
inflation_layer.cpp ('The configured inflation radius is smaller than the computed inscribed radius').
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import hypot

from multibot_rewrite.base.findings.finding import WARNING, Finding
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.companions.kinds import PARAMS
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.description.checks.shapes import reach_of
from multibot_rewrite.knowledge.declared import canonical
from multibot_rewrite.rules.files.bounds import polygon_of
from multibot_rewrite.rules.files.section_facts import Section, Setting, sections
from multibot_rewrite.rules.places import remark_at
from multibot_rewrite.rules.subject import Robots

_INFLATION = "nav2_costmap_2d::InflationLayer"
_RADIUS, _FOOTPRINT = "robot_radius", "footprint"
_COSTMAP = "nav2_costmap_2d"
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
    """Each costmap of a file."""
    for section in sections(file):
        if section.node is not None and section.node.package == _COSTMAP:
            yield from _of_costmap(file, section)


def _of_costmap(file: NamedFile, section: Section) -> Iterator[Finding]:
    radius, footprint = _by_radius(section), _by_footprint(section)
    size = footprint or radius
    if size is None:
        return
    if radius and footprint and not _fits(radius, footprint):
        message = (
            f"{section.title}: {_RADIUS} has no effect beside a footprint, and is another size"
        )
        yield remark_at(radius.given.node, message, f"leave out {_RADIUS}")
    yield from _inflation(section, size)
    reach = _reach(file)
    if reach and size.inscribed > _FAR * reach:
        message = f"{section.title}: {size.given.name} reaches {size.inscribed:g} m from the middle"
        hint = f"the description reaches {reach:.3g} m; write metres"
        yield remark_at(size.given.node, message, hint)
    elif size.reach * _TINY < reach:
        message = (
            f"{section.title}: {size.given.name} reaches {size.reach:g} m from the middle alone"
        )
        hint = f"the description reaches {reach:.3g} m; write metres"
        yield remark_at(size.given.node, message, hint)


def _by_radius(section: Section) -> Size | None:
    given = section.whole.get(_RADIUS)
    value = given.value if given else None
    return Size(given, value, value) if given and isinstance(value, float) and value > 0 else None


def _by_footprint(section: Section) -> Size | None:
    given = section.whole.get(_FOOTPRINT)
    points = polygon_of(given.value) if given and isinstance(given.value, str) else None
    if not given or not points or len(points) < 3:
        return None
    return Size(given, _inscribed(points), max(hypot(x, y) for x, y in points))


def _inscribed(points: Sequence[tuple[float, float]]) -> float:
    """From the origin to the nearest edge, as calculateMinAndMaxDistances has it."""
    edges = zip(points, [*points[1:], points[0]], strict=True)
    return min(_to_edge(one, other) for one, other in edges)


def _to_edge(one: tuple[float, float], other: tuple[float, float]) -> float:
    (x, y), (u, v) = one, other
    length = hypot(u - x, v - y)
    along = max(0.0, min(1.0, -(x * (u - x) + y * (v - y)) / length**2)) if length else 0.0
    return hypot(x + along * (u - x), y + along * (v - y))


def _fits(radius: Size, footprint: Size) -> bool:
    return footprint.inscribed * 0.9 <= radius.reach <= footprint.reach * 1.5


def _inflation(section: Section, size: Size) -> Iterator[Finding]:
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


def _reach(file: NamedFile) -> float:
    """How far the one description of the package reaches; 0 where that is not known."""
    robots = file.memo.get(Robots)
    if not isinstance(robots, Robots) or len(robots.subjects) != 1:
        return 0.0
    return reach_of(robots.subjects[0].document.root)
