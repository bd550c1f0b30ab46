"""Many endpoints of a graph are one thing in a node's code: an action, an image, a known part."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from typing import NamedTuple

from multibot_rewrite.remap.records import (
    ACTION,
    CALLS,
    PUBLISHES,
    SERVES,
    SERVICE,
    TOPIC,
    Endpoint,
)
from multibot_rewrite.remap.table import TRANSPORTS

IMAGE = "sensor_msgs/msg/Image"
CLOCK = "/clock"
_HIDDEN = "/_action/"
_SEND_GOAL = "_SendGoal"


class Key(NamedTuple):
    """One endpoint of a node; ``name`` is fully qualified."""

    kind: str
    role: str
    name: str


# The types an endpoint was seen with, sorted.
Seen = Mapping[Key, tuple[str, ...]]


def fold_actions(seen: Seen) -> dict[Key, tuple[str, ...]]:
    """``seen`` with an action in place of the services and topics it is made of.

    Who has only topics of an action listens to it, without being its client: those stay topics.
    """
    actions = _actions(seen)
    whole = {(key.role, key.name) for key in actions}
    rest = {
        key: types
        for key, types in seen.items()
        if key.kind != ACTION and (_HIDDEN not in key.name or _owner(key) not in whole)
    }
    return {**actions, **rest}


def _owner(key: Key) -> tuple[str, str]:
    """Role and name of the action that a hidden endpoint belongs to."""
    role = SERVES if key.role in (SERVES, PUBLISHES) else CALLS
    return role, key.name.partition(_HIDDEN)[0]


def _actions(seen: Seen) -> dict[Key, tuple[str, ...]]:
    kinds = defaultdict(set)
    found = {}
    for key, types in seen.items():
        if _HIDDEN in key.name:
            kinds[_owner(key)].add(key.kind)
        if key.kind == SERVICE and key.name.endswith(f"{_HIDDEN}send_goal") and types:
            whole = tuple(type_.removesuffix(_SEND_GOAL) for type_ in types)
            found[Key(ACTION, *_owner(key))] = whole
    told = {key: types for key, types in seen.items() if key.kind == ACTION and types}
    # rcl calls everybody who listens to the feedback a client.
    listens = {key for key in told if kinds.get((key.role, key.name)) == {TOPIC}}
    return found | {key: types for key, types in told.items() if key not in listens}


def fold_images(seen: Seen) -> tuple[dict[Key, tuple[str, ...]], frozenset[Key]]:
    """``seen`` without the topics image_transport makes of an image, and the images that had some."""
    images: dict[Key, set[Key]] = {}
    for key, types in seen.items():
        siblings = {key._replace(name=f"{key.name}/{transport}") for transport in TRANSPORTS}
        if key.kind == TOPIC and types == (IMAGE,) and not siblings.isdisjoint(seen):
            images[key] = siblings
    folded = {key for siblings in images.values() for key in siblings}
    rest = {key: types for key, types in seen.items() if key not in folded}
    return rest, frozenset(images)


def fold_parts(
    endpoints: Iterable[Endpoint], parts: Mapping[str, tuple[Endpoint, ...]], in_root: bool
) -> tuple[list[Endpoint], tuple[str, ...]]:
    """``endpoints`` without those of the parts that are there whole, and the names of these.

    ``in_root`` tells that ``/x`` may be ``x`` in the code.
    """
    left = {_traits(end, end.name): end for end in endpoints}
    whole = []
    for name, part in parts.items():
        wanted = [_wanted(end, in_root) for end in part if end.name != CLOCK]
        if all(any(traits in left for traits in either) for either in wanted):
            whole.append(name)
            for end in part:
                for traits in _wanted(end, in_root):
                    left.pop(traits, None)
    return list(left.values()), tuple(whole)


_Traits = tuple[str, str, str, str, tuple[str, ...], bool]


def _wanted(end: Endpoint, in_root: bool) -> list[_Traits]:
    """What an endpoint of a part may look like."""
    relative = end.name[0] not in "/~"
    spellings = [end.name, f"/{end.name}"] if in_root and relative else [end.name]
    return [_traits(end, name) for name in spellings]


def _traits(end: Endpoint, name: str) -> _Traits:
    return end.kind, end.role, name, end.type, end.also, end.helper
