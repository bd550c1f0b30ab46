"""Rows of a ros_gz_bridge file against the gz topics that a robot's sensors and plugins send."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import yaml

from multibot_rewrite.closure.gap import Gap
from multibot_rewrite.companions.yaml_text import YamlText, items, line_of, pairs
from multibot_rewrite.evidence.records import Place
from multibot_rewrite.nearest import nearest

GZ_TOPIC = "gz topic"
# Keys of a row that name the gz side, in the order in which ros_gz_bridge looks at them.
_GZ, _BOTH, _TYPE, _WAY, _IN = (
    "gz_topic_name",
    "topic_name",
    "gz_type_name",
    "direction",
    "GZ_TO_ROS",
)


def bridge_gaps(document: YamlText, sent: Mapping[str, str]) -> Iterator[Gap]:
    """Rows that read a gz topic which is not ``sent`` (topic -> gz type), although another one of
    their type is: what sends topics of other types is not known."""
    for at, row in enumerate(items(document.root)):
        found = {key.value: value for key, value in pairs(row)}
        words = {key: it.value for key, it in found.items() if isinstance(it, yaml.ScalarNode)}
        name = found.get(_GZ) or found.get(_BOTH)
        if name is None or words.get(_WAY) != _IN:
            continue
        topic = f"/{str(name.value).lstrip('/')}"
        alike = [it for it, type_ in sent.items() if type_ == words.get(_TYPE)]
        if alike and topic not in sent:
            near = alike[0] if len(alike) == 1 else nearest(topic, alike)
            place = Place(document.file, line_of(name))
            yield Gap(GZ_TOPIC, topic, "ros_gz_bridge", (GZ_TOPIC, str(at)), place, near)
