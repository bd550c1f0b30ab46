# SPDX-License-Identifier: Apache-2.0
"""Outputs at the paths and in the style that a vendor's launch files take (``shapes.yaml``)."""

import itertools
import os
from collections.abc import Iterator, Mapping
from contextlib import suppress
from functools import cache
from typing import Any, NamedTuple

from multibot_rewrite import fleet
from multibot_rewrite.base.bounded import load_own_yaml
from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.fleet.file.fleet_file import FleetFile
from multibot_rewrite.fleet.outputs.output_file import expanded_name, params_of, path_for
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot
from multibot_rewrite.producers.ends import BRIDGE_FILE
from multibot_rewrite.related_files.params.sections import raw_sections

REAL, SIMULATED = "real", "simulated"
DESCRIPTION, SRDF, BRIDGE = "description", "srdf", "bridge"
NOTHING: Mapping[str, Any] = {}


class TakingCommand(NamedTuple):
    """A vendor's command for a robot; ``takes`` are launch arguments and the file of each.

    ``as_it_is`` is the same for files with full names. ``robots`` is ``REAL``, ``SIMULATED`` or
    empty for both; ``pose`` are the arguments of a start pose."""

    command: str
    takes: Mapping[str, str] = NOTHING
    as_it_is: Mapping[str, str] = NOTHING
    robots: str = ""
    releases: str = ""
    pose: tuple[str, ...] = ()


class Shape(NamedTuple):
    """What a vendor's launch files take: the keys of ``shapes.yaml``."""

    source: str
    layouts: tuple[str, ...]
    launch: tuple[TakingCommand, ...]
    params_style: str = ""
    places: Mapping[str, str] = NOTHING
    keeps: tuple[str, ...] = ()
    namespace_in: Mapping[str, tuple[str, ...]] = NOTHING


@cache
def shapes() -> Mapping[str, Shape]:
    """Return all shapes by name."""
    rows = load_own_yaml(fleet.__file__, "shapes.yaml")
    found = {}
    for name, it in rows.items():
        launch = [
            {("robots" if key == "for" else key): value for key, value in row.items()}
            for row in it.pop("launch")
        ]
        found[name] = Shape(**it, launch=tuple(TakingCommand(**row) for row in launch))
    return found


def with_shape(file: FleetFile) -> FleetFile:
    """Return the fleet in the style of its shape; raises UsageError if the layout does not fit."""
    if not file.shape:
        return file
    shape, place = shapes()[file.shape], f"{file.file}: shape {file.shape}"
    layout, style = make_naming(**file.policy).layout.name, shape.params_style or "full"
    if layout not in shape.layouts:
        own = " or ".join(shape.layouts)
        raise UsageError(
            f"{place}: the vendor's launch files do not start layout {layout}; use {own}"
        )
    if file.params_style not in ("", style):
        hint = f"leave it out, or write {style}"
        raise UsageError(
            f"{place}: the vendor's launch files do not take params_style {file.params_style}; {hint}"
        )
    return file._replace(params_style=style)


def placed(robot: RewrittenRobot, shape: str) -> RewrittenRobot:
    """Return the robot with the paths below its folder at which a vendor's launch files look."""
    if not shape:
        return robot
    made, related_files = {}, robot.spec.related_files
    # The files that lie in a vendor's folder already.
    for source in (*related_files.get("params", ()), *related_files.get(BRIDGE, ())):
        folder = os.path.dirname(os.path.abspath(source))
        for it in shapes()[shape].keeps:
            if f"{folder}/".endswith(f"/{it}/"):
                made[_plain_name(robot, source)] = f"{it}/{os.path.basename(source)}"
    for place, what in shapes()[shape].places.items():
        if place not in made.values():
            free = (name for name in _files_with(robot, what) if name not in made)
            made |= dict.fromkeys(itertools.islice(free, 1), place)
    return robot._replace(spec=robot.spec._replace(places=tuple(made.items())))


def name_of(robot: RewrittenRobot, what: str) -> str:
    """Return the file name of a robot's output of a sort, such as ``amcl``; empty if it has none."""
    return next(_files_with(robot, what), "")


def _files_with(robot: RewrittenRobot, what: str) -> Iterator[str]:
    """Yield the file names of a robot's outputs of a sort: description, bridge, or a node's section."""
    spec = robot.spec
    described = {DESCRIPTION: spec.description, SRDF: spec.srdf}
    if what in described:
        yield from [expanded_name(described[what])] if described[what] else ()
    elif what == BRIDGE:
        yield from [BRIDGE_FILE] if spec.related_files.get(BRIDGE) else ()
    else:
        for path, document in params_of(spec).items():
            with suppress(InputError):
                if any(it.path.rpartition("/")[2] == what for it in raw_sections(document)):
                    yield _plain_name(robot, path)


def _plain_name(robot: RewrittenRobot, source: str) -> str:
    """Return the name that the robot's version of a file has without a shape."""
    plain = robot._replace(spec=robot.spec._replace(places=()))
    return path_for(plain, source).partition("/")[2]
