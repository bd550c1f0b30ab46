"""MB7: mesh and texture files, and the packages they are in."""

from multibot_rewrite.rules.description.meshes import boxes, formats, lookup, paths

THEMES = (lookup, paths, formats, boxes)
