"""Descriptions and folders -> a proposal for a fleet file."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.checks.footprint import reach_of
from multibot_rewrite.description.rewriters.builtin import builtin_tree
from multibot_rewrite.description.sources.access import Reach
from multibot_rewrite.fleet.proposal.choosing import (
    Choice,
    Member,
    affix_of,
    layout_of,
    names_of,
    poses_of,
    simulator_of,
    worlds_of,
)
from multibot_rewrite.fleet.proposal.companions import companions_of
from multibot_rewrite.fleet.proposal.fleet_text import Proposal
from multibot_rewrite.fleet.proposal.looking import (
    CLASSIC,
    Looked,
    look,
    ranked,
    with_own_arguments,
)
from multibot_rewrite.fleet.proposal.needed_values import NeededValues
from multibot_rewrite.fleet.proposal.searching import Found, search, without

# Descriptions of a folder that are looked at.
MOST = 60
# Metres, for a robot without a shape whose size is known.
UNKNOWN_RADIUS = 0.5
# The last release that has packages of its plugins (rosdistro).
OF_CLASSIC = "humble"


class Wanted(NamedTuple):
    """What is asked for: files and folders, robots of each description or their names, values of xacro
    arguments, the release and whether somebody named it, a layout if not the one that the files are
    made for, metres from robot to robot if not as they are wide, whether xacros may do anything."""

    paths: tuple[str, ...]
    each: int
    arguments: Mapping[str, str]
    release: str
    named: bool
    layout: str = ""
    trust: bool = False
    names: tuple[str, ...] = ()
    apart: float = 0.0


class Seen(NamedTuple):
    """What there is: the files, and descriptions that may be meant; ``named`` is true for those that
    were asked for, all of which count."""

    found: Found
    robots: Sequence[Looked]
    named: bool


def see(wanted: Wanted) -> Seen:
    """Look at all descriptions; the likeliest robot of a folder is the first.

    Raises UsageError where there is none, and for one that was named and cannot be read.
    """
    found = search(wanted.paths)
    reach = Reach(trust=wanted.trust)
    values = NeededValues(found.launch)
    every = found.descriptions[:MOST]
    looked = [look(it, wanted.arguments, reach, values) for it in every]
    usable = [it for it in looked if it.links]
    named = [it for it in looked if it.path in map(os.path.normpath, wanted.paths)]
    if bad := next((it for it in (named or looked if not usable else named) if not it.links), None):
        fault = bad.fault or f"{bad.path}: it has no link; give the file that has the robot"
        others = "" if named or not looked[1:] else f" (of {len(looked)} files none is a robot)"
        raise UsageError(f"{fault}{others}")
    if not usable:
        where = ", ".join(found.folders)
        raise UsageError(f"{where}: no description of a robot is there; give a URDF, xacro or SDF")
    return Seen(found, named or ranked(usable), bool(named))


def with_arguments(robots: Sequence[Looked], wanted: Wanted) -> list[Looked]:
    """The robots with the arguments of their xacros that give each its own names."""
    tree = builtin_tree((), wanted.release)
    return [with_own_arguments(it, tree, Reach(trust=wanted.trust)) for it in robots]


def release_of(robots: Sequence[Looked], wanted: Wanted) -> Choice:
    """The release that was asked for, else the one that has the robots' simulator."""
    if wanted.named:
        return Choice(wanted.release, "the ROS release whose facts count")
    if any(it.simulator == CLASSIC for it in robots):
        return Choice(OF_CLASSIC, "the last ROS release that has Gazebo Classic")
    return Choice(wanted.release, "the newest long-term ROS release; name yours")


def propose(
    robots: Sequence[Looked], found: Found, wanted: Wanted, refused: Mapping[str, str]
) -> Proposal:
    """A fleet of these descriptions; ``refused`` are files that do not go with them, and why."""
    stems = [it.name or os.path.basename(it.path).partition(".")[0] for it in robots]
    names = names_of(stems, wanted.each)
    if wanted.names and len(robots) == 1:
        names = [wanted.names]
    release = release_of(robots, wanted)
    kept = without(found, refused)
    members = [
        Member(it, companions_of(it, kept, release.value), own, _radius(it))
        for it, own in zip(robots, names, strict=True)
    ]
    layout = layout_of(members)
    if wanted.layout:
        layout = Choice(wanted.layout, "as it was asked for")
    affix = affix_of(layout.value)
    keys: dict[str, Choice] = {
        "layout": layout,
        **({"affix": affix} if affix else {}),
        "distro": release,
        "simulator": simulator_of(members),
        **worlds_of(members),
    }
    poses = poses_of(members, wanted.apart)
    return Proposal(keys, members, poses, (), _others(found, robots), refused)


def _others(found: Found, robots: Sequence[Looked]) -> tuple[str, ...]:
    taken = {it.path for it in robots}
    return tuple(it for it in found.descriptions if it not in taken)


def _radius(it: Looked) -> float:
    assert it.root is not None
    return reach_of(it.root) or UNKNOWN_RADIUS
