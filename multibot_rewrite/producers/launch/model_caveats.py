# SPDX-License-Identifier: Apache-2.0
"""What is not known of the models in a simulator: those that a launch spawns, those of its world."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import suppress

from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.wording import SEVERAL, shorten
from multibot_rewrite.description.readback.xml import read_xml
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.producers.launch.launched import world_files
from multibot_rewrite.producers.launch.models import Models
from multibot_rewrite.producers.launch.records import LaunchGraph
from multibot_rewrite.producers.launch.source_packages import NOT_INSTALLED
from multibot_rewrite.system.records import Caveat

NOT_WHOLE, NOT_KNOWN = "launch-not-whole", "node-not-known"


def of_simulator(graph: LaunchGraph, models: Models) -> tuple[Caveat, ...]:
    """What makes the view of a simulator incomplete."""
    return (*_of_models(models), *_of_worlds(graph, models))


def _of_models(models: Models) -> Iterator[Caveat]:
    """Plugins of a spawned model are nodes, which a robot brings with it."""
    for it in models.lost[:1]:
        text = "nodes that plugins of a spawned model make are not known: its description is not"
        yield Caveat(NOT_WHOLE, True, f"{it.place}: {text}")
    unknown = [name for it in models.found if it.spawned for _, name in it.reading.unknown]
    if unknown:
        listed = shorten(list(dict.fromkeys(unknown)), SEVERAL)
        text = f"what these plugins of spawned models start is not known: {listed}"
        yield Caveat(NOT_KNOWN, True, f"{text}; describe them (docs/add-a-plugin.md)")


def _of_worlds(graph: LaunchGraph, models: Models) -> Iterator[Caveat]:
    """A world may have robots in it, which nobody spawns."""
    alone = not models.lost and not any(it.spawned for it in models.found)
    for it in graph.nodes:
        for file in world_files(it):
            why = "" if NOT_INSTALLED in file else _unknown_in(file, alone)
            if why:
                yield Caveat(NOT_WHOLE, True, f"{it.place}: the world {file} {why}")


def _unknown_in(file: str, alone: bool) -> str:
    if not os.path.isfile(file):
        return "is not here, so what its models send is not known" if os.path.isabs(file) else ""
    with suppress(InputError):
        root = read_xml(read_file(file), file)
        moved = any(True for model in root.iter("model") for _ in model.iter("plugin"))
        if moved or (alone and any(True for _ in root.iter("include"))):
            return "has models of its own: what they send is not known"
    return ""
