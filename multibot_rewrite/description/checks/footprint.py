# SPDX-License-Identifier: Apache-2.0
"""How far a robot reaches to the side: of its collisions, else its visuals, with every joint at 0.

Boxes, cylinders and spheres are measured; of a mesh, which is a file, and of a link without a shape
only the place counts.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import hypot

from lxml.etree import _Element

from multibot_rewrite.description.checks.links_and_joints import Robot, read_robot
from multibot_rewrite.description.checks.numbers import Vector
from multibot_rewrite.description.checks.poses import link_poses, origin_of, placed
from multibot_rewrite.description.checks.shapes import extent_of, shapes_of


def reach_of(root: _Element) -> float:
    """The radius in metres of the upright cylinder around the root link that holds the robot's
    shapes; 0 where nothing of it has a size, and for an SDF."""
    robot = read_robot(root)
    corners = [*_corners(robot, "collision")] or [*_corners(robot, "visual")]
    return max((hypot(x, y) for x, y, _ in corners), default=0.0)


def filled_by(root: _Element) -> float:
    """What a robot surely fills, however it is turned: half of how far it reaches. Two overlap where
    they are nearer than both fill."""
    return reach_of(root) / 2


def _corners(robot: Robot, tag: str) -> Iterator[Vector]:
    """The corners of the boxes around all shapes."""
    poses = link_poses(robot)
    for link in robot.links:
        for element, shape in shapes_of(link.element, tag) if link.name in poses else ():
            own = origin_of(element)
            extent = extent_of(shape, placed(poses[link.name], own)) if own else None
            if extent:
                (x1, y1, z), (x2, y2, _) = extent
                yield from ((x, y, z) for x in (x1, x2) for y in (y1, y2))
