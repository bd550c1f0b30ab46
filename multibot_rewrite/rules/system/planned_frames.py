# SPDX-License-Identifier: Apache-2.0
"""Rules about tf frames by a plan: those under other names, those besides, and those not sent."""

from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping, Sequence, Set
from typing import NamedTuple

from multibot_rewrite.base.conventions import SENT_FRAMES, USUAL_FRAMES
from multibot_rewrite.base.findings.finding import ERROR, INCONCLUSIVE, WARNING, Finding
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.rules.declaration import planned_rule
from multibot_rewrite.rules.system.causes import Cause, caused
from multibot_rewrite.rules.system.planned_ends import similar
from multibot_rewrite.rules.system.tf_trees import (
    by_child,
    frames_by_topic,
    frames_in,
    home_of,
    is_described,
    robots_on,
    sent_by_robot,
    taken_elsewhere,
    where_set,
    why_not_received,
)
from multibot_rewrite.system.index import Index, Tree, once
from multibot_rewrite.system.ownership import SEPARATORS
from multibot_rewrite.system.records import PUBLISHES, TOPIC, Edge, Robot
from multibot_rewrite.system.tf_copies import static_topic


class Stray(NamedTuple):
    """A frame of a robot that is not planned.

    ``meant`` is the planned frame that it is under another name, or empty; ``added`` what it has in
    front or behind besides. ``bare``: it lacks the robot's name."""

    frame: str
    meant: str
    added: str = ""
    bare: bool = False


# Robot -> its strays, of one tree.
Strays = Mapping[str, Sequence[Stray]]


@planned_rule("MG207", "frame-without-robot-name", ERROR, nodes=False, absence=True)
def frame_without_robot_name(plan: Index, seen: Index) -> Iterator[Finding]:
    """Report a planned frame that is sent without the robot's name, for one robot only."""
    for tree, robot, found in _strays_of_robots(plan, seen):
        if bare := [it for it in found if it.bare]:
            bare.sort(key=lambda it: robot.frames.index(it.meant))
            names = [it.frame for it in bare]
            message = (
                f"frames {shorten(names)} on {tree.topic} do not have the name of {robot.name}"
            )
            yield frame_without_robot_name.finding(
                message, **_why_bare(plan, tree, robot, bare)._asdict(),
                robot=robot.name, names=tuple(names),
            )  # fmt: skip


def _why_bare(plan: Index, tree: Tree, robot: Robot, bare: Sequence[Stray]) -> Cause:
    """Return the cause of names without the robot's: a sender by the plan, or else the description."""
    expected = {it.meant for it in bare}
    sent = next((it for it in sent_by_robot(plan)[robot.name] if expected <= {*it[1:]}), None)
    first = f"expected {bare[0].meant}"
    if sent:
        place = where_set(plan, sent.node)
        see = f", see {place}" if place else ""
        return caused(f"{first}: by the plan {sent.node} sends {sent}{see}", place)
    own = sorted(it for it in tree.senders if plan.robot(it) == robot.name)
    senders = shorten(own) or "its robot_state_publisher"
    return Cause(f"{first}: load the rewritten description in {senders}")


@planned_rule("MG204", "undeclared-frame", WARNING, nodes=False)
def undeclared_frame(plan: Index, seen: Index) -> Iterator[Finding]:
    """Yield unplanned frames, except those that a driver adds below its sensor's link."""
    for tree, robot, found in _strays_of_robots(plan, seen):
        children = by_child(seen)[tree.topic]
        others = [
            it
            for it in found
            if it.frame in children and not (it.bare or it.added)
            if not _is_added_by_driver(plan, robot.name, it.frame, children)
        ]
        if others:
            names, meant = [it.frame for it in others], others[0].meant
            verb, them = ("is", "it") if len(names) == 1 else ("are", "them")
            cause = f"did you mean {meant}? Otherwise" if meant else "a sensor's own frame? Then"
            there = frames_by_topic(seen)[tree.topic]
            instead = any(it.meant and it.meant not in there for it in others)
            listed = f"frame{'s' * (len(names) > 1)} {shorten(names)}"
            yield undeclared_frame.finding(
                f"{listed} {verb} not in the description of {robot.name}",
                f"{cause} add {them} to other_frames of the plan",
                level=ERROR if instead else WARNING, robot=robot.name, names=tuple(names),
            )  # fmt: skip


def _is_added_by_driver(plan: Index, robot: str, name: str, children: Mapping[str, Edge]) -> bool:
    """Return whether a driver adds the frame: below a link whose name begins like it."""
    above, passed = name, set()
    while above in children and children[above].static and above not in passed:
        passed.add(above)
        above = children[above].parent
        if above in plan.frames_of[robot]:
            return _first_word(plan, above, robot) == _first_word(plan, name, robot)
    return False


def _first_word(plan: Index, frame: str, robot: str) -> str:
    plain = plan.of_frames.without_robot(frame, robot)
    ends = (at for at, letter in enumerate(plain) if letter in "/" + SEPARATORS)
    return plain[: next(ends, None)]


def with_more_names(
    plan: Index, seen: Index
) -> Iterator[tuple[str, bool, Tree, Robot, tuple[str, ...]]]:
    """Yield message, whether the names are planned but for it, tree, robot and frames with a prefix.

    Source: robot_state_publisher src/robot_state_publisher.cpp: frame_prefix is put in front of
    parent and child of every transform, as it is."""
    for tree, robot, found in _strays_of_robots(plan, seen):
        if names := tuple(it.frame for it in found if it.added):
            added = next(it.added for it in found if it.added)
            verb = "is" if len(names) == 1 else "are"
            frames = f"frame{'s' * (len(names) > 1)} {shorten(names)}"
            without = {it.removeprefix(added).lstrip("/") for it in names}
            is_planned = without <= plan.frames_of[robot.name]
            yield f"{frames} {verb} planned without {added!r}", is_planned, tree, robot, names


def misnamed(plan: Index, seen: Index) -> Set[str]:
    """Return the robots whose frames are sent under other names, or on another tf topic."""
    strays = set()
    for tree, robot, found in _strays_of_robots(plan, seen):
        sent = by_child(seen)[tree.topic]
        if any(it.meant and it.meant not in sent and it.frame in sent for it in found):
            strays.add(robot.name)
    elsewhere = taken_elsewhere(plan)
    for tree in (it for it in seen.trees if it.topic not in elsewhere):
        children = (plan.of_frames.exact.get(edge.child, "") for edge in tree.edges)
        strays |= {it for it in children if it and it not in home_of(plan, tree)}
    return strays


def _strays_of_robots(plan: Index, seen: Index) -> Iterator[tuple[Tree, Robot, Sequence[Stray]]]:
    """Yield (tree, robot, unplanned frames of the robot in it)."""
    for tree, strays in _strays(plan, seen):
        for robot, found in strays.items():
            yield tree, plan.declared[robot], found


@once
def _strays(plan: Index, seen: Index) -> Sequence[tuple[Tree, Strays]]:
    """Return (tree, its unplanned frames by robot) for each tree."""
    there = frames_by_topic(seen)
    return [(tree, _strays_of(plan, tree, there[tree.topic])) for tree in seen.trees]


def _strays_of(plan: Index, tree: Tree, present: Set[str]) -> Strays:
    """Return the unplanned frames of a tree that belong to a robot by name or topic."""
    found: dict[str, list[Stray]] = defaultdict(list)
    names: dict[str, list[str]] = defaultdict(list)
    # A moving frame on a robot's own topic may be anything that it detects.
    own, robots = home_of(plan, tree), {*robots_on(plan, tree)}
    fixed = {it.child for it in tree.edges if it.static}
    for name in (it for it in frames_in(tree) if it not in _planned_frame_names(plan)):
        robot = plan.frame_robot(name)
        meant = _frames_by_plain(plan).get(name, {}) if not robot else {}
        plain = {one: it for one, it in meant.items() if one in robots}
        bare = [one for one, it in plain.items() if it == name or it not in present]
        if len(bare) == 1:
            found[bare[0]].append(Stray(name, plain[bare[0]], bare=True))
        elif not plain:
            # The robot whose frame it is but for a prefix: `foo_left_tool` of `left_tool`.
            ends = (plan.of_frames.exact.get(name[at:]) for at in range(1, len(name)))
            home = own[0] if len(own) == 1 else next((it for it in ends if it is not None), "")
            names[robot or home].append(name)
    for robot, strange in names.items():
        if robot and plan.declared[robot].frames:
            strays = _with_meanings(plan, robot, strange)
            sure = (
                it for it in strays if it.added or it.frame in fixed or plan.frame_robot(it.frame)
            )
            found[robot] += sure
    return found


@once
def _planned_frame_names(plan: Index) -> Set[str]:
    return {*plan.system.shared_frames}.union(*plan.frames_of.values())


@once
def _planned_by_plain(plan: Index) -> Mapping[str, Mapping[str, str]]:
    """Return the frames of each robot by name without its own, or by name if the layout adds none."""
    found = {}
    for robot in plan.system.robots:
        plain = {plan.of_frames.without_robot(it, robot.name): it for it in robot.frames}
        # One of a layout without the names may hold the robot's.
        is_plain = any(it == frame for it, frame in plain.items())
        found[robot.name] = {it: it for it in robot.frames} if is_plain else plain
    return found


@once
def _frames_by_plain(plan: Index) -> Mapping[str, Mapping[str, str]]:
    """Return by name without the robot's the frame of each robot that has it."""
    found: dict[str, dict[str, str]] = defaultdict(dict)
    for robot, frames in _planned_by_plain(plan).items():
        for plain, frame in frames.items():
            found[plain][robot] = frame
    return found


def _with_meanings(plan: Index, robot: str, names: Sequence[str]) -> Iterator[Stray]:
    """Yield the unplanned frames, each with the planned frame that it probably is."""
    declared, whose = plan.declared[robot], plan.of_frames
    frames, tag = (*declared.frames, *declared.other_frames), whose.tag(robot)
    plain = {
        **{whose.without_robot(it, robot): it for it in frames},
        **_planned_by_plain(plan)[robot],
    }
    prefixes = {name: _prefix_of(frames, name) for name in names}
    often = Counter(prefixes.values())
    least = min(len(declared.frames), max(2, len(declared.frames) // 2))
    for name in names:
        front = prefixes[name]
        behind = next((name[len(it) :] for it in frames if name.startswith(it)), "")
        twice = next((it for it in (front, behind) if it.strip("/" + SEPARATORS) == tag), "")
        common = front if often[front] >= (2 if front.endswith("/") else least) else ""
        own = whose.without_robot(name, robot)
        again = whose.without_robot(own, robot)
        if added := twice or common:
            yield Stray(name, name.removeprefix(added).removesuffix(added), added)
        elif again != own and again in plain and tag not in whose.ambiguous_words:
            yield Stray(name, plain[again], tag)
        else:
            yield Stray(name, plain.get(own) or plain.get(similar(own, plain), ""))


def _prefix_of(frames: Sequence[str], name: str) -> str:
    """Return what is in front of the longest planned frame that the name ends with."""
    ends = [frame for frame in frames if name.endswith(frame) and name != frame]
    return name.removesuffix(max(ends, key=len)) if ends else ""


@planned_rule("MG208", "frame-not-received", ERROR, absence=True, drawn="missing")
def frame_not_received(plan: Index, seen: Index) -> Iterator[Finding]:
    """Report the planned frames of a robot that no transform has, if all its senders run."""
    senders = _senders(plan) if seen.system.edges else {}
    heard: dict[str, set[str]] = defaultdict(set)
    for tree, strays in _strays(plan, seen):
        nobodys: set[str] = set()
        for name in frames_in(tree):
            # On another topic it has a finding of its own.
            owner = plan.of_frames.exact.get(name, "")
            (heard[owner].add if owner else nobodys.add)(name)
        for owner in {*home_of(plan, tree), *robots_on(plan, tree)} if nobodys else ():
            plain = _planned_by_plain(plan).get(owner, {})
            heard[owner] |= nobodys & plan.frames_of[owner]
            heard[owner].update(plain[it] for it in plain.keys() & nobodys)
        for owner, found in strays.items():
            heard[owner].update(it.meant for it in found)
    for robot in plan.system.robots:
        needed = senders.get(robot.name, set()) - plan.may_miss
        if needed and needed <= seen.nodes.keys():
            left = _left_to_others(plan, seen, robot) | heard[robot.name]
            if missing := [it for it in robot.frames if it not in left]:
                yield _not_received(seen, plan, robot, missing)


def _left_to_others(plan: Index, seen: Index, robot: Robot) -> Set[str]:
    """Return the missing frames that only missing optional nodes send."""
    sent = sent_by_robot(plan)[robot.name]
    absent = plan.may_miss - seen.nodes.keys()
    left = {name for it in sent if it.node in absent for name in it[1:]}
    links = {it for it in robot.frames if plan.plain_frame(it) not in SENT_FRAMES}
    left |= links if len(links) == 1 else set()
    return left.difference(*(it[1:] for it in sent if it.node not in absent))


def _senders(plan: Index) -> Mapping[str, set[str]]:
    """Return by robot its planned nodes that publish its tf."""
    topics = {it.name: (it.tf_topic, static_topic(it.tf_topic)) for it in plan.system.robots}
    found: dict[str, set[str]] = defaultdict(set)
    robot_of = plan.robot_of
    for node, kind, role, name in plan.by_key:
        if role == PUBLISHES and kind == TOPIC and name in topics.get(robot_of.get(node, ""), ()):
            found[robot_of[node]].add(node)
    return found


def _not_received(seen: Index, plan: Index, robot: Robot, missing: Sequence[str]) -> Finding:
    several = f"{len(missing)} of the {len(robot.frames)} frames of {robot.name} are"
    what = several if len(missing) > 1 else f"frame {missing[0]} of {robot.name} is"
    described = set(robot.frames).difference(*(it[1:] for it in sent_by_robot(plan)[robot.name]))
    # The root comes with the odometry, too.
    described = {it for it in described if plan.plain_frame(it) not in USUAL_FRAMES}
    undescribed = bool(described) and described.issubset(missing)
    return frame_not_received.finding(
        f"{what} in no transform: {shorten(missing)}",
        why_not_received(plan, seen, robot, missing, undescribed),
        level=INCONCLUSIVE if undescribed and not is_described(plan, robot) else ERROR,
        robot=robot.name, names=tuple(missing),
    )  # fmt: skip
