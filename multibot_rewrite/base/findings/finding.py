# SPDX-License-Identifier: Apache-2.0
"""The record of a finding, and the rule that it is of: its code, level and check.

A finding is about a description, a parameter file, a remap table or the live graph. A rule's words
and examples are its page, ``rules/pages/CODE.md``.

A page says what is found, why that hurts, the fix, and has examples. Below the title are three
paragraphs, the second begins with ``**Why.**``, the third with ``**Fix.**``. Then come fenced blocks,
each below its title: ``Bad``, ``Fixed`` (what ``--fix`` makes), ``Good``, and ``With it, `NAME` ``
for each other file. ``Bad (line N)`` says where the finding is."""

import os
from collections.abc import Callable, Iterator, Mapping
from functools import cache, lru_cache, partial
from types import MappingProxyType
from typing import Annotated, Any, NamedTuple, TypeVar

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import Edit, MultibotError
from multibot_rewrite.base.wording import one_line

# What is counted once: a file may have thousands of findings, and be one line.
_BLOCK = 4096
# In UTF-8 a character is one byte that is none of these.
_FOLLOWING = bytes(range(0x80, 0xC0))
ERROR, WARNING, NOTE, INCONCLUSIVE = "error", "warning", "note", "inconclusive"
# From the worst on. Inconclusive is no level to ask for: the view of the graph was incomplete.
LEVELS = (ERROR, WARNING, NOTE)


def locate(source: bytes, offset: int) -> tuple[int, int]:
    """Return line and column, from 1, of a byte offset; the column counts characters."""
    block = offset // _BLOCK
    return _place_after(*_block_starts(source)[block], source[block * _BLOCK : offset])


@lru_cache(maxsize=4)
def _block_starts(source: bytes) -> list[tuple[int, int]]:
    """Return line and column of the start of each block of ``_BLOCK`` bytes."""
    here = 1, 1
    found = [here]
    for at in range(0, len(source), _BLOCK):
        here = _place_after(*here, source[at : at + _BLOCK])
        found.append(here)
    return found


def _place_after(line: int, column: int, text: bytes) -> tuple[int, int]:
    """Return line and column behind a text that starts at these."""
    lines = text.count(b"\n")
    if not lines:
        return line, column + _count_characters(text)
    return line + lines, _count_characters(text[text.rfind(b"\n") + 1 :]) + 1


def _count_characters(text: bytes) -> int:
    """Return how many characters a text in UTF-8 has."""
    return len(text) if text.isascii() else len(text.translate(None, _FOLLOWING))


class Remap(NamedTuple):
    """A remap rule ``old:=new`` for a node of a graph: full names, or `__ns` or `__node` as old."""

    node: str
    old: str
    new: str


class Setting(NamedTuple):
    """A value that a node should have: of a parameter, or of a field of its messages on ``topic``."""

    node: str
    name: str
    value: str
    topic: str = ""


class Finding(NamedTuple):
    """Something that a person should know, and where.

    ``code`` is permanent; ``level`` is one of ``LEVELS``, or ``INCONCLUSIVE``. ``hint`` says what to
    do, in the live graph the likely cause too. ``file``, ``line`` and ``column`` (from 1) are the
    place in a source file; an empty ``file`` means that there is none. ``calls`` are the xacro macro
    calls that made the element, the innermost first, as ``file:line: name``; ``arguments`` are the
    xacro arguments under which it is found, empty for the default ones. ``edits`` fix it in ``file``.

    In a fleet or graph, ``robot`` and ``node`` say who it is about (either may be empty) and
    ``names`` which topics, services, actions or frames. ``robots`` are all of which it is true, that of
    its words first, where it is one for several or is known by its line. ``remaps`` and ``settings``
    mend it: the rules and values that the hint names.
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
    remaps: tuple[Remap, ...] = ()
    settings: tuple[Setting, ...] = ()

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
    """Return the sort key of a finding: file, line, column, code and text."""
    it = finding
    return it.file, it.line, it.column, it.code, it.message, it.arguments


def same_for(finding: Finding) -> str:
    """Return ``; the same for robot2 and 18 more``, empty for a finding about one robot."""
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


URDF, SRDF, XACRO = "urdf", "srdf", "xacro"
NOTHING: Mapping[str, Any] = {}
_Check = TypeVar("_Check", bound=Callable[..., Any])


class Rule(NamedTuple):
    """A rule, with its words and examples.

    ``check`` is the function that finds the fault, None where several functions raise it.
    ``formats`` are what the examples are written in; in a ``urdf``, ``srdf`` or ``xacro`` a text that
    starts with neither ``<?xml`` nor ``<robot`` belongs inside ``<robot name="r">``. ``options`` say
    how the examples are checked. ``examples`` names the page of the examples where it is not that
    of the code.
    """

    code: str
    name: str
    level: str
    check: Callable[..., Any] | None = None
    formats: tuple[str, ...] = (URDF,)
    options: Mapping[str, object] = NOTHING
    examples: str = ""

    @property
    def what(self) -> str:
        """What the rule finds."""
        return rule_page(self.code).what

    @property
    def why(self) -> str:
        """Why that hurts at run time."""
        return rule_page(self.code).why

    @property
    def fix(self) -> str:
        """How to mend it."""
        return rule_page(self.code).fix

    @property
    def page(self) -> "RulePage":
        """The page with the examples."""
        return rule_page(self.examples or self.code)

    def finding(self, message: str, hint: str = "", **place: Any) -> Finding:
        """Return a finding of this rule with the fields ``place``; a line without a column gets 1."""
        if "line" in place:
            place.setdefault("column", 1)
        level = place.pop("level", self.level)
        return Finding(self.code, level, message, hint or self.advice, **place)

    @property
    def advice(self) -> str:
        """What to do in few words: the first sentence of ``fix``, as a hint is written.

        Empty where that sentence says to do nothing, or what the hint of each finding has.
        """
        first = self.fix.partition(". ")[0].removesuffix(".")
        if first.startswith("Nothing") or "the hint" in first:
            return ""
        return first[:1].lower() + first[1:]


def declare(
    code: str,
    name: str,
    level: str,
    check: Callable[..., Any] | None = None,
    *,
    formats: tuple[str, ...] = (URDF,),
    options: Mapping[str, object] = NOTHING,
) -> Rule:
    """Return a rule; without a function of its own it is for what a step or several functions find."""
    return Rule(code, name, level, check, formats, options)


def rule(code: str, name: str, level: str, **about: Any) -> Callable[[_Check], Rule]:
    """Return a decorator that makes a function a ``Rule``; ``about`` is as for ``declare``."""
    return partial(declare, code, name, level, **about)


FOLDER = os.path.join(os.path.dirname(__file__), "..", "..", "rules", "pages")
_WHY, _FIX = "**Why.** ", "**Fix.** "
_BESIDE = "With it, "
_TITLE = lazy_compile(r"(Bad|Fixed|Good|With it, `[^`]+`)(?: \(line ([0-9]+)\))?:")


class RulePage(NamedTuple):
    """The words and examples of a rule.

    ``bad`` has the finding exactly once, in line ``line``, and ``good`` has none; ``fixed`` is what the
    fix makes of ``bad``, if there is one; ``beside`` has the texts of files in its folder, by name."""

    what: str = ""
    why: str = ""
    fix: str = ""
    bad: str = ""
    good: str = ""
    fixed: str = ""
    line: int = 1
    beside: Mapping[str, str] = MappingProxyType({})


@cache
def rule_page(name: str) -> RulePage:
    """Return the page ``name`` of the rules; raises FileNotFoundError where there is none."""
    with open(os.path.join(FOLDER, f"{name}.md"), encoding="utf-8", newline="") as file:
        return read_page(file.read())


def read_page(text: str) -> RulePage:
    """Return the page of a rule, read from the text of its Markdown file."""
    prose, examples, line = [], {}, 1
    lines = iter(text.split("\n"))
    paragraph: list[str] = []
    title = ""
    for each in lines:
        found = _TITLE.fullmatch(each)
        if found:
            title, line = found[1], int(found[2] or line)
        elif title and each.startswith("```"):
            examples[title] = _example(each[: len(each) - len(each.lstrip("`"))], lines)
        elif each.strip() and not each.startswith("#"):
            paragraph.append(each)
        elif paragraph:
            prose.append(" ".join(paragraph))
            paragraph = []
    what, why, fix = prose or ("", _WHY, _FIX)
    beside = {
        it.removeprefix(_BESIDE).strip("`"): own
        for it, own in examples.items()
        if it.startswith(_BESIDE)
    }
    why, fix = why.removeprefix(_WHY), fix.removeprefix(_FIX)
    bad, good, fixed = (examples.get(it, "") for it in ("Bad", "Good", "Fixed"))
    return RulePage(what, why, fix, bad, good, fixed, line, beside)


def _example(fence: str, lines: Iterator[str]) -> str:
    """Return the block up to the closing fence."""
    block = []
    for line in lines:
        if line == fence:
            break
        block.append(line)
    return block[0] if len(block) == 1 else "".join(f"{it}\n" for it in block)
