# SPDX-License-Identifier: Apache-2.0
"""What a viewer can show of each robot of a plan, and a layout of Foxglove that shows it."""

import json
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from multibot_rewrite.base.conventions import BODY_FRAMES, WORLD_FRAMES
from multibot_rewrite.base.naming import LAYOUTS
from multibot_rewrite.system.ownership import whose_by_plan
from multibot_rewrite.system.records import (
    PUBLISHES,
    RUNS,
    SUBSCRIBES,
    TOPIC,
    Robot,
    System,
    surely,
)

_STRING, _DESCRIPTION = "std_msgs/msg/String", "robot_description"


class Shown(NamedTuple):
    """A robot with the types of the topics that its nodes and bridges send, and of those they read.

    A robot without a name stands for what all robots share.
    """

    robot: Robot
    sent: dict[str, str]
    read: dict[str, str]

    @property
    def description(self) -> str:
        """The topic of its description."""
        sent = self.of_type({_STRING})
        usual = f"/{self.robot.space}/{_DESCRIPTION}"
        return next((it for it in sent if _DESCRIPTION in it), usual)

    def of_type(self, types: Iterable[str]) -> list[str]:
        """Return the topics of these types that it sends."""
        some = set(types)
        return [name for name, type_ in self.sent.items() if type_ in some]

    def clicked(self, word: str) -> str:
        """Return the topic with this last word, such as ``initialpose``, that it reads; or ""."""
        return next((it for it in self.read if self.is_called(it, word)), "")

    def is_called(self, topic: str, word: str) -> bool:
        """Return whether the topic is ``/robot1/WORD`` or ``/WORD/robot1``."""
        own = ("", *self.robot.space.split("/"), self.robot.tag)
        return [it for it in topic.split("/") if it not in own] == [word]


def shown_by_robot(plan: System) -> tuple[list[Shown], Shown]:
    """Return what can be shown of every robot, and what all robots share."""
    every = {it.name: Shown(it, {}, {}) for it in (Robot(""), *plan.robots)}
    whose = whose_by_plan(plan).robot
    owners = {it.name: it.robot for it in plan.nodes}
    for end in plan.ends:
        if end.kind == TOPIC and end.sure == RUNS:
            _add_topic(every.get(owners.get(end.node, "")), end.role, end.name, end.type)
    for topic in plan.topics:
        owner = whose(topic.name)
        for role in topic.bridge if owner else ():
            _add_topic(every[owner], role, topic.name, topic.type)
    shared = every.pop("")
    return list(every.values()), shared


def _add_topic(shown: Shown | None, role: str, topic: str, type_: str) -> None:
    if shown and role in (PUBLISHES, SUBSCRIBES):
        (shown.sent if role == PUBLISHES else shown.read).setdefault(topic, type_)


def world_of_plan(plan: System) -> str:
    """Return the frame of all robots that is their world, or the first frame of the first robot."""
    shared = plan.shared_frames
    worlds = (
        *(it.parent for it in plan.edges if it.parent in shared),
        *(it for it in WORLD_FRAMES if it in shared),
        *(it for robot in plan.robots for it in robot.frames),
    )
    return next(iter(worlds), "")


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
    """Return the layout as JSON; empty if the frames of two robots have the same names."""
    layout = next(it for it in LAYOUTS if plan.layout in (it.name, it.short))
    if not layout.frames and len(plan.robots) > 1:
        return ""
    robots, shared = shown_by_robot(plan)
    sent = {it.name for it in surely(plan).ends if it.role == PUBLISHES}
    prefixed = layout.at_run_time
    every = _scene(robots, shared, world_of_plan(plan), prefixed)
    tabs = [
        _Tab("all robots", {"3D!all": every}),
        *(_Tab(it.robot.name, _panels_of_robot(it, shared, sent, prefixed)) for it in robots),
    ]
    config: dict[str, Any] = {name: own for tab in tabs for name, own in tab.panels.items()}
    shown = []
    for tab in tabs:
        # The first panel beside the others, which are below each other.
        first, *others = tab.panels
        mosaic: Any = first
        if others:
            side: Any = others[-1]
            for one in reversed(others[:-1]):
                side = {"direction": "column", "first": one, "second": side}
            sides = {"first": first, "second": side}
            mosaic = {"direction": "row", **sides, "splitPercentage": 70}
        shown.append({"title": tab.title, "layout": mosaic})
    config["Tab!robots"] = {"activeTabIdx": 0, "tabs": shown}
    rest = {"globalVariables": {}, "userNodes": {}, "playbackConfig": {"speed": 1}}
    return json.dumps({"configById": config, **rest, "layout": "Tab!robots"}, indent=1) + "\n"


def _panels_of_robot(shown: Shown, shared: Shown, sent: set[str], prefixed: bool) -> Panels:
    """Return the robot in 3D, its images, and buttons that drive it."""
    name, frames = shown.robot.name, shown.robot.frames
    bodies = [it for it in frames if any(body in it for body in BODY_FRAMES)]
    frame = next(iter(bodies or frames), "")
    panels: dict[str, Mapping[str, Any]] = {f"3D!{name}": _scene([shown], shared, frame, prefixed)}
    for at, topic in enumerate(sorted(shown.of_type({_IMAGE}))):
        camera = f"{topic.rpartition('/')[0]}/{_CAMERA}"
        settings = {"imageTopic": topic, "calibrationTopic": camera}
        panels[f"Image!{name}_{at}"] = {"imageMode": settings}
    # The topic of speeds that the robot reads and no planned node sends.
    drives = {name for name, type_ in shown.read.items() if type_ == _TWIST} - sent
    for topic in sorted(drives, key=lambda it: (it.count("/"), it))[:1]:
        panels[f"Teleop!{name}"] = {"topic": topic, "publishRate": 10}
    return panels


def _scene(robots: Sequence[Shown], shared: Shown, frame: str, prefixed: bool) -> dict[str, Any]:
    """Return the settings of a 3D panel."""
    topics = {it for one in (*robots, shared) for it in one.of_type(_SHOWN)}
    layers = {}
    for it in robots:
        name, word = it.robot.name, it.robot.tag or it.robot.name
        lead = next(iter(it.robot.frames), "")[: len(word) + 1] if prefixed else ""
        layer = {"layerId": "foxglove.Urdf", "instanceId": name, "label": name, "visible": True}
        layers[name] = {
            **layer,
            "sourceType": "topic",
            "topic": it.description,
            "framePrefix": lead,
        }
    clicked = {
        key: next(filter(None, (it.clicked(word) for it in robots)), f"/{word}")
        for key, word in _CLICKED.items()
    }
    return {
        "followTf": frame,
        "followMode": "follow-pose",
        "topics": {it: {"visible": True} for it in sorted(topics)},
        "layers": layers,
        "publish": {"type": "pose", **clicked},
    }
