"""What a section says beside its rows, in the words that the page and the command share."""

from __future__ import annotations

from multibot_rewrite.rewriters.vocabulary.grammar import VocabularySection


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
        "finds by bare name in the whole world": section.unique,
        "looks for": " ".join(section.hardwired),
        "remaps hold for": "the whole process" if section.process_wide else "",
        "never inserted into": "" if section.inserts else "it throws on unknown children",
        "source": section.source,
    }
    return {what: text for what, text in found.items() if text}
