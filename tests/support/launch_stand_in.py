# SPDX-License-Identifier: Apache-2.0
"""The package's stand-in for launch, with what ``multibot_rewrite.launch`` uses of its XML frontend.

It runs no process, and its XML knows attributes and children, no type but bool and lists of elements.
"""

from __future__ import annotations

import re
import sys
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from typing import Any

import pytest

from multibot_rewrite.producers.launch.stand_in import contents, standing_in
from multibot_rewrite.producers.launch.stand_in.actions import Action
from multibot_rewrite.producers.launch.stand_in.values import (
    IfCondition,
    LaunchConfiguration,
    TextSubstitution,
)

ACTIONS: dict[str, Any] = {}
SUBSTITUTIONS: dict[str, Any] = {
    "var": lambda data: (LaunchConfiguration, {"variable_name": data[0]})
}


def expose_action(name: str) -> Any:
    return lambda exposed: ACTIONS.setdefault(name, exposed)


def expose_substitution(name: str) -> Any:
    return lambda exposed: SUBSTITUTIONS.setdefault(name, exposed)


class Entity:
    """An XML element that knows what was read of it."""

    def __init__(self, xml_element: ET.Element) -> None:
        self.element = xml_element
        self.read: set[str] = set()
        self.children_read = False

    @property
    def type_name(self) -> str:
        return self.element.tag

    @property
    def children(self) -> list[Entity]:
        self.children_read = True
        return [Entity(it) for it in self.element]

    def get_attr(
        self, name: str, *, data_type: Any = str, optional: bool = False, can_be_str: bool = True
    ) -> Any:
        self.read.add(name)
        if data_type not in (str, bool):
            return self._nested(name) or None
        if name not in self.element.attrib:
            if optional:
                return None
            raise AttributeError(f"Attribute '{name}' not found in Entity '{self.type_name}'")
        text = self.element.attrib[name]
        return text.lower() == "true" if data_type is bool else text

    def _nested(self, name: str) -> list[Entity]:
        self.children_read = True
        return [Entity(it) for it in self.element if it.tag == name]

    def assert_entity_completely_parsed(self) -> None:
        left = set(self.element.attrib) - self.read
        if left or (len(self.element) and not self.children_read):
            raise ValueError(f"Unexpected attribute(s) found in `{self.type_name}`: {left}")


class Parser:
    def parse_substitution(self, value: str) -> list[Any]:
        return list(_parsed(value))

    def parse_action(self, entity: Entity) -> Any:
        made, kwargs = ACTIONS[entity.type_name](entity, self)
        entity.assert_entity_completely_parsed()
        return made(**kwargs)


def _parsed(text: str) -> Iterator[Any]:
    """``$(name word word)`` with one more inside each word; no quotes."""
    inner = r"(?:[^()$]|\$\([^()]*\))*"
    for found in re.finditer(rf"\$\(({inner})\)|((?:[^$]|\$(?!\())+)", text):
        if found[2]:
            yield TextSubstitution(text=found[2])
            continue
        name, *words = re.findall(r"(?:[^ $]|\$\([^()]*\))+", found[1])
        made, kwargs = SUBSTITUTIONS[name]([list(_parsed(word)) for word in words])
        yield made(**kwargs)


def parse(entity: Entity, parser: Parser) -> tuple[Any, dict[str, Any]]:
    told = entity.get_attr("if", optional=True)
    return Action, {"condition": IfCondition(parser.parse_substitution(told))} if told else {}


FRONTEND = {
    "Entity": Entity,
    "Parser": Parser,
    "expose_action": expose_action,
    "expose_substitution": expose_substitution,
}


def install(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let ``import launch`` find this."""
    monkeypatch.setattr(Action, "parse", staticmethod(parse), raising=False)
    stood_in = contents().keys()
    with standing_in(**{"launch.frontend": FRONTEND}):
        made = {name: it for name, it in sys.modules.items() if name in stood_in}
    for name, module in made.items():
        if not (
            name.startswith("ament") or (name in sys.modules and name.startswith("launch_ros"))
        ):
            monkeypatch.setitem(sys.modules, name, module)
