"""Ends of one topic inside a description that no longer meet after a rewrite: two that were equal have
to stay equal."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping

from multibot_rewrite.description.readback.reading import Reading, RuntimeName
from multibot_rewrite.system.records import SERVICE, TOPIC

# The element of a name, its parameter, and the how manieth it is there.
Place = tuple[str, int, str, str, int]


def parted(before: Reading, after: Reading) -> Iterator[tuple[RuntimeName, RuntimeName]]:
    """Each end that lost the first of those that it met, with that one, as they are now."""
    now = _by_place(after.names)
    of_topic: dict[tuple[str, str], list[Place]] = defaultdict(list)
    for place, name in _by_place(before.names).items():
        if place in now:
            of_topic[name.kind, name.name].append(place)
    for places in of_topic.values():
        first = now[places[0]]
        yield from ((now[it], first) for it in places[1:] if now[it].name != first.name)


def _by_place(names: Iterable[RuntimeName]) -> Mapping[Place, RuntimeName]:
    found: dict[Place, RuntimeName] = {}
    seen: Counter[tuple[str, int, str, str]] = Counter()
    for it in names:
        if it.kind in (TOPIC, SERVICE) and not it.of_controllers:
            place = it.tag, it.number, it.path, it.kind
            found[(*place, seen[place])] = it
            seen[place] += 1
    return found
