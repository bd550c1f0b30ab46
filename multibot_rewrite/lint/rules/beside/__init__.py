"""MB8: files beside a description: SRDF, parameters, RViz, MoveIt's YAML, bridges."""

from multibot_rewrite.lint.rules import srdf
from multibot_rewrite.lint.rules.beside import names, parameters

THEMES = (*srdf.THEMES, parameters, names)
