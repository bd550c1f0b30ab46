# SPDX-License-Identifier: Apache-2.0
"""MB8: files beside a description: SRDF, parameters, RViz, MoveIt's YAML, bridges."""

from multibot_rewrite.rules.description.srdf import THEMES as _OF_SRDF
from multibot_rewrite.rules.files import judge

THEMES = (*(f"..srdf{it}" for it in _OF_SRDF), *judge.THEMES)
