# SPDX-License-Identifier: Apache-2.0
"""The mesh and texture files that a description names."""

from __future__ import annotations

from lxml.etree import _Element

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.subject import Subject

_SCHEME = lazy_compile(r"([A-Za-z][A-Za-z0-9+.-]+)://")
# The same without a host, which libcurl takes (RFC 8089).
_SHORT = "file:/"
# A letter and a colon is a drive of Windows.
_MACHINE = lazy_compile(r"/|[A-Za-z]:[/\\]")


class Used(NamedTuple):
    """A mesh or texture; ``scheme`` is what is before ``://``, ``file`` for a path from the
    root of the disk, empty for a relative one. ``path`` is the rest of it."""

    element: _Element
    name: str
    scheme: str
    path: str


@memoized
def used_files(subject: Subject) -> tuple[Used, ...]:
    """Every file that a link's shapes and materials name, in document order."""
    tags, elements = ("mesh", "texture"), subject.elements
    files = elements.root.iter(*tags) if elements.every("texture") else elements.every("mesh")
    found = ((it, it.get("filename")) for it in files)
    return tuple(_read(it, name.strip()) for it, name in found if name and name.strip())


def _read(element: _Element, name: str) -> Used:
    scheme = _SCHEME.match(name)
    if scheme:
        return Used(element, name, scheme[1].lower(), name[scheme.end() :])
    if name.lower().startswith(_SHORT):
        return Used(element, name, "file", name[len(_SHORT) - 1 :])
    return Used(element, name, "file" if _MACHINE.match(name) else "", name)


def problem(it: Used, message: str, hint: str) -> Problem:
    """A problem at the file's name."""
    return Problem(it.element, message, "filename", hint)


def and_more(count: int) -> str:
    """The rest of a message that is about the first of many."""
    return f" (and {count - 1} more)" if count > 1 else ""
