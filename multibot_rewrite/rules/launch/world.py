# SPDX-License-Identifier: Apache-2.0
"""Whether the world that a launch starts runs what its robots need.

Source: gz-sim8 src/ServerConfig.cc and src/SimulationRunner.cc (a world without any plugin gets those
of server.config: physics, user commands, scene broadcaster); src/systems/user_commands (it spawns
entities); src/systems/sensors and the systems of other sensors.
"""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.description.rewriters.tree import library_key
from multibot_rewrite.knowledge.worlds import DEFAULTS
from multibot_rewrite.producers.launch.launched import (
    Launched,
    World,
    worlds,
)
from multibot_rewrite.rules.declaration import launch_rule
from multibot_rewrite.rules.facts.simulators import needed_systems
from multibot_rewrite.rules.places import at


@launch_rule("MG706", "world-without-system")
def without_system(launched: Launched) -> Iterator[Finding]:
    """A robot may bring a system itself."""
    models = launched.simulated
    roots = [it.root for it in models]
    brought = {_system(it.get("filename", "")) for root in roots for it in root.iter("plugin")}
    for world in worlds(launched):
        there = _systems(world)
        for system, why in needed_systems((it.name, it.root) for it in models):
            if system not in {*there, *brought}:
                message = f"world {world.file} does not load the system {system}: {why}"
                hint = f'add <plugin filename="gz-sim-{system}-system" .../> to the world'
                yield at(without_system, world.place, message, hint)


def _systems(world: World) -> set[str]:
    found = list(world.root.iterfind("world/plugin"))
    return {_system(it.get("filename", "")) for it in found} if found else set(DEFAULTS)


def _system(library: str) -> str:
    return library_key(library).removeprefix("gz-sim-").removesuffix("-system")
