"""What a section says beside its rows, in the words that the page and the command share."""

from __future__ import annotations

from collections.abc import Iterable

from multibot_rewrite.description.rewriters.vocabulary.grammar import VocabularySection
from multibot_rewrite.description.rewriters.vocabulary.wired import ROLES, WiredTopic


def facts(section: VocabularySection) -> dict[str, str]:
    """What each setting means -> its value, those that say nothing left out."""
    found = {
        "about": section.about,
        "in": section.releases,
        "also called": " ".join(section.names[1:]),
        "stands in": " ".join(section.at),
        "chosen by": section.select,
        "shares": " ".join(f"[block {name}]" for name in section.blocks),
        "only a remap moves": " ".join(section.topics),
        **{role: _wired(it for it in section.wired if it.role == role) for role in ROLES},
        "finds by bare name in the whole world": section.unique,
        "looks for": " ".join(section.hardwired),
        "remaps hold for": "the whole process" if section.process_wide else "",
        "never inserted into": "" if section.inserts else "it throws on unknown children",
        "source": section.source,
    }
    return {what: text for what, text in found.items() if text}


def _wired(topics: Iterable[WiredTopic]) -> str:
    """Those with a type, each with it and the condition on which it is there."""
    typed = ((it, f" if {it.when}" if it.when else "") for it in topics if it.type)
    return ", ".join(f"{it.name} ({it.type}{when})" for it, when in typed)
