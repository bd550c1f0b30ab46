# SPDX-License-Identifier: Apache-2.0
"""A launch file in XML or YAML -> its elements, alike for both, each with its line.

Source: launch jazzy, launch_xml and launch_yaml, entity.py and parser.py.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import yaml
from lxml import etree

from multibot_rewrite.base.bounded import A_VALUE, compose_yaml, load_yaml
from multibot_rewrite.related_files.yaml_text import line_of

# What is made of an entity has its line in this attribute, where the maker knows it.
LINE = "multibot_line"
_SEPARATOR, _CHILDREN = "-sep", "children"
# What libxml2 says of it, by its release.
_TOO_DEEP = (etree.ErrorTypes.ERR_RESOURCE_LIMIT, etree.ErrorTypes.ERR_INTERNAL_ERROR)


class Entity:
    """An element of a launch file: its values and the entities below it, which a reader takes away."""

    def __init__(self, tag: str, line: int, values: dict[str, Any], below: list[Entity]) -> None:
        self.tag, self.line, self.values, self.below = tag, line, values, below

    def every(self) -> Iterator[Entity]:
        """Yield this entity, and all below it."""
        yield self
        for it in self.below:
            yield from it.every()

    def take(self, name: str) -> Any:
        """Return the value of an attribute and remove it; raises AttributeError without."""
        if name not in self.values:
            raise AttributeError(f"Attribute {name!r} not found in Entity {self.tag!r}")
        return self.values.pop(name)

    def all(self, tag: str) -> list[Entity]:
        """Return the entities of a tag below this one, and remove them."""
        found = [it for it in self.below if it.tag == tag]
        self.below = [it for it in self.below if it.tag != tag]
        return found

    def check(self) -> None:
        """Raise ValueError for attributes that nothing has read."""
        if self.below:
            tags = {it.tag for it in self.below}
            raise ValueError(f"Unexpected nested tag(s) found in `{self.tag}`: {tags}")
        if self.values:
            names = set(self.values)
            raise ValueError(f"Unexpected attribute(s) found in `{self.tag}`: {names}")


def root_of(data: bytes, file: str) -> Entity:
    """Return the root of a launch ``file``; raises what launch raises for another one."""
    if data.lstrip().startswith(b"<"):
        root = _entity_of_xml(_parse_xml(data))
    else:
        node = compose_yaml(data.decode(), file)
        if not isinstance(node, yaml.MappingNode) or len(node.value) != 1:
            raise RuntimeError("Expected only one root")
        ((key, body),) = node.value
        root = _entity_of_yaml(str(key.value), line_of(key), body)
    if root.tag != "launch":
        raise RuntimeError("Expected 'launch' as root tag")
    return root


def _parse_xml(data: bytes) -> etree._Element:
    try:
        return etree.fromstring(data, etree.XMLParser(resolve_entities=False))
    except etree.XMLSyntaxError as error:
        if getattr(error, "code", 0) in _TOO_DEEP:
            raise SyntaxError("elements are nested deeper than in any launch file") from None
        raise


def _entity_of_xml(element: etree._Element) -> Entity:
    values: dict[str, Any] = {str(key): str(value) for key, value in element.attrib.items()}
    for name in [it for it in values if f"{it}{_SEPARATOR}" in values]:
        values[name] = values[name].split(values.pop(f"{name}{_SEPARATOR}"))
    below = [_entity_of_xml(it) for it in element if isinstance(it.tag, str)]
    return Entity(str(element.tag), int(str(element.sourceline or 0)), values, below)


def _entity_of_yaml(tag: str, line: int, node: yaml.Node) -> Entity:
    if isinstance(node, yaml.SequenceNode):
        return Entity(tag, line, {}, [*_entities_in_list(node)])
    if not isinstance(node, yaml.MappingNode):
        raise TypeError(f"Expected a dict or list in {tag!r}")
    values: dict[str, Any] = {}
    own: list[Entity] = []
    below: list[Entity] = []
    for key, value in node.value:
        name = str(key.value)
        if name == _CHILDREN:
            below += _entities_in_list(value)
        elif _is_list_of_maps(value):
            own += [_entity_of_yaml(name, line_of(it), it) for it in value.value]
        else:
            values[name] = _plain(value)
    return Entity(tag, line, values, [*own, *below])


def _is_list_of_maps(node: yaml.Node) -> bool:
    first = node.value[:1] if isinstance(node, yaml.SequenceNode) else []
    return any(isinstance(it, yaml.MappingNode) for it in first)


def _entities_in_list(node: yaml.Node) -> Iterator[Entity]:
    for it in node.value if isinstance(node, yaml.SequenceNode) else ():
        if not isinstance(it, yaml.MappingNode) or len(it.value) != 1:
            one = "a dictionary with only one key, which is the entity type"
            raise RuntimeError(f"Subentities must be {one}")
        yield from (_entity_of_yaml(str(key.value), line_of(key), value) for key, value in it.value)


def _plain(node: yaml.Node) -> Any:
    """Return the value of a node as YAML has it."""
    if isinstance(node, yaml.SequenceNode):
        return [_plain(it) for it in node.value]
    if isinstance(node, yaml.MappingNode):
        return {str(key.value): _plain(it) for key, it in node.value}
    return node.value if node.tag == "tag:yaml.org,2002:str" else load_yaml(node.value, A_VALUE)
