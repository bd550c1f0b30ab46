"""Rows of a ros_gz_bridge file against the gz topics of a robot's sensors and plugins."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import yaml

from multibot_rewrite.base.nearest import nearest
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.companions.yaml_text import YamlText, items, line_of, pairs
from multibot_rewrite.rules.closure.gap import Gap
from multibot_rewrite.system.records import Place

GZ_TOPIC, GZ_TYPE, GZ_WAY = "gz topic", "gz type", "gz direction"
# Keys of a row that name the gz side, in the order in which ros_gz_bridge looks at them.
_GZ, _BOTH, _TYPE, _WAY, _IN, _BOTH_WAYS = (
    "gz_topic_name",
    "topic_name",
    "gz_type_name",
    "direction",
    "GZ_TO_ROS",
    "BIDIRECTIONAL",
)


class GzTopic(NamedTuple):
    """A topic of a sensor or plugin: its type, the direction of a row for it, and its line."""

    type: str
    direction: str
    place: Place | None = None


def bridge_gaps(document: YamlText, topics: Mapping[str, GzTopic]) -> Iterator[Gap]:
    """Rows for a gz topic of the description with another type or direction, and rows that read one
    which is not there, although another one of their type is: what sends topics of other types is not
    known."""
    for at, row in enumerate(items(document.root)):
        found = {key.value: value for key, value in pairs(row)}
        name = found.get(_GZ) or found.get(_BOTH)
        if name is not None:
            words = {
                key: str(it.value) for key, it in found.items() if isinstance(it, yaml.ScalarNode)
            }
            place = Place(document.file, line_of(name))
            topic = f"/{str(name.value).lstrip('/')}"
            yield from _of_row(topic, words, topics, str(at), place)


def _of_row(
    topic: str, row: Mapping[str, str], topics: Mapping[str, GzTopic], at: str, place: Place
) -> Iterator[Gap]:
    own, type_, way = topics.get(topic), _bare(row.get(_TYPE, "")), row.get(_WAY, _BOTH_WAYS)
    if own is None:
        alike = [key for key, it in topics.items() if it.direction == _IN == way]
        alike = [it for it in alike if _bare(topics[it].type) == type_]
        if alike:
            near = alike[0] if len(alike) == 1 else nearest(topic, alike)
            where = topics[near].place if near else None
            yield Gap(GZ_TOPIC, topic, "ros_gz_bridge", (GZ_TOPIC, at), place, near, where)
    elif way not in (own.direction, _BOTH_WAYS):
        key = (GZ_WAY, at)
        yield Gap(GZ_WAY, topic, "ros_gz_bridge", key, place, own.direction, own.place)
    elif type_ and type_ != _bare(own.type):
        yield Gap(GZ_TYPE, topic, "ros_gz_bridge", (GZ_TYPE, at), place, own.type, own.place)


def _bare(type_: str) -> str:
    """The type without its package, which had another name before Garden."""
    return type_.rpartition("msgs.")[2]
