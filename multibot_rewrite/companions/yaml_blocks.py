# SPDX-License-Identifier: Apache-2.0
"""Whole lines of a YAML text: the entries of lists and maps, to be copied, moved or left out."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise

import yaml

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.companions.yaml_text import Splice, YamlText

# What ends a line in YAML 1.1.
_END = lazy_compile("\r\n?|[\n\x85\u2028\u2029]")
_ENDS = ("\n", "\r", "\x85", "\u2028", "\u2029")


class Block(NamedTuple):
    """The characters ``start:end`` of a text, whole lines; ``column`` is where its entry starts."""

    start: int
    end: int
    column: int


def is_block(node: yaml.Node | None) -> bool:
    """Is it a list or map in block style, without brackets or braces?"""
    return isinstance(node, yaml.CollectionNode) and not node.flow_style


def newline(document: YamlText) -> str:
    """How the lines of a text end."""
    found = _END.search(document.text)
    return found[0] if found else "\n"


def inserted(document: YamlText, at: int, text: str) -> Splice:
    """Lines inserted at the start of a line, or after a last line without a line end."""
    unended = at == len(document.text) and not document.text.endswith(_ENDS)
    return Splice(at, at, (newline(document) if unended and text else "") + text)


def blocks(document: YamlText, node: yaml.Node) -> list[Block]:
    """The lines of each entry of a block list or map, comments above an entry included.

    They lie side by side; comments after the last entry do not belong to it.
    """
    found: list[Block] = []
    at = line_start(document, node.start_mark.index)
    for entry in node.value if is_block(node) else ():
        last = entry[1] if isinstance(entry, tuple) else entry
        end = line_end(document, end_of(last))
        found.append(Block(at, end, node.start_mark.column))
        at = end
    return found


def end_of(node: yaml.Node) -> int:
    """Where a node ends: PyYAML's own end mark of a block is at the start of what follows."""
    while is_block(node) and node.value:
        last = node.value[-1]
        node = last[1] if isinstance(last, tuple) else last
    end = node.end_mark.index
    # A block scalar ends where the next line starts.
    styled = isinstance(node, yaml.ScalarNode) and node.style in ("|", ">")
    return max(node.start_mark.index, end - 1) if styled else end


def line_start(document: YamlText, at: int) -> int:
    """Where the line of a character starts."""
    start = document.text.rfind("\n", 0, at) + 1
    others = (it.end() for it in _END.finditer(document.text, start, at))
    return max(others, default=start)


def line_end(document: YamlText, at: int) -> int:
    """Where the next line starts."""
    found = _END.search(document.text, at)
    return found.end() if found else len(document.text)


def cut_out(document: YamlText, start: int, end: int, splices: Iterable[Splice] = ()) -> str:
    """The text between two positions with the splices made; it ends with a line end."""
    parts, at = [], start
    for first, last, new in sorted(set(splices)):
        assert at <= first <= last <= end, "a splice outside of its block, or two that overlap"
        parts += [document.text[at:first], new]
        at = last
    text = "".join([*parts, document.text[at:end]])
    return text if not text or text.endswith(_ENDS) else text + newline(document)


def lines_of(text: str) -> list[str]:
    """The lines of a text with their ends."""
    ends = [0, *(it.end() for it in _END.finditer(text)), len(text)]
    return [text[start:end] for start, end in pairwise(ends) if start < end]


def moved(text: str, by: int) -> str:
    """Lines indented by ``by`` more columns; fewer if it is negative."""
    return "".join(_moved(line, by) for line in lines_of(text))


def _moved(line: str, by: int) -> str:
    if not line.strip():
        return line
    if by >= 0:
        return " " * by + line
    return line[min(-by, len(line) - len(line.lstrip(" "))) :]


def as_item(text: str, column: int, target: int) -> str:
    """The lines of a map at ``column`` as an item of a list with its dashes at ``target``."""
    lines = lines_of(moved(text, target + 2 - column))
    at = next(at for at, line in enumerate(lines) if line.strip() and line.lstrip()[0] != "#")
    lines[at] = f"{' ' * target}- {lines[at][target + 2 :]}"
    return "".join(lines)
