# SPDX-License-Identifier: Apache-2.0
"""Finds where robots collide, and what matched before a rewrite and does not after it.

That is names that two robots have and that are not shared; remap rules without their names; two
ends that were equal; what another process makes of a topic's name. The codes are those of the
rules for a running system."""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.naming import NAMESPACE, Naming, is_keyword, is_of_world
from multibot_rewrite.base.rosnames import expand
from multibot_rewrite.description.readback import active
from multibot_rewrite.description.readback.nodes import (
    ACTION,
    BELOW,
    SERVICE,
    TOPIC,
    ReadNode,
    RuntimeName,
    full_name,
    itself,
)
from multibot_rewrite.description.readback.reading import FRAME, IN_CODE, NODE, Reading

TWO_NODES, TWO_SERVERS, COMMAND, DATA = "MG301", "MG305", "MG310", "MG320"
FRAMES, LOOKUP, NOT_TAKEN = "MG402", "MB425", "MR105"
OPENED = "MB412"
# What two robots may both have on computers of their own.
OF_COMPUTER = frozenset({active.DEVICE, active.PORT})
# What is said of a number that each further robot got in the place of such a one.
NUMBERED = "MF845"
SHARED_CODES = frozenset({TWO_NODES, TWO_SERVERS, COMMAND, DATA, FRAMES, LOOKUP, NOT_TAKEN, OPENED})
# The type of a topic called as one that moves a robot, where it is not known.
_USUAL = "geometry_msgs/msg/Twist"
_FIXED = "it is in the code of the plugin, so no description moves it"
_ALLOWED = "allow it with --shared /TOPIC (shared_topics in a fleet file)"
_OF_FRAME = "allow it with --shared FRAME (shared_frames in a fleet file)"
_ALLOW = f"rename it for each robot, or {_ALLOWED}"
_ADVICE = {
    TWO_NODES: "give each robot's node a name or namespace of its own",
    TWO_SERVERS: "rename it for each robot",
    COMMAND: _ALLOW,
    DATA: _ALLOW,
    OPENED: "write another for each robot, or give it by `arguments` of a fleet file",
    FRAMES: f"set the frame for each robot, or {_OF_FRAME}",
}
_OF_KIND = {
    active.TRANSFORMS_ON: "no rule moves it: use --layout frames-per-robot",
    active.RELATIVE: "give each robot a namespace: use --layout tf-per-robot or both",
}
CAMERA_INFO = "camera_info"
# The element of a name, its parameter, and the how manieth it is there.
Place = tuple[str, int, str, str, int]
# The rule that is about a kind of shared name.
_CODES = {
    active.TRANSFORMS_ON: DATA,
    NODE: TWO_NODES,
    active.RELATIVE: TWO_NODES,
    FRAME: FRAMES,
    **dict.fromkeys(
        (active.ADDRESS, active.DEVICE, active.FILE, active.NUMBER, active.PORT), OPENED
    ),
}


class Meeting(NamedTuple):
    """A name of ``robot`` that ``other`` has, too, as ``twin``."""

    robot: str
    other: str
    name: RuntimeName
    twin: RuntimeName


def same_for_all(names: Iterable[RuntimeName], word: str, naming: Naming) -> Iterator[RuntimeName]:
    """Yield the names that do not contain ``word``, the robot's name, each at its first place."""
    seen: set[tuple[str, str]] = set()
    for it in _own(names, naming):
        if word not in it.name and (it.kind, it.name) not in seen:
            seen.add((it.kind, it.name))
            yield it


def meetings(named: Mapping[str, Iterable[RuntimeName]], naming: Naming) -> Iterator[Meeting]:
    """Yield the names that two robots have, each once."""
    first: dict[tuple[str, str], tuple[str, RuntimeName]] = {}
    seen: set[tuple[str, str]] = set()
    for robot, names in named.items():
        for it in _own(names, naming):
            key = it.kind, it.name
            other, name = first.setdefault(key, (robot, it))
            if other != robot and key not in seen:
                seen.add(key)
                yield Meeting(other, robot, name, it)


def _own(names: Iterable[RuntimeName], naming: Naming) -> Iterator[RuntimeName]:
    """Yield the names that each robot must have for itself."""
    for it in names:
        bare = it.name.strip("/")
        if it.kind == FRAME:
            # Where each robot has a tf topic of its own, frames may be the same.
            at_run_time = naming.layout.at_run_time and it.tag == "link"
            shared = at_run_time or not naming.layout.frames or bare in naming.shared_frames
        elif it.kind in (TOPIC, BELOW, SERVICE, ACTION):
            # __default_topic__ is no topic: the simulator makes one from the model's name.
            shared = bare in naming.shared_topics or is_keyword(bare) or is_of_world(it.name)
        elif it.kind == active.TRANSFORMS_ON:
            shared = naming.layout.frames
        else:
            shared = it.kind == active.RELATIVE and naming.topics == NAMESPACE
        if not shared:
            yield it


def code_of(name: RuntimeName) -> str:
    """Return the code of the rule for a shared name."""
    if name.of_controllers:
        return NOT_TAKEN
    if name.kind in (SERVICE, ACTION):
        return TWO_SERVERS
    if name.kind in (TOPIC, BELOW):
        from multibot_rewrite.system.words import is_order  # nothing is shared in most files

        return COMMAND if is_order(name.name, name.type or _USUAL) else DATA
    return _CODES.get(name.kind, LOOKUP)


def said(who: str, *names: RuntimeName) -> str:
    """Return the message that robots share a name, with the parts that have it."""
    name, by = names[0], " and ".join(dict.fromkeys(it.path for it in names))
    if code_of(name) == LOOKUP:
        return (
            f"the {name.kind} {name.name!r} is looked up in the whole world without the robot's name: "
            "it may find that of another robot"
        )
    return f"{who} have the {name.kind} {name.name!r} ({by})"


def advice(name: RuntimeName, together: bool = False) -> str:
    """Return the hint for a shared name, unless of a controller; ``together``: in one call."""
    if name.kind in _OF_KIND:
        return _OF_KIND[name.kind]
    if name.kind == active.NUMBER and not together:
        return "name all robots in one call, or in a fleet file: each gets a number of its own"
    if name.kind in OF_COMPUTER:
        return f"{_ADVICE[OPENED]}; it is right where each robot has a computer of its own"
    if name.path == IN_CODE or (name.path.startswith("/") and code_of(name) in _ADVICE):
        return _for_code(name)
    if "/../" in name.path:
        return "use --topics namespace or prefix, which leave the last part of a topic alone"
    of_all = f"use --layout both, which renames {name.kind}s for each robot"
    return _ADVICE.get(code_of(name), of_all)


def _for_code(name: RuntimeName) -> str:
    """Return the hint for a shared name that is fixed in a plugin's code."""
    if code_of(name) == LOOKUP:
        return "run each robot in a Gazebo of its own, or if it has a prefix use --affix prefix"
    if name.path == IN_CODE:
        return f"{_FIXED}: use --layout tf-per-robot, or {_OF_FRAME}"
    if name.tag == "ros2_control":
        rule = f"-r {name.name}:={name.name.lstrip('/')}"
        return f"give each robot's controller manager the rule {rule}, and a namespace"
    # Of two servers any answers: that cannot be meant.
    is_served = code_of(name) == TWO_SERVERS
    return f"{_FIXED}: {'load the plugin for one robot only' if is_served else _ALLOWED}"


class LostRule(NamedTuple):
    """A rule, the full name that it was for, and the plugin: the ``number``-th of the file."""

    number: int
    rule: str
    name: str


def lost_rules(before: Reading, after: Reading) -> Iterator[LostRule]:
    """Yield each lost rule once for each name."""
    now = {node.number: node for node in after.nodes}
    found: dict[LostRule, None] = {}
    for node in (it for it in before.nodes if it.rules and it.number in now):
        new = now[node.number]
        for old, end in zip(node.endpoints, new.endpoints, strict=False):
            name, at = _applied(node, old)
            if at is None:
                continue
            again = _applied(new, end)[1]
            # An inserted rule may do its work: /tf:=x for tf:=x, which is another name in a namespace.
            if again is None or new.rules[again].rule.target != new.rules[at].rule.target:
                rule = node.rules[at].rule
                found[LostRule(node.number, f"{rule.source}:={rule.target}", name)] = None
    yield from found


def _applied(node: ReadNode, end: RuntimeName) -> tuple[str, int | None]:
    """Return the full name of an end without rules, and the number of its rule or None."""
    # Those of ``<remapping>`` are counted from the end, because inserted ones come first.
    bound = itself(node)
    name = full_name(end.code_name, end.kind, bound)
    sources = [expand(it.rule.source, bound.namespace, bound.node) for it in node.rules]
    if end.name == name or name not in sources:
        return name, None
    at = sources.index(name)
    return name, at if node.rules[at].tag == "argument" else at - len(sources)


def parted(before: Reading, after: Reading) -> Iterator[tuple[RuntimeName, RuntimeName]]:
    """Yield (end, first end) where both had one topic before, and have two now."""
    now = _by_place((*after.names, *after.other_ends))
    was = _by_place((*before.names, *before.other_ends))
    of_topic = lists_by_key(((it.kind, it.name), at) for at, it in was.items() if at in now)
    for places in of_topic.values():
        first = now[places[0]]
        yield from ((now[it], first) for it in places[1:] if now[it].name != first.name)


def undescribed(before: Reading, after: Reading) -> Iterator[tuple[RuntimeName, str, str]]:
    """Yield (image, wanted name, present name) of each image that lost its camera_info."""
    # A viewer replaces the last segment of an image's topic (image_common camera_common.cpp
    # getCameraInfoTopic; RViz and image_pipeline subscribe with it).
    now = _by_place(after.names)
    was = _by_place(before.names)
    infos = lists_by_key((name.name, place) for place, name in was.items())
    new = {it.name for it in now.values()}
    cameras = {(it.tag, it.number) for it in before.names if it.name == _camera_info_topic(it.name)}
    for place, name in was.items():
        beside = _camera_info_topic(name.name)
        is_camera = name.tag == "sensor" and (name.tag, name.number) in cameras
        is_image = beside != name.name and (is_camera or "image" in name.name)
        info = next((now[it].name for it in infos.get(beside, ()) if it in now), "")
        if is_image and info and place in now and _camera_info_topic(now[place].name) not in new:
            yield now[place], _camera_info_topic(now[place].name), info


def _camera_info_topic(topic: str) -> str:
    return f"{topic.rpartition('/')[0]}/{CAMERA_INFO}"


def _by_place(names: Iterable[RuntimeName]) -> Mapping[Place, RuntimeName]:
    """Return topics and services by their place: element, path, kind, and a count of equal ones."""
    found: dict[Place, RuntimeName] = {}
    seen: Counter[tuple[str, int, str, str]] = Counter()
    for it in names:
        if it.kind in (TOPIC, SERVICE) and not it.of_controllers:
            place = it.tag, it.number, it.path, it.kind
            numbered = (*place, seen[place])
            found[numbered] = it
            seen[place] += 1
    return found
