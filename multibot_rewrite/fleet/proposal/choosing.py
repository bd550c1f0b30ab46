"""What was found -> the keys of a fleet file, each with its reason."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import ceil
from typing import Any

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.fleet.proposal.companions import Companions
from multibot_rewrite.fleet.proposal.looking import NO_SIMULATOR, Looked, holds_the_world

PER_ROBOT, FRAMES = "tf-per-robot", "frames-per-robot"
# Metres between the outlines of two robots, and the step to which distances are rounded.
_GAP, _STEP = 0.5, 0.5


class Member(NamedTuple):
    """A description with its files; ``names`` are the robots of it, ``radius`` how far it reaches from
    its base in metres."""

    looked: Looked
    companions: Companions
    names: tuple[str, ...]
    radius: float


class Choice(NamedTuple):
    """The value of a key, and why."""

    value: Any
    why: str


def layout_of(members: Sequence[Member]) -> Choice:
    """The layout that the files of these robots are made for."""
    if any(it.looked.own_tf for it in members):
        return Choice(PER_ROBOT, "plugins of the description send tf on each robot's own topic")
    stacks = {name for it in members for name in it.companions.stacks}
    if any(it.looked.arguments for it in members) or "moveit" in stacks:
        return Choice(
            FRAMES, "arms and prefixed frames share one /tf, so one RViz shows all robots"
        )
    if stacks & {"nav2", "nav2_slam", "navigation", "localization", "slam_toolbox"}:
        return Choice(PER_ROBOT, "the launch files of Nav2 always give each robot its own /tf")
    return Choice(FRAMES, "one /tf for all robots, so one RViz shows them all")


def affix_of(layout: str) -> Choice | None:
    """``prefix`` where frames have the robot's name, as most robots of vendors do."""
    return (
        None
        if layout == PER_ROBOT
        else Choice("prefix", "frames are called robot1/base_link, as ROS users write it")
    )


def simulator_of(members: Sequence[Member]) -> Choice:
    """Whether the robots are simulated, by what their descriptions have."""
    kinds = {it.looked.simulator for it in members} - {NO_SIMULATOR}
    if not kinds:
        return Choice("none", "no description has anything for a simulator")
    names = {"gz": "gz-sim", "classic": "Gazebo Classic"}
    return Choice(
        "gazebo",
        f"plugins and sensors for {' and '.join(sorted(names[it] for it in kinds))};"
        " write none for real robots",
    )


def worlds_of(members: Sequence[Member]) -> dict[str, Choice]:
    """Where descriptions fix their robots to the world, each real robot gets a world of its own, which
    stands at its pose in the map. A simulator needs the one world."""
    simulated = any(it.looked.simulator != NO_SIMULATOR for it in members)
    if simulated or not any(holds_the_world(it.looked) for it in members):
        return {}
    why = "the description fixes the robot to a link `world`: each robot has its own, placed in map"
    return {"shared_frames": Choice(["map"], why)}


def poses_of(members: Sequence[Member], apart: float) -> Mapping[str, Mapping[str, float]]:
    """A place for each robot, in a row along y, so many metres ``apart``; with 0 as they are wide."""
    found: dict[str, dict[str, float]] = {}
    y = before = 0.0
    for member in members:
        for name in member.names:
            if found:
                y += apart or ceil((before + member.radius + _GAP) / _STEP) * _STEP
            before = member.radius
            found[name] = {"x": 0.0, "y": y}
    return found


def names_of(stems: Sequence[str], count: int) -> list[tuple[str, ...]]:
    """The names of ``count`` robots of each description: robot1, robot2, or by its own name."""
    if len(stems) == 1:
        return [tuple(f"robot{at}" for at in range(1, count + 1))]
    return [tuple(f"{stem}{at}" for at in range(1, count + 1)) for stem in unlike(stems)]


def unlike(words: Iterable[str]) -> list[str]:
    """The words as names of robots, made different where they are equal."""
    found: list[str] = []
    for word in words:
        plain = "".join(it if it.isalnum() else "_" for it in word.lower()).strip("_") or "robot"
        plain = plain if plain[0].isalpha() else f"robot_{plain}"
        plain = plain.rstrip("0123456789") or plain
        found.append(plain if plain not in found else f"{plain}_{len(found)}_")
    return found
