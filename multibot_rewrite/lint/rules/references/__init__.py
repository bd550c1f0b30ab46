"""MB2: names that nothing declares, or that are declared twice."""

from multibot_rewrite.lint.rules.references import control, duplicates, frames, gazebo, undeclared

THEMES = (undeclared, frames, duplicates, gazebo, control)
