# SPDX-License-Identifier: Apache-2.0
"""Spawners and the controller managers that launch files start: each asks for one that runs.

Source: ros2_control humble 2.37 and jazzy, ``controller_manager/spawner.py``: a relative name of a
manager is below the namespace that the spawner gets, by ``--namespace`` or as a node.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.producers.launch.spawners import Spawned

_ROBOTS = """\
companions: {params: controllers.yaml}
robots:
  - {name: robot1, description: robot.urdf}
  - {name: robot2, description: robot.urdf}
"""
_MODEL = """\
structure:
  nodes:
    /arm/controller_manager:
      {pkg: controller_manager, exec: ros2_control_node, node_name: controller_manager}
    /spawner:
      {pkg: controller_manager, exec: spawner, args: [drive, -n, arm, -c, MANAGER]}
"""
NO_MANAGER = declare(
    "MG723",
    "no-controller-manager",
    ERROR,
    what="A spawner waits for a controller manager that no node of the launch files and no plugin of a "
    "published description makes. In `build` it is a warning where they start another one.",
    why="The spawner waits for the manager and gives up: its controllers are never loaded. A relative "
    "name is below the spawner's namespace, so a namespace in both is there twice.",
    fix="Name the manager that runs (`-c`), without the namespace that the spawner has already, or "
    "with a slash before the whole name. Or start it in that namespace. Where another launch file "
    "starts it, check both together.",
    bad=f"launch: system_model.yaml\n{_ROBOTS}",
    good=f"launch: right.yaml\n{_ROBOTS}",
    line=5,
    formats=("fleet",),
    beside={
        "system_model.yaml": _MODEL.replace("MANAGER", "arm/controller_manager"),
        "right.yaml": _MODEL.replace("MANAGER", "controller_manager"),
        "controllers.yaml": "controller_manager:\n  ros__parameters:\n    drive: "
        "{type: diff_drive_controller/DiffDriveController}\n",
    },
)


class UnderManagers(NamedTuple):
    """Controllers under a manager that runs, and findings of spawners that ask for another one."""

    spawned: tuple[Spawned, ...]
    findings: tuple[Finding, ...]


def under_managers(spawned: Iterable[Spawned], started: Collection[str]) -> UnderManagers:
    """The controllers, those of a manager that is not among the ``started`` ones under the one that
    is meant; as they are where there is none, or more than one."""
    meant = next(iter(started)) if len(started) == 1 else ""
    every = tuple(spawned)
    lost = [it for it in every if meant and it.manager not in started]
    found = tuple(it._replace(manager=meant) if it in lost else it for it in every)
    return UnderManagers(found, tuple(_findings(lost, meant)))


def _findings(lost: Iterable[Spawned], meant: str) -> Iterator[Finding]:
    """One a spawner."""
    spawners: dict[tuple[str, int, str], list[str]] = {}
    for it in lost:
        spawners.setdefault((it.place.file, it.place.line, it.manager), []).append(it.name)
    for (file, line, manager), names in spawners.items():
        message = f"the spawner of {', '.join(names)} asks for {manager}, which nothing starts"
        hint = f"{meant} is started; give the namespace once; the plan has them there"
        yield NO_MANAGER.finding(message, hint, level=WARNING, file=file, line=line, column=1)
