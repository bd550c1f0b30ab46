"""MB6: mass, inertia, shapes, and geometry against the robot."""

from multibot_rewrite.lint.rules.physics import (
    drives,
    inertia,
    loads,
    mass,
    placement,
    sensors,
    shapes,
)

THEMES = (mass, inertia, shapes, drives, sensors, placement, loads)
