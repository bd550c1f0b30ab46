# SPDX-License-Identifier: Apache-2.0
"""Several endpoints in a graph that are one in a node's code: an action, an image, a known part."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping

from multibot_rewrite.base.conventions import CLOCK
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.knowledge.records import TRANSPORTS, Endpoint
from multibot_rewrite.system.records import ACTION, CALLS, PUBLISHES, SERVES, SERVICE, TOPIC

IMAGE = "sensor_msgs/msg/Image"
_HIDDEN = "/_action/"
_SEND_GOAL = "_SendGoal"


class EndpointId(NamedTuple):
    """One endpoint of a node; ``name`` is fully qualified."""

    kind: str
    role: str
    name: str


# The types of each endpoint, sorted.
Seen = Mapping[EndpointId, tuple[str, ...]]


def fold_actions(seen: Seen) -> dict[EndpointId, tuple[str, ...]]:
    """``seen`` with an action in place of the services and topics it is made of.

    A node with only the topics of an action is not its client: those topics stay.
    """
    actions = _actions(seen)
    whole = {(key.role, key.name) for key in actions}
    rest = {
        key: types
        for key, types in seen.items()
        if key.kind != ACTION and (_HIDDEN not in key.name or _action_of(key) not in whole)
    }
    return {**actions, **rest}


def _action_of(key: EndpointId) -> tuple[str, str]:
    """Role and name of the action that a hidden endpoint belongs to."""
    role = SERVES if key.role in (SERVES, PUBLISHES) else CALLS
    return role, key.name.partition(_HIDDEN)[0]


def _actions(seen: Seen) -> dict[EndpointId, tuple[str, ...]]:
    kinds = defaultdict(set)
    found = {}
    for key, types in seen.items():
        if _HIDDEN in key.name:
            kinds[_action_of(key)].add(key.kind)
        if key.kind == SERVICE and key.name.endswith(f"{_HIDDEN}send_goal") and types:
            whole = tuple(type_.removesuffix(_SEND_GOAL) for type_ in types)
            found[EndpointId(ACTION, *_action_of(key))] = whole
    listed = {key: types for key, types in seen.items() if key.kind == ACTION and types}
    # rcl lists every subscriber of the feedback as a client.
    only_topics = {key for key in listed if kinds.get((key.role, key.name)) == {TOPIC}}
    return found | {key: types for key, types in listed.items() if key not in only_topics}


def fold_images(seen: Seen) -> tuple[dict[EndpointId, tuple[str, ...]], frozenset[EndpointId]]:
    """``seen`` without the topics of image_transport, and the images that had such topics."""
    images: dict[EndpointId, set[EndpointId]] = {}
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
    """``endpoints`` without those of complete parts, and the names of these parts.

    With ``in_root`` the graph name ``/x`` may be ``x`` in the code.
    """
    left = {_signature(end, end.name): end for end in endpoints}
    complete = []
    for name, part in parts.items():
        wanted = [_signatures(end, in_root) for end in part if end.name != CLOCK]
        if all(any(it in left for it in variants) for variants in wanted):
            complete.append(name)
            for end in part:
                for signature in _signatures(end, in_root):
                    left.pop(signature, None)
    return list(left.values()), tuple(complete)


_Signature = tuple[str, str, str, str, tuple[str, ...], bool]


def _signatures(end: Endpoint, in_root: bool) -> list[_Signature]:
    """How an endpoint of a part may appear in the graph."""
    relative = end.name[0] not in "/~"
    names = [end.name, f"/{end.name}"] if in_root and relative else [end.name]
    return [_signature(end, name) for name in names]


def _signature(end: Endpoint, name: str) -> _Signature:
    return end.kind, end.role, name, end.type, end.also, end.helper
