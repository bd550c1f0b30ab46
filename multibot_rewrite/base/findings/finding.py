# SPDX-License-Identifier: Apache-2.0
"""The one record of a finding: of a description, a parameter file, a remap table, the live graph."""

from __future__ import annotations

from functools import lru_cache
from typing import Annotated

from multibot_rewrite.base.model import Edit, MultibotError
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.base.wording import one_line

# What is counted once: a file may have thousands of findings, and be one line.
_BLOCK = 4096
# In UTF-8 a character is one byte that is none of these.
_FOLLOWING = bytes(range(0x80, 0xC0))
ERROR, WARNING, NOTE, INCONCLUSIVE = "error", "warning", "note", "inconclusive"
# From the worst on. Inconclusive is no level to ask for: the view of the graph was incomplete.
LEVELS = (ERROR, WARNING, NOTE)


def locate(source: bytes, offset: int) -> tuple[int, int]:
    """Line and column, from 1, of a byte offset; the column counts characters."""
    block = offset // _BLOCK
    return _behind(*_blocks(source)[block], source[block * _BLOCK : offset])


@lru_cache(maxsize=4)
def _blocks(source: bytes) -> list[tuple[int, int]]:
    """Line and column of the start of each block."""
    here = 1, 1
    found = [here]
    for at in range(0, len(source), _BLOCK):
        here = _behind(*here, source[at : at + _BLOCK])
        found.append(here)
    return found


def _behind(line: int, column: int, text: bytes) -> tuple[int, int]:
    """Line and column behind a text that starts at these."""
    lines = text.count(b"\n")
    if not lines:
        return line, column + _characters(text)
    return line + lines, _characters(text[text.rfind(b"\n") + 1 :]) + 1


def _characters(text: bytes) -> int:
    return len(text) if text.isascii() else len(text.translate(None, _FOLLOWING))


class Finding(NamedTuple):
    """Something that a person should know, and where.

    ``code`` is permanent; ``level`` is one of ``LEVELS``, or ``INCONCLUSIVE``. ``hint`` says what to
    do, in the live graph the likely cause too. ``file``, ``line`` and ``column`` (from 1) are the
    place in a source file; an empty ``file`` means that there is none. ``calls`` are the xacro macro
    calls that made the element, the innermost first, as ``file:line: name``; ``arguments`` are the
    xacro arguments under which it is found, empty for the default ones. ``edits`` fix it in ``file``.

    In a fleet or graph, ``robot`` and ``node`` say who it is about (either may be empty) and
    ``names`` which topics, services, actions or frames. ``robots`` are all of which it is true, that of
    its words first, where it is one for several or is known by its line.
    """

    code: str
    level: Annotated[str, LEVELS]
    message: str
    hint: str = ""
    file: str = ""
    line: int = 0
    column: int = 0
    calls: tuple[str, ...] = ()
    arguments: str = ""
    edits: tuple[Edit, ...] = ()
    robot: str = ""
    node: str = ""
    names: tuple[str, ...] = ()
    robots: tuple[str, ...] = ()

    @property
    def place(self) -> str:
        """Where it is: a node, a robot, or ``file:line:column``; raises nothing."""
        if self.node.startswith("/"):
            return self.node
        if self.robot or self.node:
            return ": ".join(filter(None, (self.robot, self.node)))
        return f"{self.file}:{self.line}:{self.column}" if self.file else "graph"

    def __str__(self) -> str:
        hint = f" ({self.hint})" if self.hint else ""
        text = f"{self.place}: {self.level}: {self.code} {self.message}{same_for(self)}{hint}"
        return one_line(text)


def by_place(finding: Finding) -> tuple[str, int, int, str, str, str]:
    """What findings are sorted by: file, line, column, code and text."""
    it = finding
    return it.file, it.line, it.column, it.code, it.message, it.arguments


def same_for(finding: Finding) -> str:
    """``; the same for robot2 and 18 more``, empty where it is about one robot."""
    if len(finding.robots) < 2:
        return ""
    _, first, *more = finding.robots
    rest = f" and {len(more)} more" if more else ""
    return f"; the same for {first}{rest}"


class RewriteRefused(MultibotError):
    """The content does not allow a rewrite; ``findings`` says why."""

    def __init__(self, findings: tuple[Finding, ...]) -> None:
        # The base class keeps its arguments, and a pickle is made of them.
        super().__init__(findings)
        self.findings = findings

    def __str__(self) -> str:
        return "\n".join(str(finding) for finding in self.findings)
