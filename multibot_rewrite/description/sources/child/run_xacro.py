"""One expansion, in the process that was made for it. The only import of xacro."""

from __future__ import annotations

import io
import sys
from array import array
from collections.abc import Iterator, Mapping
from types import FrameType
from typing import Any
from xml.parsers.expat import ExpatError, errors

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.sources.child.asking import Ask, connect
from multibot_rewrite.description.sources.child.frames import MOST_TEXT, NUMBER
from multibot_rewrite.description.sources.child.marks import MARK, NOWHERE, Mark, Marks, marking

# What xacro's functions call the element that they work on.
_NODES = ("node", "elt", "tag")
# Of what xacro warns about, and of a reason.
MOST_NOTES, MOST_WORDS = 20_000, 20_000


class Expanded(NamedTuple):
    """A result: what is told as JSON, the text, and the numbers of origins and calls."""

    report: dict[str, object]
    text: bytes = b""
    origins: bytes = b""
    calls: bytes = b""


def missing() -> str:
    """Why xacro cannot be imported; empty if it can."""
    try:
        import xacro.substitution_args
    except ImportError as error:
        return f"xacro cannot be imported: {error}"
    return "" if xacro else "xacro is empty"


def expand(path: str, arguments: Mapping[str, str], traced: bool, ask: Ask) -> Expanded:
    """The text of a xacro file, or in the report why there is none."""
    import xacro
    from xacro import substitution_args

    connect(xacro, substitution_args, ask)
    marks = Marks()
    if traced:
        marking(xacro, marks)
    sys.stderr = sys.stdout = notes = io.StringIO()
    root, text, failed = None, b"", None
    origins = array(NUMBER)
    try:
        document = xacro.process_file(path, mappings=dict(arguments))
        root = [document.documentElement.prefix, document.documentElement.tagName]
        text = document.toprettyxml(indent="  ").encode()
        origins = marks.origins(document) if traced else origins
        _check_length(text)
    except Exception as error:  # an expression of the file may raise anything
        failed = _failure(error, (xacro.filestack or [path])[-1], marks)
    report = {"notes": notes.getvalue()[:MOST_NOTES], "files": marks.files, "macros": marks.macros}
    result = {"error": failed} if failed else {"root": root}
    return Expanded({**report, **result}, text, origins.tobytes(), marks.calls.tobytes())


def _check_length(text: bytes) -> None:
    if len(text) > MOST_TEXT:
        raise ValueError(f"the result is over the limit of {MOST_TEXT // 2**20} MB")


def _failure(error: Exception, file: str, marks: Marks) -> dict[str, object]:
    """What went wrong: words, the file, and the place as far as it is known."""
    position = (error.lineno, error.offset + 1) if isinstance(error, ExpatError) else None
    place = _place(error)
    said = {"reason": _reason(error)[:MOST_WORDS], "file": file, "position": position}
    return {**said, "place": place, "call": marks.failed}


def _place(error: BaseException) -> tuple[int, int, str] | None:
    """File, element and attribute that were worked on."""
    for frame in reversed(list(_frames(error))):
        node = next((frame.f_locals[it] for it in _NODES if it in frame.f_locals), None)
        element: Any = node if hasattr(node, "tagName") else getattr(node, "parentNode", None)
        mark = element.getUserData(MARK) if hasattr(element, "getUserData") else None
        if isinstance(mark, Mark) and mark.file != NOWHERE:
            return mark.file, mark.element, _attribute(element, frame)
    return None


def _frames(error: BaseException) -> Iterator[FrameType]:
    """The frames an error passed, the outermost first, and those of what caused it behind them."""
    step = error.__traceback__
    while step is not None:
        yield step.tb_frame
        step = step.tb_next
    cause = error.__cause__ or error.__context__
    if cause is not None:
        yield from _frames(cause)


def _attribute(element: Any, frame: FrameType) -> str:
    """The attribute whose value was evaluated; empty where that is not known."""
    name, value = frame.f_locals.get("name"), frame.f_locals.get("value")
    both = isinstance(name, str) and isinstance(value, str)
    return str(name) if both and element.getAttribute(name) == value else ""


def _reason(error: Exception) -> str:
    if isinstance(error, ExpatError):
        return f"not well-formed XML: {errors.messages.get(error.code, error)}"
    if isinstance(error, UnicodeDecodeError):
        return "the text is not UTF-8"
    inner = getattr(error, "exc", None)
    if isinstance(inner, Exception) and not str(inner):
        return f"{type(inner).__name__} {error}"
    return str(error) or type(error).__name__
