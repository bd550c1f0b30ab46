# SPDX-License-Identifier: Apache-2.0
"""Descriptions and folders -> a proposal for a fleet file."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from math import ceil
from typing import Any

from lxml import etree

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.checks.footprint import reach_of
from multibot_rewrite.description.rewriters.builtin import builtin_tree
from multibot_rewrite.description.sources.access import Reach
from multibot_rewrite.description.sources.included_by import robot_instead
from multibot_rewrite.description.sources.release_said import release_said
from multibot_rewrite.fleet.file.robot_spec import REAL
from multibot_rewrite.fleet.proposal.choosing import (
    Chosen,
    Undecided,
    acts,
    chosen,
    launches_of,
    may_be_partners,
    partner,
)
from multibot_rewrite.fleet.proposal.companions import Companions, companions_of, srdf_of
from multibot_rewrite.fleet.proposal.given_by_launch import (
    VALUES,
    Launched,
    given_by_launch,
    readings,
)
from multibot_rewrite.fleet.proposal.looking import (
    CLASSIC,
    NO_SIMULATOR,
    Looked,
    NeededValues,
    holds_the_world,
    in_its_world,
    is_placed,
    look,
    with_controllers,
    with_model,
    with_own_arguments,
    with_semantic_arguments,
)
from multibot_rewrite.fleet.proposal.release_of_files import release_of_files
from multibot_rewrite.fleet.proposal.searching import Found, search, text_of, without

MEANT = "as it was asked for"
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


class Proposal(NamedTuple):
    """A fleet: its keys with their reasons, in the order in which they are written; its robots with
    their poses. ``notes`` are said at the head of the file, ``others`` are descriptions not taken,
    ``refused`` files that do not go with the robots, and why; ``launched`` is what launch files give
    its nodes."""

    keys: Mapping[str, Choice]
    members: Sequence[Member]
    poses: Mapping[str, Mapping[str, float]]
    notes: tuple[str, ...] = ()
    others: tuple[str, ...] = ()
    refused: Mapping[str, str] = {}
    launched: Launched = Launched()


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
    """A place for each robot, in a row along y, so many metres ``apart``; with 0 as they are wide. None
    for a real one whose description has its place in the map."""
    found: dict[str, dict[str, float]] = {}
    y = before = 0.0
    for member in members:
        for name in () if is_placed(member.looked) else member.names:
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
        plain = plain.rstrip("0123456789")
        found.append(plain if plain not in found else f"{plain}_{len(found)}_")
    return found


# Descriptions of a folder that are looked at.
MOST = 60
# Files that may be of the same robot that are looked at.
MOST_PARTNERS = 5
# Metres, for a robot without a shape whose size is known.
UNKNOWN_RADIUS = 0.5
# Packages that start a simulator.
_SIMULATORS = ("ros_gz_sim", "ros_ign_gazebo", "gazebo_ros")
# The last release that has packages of its plugins (rosdistro).
OF_CLASSIC = "humble"


def _silent(_: str) -> None:
    """Nobody is told."""


class Wanted(NamedTuple):
    """What is asked for: files and folders, robots of each description or their names, values of xacro
    arguments, the release and whether somebody named it, a layout if not the one that the files are
    made for, metres from robot to robot if not as they are wide, whether xacros may do anything, a
    simulator or "none" if not what the files are for. ``tell`` is told what is looked at."""

    paths: tuple[str, ...]
    each: int
    arguments: Mapping[str, str]
    release: str
    named: bool
    layout: str = ""
    trust: bool = False
    names: tuple[str, ...] = ()
    apart: float = 0.0
    simulator: str = ""
    tell: Callable[[str], None] = _silent


class Seen(NamedTuple):
    """What there is: the files, and descriptions that may be meant, the likeliest first; ``named`` is
    true for those that were asked for, all of which count. ``rivals`` are as likely as the first,
    ``alike`` are other files of it."""

    found: Found
    robots: Sequence[Looked]
    named: bool
    rivals: Sequence[Looked] = ()
    alike: Sequence[Looked] = ()


def see(wanted: Wanted) -> Seen:
    """Look at all descriptions; the likeliest robot of a folder is the first.

    Raises UsageError where there is none, for one that was named and cannot be read, and for the one
    that launch files load where it cannot be read.
    """
    wanted.tell(f"looking for robots in {', '.join(wanted.paths)}")
    found = search(wanted.paths)
    reach = Reach(trust=wanted.trust)
    values = NeededValues(found.launch)
    every = found.descriptions
    if len(every) > MOST:
        every = tuple(sorted(every, key=lambda it: -launches_of(it, found)))[:MOST]
    look_at = partial(look, given=wanted.arguments, reach=reach, values=values)
    looked = []
    for at, it in enumerate(every, 1):
        wanted.tell(f"{at} of {len(every)} descriptions: {it}")
        looked.append(look_at(it))
    named = [it for it in looked if it.path in map(os.path.normpath, wanted.paths)]
    return _named(wanted, found, named, look_at) if named else _likeliest(wanted, found, looked)


def _named(
    wanted: Wanted, found: Found, named: list[Looked], look_at: Callable[[str], Looked]
) -> Seen:
    """The descriptions that were named; beside one alone stand those that share its folder."""
    _refuse([it for it in named if not it.links], "")
    if len(named) > 1:
        return Seen(found, named, True)
    beside = [look_at(it) for it in _partners(named[0], found)]
    return Seen(found, [_with_partner(named[0], beside, wanted)], True, (), named)


def _likeliest(wanted: Wanted, found: Found, looked: Sequence[Looked]) -> Seen:
    """The robots of a folder, the likeliest first."""
    usable = [it for it in looked if it.links and acts(it)]
    if not usable:
        others = f" (of {len(looked)} files none is a robot)" if looked[1:] else ""
        _refuse(_by_launches(looked, found), others)
        where = ", ".join(found.folders or map(os.path.normpath, wanted.paths))
        raise UsageError(f"{where}: no description of a robot is there; give a URDF, xacro or SDF")
    best = chosen(usable, found)
    _refuse(
        _rather(best, looked, found), "; the launch files load it, name another one if you mean it"
    )
    likeliest = best.order[0]
    # The name of a model tells what it carries: x500_lidar.
    if likeliest.part and not likeliest.moving and likeliest.robot.tag == "robot":
        said = {likeliest.robot.path: "it is called as a part, and nothing in it moves"}
        raise Undecided("no description of a whole robot is there", said, found)
    order, rivals, alike = ([it.robot for it in its] for its in best)
    known = {*_partners(order[0], found)}
    beside = [it for it in usable if it in alike or it.path in known]
    first = _with_partner(order[0], beside, wanted)
    left = [] if first == order[0] else [order[0]]
    rivals = [it for it in rivals if it.path not in (first.path, first.model)]
    return Seen(found, [first, *order[1:]], False, rivals, [*left, *alike])


def _partners(it: Looked, found: Found) -> list[str]:
    """Files that may be of the same robot: none of a URDF that has its simulator's part itself."""
    if it.tag == "robot" and it.simulator != NO_SIMULATOR:
        return []
    return [*may_be_partners(it.path, found)][:MOST_PARTNERS]


def _with_partner(it: Looked, others: Sequence[Looked], wanted: Wanted) -> Looked:
    """The URDF of a robot for robot_state_publisher, which takes no SDF, and its SDF for the simulator,
    where both are there."""
    other = partner(it, others) if wanted.simulator != REAL else None
    if other is None or (it.tag == "robot" and it.simulator != NO_SIMULATOR):
        return it
    return with_model(other, it) if it.tag == "sdf" else with_model(it, other)


def _rather(best: Chosen, looked: Sequence[Looked], found: Found) -> list[Looked]:
    """Descriptions that cannot be read, and that more launch files load than the likeliest; any where
    that one cannot move."""
    least = best.order[0].launched if best.order[0].moving else -1
    broken = _by_launches([it for it in looked if it.fault], found)
    return [it for it in broken if launches_of(it.path, found) > least]


def _by_launches(looked: Iterable[Looked], found: Found) -> list[Looked]:
    """Those that cannot be read, and that launch files load, first."""
    return sorted(looked, key=lambda it: (not it.fault, -launches_of(it.path, found)))


def _refuse(which: Sequence[Looked], more: str) -> None:
    for it in which[:1]:
        why = f"it has no link; {robot_instead(it.path)}"
        if it.links:
            why = "nothing in it moves or senses; give the file that has the robot"
        fault = it.fault or f"{it.path}: {why}"
        raise UsageError(f"{fault}{more}")


def with_arguments(robots: Sequence[Looked], wanted: Wanted, found: Found) -> list[Looked]:
    """The robots with the arguments of their xacros that give each its own names, and with the one that
    makes them simulated or real: as it was asked for, or as the files are."""
    tree = builtin_tree((), wanted.release)
    reach = Reach(trust=wanted.trust)
    own = [with_own_arguments(it, tree, reach) for it in robots]
    launched = any(it in text_of(path) for path in found.launch for it in _SIMULATORS)
    made = [
        in_its_world(it, _is_simulated(it, wanted) or (launched and not wanted.simulator), reach)
        for it in own
    ]
    values = NeededValues(found.launch)
    return [
        with_semantic_arguments(it, srdf_of(it, found), reach, values) if found.srdf else it
        for it in made
    ]


def _is_simulated(it: Looked, wanted: Wanted) -> bool:
    has = it.simulator != NO_SIMULATOR
    return wanted.simulator != REAL if wanted.simulator else has


def release_of(robots: Sequence[Looked], found: Found, wanted: Wanted) -> Choice:
    """The release that was asked for, else the one that has the robots' simulator and what they load,
    that their repository names, or that has what the parameter files set."""
    if wanted.named:
        return Choice(wanted.release, "the ROS 2 release that was asked for")
    if any(it.simulator == CLASSIC for it in robots):
        return Choice(OF_CLASSIC, "the last ROS release that has Gazebo Classic")
    said = {release_said("", _text_of(it), it.path) for it in robots if it.path}
    telling = [it for it in said if it.why] or [release_of_files(found.params)]
    if len(telling) == 1 and telling[0].why:
        return Choice(*telling[0])
    return Choice(wanted.release, "the newest long-term ROS release; name yours")


def _text_of(it: Looked) -> bytes:
    return b"" if it.root is None else etree.tostring(it.root)


def propose(
    robots: Sequence[Looked], found: Found, wanted: Wanted, refused: Mapping[str, str]
) -> Proposal:
    """A fleet of these descriptions; ``refused`` are files that do not go with them, and why."""
    stems = [it.name or os.path.basename(it.path).partition(".")[0] for it in robots]
    names = names_of(stems, wanted.each)
    if wanted.names and len(robots) == 1:
        names = [wanted.names]
    release = release_of(robots, found, wanted)
    kept = without(found, refused)
    members = [
        _member(it, companions_of(it, kept, release.value), own, Reach(trust=wanted.trust))
        for it, own in zip(robots, names, strict=True)
    ]
    layout = layout_of(members)
    if wanted.layout:
        layout = Choice(wanted.layout, MEANT)
    affix = affix_of(layout.value)
    keys: dict[str, Choice] = {
        "layout": layout,
        **({"affix": affix} if affix else {}),
        "distro": release,
        "simulator": Choice(wanted.simulator, MEANT) if wanted.simulator else simulator_of(members),
        **worlds_of(members),
    }
    poses = poses_of(members, wanted.apart)
    stacks = dict.fromkeys(stack for it in members for stack in it.companions.stacks)
    # Launch files of several robots give each its own values.
    read = readings(found.launch, robots[0].path, found.every) if len(robots) == 1 else ()
    launched = given_by_launch(read, stacks, release.value, VALUES not in refused)
    return Proposal(keys, members, poses, (), _others(found, robots), refused, launched)


def _member(it: Looked, beside: Companions, names: tuple[str, ...], reach: Reach) -> Member:
    own = with_controllers(it, beside.files.get("params", ()), reach)
    return Member(own, beside, names, _radius(own))


def _others(found: Found, robots: Sequence[Looked]) -> tuple[str, ...]:
    taken = {path for it in robots for path in (it.path, it.model)}
    return tuple(it for it in found.descriptions if it not in taken)


def _radius(it: Looked) -> float:
    assert it.root is not None
    return reach_of(it.root) or UNKNOWN_RADIUS
