"""Names that hold the word of their robot twice, such as ``robot1/robot1/scan``."""

from __future__ import annotations

import re
from collections.abc import Container, Iterable

from multibot_rewrite.description.checks.twice import BETWEEN, is_part


def twice(token: str, words: Iterable[str]) -> str:
    """The word of a robot that a name holds twice in a row; empty for none."""
    for word in words:
        if f"{word}/{word}" in token or f"{word}_{word}" in token:
            repeated = re.compile(f"(?<![A-Za-z0-9])({re.escape(word)})[/_]\\1(?![A-Za-z0-9])")
            if repeated.search(token):
                return word
    return ""


def doubled(token: str, words: Iterable[str], right: Container[str], bare: Container[str]) -> str:
    """The word of a robot that a name holds once too often; empty for none. ``right`` are the robot's
    names, ``bare`` those that its files declare.

    A declared name, as it is written for the robot, is right whatever is in it. A robot may be called
    as parts are: its name twice tells nothing in ``left/left_scan``, but ``left_left_base_link`` can
    only be the declared base_link.
    """
    name = token.strip("/")
    word = "" if name in right else twice(name, words)
    if not word or not is_part(word) or f"/{word}/{word}/" in f"/{name}/":
        return word
    return word if _without_twice(name, word) in bare else ""


def _without_twice(name: str, word: str) -> str:
    rest = re.sub(
        f"(?<![A-Za-z0-9]){re.escape(word)}[/_]{re.escape(word)}(?![A-Za-z0-9])", "", name
    )
    return rest.strip("".join(BETWEEN))
