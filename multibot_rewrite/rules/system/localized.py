# SPDX-License-Identifier: Apache-2.0
"""Dangers of where a robot is: no map, another's odometry, transforms that tf2 drops."""

from collections.abc import Iterator, Mapping, Set
from math import inf, isfinite
from typing import NamedTuple

from multibot_rewrite.base.conventions import BODY_FRAMES, TF_SWITCHES, WORLD_FRAMES, switch
from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.wording import only, shorten, unique
from multibot_rewrite.rules.declaration import last_place, see_all, system_rule
from multibot_rewrite.rules.system.causes import Cause, to_set
from multibot_rewrite.rules.system.frame_ids import trees_of
from multibot_rewrite.rules.system.states import ACTIVE
from multibot_rewrite.rules.system.tf_trees import root_of
from multibot_rewrite.rules.system.transforms import collide
from multibot_rewrite.system import words
from multibot_rewrite.system.index import Index, Tree, once, robots_of, sent_on
from multibot_rewrite.system.parameters import parameter_text
from multibot_rewrite.system.records import OFF, RUNS, SUBSCRIBES, TOPIC, Edge, End

_MAP = "map"
_ODOM = "odom"
_START = "set_initial_pose"


class _Body(NamedTuple):
    """A robot's frames on a tf topic: the root of its base, and the odd ends below the map."""

    root: str
    loose: tuple[str, ...]


@system_rule("MG415", "map-not-joined", ERROR, absence=True)
def map_not_joined(seen: Index) -> Iterator[Finding]:
    """Report a map that no transform joins to the robot; pieces below the odometry are MG406."""
    for tree in seen.trees:
        silent = (it for it in tree.listeners if switch(TF_SWITCHES, it))
        localizers = [it for it in (*tree.senders, *silent) if _start_pose_end(seen, it)]
        if not localizers or not tree.edges or collide(seen, tree):
            continue
        for node in unique(localizers):
            body, start = _unjoined_body(seen, tree, seen.robot(node)), _start_pose_end(seen, node)
            if body and node not in _forbidden_senders(seen):
                yield map_not_joined.finding(
                    f"sends no {_MAP} -> {body.root} on {tree.topic}, and no other node does",
                    **_why_not_localized(seen, tree, node, body, start.name if start else "")._asdict(),
                    robot=seen.robot(node), node=node, names=(body.root, *body.loose),
                )  # fmt: skip
    yield from _maps_below_the_map(seen)


def _maps_below_the_map(seen: Index) -> Iterator[Finding]:
    """Yield maps in the frame of odometry, or of a body, that is sent below the map's: they move."""
    for it in seen.system.heard:
        type_, senders = sent_on(seen, it.topic)
        is_map = words.kind_of_data(it.topic, type_) == words.MAP and senders
        if not is_map or seen.plain_frame(it.frame) not in (_ODOM, *BODY_FRAMES):
            continue
        robot = seen.robot(it.topic) or only(robots_of(seen, senders))
        edges = (one for tree in trees_of(seen, robot) for one in tree.edges)
        root = root_of(it.frame, {one.child: one.parent for one in edges})
        if seen.plain_frame(root) in WORLD_FRAMES and seen.frame_robot(it.frame) in ("", robot):
            yield map_not_joined.finding(
                f"frame_id of {it.topic} is {it.frame}, which moves in {root}; sent by {senders[0]}",
                f"set the frame of {senders[0]} to that of the map",
                level=WARNING, robot=robot, node=senders[0], names=(it.topic,),
            )  # fmt: skip


def _start_pose_end(seen: Index, node: str) -> End | None:
    """Return where the node surely reads a start pose; None for one that needs none."""
    read = (it for it in seen.by_node.get(node, ()) if it.role == SUBSCRIBES and it.sure == RUNS)
    return next((it for it in read if words.is_start_pose(seen.plain(it.name), it.type)), None)


def _unjoined_body(seen: Index, tree: Tree, robot: str) -> _Body | None:
    """Return the robot's part of a tree if nothing joins its odometry with the map; None otherwise."""
    above: dict[str, str] = {it.child: it.parent for it in tree.edges}
    if len({(it.child, it.parent) for it in tree.edges}) > len(above):
        return None
    every = {**above, **dict.fromkeys(above.values())}
    frames = [it for it in every if seen.frame_robot(it) in ("", robot)]
    # What hangs on the map and has nothing below it.
    ends = above.keys() - {*above.values()}
    loose = [it for it in frames if it in ends and above[it] in WORLD_FRAMES]
    body = (it for it in frames if seen.plain_frame(it) in (*BODY_FRAMES, _ODOM))
    roots = {root_of(it, above) for it in body if it not in loose} - {*above}
    bodies = BODY_FRAMES if _ODOM in map(seen.plain_frame, loose) else ()
    is_one = len(roots) == 1 and {*WORLD_FRAMES, *bodies}.isdisjoint(map(seen.plain_frame, roots))
    return _Body(next(iter(roots)), tuple(loose)) if is_one else None


@once
def _forbidden_senders(seen: Index) -> Set[str]:
    """Return the nodes that a parameter forbids to send a transform."""
    return {node for it in seen.system.edges if it.sure == OFF for node in it.publishers}


def _why_not_localized(seen: Index, tree: Tree, node: str, body: _Body, start: str) -> Cause:
    """Return the first reason why a node does not send map -> odom."""
    state = seen.node[node].lifecycle if node in seen.node else ""
    if state not in ("", ACTIVE):
        return Cause(f"it is {state}: see the log of its lifecycle manager")
    if node not in tree.senders and (name := switch(TF_SWITCHES, node)):
        cause = to_set(name, parameter_text(True), node)
        return cause._replace(hint=f"it sends no transforms at all: {cause.hint}")
    if body.loose:
        sent = f"{_MAP} -> {body.loose[0]} is sent, and nothing is below {body.loose[0]}"
        cause = to_set("odom_frame_id", body.root, node)
        return cause._replace(hint=f"{sent}: {cause.hint}")
    # The scans and maps that it reads.
    read = [it for it in seen.by_node.get(node, ()) if it.role == SUBSCRIBES]
    read = [it for it in read if words.is_of_a_body(it.type) or it.type == words.MAP]
    if unsent := [it.name for it in read if it.name not in seen.published]:
        return Cause(f"it waits for {shorten(unsent)}, which {seen.nobody} publishes")
    told = any(
        (it.node, it.name, it.value) == (node, _START, "true") for it in seen.system.parameters
    )
    nobody = not told and not seen.ends_at(TOPIC, start).publishers
    do = "nothing publishes" if nobody else "send one to"
    return Cause(f"it waits for an initial pose: {do} {start}")


@system_rule("MG414", "odometry-of-another-robot", ERROR)
def odometry_of_another(seen: Index) -> Iterator[Finding]:
    """Yield frames below the odometry of another robot; on its links a robot may be."""
    for tree in seen.trees:
        for edge in tree.edges:
            owner, robot = seen.frame_robot(edge.parent), seen.frame_robot(edge.child)
            if owner and robot and owner != robot and seen.plain_frame(edge.parent) == _ODOM:
                message = f"{edge.child} is sent below {edge.parent}, the odometry of {owner}"
                hint = f"set the odometry frame of {robot} to its own{see_all([edge])}"
                yield odometry_of_another.finding(
                    message, hint, robot=robot, names=(edge.child,), **last_place([edge])
                )


# QUATERNION_NORMALIZATION_TOLERANCE of tf2/src/buffer_core.cpp.
_TOLERANCE = 10e-3


@system_rule("MG416", "transform-refused", ERROR)
def transform_refused(seen: Index) -> Iterator[Finding]:
    """Report transforms that BufferCore::setTransformImpl refuses, once per topic and reason."""
    edges = [it for tree in seen.trees for it in tree.edges]
    found = lists_by_key(((it.topic, why), it) for it in edges if (why := _why_dropped(it)))
    for (topic, why), edges in found.items():
        senders = unique(node for it in edges for node in it.publishers)
        listed = shorten(
            unique(f"{it.parent or '(none)'} -> {it.child or '(none)'}" for it in edges)
        )
        robots = unique(seen.frame_robot(it.child) for it in edges)
        yield transform_refused.finding(
            f"tf2 drops {listed} on {topic}: {why}",
            f"one of {shorten(senders)} sends it" if senders else "",
            robot=only(robots) or only(robots_of(seen, senders)),
            names=(topic, *unique(it.child for it in edges if it.child)),
        )
    for it in seen.system.heard:
        _, senders = sent_on(seen, it.topic)
        if senders and (why := _fault_of_pose(it.pose)):
            yield transform_refused.finding(
                f"the pose on {it.topic} cannot be used: {why}",
                f"see what {shorten(senders)} makes it of",
                robot=only(robots_of(seen, senders)), node=senders[0], names=(it.topic,),
            )  # fmt: skip


def _why_dropped(it: Edge) -> str:
    """Return why tf2 refuses a transform; empty if it does not."""
    if not (it.child and it.parent):
        return "a frame has no name"
    if it.child == it.parent:
        return "a frame is its own parent"
    return _fault_of_pose(it.transform)


def _fault_of_pose(numbers: tuple[float, ...]) -> str:
    """Return what is wrong with the numbers of a transform; empty if nothing is."""
    if not all(map(isfinite, numbers)):
        return "a number in it is not finite (NaN)"
    length = sum(number * number for number in numbers[3:])
    if numbers and abs(length - 1) > _TOLERANCE:
        return "its quaternion is all zeros" if not length else "its quaternion is not of length 1"
    return ""


# No robot's part is so far from its base, in metres: a place in millimetres is.
_FAR = 20.0


@system_rule("MG418", "part-far-away", WARNING)
def part_far_away(seen: Index) -> Iterator[Finding]:
    """Report parts that are implausibly far from their parent; below the map distance is no fault."""
    for tree in seen.trees:
        above = {it.child: it.parent for it in tree.edges}
        for it in tree.edges:
            away = max(map(abs, it.transform[:3]), default=0.0)
            if it.static and _FAR < away < inf and _is_of_a_body(seen, it.parent, above):
                yield part_far_away.finding(
                    f"{it.parent} -> {it.child} on {it.topic} is {away:g} m long",
                    f"write metres in the files that {shorten(it.publishers) or 'its node'} reads",
                    robot=seen.frame_robot(it.child) or only(robots_of(seen, it.publishers)),
                    names=(it.child, it.topic),
                )


def _is_of_a_body(seen: Index, frame: str, above: Mapping[str, str]) -> bool:
    """Return whether a frame is the base of a robot, or below it."""
    way = [frame]
    while way[-1] in above and above[way[-1]] not in way:
        way.append(above[way[-1]])
    return any(seen.plain_frame(it) in BODY_FRAMES for it in way)
