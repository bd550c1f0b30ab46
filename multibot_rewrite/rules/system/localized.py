# SPDX-License-Identifier: Apache-2.0
"""Dangers of where a robot is: nothing joins the map and the robot, or the odometry is another's."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence, Set

from multibot_rewrite.base.conventions import BODY_FRAMES, WORLD_FRAMES
from multibot_rewrite.base.findings.finding import ERROR, Finding
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.rules.declaration import system_rule
from multibot_rewrite.rules.places import see, where
from multibot_rewrite.rules.system.states import ACTIVE
from multibot_rewrite.rules.system.tf_trees import root_of
from multibot_rewrite.rules.system.transforms import collide
from multibot_rewrite.system import words
from multibot_rewrite.system.index import Index, Tree, once
from multibot_rewrite.system.records import OFF, RUNS, SUBSCRIBES, TOPIC, End

_MAP = "map"
_ODOM = "odom"
_START = "set_initial_pose"


class _Body(NamedTuple):
    """A robot's frames on a tf topic: the root of its base, and the odd ends below the map."""

    root: str
    loose: tuple[str, ...]


@system_rule("MG415", "map-not-joined", ERROR, absence=True)
def map_not_joined(seen: Index) -> Iterator[Finding]:
    """Where the tree is in pieces below the odometry as well, that is the finding."""
    for tree in seen.trees:
        localizers = [it for it in tree.senders if _starts_at(seen, it)]
        if not localizers or not tree.edges or collide(seen, tree):
            continue
        for node in localizers:
            body = _body(seen, tree, seen.robot(node))
            if body and not _is_told_not_to(seen, node):
                yield _lost(seen, tree, node, body)


def _starts_at(seen: Index, node: str) -> End | None:
    """Where the node surely reads a start pose; None for one that needs none."""
    return next(
        (
            it
            for it in seen.by_node.get(node, ())
            if it.role == SUBSCRIBES
            and it.sure == RUNS
            and words.is_start_pose(seen.plain(it.name), it.type)
        ),
        None,
    )


def _body(seen: Index, tree: Tree, robot: str) -> _Body | None:
    """The robot's part of a tree, if nothing joins it with the map."""
    above: dict[str, str] = {it.child: it.parent for it in tree.edges}
    if len({(it.child, it.parent) for it in tree.edges}) > len(above):
        return None
    frames = [it for it in {**above, **dict.fromkeys(above.values())} if _is_of(seen, it, robot)]
    roots = {
        root_of(it, above) for it in frames if seen.plain_frame(it) in (*BODY_FRAMES, _ODOM)
    } - {*above}
    if len(roots) != 1 or roots & {*WORLD_FRAMES}:
        return None
    return _Body(next(iter(roots)), tuple(_loose(above, robot, seen)))


def _loose(above: Mapping[str, str], robot: str, seen: Index) -> Iterator[str]:
    """What hangs on the map and has nothing below it."""
    parents = {*above.values()}
    for child, parent in above.items():
        if parent in WORLD_FRAMES and child not in parents and _is_of(seen, child, robot):
            yield child


def _is_of(seen: Index, frame: str, robot: str) -> bool:
    return seen.frame_robot(frame) in ("", robot)


def _is_told_not_to(seen: Index, node: str) -> bool:
    return node in _told_not_to(seen)


@once
def _told_not_to(seen: Index) -> Set[str]:
    return {node for it in seen.system.edges if it.sure == OFF for node in it.publishers}


def _lost(seen: Index, tree: Tree, node: str, body: _Body) -> Finding:
    start = _starts_at(seen, node)
    return map_not_joined.finding(
        f"sends no {_MAP} -> {body.root} on {tree.topic}, and no other node does",
        _why(seen, node, body, start.name if start else ""),
        robot=seen.robot(node), node=node, names=(body.root, *body.loose),
    )  # fmt: skip


def _why(seen: Index, node: str, body: _Body, start: str) -> str:
    """The first thing that it lacks."""
    state = seen.node[node].lifecycle if node in seen.node else ""
    if state not in ("", ACTIVE):
        return f"it is {state}: see the log of its lifecycle manager"
    if body.loose:
        return (
            f"{_MAP} -> {body.loose[0]} is sent, and nothing is below {body.loose[0]}: set its"
            f" odom_frame_id to {body.root}"
        )
    if unsent := _unsent(seen, node):
        return f"it waits for {shorten(unsent)}, which no node publishes"
    ends = seen.by_name.get((TOPIC, start))
    told = any(
        (it.node, it.name, it.value) == (node, _START, "true") for it in seen.system.parameters
    )
    nobody = not told and not (ends and ends.publishers)
    return (
        f"it waits for an initial pose: {'nothing publishes' if nobody else 'send one to'} {start}"
    )


def _unsent(seen: Index, node: str) -> Sequence[str]:
    """The scans and maps that it reads and no node publishes."""
    names = (
        it.name
        for it in seen.by_node.get(node, ())
        if it.role == SUBSCRIBES and (words.is_of_a_body(it.type) or it.type == words.MAP)
    )
    return [it for it in names if it not in seen.published]


@system_rule("MG414", "odometry-of-another-robot", ERROR)
def odometry_of_another(seen: Index) -> Iterator[Finding]:
    """A robot that stands on another one is below its links, not below its odometry."""
    for tree in seen.trees:
        for edge in tree.edges:
            owner, robot = seen.frame_robot(edge.parent), seen.frame_robot(edge.child)
            if owner and robot and owner != robot and seen.plain_frame(edge.parent) == _ODOM:
                message = f"{edge.child} is sent below {edge.parent}, the odometry of {owner}"
                hint = f"set the odometry frame of {robot} to its own{see([edge])}"
                yield odometry_of_another.finding(
                    message, hint, robot=robot, names=(edge.child,), **where([edge])
                )
