# SPDX-License-Identifier: Apache-2.0
"""Which topics a plugin's own parameters turn off."""

from __future__ import annotations

from typing import TYPE_CHECKING

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.description.rewriters.text import text_at

if TYPE_CHECKING:
    from lxml.etree import _Element

    from multibot_rewrite.description.rewriters.vocabulary import VocabularySection


# As sdformat reads booleans (Param.cc, ValueFromStringImpl): case and white space around do not
# count, any other text leaves the default.
def is_true(text: str) -> bool:
    """Return whether this text of a parameter turns it on."""
    return text.strip().lower() in ("true", "1")


def is_false(text: str) -> bool:
    """Return whether this text of a parameter turns it off."""
    return text.strip().lower() in ("false", "0")


def switched_off(plugin: _Element, section: VocabularySection) -> dict[str, str]:
    """Return the topics that none of their switches turns on, with the parameters that would."""
    found = [it.split("=") for it in section.switches]
    on = set()
    for parameter, topic, *usual in found:
        text = text_at(plugin, parameter)
        # One that is not there is as its code has it.
        if is_true(text) or (usual == ["on"] and not is_false(text)):
            on.add(topic)
    off = lists_by_key((topic, parameter) for parameter, topic, *_ in found if topic not in on)
    return {topic: " or ".join(parameters) for topic, parameters in off.items()}
