# SPDX-License-Identifier: Apache-2.0
"""The latched descriptions of a graph, read for what they name; the function that subscribes is passed
in."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial

from multibot_rewrite.producers.ros.headers import Subscribe
from multibot_rewrite.producers.ros.tf_subscriptions import Mark
from multibot_rewrite.producers.zenoh.cdr import read_text
from multibot_rewrite.system.records import PUBLISHES, TOPIC, Description, End
from multibot_rewrite.system.words import is_description

# A subscription costs a few milliseconds.
MOST_TOPICS = 200


class DescriptionSamples:
    """Subscriptions to the topics of descriptions, each until one has come."""

    def __init__(self, subscribe: Subscribe) -> None:
        self._subscribe = subscribe
        self._open: dict[str, Callable[[], None]] = {}
        self._asked: set[str] = set()
        self._found: dict[str, Description] = {}

    def update(self, endpoints: Iterable[End]) -> None:
        """Subscribe to every such topic that was not there before, as its publisher offers it."""
        for it in endpoints:
            sent = (it.kind, it.role) == (TOPIC, PUBLISHES) and is_description(it.name, it.type)
            if sent and it.name not in self._asked and len(self._asked) < MOST_TOPICS:
                self._asked.add(it.name)
                # What nobody reads was not asked for its QoS: nearly all are latched.
                latched = not (it.qos and it.qos.durability == "VOLATILE")
                end = self._subscribe(it.name, it.type, latched, partial(self._receive, it.name))
                if end:
                    self._open[it.name] = end

    def _receive(self, topic: str, data: bytes, _: Mark = None) -> None:
        text = read_text(data)
        if text is not None:
            self._found[topic] = described(topic, text)
            self._open.pop(topic)()

    def found(self) -> tuple[Description, ...]:
        """Return what has come, by topic."""
        return tuple(self._found[it] for it in sorted(self._found))


def described(topic: str, text: str) -> Description:
    """Return what a URDF names; an empty description for no URDF."""
    from lxml import etree  # takes longer than the rest of a look's start

    parser = etree.XMLParser(resolve_entities=False, no_network=True)
    try:
        root = etree.fromstring(text.encode(), parser)
    except (etree.XMLSyntaxError, ValueError):
        return Description(topic)
    links = tuple(it.get("name", "") for it in root.iterfind("link"))
    moving = (it for it in root.iterfind("joint") if it.get("type") != "fixed")
    return Description(topic, links, tuple(it.get("name", "") for it in moving))
