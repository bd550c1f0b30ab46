# SPDX-License-Identifier: Apache-2.0
"""Expands xacro in a process of its own, which can only reach what it may."""

import os
import re
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from functools import lru_cache
from types import MappingProxyType
from typing import Any, NamedTuple, TypeVar

from multibot_rewrite.base import model
from multibot_rewrite.base.bounded import load_own_yaml
from multibot_rewrite.base.findings.finding import locate
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.description.sources.access import BOUNDED, Access, Find, Reach, check_file
from multibot_rewrite.description.sources.child.frames import KERNEL
from multibot_rewrite.description.sources.conversation import Failure, Result, Sources, converse
from multibot_rewrite.description.sources.trace import Origins, Pieces, Trace, alike
from multibot_rewrite.description.steps.document import start_offsets, tag_end

__all__ = ["Expanded", "Expansion", "Find", "Reach", "expand", "expand_traced", "expand_whole"]
_T = TypeVar("_T")
_KEPT: ContextVar[dict[object, Any] | None] = ContextVar("expansions", default=None)
# Of a longer message no repetition is looked for.
LONG = 1000
_UNREADABLE = lazy_compile("No such file|cannot be read|Is a directory|Permission denied")
_NOT_DEFINED = lazy_compile(
    r"unknown macro name: (?:xacro:)?([\w.]+)|name '(\w+)' is not defined|has no key"
)


class Expanded(NamedTuple):
    """A text, and the files that were read for it, as they were asked for."""

    data: bytes
    texts: Mapping[str, bytes]


class Expansion(NamedTuple):
    """An expanded text with origins of its elements, XML ``sources``, files ``read``, pieces."""

    data: bytes
    origins: Origins
    sources: Mapping[str, bytes]
    read: tuple[str, ...]
    pieces: Pieces


@contextmanager
def kept_expansions() -> Iterator[None]:
    """Keep expansions for equal arguments as long as the block runs."""
    before = _KEPT.set({})
    try:
        yield
    finally:
        _KEPT.reset(before)


def once_kept(key: object, expanded: Callable[[], _T]) -> _T:
    """Return the kept result for a key, or raise the kept error; make it at first."""
    kept = _KEPT.get()
    if kept is None:
        return expanded()
    if key not in kept:
        try:
            kept[key] = expanded()
        except model.InputError as error:
            kept[key] = error
    found: Any = kept[key]
    if isinstance(found, model.InputError):
        raise found.with_traceback(None)
    return found  # type: ignore[no-any-return]


def expand(
    path: str, arguments: Mapping[str, str], find: Find | None = None, reach: Reach = BOUNDED
) -> bytes:
    """Return the URDF text of a xacro file, UTF-8; raises InputError with xacro's reason.

    ``find`` is asked for packages before a sourced ROS; ``reach`` limits what the file may use.
    """
    return expand_whole(path, arguments, find, reach).data


def expand_whole(
    path: str, arguments: Mapping[str, str], find: Find | None = None, reach: Reach = BOUNDED
) -> Expanded:
    """Return the URDF text of a xacro file, and the files that were read."""

    def expanded() -> Expanded:
        check_file(path)
        sources = Sources(Access(path, reach, find), {})
        result = converse(arguments, sources, traced=False)
        _tell_missing(reach, result.fences)
        return Expanded(_text(path, result, Trace(result, sources, path)), sources.texts)

    return once_kept((path, frozenset(arguments.items()), find, reach), expanded)


def expand_traced(
    path: str,
    data: bytes,
    arguments: Mapping[str, str],
    find: Find | None = None,
    reach: Reach = BOUNDED,
    in_pieces: bool = False,
    changed: Mapping[str, bytes] = MappingProxyType({}),
) -> Expansion:
    """Return the URDF text of ``data`` with origins; ``changed`` files have these texts instead."""

    def expanded() -> Expansion:
        sources = Sources(Access(path, reach, find), {path: data}, changed)
        result = converse(arguments, sources, True, in_pieces)
        _tell_missing(reach, result.fences)
        trace = Trace(result, sources, path)
        text = _text(path, result, trace)
        if len(result.origins) != 3 * len(start_offsets(text)):
            what = "the places that its process reported are wrong; report this with the file"
            raise model.InputError(f"{path}: xacro failed: {what}", model.XACRO_FAILED)
        return Expansion(text, Origins(trace), trace.sources, tuple(sources.texts), Pieces(trace))

    given = frozenset(arguments.items()), frozenset(changed.items())
    return once_kept((path, data, *given, find, reach, in_pieces), expanded)


def _text(path: str, result: Result, trace: Trace) -> bytes:
    """Return the expanded text and print warnings; raises InputError with its place."""
    # What xacro warns about, without what a terminal would obey.
    for line in result.notes.splitlines():
        sys.stderr.write("".join(it if it.isprintable() else "?" for it in line) + "\n")
    if result.failure:
        said = result.failure.reason
        text = re.sub(r"^\[Errno \d+\] |<class '[\w.]+'>: ", "", said.partition(" [Errno")[0])
        # xacro may say it twice: in its own words and in those of the cause.
        if len(text) < LONG:
            text = re.sub(r"(.{9,}) \1(?= |$)", r"\1", text, flags=re.DOTALL)
        reason = " ".join((text or said).split())
        message = _failure_message(path, result.failure, reason, trace)
        raise model.InputError(message, *_cause(reason))
    # xacro expands what is inside the root, and drops the declaration of its own prefix.
    prefix, tag = result.root
    if prefix == "xacro":
        raise model.InputError(
            f"{path}: the root element is <{tag}>, which xacro does not expand; "
            "put everything inside a <robot> element"
        )
    return result.text


def _tell_missing(reach: Reach, held: tuple[str, ...]) -> None:
    """Log once for a process that the kernel cannot restrict it while it expands files."""
    if not reach.trust and KERNEL.isdisjoint(held) and not KERNEL.isdisjoint(reach.fences):
        _tell_once()


@lru_cache
def _tell_once() -> None:
    said = "xacro files are held by limits and Python's audit hook alone: this system has neither"
    sys.stderr.write(f"{said} Landlock nor seccomp (SECURITY.md)\n")


def _cause(reason: str) -> tuple[str, str]:
    """Return the cause of a failure that xacro reported, and the undefined name."""
    if _UNREADABLE.search(reason):
        return model.UNREADABLE, ""
    if reason.startswith("package '") and "is not found" in reason:
        return model.NO_PACKAGE, ""
    if reason.startswith("Undefined substitution argument"):
        return model.NO_ARGUMENT, ""
    found = _NOT_DEFINED.search(reason)
    return (model.NOT_DEFINED, found[1] or found[2] or "") if found else (model.XACRO_FAILED, "")


def _failure_message(path: str, failure: Failure, reason: str, trace: Trace) -> str:
    inner = alike(failure.file, path)
    inner = path if inner == os.path.normpath(path) else inner
    if not os.path.isabs(path):
        reason = reason.replace(os.path.join(os.getcwd(), ""), "")
    hints = load_own_yaml(__file__, "xacro_hints.yaml")
    hint = next((hint for word, hint in hints if word in reason), "run xacro on it to see more")
    argument = reason.partition(" argument ")[2].partition(" ")[0]
    where = f"{inner}:{failure.position[0]}:{failure.position[1]}" if failure.position else ""
    where = where or _place(failure, trace) or inner
    # The file that failed is this one, or one that it includes.
    included = "" if inner == path else f" (included from {path})"
    said = f"xacro failed{included}{_macros(trace, failure, reason)}: {reason}"
    return f"{where}: {said}; {hint.replace('{}', argument)}"


def _macros(trace: Trace, failure: Failure, reason: str) -> str:
    """Return the macro that failed, and the line of its call."""
    calls = trace.calls(failure.call)
    if not calls or "unknown macro" in reason:
        return ""
    line, _ = locate(trace.sources[calls[0].file], calls[0].start)
    file = os.path.basename(calls[0].file)
    return f" in the macro {calls[0].macro!r} that line {line} of {file} calls"


def _place(failure: Failure, trace: Trace) -> str:
    """Return ``file:line:column`` of the element that failed, or of its attribute; "" if unknown."""
    place = trace.place(*failure.place[:2]) if failure.place else None
    if place is None or failure.place is None:
        return ""
    file, start = place
    source = trace.sources[file]
    # The offset of an attribute of the tag at ``start``; that of the tag where it has none.
    name = failure.place[2].encode()
    pattern = re.compile(rb"\s(" + re.escape(name) + rb"\s*=)")
    found = pattern.search(source, start, tag_end(source, start)) if name else None
    line, column = locate(source, found.start(1) if found else start)
    return f"{file}:{line}:{column}"
