"""MB6: mass, inertia, shapes, and geometry against the robot."""

from multibot_rewrite.rules.description.physics import (
    drives,
    inertia,
    loads,
    mass,
    placement,
    sensors,
    shapes,
)

THEMES = (mass, inertia, shapes, drives, sensors, placement, loads)
