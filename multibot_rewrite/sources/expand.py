"""Expand xacro through its own API. The only import of xacro."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, nullcontext
from types import FrameType
from typing import Any
from xml.dom import DOMException
from xml.parsers.expat import ExpatError, errors

from multibot_rewrite.bounded import MAX_BYTES
from multibot_rewrite.findings.place import locate
from multibot_rewrite.model import InputError
from multibot_rewrite.sources.trace import ORIGIN, Origin, Trace, alike, tracing
from multibot_rewrite.steps.document import tag_end

# What it lets through in its own code: unreadable files, bytes that are no text, attributes that are
# missing (RuntimeError) and names that are no text (TypeError). What expressions raise, it words.
_UNWORDED = (OSError, ValueError, RuntimeError, TypeError)
# The folder of a package for $(find PACKAGE), empty where it is not known.
Find = Callable[[str], str]
# Of a longer message no repetition is looked for.
LONG = 1000
# What xacro's functions call the element that they work on.
_NODES = ("node", "elt", "tag")
# What xacro says -> what to do about it; {} stands for the argument that is missing.
_HINTS = (
    ("Undefined substitution argument", "give it as {}:=VALUE"),
    ("No module named 'ament_index_python'", "$(find PACKAGE) needs a sourced ROS 2"),
    ("AMENT_PREFIX_PATH", "$(find PACKAGE) needs a sourced ROS 2"),
    ("No such file", "check the path"),
    ("Is a directory", "check the path"),
    ("is not found", "source the workspace it is in, or name a folder above it: --roots"),
    ("package", "source the workspace that holds it"),
    ("Undefined block", "give it to the macro, or call it what the macro's params call it: *NAME"),
    ("Invalid parameter", "the macro has no such parameter: see its params"),
    ("missing attribute", "add it, an <xacro:arg> needs its default"),
    ("not a boolean", "write true, false, 1, 0 or an expression"),
    ("must be valid python identifiers", "use letters, digits and underscores"),
    ("invalid syntax", "correct the expression"),
    ("unknown macro name", "check its name and the <xacro:include> it comes from"),
    ("Undefined parameters", "give the macro all its parameters"),
    ("is not defined", "define it with <xacro:property> or <xacro:arg>"),
    ("environment variable", "set it, or use $(optenv NAME DEFAULT)"),
    ("recursion", "a macro or an include leads back to itself, or elements are nested too deep"),
    ("not UTF-8", "save it as UTF-8"),
    ("amplification", "entities are not accepted, write out what they stand for"),
    ("unbound prefix", 'declare it: xmlns:xacro="http://www.ros.org/wiki/xacro"'),
    ("not well-formed XML", "correct the XML and try again"),
)


def expand(path: str, arguments: Mapping[str, str], find: Find | None = None) -> bytes:
    """The URDF text of a xacro file, UTF-8; raises InputError with xacro's reason.

    ``find`` is asked for packages before a sourced ROS is.
    """
    return _expanded(path, arguments, None, find)[0]


def expand_traced(
    path: str, arguments: Mapping[str, str], trace: Trace, find: Find | None = None
) -> tuple[bytes, tuple[Origin | None, ...]]:
    """The same, and the origin of each element in document order; ``trace`` gets the sources."""
    data, document = _expanded(path, arguments, trace, find)
    return data, trace.origins(document)


def _expanded(
    path: str, arguments: Mapping[str, str], trace: Trace | None, find: Find | None
) -> tuple[bytes, Any]:
    _check_file(path)
    import xacro
    from xacro import substitution_args

    # What a file can be at fault for; anything else is no fault of the file and must be seen whole.
    said = (xacro.XacroException, substitution_args.SubstitutionException, ExpatError, DOMException)
    try:
        with tracing(xacro, trace) if trace else nullcontext(), _finding(substitution_args, find):
            document = xacro.process_file(path, mappings=dict(arguments))
        text: str = document.toprettyxml(indent="  ")
    except (*said, *_UNWORDED) as error:
        inner = alike((xacro.filestack or [path])[-1], path)
        inner = path if inner == os.path.normpath(path) else inner
        raise InputError(_message(path, inner, error, trace or Trace())) from error
    _check_root(path, document.documentElement)
    return text.encode(), document


def _check_root(path: str, root: Any) -> None:
    """xacro expands what is inside the root, and drops the declaration of its own prefix."""
    if root.prefix == "xacro":
        raise InputError(
            f"{path}: the root element is <{root.tagName}>, which xacro does not expand; "
            "put everything inside a <robot> element"
        )


@contextmanager
def _finding(module: Any, find: Find | None) -> Iterator[None]:
    """While it lasts, xacro's $(find ...) asks ``find`` first."""
    ask = module._eval_find

    def found(package: str) -> str:
        try:
            return str((find and find(package)) or ask(package))
        except (LookupError, OSError, ImportError):
            if find is None:
                raise
            raise LookupError(f"package {package!r} is not found") from None

    module._eval_find = module._eval_dict["find"] = found
    try:
        yield
    finally:
        module._eval_find = module._eval_dict["find"] = ask


def _check_file(path: str) -> None:
    try:
        with open(path, "rb") as file:
            size = os.fstat(file.fileno()).st_size
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from None
    if size > MAX_BYTES:
        limit = f"{MAX_BYTES // 2**20} MB"
        raise InputError(f"{path}: {size / 2**20:.0f} MB is over the limit of {limit}")


def _message(path: str, inner: str, error: Exception, trace: Trace) -> str:
    """``inner`` is the file that failed: ``path`` or one it includes."""
    reason = " ".join(_reason(error).split())
    if not os.path.isabs(path):
        reason = reason.replace(os.path.join(os.getcwd(), ""), "")
    hint = next((hint for word, hint in _HINTS if word in reason), "run xacro on it to see more")
    argument = reason.partition(" argument ")[2].partition(" ")[0]
    where = f"{inner}:{error.lineno}:{error.offset + 1}" if isinstance(error, ExpatError) else ""
    where = where or _place(error, trace) or inner
    included = "" if inner == path else f" (included from {path})"
    said = f"xacro failed{included}{_macros(trace, reason)}: {reason}"
    return f"{where}: {said}; {hint.replace('{}', argument)}"


def _macros(trace: Trace, reason: str) -> str:
    """The macro that failed, and the line of its call."""
    if not trace.failed or "unknown macro" in reason:
        return ""
    call = trace.failed[0]
    line, _ = locate(trace.sources[call.file], call.start)
    return f" in the macro {call.macro!r} that line {line} of {os.path.basename(call.file)} calls"


def _place(error: BaseException, trace: Trace) -> str:
    """``file:line:column`` of the element that was worked on, or of its attribute; "" if unknown."""
    for frame in reversed(list(_frames(error))):
        node = next((frame.f_locals[it] for it in _NODES if it in frame.f_locals), None)
        element: Any = node if hasattr(node, "tagName") else getattr(node, "parentNode", None)
        origin = element.getUserData(ORIGIN) if hasattr(element, "getUserData") else None
        if isinstance(origin, Origin):
            line, column = _locate(trace.sources[origin.file], origin, element, frame)
            return f"{origin.file}:{line}:{column}"
    return ""


def _frames(error: BaseException) -> Iterator[FrameType]:
    """The frames an error passed, the outermost first, and those of what caused it behind them."""
    step = error.__traceback__
    while step is not None:
        yield step.tb_frame
        step = step.tb_next
    cause = error.__cause__ or error.__context__
    if cause is not None:
        yield from _frames(cause)


def _locate(source: bytes, origin: Origin, element: Any, frame: FrameType) -> tuple[int, int]:
    """The attribute whose value was evaluated, or the element."""
    name, value = frame.f_locals.get("name"), frame.f_locals.get("value")
    start = origin.start
    if isinstance(name, str) and isinstance(value, str) and element.getAttribute(name) == value:
        pattern = re.compile(rb"\s(" + re.escape(name.encode()) + rb"\s*=)")
        found = pattern.search(source, start, tag_end(source, start))
        start = found.start(1) if found else start
    return locate(source, start)


def _reason(error: Exception) -> str:
    if isinstance(error, ExpatError):
        return f"not well-formed XML: {errors.messages.get(error.code, error)}"
    if isinstance(error, UnicodeDecodeError):
        return "the text is not UTF-8"
    text = str(error).partition(" [Errno")[0]
    text = re.sub(r"^\[Errno \d+\] |<class '[\w.]+'>: ", "", text)
    # xacro may say it twice: in its own words and in those of the cause.
    inner = getattr(error, "exc", None)
    cause = str(inner or "")
    if isinstance(inner, Exception) and not cause:
        text = f"{type(inner).__name__} {text}"
    if len(text) < LONG:
        text = re.sub(r"(.{9,}) \1(?= |$)", r"\1", text, flags=re.DOTALL)
    return text or type(error).__name__
