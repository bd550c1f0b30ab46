"""What a section says beside its rows, in the words that the page and the command share."""

from __future__ import annotations

from multibot_rewrite.rewriters.vocabulary.grammar import Rewriter


def facts(rewriter: Rewriter) -> dict[str, str]:
    """What each setting means -> its value, those that say nothing left out."""
    found = {
        "about": rewriter.about,
        "also called": " ".join(rewriter.names[1:]),
        "stands in": " ".join(rewriter.at),
        "chosen by": rewriter.select,
        "shares": " ".join(f"[block {name}]" for name in rewriter.blocks),
        "only a remap moves": " ".join(rewriter.topics),
        "finds by bare name in the whole world": rewriter.unique,
        "looks for": " ".join(rewriter.hardwired),
        "remaps hold for": "the whole process" if rewriter.process_wide else "",
        "never inserted into": "" if rewriter.inserts else "it throws on unknown children",
        "source": rewriter.source,
    }
    return {what: text for what, text in found.items() if text}
