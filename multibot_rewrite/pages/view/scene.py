# SPDX-License-Identifier: Apache-2.0
"""A planned fleet -> the scene: models at their poses, old names, and a snapshot's tf trees."""

import os
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from math import acos, degrees, dist, isfinite
from typing import NamedTuple

from multibot_rewrite.base.conventions import WORLD_FRAMES
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.model import Change
from multibot_rewrite.description.checks.poses import inverse, matrix_of_quaternion, product
from multibot_rewrite.description.library import Prepared
from multibot_rewrite.description.steps.apply import Template, list_changes
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.robots.rewritten_robots import GRAPH_KINDS, RewrittenRobot
from multibot_rewrite.pages.view.models import Joint, Model, load_urdf
from multibot_rewrite.pages.view.sdf_model import line_of, lines_by_name, load_sdf
from multibot_rewrite.planning.planned_system import tf_topic
from multibot_rewrite.related_files.names.rename_map import spell
from multibot_rewrite.system.records import Edge, System
from multibot_rewrite.system.tf_copies import tree_topic

HEARD, ELSEWHERE, SILENT = "heard", "elsewhere", "silent"


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
    """A robot: where it is (x, y, z, roll, pitch, yaw), its model, its names, what was changed.

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
    trees: "tuple[HeardTree, ...]"


def scene_of(plan: FleetPlan, graph: System | None = None) -> ShownScene:
    """Return the robots of a plan; raises as ``load_sdf``."""
    templates = {sources: Prepared(job.description).template for sources, job in plan.jobs.items()}
    robots = tuple(_viewed_robot(it, templates[it.spec.sources], graph) for it in plan.robots)
    if graph is None:
        return ShownScene(robots, ())
    frames = [
        LinkFrames(it.name, it.topic, frozenset(f"{it.prefix}{link}" for link in it.model.links))
        for it in robots
    ]
    return ShownScene(robots, heard_trees(graph.edges, frames, plan.fleet.naming.shared_frames))


def _viewed_robot(it: RewrittenRobot, template: Template, graph: System | None) -> ViewedRobot:
    spec = it.spec
    root, source = it.member.described.document.root, os.path.abspath(spec.description)
    model = (load_sdf if root.tag == "sdf" else load_urdf)(root, source)
    # Frames have the tag of a robot, its topics the namespace.
    made = [one for one in list_changes(template, spec.tag) if one.kind not in GRAPH_KINDS]
    made += (one for one in list_changes(template, spec.namespace) if one.kind in GRAPH_KINDS)
    before = _names_before(it, model)
    keys = (("link", model.links), ("joint", [one.name for one in model.joints]))
    names = tuple(
        Name(name, *before.get((kind, name), (name, 0))) for kind, own in keys for name in own
    )
    document, plugins = it.member.source, []
    for element, start in zip(document.elements, document.starts, strict=True):
        if element.tag == "plugin":
            line = document.source.count(b"\n", 0, start) + 1
            text = (element.text or "").strip()
            plugins.append(Plugin(element.get("name", text), element.get("filename", text), line))
    prefix, topic = it.frame_prefix, tf_topic(spec.namespace, it.names.naming)
    sent = graph.edges if graph else ()
    edges = {one.child: one for one in sent if tree_topic(one.topic) == topic}
    # Each link: is it a frame of the robot's tf, below the parent that it has here?
    known = {*edges, *(one.parent for one in edges.values())}
    above = {one.child: f"{prefix}{one.parent}" for one in model.joints}
    heard = {}
    for link in model.links if graph else ():
        edge = edges.get(f"{prefix}{link}")
        here = link not in above or (edge is not None and edge.parent == above[link])
        heard[link] = SILENT if f"{prefix}{link}" not in known else HEARD if here else ELSEWHERE
    links = [one.child for one in model.joints if heard.get(one.child) == HEARD]
    transforms = {link: transform_of(edges[f"{prefix}{link}"]) for link in links}
    file = (
        f"{spec.description} (expanded)"
        if spec.description.endswith(".xacro")
        else spec.description
    )
    return ViewedRobot(
        spec.name, file, tuple(spec.pose or (0.0,) * 6), model, names,
        tuple(sorted(made)), tuple(plugins), topic, prefix, heard, transforms,
    )  # fmt: skip


def _names_before(it: RewrittenRobot, model: Model) -> dict[tuple[str, str], tuple[str, int]]:
    """Return (old name, line) by kind and new name of links and joints; nested ones by order."""
    root = it.member.source.root
    if root.tag == it.member.described.document.root.tag == "sdf":
        old, lines = load_sdf(root, ""), lines_by_name(root)
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


# What rounding and single precision explain.
METRES, DEGREES = 0.001, 0.1


class HeardFrame(NamedTuple):
    """A frame in its parent: x, y, z and a quaternion x, y, z, w."""

    name: str
    parent: str
    transform: tuple[float, ...]


class HeardTree(NamedTuple):
    """Frames below ``root``, parents first, to be drawn at ``robot``'s planned pose or the origin."""

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
    """Return the trees of a snapshot, without frames that have no pose and those below them."""
    by_topic: dict[str, dict[str, Edge]] = defaultdict(dict)
    for it in heard:
        by_topic[tree_topic(it.topic)].setdefault(it.child, it)
    found = []
    for topic, above in by_topic.items():
        for root in dict.fromkeys(it.parent for it in above.values() if it.parent not in above):
            frames = tuple(_frames_below(root, above))
            names = {root, *(it.name for it in frames)}
            own = [it.robot for it in robots if it.topic == topic and it.frames & names]
            # The one robot whose tree this is: nothing says where its root is in the world.
            is_of_one = root not in shared and root not in WORLD_FRAMES and len(own) == 1
            found += [HeardTree(topic, root, own[0] if is_of_one else "", frames)] if frames else []
    return tuple(found)


def transform_of(edge: Edge) -> tuple[float, ...]:
    """Return the seven numbers of a transform; empty unless all are numbers."""
    return edge.transform if all(map(isfinite, edge.transform)) else ()


def _frames_below(root: str, above: Mapping[str, Edge]) -> Iterator[HeardFrame]:
    """Yield the frames below a root whose poses were heard."""
    children = lists_by_key((it.parent, it) for it in above.values())
    todo = [root]
    for name in todo:  # grows
        for it in children[name]:
            if transform := transform_of(it):
                yield HeardFrame(it.child, name, transform)
                todo.append(it.child)


def moved_links(joints: Iterable[Joint], heard: Mapping[str, tuple[float, ...]]) -> Iterator[str]:
    """Yield in words each link on a fixed joint that was heard elsewhere; ``heard`` is by link."""
    for it in joints:
        if it.type == "fixed" and heard.get(it.child):
            metres, angle = offset_between(it, heard[it.child])
            if metres > METRES or angle > DEGREES:
                yield f"{it.child} by {metres:.3f} m and {angle:.1f} degrees"


def offset_between(joint: Joint, heard: tuple[float, ...]) -> tuple[float, float]:
    """Return metres and degrees between a joint's origin and a transform."""
    (a, b, c, x), (d, e, f, y), (g, h, i, z) = (tuple(row) for row in joint.pose[:3])
    turn = product(
        inverse(((a, b, c), (d, e, f), (g, h, i))),
        matrix_of_quaternion((heard[3], heard[4], heard[5], heard[6])),
    )
    cosine = (turn[0][0] + turn[1][1] + turn[2][2] - 1) / 2
    return dist((x, y, z), heard[:3]), degrees(acos(max(-1.0, min(1.0, cosine))))
