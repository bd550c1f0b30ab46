# SPDX-License-Identifier: Apache-2.0
"""The interfaces of ros2_control in a launch: what managers export, what spawned controllers claim."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.rosnames import expand
from multibot_rewrite.description.readback.xml import read_xml
from multibot_rewrite.knowledge.records import MANAGER
from multibot_rewrite.producers.evidence.hardware import claims_of, exported
from multibot_rewrite.producers.launch.launched import file_of
from multibot_rewrite.producers.launch.records import LaunchGraph
from multibot_rewrite.spelling.records import Run
from multibot_rewrite.system.records import CLAIMS, EXPORTS, Interface

_DESCRIPTION = "robot_description"


def interfaces_of(
    nodes: Iterable[Run], published: Mapping[str, str], graph: LaunchGraph
) -> Iterator[Interface]:
    """Of controllers whose manager has a known description; ``published`` is what each topic has."""
    nodes = [*nodes]
    texts = {it.full_name: _description(it, published) for it in nodes if is_manager(it)}
    for manager, text in texts.items():
        yield from _exports(manager, text, graph)
    known = {it.process for it in nodes if texts.get(it.full_name)}
    for it in nodes:
        if it.process in known and it.fact.is_controller:
            yield from _claims(it)


def is_manager(it: Run) -> bool:
    """Is it a controller manager?"""
    return it.fact.known == MANAGER


def _description(it: Run, published: Mapping[str, str]) -> str:
    """What a manager has as its parameter, else on the topic that it reads."""
    given = it.values.get(_DESCRIPTION)
    if given and isinstance(given.value, str) and "<robot" in given.value[:4096]:
        text = given.value
        if "<robot/>" not in text:
            return text
    rules = {old.lstrip("/~"): new for old, new in it.rules}
    topic = rules.get(_DESCRIPTION, _DESCRIPTION)
    return published.get(expand(topic, it.namespace, it.name), "")


def _exports(manager: str, text: str, graph: LaunchGraph) -> Iterator[Interface]:
    if not text:
        return
    try:
        root = read_xml(text.encode(), "")
    except InputError:
        return
    for it in exported(root, file_of(graph, text)):
        yield Interface(it.kind, it.name, manager, EXPORTS, it.place)


def _claims(it: Run) -> Iterator[Interface]:
    for claim in claims_of(it.fact.claims, it):
        place = claim.place if claim.place and claim.place.file else it.place
        yield Interface(claim.kind, claim.name, it.full_name, CLAIMS, place)
