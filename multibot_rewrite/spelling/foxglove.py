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
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from multibot_rewrite.base.conventions import BODY_FRAMES
from multibot_rewrite.base.naming import LAYOUTS
from multibot_rewrite.spelling.shown import Shown, shown_by_robot, world_of_plan
from multibot_rewrite.system.records import PUBLISHES, System, surely

# What a 3D panel shows, and what an Image panel does.
_SHOWN = {
    *("sensor_msgs/msg/LaserScan", "sensor_msgs/msg/PointCloud2", "nav_msgs/msg/OccupancyGrid"),
    *("nav_msgs/msg/Path", "geometry_msgs/msg/PolygonStamped", "geometry_msgs/msg/PoseArray"),
    *("visualization_msgs/msg/Marker", "visualization_msgs/msg/MarkerArray"),
}
_IMAGE, _CAMERA = "sensor_msgs/msg/Image", "camera_info"
_TWIST = "geometry_msgs/msg/Twist"
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
    """The layout as JSON; empty where the frames of two robots have the same names."""
    layout = next(it for it in LAYOUTS if plan.layout in (it.name, it.short))
    if not layout.frames and len(plan.robots) > 1:
        return ""
    robots, shared = shown_by_robot(plan)
    sent = {it.name for it in surely(plan).ends if it.role == PUBLISHES}
    prefixed = layout.at_run_time
    every = _scene(robots, shared, world_of_plan(plan), prefixed)
    tabs = [
        _Tab("all robots", {"3D!all": every}),
        *(_Tab(it.robot.name, _own(it, shared, sent, prefixed)) for it in robots),
    ]
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


def _own(shown: Shown, shared: Shown, sent: set[str], prefixed: bool) -> Panels:
    """The robot in 3D, its images, and buttons that drive it."""
    name, frames = shown.robot.name, shown.robot.frames
    bodies = [it for it in frames if any(body in it for body in BODY_FRAMES)]
    frame = next(iter(bodies or frames), "")
    panels: dict[str, Mapping[str, Any]] = {f"3D!{name}": _scene([shown], shared, frame, prefixed)}
    for at, topic in enumerate(sorted(shown.of_type({_IMAGE}))):
        camera = f"{topic.rpartition('/')[0]}/{_CAMERA}"
        settings = {"imageTopic": topic, "calibrationTopic": camera}
        panels[f"Image!{name}_{at}"] = {"imageMode": settings}
    for topic in _drives(shown, sent):
        panels[f"Teleop!{name}"] = {"topic": topic, "publishRate": 10}
    return panels


def _drives(shown: Shown, sent: set[str]) -> list[str]:
    """The topic of speeds that the robot reads and no planned node sends."""
    read = {name for name, type_ in shown.read.items() if type_ == _TWIST} - sent
    return sorted(read, key=lambda it: (it.count("/"), it))[:1]


def _scene(robots: Sequence[Shown], shared: Shown, frame: str, prefixed: bool) -> dict[str, Any]:
    topics = {it for one in (*robots, shared) for it in one.of_type(_SHOWN)}
    clicked = {
        key: next(filter(None, (it.clicked(word) for it in robots)), f"/{word}")
        for key, word in _CLICKED.items()
    }
    return {
        "followTf": frame,
        "followMode": "follow-pose",
        "topics": {it: {"visible": True} for it in sorted(topics)},
        "layers": {it.robot.name: _model(it, prefixed) for it in robots},
        "publish": {"type": "pose", **clicked},
    }


def _model(shown: Shown, prefixed: bool) -> dict[str, Any]:
    """The robot's description, from its topic."""
    robot = shown.robot
    word = robot.tag or robot.name
    return {
        "layerId": "foxglove.Urdf",
        "instanceId": robot.name,
        "label": robot.name,
        "visible": True,
        "sourceType": "topic",
        "topic": shown.description,
        "framePrefix": next(iter(robot.frames), "")[: len(word) + 1] if prefixed else "",
    }
