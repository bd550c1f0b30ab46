# SPDX-License-Identifier: Apache-2.0
"""Robots for RViz configs: a description made up of the names in the file."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from typing import Any

import yaml

from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.related_files.names.rename_map import RelatedNames
from multibot_rewrite.related_files.rviz.read_config import RvizRobot, rviz_data
from multibot_rewrite.related_files.yaml_text import YamlText, pairs

Declared = dict[str, dict[str, Any]]
MAPS = {"Frames": "link", "Links": "link", "Joints": "joint"}


def declared(document: YamlText) -> Declared:
    """Return what a description of the robot in the file would declare."""
    found: Declared = defaultdict(dict, {"link": {}, "joint": {}})
    for kind, name in _names(document.root):
        if name not in rviz_data()["fixed_keys"]:
            found[kind][name] = None
    return found


def _names(node: yaml.Node | None) -> Iterator[tuple[str, str]]:
    for key, value in pairs(node):
        if key.value in MAPS:
            yield from ((MAPS[key.value], name.value) for name, _ in pairs(value))
        yield from _names(value)
    for item in node.value if isinstance(node, yaml.SequenceNode) else ():
        yield from _names(item)


def robots_of(names: Declared, layout: str, robots: Sequence[str], **more: Any) -> list[RvizRobot]:
    """Return a robot of this description for each name."""
    naming = make_naming(layout, "postfix" if layout == "L4" else "prefix")
    both = ((name, RelatedNames(names, naming, name)) for name in robots)
    return [RvizRobot(name, it, it, **more) for name, it in both]
