# SPDX-License-Identifier: Apache-2.0
"""What a robot does not do, and why; the first of it: two things of one name."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from fleet import Fleet


class Fault(NamedTuple):
    """What a robot does not do ("starts", "drives", "sees", "plans"), and why."""

    robot: str
    what: str
    why: str


def twins(fleet: Fleet) -> Iterator[Fault]:
    """Nodes of one name: the second takes the services of the first. Bridges and windows have none."""
    seen: dict[str, str] = {}
    for it in fleet.nodes:
        if it.what not in ("parameter_bridge", "rviz2") and it.fqn in seen:
            yield Fault(it.robot, "starts", f"two nodes are called {it.fqn}")
        seen[it.fqn] = it.robot


def models_twice(fleet: Fleet) -> Iterator[Fault]:
    """Models of one name: the simulator refuses the second (-allow_renaming=false)."""
    first: dict[str, str] = {}
    for robot, model in fleet.models.items():
        if model in first:
            yield Fault(robot, "starts", f"two models are called {model}")
        first.setdefault(model, robot)


def topics_twice(fleet: Fleet) -> Iterator[Fault]:
    """Yield a gz topic that two models hear, or on which both send: nothing tells them apart.
    Transforms of all robots may be on one."""
    robots = {model: robot for robot, model in fleet.models.items()}
    first: dict[tuple[str, str], str] = {}
    for it in fleet.gz:
        other = first.setdefault((it.role, it.topic), it.model)
        if other != it.model and it.type != "gz.msgs.Pose_V":
            word = "drives" if it.role == "hears" else "sees"
            yield Fault(robots[it.model], word, f"{robots[other]} {it.role} {it.topic}, too")


# What all robots may send on one topic: each message says whose it is, or of which frames.
TOGETHER = (
    *("tf2_msgs/msg/TFMessage", "diagnostic_msgs/msg/DiagnosticArray", "rcl_interfaces/msg/Log"),
)


def sent_twice(fleet: Fleet) -> Iterator[Fault]:
    """Yield a topic of ROS on which nodes of two robots send: who reads it cannot tell them apart."""
    first: dict[tuple[str, str], str] = {}
    for it in fleet.ends:
        if it.role == "publishes" and it.robot and it.sure and it.type not in TOGETHER:
            other = first.setdefault((it.name, it.type), it.robot)
            if other != it.robot:
                yield Fault(it.robot, "sees", f"{it.node} sends on {it.name}, as {other} does")
