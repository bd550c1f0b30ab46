"""Descriptions and folders -> a proposal for a fleet file."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.checks.footprint import reach_of
from multibot_rewrite.model import UsageError
from multibot_rewrite.proposal.choosing import (
    Choice,
    Member,
    affix_of,
    layout_of,
    names_of,
    poses_of,
    simulator_of,
    worlds_of,
)
from multibot_rewrite.proposal.companions import companions_of
from multibot_rewrite.proposal.fleet_text import Proposal
from multibot_rewrite.proposal.looking import Looked, look, ranked, with_own_arguments
from multibot_rewrite.proposal.searching import Found, search
from multibot_rewrite.rewriters.builtin import builtin_tree
from multibot_rewrite.sources.access import Reach

# Descriptions of a folder that are looked at.
MOST = 60
# Metres, for a robot without a shape whose size is known.
UNKNOWN_RADIUS = 0.5
Ask = Callable[[Sequence[Looked]], Sequence[Looked]]


class Wanted(NamedTuple):
    """What is asked for: files and folders, robots of each description, values of xacro arguments, the
    release, a layout if not the one that the files are made for, whether xacros may do anything."""

    paths: tuple[str, ...]
    each: int
    arguments: Mapping[str, str]
    release: str
    layout: str = ""
    trust: bool = False


def propose(wanted: Wanted, choose: Ask) -> Proposal:
    """A fleet of the descriptions; ``choose`` picks from those that were found in folders.

    Raises UsageError where there is none, InputError for one that was named and cannot be read.
    """
    found = search(wanted.paths)
    robots = _chosen(found, wanted, choose)
    stems = [it.name or os.path.basename(it.path).partition(".")[0] for it in robots]
    members = [
        Member(it, companions_of(it, found, wanted.release), names, _radius(it))
        for it, names in zip(robots, names_of(stems, wanted.each), strict=True)
    ]
    layout = layout_of(members)
    if wanted.layout:
        layout = Choice(wanted.layout, "as it was asked for")
    affix = affix_of(layout.value)
    keys: dict[str, Choice] = {
        "layout": layout,
        **({"affix": affix} if affix else {}),
        "distro": Choice(wanted.release, "the ROS release whose facts count"),
        "simulator": simulator_of(members),
        **worlds_of(members),
    }
    return Proposal(keys, members, poses_of(members), others=_others(found, robots))


def _others(found: Found, robots: Sequence[Looked]) -> tuple[str, ...]:
    taken = {it.path for it in robots}
    return tuple(it for it in found.descriptions if it not in taken)


def _chosen(found: Found, wanted: Wanted, choose: Ask) -> Sequence[Looked]:
    reach = Reach(trust=wanted.trust)
    looked = [look(it, wanted.arguments, reach) for it in found.descriptions[:MOST]]
    usable = [it for it in looked if it.links]
    named = [it for it in looked if it.path in map(os.path.normpath, wanted.paths)]
    if bad := next((it for it in (named or looked if not usable else named) if not it.links), None):
        raise UsageError(
            bad.fault or f"{bad.path}: it has no link; give the file that has the robot"
        )
    if not usable:
        where = ", ".join(found.folders)
        raise UsageError(f"{where}: no description of a robot is there; give a URDF, xacro or SDF")
    tree = builtin_tree((), wanted.release)
    chosen = named or choose(ranked(usable))
    return [with_own_arguments(it, tree, reach) for it in chosen]


def _radius(it: Looked) -> float:
    assert it.root is not None
    return reach_of(it.root) or UNKNOWN_RADIUS
