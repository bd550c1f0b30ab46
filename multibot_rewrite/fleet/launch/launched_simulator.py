# SPDX-License-Identifier: Apache-2.0
"""The simulator as the launch files of a robot start it: its world, its options, if it has a window."""

import os
from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import pairwise
from typing import NamedTuple, cast

from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.releases import ROS_2
from multibot_rewrite.description.readback.reading import read_tree
from multibot_rewrite.description.readback.xml import read_xml
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.fleet.file.fleet_file import FleetFile
from multibot_rewrite.fleet.launch.launched_robot import launch_of
from multibot_rewrite.planning.of_runs import with_names
from multibot_rewrite.planning.records import Run
from multibot_rewrite.planning.table import plugin_nodes
from multibot_rewrite.producers.launch.describe import CLASSIC, SIMULATOR, SIMULATORS
from multibot_rewrite.producers.launch.launched import world_files
from multibot_rewrite.system.records import Place

# Options of ``gz sim`` that are switches of the built launch file: -r it has always.
_SERVER, _WINDOW, _OWN = "-s", "-g", ("-r", "-s", "-g")
# Those that have a value, which is the next word (gz-sim gz-sim8 src/cmd/cmdsim.rb.in).
_VALUED = (
    *("-v", "-z", "--seed", "--iterations", "--physics-engine", "--render-engine"),
    *("--render-engine-server", "--render-engine-gui", "--network-role"),
)


class Simulator(NamedTuple):
    """The simulator of launch files: its world (path, name or empty), options, window and kind."""

    world: str = ""
    options: tuple[str, ...] = ()
    headless: bool = False
    is_classic: bool = False


def launched_simulator(file: FleetFile) -> Simulator:
    """Return the simulator of the first robot whose launch files start one."""
    for spec in file.robots:
        nodes = launch_of(spec.launch, spec.words[0]).nodes if spec.launch else ()
        started = [it for it in nodes if it.executable == SIMULATOR and it.package in SIMULATORS]
        if started:
            words = [word for own in started for word in own.arguments]
            worlds = [one for own in started for one in world_files(own)]
            world = worlds[0] if worlds else ""
            if started[0].package == CLASSIC:
                programs = (os.path.basename(it.executable) for it in nodes if not it.package)
                return Simulator(world, (), "gzclient" in programs, True)
            headless = _SERVER in words and _WINDOW not in words
            return Simulator(world, tuple(dict.fromkeys(_options(words))), headless)
    return Simulator()


def with_launched_world(file: FleetFile) -> FleetFile:
    """Return the fleet with the gz-sim world that its launch files name, if it names none itself."""
    own = launched_simulator(file)
    if file.simulator_world or own.is_classic or not os.path.isfile(own.world):
        return file
    place = next((it.launch[0].file, 1) for it in file.robots if it.launch)
    with suppress(InputError):
        if read_document(read_file(own.world), own.world).root.find("world") is not None:
            return file._replace(simulator_world=own.world, world_place=place)
    return file


def nodes_of_world(file: FleetFile) -> Iterator[Run]:
    """Yield the nodes of a Gazebo Classic world that launch files name."""
    own = launched_simulator(file)
    if not own.is_classic or not os.path.isfile(own.world):
        return
    with suppress(InputError):  # it is told where the launch is read
        root = read_xml(read_file(own.world), own.world)
        reading = read_tree(root, builtin_tree((), file.distro, ROS_2).definitions)
        lines = [cast("int", it.sourceline) for it in root.iter("plugin")]
        for node, run in zip(reading.nodes, plugin_nodes(reading, ""), strict=True):
            yield with_names(run)._replace(place=Place(own.world, lines[node.number]))


def _options(words: Sequence[str]) -> Iterator[str]:
    """Yield the options with their values, each as one text."""
    for word, after in pairwise((*words, "-")):
        if word in _VALUED:
            yield word if after.startswith("-") else f"{word} {after}"
        elif word.startswith("-") and word not in _OWN:
            yield word
