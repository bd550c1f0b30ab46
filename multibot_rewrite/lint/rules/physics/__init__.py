"""MB6: mass, inertia and shapes."""

from multibot_rewrite.lint.rules.physics import inertia, mass, shapes

THEMES = (mass, inertia, shapes)
