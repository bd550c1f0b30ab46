# SPDX-License-Identifier: Apache-2.0
"""What vendors' and our files say, as rows of data that can be compared: where, and which value.

It knows nothing of the project: parameters are merged as rcl does it, descriptions are read as XML.
"""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from collections.abc import Iterable, Iterator, Mapping
from itertools import pairwise
from typing import Any

import yaml

from multibot_rewrite.base.rosnames import BoundNode, resolve_bound

Rows = dict[str, str]
# The topic of a display, a tool or a panel.
_GROUP, _ROBOT = "rviz_common/Group", re.compile(r"robot\d")
_TOPIC = re.compile(r"(^|[. ])Topic(\.Value)?$")
_SPACE = re.compile(r"\s+")
_ARGUMENT = re.compile(r"([^@]+)@([^@\[\]]+)([@\[\]])(.+)")
_WAYS = {"[": "GZ_TO_ROS", "]": "ROS_TO_GZ", "@": "BIDIRECTIONAL"}


class Merging(yaml.SafeLoader):
    """A loader for which a key that comes twice has the entries of both, as in rcl's parser."""


def _merged(loader: yaml.SafeLoader, node: yaml.MappingNode) -> dict[Any, Any]:
    found: dict[Any, Any] = {}
    for key_node, value_node in node.value:
        key = loader.construct_object(key_node, deep=True)
        value = loader.construct_object(value_node, deep=True)
        both = isinstance(value, dict) and isinstance(found.get(key), dict)
        found[key] = {**found[key], **value} if both else value
    return found


def _listed(loader: yaml.SafeLoader, node: yaml.SequenceNode) -> list[Any]:
    return loader.construct_sequence(node, deep=True)


Merging.add_constructor("tag:yaml.org,2002:map", _merged)
# launch writes lists of parameters so.
Merging.add_constructor("tag:yaml.org,2002:python/tuple", _listed)


def load(text: str) -> Any:
    """Return the data of a YAML text."""
    return yaml.load(text, Merging)


def description_rows(text: str, robot: str, frame_prefix: str = "") -> Rows:
    """Return a row for every attribute and text. Elements go by their names without the robot's,
    elements that only have a text go together. ``frame_prefix`` is put in front of links, as
    robot_state_publisher does it."""
    root = ET.fromstring(text)
    for tag, key in (("link", "name"), ("parent", "link"), ("child", "link")):
        for it in root.iter(tag) if frame_prefix else ():
            it.set(key, frame_prefix + it.get(key, ""))
    found: Rows = {}
    _element(root, root.tag, robot, found)
    return found


def _element(it: ET.Element, at: str, robot: str, found: Rows) -> None:
    found |= {f"{at}@{key}": _plain(value) for key, value in it.attrib.items()}
    if it.text and it.text.strip():
        found[at] = _plain(it.text)
    seen: dict[str, int] = {}
    leaves: dict[str, list[str]] = {}
    for child in it:
        if not len(child) and not child.attrib:
            leaves.setdefault(child.tag, []).append(_plain(child.text or ""))
            continue
        name = _bare(child.get("name") or child.get("reference") or "", robot)
        key = f"{child.tag}[{name}]" if name else child.tag
        seen[key] = seen.get(key, 0) + 1
        count = f"#{seen[key]}" if seen[key] > 1 else ""
        _element(child, f"{at}/{key}{count}", robot, found)
    found |= {f"{at}/{tag}": " | ".join(sorted(texts)) for tag, texts in leaves.items()}


def _plain(text: str) -> str:
    words = _SPACE.sub(" ", text).strip()
    try:
        return " ".join(f"{float(it):.9g}" for it in words.split())
    except ValueError:
        return words


def _bare(name: str, robot: str) -> str:
    """Return a name without the robot's in front or behind."""
    return re.sub(rf"^{robot}[/_]|[/_]{robot}$", "", name)


def parameter_rows(texts: Iterable[str], node: str) -> Rows:
    """Return the parameters of a node by several files, the last that says it counts."""
    found: Rows = {}
    for text in texts:
        for pattern, values in _sections(load(text), ""):
            if _matches(pattern, node):
                found |= dict(flat(values, ""))
    return found


def _sections(content: Any, at: str) -> Iterator[tuple[str, Any]]:
    for key, value in content.items() if isinstance(content, Mapping) else ():
        if key == "ros__parameters":
            yield at, value
        else:
            yield from _sections(value, f"{at}/{str(key).strip('/')}")


def _matches(pattern: str, node: str) -> bool:
    words = {"**": r"(/\w+)*", "*": r"/\w+"}
    parts = (words.get(it, f"/{re.escape(it)}") for it in pattern.strip("/").split("/"))
    return bool(re.fullmatch("".join(parts), node))


def flat(value: Any, at: str) -> Iterator[tuple[str, str]]:
    """Every value with the path of keys to it; a list of simple values is one."""
    if isinstance(value, Mapping):
        for key, it in value.items():
            yield from flat(it, f"{at}.{key}" if at else str(key))
    elif isinstance(value, list) and any(isinstance(it, (dict, list)) for it in value):
        for index, it in enumerate(value):
            yield from flat(it, f"{at}[{index}]")
    else:
        yield at, str(value)


def rviz_rows(text: str, bound: BoundNode, robot: str) -> Rows:
    """Return what an RViz config shows of a robot: displays and tools by class and name, topics
    as they are called in the graph; ``bound`` is its rviz2. A window for all robots has a group
    for each."""
    data = load(text) or {}
    manager = data.get("Visualization Manager", {})
    shown = [part for it in manager.get("Displays", ()) for part in _dissolved(it, robot)]
    tools = [it for it in manager.get("Tools") or () if _is_of(it, robot)]
    manager |= {"Displays": shown, "Tools": tools}
    found = dict(flat(_by_name(data), ""))
    topics = {at for at, it in found.items() if _TOPIC.search(at) and it not in ("", "None")}
    return found | {at: resolve_bound(found[at], "topic", bound) for at in topics}


def _dissolved(display: dict[str, Any], robot: str) -> list[dict[str, Any]]:
    """Return the displays of the robot's group, none of another robot's, any other display itself."""
    name = str(display.get("Name"))
    if display.get("Class") != _GROUP or not _ROBOT.fullmatch(name):
        return [display]
    return list(display["Displays"]) if name == robot else []


def _is_of(tool: Any, robot: str) -> bool:
    """Is it a tool that names no other robot?"""
    heads = {str(it).strip("/").partition("/")[0] for _, it in flat(tool, "")}
    return heads.isdisjoint({it for it in heads if _ROBOT.fullmatch(it)} - {robot})


def _by_name(value: Any) -> Any:
    """Return lists of displays and tools as maps; groups of one name are one."""
    if isinstance(value, dict):
        return {key: _by_name(it) for key, it in value.items()}
    if not isinstance(value, list) or not all(
        isinstance(it, dict) and "Class" in it for it in value
    ):
        return value
    found: dict[str, Any] = {}
    for it in value:
        key = f"{it['Class']}[{it.get('Name', '')}]"
        found[key] = _both(found[key], _by_name(it)) if key in found else _by_name(it)
    return found


def _both(one: Any, other: Any) -> Any:
    if not isinstance(one, dict) or not isinstance(other, dict):
        return one
    return {
        **other,
        **{key: _both(it, other[key]) if key in other else it for key, it in one.items()},
    }


def bridge_rows(text: str) -> Iterator[tuple[str, str]]:
    """Yield the ROS topics of a bridge's file, each with what it passes on."""
    for it in load(text) or ():
        topic = it.get("ros_topic_name") or it.get("topic_name")
        gz = it.get("gz_topic_name") or it.get("topic_name")
        types = f"{it.get('ros_type_name')} {it.get('gz_type_name')}"
        yield topic, f"{gz} {types} {it.get('direction', 'BIDIRECTIONAL')}"


def bridge_argument(word: str) -> tuple[str, str] | None:
    """Return the same of an argument of a bridge; None for another one."""
    found = _ARGUMENT.fullmatch(word)
    if found is None:
        return None
    topic, ros, way, gz = found.groups()
    return topic, f"{topic} {ros} {gz} {_WAYS[way]}"


def static_edge(words: list[str]) -> str:
    """Return the transform of a static_transform_publisher, by its arguments."""
    given = dict(pairwise(words))
    if "--frame-id" in given:
        return f"{given['--frame-id']} -> {given.get('--child-frame-id', '')}"
    return " -> ".join(words[-2:])
