# SPDX-License-Identifier: Apache-2.0
"""Rows of a ros_gz_bridge file as the bridge reads them, and the gz topics of a robot.

Source: gazebosim/ros_gz ros_gz_bridge/src/bridge_config.cpp (parseEntry, and its messages).
"""

from collections.abc import Iterator, Mapping
from typing import NamedTuple

import yaml

from multibot_rewrite.base.findings.finding import WARNING, Finding, rule
from multibot_rewrite.base.nearest import SLIP, did_you_mean, nearest
from multibot_rewrite.planning.bridge_rows import bridge_data
from multibot_rewrite.related_files.bridge import (
    BOTH,
    DIRECTIONS,
    GZ,
    KEYS,
    SERVICE,
    TYPES,
    Row,
    faults,
    models,
    row_of,
    text_in,
)
from multibot_rewrite.related_files.named_file import BRIDGE, NamedFile
from multibot_rewrite.related_files.yaml_text import items
from multibot_rewrite.rules.declaration import remark_at, robots_rule
from multibot_rewrite.rules.files.section_facts import did_you_mean_at
from multibot_rewrite.system.records import NOWHERE, Place

_BOTH_WAYS, _IN = DIRECTIONS[:2]


@rule("MB855", "bridge-row", WARNING, formats=(BRIDGE,))
def bridge_row(file: NamedFile) -> Iterator[Finding]:
    """Report each fault of each row, and a file that is no list of rows."""
    root = file.document.root if file.document else None
    if isinstance(root, yaml.MappingNode):
        hint = "write '- ' before it"
        yield remark_at(root, "the file is no list of rows: none is bridged", hint)
    for node in _bridge_rows(file):
        yield from (remark_at(*fault) for fault in faults(node))


def _bridge_rows(file: NamedFile) -> list[yaml.Node]:
    return items(file.document.root) if file.document else []


@rule("MB858", "bridge-key", WARNING, formats=(BRIDGE,))
def bridge_key(file: NamedFile) -> Iterator[Finding]:
    """Report unknown keys of each row."""
    for row in map(row_of, _bridge_rows(file)):
        for name, (key, _) in row.items():
            if name not in KEYS:
                message = f"the bridge knows no {name!r}, and ignores it"
                yield remark_at(key, message, did_you_mean(name, KEYS) or "delete it")


@rule("MB874", "bridge-types-not-converted", WARNING, formats=(BRIDGE,))
def not_converted(file: NamedFile) -> Iterator[Finding]:
    """Report rows whose types do not belong together."""
    known: Mapping[str, list[str]] = bridge_data()["pairs"]
    for node in _bridge_rows(file):
        ros, gz = (text_in(row_of(node), key) for key in TYPES)
        bare, belongs = _without_package(gz), known.get(ros, ())
        others = [it for it, types in known.items() if bare in types]
        cased = (it for it in known if it.lower() == ros.lower())
        alike = "" if ros in known else next(cased, nearest(ros, known, SLIP))
        if alike:
            yield remark_at(node, f"there is no type {ros!r}", f"did you mean {alike!r}?")
        # A gz type of a package that there is not.
        if others and gz not in (f"gz.msgs.{bare}", f"ignition.msgs.{bare}"):
            yield remark_at(node, f"there is no gz type {gz!r}", f"write gz.msgs.{bare}")
        near = "" if others else nearest(bare, belongs, SLIP)
        if near:
            yield remark_at(node, f"there is no gz type {gz!r}", f"did you mean gz.msgs.{near}?")
        if belongs and others and bare not in belongs:
            message = f"{ros} and {gz} are not converted into each other"
            yield remark_at(node, message, f"with {gz} write {' or '.join(others)}")


@robots_rule("MB889", "bridge-of-second-model", WARNING, BRIDGE)
def second_model(file: NamedFile) -> Iterator[Finding]:
    """Report each other model than the first, at its first entry."""
    first: dict[str, yaml.Node] = {}
    for node, name in models(file.document, file.context) if file.document else ():
        first.setdefault(name, node)
    own, *others = first or ("",)
    for name in others:
        message = f"model {name!r} is not the robot's model {own!r}"
        hint = "its topics stay as they are and are bridged once for all robots"
        yield remark_at(first[name], message, hint)


@robots_rule("MB890", "bridge-not-per-robot", WARNING, BRIDGE)
def shared_service(file: NamedFile) -> Iterator[Finding]:
    """Report services that one row bridges for all robots, unless they are the world's."""
    for node in _bridge_rows(file):
        service = text_in(row_of(node), SERVICE)
        if service and not service.strip("/").startswith("world/") and not any(faults(node)):
            message = f"service {service!r} is bridged once for all robots"
            yield remark_at(node, message, "add an entry for each robot")


# What a world's own systems send is below its name.
_WORLD = "/world/"


class GzTopics(NamedTuple):
    """The gz topics of the robot's sensors and plugins, and of its world, by name."""

    topics: "Mapping[str, GzTopic]"


class GzTopic(NamedTuple):
    """A sensor's or plugin's topic: type, direction of its row, line; empty where unknown."""

    type: str
    direction: str
    place: Place = NOWHERE


@rule("MB879", "bridge-row-without-gz-topic", WARNING, formats=(BRIDGE,), options={"build": True})
def no_gz_topic(file: NamedFile) -> Iterator[Finding]:
    """Report rows whose gz topic the description has with another type or direction, or lacks.

    A missing one only if it is read and another of its type exists: senders of other types are
    unknown."""
    known: GzTopics | None = file.memo.get(GzTopics)
    for row in map(row_of, _bridge_rows(file) if known else ()):
        _, node = row.get(GZ) or row.get(BOTH) or (None, None)
        if node is not None and known is not None:
            yield from _topic_faults(node, row, known.topics)


def _topic_faults(node: yaml.Node, row: Row, topics: Mapping[str, GzTopic]) -> Iterator[Finding]:
    """Yield what is wrong with the gz topic at a node, of one row."""
    topic = f"/{str(node.value).lstrip('/')}"
    way, type_ = text_in(row, "direction") or _BOTH_WAYS, _without_package(text_in(row, TYPES[1]))
    own = topics.get(topic)
    if own is None:
        incoming = [
            it
            for it, its in topics.items()
            if its.direction == _IN == way and it.startswith(_WORLD) == topic.startswith(_WORLD)
        ]
        alike = [it for it in incoming if _without_package(topics[it].type) == type_]
        near = alike[0] if len(alike) == 1 else nearest(topic, alike)
        hint = did_you_mean_at(near, topics[near].place) if near else "name one that is there"
        if alike:
            yield remark_at(node, f"nothing sends gz topic {topic}, which the row reads", hint)
    elif own.direction and way not in (own.direction, _BOTH_WAYS):
        message = f"gz topic {topic} is in the other direction in the description"
        yield remark_at(node, message, _write(own.direction, own))
    elif type_ and own.type and type_ != _without_package(own.type):
        message = f"gz topic {topic} has another type in the description"
        yield remark_at(node, message, _write(own.type, own))


def _write(word: str, topic: GzTopic) -> str:
    """Return the hint to write a value of the description's topic, with the topic's place."""
    return f"write {word}" + (f", see {topic.place}" if topic.place != NOWHERE else "")


def _without_package(type_: str) -> str:
    """Return the message type without its package, which had another name before Garden."""
    return type_.rpartition("msgs.")[2]
