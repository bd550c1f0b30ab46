"""Displays that are not known, that keep values for one robot, or that work differently now."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import WARNING, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.companions.rviz.display_groups import Robots
from multibot_rewrite.companions.rviz.read_config import (
    DOCK,
    RvizConfig,
    RvizItem,
)
from multibot_rewrite.companions.yaml_text import found_at, pairs


def display_findings(
    config: RvizConfig, one: RvizItem, robots: Robots, together: bool
) -> Iterator[Finding]:
    """What is wrong with one display; ``together`` if one window shows all robots."""
    if together and one.flag == DOCK:
        yield from _visibility(config, one)


VISIBILITY_RESET = declare(
    "MF212",
    "rviz-camera-visibility-reset",
    WARNING,
    what="The Visibility of a camera display is reset, because the displays are in groups for the "
    "robots now.",
    why="Visibility refers to displays by name and group. What was hidden in the picture of the "
    "camera is drawn in it again.",
    fix="Choose the displays again in rviz2 and save the file.",
    bad="""\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/Camera
      Topic: /camera/image_raw
      Visibility:
        Grid: false
""",
    good="""\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/Camera
      Topic: /camera/image_raw
""",
    line=5,
    formats=("rviz",),
)


def _visibility(config: RvizConfig, one: RvizItem) -> Iterator[Finding]:
    for key, there in pairs(one.node):
        if key.value == "Visibility" and pairs(there):
            message = f"Visibility of {one.name!r} is reset: the displays are in groups now"
            hint = "choose the displays again in rviz2"
            yield found_at(config.document, key, VISIBILITY_RESET, message, hint)
