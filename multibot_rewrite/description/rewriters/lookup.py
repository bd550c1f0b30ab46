# SPDX-License-Identifier: Apache-2.0
"""Finds plugin definitions by any name that a user may give, and says what they contain."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from multibot_rewrite.base.model import SiteRow
from multibot_rewrite.base.nearest import nearest_few
from multibot_rewrite.description.rewriters.plugin_definitions import Definitions, PluginDefinition
from multibot_rewrite.description.rewriters.plugin_definitions.values import ROLES, WiredTopic
from multibot_rewrite.description.rewriters.tree import library_key


def look_up(definitions: Definitions, name: str, types: Sequence[str]) -> list[PluginDefinition]:
    """Return the definitions of these types for a library, class, element, sensor type or block."""
    # ``sensor`` also finds ``robot.sensor``, after it.
    keys = spellings(name)
    found = [
        section
        for type_ in types
        for known in definitions.names(type_)
        if known in keys or (type_ == "element" and known.rpartition(".")[2] == name)
        for section in definitions.find(type_, known)
    ]
    found.sort(key=lambda section: keys.isdisjoint(section.names))
    return list({(section.file, section.line): section for section in found}.values())


def spellings(name: str) -> set[str]:
    """Return the keys under which a section for ``name`` may be found, as the loaders read it."""
    library = library_key(name.strip().rpartition("/")[2])
    return {name.strip(), library, name.strip().replace("ignition::gazebo::", "gz::sim::")}


def near_names(definitions: Definitions, name: str, types: Sequence[str]) -> list[str]:
    """Return up to three known names most like ``name``, in upper or lower case."""
    known = {known.lower(): known for type_ in types for known in definitions.names(type_)}
    words = sorted(word.lower() for word in spellings(name))
    near = [word for key in words for word in nearest_few(key, known, 3)]
    parts = [word for word in known if any(key and key in word for key in words)]
    return [known[word] for word in list(dict.fromkeys(near + parts))[:3]]


def block_of(site: SiteRow) -> str:
    """Return the block that a row comes from, shared by several sections; empty for an own row."""
    type_, _, name = site.section.partition(" ")
    return name if type_ == "block" else ""


def facts(section: PluginDefinition) -> dict[str, str]:
    """Return the meaning of each setting with its value, without empty ones."""
    found = {
        "about": section.about,
        "in": section.releases,
        "also called": " ".join(section.names[1:]),
        "is allowed in": " ".join(section.at),
        "chosen by": section.select,
        "shares": " ".join(f"[block {name}]" for name in section.blocks),
        "only a remap moves": " ".join(section.topics),
        **{role: _wired(it for it in section.wired if it.role == role) for role in ROLES},
        "looks up in the whole world": section.unique,
        "looks for": " ".join(section.hardwired),
        "remaps hold for": "the whole process" if section.process_wide else "",
        "never inserted into": "" if section.inserts else "it throws on unknown children",
        "source": section.source,
    }
    return {what: text for what, text in found.items() if text}


def _wired(topics: Iterable[WiredTopic]) -> str:
    """Return the topics with a type, each with its type and the condition for it."""
    typed = ((it, f" if {it.when}" if it.when else "") for it in topics if it.type)
    return ", ".join(f"{it.name} ({it.type}{when})" for it, when in typed)
