# SPDX-License-Identifier: Apache-2.0
"""A launch file in XML or YAML -> its elements, alike for both.

Source: launch jazzy, launch_xml and launch_yaml, entity.py and parser.py.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from lxml import etree

from multibot_rewrite.base.bounded import load_yaml, read_bytes

_SEPARATOR, _CHILDREN = "-sep", "children"


class Entity:
    """An element of a launch file: its values and the entities below it, which a reader takes away."""

    def __init__(self, tag: str, values: dict[str, Any], below: list[Entity]) -> None:
        self.tag, self.values, self.below = tag, values, below

    def take(self, name: str) -> Any:
        """A value; raises AttributeError where it is not there."""
        if name not in self.values:
            raise AttributeError(f"Attribute {name!r} not found in Entity {self.tag!r}")
        return self.values.pop(name)

    def all(self, tag: str) -> list[Entity]:
        """The entities of a tag below this one."""
        found = [it for it in self.below if it.tag == tag]
        self.below = [it for it in self.below if it.tag != tag]
        return found

    def check(self) -> None:
        """Raise ValueError for what nobody took."""
        if self.below:
            tags = {it.tag for it in self.below}
            raise ValueError(f"Unexpected nested tag(s) found in `{self.tag}`: {tags}")
        if self.values:
            names = set(self.values)
            raise ValueError(f"Unexpected attribute(s) found in `{self.tag}`: {names}")


def _of_xml(element: etree._Element) -> Entity:
    values = {str(key): str(value) for key, value in element.attrib.items()}
    for name in [it for it in values if f"{it}{_SEPARATOR}" in values]:
        values[name] = values[name].split(values.pop(f"{name}{_SEPARATOR}"))  # type: ignore[assignment]
    below = [_of_xml(it) for it in element if isinstance(it.tag, str)]
    return Entity(str(element.tag), values, below)


def _of_yaml(tag: str, data: Any) -> Entity:
    if isinstance(data, list):
        return Entity(tag, {}, [*_in_list(data)])
    if not isinstance(data, Mapping):
        raise TypeError(f"Expected a dict or list, got {type(data)}")
    lists = {key: it for key, it in data.items() if _is_of_entities(it)}
    values = {str(key): it for key, it in data.items() if key not in lists}
    below = [*_in_list(lists.pop(_CHILDREN, ()))]
    own = [_of_yaml(str(key), one) for key, it in lists.items() for one in it]
    return Entity(tag, values, [*own, *below])


def _is_of_entities(it: Any) -> bool:
    return isinstance(it, list) and bool(it) and isinstance(it[0], Mapping)


def _in_list(data: Sequence[Any]) -> Iterator[Entity]:
    for it in data:
        if not isinstance(it, Mapping) or len(it) != 1:
            one = "a dictionary with only one key, which is the entity type"
            raise RuntimeError(f"Subentities must be {one}")
        yield from (_of_yaml(str(key), value) for key, value in it.items())


def root_of(path: str) -> Entity:
    """The root of a launch file; raises what launch raises for another file."""
    data = read_bytes(path)
    if data.lstrip().startswith(b"<"):
        root = _of_xml(etree.fromstring(data, etree.XMLParser(resolve_entities=False)))
    else:
        ((tag, body),) = (load_yaml(data.decode()) or {"": []}).items()
        root = _of_yaml(str(tag), body)
    if root.tag != "launch":
        raise RuntimeError("Expected 'launch' as root tag")
    return root
