# SPDX-License-Identifier: Apache-2.0
"""``world.sdf``: an empty world for gz-sim that runs the sensors of the robots.

Gazebo's own empty.sdf has physics, user commands, the scene and contacts; a lidar, a camera or an IMU
sends nothing in it. Source: gz-sim gz-sim8 examples/worlds/empty.sdf, sensors_demo.sdf, and the names
in src/systems (ign-gazebo6 of Humble calls the libraries ignition-gazebo-...).
"""

from __future__ import annotations

from collections.abc import Sequence

from multibot_rewrite.base.bounded import own_text
from multibot_rewrite.base.releases import has_release
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.outputs.given_world import own_world
from multibot_rewrite.fleet.outputs.output_file import FilesAndFindings, OutputFile
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot
from multibot_rewrite.fleet.robots.simulators import is_simulated, systems_of
from multibot_rewrite.knowledge.worlds import SYSTEMS
from multibot_rewrite.rules.facts.simulators import needed_systems

FILE = "world.sdf"
# The release whose Gazebo has libraries of the old name.
OLD_NAMES = "humble"
_ALWAYS = {
    "physics": "Physics",
    "user-commands": "UserCommands",
    "scene-broadcaster": "SceneBroadcaster",
    "contact": "Contact",
}


def world_file(plan: FleetPlan) -> FilesAndFindings:
    """Yield the fleet file's world with what the robots need; otherwise an empty one, if a gz-sim
    robot's sensor needs more than Gazebo's own. Raises InputError for a file that is no world."""
    kind = "ignition-gazebo" if has_release(OLD_NAMES, plan.file.distro) else "gz-sim"
    robots = [it for it in plan.robots if is_simulated(it) and not it.is_classic]
    usual = {library: _system(kind, library, name) for library, name in _ALWAYS.items()}
    ours = _needed(robots, kind)
    given = plan.file.simulator_world
    if given:
        simulated = [it for it in plan.robots if is_simulated(it)]
        models = [(it.spec.model, it.member.inventory.document.root) for it in simulated]
        spawning = {it: usual[it] for it, _ in needed_systems(models) if it in usual}
        world = read_document(read_file(given), given).root.find("world")
        plugins = world.iterchildren("plugin") if world is not None else ()
        there = [it.get("filename") or "" for it in plugins]
        lacking = {
            library: text
            for library, text in (spawning | ours).items()
            if not any(f"-{library}-system" in it for it in there)
        }
        if not there:
            # To a world that names none those are added that Gazebo gives it.
            lacking = usual | ours if ours else {}
        systems = "".join(lacking.values())
        data, findings = own_world(given, simulated, systems, *plan.file.world_place)
        yield OutputFile(FILE, data, (given,))
        yield from findings
    elif ours:
        systems = "".join({**usual, **ours}.values())
        place = own_text(__file__, "place_on_earth.sdf") if "navsat" in ours else ""
        empty = own_text(__file__, "empty_world.sdf").format(systems=systems, place=place)
        yield OutputFile(FILE, empty.encode())


def _needed(robots: Sequence[RewrittenRobot], kind: str) -> dict[str, str]:
    """Return the systems for the sensors of these robots, by library, and those of their files."""
    roots = [it.member.inventory.document.root for it in robots]
    types = {sensor.get("type", "") for root in roots for sensor in root.iter("sensor")}
    needed = dict(sorted(SYSTEMS[it] for it in types & SYSTEMS.keys()))
    found = systems_of(robots).items()
    theirs = {
        library.removeprefix("gz-sim-").removesuffix("-system"): f"    {text}\n"
        for library, text in found
    }
    return {**{it: _system(kind, it, name) for it, name in needed.items()}, **theirs}


def _system(kind: str, library: str, name: str) -> str:
    head = f'    <plugin filename="{kind}-{library}-system" name="gz::sim::systems::{name}"'
    if name != "Sensors":
        return f"{head}/>\n"
    return f"{head}>\n      <render_engine>ogre2</render_engine>\n    </plugin>\n"
