"""Names that a xacro's own arguments spell for a robot.

The author of a xacro may have given it a prefix or a namespace argument. Which names an argument
reaches is found by expanding the file once more, with a word that nobody uses for the robot's.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence

from multibot_rewrite.model import UsageError
from multibot_rewrite.naming import OwnNames
from multibot_rewrite.steps.collect import Inventory

ROBOT = "{robot}"
# Stand for the words of a robot. Letters alone are taken by every file that takes a name.
MARKS = ("qzrobotzq", "qznamespacezq", "qztagzq")
_TWICE = re.compile(r"(qz\w+?zq)[/_]*\1")
_PLACEHOLDER = re.compile(r"(?<!\$)\{[A-Za-z_]\w*\}")
Arguments = Mapping[str, str]


def filled(arguments: Arguments, robot: str = "") -> dict[str, str]:
    """The arguments of one robot; raises UsageError for a placeholder other than ``{robot}``.

    Without ``robot`` there is nothing to fill in, and every placeholder is an error.
    """
    for name, text in arguments.items():
        found = _PLACEHOLDER.findall(text)
        unknown = [it for it in found if it != ROBOT or not robot]
        if unknown:
            hint = f"only {ROBOT} is filled in" if robot else "no robot is named to fill it in for"
            raise UsageError(f"{name}:={text}: unknown placeholder {unknown[0]}, {hint}")
    return {name: _PLACEHOLDER.sub(robot, text) for name, text in arguments.items()}


def marked(arguments: Arguments, words: Sequence[str]) -> dict[str, str]:
    """The arguments with a mark for each word of a robot; the first word is what fills ``{robot}``."""
    return {name: _marked(text, words) for name, text in arguments.items()}


def _marked(text: str, words: Sequence[str]) -> str:
    pairs = sorted(zip(words, MARKS, strict=False), key=lambda it: -len(it[0]))
    for word, mark in pairs:
        token = rf"(?<![A-Za-z0-9]){re.escape(word)}(?![A-Za-z0-9])"
        text = re.sub(token, mark, text)
    return _PLACEHOLDER.sub(MARKS[0], text)


def name_robot(arguments: Arguments, words: Sequence[str]) -> bool:
    """Does any of the arguments hold a word of the robot?"""
    return marked(arguments, words) != dict(arguments)


def own_names(inventory: Inventory, words: Sequence[str]) -> OwnNames:
    """The names with a mark in them, as they are for the robot with these words.

    Raises UsageError for a name that has the robot's name twice in a row.
    """
    found: dict[tuple[str, str], None] = {}
    for kind, text in _marked_names(inventory):
        name = _unmarked(text, words)
        if _TWICE.search(text):
            hint = "give one argument only, or none: the rewrite names what is left"
            raise UsageError(f"the xacro's arguments would make {name!r} of a {kind}; {hint}")
        found[kind, name] = None
    return found


def _marked_names(inventory: Inventory) -> Iterator[tuple[str, str]]:
    for names in inventory.names:
        for name in names:
            if name.kind and any(mark in name.text for mark in MARKS):
                yield name.kind, name.text


def _unmarked(text: str, words: Sequence[str]) -> str:
    for word, mark in zip(words, MARKS, strict=False):
        text = text.replace(mark, word)
    return text
