"""MB8: files beside a description: SRDF, parameters, RViz, MoveIt's YAML, bridges."""

from multibot_rewrite.rules.description import srdf
from multibot_rewrite.rules.description.beside import packages
from multibot_rewrite.rules.files import judge

THEMES = (*srdf.THEMES, packages, *judge.THEMES)
