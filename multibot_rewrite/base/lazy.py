# SPDX-License-Identifier: Apache-2.0
"""Regular expressions compiled at first use, and patterns that take linear time.

A run needs only few expressions. The parts of patterns read XML, Python and substitutions. A search
for something without an end would start again at the next place that looks like its start: what has
no end therefore goes to the end of the text, or stops where the next one starts.

Besides: no garbage collection while very many records are made."""

from __future__ import annotations

import gc
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any, AnyStr, cast

_USES = ("findall", "finditer", "fullmatch", "match", "search", "split", "sub")


class _Later:
    """A pattern that becomes one when one of its methods is asked for."""

    def __init__(self, text: Any, flags: int) -> None:
        self._made = text, flags

    def __getattr__(self, name: str) -> Any:
        compiled = re.compile(*self._made)
        # From now on its methods are found without this one.
        self.__dict__.update({use: getattr(compiled, use) for use in _USES})
        return getattr(compiled, name)


def lazy_compile(text: AnyStr, flags: int = 0) -> re.Pattern[AnyStr]:
    """Return a pattern as ``re.compile``, but a mistake in ``text`` is raised at the first use."""
    return cast("re.Pattern[AnyStr]", _Later(text, flags))


COMMENT = rb"<!--(?s:.*?)(?:-->|\Z)"
# What holds no tags.
SILENT = COMMENT + rb"|<!\[CDATA\[(?s:.*?)(?:\]\]>|\Z)|<\?(?s:.*?)(?:\?>|\Z)"
# Inside a start tag, behind its name: no value of an attribute holds a "<".
ATTRIBUTES = rb"(?:[^<>\"']|\"[^\"<]*\"|'[^'<]*')*"
# Inside an expression ${...} of xacro, and inside a substitution $(...).
IN_EXPRESSION = r"(?:[^$}]|\$(?!\{))*"
IN_SUBSTITUTION = r"(?:[^$)]|\$(?!\())*"
FILLED_IN = rf"\$\{{{IN_EXPRESSION}\}}|\$\({IN_SUBSTITUTION}\)"
_SILENT = lazy_compile(SILENT)


def without_comments(source: bytes) -> bytes:
    """Return a text of XML without its comments and processing instructions."""
    return _SILENT.sub(lambda found: found[0] if found[0].startswith(b"<![") else b"", source)


def with_gaps(pieces: Sequence[str], gap: str) -> str:
    """Return a pattern for texts of the pieces, each taken at its first place, ``gap`` between them."""
    first, *others = pieces
    *middle, last = others or [""]
    taken = (rf"(?=(?P<_{at}>{gap}+?{re.escape(it)}))(?P=_{at})" for at, it in enumerate(middle))
    end = f"{gap}+{re.escape(last)}" if others else ""
    return "".join((re.escape(first), *taken, end))


@contextmanager
def gc_paused() -> Iterator[None]:
    """Stop the garbage collector in the block: it would double the time of making many records."""
    on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if on:
            gc.enable()
