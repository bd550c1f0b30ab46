# SPDX-License-Identifier: Apache-2.0
"""Which topics a plugin's own parameters turn off."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.description.rewriters.text import text_at

if TYPE_CHECKING:
    from lxml.etree import _Element

    from multibot_rewrite.description.rewriters.vocabulary import VocabularySection


# As sdformat reads booleans (Param.cc, ValueFromStringImpl): case and white space around do not
# count, any other text leaves the default.
def is_true(text: str) -> bool:
    """Does this text of a parameter turn it on?"""
    return text.strip().lower() in ("true", "1")


def is_false(text: str) -> bool:
    """Does this text of a parameter turn it off?"""
    return text.strip().lower() in ("false", "0")


class Switch(NamedTuple):
    """A parameter of a plugin that turns a topic on or off, and whether it is on in this file."""

    parameter: str
    topic: str
    on: bool


def switches(plugin: _Element, section: VocabularySection) -> tuple[Switch, ...]:
    """The switches of a plugin as they stand; one that is not there is as its code has it."""
    return tuple(_switch(plugin, *it.split("=")) for it in section.switches)


def _switch(plugin: _Element, parameter: str, topic: str, usual: str = "off") -> Switch:
    text = text_at(plugin, parameter)
    return Switch(parameter, topic, is_true(text) or (usual == "on" and not is_false(text)))


def switched_off(plugin: _Element, section: VocabularySection) -> dict[str, str]:
    """The topics that no switch of theirs turns on, and what would."""
    found = switches(plugin, section)
    on = {it.topic for it in found if it.on}
    off = lists_by_key((it.topic, it.parameter) for it in found if it.topic not in on)
    return {topic: " or ".join(parameters) for topic, parameters in off.items()}
