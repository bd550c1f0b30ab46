# SPDX-License-Identifier: Apache-2.0
"""Makes a proposal for a fleet file of descriptions and folders."""

import os
from collections.abc import Iterable, Mapping, Sequence
from math import ceil
from typing import Any, NamedTuple

from lxml import etree

from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.base.releases import NEWEST_LTS, RELEASES
from multibot_rewrite.base.rosnames import numbered_names
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.description.checks.shapes import reach_of
from multibot_rewrite.description.sources.access import Reach
from multibot_rewrite.description.sources.own_names import ROBOT
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.description.sources.release_said import SaidRelease, release_said
from multibot_rewrite.fleet.file.robot_spec import REAL
from multibot_rewrite.proposal.launches import (
    Bringup,
    Reading,
    Row,
    not_read,
    started,
    starts_simulator,
)
from multibot_rewrite.proposal.looking import (
    CLASSIC,
    NO_SIMULATOR,
    Looked,
    holds_the_world,
    is_placed,
    with_controllers,
)
from multibot_rewrite.proposal.owners import of_other_robots
from multibot_rewrite.proposal.related_files import (
    RelatedFiles,
    related_files_launched,
    related_files_of,
)
from multibot_rewrite.proposal.searching import Found, without
from multibot_rewrite.proposal.seeing import Wanted
from multibot_rewrite.related_files.context import make_context
from multibot_rewrite.related_files.formats import read_named
from multibot_rewrite.related_files.named_file import PARAMS
from multibot_rewrite.rules.files.plugin_names import classes_of_other_releases
from multibot_rewrite.rules.files.releases import elsewhere

MEANT = "as it was asked for"
PER_ROBOT, FRAMES = "tf-per-robot", "frames-per-robot"
_OF_NAV2 = frozenset(("nav2", "nav2_slam", "navigation", "localization", "slam_toolbox"))
# Metres between the outlines of two robots, and the step to which distances are rounded.
_GAP, _STEP = 0.5, 0.5
# Metres, for a robot without a shape whose size is known.
UNKNOWN_RADIUS = 0.5
# The last release that has packages of its plugins (rosdistro).
OF_CLASSIC = "humble"


class Member(NamedTuple):
    """A description with its files; ``names`` are its robots, ``radius`` is their reach in metres.

    ``is_real`` is true for robots that are real among simulated ones."""

    looked: Looked
    related_files: RelatedFiles
    names: tuple[str, ...]
    radius: float
    is_real: bool = False

    @property
    def bringup(self) -> Bringup | None:
        """The launch file that starts its robots; raises nothing."""
        return self.looked.bringup


class Choice(NamedTuple):
    """The value of a key, and why."""

    value: Any
    why: str


class Proposal(NamedTuple):
    """A fleet: its keys with reasons, in their order, its robots and their poses.

    ``notes`` are for the head of the file, ``others`` are unused descriptions, ``refused`` files
    that do not go with the robots and ``broken`` unreadable descriptions, each with the reason.
    ``started`` is what launch files start if none is the robot's, ``unread`` what could not be
    read of the robots' launch files, ``others_unread`` of other ones. ``chosen`` is what differs
    from the files so that the fleet builds."""

    keys: Mapping[str, Choice]
    members: Sequence[Member]
    poses: Mapping[str, Mapping[str, float]]
    notes: tuple[str, ...] = ()
    others: tuple[str, ...] = ()
    refused: Mapping[str, str] = {}
    started: tuple[Row, ...] = ()
    unread: tuple[Row, ...] = ()
    others_unread: tuple[Row, ...] = ()
    broken: Mapping[str, str] = {}
    chosen: str = ""


def layout_of(members: Sequence[Member]) -> Choice:
    """Return the layout that the files of these robots are made for."""
    if any(it.looked.own_tf for it in members):
        return Choice(PER_ROBOT, "plugins of the description send tf on each robot's own topic")
    node_sets = {name for it in members for name in it.related_files.node_sets}
    launched = {one for it in members if it.bringup for one in it.bringup.graph.packages}
    named = any(ROBOT in value for it in members for _, value in it.looked.arguments)
    if named or "moveit" in node_sets or "moveit_ros_move_group" in launched:
        return Choice(
            FRAMES, "arms and prefixed frames share one /tf, so one RViz shows all robots"
        )
    if node_sets & _OF_NAV2 or any(it.startswith("nav2_") for it in launched):
        return Choice(PER_ROBOT, "the launch files of Nav2 always give each robot its own /tf")
    return Choice(FRAMES, "one /tf for all robots, so one RViz shows them all")


def affix_of(layout: str) -> Choice | None:
    """Return ``prefix`` if frames have the robot's name, as with most robots of vendors."""
    if layout == PER_ROBOT:
        return None
    return Choice("prefix", "frames are called robot1/base_link, the usual form in ROS")


def simulator_of(members: Sequence[Member]) -> Choice:
    """Return whether robots are simulated, by their launch files, else by their descriptions."""
    launched = {it.bringup.is_simulated: it.bringup for it in members if it.bringup}
    if len(launched) == 1 and all(it.bringup for it in members):
        ((is_simulated, bringup),) = launched.items()
        what = "starts a simulator" if starts_simulator(bringup.graph) else "is for a simulator"
        if is_simulated:
            why = f"the launch file {bringup.name} {what}; write none for real robots"
            return Choice("gazebo", why)
        return Choice(REAL, f"the launch file {bringup.name} starts no simulator")
    kinds = {it.looked.simulator for it in members} - {NO_SIMULATOR}
    if not kinds:
        have = "the description has" if len(members) == 1 else "the descriptions have"
        return Choice("none", f"{have} nothing for a simulator")
    names = {"gz": "gz-sim", "classic": "Gazebo Classic"}
    return Choice(
        "gazebo",
        f"plugins and sensors for {' and '.join(sorted(names[it] for it in kinds))};"
        " write none for real robots",
    )


def worlds_of(members: Sequence[Member], is_real: bool) -> dict[str, Choice]:
    """Return ``shared_frames``, chosen for real robots whose descriptions are fixed to the world."""
    # Each has its own world, at its pose in the map; a simulator needs one world.
    if not is_real or not any(holds_the_world(it.looked) for it in members):
        return {}
    why = "the description fixes the robot to a link `world`: each robot has its own, placed in map"
    return {"shared_frames": Choice(["map"], why)}


def poses_of(members: Sequence[Member], apart: float) -> Mapping[str, Mapping[str, float]]:
    """Return x, y and so on of each robot's pose, in a row ``apart`` metres; 0: by their widths."""
    # None for a real robot whose description has its place in the map.
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
    """Return the names of ``count`` robots of each description: robot1, robot2, or by its own name."""
    if len(stems) == 1:
        return [numbered_names(count)]
    return [numbered_names(count, stem) for stem in unlike(stems)]


def unlike(words: Iterable[str]) -> list[str]:
    """Return names for robots that are made of these and differ from each other."""
    found: list[str] = []
    for word in words:
        letters = (it if it.isascii() and it.isalnum() else " " for it in word.lower())
        plain = "_".join("".join(letters).split()) or "robot"
        plain = plain if plain[0].isalpha() else f"robot_{plain}"
        plain = plain.rstrip("0123456789")
        found.append(plain if plain not in found else f"{plain.rstrip('_')}_{len(found)}_")
    return found


def release_of(robots: Sequence[Looked], found: Found, wanted: Wanted) -> Choice:
    """Return the release: asked for, or by the simulator, plugins, repository or parameters."""
    if wanted.named:
        return Choice(wanted.release, "the ROS 2 release that was asked for")
    if any(it.simulator == CLASSIC for it in robots):
        return Choice(OF_CLASSIC, "the last ROS release that has Gazebo Classic")
    texts = {it.path: b"" if it.root is None else etree.tostring(it.root) for it in robots}
    said = {release_said("", text, path) for path, text in texts.items() if path}
    telling = [it for it in said if it.why] or [release_of_files(found.params)]
    if len(telling) == 1 and telling[0].why:
        return Choice(*telling[0])
    return Choice(wanted.release, "the newest long-term ROS release; name yours")


def propose(
    robots: Sequence[Looked], found: Found, wanted: Wanted, refused: Mapping[str, str]
) -> Proposal:
    """Return a fleet of these descriptions; ``refused`` are files that do not go with them, and why."""
    stems = [it.name or os.path.basename(it.path).partition(".")[0] for it in robots]
    names = names_of(stems, wanted.each)
    if wanted.names and len(robots) == 1:
        names = [wanted.names]
    release = release_of(robots, found, wanted)
    kept = without(found, refused)
    shared_out = [without(kept, its) for its in of_other_robots(robots, kept, release.value)]
    members = [
        _member_of(
            it, _related_files(it, own, release.value, wanted), called, Reach(trust=wanted.trust)
        )
        for it, own, called in zip(robots, shared_out, names, strict=True)
    ]
    layout = layout_of(members)
    if wanted.layout:
        layout = Choice(wanted.layout, MEANT)
    affix = affix_of(layout.value)
    simulator = Choice(wanted.simulator, MEANT) if wanted.simulator else simulator_of(members)
    keys: dict[str, Choice] = {
        "layout": layout,
        **({"affix": affix} if affix else {}),
        "distro": release,
        "simulator": simulator,
        **worlds_of(members, simulator.value == REAL),
    }
    poses = poses_of(members, wanted.apart)
    taken = {path for it in robots for path in it.files}
    every = found.read
    bringups = [it.bringup for it in robots if it.bringup]
    other = (one for it in every for one in it.graph.nodes if not bringups)
    unread = dict.fromkeys(not_read(Reading(it.order, it.graph) for it in bringups))
    others = dict.fromkeys(not_read(every))
    return Proposal(
        keys,
        members,
        poses,
        (),
        tuple(it for it in found.descriptions if it not in taken),
        refused,
        tuple(started(other)),
        tuple(unread),
        tuple(it for it in others if it not in unread),
    )


def _related_files(it: Looked, found: Found, release: str, wanted: Wanted) -> RelatedFiles:
    """Return the files that go with a robot: those of its launch file, otherwise of its folders."""
    asked = dict.fromkeys(wanted.node_sets, MEANT)
    if it.bringup:
        return related_files_launched(it, it.bringup, found, release, asked)
    made = related_files_of(it, found, release)
    return made._replace(node_sets={**made.node_sets, **asked})


def _member_of(it: Looked, beside: RelatedFiles, names: tuple[str, ...], reach: Reach) -> Member:
    own = with_controllers(it, beside.files.get("params", ()), reach)
    assert own.root is not None
    return Member(own, beside, names, reach_of(own.root) or UNKNOWN_RADIUS)


# The release that parameter files were written for, by the parameters and the classes of plugins that
# only some releases have.
# Sources: what the packages declare in each release (``knowledge/declared.schema``), and the classes
# that they register (``knowledge/plugin_classes.schema``).
# The newest that people run first; nobody writes files for the one that changes each day.
_ORDER = (NEWEST_LTS, *(it for it in RELEASES[-2::-1] if it != NEWEST_LTS))
# One parameter may be left over of an older file.
_ENOUGH = 2


def release_of_files(paths: Sequence[str]) -> SaidRelease:
    """Return the release that knows most of what parameter files set; no reason if many do."""
    lacking = {release: _files_lacking(paths, release) for release in _ORDER}
    most = len(lacking[NEWEST_LTS])
    best = min(_ORDER, key=lambda it: len(lacking[it]))
    if most - len(lacking[best]) < _ENOUGH:
        return SaidRelease(NEWEST_LTS)
    files = dict.fromkeys(map(os.path.basename, lacking[NEWEST_LTS]))
    return SaidRelease(
        best, f"{NEWEST_LTS} lacks {most} parameters or plugins of {shorten([*files])}"
    )


def _files_lacking(paths: Sequence[str], release: str) -> list[str]:
    """Return the file of each parameter, and of each plugin class, that a release does not have."""
    context = make_context({}, make_naming("tf-per-robot"), (), release)
    found = []
    for path in paths:
        try:
            file = read_named(PARAMS, read_file(path), path, context)
        except InputError:  # it is told where it is taken
            continue
        found += [path for _ in (*elsewhere(file), *classes_of_other_releases(file))]
    return found
