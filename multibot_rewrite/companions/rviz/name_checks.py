"""Names in displays and tools: undeclared, with a robot or a placeholder in them, of unknown use."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import yaml

from multibot_rewrite.companions.names.placeholders import without_robot
from multibot_rewrite.companions.names.rename_map import is_declared
from multibot_rewrite.companions.rviz.display_groups import Robots
from multibot_rewrite.companions.rviz.read_config import RvizConfig, RvizItem, ValuePlace
from multibot_rewrite.companions.rviz.values import (
    FRAME,
    JOINT,
    LINK,
    RvizRobot,
    is_name,
    robot_value,
)
from multibot_rewrite.companions.yaml_text import found_at, is_text, pairs
from multibot_rewrite.findings.finding import WARNING, Finding
from multibot_rewrite.findings.rule import declare
from multibot_rewrite.nearest import MISTYPED, did_you_mean
from multibot_rewrite.system.conventions import SENT_FRAMES

# Titles of displays and windows: never names of links.
_TITLES = ("Name", "Class")


def name_findings(config: RvizConfig, one: RvizItem, robots: Robots) -> Iterator[Finding]:
    """What is wrong with the names in a display or tool."""
    for place in filter(is_name, one.places):
        yield from _robot_in_name(config, place, robots)
        if _has_placeholder(robot_value(place, robots[0])):
            yield _placeholder(config, place)
        else:
            yield from _undeclared(config, place, robots)
    yield from _mentions(config, one, robots)


ROBOT_IN_NAME = declare(
    "MF215",
    "rviz-robot-in-name",
    WARNING,
    what="A name in an RViz config has the name of a robot already.",
    why="The config was saved for one robot of the fleet. With the robot's name added once more, "
    "the display subscribes to /robot1/robot1/plan, and that of robot2 to /robot2/robot1/plan.",
    fix="Use a config for a single robot, without namespace and prefix.",
    bad="""\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/Path
      Topic: /robot1/plan
""",
    good="""\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/Path
      Topic: /plan
""",
    line=4,
    formats=("rviz",),
)


def _robot_in_name(config: RvizConfig, place: ValuePlace, robots: Robots) -> Iterator[Finding]:
    given = str(place.node.value)
    there = next((it for it in robots if _has(given, place, it)), None)
    if there is not None:
        message = f"{given!r} already holds the name of robot {there.name!r}"
        hint = "use a config for a single robot without namespace and prefix"
        yield found_at(config.document, place.node, ROBOT_IN_NAME, message, hint)


def _has(given: str, place: ValuePlace, robot: RvizRobot) -> bool:
    names = robot.names if place.word in (FRAME, LINK, JOINT) else robot.topics
    ends = given.strip("/").split("/")
    return len(ends) > 1 and names.robot in (ends[0], ends[-1])


PLACEHOLDER_KEPT = declare(
    "MF210",
    "rviz-placeholder-kept",
    WARNING,
    what="A topic or frame has a placeholder such as <name>, which stays.",
    why="A launch file replaces it before rviz2 starts. rviz2 itself takes it as it is, and "
    "<name>/plan is not a valid topic name.",
    fix="Write the name as for a single robot.",
    bad="""\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/Path
      Topic: <name>/plan
""",
    good="""\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/Path
      Topic: /plan
""",
    line=4,
    formats=("rviz",),
)


def _has_placeholder(given: str) -> bool:
    return "<" in without_robot(given) and given != "<Fixed Frame>"


def _placeholder(config: RvizConfig, place: ValuePlace) -> Finding:
    given = str(place.node.value)
    message = (
        f"the placeholder in {given!r} stays; the launch file that starts rviz2 must replace it"
    )
    hint = "write the name as for a single robot"
    return found_at(config.document, place.node, PLACEHOLDER_KEPT, message, hint)


UNDECLARED = declare(
    "MF206",
    "rviz-undeclared-name",
    WARNING,
    what="A link or joint in an RViz config is not in the description, or a frame looks like a "
    "misspelled link of it.",
    why="The entry has no effect, or RViz waits for a transform that nobody publishes.",
    fix="Correct the name, or delete the entry.",
    bad="""\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/Axes
      Reference Frame: lidar_lnk
""",
    good="""\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/Axes
      Reference Frame: lidar_link
""",
    line=4,
    formats=("rviz",),
)


def _undeclared(config: RvizConfig, place: ValuePlace, robots: Robots) -> Iterator[Finding]:
    naming = robots[0].names.naming
    if place.word not in (FRAME, LINK, JOINT) or not naming.layout.frames:
        return
    bare = str(place.node.value).strip("/")
    if not bare or "<" in bare or bare in naming.shared_frames or bare in SENT_FRAMES:
        return
    if any(is_declared(robot.names, place.word, bare) for robot in robots):
        return
    # A driver's frame need not be in the description: only a likely typo is reported.
    near = did_you_mean(bare, _declared(robots, place.word), MISTYPED)
    if place.word == FRAME and not near:
        return
    message = f"the description has no {place.word} {bare!r}{near and ', '}{near}"
    hint = "correct the name or delete the entry"
    yield found_at(config.document, place.node, UNDECLARED, message, hint)


def _declared(robots: Robots, word: str) -> Iterable[str]:
    kinds = (LINK, FRAME) if word == FRAME else (word,)
    return dict.fromkeys(
        name for robot in robots for kind in kinds for name in robot.names.declared.get(kind, ())
    )


UNKNOWN_USE = declare(
    "MF205",
    "rviz-name-in-unknown-property",
    WARNING,
    what="A value of a display equals a link or joint of the description, but its use is not "
    "known.",
    why="It stays unchanged. If it is a frame, RViz looks for the frame of a single robot, which "
    "no robot of the fleet publishes.",
    fix="If it is a name, rename it by hand in the copy for each robot.",
    bad="""\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/Marker
      Attach To: lidar_link
""",
    good="""\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/Axes
      Reference Frame: lidar_link
""",
    line=4,
    formats=("rviz",),
)


def _mentions(config: RvizConfig, one: RvizItem, robots: Robots) -> Iterator[Finding]:
    claimed = {id(place.node) for place in one.places}
    for node in _scalars(one.node):
        if id(node) not in claimed and _is_mention(node, robots):
            message = (
                f"{node.value!r} is the name of a link or joint, but its use here is not known"
            )
            hint = "if it is a name, rename it by hand"
            yield found_at(config.document, node, UNKNOWN_USE, message, hint)


def _is_mention(node: yaml.ScalarNode, robots: Robots) -> bool:
    named = robots[0].names.naming.layout.frames and is_text(node)
    names = (LINK, JOINT)
    return named and any(is_declared(it.names, k, node.value) for it in robots for k in names)


def _scalars(node: yaml.Node) -> Iterator[yaml.ScalarNode]:
    """The values of a display and its maps, without titles."""
    for key, there in pairs(node):
        if key.value in (*_TITLES, "Displays"):
            continue
        if isinstance(there, yaml.ScalarNode):
            yield there
        yield from _scalars(there)
