# SPDX-License-Identifier: Apache-2.0
"""A Foxglove layout that follows from a plan: all robots in one tab, and a tab for each robot.

Source: lichtblick 66adecb99 (the open successor of Foxglove Studio), ``packages/suite-base/src``: keys
of a layout in ``context/CurrentLayoutContext/actions.ts`` and ``types/layouts.ts``, those of panels in
``panels/ThreeDeeRender/IRenderer.ts`` (3D, Image), ``panels/Teleop/types.ts`` and ``panels/Tab``, those
of a URDF in ``panels/ThreeDeeRender/renderables/Urdfs.ts``. A 3D panel reads every topic with
transforms into one tree (``Renderer.ts``, TF_DATATYPES). Teleop sends Twist alone
(``TeleopPanel.tsx``).
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from multibot_rewrite.base.conventions import BODY_FRAMES, WORLD_FRAMES
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.naming import LAYOUTS
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.system.records import (
    PUBLISHES,
    SUBSCRIBES,
    TOPIC,
    Robot,
    System,
    nodes_by_robot,
)

# What a 3D panel shows, and what an Image panel does.
_SHOWN = {
    *("sensor_msgs/msg/LaserScan", "sensor_msgs/msg/PointCloud2", "nav_msgs/msg/OccupancyGrid"),
    *("nav_msgs/msg/Path", "geometry_msgs/msg/PolygonStamped", "geometry_msgs/msg/PoseArray"),
    *("visualization_msgs/msg/Marker", "visualization_msgs/msg/MarkerArray"),
}
_IMAGE, _CAMERA = "sensor_msgs/msg/Image", "camera_info"
_TWIST, _DESCRIPTION = "geometry_msgs/msg/Twist", "robot_description"
# Topics that a click in a 3D panel sends to, by their last word.
_CLICKED = {
    "poseTopic": "goal_pose",
    "poseEstimateTopic": "initialpose",
    "pointTopic": "clicked_point",
}
Panels = Mapping[str, Mapping[str, Any]]


class _Tab(NamedTuple):
    """A title, and its panels with their settings."""

    title: str
    panels: Panels


def to_layout(plan: System) -> str:
    """The layout as JSON; UsageError where the frames of two robots have the same names."""
    layout = next(it for it in LAYOUTS if plan.layout in (it.name, it.short))
    if not layout.frames and len(plan.robots) > 1:
        raise UsageError(
            f"layout {layout.name}: the frames of all robots have the same names, and Foxglove reads"
            " every tf topic into one tree; take frames-per-robot or both"
        )
    tabs = [_Tab("all robots", _all(plan)), *(_Tab(it.name, _own(plan, it)) for it in plan.robots)]
    config: dict[str, Any] = {name: own for tab in tabs for name, own in tab.panels.items()}
    shown = [{"title": it.title, "layout": _mosaic(list(it.panels))} for it in tabs]
    config["Tab!robots"] = {"activeTabIdx": 0, "tabs": shown}
    rest = {"globalVariables": {}, "userNodes": {}, "playbackConfig": {"speed": 1}}
    return json.dumps({"configById": config, **rest, "layout": "Tab!robots"}, indent=1) + "\n"


def _mosaic(panels: Sequence[str]) -> Any:
    """The first panel beside the others, which are below each other."""
    first, *others = panels
    if not others:
        return first
    side: Any = others[-1]
    for one in reversed(others[:-1]):
        side = {"direction": "column", "first": one, "second": side}
    return {"direction": "row", "first": first, "second": side, "splitPercentage": 70}


def _all(plan: System) -> Panels:
    return {"3D!all": _scene(plan, plan.robots, _world(plan))}


def _world(plan: System) -> str:
    """The frame of all robots in which they stand, else the first robot's first."""
    shared = plan.shared_frames
    parents = [it.parent for it in plan.edges if it.parent in shared]
    usual = [it for it in WORLD_FRAMES if it in shared]
    own = (it for robot in plan.robots for it in robot.frames)
    return next(iter([*parents, *usual]), "") or next(own, "")


def _own(plan: System, robot: Robot) -> Panels:
    """The robot in 3D, its images, and buttons that drive it."""
    bodies = [it for it in robot.frames if any(body in it for body in BODY_FRAMES)]
    frame = next(iter(bodies or robot.frames), "")
    panels: dict[str, Mapping[str, Any]] = {
        f"3D!{robot.name}": _scene(plan, [robot], frame),
    }
    for at, topic in enumerate(sorted(_topics(plan, [robot], PUBLISHES, {_IMAGE}))):
        camera = f"{topic.rpartition('/')[0]}/{_CAMERA}"
        shown = {"imageTopic": topic, "calibrationTopic": camera}
        panels[f"Image!{robot.name}_{at}"] = {"imageMode": shown}
    for topic in _drives(plan, robot):
        panels[f"Teleop!{robot.name}"] = {"topic": topic, "publishRate": 10}
    return panels


def _drives(plan: System, robot: Robot) -> list[str]:
    """The topic of speeds that the robot reads and no planned node sends."""
    sent = {it.name for it in plan.ends if it.role == PUBLISHES}
    read = set(_topics(plan, [robot], SUBSCRIBES, {_TWIST})) - sent
    return sorted(read, key=lambda it: (it.count("/"), it))[:1]


def _scene(plan: System, robots: Sequence[Robot], frame: str) -> dict[str, Any]:
    shown = [*_topics(plan, robots, PUBLISHES, _SHOWN), *_shared(plan)]
    read = [*_topics(plan, robots, SUBSCRIBES, None)]
    clicked = {
        key: next((it for it in read if it.rpartition("/")[2].startswith(word)), f"/{word}")
        for key, word in _CLICKED.items()
    }
    return {
        "followTf": frame,
        "followMode": "follow-pose",
        "topics": {it: {"visible": True} for it in sorted(shown)},
        "layers": {it.name: _model(plan, it) for it in robots},
        "publish": {"type": "pose", **clicked},
    }


def _model(plan: System, robot: Robot) -> dict[str, Any]:
    """The robot's description, from its topic."""
    sent = _topics(plan, [robot], PUBLISHES, {"std_msgs/msg/String"})
    topic = next((it for it in sent if _DESCRIPTION in it), f"/{robot.name}/{_DESCRIPTION}")
    bare = next(it for it in LAYOUTS if plan.layout in (it.name, it.short)).at_run_time
    word = robot.tag or robot.name
    return {
        "layerId": "foxglove.Urdf",
        "instanceId": robot.name,
        "label": robot.name,
        "visible": True,
        "sourceType": "topic",
        "topic": topic,
        "framePrefix": next(iter(robot.frames), "")[: len(word) + 1] if bare else "",
    }


def _topics(
    plan: System, robots: Iterable[Robot], role: str, types: set[str] | None
) -> Iterator[str]:
    """Topics of the robots' nodes and bridges in a role, of some types or of any, each once."""
    every, robots = nodes_by_robot(plan), list(robots)
    nodes = {it for robot in robots for it in every[robot.name]}
    ends = [
        (it.name, it.type)
        for it in plan.ends
        if it.kind == TOPIC and it.role == role and it.node in nodes
    ]
    bridged = [
        (it.name, it.type)
        for it in plan.topics
        if role in it.bridge and any(_is_of(it.name, robot) for robot in robots)
    ]
    found = (name for name, type_ in (*ends, *bridged) if types is None or type_ in types)
    yield from dict.fromkeys(found)


def _is_of(topic: str, robot: Robot) -> bool:
    """Is a bridged topic one of the robot: in its namespace, or with its name at the end?"""
    return topic.startswith(f"/{robot.name}/") or topic.endswith(f"/{robot.tag or robot.name}")


def _shared(plan: System) -> list[str]:
    """What nodes for all robots show, as the map."""
    nodes = nodes_by_robot(plan)[""]
    ends = (it for it in plan.ends if it.role == PUBLISHES and it.node in nodes)
    return [it.name for it in ends if it.type in _SHOWN]
