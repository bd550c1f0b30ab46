"""A planned fleet -> the scene: each robot's model at its pose, and what every name was before."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.companions.names.rename_map import spell
from multibot_rewrite.fleets.fleet_file import Sources
from multibot_rewrite.fleets.fleet_plan import FleetPlan
from multibot_rewrite.fleets.rewritten_robots import GRAPH_KINDS, RewrittenRobot
from multibot_rewrite.graph.snapshot import Snapshot
from multibot_rewrite.library import Prepared
from multibot_rewrite.model import Change, UsageError
from multibot_rewrite.reports.changes import list_changes
from multibot_rewrite.view.models import Model, load_model

HEARD, ELSEWHERE, SILENT = "heard", "elsewhere", "silent"
# What is changed for a robot, by its name.
_Changes = Callable[[str], list[Change]]


class Name(NamedTuple):
    """A link's or joint's name for the robot, and before; ``line`` is where the source declares it."""

    after: str
    before: str
    line: int


class ViewedRobot(NamedTuple):
    """A robot: where it stands (x, y, z, roll, pitch, yaw), its model, its names, what was changed.

    ``heard`` says of each frame whether a snapshot of the graph has it.
    """

    name: str
    file: str
    pose: tuple[float, ...]
    model: Model
    names: tuple[Name, ...]
    changes: tuple[Change, ...]
    heard: Mapping[str, str]


def scene_of(plan: FleetPlan, graph: Snapshot | None = None) -> tuple[ViewedRobot, ...]:
    """The robots; raises as ``load_model``, and UsageError for an SDF."""
    changes = {sources: _changes(plan, sources) for sources in plan.jobs}
    return tuple(_robot(it, changes[it.spec.sources], graph) for it in plan.robots)


def _changes(plan: FleetPlan, sources: Sources) -> _Changes:
    template = Prepared(plan.jobs[sources].description).template
    return lambda robot: list_changes(template, robot)


def _robot(it: RewrittenRobot, changes: _Changes, graph: Snapshot | None) -> ViewedRobot:
    spec, root = it.spec, it.member.inventory.document.root
    if root.tag == "sdf":
        raise UsageError(f"{spec.description}: the view shows URDF and xacro, this is an SDF")
    model = load_model(it.description, os.path.abspath(spec.description))
    # Frames have the tag of a robot, its topics the namespace.
    made = [*_of(changes(spec.tag), False), *_of(changes(spec.namespace), True)]
    names = tuple(_names(it, model, made))
    heard = _heard(model, graph, it) if graph else {}
    file = (
        f"{spec.description} (expanded)"
        if spec.description.endswith(".xacro")
        else spec.description
    )
    return ViewedRobot(
        spec.name, file, tuple(spec.pose or (0.0,) * 6), model, names,
        tuple(sorted(made)), heard,
    )  # fmt: skip


def _of(changes: Iterable[Change], graph: bool) -> Iterator[Change]:
    yield from (it for it in changes if (it.kind in GRAPH_KINDS) == graph)


def _names(it: RewrittenRobot, model: Model, made: Sequence[Change]) -> Iterator[Name]:
    lines = {(one.kind, one.old): one.line for one in reversed(made)}
    source = it.member.source
    for kind, tag in (("link", "link"), ("joint", "joint")):
        own = [one.get("name", "") for one in source.root.iterfind(tag)]
        before = {spell(it.names, kind, name): name for name in own}
        after = model.links if kind == "link" else [one.name for one in model.joints]
        for name in after:
            old = before.get(name, name)
            yield Name(name, old, lines.get((kind, old), 0))


def _heard(model: Model, graph: Snapshot, it: RewrittenRobot) -> dict[str, str]:
    """Each link: is it a frame of the graph, below the parent that it has here?"""
    parents = {frame.child: frame.parent for frame in graph.frames}
    known = {*parents, *parents.values()}
    above = {one.child: one.parent for one in model.joints}
    found = {}
    for link in model.links:
        frame = f"{it.frame_prefix}{link}"
        if frame not in known:
            found[link] = SILENT
        elif link in above and parents.get(frame) != f"{it.frame_prefix}{above[link]}":
            found[link] = ELSEWHERE
        else:
            found[link] = HEARD
    return found
