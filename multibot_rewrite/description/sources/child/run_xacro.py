# SPDX-License-Identifier: Apache-2.0
"""Expands one xacro in its own process, and finds where elements were written; imports xacro.

xacro expands a DOM tree: its elements carry their mark (numbers of files, elements and macro
calls) as user data, which minidom hands on to every copy, and a macro's body is copied while its
call is the innermost one."""

from __future__ import annotations

import io
import sys
from array import array
from collections.abc import Iterator, Mapping
from types import FrameType
from typing import Any, NamedTuple
from xml.dom import UserDataHandler
from xml.parsers.expat import ExpatError, errors

from multibot_rewrite.description.sources.child.frames import MOST_TEXT, NUMBER, Ask, connect
from multibot_rewrite.description.sources.child.pieces import note, numbers, tracking

# What xacro's functions call the element that they work on.
_NODES = ("node", "elt", "tag")
# Of what xacro warns about, and of a reason.
MOST_NOTES, MOST_WORDS = 20_000, 20_000
MARK = "multibot_mark"
NOWHERE = -1
_CALL = "xacro:call"


class Expanded(NamedTuple):
    """A result: the report for JSON, the text, and the numbers of origins and calls."""

    report: dict[str, object]
    text: bytes = b""
    origins: bytes = b""
    calls: bytes = b""
    pieces: bytes = b""


def missing() -> str:
    """Return why xacro cannot be imported; empty if it can."""
    try:
        import xacro.substitution_args
    except ImportError as error:
        return f"xacro cannot be imported: {error}"
    return "" if xacro else "xacro is empty"


def expand(
    path: str, arguments: Mapping[str, str], traced: bool, in_pieces: bool, ask: Ask
) -> Expanded:
    """Return the text of a xacro file or why there is none; ``traced`` with origins of elements."""
    import xacro
    from xacro import substitution_args

    connect(xacro, substitution_args, ask)
    marks = Marks(in_pieces)
    if traced:
        marking(xacro, marks)
    given = tracking(xacro, arguments, marks.number) if in_pieces else dict(arguments)
    sys.stderr = sys.stdout = notes = io.StringIO()
    root, text, failed = None, b"", None
    origins = pieces = array(NUMBER)
    words: list[str] = []
    try:
        document = xacro.process_file(path, mappings=given)
        root = [document.documentElement.prefix, document.documentElement.tagName]
        text = document.toprettyxml(indent="  ").encode()
        origins = marks.origins(document) if traced else origins
        pieces = numbers(document, words) if in_pieces else pieces
        if len(text) > MOST_TEXT:
            raise ValueError(f"the result is over the limit of {MOST_TEXT // 2**20} MB")
    except Exception as error:  # an expression of the file may raise anything
        failed = _failure(error, (xacro.filestack or [path])[-1], marks)
    said = notes.getvalue()[:MOST_NOTES]
    report = {"notes": said, "files": marks.files, "macros": marks.macros, "words": words}
    result = {"error": failed} if failed else {"root": root}
    rows = (origins.tobytes(), marks.calls.tobytes(), pieces.tobytes())
    return Expanded({**report, **result}, text, *rows)


def _failure(error: Exception, file: str, marks: Marks) -> dict[str, object]:
    """Return the reason of a failure, the file, and the place as far as it is known."""
    position = (error.lineno, error.offset + 1) if isinstance(error, ExpatError) else None
    place = _place(error)
    said = {"reason": _reason_text(error)[:MOST_WORDS], "file": file, "position": position}
    return {**said, "place": place, "call": marks.failed}


def _place(error: BaseException) -> tuple[int, int, str] | None:
    """Return the number of the file and of the element, and the attribute, that failed; or None."""
    for frame in reversed(list(_frames(error))):
        node = next((frame.f_locals[it] for it in _NODES if it in frame.f_locals), None)
        element: Any = node if hasattr(node, "tagName") else getattr(node, "parentNode", None)
        mark = element.getUserData(MARK) if hasattr(element, "getUserData") else None
        if isinstance(mark, Mark) and mark.file != NOWHERE:
            return mark.file, mark.element, _attribute(element, frame)
    return None


def _frames(error: BaseException) -> Iterator[FrameType]:
    """Yield the frames an error passed, the outermost first, then those of its cause."""
    step = error.__traceback__
    while step is not None:
        yield step.tb_frame
        step = step.tb_next
    cause = error.__cause__ or error.__context__
    if cause is not None:
        yield from _frames(cause)


def _attribute(element: Any, frame: FrameType) -> str:
    """Return the attribute whose value was evaluated; empty if that is not known."""
    name, value = frame.f_locals.get("name"), frame.f_locals.get("value")
    both = isinstance(name, str) and isinstance(value, str)
    return str(name) if both and element.getAttribute(name) == value else ""


def _reason_text(error: Exception) -> str:
    if isinstance(error, ExpatError):
        return f"not well-formed XML: {errors.messages.get(error.code, error)}"
    if isinstance(error, UnicodeDecodeError):
        return "the text is not UTF-8"
    inner = getattr(error, "exc", None)
    if isinstance(inner, Exception) and not str(inner):
        return f"{type(inner).__name__} {error}"
    return str(error) or type(error).__name__


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

    def __init__(self, in_pieces: bool) -> None:
        self.in_pieces = in_pieces
        self.files: list[tuple[str, int]] = []
        self.macros: list[str] = []
        self.calls = array(NUMBER)
        self.current = self.failed = NOWHERE

    def handle(self, operation: int, key: str, data: Mark, source: Any, copy: Any) -> None:
        """Mark the copy of an element; minidom calls this for every copy."""
        if operation == UserDataHandler.NODE_CLONED and copy is not None:
            copy.setUserData(key, data._replace(call=self.current), self)

    def mark(self, document: Any, file: str) -> None:
        """Give the elements of a file that was just parsed their marks."""
        elements = document.getElementsByTagName("*")
        number = self.number(file, len(elements))
        for at, element in enumerate(elements):
            element.setUserData(MARK, Mark(number, at, NOWHERE), self)
        if self.in_pieces:
            note(document, number)

    def number(self, file: str, elements: int = 0) -> int:
        """Return the number of a file that was just read."""
        if (file, elements) not in self.files[-1:]:
            self.files.append((file, elements))
        return len(self.files) - 1

    def call(self, macro: str, at: Mark) -> int:
        """Return the number of a new call, inside the current one."""
        if macro not in self.macros:
            self.macros.append(macro)
        self.calls.extend((self.current, self.macros.index(macro), at.file, at.element))
        return len(self.calls) // 4 - 1

    def origins(self, document: Any) -> array[int]:
        """Return three numbers for each element of an expanded document, in its order."""
        nowhere = Mark(NOWHERE, NOWHERE, NOWHERE)
        found = (it.getUserData(MARK) or nowhere for it in document.getElementsByTagName("*"))
        return array(NUMBER, (number for mark in found for number in mark))


def marking(xacro: Any, marks: Marks) -> None:
    """Note in ``marks`` what ``xacro`` reads and calls from now on."""
    parse, handle = xacro.parse, xacro.handle_macro_call

    def read(given: Any, filename: str | None = None) -> Any:
        document = parse(given, filename)
        if given is None and filename is not None:
            marks.mark(document, filename)
        return document

    def called(node: Any, macros: Any, symbols: Any) -> Any:
        """Return what xacro's handler does, after noting the call of a macro."""
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

    xacro.parse, xacro.handle_macro_call = read, called
