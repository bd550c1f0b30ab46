"""Where in the xacro files each element of an expansion was written, and through which macro calls.

xacro expands a DOM tree: its elements carry their origin as user data, which minidom hands on to
every copy, and a macro's body is copied while its call is the innermost one.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any, NamedTuple
from xml.dom import UserDataHandler

from multibot_rewrite.steps.document import start_offsets

ORIGIN = "multibot_origin"
_CALL = "xacro:call"


class Call(NamedTuple):
    """A macro call: the macro's name, the file of the call and the byte offset of its tag."""

    macro: str
    file: str
    start: int


class Origin(NamedTuple):
    """The file an element was written in, the byte offset of its tag, the innermost call first."""

    file: str
    start: int
    calls: tuple[Call, ...]


class Trace:
    """What one expansion knows of its origins.

    ``sources`` are the files that were read, or whose text was at hand, ``calls`` the macro calls
    under way, ``failed`` those that were when an error passed. ``given`` is the path that was asked
    for: others are spelled as it is.
    """

    def __init__(self, sources: Mapping[str, bytes] = {}, given: str = os.sep) -> None:
        self.sources = dict(sources)
        self.given = given
        self.calls: list[Call] = []
        self.failed: tuple[Call, ...] = ()

    def handle(self, operation: int, key: str, data: Origin, source: Any, copy: Any) -> None:
        """Called by minidom for every copy of an element."""
        if operation == UserDataHandler.NODE_CLONED and copy is not None:
            copy.setUserData(key, data._replace(calls=tuple(reversed(self.calls))), self)

    def mark(self, document: Any, file: str) -> None:
        """Give the elements of a file that was just parsed their origins."""
        if file not in self.sources:
            with open(file, "rb") as opened:
                self.sources[file] = opened.read()
        starts = start_offsets(self.sources[file])
        elements = document.getElementsByTagName("*")
        if len(elements) == len(starts):
            for element, start in zip(elements, starts, strict=True):
                element.setUserData(ORIGIN, Origin(file, start, ()), self)

    def origins(self, document: Any) -> tuple[Origin | None, ...]:
        """The origins of an expanded document's elements, in document order."""
        return tuple(element.getUserData(ORIGIN) for element in document.getElementsByTagName("*"))


def alike(path: str, given: str) -> str:
    """A path, relative where ``given`` is and it leads no further up; $(find ...) makes whole ones."""
    path = os.path.normpath(path)
    if os.path.isabs(given) or not os.path.isabs(path):
        return path
    relative = os.path.relpath(path)
    return relative if _climbs(relative) <= _climbs(os.path.normpath(given)) else path


def _climbs(path: str) -> int:
    return path.split(os.sep).count(os.pardir)


@contextmanager
def tracing(xacro: Any, trace: Trace) -> Iterator[None]:
    """While it lasts, what ``xacro`` reads and calls is noted in ``trace``."""
    parse, handle = xacro.parse, xacro.handle_macro_call
    xacro.parse, xacro.handle_macro_call = _reader(parse, trace), _caller(handle, trace)
    try:
        yield
    finally:
        xacro.parse, xacro.handle_macro_call = parse, handle


def _reader(parse: Callable[..., Any], trace: Trace) -> Callable[..., Any]:
    def read(given: Any, filename: str | None = None) -> Any:
        if given is not None or filename is None:
            return parse(given, filename)
        at_hand = trace.sources.get(filename)
        document = parse(None if at_hand is None else at_hand.decode(), filename)
        trace.mark(document, filename if at_hand is not None else alike(filename, trace.given))
        return document

    return read


def _caller(handle: Callable[..., Any], trace: Trace) -> Callable[..., Any]:
    def called(node: Any, macros: Any, symbols: Any) -> Any:
        origin = node.getUserData(ORIGIN)
        # A dynamic call comes back under the name of its macro.
        if origin is None or node.tagName == _CALL or not node.tagName.startswith("xacro:"):
            return handle(node, macros, symbols)
        depth = len(trace.calls)
        trace.calls.append(Call(node.tagName[6:], origin.file, origin.start))
        try:
            return handle(node, macros, symbols)
        except BaseException:
            trace.failed = trace.failed or tuple(reversed(trace.calls))
            raise
        finally:
            del trace.calls[depth:]

    return called
