"""Displays that are not known, that keep values for one robot, or that work differently now."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.companions.rviz.display_groups import Robots, leaves
from multibot_rewrite.companions.rviz.read_config import (
    DOCK,
    RvizConfig,
    RvizItem,
    ValuePlace,
    rviz_data,
    text_of,
    value,
)
from multibot_rewrite.companions.rviz.values import GRAPH_NAMESPACE, LINK, TF_PREFIX, RvizRobot
from multibot_rewrite.companions.yaml_text import found_at, pairs
from multibot_rewrite.findings.finding import WARNING, Finding
from multibot_rewrite.findings.rule import declare
from multibot_rewrite.naming import NAMESPACE


def display_findings(
    config: RvizConfig, one: RvizItem, robots: Robots, together: bool
) -> Iterator[Finding]:
    """What is wrong with one display; ``together`` if one window shows all robots."""
    if not one.known:
        yield _unknown(config, one)
    for place in one.places:
        yield from _tf_prefix(config, place, robots[0])
        yield from _not_renamed(config, one, place, robots[0])
    yield from _legacy(config, one)
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


def _tf_prefix(config: RvizConfig, place: ValuePlace, robot: RvizRobot) -> Iterator[Finding]:
    given = str(place.node.value)
    if place.word != TF_PREFIX or not robot.names.naming.layout.frames or robot.tf_prefix:
        return
    if given and given != robot.tf_prefix:
        name = _named(place)
        message = f"{name} is emptied: the links of a rewritten description have the prefix already"
        hint = "nothing to do; RViz would add the prefix a second time"
        yield found_at(config.document, place.node, TF_PREFIX_TWICE, message, hint)


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
    config: RvizConfig, one: RvizItem, place: ValuePlace, robot: RvizRobot
) -> Iterator[Finding]:
    there = _why_not(one, place, robot) if place.node.value else None
    if there:
        message, hint = there
        message = f"{_named(place)} {message}"
        yield found_at(config.document, place.node, NOT_RENAMED, message, hint)


def _why_not(one: RvizItem, place: ValuePlace, robot: RvizRobot) -> tuple[str, str] | None:
    """Why a value stays unchanged, and what to do; None for a value that may."""
    naming = robot.names.naming
    frames = naming.layout.frames
    if place.word == "regex" and frames:
        return "is a pattern for frames and stays unchanged", "make it match the robots' frames"
    if place.word == "file" and text_of(one.node, "Description Source") == "File":
        renamed = LINK in naming.separators
        hint = "set Description Source to Topic" if renamed else "fine if all robots look the same"
        return "is one description file, shown for every robot", hint
    if place.word == GRAPH_NAMESPACE and naming.topics != NAMESPACE:
        problem = "is a namespace of topics, but this layout renames each topic instead"
        return problem, "use a layout with namespaces"
    return None


def _named(place: ValuePlace) -> str:
    return f"{place.path.rstrip('.*')} {str(place.node.value)!r}"


ROS1_PROPERTY = declare(
    "MF209",
    "rviz-ros1-property",
    WARNING,
    what="A display has a property of RViz for ROS 1: Image Topic, Marker Topic, Unreliable or "
    "Queue Size.",
    why="rviz2 ignores properties that it does not know. The display subscribes to nothing and "
    "shows nothing, without a message.",
    fix="Set the Topic of the display in rviz2 and save the file.",
    bad="""\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/Image
      Image Topic: /camera/image_raw
""",
    good="""\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/Image
      Topic: /camera/image_raw
""",
    line=4,
    formats=("rviz",),
)


def _legacy(config: RvizConfig, one: RvizItem) -> Iterator[Finding]:
    for key, _ in pairs(one.node):
        if key.value in rviz_data()["legacy"]:
            message = f"{key.value!r} of {one.name!r} is a ROS 1 property, which rviz2 ignores"
            hint = "set its Topic in rviz2"
            yield found_at(config.document, key, ROS1_PROPERTY, message, hint)


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


VOLATILE_DESCRIPTION = declare(
    "MF214",
    "rviz-description-volatile",
    WARNING,
    what="A display subscribes to the description with Durability Policy: Volatile.",
    why="robot_state_publisher publishes the description once. A volatile subscription misses it "
    "if rviz2 starts later, so the RobotModel stays empty. The RViz file of Nav2 has this.",
    fix="Write Durability Policy: Transient Local below Description Topic.",
    bad="""\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/RobotModel
      Description Topic:
        Durability Policy: Volatile
        Value: /robot_description
""",
    good="""\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/RobotModel
      Description Topic:
        Durability Policy: Transient Local
        Value: /robot_description
""",
    line=3,
    formats=("rviz",),
)


def volatile_findings(config: RvizConfig) -> Iterator[Finding]:
    """Displays that miss the description; reported once: nearly every saved config has it."""
    found = [
        one
        for one in leaves(config.displays)
        if text_of(value(one.node, "Description Topic"), "Durability Policy") == "Volatile"
    ]
    if found:
        names = ", ".join(repr(one.name) for one in found)
        message = f"{names} misses a description published before rviz2 starts: it is Volatile"
        hint = "set Durability Policy: Transient Local below Description Topic"
        yield found_at(config.document, found[0].node, VOLATILE_DESCRIPTION, message, hint)
