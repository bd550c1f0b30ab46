"""Rows of a ros_gz_bridge file as the bridge reads them.

Source: gazebosim/ros_gz ros_gz_bridge/src/bridge_config.cpp (parseEntry, and its messages).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import yaml

from multibot_rewrite.companions.bridge_entry import BOTH, DIRECTIONS, GZ, KEYS, ROS, SERVICE, TYPES
from multibot_rewrite.companions.yaml_text import items, pairs
from multibot_rewrite.lint.beside.records import Beside, Remark
from multibot_rewrite.nearest import did_you_mean, did_you_mean_one_of

_TOPICS = (BOTH, ROS, GZ)


def faulty_rows(beside: Beside) -> Iterator[Remark]:
    """What is wrong with the rows of a file."""
    for row in items(beside.document.root):
        below = {str(key.value): (key, value) for key, value in pairs(row)}
        if not below:
            continue
        for name, (key, _) in below.items():
            near = did_you_mean(name, KEYS) if name not in KEYS else ""
            if near:
                yield Remark(key, f"the bridge knows no {name!r}", near)
        for other in (ROS, GZ) if BOTH in below else ():
            if other in below:
                message = f"the row has {BOTH} and {other}: the bridge leaves it out"
                yield Remark(below[other][0], message, f"delete {BOTH}")
        yield from _direction(below)
        lacks = _lacks(below)
        if lacks:
            yield Remark(row, f"the row has no {lacks}: the bridge leaves it out")


def _direction(below: Mapping[str, tuple[yaml.ScalarNode, yaml.Node]]) -> Iterator[Remark]:
    value = below["direction"][1] if "direction" in below else None
    if isinstance(value, yaml.ScalarNode) and value.value not in DIRECTIONS:
        hint = did_you_mean_one_of(str(value.value), DIRECTIONS)
        yield Remark(value, f"the bridge has no direction {value.value!r}", hint)


def _lacks(below: Mapping[str, object]) -> str:
    """What the bridge asks of a row of topics."""
    if SERVICE in below:
        return ""
    if not any(it in below for it in _TOPICS):
        return "topic_name"
    return next((it for it in TYPES if it not in below), "")
