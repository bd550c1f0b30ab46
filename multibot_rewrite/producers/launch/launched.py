# SPDX-License-Identifier: Apache-2.0
"""What a launch starts, with all that is known of it; and what of simulated models is not known."""

import os
import shlex
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from itertools import pairwise
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.base.model import InputError, MultibotError
from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.base.releases import ROS_2
from multibot_rewrite.base.wording import SEVERAL, shorten
from multibot_rewrite.description.readback.xml import read_xml
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.description.steps.collect import collect
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.planning.bridged_topics import BridgedTopic, bridged_topics
from multibot_rewrite.planning.records import Run
from multibot_rewrite.producers.ends import SensorFrame, sensor_frames
from multibot_rewrite.producers.launch.bridges import BridgedDomains
from multibot_rewrite.producers.launch.describe import CLASSIC, SIMULATOR
from multibot_rewrite.producers.launch.models import Model, Models
from multibot_rewrite.producers.launch.records import LaunchedNode, LaunchGraph, LaunchNote
from multibot_rewrite.producers.launch.source_packages import NOT_INSTALLED
from multibot_rewrite.producers.launch.spawners import Spawned
from multibot_rewrite.system.records import Caveat, Place, System

_WORLDS = (".sdf", ".world", ".model")
# The topics of a fleet with a tf each: those of a model are its own then.
_NAMING = make_naming("tf-per-robot")


class InSimulator(NamedTuple):
    """A spawned model: name, description, gz topics, and what spawned it with which ``words``."""

    name: str
    text: str
    root: _Element
    topics: tuple[BridgedTopic, ...]
    words: Mapping[str, str]
    place: Place


class World(NamedTuple):
    """The world that a launch starts the simulator with."""

    file: str
    root: _Element
    place: Place


class Launched(NamedTuple):
    """All that a launch starts: as written (``graph``), as it runs, and as the system of a release.

    ``bridged`` is what its domain_bridges have in ROS domains: in one view of all domains each
    would be a second sender, so it is not in the system."""

    graph: LaunchGraph
    nodes: tuple[Run, ...]
    spawned: tuple[Spawned, ...]
    models: Models
    simulated: tuple[InSimulator, ...]
    system: System
    release: str
    bridged: BridgedDomains

    @property
    def whole(self) -> bool:
        """Return whether every node is known, with all that it does."""
        return not any(it.incomplete for it in self.system.environment.caveats)

    @property
    def with_bridged(self) -> System:
        """The system with the nodes of domain_bridges, for a view of each domain."""
        seen = self.system
        return seen._replace(
            nodes=(*seen.nodes, *self.bridged.nodes), ends=(*seen.ends, *self.bridged.ends)
        )


def file_of(graph: LaunchGraph, text: str) -> str:
    """Return the file that a launch read a description from; empty if unknown."""
    return next((it.source for _, it in graph.files if it.text == text and it.source), "")


def models_in_simulator(models: Models, release: str) -> tuple[InSimulator, ...]:
    """Return the models that a launch spawns, as far as their descriptions are known."""
    found = (_model_in_simulator(it, release) for it in models.found if it.spawned)
    return tuple([it for it in found if it is not None])


def _model_in_simulator(it: Model, release: str) -> InSimulator | None:
    """Return a model with its gz topics; None if its description cannot be read."""
    with suppress(MultibotError):
        document = read_document(it.text.encode(), it.place.file)
        name = it.name or document.root.get("name", "")
        inventory = collect(document, builtin_tree((), release, ROS_2))
        topics, _ = bridged_topics({name: inventory}, _NAMING)
        own = tuple(one for one in topics if one.robot)
        return InSimulator(name, it.text, document.root, own, dict(pairwise(it.words)), it.place)
    return None


def worlds(launched: Launched) -> Iterator[World]:
    """Yield the files of worlds that gz is started with."""
    for it in launched.graph.nodes:
        for word in world_files(it) if it.package != CLASSIC else ():
            with suppress(InputError, OSError):
                yield World(word, read_xml(read_file(word), word), it.place)


def world_files(it: LaunchedNode) -> list[str]:
    """Return the files of worlds in the arguments of a simulator."""
    words: list[str] = []
    for text in it.arguments if it.executable == SIMULATOR else ():
        with suppress(ValueError):
            words += shlex.split(text)
    return [word for word in words if word.endswith(_WORLDS)]


def unread_worlds(nodes: Iterable[LaunchedNode]) -> Iterator[LaunchNote]:
    """Return notes of worlds that cannot be read: a simulator gets them as they are."""
    for it in nodes:
        for file in filter(os.path.isfile, world_files(it)):
            try:
                read_document(read_file(file), file)
            except InputError as error:
                message = f"the simulator gets a world that cannot be read: {error}"
                yield LaunchNote(it.place, message, parameters=True)


def sensors_of(models: Iterable[InSimulator], release: str) -> list[SensorFrame]:
    """Return the sensors of the models."""
    return [sensor for it in models for sensor in sensor_frames(it.root, it.name, release)]


NOT_WHOLE, NOT_KNOWN = "launch-not-whole", "node-not-known"


def of_simulator(graph: LaunchGraph, models: Models) -> Iterator[Caveat]:
    """Yield why the view of a simulator may be incomplete."""
    # Plugins of a spawned model are nodes, which a robot brings with it.
    for it in models.lost[:1]:
        text = "nodes that plugins of a spawned model make are not known: its description is not"
        yield Caveat(NOT_WHOLE, True, f"{it.place}: {text}")
    unknown = [name for it in models.found if it.spawned for _, name in it.reading.unknown]
    if unknown:
        listed = shorten(list(dict.fromkeys(unknown)), SEVERAL)
        text = f"what these plugins of spawned models start is not known: {listed}"
        yield Caveat(NOT_KNOWN, True, f"{text}; describe them (docs/add-a-plugin.md)")
    # A world may have robots in it, which nobody spawns.
    alone = not models.lost and not any(it.spawned for it in models.found)
    for it in graph.nodes:
        for file in world_files(it):
            why = "" if NOT_INSTALLED in file else _unknown_in(file, alone)
            if why:
                yield Caveat(NOT_WHOLE, True, f"{it.place}: the world {file} {why}")


def _unknown_in(file: str, alone: bool) -> str:
    """Return what is unknown of a world file's models, for a message; or empty."""
    if not os.path.isfile(file):
        return "was not found, so it is unknown what its models send" if os.path.isabs(file) else ""
    with suppress(InputError):
        root = read_xml(read_file(file), file)
        moved = any(True for model in root.iter("model") for _ in model.iter("plugin"))
        if moved or (alone and any(True for _ in root.iter("include"))):
            return "has models of its own: what they send is not known"
    return ""
