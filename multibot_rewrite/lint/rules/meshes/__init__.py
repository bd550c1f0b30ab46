"""MB7: mesh and texture files, and the packages they are in."""

from multibot_rewrite.lint.rules.meshes import boxes, formats, lookup, paths

THEMES = (lookup, paths, formats, boxes)
