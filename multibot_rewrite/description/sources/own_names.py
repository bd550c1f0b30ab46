# SPDX-License-Identifier: Apache-2.0
"""Names that a xacro's own arguments spell for a robot.

The author of a xacro may have given it a prefix or a namespace argument. Which names an argument
reaches is found by expanding the file once more, with a word that nobody uses for the robot's.
"""

import re
from collections.abc import Collection, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.naming import DECLARED_KINDS, TWIN, Affix, OwnNames

if TYPE_CHECKING:
    from multibot_rewrite.description.steps.collect import Inventory

ROBOT = "{robot}"
# Stand for the words of a robot.
MARKS = (TWIN, "qznamespacezq", "qztagzq")
_TWICE = lazy_compile(rf"({'|'.join(MARKS)})[/_]*\1")
_PLACEHOLDER = lazy_compile(r"(?<!\$)\{[A-Za-z_]\w*\}")
Arguments = Mapping[str, str]
# Kind and text of a name -> another text of it.
NameTexts = Mapping[tuple[str, str], str]
NO_TEXTS: NameTexts = {}


class OwnSource(NamedTuple):
    """What is known of a description whose xacro arguments name one robot.

    ``robot`` is its name; ``plain`` are the names that the arguments make, by what they are without
    these; ``twin`` are the bytes for a robot that is called ``TWIN``.
    """

    robot: str = ""
    plain: NameTexts = NO_TEXTS
    twin: bytes = b""


OF_ALL = OwnSource()


def filled(arguments: Arguments, robot: str = "") -> dict[str, str]:
    """Return the arguments of one robot; raises UsageError for a placeholder other than ``{robot}``.

    Without ``robot`` there is nothing to fill in, and every placeholder is an error.
    """
    for name, text in arguments.items():
        found = _PLACEHOLDER.findall(text)
        if unknown := [it for it in found if it != ROBOT or not robot]:
            hint = f"only {ROBOT} is filled in" if robot else "no robot is named to fill it in for"
            raise UsageError(f"{name}:={text}: unknown placeholder {unknown[0]}, {hint}")
    return {name: _PLACEHOLDER.sub(robot, text) for name, text in arguments.items()}


def marked(
    arguments: Arguments, words: Sequence[str], common: Collection[str] = ()
) -> dict[str, str]:
    """Return the arguments with a mark for each name of a robot; the first fills ``{robot}``.

    Those that are ``common`` to robots name none of them.
    """
    return {
        name: text if name in common else _marked_text(text, words)
        for name, text in arguments.items()
    }


def _marked_text(text: str, words: Sequence[str]) -> str:
    if ROBOT in text:
        # It says where the robot is: another left in it is the left finger.
        return text.replace(ROBOT, MARKS[0])
    for word, mark in zip(words, MARKS, strict=False):
        token = rf"(?<![A-Za-z0-9]){re.escape(word)}(?![A-Za-z0-9])"
        text = re.sub(token, mark, text)
    return _PLACEHOLDER.sub(MARKS[0], text)


def templates(arguments: Arguments, robot: str) -> dict[str, str]:
    """Return the arguments with ``{robot}`` in place of the robot's name."""
    texts = marked(arguments, [robot])
    return {name: text.replace(MARKS[0], ROBOT) for name, text in texts.items()}


def name_robot(arguments: Arguments, words: Sequence[str], common: Collection[str] = ()) -> bool:
    """Return whether an argument contains a name of the robot."""
    return marked(arguments, words, common) != dict(arguments)


def common_to(robots: Sequence[tuple[Arguments, Sequence[str]]]) -> frozenset[str]:
    """Return arguments equal for several robots, in which a robot's name is a part's name."""
    # In ``left_finger`` left is a side: the fingers of all robots have that name.
    first = robots[0][0] if len(robots) > 1 else {}
    alike = {name for name in first if all(it.get(name) == first[name] for it, _ in robots)}
    words = {word for _, own in robots for word in own}
    return frozenset(
        it for it in alike if ROBOT not in first[it] and first[it].strip("_/") not in words
    )


def own_names(inventory: "Inventory", words: Sequence[str]) -> OwnNames:
    """Return the names with a mark in them, as they are for the robot with these names.

    Raises UsageError for a name that has the robot's name twice in a row.
    """
    found: dict[tuple[str, str], None] = {}
    every = ((it.kind, it.text) for names in inventory.names for it in names if it.kind)
    for kind, text in every:
        if not any(mark in text for mark in MARKS):
            continue
        name = _unmarked_text(text, words)
        if _TWICE.search(text):
            hint = "give one argument only, or none: the rewrite names what is left"
            raise UsageError(f"the xacro's arguments would make {name!r} of a {kind}; {hint}")
        found[kind, name] = None
    return found


def has_mark(data: bytes) -> bool:
    """Return whether a mark is anywhere in a text."""
    return any(mark.encode() in data for mark in MARKS)


def _unmarked_text(text: str, words: Sequence[str]) -> str:
    for word, mark in zip(words, MARKS, strict=False):
        text = text.replace(mark, word)
    return text


def marked_texts(plain: "Inventory", marked: "Inventory") -> NameTexts:
    """Return names without the arguments, mapped to the same with marks."""
    # Matched by their order: a kind with another number of names is left out.
    found: dict[tuple[str, str], str] = {}
    before, after = _names_by_kind(plain), _names_by_kind(marked)
    for kind, names in after.items():
        same = len(before.get(kind, ())) == len(names)
        pairs = zip(before[kind], names, strict=True) if same else ()
        found.update({(kind, old): new for old, new in pairs if any(mark in new for mark in MARKS)})
    return found


def _names_by_kind(inventory: "Inventory") -> dict[str, list[str]]:
    every = (it for names in inventory.names for it in names if it.kind not in DECLARED_KINDS)
    found = lists_by_key((it.kind, it.text) for it in every)
    # A reference that an argument misses is of another kind without its declaration.
    return {**found, **{kind: list(names) for kind, names in inventory.declared.items()}}


def own_texts(texts: NameTexts, words: Sequence[str]) -> NameTexts:
    """Return the texts for the robot with these names."""
    return {key: _unmarked_text(text, words) for key, text in texts.items()}


def own_affixes(texts: NameTexts) -> OwnNames | None:
    """Return where the robot's name goes in the plain names; None if more of a name is replaced."""
    found = {key: _inserted_affix(key[1], text) for key, text in texts.items()}
    return None if None in found.values() else found


def _inserted_affix(plain: str, marked: str) -> Affix | None:
    for at in range(len(plain) + 1):
        middle = marked[at : len(marked) - len(plain) + at]
        before, mark, after = middle.partition(MARKS[0])
        if mark and plain[:at] + middle + plain[at:] == marked:
            return Affix(at, before, after)
    return None


def as_twin(data: bytes) -> bytes:
    """Return the text for a robot that is called ``TWIN`` everywhere."""
    for mark in MARKS:
        data = data.replace(mark.encode(), TWIN.encode())
    return data
