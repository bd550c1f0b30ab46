# SPDX-License-Identifier: Apache-2.0
"""The RViz configs that follow from a plan, for a fleet that has none of its own: each robot's
description, its sensors, maps and paths in the robot's colour, and tools for its goal and pose.

Sources: classes and properties ``rviz.yaml``; a map is latched (nav2_map_server map_server.cpp), so is
a description (robot_state_publisher.cpp); drivers send scans and clouds best effort (REP 2003).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from multibot_rewrite.base.findings.finding import WARNING, Finding, declare
from multibot_rewrite.base.naming import LAYOUTS, PREFIX, TF_TOPICS, make_naming
from multibot_rewrite.companions.rviz.display_groups import leaves
from multibot_rewrite.companions.rviz.read_config import (
    TF_PREFIX,
    TOPIC,
    RvizRobot,
    palette,
    read_config,
    rviz_data,
)
from multibot_rewrite.companions.rviz.rewrite import RvizText, rewrite_rviz
from multibot_rewrite.companions.yaml_text import YamlText, found_at, quoted
from multibot_rewrite.spelling.shown import Shown, shown_by_robot, world_of_plan
from multibot_rewrite.system.records import Robot, System

_BEST_EFFORT = {"Reliability Policy": "Best Effort"}
_LATCHED = {"Durability Policy": "Transient Local"}
_QOS = {"LaserScan": _BEST_EFFORT, "PointCloud2": _BEST_EFFORT, "Map": _LATCHED}
# Those with a colour; some take it only without one for each point.
_FLAT = ("LaserScan", "PointCloud2")
_COLOURED = (*_FLAT, "Range", "Path", "Polygon", "PoseArray")
# Costmaps hide the map below them, and each other.
_MAP = "map"
_TOOLS = {"SetInitialPose": "initialpose", "SetGoal": "goal_pose"}


def windows_of_plan(plan: System, relayed: bool) -> tuple[RvizText, ...]:
    """Return one config for all robots; one for each robot, with its namespace and tf topic, if
    each sends its transforms on its own topic and they are not ``relayed`` to ``/tf``."""
    layout = next(it for it in LAYOUTS if plan.layout in (it.name, it.short))
    robots, shared = shown_by_robot(plan)
    lines = [_group(it, at, layout.at_run_time) for at, it in enumerate(robots)]
    if len({it.tf_topic for it in plan.robots}) == 1 or (relayed and layout.frames):
        own = [*_displays(shared, ""), *lines]
        return (RvizText("", _text(own, robots, world_of_plan(plan))),)
    made = []
    for it, group in zip(robots, lines, strict=True):
        # The frame that the robot's frames hang on.
        own_frames = {*it.robot.frames, *it.robot.other_frames}
        parents = (edge.parent for edge in plan.edges if edge.child in own_frames)
        root = next(parents, next(iter(it.robot.frames), ""))
        text = _text([*_displays(shared, ""), group], [it], root)
        remaps = _tf_topics(it.robot, layout.namespaced)
        made.append(RvizText(it.robot.name, text, remaps=remaps))
    return tuple(made)


def _tf_topics(robot: Robot, namespaced: bool) -> tuple[tuple[str, str], ...]:
    """Return the rules for both topics of tf. The robot's name may have ``tf`` in it, or be it: the
    topic is the last part of a name in a namespace, else the first one of that name."""
    tf, static = TF_TOPICS
    parts = robot.tf_topic.split("/")
    places = [at for at, it in enumerate(parts) if it == tf]
    if places:
        parts[places[-1 if namespaced else 0]] = static
    other = "/".join(parts) if places else f"/{static}{robot.tf_topic.removeprefix(f'/{tf}')}"
    return (f"/{tf}", robot.tf_topic), (f"/{static}", other)


def _group(shown: Shown, at: int, prefixed: bool) -> dict[str, Any]:
    """Return the displays of a robot, in its colour."""
    robot = shown.robot
    model = {
        **_display("RobotModel", "RobotModel", {**_LATCHED, "Value": shown.description}, True),
        "Description Source": "Topic",
        "TF Prefix": (robot.tag or robot.name) if prefixed else "",
    }
    model["Description Topic"] = model.pop("Topic")
    colour = "; ".join(map(str, palette(at)))
    displays = [model, *_displays(shown, colour)]
    return {"Class": "rviz_common/Group", "Name": robot.name, "Enabled": True, "Displays": displays}


def _displays(shown: Shown, colour: str) -> Iterator[dict[str, Any]]:
    kinds = rviz_data()["shown"]
    for topic in sorted(shown.of_type(kinds)):
        kind = kinds[shown.sent[topic]]
        enabled = kind != "Map" or shown.is_called(topic, _MAP)
        made = _display(kind, topic, {**_QOS.get(kind, {}), "Value": topic}, enabled)
        if colour and kind in _COLOURED:
            made |= {"Color": colour}
        if colour and kind in _FLAT:
            made |= {"Color Transformer": "FlatColor"}
        yield made


def _display(kind: str, name: str, topic: dict[str, str], enabled: bool) -> dict[str, Any]:
    kind = f"rviz_default_plugins/{kind}"
    return {"Class": kind, "Name": name, "Enabled": enabled, "Topic": topic}


def _text(displays: Sequence[dict[str, Any]], robots: Sequence[Shown], frame: str) -> str:
    clicked = [
        {"Class": f"rviz_default_plugins/{kind}", "Topic": {"Value": topic}}
        for it in robots
        for kind, word in _TOOLS.items()
        if (topic := it.clicked(word))
    ]
    usual = [{"Class": f"rviz_default_plugins/{it}"} for it in ("MoveCamera", "Select")]
    first = [_plain("Grid"), _plain("TF")]
    config = {
        "Panels": [{"Class": "rviz_common/Displays", "Name": "Displays"}],
        "Visualization Manager": {
            "Class": "",
            "Displays": [*first, *displays],
            "Global Options": {"Fixed Frame": frame},
            "Tools": [*usual, *clicked],
            "Views": {"Current": {"Class": "rviz_default_plugins/Orbit", "Distance": 10}},
        },
    }
    return "".join(f"{line}\n" for line in _lines(config))


def _plain(kind: str) -> dict[str, Any]:
    return {"Class": f"rviz_default_plugins/{kind}", "Name": kind, "Enabled": True}


def _lines(value: Any) -> Iterator[str]:
    """Yield a mapping as lines of YAML. PyYAML takes longer than the rest of a build."""
    for key, there in value.items():
        if isinstance(there, dict):
            yield f"{key}:"
            yield from (f"  {it}" for it in _lines(there))
        elif isinstance(there, list):
            yield f"{key}:" if there else f"{key}: []"
            for one in there:
                first, *rest = _lines(one)
                yield from (f"  - {first}", *(f"    {it}" for it in rest))
        else:
            text = str(there).lower() if isinstance(there, bool | int) else quoted(there)
            yield f"{key}: {text}"


# The window for all robots where a bridge puts their names before the frames on their way to ``/tf``.
# Links have bare names and frames the robot's, as with robot_state_publisher's ``frame_prefix``; those
# in
# headers of messages stay bare. Source: tf_namespace_bridge src/tf_namespace_bridge.cpp; rviz_common
# src/rviz_common/transformation (displays of messages look their header's frame up in tf).
AT_RUN_TIME = "frame-prefix"

BARE_HEADERS = declare("MF216", "rviz-bridged-messages", WARNING, formats=("fleet",))


def bridged_window(
    document: YamlText, robots: Sequence[RvizRobot], world: str
) -> tuple[RvizText, tuple[Finding, ...]]:
    """Return the config for all robots, and its limits as findings; raises as ``rewrite_rviz``."""
    shared = [world] if world else []
    naming = make_naming(layout=AT_RUN_TIME, affix=PREFIX, shared_frames=shared)
    bridged = []
    for it in robots:
        own = it.topics.robot
        names = it.names._replace(naming=naming, robot=own)
        bridged.append(it._replace(names=names, tf_prefix=own))
    texts, _ = rewrite_rviz(document, bridged, world=world)
    shown = next(it for it in texts if not it.robot)
    return shown, tuple(_bare_headers(document))


def _bare_headers(document: YamlText) -> Iterator[Finding]:
    shown = ((it, {at.kind for at in it.places}) for it in leaves(read_config(document).displays))
    found = [it for it, kinds in shown if TOPIC in kinds and TF_PREFIX not in kinds]
    if found:
        names = ", ".join(it.name or it.cls for it in found)
        message = (
            f"the window for all robots shows nothing of {names}: "
            "frames in headers are without the robot's name"
        )
        hint = "each robot has a window for it; or take layout both"
        yield found_at(document, found[0].node, BARE_HEADERS, message, hint)
