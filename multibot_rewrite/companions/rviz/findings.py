"""Findings about an RViz config that was rewritten for robots."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import yaml

from multibot_rewrite.companions.names.rename_map import is_declared
from multibot_rewrite.companions.rviz.display_groups import for_one_process, leaves
from multibot_rewrite.companions.rviz.read_config import (
    ABSOLUTE,
    DOCK,
    PROCESS,
    RvizConfig,
    RvizItem,
    ValuePlace,
    rviz_data,
    text_of,
    value,
)
from multibot_rewrite.companions.rviz.values import (
    FRAME,
    GRAPH_NAMESPACE,
    JOINT,
    LINK,
    TF_PREFIX,
    RvizRobot,
    frame_of,
    is_name,
    without_placeholder,
)
from multibot_rewrite.companions.yaml_text import is_text, pairs
from multibot_rewrite.model import WARNING, Finding
from multibot_rewrite.naming import NAMESPACE
from multibot_rewrite.nearest import MISTYPED, did_you_mean

Robots = Sequence[RvizRobot]
# Titles of displays and windows: never names of links.
_TITLES = ("Name", "Class")


def config_findings(
    config: RvizConfig, robots: Robots, world: str, together: bool
) -> Iterator[Finding]:
    """The findings, each once, in the order of the file."""
    found = [
        *_windows(config, robots, together),
        *_fixed_frame(config, robots, world, together),
        *_left_out(config, robots, together),
        *_view(config, robots, together),
        *_volatile(config),
    ]
    for one in leaves(config.displays):
        if not one.known:
            found.append(_unknown(config, one))
        found += _display(config, one, robots, together)
    for one in (*leaves(config.displays), *config.tools):
        found += _names(config, one, robots)
    yield from sorted(dict.fromkeys(found), key=lambda it: (it.line, it.column, it.code))


def _finding(config: RvizConfig, node: yaml.Node, code: str, message: str, hint: str) -> Finding:
    mark, file = node.start_mark, config.document.file
    return Finding(code, WARNING, message, hint, file, mark.line + 1, mark.column + 1)


def _windows(config: RvizConfig, robots: Robots, together: bool) -> Iterator[Finding]:
    layout = robots[0].names.naming.layout
    if together and not layout.tf_per_robot:
        return
    first = f"/{robots[0].topics.robot}/tf" if layout.namespaced else "the robot's tf topic"
    if together:
        message = "one window shows all robots only if each robot's tf is relayed to /tf"
        hint = f"ros2 run topic_tools relay {first} /tf, and the same for tf_static"
    else:
        message = (
            f"one rviz2 reads one tf topic, but in layout {layout.name} each robot has its own"
        )
        hint = f"each robot gets its own config; start rviz2 with -r /tf:={first}, see commands.md"
    yield _finding(config, config.manager, "MF203", message, hint)


def _fixed_frame(
    config: RvizConfig, robots: Robots, world: str, together: bool
) -> Iterator[Finding]:
    node = value(value(config.manager, "Global Options"), "Fixed Frame")
    if not isinstance(node, yaml.ScalarNode):
        return
    if node.value.startswith("/"):
        message = f"Fixed Frame {node.value!r} starts with a slash, which tf2 rejects"
        yield _finding(config, node, "MF211", message, "remove the slash")
    if together and any(frame_of(node, robot) != node.value for robot in robots):
        now = f"it is {world!r} now" if world else "no frame is shared by all robots"
        message = f"Fixed Frame {node.value!r} differs from robot to robot; {now}"
        hint = "publish a transform from it to each robot, see pose:" if world else "set world:"
        yield _finding(config, node, "MF201", message, hint)


def _left_out(config: RvizConfig, robots: Robots, together: bool) -> Iterator[Finding]:
    whole = not together and robots[0].names.naming.layout.namespaced
    for one in (*leaves(config.displays), *config.tools, *config.panels):
        if for_one_process(one) and not (whole and one.flag == PROCESS):
            title = f"{one.cls} {one.name!r}" if one.name else one.cls
            message = (
                f"{title} is left out: it works only for the robot whose namespace rviz2 runs in"
            )
            hint = "for that robot start a second rviz2 in its namespace with the original file"
            if one.flag == ABSOLUTE:
                hint = "its topics are absolute: remap them in an rviz2 for one robot"
            yield _finding(config, one.node, "MF202", message, hint)


def _view(config: RvizConfig, robots: Robots, together: bool) -> Iterator[Finding]:
    node = value(value(value(config.manager, "Views"), "Current"), "Target Frame")
    if not together or not isinstance(node, yaml.ScalarNode) or len(robots) < 2:
        return
    if any(frame_of(node, robot) != node.value for robot in robots):
        message = f"the view follows {node.value!r}; it now follows robot {robots[0].name!r}"
        yield _finding(config, node, "MF213", message, "each robot has a saved view")


def _unknown(config: RvizConfig, one: RvizItem) -> Finding:
    message = f"display class {one.cls!r} is not known; only its Topic is renamed"
    return _finding(config, one.node, "MF204", message, "check its other topics and frames")


def _display(
    config: RvizConfig, one: RvizItem, robots: Robots, together: bool
) -> Iterator[Finding]:
    naming, frames = robots[0].names.naming, robots[0].names.naming.layout.frames
    for place in one.places:
        given = str(place.node.value)
        node, name = place.node, f"{place.path.rstrip('.*')} {given!r}"
        if place.word == TF_PREFIX and frames and given and given != robots[0].tf_prefix:
            message = (
                f"{name} is emptied: the links of a rewritten description have the prefix already"
            )
            hint = "nothing to do; RViz would add the prefix a second time"
            yield _finding(config, node, "MF207", message, hint)
        if place.word == "regex" and frames and given:
            message = f"{name} is a pattern for frames and stays unchanged"
            yield _finding(config, node, "MF208", message, "make it match the robots' frames")
        if place.word == "file" and given and text_of(one.node, "Description Source") == "File":
            message = f"{name} is one description file, shown for every robot"
            hint = (
                "set Description Source to Topic" if frames else "fine if all robots look the same"
            )
            yield _finding(config, node, "MF208", message, hint)
        if place.word == GRAPH_NAMESPACE and given and naming.topics != NAMESPACE:
            message = f"{name} is a namespace of topics, but this layout renames each topic instead"
            yield _finding(config, node, "MF208", message, "use a layout with namespaces")
    yield from _properties(config, one, robots, together)


def _properties(
    config: RvizConfig, one: RvizItem, robots: Robots, together: bool
) -> Iterator[Finding]:
    for key, there in pairs(one.node):
        if key.value in rviz_data()["legacy"]:
            message = f"{key.value!r} of {one.name!r} is a ROS 1 property, which rviz2 ignores"
            yield _finding(config, key, "MF209", message, "set its Topic in rviz2")
        if key.value == "Visibility" and one.flag == DOCK and together and pairs(there):
            message = f"Visibility of {one.name!r} is reset: the displays are in groups now"
            yield _finding(config, key, "MF212", message, "choose the displays again in rviz2")


def _volatile(config: RvizConfig) -> Iterator[Finding]:
    """Reported once: nearly every saved config has it."""
    found = [
        one
        for one in leaves(config.displays)
        if text_of(value(one.node, "Description Topic"), "Durability Policy") == "Volatile"
    ]
    if found:
        names = ", ".join(repr(one.name) for one in found)
        message = f"{names} misses a description published before rviz2 starts: it is Volatile"
        hint = "set Durability Policy: Transient Local below Description Topic"
        yield _finding(config, found[0].node, "MF214", message, hint)


def _names(config: RvizConfig, one: RvizItem, robots: Robots) -> Iterator[Finding]:
    claimed = {id(place.node) for place in one.places}
    for place in filter(is_name, one.places):
        yield from _name(config, place, robots)
    for node in _scalars(one.node):
        if id(node) not in claimed and _is_mention(node, robots):
            message = (
                f"{node.value!r} is the name of a link or joint, but its use here is not known"
            )
            yield _finding(config, node, "MF205", message, "if it is a name, rename it by hand")


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


def _name(config: RvizConfig, place: ValuePlace, robots: Robots) -> Iterator[Finding]:
    """A placeholder that stays, a name that has a robot's name already, or an undeclared name."""
    given = str(place.node.value)
    there = next((it for it in robots if _has(given, place, it)), None)
    if there is not None:
        message = f"{given!r} already holds the name of robot {there.name!r}"
        hint = "use a config for a single robot without namespace and prefix"
        yield _finding(config, place.node, "MF215", message, hint)
    if "<" in without_placeholder(given, "") and given != "<Fixed Frame>":
        message = (
            f"the placeholder in {given!r} stays; the launch file that starts rviz2 must replace it"
        )
        hint = "write the name as for a single robot"
        yield _finding(config, place.node, "MF210", message, hint)
    elif place.word in (FRAME, LINK, JOINT) and robots[0].names.naming.layout.frames:
        yield from _missing(config, place, given, robots)


def _has(given: str, place: ValuePlace, robot: RvizRobot) -> bool:
    names = robot.names if place.word in (FRAME, LINK, JOINT) else robot.topics
    ends = given.strip("/").split("/")
    return len(ends) > 1 and names.robot in (ends[0], ends[-1])


def _missing(
    config: RvizConfig, place: ValuePlace, given: str, robots: Robots
) -> Iterator[Finding]:
    bare = given.strip("/")
    shared = robots[0].names.naming.shared_frames
    if not bare or "<" in bare or bare in shared or bare in rviz_data()["frames"]:
        return
    if any(is_declared(robot.names, place.word, bare) for robot in robots):
        return
    # A driver's frame need not be in the description: only a likely typo is reported.
    near = did_you_mean(bare, _declared(robots, place.word), MISTYPED)
    if place.word == FRAME and not near:
        return
    message = f"the description has no {place.word} {bare!r}{near and ', '}{near}"
    yield _finding(config, place.node, "MF206", message, "correct the name or delete the entry")


def _declared(robots: Robots, word: str) -> Iterable[str]:
    kinds = (LINK, FRAME) if word == FRAME else (word,)
    return dict.fromkeys(
        name for robot in robots for kind in kinds for name in robot.names.declared.get(kind, ())
    )
