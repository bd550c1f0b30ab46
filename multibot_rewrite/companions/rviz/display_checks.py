"""Displays that are not known, that keep values for one robot, or that work differently now."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import WARNING, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.base.naming import NAMESPACE
from multibot_rewrite.companions.rviz.display_groups import Robots
from multibot_rewrite.companions.rviz.read_config import (
    DOCK,
    GRAPH_NAMESPACE,
    RvizConfig,
    RvizItem,
    text_of,
)
from multibot_rewrite.companions.rviz.values import LINK, TF_PREFIX, RvizRobot
from multibot_rewrite.companions.sites import Site, found_in
from multibot_rewrite.companions.yaml_text import found_at, pairs


def display_findings(
    config: RvizConfig, one: RvizItem, robots: Robots, together: bool
) -> Iterator[Finding]:
    """What is wrong with one display; ``together`` if one window shows all robots."""
    if not one.known:
        yield _unknown(config, one)
    for place in one.places:
        yield from _tf_prefix(config, place, robots[0])
        yield from _not_renamed(config, one, place, robots[0])
    if together and one.flag == DOCK:
        yield from _visibility(config, one)


UNKNOWN_DISPLAY = declare(
    "MF204",
    "rviz-unknown-display",
    WARNING,
    what="The class of a display is not known, so only its Topic is renamed.",
    why="Each plugin has its own keys for topics and frames. What is not renamed is a name that "
    "no robot has any more, so that part of the display stays empty.",
    fix="Check the other topics and frames of the display for each robot.",
    bad="""\
Visualization Manager:
  Displays:
    - Class: my_plugins/ScanColours
      Topic: /scan
""",
    good="""\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/LaserScan
      Topic: /scan
""",
    line=3,
    formats=("rviz",),
)


def _unknown(config: RvizConfig, one: RvizItem) -> Finding:
    message = f"display class {one.cls!r} is not known; only its Topic is renamed"
    hint = "check its other topics and frames"
    return found_at(config.document, one.node, UNKNOWN_DISPLAY, message, hint)


TF_PREFIX_TWICE = declare(
    "MF207",
    "rviz-tf-prefix-twice",
    WARNING,
    what="The TF Prefix of a RobotModel or Effort display is emptied.",
    why="RViz looks up the transform of TF Prefix/link for each link of the description. The "
    "links of a rewritten description have the robot's prefix already, and "
    "robot1/robot1/base_link does not exist.",
    fix="Nothing has to be done.",
    bad="""\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/RobotModel
      TF Prefix: robot1
""",
    good="""\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/RobotModel
      TF Prefix: ""
""",
    line=4,
    formats=("rviz",),
)


def _tf_prefix(config: RvizConfig, place: Site, robot: RvizRobot) -> Iterator[Finding]:
    given = place.slot.value
    if place.kind != TF_PREFIX or not robot.names.naming.layout.frames or robot.tf_prefix:
        return
    if given and given != robot.tf_prefix:
        name = _named(place)
        message = f"{name} is emptied: the links of a rewritten description have the prefix already"
        hint = "nothing to do; RViz would add the prefix a second time"
        yield found_in(config.document.file, place.slot, TF_PREFIX_TWICE, message, hint)


NOT_RENAMED = declare(
    "MF208",
    "rviz-value-not-renamed",
    WARNING,
    what="A value of a display cannot be renamed: a pattern for frames (the filters of TF), a "
    "description file, or a namespace of topics in a layout that renames each topic.",
    why="A pattern such as ^base_link$ matches no frame of a robot with a prefix, so the display "
    "is empty. The links of a description file are those of a single robot; the fleet publishes "
    "no transforms for them.",
    fix="Make the pattern match the frames of the robots, set Description Source to Topic, or "
    "take a layout with namespaces.",
    bad="""\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/TF
      Filter (whitelist): ^base_link$
""",
    good="""\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/TF
      Filter (whitelist): ""
""",
    line=4,
    formats=("rviz",),
)


def _not_renamed(
    config: RvizConfig, one: RvizItem, place: Site, robot: RvizRobot
) -> Iterator[Finding]:
    there = _why_not(one, place, robot) if place.slot.value else None
    if there:
        message, hint = there
        message = f"{_named(place)} {message}"
        yield found_in(config.document.file, place.slot, NOT_RENAMED, message, hint)


def _why_not(one: RvizItem, place: Site, robot: RvizRobot) -> tuple[str, str] | None:
    """Why a value stays unchanged, and what to do; None for a value that may."""
    naming = robot.names.naming
    frames = naming.layout.frames
    if place.kind == "regex" and frames:
        return "is a pattern for frames and stays unchanged", "make it match the robots' frames"
    if place.kind == "file" and text_of(one.node, "Description Source") == "File":
        renamed = LINK in naming.separators
        hint = "set Description Source to Topic" if renamed else "fine if all robots look the same"
        return "is one description file, shown for every robot", hint
    if place.kind == GRAPH_NAMESPACE and naming.topics != NAMESPACE:
        problem = "is a namespace of topics, but this layout renames each topic instead"
        return problem, "use a layout with namespaces"
    return None


def _named(place: Site) -> str:
    return f"{place.key.rstrip('.*')} {place.slot.value!r}"


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
