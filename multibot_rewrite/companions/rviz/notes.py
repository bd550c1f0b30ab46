"""What a person should know about an RViz config that was made for robots."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import yaml

from multibot_rewrite.companions.respell import is_declared
from multibot_rewrite.companions.rviz.groups import for_one_process, leaves
from multibot_rewrite.companions.rviz.names import (
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
from multibot_rewrite.companions.rviz.read import (
    ABSOLUTE,
    DOCK,
    PROCESS,
    Config,
    Place,
    Shown,
    rviz_data,
    text_of,
    value,
)
from multibot_rewrite.companions.yaml_text import is_text, pairs
from multibot_rewrite.model import WARNING, Finding
from multibot_rewrite.naming import NAMESPACE
from multibot_rewrite.nearest import MISTYPED, did_you_mean

Robots = Sequence[RvizRobot]
# Never names of links: what displays and windows are called.
_TITLES = ("Name", "Class")


def notes(config: Config, robots: Robots, world: str, together: bool) -> Iterator[Finding]:
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


def _finding(config: Config, node: yaml.Node, code: str, message: str, hint: str) -> Finding:
    mark, file = node.start_mark, config.document.file
    return Finding(code, WARNING, message, hint, file, mark.line + 1, mark.column + 1)


def _windows(config: Config, robots: Robots, together: bool) -> Iterator[Finding]:
    layout = robots[0].names.naming.layout
    if together and not layout.tf_per_robot:
        return
    first = f"/{robots[0].topics.robot}/tf" if layout.namespaced else "the robot's tf topic"
    if together:
        message = "one window shows all robots only while each robot's tf is relayed to /tf"
        hint = f"ros2 run topic_tools relay {first} /tf, and the same for tf_static"
    else:
        message = (
            f"one rviz2 hears one tf topic, and {layout.name} has one a robot: a config for each"
        )
        hint = f"start each with -r /tf:={first} as its command says"
    yield _finding(config, config.manager, "MF203", message, hint)


def _fixed_frame(config: Config, robots: Robots, world: str, together: bool) -> Iterator[Finding]:
    node = value(value(config.manager, "Global Options"), "Fixed Frame")
    if not isinstance(node, yaml.ScalarNode):
        return
    if node.value.startswith("/"):
        message = f"Fixed Frame {node.value!r} starts with a slash, which tf2 look-ups reject"
        yield _finding(config, node, "MF211", message, "drop the slash")
    if together and any(frame_of(node, robot) != node.value for robot in robots):
        told = f"{world!r} stands there now" if world else "there is no frame that all share"
        message = f"Fixed Frame {node.value!r} is each robot's own; {told}"
        hint = (
            "send a transform from it to each robot, see poses" if world else "name a world frame"
        )
        yield _finding(config, node, "MF201", message, hint)


def _left_out(config: Config, robots: Robots, together: bool) -> Iterator[Finding]:
    whole = not together and robots[0].names.naming.layout.namespaced
    for one in (*leaves(config.displays), *config.tools, *config.panels):
        if for_one_process(one) and not (whole and one.flag == PROCESS):
            title = f"{one.cls} {one.name!r}" if one.name else one.cls
            message = (
                f"{title} is left out: it serves the robot that its rviz2 process is set up for"
            )
            hint = "for one robot start a second rviz2 with the old file in its namespace"
            if one.flag == ABSOLUTE:
                hint = "its names are absolute: remap each for an rviz2 of one robot"
            yield _finding(config, one.node, "MF202", message, hint)


def _view(config: Config, robots: Robots, together: bool) -> Iterator[Finding]:
    node = value(value(value(config.manager, "Views"), "Current"), "Target Frame")
    if not together or not isinstance(node, yaml.ScalarNode) or len(robots) < 2:
        return
    if any(frame_of(node, robot) != node.value for robot in robots):
        message = f"the view follows {node.value!r}: now that of {robots[0].name!r}"
        yield _finding(config, node, "MF213", message, "each robot has a saved view of its own")


def _unknown(config: Config, one: Shown) -> Finding:
    message = f"display class {one.cls!r} is not known: of its values only Topic is renamed"
    return _finding(config, one.node, "MF204", message, "look at its other topics and frames")


def _display(config: Config, one: Shown, robots: Robots, together: bool) -> Iterator[Finding]:
    naming, frames = robots[0].names.naming, robots[0].names.naming.layout.frames
    for place in one.places:
        given = str(place.node.value)
        node, name = place.node, f"{place.path.rstrip('.*')} {given!r}"
        if place.word == TF_PREFIX and frames and given and given != robots[0].tf_prefix:
            message = f"{name} is emptied: the links of a rewritten description have their prefix"
            hint = "RViz would put it before them a second time"
            yield _finding(config, node, "MF207", message, hint)
        if place.word == "regex" and frames and given:
            message = f"{name} is a pattern of frames and stays as it is"
            yield _finding(config, node, "MF208", message, "write it for the robots' frames")
        if place.word == "file" and given and text_of(one.node, "Description Source") == "File":
            message = f"{name} is one description, shown for every robot"
            hint = "set Description Source to Topic" if frames else "mind that all robots have it"
            yield _finding(config, node, "MF208", message, hint)
        if place.word == GRAPH_NAMESPACE and given and naming.topics != NAMESPACE:
            message = f"{name} holds topics, and this layout spells each topic for itself"
            yield _finding(config, node, "MF208", message, "a layout with namespaces moves it")
    yield from _properties(config, one, robots, together)


def _properties(config: Config, one: Shown, robots: Robots, together: bool) -> Iterator[Finding]:
    for key, there in pairs(one.node):
        if key.value in rviz_data()["legacy"]:
            message = (
                f"{key.value!r} of {one.name!r} is a property of ROS 1, which rviz2 reads over"
            )
            yield _finding(config, key, "MF209", message, "set its Topic in rviz2")
        if key.value == "Visibility" and one.flag == DOCK and together and pairs(there):
            message = f"what {one.name!r} shows of other displays is reset: they are in groups now"
            yield _finding(config, key, "MF212", message, "choose again in its Visibility")


def _volatile(config: Config) -> Iterator[Finding]:
    """Said once: nearly every saved config has it."""
    found = [
        one
        for one in leaves(config.displays)
        if text_of(value(one.node, "Description Topic"), "Durability Policy") == "Volatile"
    ]
    if found:
        names = ", ".join(repr(one.name) for one in found)
        message = f"{names} may miss a description published before rviz2 starts: it is Volatile"
        hint = "Durability Policy: Transient Local below Description Topic"
        yield _finding(config, found[0].node, "MF214", message, hint)


def _names(config: Config, one: Shown, robots: Robots) -> Iterator[Finding]:
    claimed = {id(place.node) for place in one.places}
    for place in filter(is_name, one.places):
        yield from _name(config, place, robots)
    for node in _scalars(one.node):
        if id(node) not in claimed and _is_mention(node, robots):
            message = (
                f"{node.value!r} is a link or joint, and nothing known says what it means here"
            )
            yield _finding(config, node, "MF205", message, "rename it by hand if it is meant")


def _is_mention(node: yaml.ScalarNode, robots: Robots) -> bool:
    named = robots[0].names.naming.layout.frames and is_text(node)
    names = (LINK, JOINT)
    return named and any(is_declared(it.names, k, node.value) for it in robots for k in names)


def _scalars(node: yaml.Node) -> Iterator[yaml.ScalarNode]:
    """The values of a display and its maps; what it and its groups are called is not of it."""
    for key, there in pairs(node):
        if key.value in (*_TITLES, "Displays"):
            continue
        if isinstance(there, yaml.ScalarNode):
            yield there
        yield from _scalars(there)


def _name(config: Config, place: Place, robots: Robots) -> Iterator[Finding]:
    """A placeholder that stays, a robot that is in it already, or a name that no description has."""
    given = str(place.node.value)
    there = next((it for it in robots if _has(given, place, it)), None)
    if there is not None:
        message = f"{given!r} has the name of {there.name!r} already, and gets each robot's as well"
        yield _finding(config, place.node, "MF215", message, "give the config of one robot alone")
    if "<" in without_placeholder(given, "") and given != "<Fixed Frame>":
        message = f"{given!r} is a placeholder that stays: who starts rviz2 has to fill it"
        yield _finding(config, place.node, "MF210", message, "write the name of one robot")
    elif place.word in (FRAME, LINK, JOINT) and robots[0].names.naming.layout.frames:
        yield from _missing(config, place, given, robots)


def _has(given: str, place: Place, robot: RvizRobot) -> bool:
    names = robot.names if place.word in (FRAME, LINK, JOINT) else robot.topics
    ends = given.strip("/").split("/")
    return len(ends) > 1 and names.robot in (ends[0], ends[-1])


def _missing(config: Config, place: Place, given: str, robots: Robots) -> Iterator[Finding]:
    bare = given.strip("/")
    shared = robots[0].names.naming.shared_frames
    if not bare or "<" in bare or bare in shared or bare in rviz_data()["frames"]:
        return
    if any(is_declared(robot.names, place.word, bare) for robot in robots):
        return
    # A frame of a driver need not be in the description: only one that looks mistyped is told.
    near = did_you_mean(bare, _declared(robots, place.word), MISTYPED)
    if place.word == FRAME and not near:
        return
    message = f"the description has no {place.word} {bare!r}{near and ', '}{near}"
    yield _finding(config, place.node, "MF206", message, "mend the name, or delete the entry")


def _declared(robots: Robots, word: str) -> Iterable[str]:
    kinds = (LINK, FRAME) if word == FRAME else (word,)
    return dict.fromkeys(
        name for robot in robots for kind in kinds for name in robot.names.declared.get(kind, ())
    )
