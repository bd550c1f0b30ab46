# SPDX-License-Identifier: Apache-2.0
"""YAML as text with positions: finds scalars and whole lines of entries, and changes only those.

Comments, quoting, order and line ends stay. Positions are character offsets."""

import os
import re
from collections.abc import Iterable, Iterator
from itertools import pairwise
from math import inf
from typing import NamedTuple

import yaml

from multibot_rewrite.base.bounded import MAX_BYTES, QUOTED, compose_yaml
from multibot_rewrite.base.findings.finding import Finding, Rule
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import InputError

# Reads back as the same text in any place, and never as a number, date, boolean or null.
_PLAIN = re.compile(r"[A-Za-z_/~][A-Za-z0-9_./~-]*")
_ANCHOR = re.compile(r"(?:^|[\s\[{,:-])[&*][^\s,\[\]{}]")


class YamlText(NamedTuple):
    """A YAML file; ``root`` is PyYAML's node of its document, None if it is empty.

    ``bom`` is what stood before the text.
    """

    file: str
    text: str
    root: yaml.Node | None
    bom: str = ""


class Splice(NamedTuple):
    """Replace the characters ``start:end`` by ``new``."""

    start: int
    end: int
    new: str


def read_yaml(data: bytes, file: str) -> YamlText:
    """Return the one document of a text; raises InputError with place, cause and remedy."""
    if len(data) > MAX_BYTES:
        raise InputError(f"{file}: {len(data):,} bytes, over the limit of {MAX_BYTES:,}; split it")
    try:
        text = data.decode()
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise InputError(f"{file}:{line}: it is not UTF-8; save it as UTF-8") from None
    bom = text[:1] if text.startswith("\ufeff") else ""
    text = text[len(bom) :]
    return YamlText(file, text, compose_yaml(text, file), bom)


def anchors(document: YamlText) -> Iterator[tuple[int, str]]:
    """Yield (line, text) of anchors and aliases, which rcl_yaml_param_parser rejects."""
    if not _ANCHOR.search(document.text):
        return
    for token in yaml.scan(document.text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader)):
        if isinstance(token, yaml.AnchorToken | yaml.AliasToken):
            mark = "&" if isinstance(token, yaml.AnchorToken) else "*"
            yield token.start_mark.line + 1, f"{mark}{token.value}"


def refuse_anchors(document: YamlText) -> None:
    """Raise InputError at the first anchor or alias."""
    for line, anchor in anchors(document):
        what = f"anchors and aliases are not allowed: {anchor}; write the value out"
        raise InputError(f"{document.file}:{line}: {what}")


def refused(document: YamlText, node: yaml.Node, what: str, cause: str = "") -> InputError:
    """Return the error at a node of a document."""
    return InputError(f"{document.file}:{line_of(node)}: {what}", cause)


def pairs(node: yaml.Node | None) -> list[tuple[yaml.ScalarNode, yaml.Node]]:
    """Return (key, value) of a mapping, repeated keys included; empty for any other node."""
    if not isinstance(node, yaml.MappingNode):
        return []
    return [(key, value) for key, value in node.value if isinstance(key, yaml.ScalarNode)]


def names_below(node: yaml.Node) -> yaml.MappingNode | None:
    """Return the mapping whose keys are parts of names, as rcl reads it."""
    # Also a list of one mapping with one key with a list (rcl_yaml_param_parser parse.c).
    if isinstance(node, yaml.MappingNode):
        return node
    only = node.value[0] if isinstance(node, yaml.SequenceNode) and len(node.value) == 1 else None
    if not isinstance(only, yaml.MappingNode) or len(only.value) != 1:
        return None
    return only if isinstance(only.value[0][1], yaml.SequenceNode) else None


def items(node: yaml.Node | None) -> list[yaml.Node]:
    """Return the items of a list; a scalar is a list of itself, anything else has none."""
    if isinstance(node, yaml.SequenceNode):
        return list(node.value)
    return [node] if isinstance(node, yaml.ScalarNode) else []


def is_text(node: yaml.Node) -> bool:
    """Return whether rcl reads this scalar as a string: quoted, and not a number, boolean or null."""
    if not isinstance(node, yaml.ScalarNode):
        return False
    return node.style in ("'", '"') or node.tag == "tag:yaml.org,2002:str"


def line_of(node: yaml.Node) -> int:
    """Return the line of a node, from 1."""
    return int(node.start_mark.line) + 1


def found_at(document: YamlText, node: yaml.Node, rule: Rule, message: str, hint: str) -> Finding:
    """Return a finding of ``rule`` at the place of ``node``."""
    mark = node.start_mark
    place = {"file": document.file, "line": mark.line + 1, "column": mark.column + 1}
    return rule.finding(message, hint, **place)


def replaced(node: yaml.ScalarNode, new: str) -> Splice:
    """Return the splice of a scalar's new value, quoted as needed; raises ValueError for a block."""
    if node.style in ("|", ">"):
        raise ValueError("a block scalar is not one name")
    return Splice(node.start_mark.index, node.end_mark.index, quoted(new, node.style or ""))


def quoted(value: str, style: str = "") -> str:
    """Return a string as YAML text, in the style it had if that can hold it."""
    if style == "'" and value.isprintable():
        return "'" + value.replace("'", "''") + "'"
    if not style and _PLAIN.fullmatch(value) and value.lower() not in QUOTED:
        return value
    if value.isprintable():
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    return str(yaml.dump(value, default_style='"', width=inf)).rstrip("\n")


def joined_text(files: Iterable[str], root: yaml.Node) -> bytes:
    """Return a file made of others, with their names in a comment, without folders."""
    names = ", ".join(dict.fromkeys(map(os.path.basename, files)))
    return f"# joined by multibot from {names}\n{yaml.serialize(root, width=inf)}".encode()


def spliced(document: YamlText, splices: Iterable[Splice]) -> str:
    """Return the text with the splices applied; they do not overlap."""
    parts = []
    at = 0
    for start, end, new in sorted(splices):
        parts += [document.text[at:start], new]
        at = end
    return document.bom + "".join([*parts, document.text[at:]])


# What ends a line in YAML 1.1.
_END = lazy_compile("\r\n?|[\n\x85\u2028\u2029]")
_ENDS = ("\n", "\r", "\x85", "\u2028", "\u2029")


class Block(NamedTuple):
    """The characters ``start:end`` of a text, whole lines; ``column`` is where its entry starts."""

    start: int
    end: int
    column: int


def is_block(node: yaml.Node | None) -> bool:
    """Return whether a node is a list or map in block style, without brackets or braces."""
    return isinstance(node, yaml.CollectionNode) and not node.flow_style


def newline(document: YamlText) -> str:
    """Return how the lines of a text end."""
    found = _END.search(document.text)
    return found[0] if found else "\n"


def inserted(document: YamlText, at: int, text: str) -> Splice:
    """Return lines inserted at the start of a line, or after a last line without a line end."""
    unended = at == len(document.text) and not document.text.endswith(_ENDS)
    return Splice(at, at, (newline(document) if unended and text else "") + text)


def blocks(document: YamlText, node: yaml.Node) -> list[Block]:
    """Return the lines of each entry of a block list or map, with the comments above it.

    They are adjacent; comments after the last entry are in none.
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
    """Return where a node ends: PyYAML's end mark of a block is at the start of what follows."""
    while is_block(node) and node.value:
        last = node.value[-1]
        node = last[1] if isinstance(last, tuple) else last
    end = node.end_mark.index
    # A block scalar ends where the next line starts.
    styled = isinstance(node, yaml.ScalarNode) and node.style in ("|", ">")
    return max(node.start_mark.index, end - 1) if styled else end


def line_start(document: YamlText, at: int) -> int:
    """Return where the line of a character starts."""
    start = document.text.rfind("\n", 0, at) + 1
    others = (it.end() for it in _END.finditer(document.text, start, at))
    return max(others, default=start)


def line_end(document: YamlText, at: int) -> int:
    """Return where the next line starts."""
    found = _END.search(document.text, at)
    return found.end() if found else len(document.text)


def cut_out(document: YamlText, start: int, end: int, splices: Iterable[Splice] = ()) -> str:
    """Return the text between two positions with the splices applied; it ends with a line end."""
    parts, at = [], start
    for first, last, new in sorted(set(splices)):
        assert at <= first <= last <= end, "a splice outside of its block, or two that overlap"
        parts += [document.text[at:first], new]
        at = last
    text = "".join([*parts, document.text[at:end]])
    return text if not text or text.endswith(_ENDS) else text + newline(document)


def lines_of(text: str) -> list[str]:
    """Return the lines of a text with their ends."""
    ends = [0, *(it.end() for it in _END.finditer(text)), len(text)]
    return [text[start:end] for start, end in pairwise(ends) if start < end]


def moved(text: str, by: int) -> str:
    """Return lines indented by ``by`` more columns; fewer if it is negative."""
    lines = lines_of(text)
    for at, line in enumerate(lines):
        if line.strip():
            gone = min(-by, len(line) - len(line.lstrip(" ")))
            lines[at] = " " * by + line if by >= 0 else line[gone:]
    return "".join(lines)


def as_item(text: str, column: int, target: int) -> str:
    """Return the lines of a map at ``column`` as an item of a list with its dashes at ``target``."""
    lines = lines_of(moved(text, target + 2 - column))
    at = next(at for at, line in enumerate(lines) if line.strip() and line.lstrip()[0] != "#")
    lines[at] = f"{' ' * target}- {lines[at][target + 2 :]}"
    return "".join(lines)
