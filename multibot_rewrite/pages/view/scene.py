# SPDX-License-Identifier: Apache-2.0
"""A planned fleet -> the scene: each robot's model at its pose, what every name was before, and the
transforms of a snapshot as trees to be drawn over the robots."""

from __future__ import annotations

import os
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from math import acos, degrees, dist, isfinite
from typing import NamedTuple

from multibot_rewrite.base.conventions import WORLD_FRAMES
from multibot_rewrite.base.model import Change
from multibot_rewrite.companions.names.rename_map import spell
from multibot_rewrite.description.checks.poses import inverse, matrix_of_quaternion, product
from multibot_rewrite.description.library import Prepared
from multibot_rewrite.description.steps.apply import list_changes
from multibot_rewrite.description.steps.document import Document
from multibot_rewrite.fleet.file.robot_spec import Sources
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.robots.rewritten_robots import GRAPH_KINDS, RewrittenRobot
from multibot_rewrite.pages.view.models import Joint, Model, load_urdf
from multibot_rewrite.pages.view.sdf_model import declared, line_of, load_sdf
from multibot_rewrite.spelling.plan import tf_topic
from multibot_rewrite.system.records import Edge, System
from multibot_rewrite.system.tf_copies import tree_topic

HEARD, ELSEWHERE, SILENT = "heard", "elsewhere", "silent"
# What is changed for a robot, by its name.
_Changes = Callable[[str], list[Change]]


class Name(NamedTuple):
    """A link's or joint's name for the robot, and before; ``line`` is where the source declares it."""

    after: str
    before: str
    line: int


class Plugin(NamedTuple):
    """A ``<plugin>`` of the source: its name, what it loads, the line where it begins."""

    name: str
    loads: str
    line: int


class ViewedRobot(NamedTuple):
    """A robot: where it stands (x, y, z, roll, pitch, yaw), its model, its names, what was changed.

    ``heard`` says of each link whether a snapshot of the graph has it on ``topic``; ``transforms`` are
    those of links that hang there as they do here. ``prefix`` is before a link's name there.
    """

    name: str
    file: str
    pose: tuple[float, ...]
    model: Model
    names: tuple[Name, ...]
    changes: tuple[Change, ...]
    plugins: tuple[Plugin, ...]
    topic: str
    prefix: str
    heard: Mapping[str, str]
    transforms: Mapping[str, tuple[float, ...]]


class ShownScene(NamedTuple):
    """The robots, and what a snapshot has of tf."""

    robots: tuple[ViewedRobot, ...]
    trees: tuple[HeardTree, ...]


def scene_of(plan: FleetPlan, graph: System | None = None) -> ShownScene:
    """The robots; raises as ``load_sdf``."""
    changes = {sources: _changes(plan, sources) for sources in plan.jobs}
    robots = tuple(_robot(it, changes[it.spec.sources], graph) for it in plan.robots)
    if graph is None:
        return ShownScene(robots, ())
    frames = [
        LinkFrames(it.name, it.topic, frozenset(f"{it.prefix}{link}" for link in it.model.links))
        for it in robots
    ]
    return ShownScene(robots, heard_trees(graph.edges, frames, plan.fleet.naming.shared_frames))


def _changes(plan: FleetPlan, sources: Sources) -> _Changes:
    template = Prepared(plan.jobs[sources].description).template
    return lambda robot: list_changes(template, robot)


def _robot(it: RewrittenRobot, changes: _Changes, graph: System | None) -> ViewedRobot:
    spec = it.spec
    model = _model(it)
    # Frames have the tag of a robot, its topics the namespace.
    made = [*_of(changes(spec.tag), False), *_of(changes(spec.namespace), True)]
    names = tuple(_names(it, model))
    prefix, topic = it.frame_prefix, tf_topic(spec.namespace, it.names.naming)
    sent = graph.edges if graph else ()
    edges = {one.child: one for one in sent if tree_topic(one.topic) == topic}
    heard = _heard(model, edges, prefix) if graph else {}
    links = [one.child for one in model.joints if heard.get(one.child) == HEARD]
    transforms = {link: placed(edges[f"{prefix}{link}"]) for link in links}
    file = (
        f"{spec.description} (expanded)"
        if spec.description.endswith(".xacro")
        else spec.description
    )
    return ViewedRobot(
        spec.name, file, tuple(spec.pose or (0.0,) * 6), model, names,
        tuple(sorted(made)), tuple(_plugins(it.member.source)), topic, prefix, heard, transforms,
    )  # fmt: skip


def _of(changes: Iterable[Change], graph: bool) -> Iterator[Change]:
    yield from (it for it in changes if (it.kind in GRAPH_KINDS) == graph)


def _model(it: RewrittenRobot) -> Model:
    root, source = it.member.described.document.root, os.path.abspath(it.spec.description)
    return (load_sdf if root.tag == "sdf" else load_urdf)(root, source)


def _plugins(document: Document) -> Iterator[Plugin]:
    """In the order of the file."""
    for it, start in zip(document.elements, document.starts, strict=True):
        if it.tag == "plugin":
            line = document.source.count(b"\n", 0, start) + 1
            text = (it.text or "").strip()
            yield Plugin(it.get("name", text), it.get("filename", text), line)


def _names(it: RewrittenRobot, model: Model) -> Iterator[Name]:
    before = _before(it, model)
    for kind, names in (("link", model.links), ("joint", [one.name for one in model.joints])):
        for name in names:
            yield Name(name, *before.get((kind, name), (name, 0)))


def _before(it: RewrittenRobot, model: Model) -> dict[tuple[str, str], tuple[str, int]]:
    """What a link or joint was called, and the line that declares it. Names within nested models of an
    SDF are told by their order, which a rewrite keeps."""
    root = it.member.source.root
    if root.tag == it.member.described.document.root.tag == "sdf":
        old, lines = load_sdf(root, ""), declared(root)
        both = [("link", *pair) for pair in zip(model.links, old.links, strict=True)]
        both += [
            ("joint", new.name, was.name) for new, was in zip(model.joints, old.joints, strict=True)
        ]
        return {(kind, new): (was, lines.get(was, 0)) for kind, new, was in both}
    return {
        (kind, spell(it.names, kind, name)): (name, line_of(one))
        for kind in ("link", "joint")
        for one in root.iterfind(kind)
        for name in [one.get("name", "")]
    }


def _heard(model: Model, edges: Mapping[str, Edge], prefix: str) -> dict[str, str]:
    """Each link: is it a frame of the robot's tf, below the parent that it has here?"""
    parents = {child: edge.parent for child, edge in edges.items()}
    known = {*parents, *parents.values()}
    above = {one.child: one.parent for one in model.joints}
    found = {}
    for link in model.links:
        frame = f"{prefix}{link}"
        if frame not in known:
            found[link] = SILENT
        elif link in above and parents.get(frame) != f"{prefix}{above[link]}":
            found[link] = ELSEWHERE
        else:
            found[link] = HEARD
    return found


# What rounding and single precision explain.
METRES, DEGREES = 0.001, 0.1


class HeardFrame(NamedTuple):
    """A frame in its parent: x, y, z and a quaternion x, y, z, w."""

    name: str
    parent: str
    transform: tuple[float, ...]


class HeardTree(NamedTuple):
    """Frames below ``root`` on a tf topic, parents first. It stands where ``robot`` is planned to be,
    at the world's origin for none."""

    topic: str
    root: str
    robot: str
    frames: tuple[HeardFrame, ...]


class LinkFrames(NamedTuple):
    """A robot's links as frames of its tf topic."""

    robot: str
    topic: str
    frames: frozenset[str]


def heard_trees(
    heard: Iterable[Edge], robots: Sequence[LinkFrames], shared: frozenset[str]
) -> tuple[HeardTree, ...]:
    """The trees of a snapshot; a frame whose place was not heard is left out with those below it."""
    by_topic: dict[str, dict[str, Edge]] = defaultdict(dict)
    for it in heard:
        by_topic[tree_topic(it.topic)].setdefault(it.child, it)
    return tuple(
        HeardTree(topic, root, _robot_of(topic, root, frames, robots, shared), frames)
        for topic, above in by_topic.items()
        for root in dict.fromkeys(it.parent for it in above.values())
        if root not in above
        for frames in [tuple(_below(root, above))]
        if frames
    )


def placed(edge: Edge) -> tuple[float, ...]:
    """Its transform, if all of it is numbers."""
    return edge.transform if all(map(isfinite, edge.transform)) else ()


def _below(root: str, above: Mapping[str, Edge]) -> Iterator[HeardFrame]:
    children: dict[str, list[Edge]] = defaultdict(list)
    for it in above.values():
        children[it.parent].append(it)
    todo = [root]
    for name in todo:  # grows
        for it in children[name]:
            if transform := placed(it):
                yield HeardFrame(it.child, name, transform)
                todo.append(it.child)


def _robot_of(
    topic: str,
    root: str,
    frames: Sequence[HeardFrame],
    robots: Sequence[LinkFrames],
    shared: frozenset[str],
) -> str:
    """The one robot whose tree this is: nothing says where its root is in the world."""
    if root in shared or root in WORLD_FRAMES:
        return ""
    names = {root, *(it.name for it in frames)}
    own = [it.robot for it in robots if it.topic == topic and it.frames & names]
    return own[0] if len(own) == 1 else ""


def moved(joints: Iterable[Joint], heard: Mapping[str, tuple[float, ...]]) -> Iterator[str]:
    """Links on fixed joints that were heard at another place, and how far off; ``heard`` is by link."""
    for it in joints:
        if it.type == "fixed" and heard.get(it.child):
            metres, angle = apart(it, heard[it.child])
            if metres > METRES or angle > DEGREES:
                yield f"{it.child} by {metres:.3f} m and {angle:.1f} degrees"


def apart(joint: Joint, heard: tuple[float, ...]) -> tuple[float, float]:
    """Metres and degrees between a joint's origin and a transform."""
    (a, b, c, x), (d, e, f, y), (g, h, i, z) = (tuple(row) for row in joint.pose[:3])
    turn = product(
        inverse(((a, b, c), (d, e, f), (g, h, i))),
        matrix_of_quaternion((heard[3], heard[4], heard[5], heard[6])),
    )
    cosine = (turn[0][0] + turn[1][1] + turn[2][2] - 1) / 2
    return dist((x, y, z), heard[:3]), degrees(acos(max(-1.0, min(1.0, cosine))))
