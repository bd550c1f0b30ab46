# SPDX-License-Identifier: Apache-2.0
"""Finds the descriptions that may be meant, the likeliest first."""

import os
import shlex
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import partial
from typing import NamedTuple

from multibot_rewrite.base.left_out import marked_folders
from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.description.sources.access import Reach
from multibot_rewrite.description.sources.included_by import robot_instead
from multibot_rewrite.description.sources.packages import package_of
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.description.steps.apply import Spans
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.fleet.file.robot_spec import REAL
from multibot_rewrite.planning.transforms import STATE_PUBLISHER
from multibot_rewrite.producers.launch.launched import world_files
from multibot_rewrite.producers.launch.records import LaunchOrder
from multibot_rewrite.producers.launch.source_packages import ROOTS
from multibot_rewrite.proposal.bringup import Robot, bringup_as_named, bringup_of
from multibot_rewrite.proposal.choosing import (
    Candidate,
    acts,
    chosen,
    is_called_like_a_part,
    launched_descriptions,
    may_be_partners,
    partner,
    processes_with,
)
from multibot_rewrite.proposal.launches import Bringup, first_words
from multibot_rewrite.proposal.looking import (
    NO_SIMULATOR,
    Looked,
    NeededValues,
    in_its_world,
    look,
    with_bringup,
    with_model,
    with_own_arguments,
    with_semantic_arguments,
)
from multibot_rewrite.proposal.related_files import srdf_of
from multibot_rewrite.proposal.searching import Found, Undecided, search

# Descriptions of a folder that are looked at.
MOST = 60
# Files that may be of the same robot that are looked at.
MOST_PARTNERS = 5


class Wanted(NamedTuple):
    """What is asked for: paths, robots of each description, xacro arguments, release and more.

    ``named``: the release was asked for. ``layout``, metres ``apart`` and ``simulator`` are
    empty if they follow from the files. ``file`` is the fleet file to be written, ``tell`` shows
    what is being checked."""

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
    launch: tuple[LaunchOrder, ...] | None = None
    node_sets: tuple[str, ...] = ()
    file: str = "fleet.yaml"
    tell: Callable[[str], None] = lambda _: None


class Seen(NamedTuple):
    """The files and the descriptions that may be meant, the likeliest first.

    ``named``: they were asked for, and all of them count. ``rivals`` are as likely as the first,
    ``alike`` are other files of it, ``broken`` are unreadable, with the reason."""

    found: Found
    robots: Sequence[Looked]
    named: bool
    rivals: Sequence[Looked] = ()
    alike: Sequence[Looked] = ()
    broken: Mapping[str, str] = {}


def see(wanted: Wanted) -> Seen:
    """Look at all descriptions; the likeliest robot of a folder is the first.

    Raises UsageError where there is none, for one that was named and cannot be read, and for the one
    that launch files load where it cannot be read.
    """
    wanted.tell(f"looking for robots in {', '.join(wanted.paths)}")
    found = search(wanted.paths, wanted.launch or ())
    try:
        return _looked_at(wanted, found)
    except UsageError as error:
        if not found.named or isinstance(error, Undecided):
            raise
        # Nothing of the launch file is dropped in silence.
        graphs = [it.graph for it in found.read]
        texts = [
            " ".join((it.name or os.path.basename(it.executable), *first_words(it)))
            for one in graphs
            for it in one.nodes
        ]
        unread = [it for one in graphs for it in one.notes if not it.parameters]
        own = {it.package for one in graphs for it in one.nodes}
        told = (it for it in unread if it.missing not in own)
        texts += [it.message.replace(f"; {ROOTS}", "") for it in told]
        listed = ", ".join(dict.fromkeys(texts))
        file = os.path.basename(found.named[0].file)
        raise UsageError(f"{error}; without it a fleet has none of {file}: {listed}") from None


def _looked_at(wanted: Wanted, found: Found) -> Seen:
    """Return the descriptions as read: those named, or all of a folder, and which are robots."""
    reach = Reach(trust=wanted.trust)
    values = NeededValues(found.read, found.launch)
    look_at = partial(look, given=wanted.arguments, reach=reach, values=values)

    def look_at_all(paths: Sequence[str]) -> list[Looked]:
        looked = []
        for at, it in enumerate(paths[:MOST], 1):
            wanted.tell(f"{at} of {len(paths)} descriptions: {it}")
            looked.append(look_at(it))
        return looked

    if {*found.descriptions} & {*map(os.path.normpath, wanted.paths)}:
        # The descriptions that were named; beside one alone stand those that share its folder.
        named = look_at_all(found.descriptions)
        _refuse_robots([it for it in named if not it.links], "")
        if len(named) > 1:
            return Seen(found, named, True)
        beside = [look_at(it) for it in _partners(named[0], found)]
        return Seen(found, [_with_partner(named[0], beside, wanted)], True, (), named)
    launched = look_at_all(launched_descriptions(found))
    if found.named and not launched:
        _refuse_to_guess(found)
    if not any(it.fault or _is_like_a_robot(it) for it in launched):
        return _likeliest(wanted, found, look_at_all(found.descriptions))
    # Those that no launch file loads are not looked at then.
    known = {it.path for it in launched}
    return _likeliest(wanted, found, launched, [it for it in found.every if it not in known])


def _refuse_to_guess(found: Found) -> None:
    """Raise UsageError if it is not known which of several descriptions a launch file publishes."""
    several, graphs = len(found.descriptions), [it.graph for it in found.read]
    unread = [it for graph in graphs for it in graph.notes if not it.parameters and it.missing]
    if several > 1 and unread and not any(STATE_PUBLISHER in it.packages for it in graphs):
        where = f"{unread[0].place.file}:{unread[0].place.line}"
        what = f"which of {several} descriptions it loads is not known: {unread[0].message}"
        other = f"or name it: multibot init DESCRIPTION {shlex.join(found.words)}"
        raise UsageError(f"{where}: {what}; {other}")


def _is_like_a_robot(it: Looked) -> bool:
    return it.links > 0 and acts(it)


def _likeliest(
    wanted: Wanted, found: Found, looked: Sequence[Looked], rest: Sequence[str] = ()
) -> Seen:
    """Return the robots of a folder, the likeliest first; no launch file loads the ``rest``."""
    usable = [*filter(_is_like_a_robot, looked)]
    if not usable:
        others = f" (of {len(looked)} files none is a robot)" if looked[1:] else ""
        _refuse_robots(_by_launches(looked, found), _other_one(rest[0], found) if rest else others)
        where = ", ".join(found.folders or map(os.path.normpath, wanted.paths))
        hint = "give a URDF, xacro or SDF"
        if ignored := [it for folder in found.folders for it in marked_folders(folder)]:
            hint = f"marked to be ignored: {shorten(ignored)}; name that folder"
        hint = next(_robots_of_worlds(found), hint)
        raise UsageError(f"{where}: no description of a robot is there; {hint}")
    best = chosen(usable, found)
    likeliest = best.order[0]
    _refuse_robots(_as_likely(likeliest, looked, found), _other_one(likeliest.robot.path, found))
    # The name of a model tells what it carries: x500_lidar.
    if likeliest.part and not likeliest.moving and likeliest.robot.tag == "robot":
        said = {likeliest.robot.path: "it is called as a part, and nothing in it moves"}
        raise Undecided("no description of a whole robot is there", said, found)
    order, rivals, alike = ([it.robot for it in its] for its in best)
    partners = {*_partners(order[0], found)}
    beside = [it for it in usable if it in alike or it.path in partners]
    first = _with_partner(order[0], beside, wanted)
    left = [] if first == order[0] else [order[0]]
    rivals = [it for it in rivals if it.path not in (first.path, first.model)]
    own = package_of(first.path)
    unread = (
        it for it in looked if it.fault and (best.order[0].started or package_of(it.path) == own)
    )
    broken = {it.path: it.fault.removeprefix(f"{it.path}: ") for it in unread}
    return Seen(found, [first, *order[1:]], False, rivals, [*left, *alike], broken)


def _robots_of_worlds(found: Found) -> Iterator[str]:
    """Yield how to take the likeliest robot out of each world that a launch file names."""
    read = sorted(found.read, key=lambda it: -len(it.graph.nodes))
    worlds = ((path, it) for it in read for node in it.graph.nodes for path in world_files(node))
    for path, reading in worlds:
        with suppress(InputError, OSError):
            world = read_document(read_file(path), path)
            moving = world.root.iterfind("world/model[plugin]/joint/..")
            for it in sorted(moving, key=lambda it: -len([*it.iter("plugin", "sensor")]))[:1]:
                name, of = it.get("name", ""), f"<sdf version='{world.root.get('version')}'>"
                start, end = (world.source.count(b"\n", 0, at) + 1 for at in Spans(world).of(it))
                lines = shlex.join(["sed", "-n", f"{start},{end}p", path])
                words = ["multibot", "init", f"{os.path.dirname(path)}/{name}.sdf", "--launch"]
                command = f"(echo \"{of}\"; {lines}; echo '</sdf>') > {shlex.quote(words[2])}"
                again = shlex.join([*words, os.path.relpath(reading.order.file)])
                told = f"model {name!r} of {os.path.basename(path)} moves"
                yield f"{told}: give it a file of its own, {command}; {again}"


def _partners(it: Looked, found: Found) -> list[str]:
    """Return files that may be of the same robot; none for a URDF with its simulator's part in it."""
    if it.tag == "robot" and it.simulator != NO_SIMULATOR:
        return []
    return [*may_be_partners(it.path, found)][:MOST_PARTNERS]


def _with_partner(it: Looked, others: Sequence[Looked], wanted: Wanted) -> Looked:
    """Return the URDF of a robot with its SDF for the simulator, if both exist."""
    other = partner(it, others) if wanted.simulator != REAL else None
    if other is None or (it.tag == "robot" and it.simulator != NO_SIMULATOR):
        return it
    return with_model(other, it) if it.tag == "sdf" else with_model(it, other)


def _as_likely(likeliest: Candidate, looked: Sequence[Looked], found: Found) -> list[Looked]:
    """Return unreadable descriptions that are as likely; all if the likeliest cannot move."""
    broken = _by_launches([it for it in looked if it.fault], found)
    if not likeliest.moving:
        return broken
    whole = (it for it in broken if not is_called_like_a_part(it.path))
    return [it for it in whole if processes_with(it.path, found) >= max(1, likeliest.started)]


def _by_launches(looked: Iterable[Looked], found: Found) -> list[Looked]:
    """Return descriptions sorted: unreadable ones first, then those whose launch file starts most."""
    return sorted(looked, key=lambda it: (not it.fault, -processes_with(it.path, found)))


def _other_one(path: str, found: Found) -> str:
    """Return the end of a message about a description: how to choose another one."""
    why = "the launch files load it; " if launched_descriptions(found) else ""
    return f"; {why}for another one: multibot init {shlex.join([path, *found.words])}"


def _refuse_robots(which: Sequence[Looked], more: str) -> None:
    for it in which[:1]:
        why = f"it has no link; {robot_instead(it.path)}"
        if it.links:
            why = "nothing in it moves or senses; give the file that has the robot"
        fault = it.fault or f"{it.path}: {why}"
        raise UsageError(f"{fault}{more}")


def with_arguments(robots: Sequence[Looked], wanted: Wanted, found: Found) -> list[Looked]:
    """Return the robots with their launch files and xacro arguments, simulated or real."""
    tree = builtin_tree((), wanted.release)
    reach = Reach(trust=wanted.trust)
    launched = (
        with_bringup(it, _bringup(it, wanted, found), wanted.arguments, reach) for it in robots
    )
    own = [with_own_arguments(it, tree, reach) for it in launched]
    made = [in_its_world(it, _is_simulated(it, wanted), reach) for it in own]
    if not found.srdf:
        return made
    values = NeededValues(found.read)
    return [with_semantic_arguments(it, srdf_of(it, found), reach, values) for it in made]


def _bringup(it: Looked, wanted: Wanted, found: Found) -> Bringup | None:
    """Return the launch file that starts a robot; None without."""
    if wanted.launch is not None:
        return next(map(bringup_as_named, wanted.launch), None)
    files = {*map(os.path.realpath, it.files)}
    others = {*map(os.path.realpath, found.every)} - files
    has = it.simulator != NO_SIMULATOR
    robot = Robot(frozenset(files), frozenset(others), wanted.simulator, has, it.control)
    return bringup_of(robot, found.launch, wanted.trust)


def _is_simulated(it: Looked, wanted: Wanted) -> bool:
    has = it.bringup.is_simulated if it.bringup else it.simulator != NO_SIMULATOR
    return wanted.simulator != REAL if wanted.simulator else has
