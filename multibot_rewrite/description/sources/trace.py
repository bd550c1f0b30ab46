# SPDX-License-Identifier: Apache-2.0
"""Where in the xacro files each element of an expansion was written, and through which macro calls.

A child tells numbers (``child/marks.py``); what they stand for is looked up in the files as they were
read here, so a number that is wrong leads nowhere else.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.steps.document import start_offsets

if TYPE_CHECKING:
    from multibot_rewrite.description.sources.conversation import Result, Sources

NOWHERE = -1
# No macro is called from so deep: Python's recursion ends before.
DEEPEST = 500


class Call(NamedTuple):
    """A macro call: the macro's name, the file of the call and the byte offset of its tag."""

    macro: str
    file: str
    start: int


class WrittenAt(NamedTuple):
    """The file an element was written in, the byte offset of its tag, the innermost call first."""

    file: str
    start: int
    calls: tuple[Call, ...]


class Trace:
    """The files of one expansion, and what a child's numbers mean in them.

    ``sources`` are the files that were read, named as ``given`` is where that is possible.
    """

    def __init__(self, result: Result, sources: Sources, given: str) -> None:
        self.result = result
        texts = sources.texts
        self.names = [it if it == given else alike(it, given) for it, _ in result.files]
        self.starts = [_starts(texts.get(name, b""), count) for name, count in result.files]
        read = zip(self.names, result.files, strict=True)
        self.sources = {name: texts[asked] for name, (asked, _) in read if asked in texts}

    def place(self, file: int, element: int) -> tuple[str, int] | None:
        """The name of a file, and the offset of the tag of an element in it; None if unknown."""
        known = 0 <= file < len(self.names) and 0 <= element < len(self.starts[file])
        return (self.names[file], self.starts[file][element]) if known else None

    def calls(self, number: int) -> tuple[Call, ...]:
        """A macro call and those around it, the innermost first."""
        found: list[Call] = []
        numbers, macros = self.result.calls, self.result.macros
        while 0 <= number < len(numbers) // 4 and len(found) < DEEPEST:
            around, macro, file, element = numbers[4 * number : 4 * number + 4]
            place = self.place(file, element)
            if place and 0 <= macro < len(macros):
                found.append(Call(macros[macro], *place))
            number = around if around < number else NOWHERE
        return tuple(found)


class Origins(NamedTuple):
    """The origin of each element of an expanded document, in its order: looked up when asked for."""

    trace: Trace

    def of(self, number: int) -> WrittenAt | None:
        """The origin of an element; None where xacro itself made it."""
        file, element, call = self.trace.result.origins[3 * number : 3 * number + 3]
        place = self.trace.place(file, element)
        return WrittenAt(*place, self.trace.calls(call)) if place else None


def _starts(source: bytes, count: int) -> Sequence[int]:
    """The offsets of the tags of a file; none where they are not as many as its elements."""
    found = start_offsets(source)
    return found if len(found) == count else ()


def alike(path: str, given: str) -> str:
    """A path, relative where ``given`` is and it leads no further up; $(find ...) makes whole ones."""
    path = os.path.normpath(path)
    if os.path.isabs(given) or not os.path.isabs(path):
        return path
    relative = os.path.relpath(path)
    return relative if _climbs(relative) <= _climbs(os.path.normpath(given)) else path


def _climbs(path: str) -> int:
    return path.split(os.sep).count(os.pardir)
