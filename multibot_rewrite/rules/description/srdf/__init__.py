"""MB8: an SRDF against its URDF."""

from multibot_rewrite.rules.description.srdf import elements, joints, names, pairs, planning, states

THEMES = (names, pairs, planning, states, joints, elements)
