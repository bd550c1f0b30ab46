# SPDX-License-Identifier: Apache-2.0
"""Ends of one topic inside a description that no longer meet after a rewrite: two that were equal have
to stay equal, and what another process makes of a topic's name has to be there still."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping

from multibot_rewrite.description.readback.nodes import SERVICE, TOPIC, RuntimeName
from multibot_rewrite.description.readback.reading import Reading

CAMERA_INFO = "camera_info"
# The element of a name, its parameter, and the how manieth it is there.
Place = tuple[str, int, str, str, int]


def parted(before: Reading, after: Reading) -> Iterator[tuple[RuntimeName, RuntimeName]]:
    """Each end that lost the first of those that it met, with that one, as they are now: what is left
    as it was by the vocabulary counts as well."""
    now = _by_place((*after.names, *after.other_ends))
    of_topic: dict[tuple[str, str], list[Place]] = defaultdict(list)
    for place, name in _by_place((*before.names, *before.other_ends)).items():
        if place in now:
            of_topic[name.kind, name.name].append(place)
    for places in of_topic.values():
        first = now[places[0]]
        yield from ((now[it], first) for it in places[1:] if now[it].name != first.name)


def undescribed(before: Reading, after: Reading) -> Iterator[tuple[RuntimeName, str, str]]:
    """Each image that had its camera_info beside it and has not now, with the name that is asked for
    and the one that it has.

    Who shows an image replaces the last segment of its topic (image_common camera_common.cpp
    getCameraInfoTopic; RViz and image_pipeline subscribe with it).
    """
    now = _by_place(after.names)
    was = _by_place(before.names)
    infos: dict[str, list[Place]] = defaultdict(list)
    for place, name in was.items():
        infos[name.name].append(place)
    new = {it.name for it in now.values()}
    cameras = {(it.tag, it.number) for it in before.names if it.name == _info_of(it.name)}
    for place, name in was.items():
        beside = _info_of(name.name)
        is_camera = name.tag == "sensor" and (name.tag, name.number) in cameras
        is_image = beside != name.name and (is_camera or "image" in name.name)
        info = next((now[it].name for it in infos.get(beside, ()) if it in now), "")
        if is_image and info and place in now and _info_of(now[place].name) not in new:
            yield now[place], _info_of(now[place].name), info


def _info_of(topic: str) -> str:
    return f"{topic.rpartition('/')[0]}/{CAMERA_INFO}"


def _by_place(names: Iterable[RuntimeName]) -> Mapping[Place, RuntimeName]:
    found: dict[Place, RuntimeName] = {}
    seen: Counter[tuple[str, int, str, str]] = Counter()
    for it in names:
        if it.kind in (TOPIC, SERVICE) and not it.of_controllers:
            place = it.tag, it.number, it.path, it.kind
            key = (*place, seen[place])
            found[key] = it
            seen[place] += 1
    return found
