# SPDX-License-Identifier: Apache-2.0
"""The page of a rule, ``rules/pages/CODE.md``: what it finds, why that hurts, the fix, and examples.

Below the title are three paragraphs, the second begins with ``**Why.**``, the third with ``**Fix.**``.
Then come fenced blocks, each below its title: ``Bad``, ``Fixed`` (what ``--fix`` makes), ``Good``,
and ``Beside it, `NAME` `` for each other file. ``Bad (line N)`` says where the finding is.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from functools import cache
from types import MappingProxyType

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.record import NamedTuple

FOLDER = os.path.join(os.path.dirname(__file__), "..", "..", "rules", "pages")
_WHY, _FIX = "**Why.** ", "**Fix.** "
_BESIDE = "Beside it, "
_TITLE = lazy_compile(r"(Bad|Fixed|Good|Beside it, `[^`]+`)(?: \(line ([0-9]+)\))?:")


class RulePage(NamedTuple):
    """The words and examples of a rule."""

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
    """Return what a page says. An example of one line has no line end, a longer one has."""
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
