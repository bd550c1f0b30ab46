"""Where each element of an expansion was written: numbers of files, elements and macro calls.

xacro expands a DOM tree: its elements carry their mark as user data, which minidom hands on to every
copy, and a macro's body is copied while its call is the innermost one.
"""

from __future__ import annotations

from array import array
from collections.abc import Callable
from typing import Any
from xml.dom import UserDataHandler

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.sources.child.frames import NUMBER

MARK = "multibot_mark"
NOWHERE = -1
_CALL = "xacro:call"


class Mark(NamedTuple):
    """The numbers of a file, of an element in it, and of the innermost macro call, or NOWHERE."""

    file: int
    element: int
    call: int


class Marks:
    """What one expansion knows of its origins.

    ``files`` are the names and numbers of elements of what was read; ``calls`` four numbers for each
    macro call: the call around it, its macro, and the file and element that it is in; ``current`` is
    the call under way, ``failed`` the one that was when an error passed.
    """

    def __init__(self) -> None:
        self.files: list[tuple[str, int]] = []
        self.macros: list[str] = []
        self.calls = array(NUMBER)
        self.current = self.failed = NOWHERE

    def handle(self, operation: int, key: str, data: Mark, source: Any, copy: Any) -> None:
        """Called by minidom for every copy of an element."""
        if operation == UserDataHandler.NODE_CLONED and copy is not None:
            copy.setUserData(key, data._replace(call=self.current), self)

    def mark(self, document: Any, file: str) -> None:
        """Give the elements of a file that was just parsed their marks."""
        elements = document.getElementsByTagName("*")
        number = len(self.files)
        self.files.append((file, len(elements)))
        for at, element in enumerate(elements):
            element.setUserData(MARK, Mark(number, at, NOWHERE), self)

    def call(self, macro: str, at: Mark) -> int:
        """The number of a new call, inside the current one."""
        if macro not in self.macros:
            self.macros.append(macro)
        self.calls.extend((self.current, self.macros.index(macro), at.file, at.element))
        return len(self.calls) // 4 - 1

    def origins(self, document: Any) -> array[int]:
        """Three numbers for each element of an expanded document, in its order."""
        nowhere = Mark(NOWHERE, NOWHERE, NOWHERE)
        found = (it.getUserData(MARK) or nowhere for it in document.getElementsByTagName("*"))
        return array(NUMBER, (number for mark in found for number in mark))


def marking(xacro: Any, marks: Marks) -> None:
    """From now on what ``xacro`` reads and calls is noted in ``marks``."""
    xacro.parse = _reader(xacro.parse, marks)
    xacro.handle_macro_call = _caller(xacro.handle_macro_call, marks)


def _reader(parse: Callable[..., Any], marks: Marks) -> Callable[..., Any]:
    def read(given: Any, filename: str | None = None) -> Any:
        document = parse(given, filename)
        if given is None and filename is not None:
            marks.mark(document, filename)
        return document

    return read


def _caller(handle: Callable[..., Any], marks: Marks) -> Callable[..., Any]:
    def called(node: Any, macros: Any, symbols: Any) -> Any:
        at = node.getUserData(MARK)
        # A dynamic call comes back under the name of its macro.
        if at is None or node.tagName == _CALL or not node.tagName.startswith("xacro:"):
            return handle(node, macros, symbols)
        around = marks.current
        marks.current = marks.call(node.tagName[6:], at)
        try:
            return handle(node, macros, symbols)
        except BaseException:
            if marks.failed == NOWHERE:
                marks.failed = marks.current
            raise
        finally:
            marks.current = around

    return called
