# SPDX-License-Identifier: Apache-2.0
"""A text with slots for a robot's namespace and tag: made once, filled for each robot."""

from __future__ import annotations

import re
from collections.abc import Iterable

from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.companions.yaml_text import Splice

# Stand for the robot's namespace, and for the tag (prefix or postfix) in its frames and joints:
# ordinary letters, so that quoting and checks of names treat them as they will treat the names.
NAMESPACE_SLOT, TAG_SLOT = "multibotNamespaceSlot", "multibotTagSlot"
# Before the number that the first robot has, and what each further one has more.
_NUMBER, NUMBER_STEP = "multibotNumber", 10
_SLOT = re.compile(rf"({NAMESPACE_SLOT}|{TAG_SLOT}|{_NUMBER}\d+Slot)")


class FileTemplate(NamedTuple):
    """Pieces of text, every second one a slot."""

    pieces: tuple[str, ...]


def number_slot(first: int) -> str:
    """What stands for a number of the robot; raises nothing."""
    return f"{_NUMBER}{first}Slot"


def check_no_slots(text: str, file: str) -> None:
    """Raise InputError for a file that already holds one of the words that slots are made of."""
    found = _SLOT.search(text)
    if found:
        raise InputError(f"{file}: the word {found[0]} is reserved for this tool; use another word")


def make_template(text: str, splices: Iterable[Splice]) -> FileTemplate:
    """The text with the splices made; their new text may hold slots. They do not overlap."""
    held: list[str] = [""]
    at = 0
    for start, end, new in sorted(set(splices)):
        assert start >= at, "two splices overlap"
        first, *rest = _SLOT.split(new)
        held[-1] += text[at:start] + first
        held += rest
        at = end
    held[-1] += text[at:]
    return FileTemplate(tuple(held))


def fill_template(template: FileTemplate, namespace: str, tag: str, number: int = 0) -> str:
    """The text for a robot, which is the ``number``-th one after the first that has the file."""
    pieces = list(template.pieces)
    pieces[1::2] = [_filled(slot, namespace, tag, number) for slot in pieces[1::2]]
    return "".join(pieces)


def _filled(slot: str, namespace: str, tag: str, number: int) -> str:
    if slot in (NAMESPACE_SLOT, TAG_SLOT):
        return namespace if slot == NAMESPACE_SLOT else tag
    return str(int(slot[len(_NUMBER) : -len("Slot")]) + number * NUMBER_STEP)
