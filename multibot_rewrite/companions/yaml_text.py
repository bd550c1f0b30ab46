# SPDX-License-Identifier: Apache-2.0
"""YAML as text with positions: parse to find the scalars, change those and nothing else.

Comments, quoting, order and line ends stay. Positions are character offsets.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator
from math import inf

import yaml

from multibot_rewrite.base.bounded import MAX_BYTES, QUOTED, compose_yaml
from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.findings.rule import Rule
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.record import NamedTuple

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
    """Parse one document; raises InputError with place, cause and remedy."""
    if len(data) > MAX_BYTES:
        raise InputError(f"{file}: {len(data):,} bytes, over the limit of {MAX_BYTES:,}")
    try:
        text = data.decode()
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise InputError(f"{file}:{line}: it is not UTF-8; save it as UTF-8") from None
    bom = text[:1] if text.startswith("\ufeff") else ""
    text = text[len(bom) :]
    return YamlText(file, text, compose_yaml(text, file), bom)


def anchors(document: YamlText) -> Iterator[tuple[int, str]]:
    """Line and text of anchors and aliases, which rcl's parser rejects (rcl_yaml_param_parser)."""
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
    """Keys and values of a mapping, repeated keys included; nothing for any other node."""
    if not isinstance(node, yaml.MappingNode):
        return []
    return [(key, value) for key, value in node.value if isinstance(key, yaml.ScalarNode)]


def names_below(node: yaml.Node) -> yaml.MappingNode | None:
    """The mapping whose keys are parts of names: the value, or what rcl reads in the same way, a list
    of one mapping with one key that has a list (rcl_yaml_param_parser jazzy 9.2 src/parse.c)."""
    if isinstance(node, yaml.MappingNode):
        return node
    only = node.value[0] if isinstance(node, yaml.SequenceNode) and len(node.value) == 1 else None
    if not isinstance(only, yaml.MappingNode) or len(only.value) != 1:
        return None
    return only if isinstance(only.value[0][1], yaml.SequenceNode) else None


def items(node: yaml.Node | None) -> list[yaml.Node]:
    """The items of a list; a scalar is a list of itself, anything else has none."""
    if isinstance(node, yaml.SequenceNode):
        return list(node.value)
    return [node] if isinstance(node, yaml.ScalarNode) else []


def is_text(node: yaml.Node) -> bool:
    """Does rcl read this scalar as a string: quoted, and not a number, boolean or null?"""
    if not isinstance(node, yaml.ScalarNode):
        return False
    return node.style in ("'", '"') or node.tag == "tag:yaml.org,2002:str"


def line_of(node: yaml.Node) -> int:
    """The line of a node, from 1."""
    return int(node.start_mark.line) + 1


def found_at(document: YamlText, node: yaml.Node, rule: Rule, message: str, hint: str) -> Finding:
    """A finding of ``rule`` at the place of ``node``."""
    mark = node.start_mark
    place = {"file": document.file, "line": mark.line + 1, "column": mark.column + 1}
    return rule.finding(message, hint, **place)


def replaced(node: yaml.ScalarNode, new: str) -> Splice:
    """The splice that gives a scalar another value, with the quotes it had or now needs.

    Raises ValueError for a block scalar, which spans several lines.
    """
    if node.style in ("|", ">"):
        raise ValueError("a block scalar is not one name")
    return Splice(node.start_mark.index, node.end_mark.index, quoted(new, node.style or ""))


def quoted(value: str, style: str = "") -> str:
    """A string as YAML text, in the style it had if that can hold it."""
    if style == "'" and value.isprintable():
        return "'" + value.replace("'", "''") + "'"
    if not style and _PLAIN.fullmatch(value) and value.lower() not in QUOTED:
        return value
    if value.isprintable():
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    return str(yaml.dump(value, default_style='"', width=inf)).rstrip("\n")


def joined_text(files: Iterable[str], root: yaml.Node) -> bytes:
    """A file that is made of others; called by their names, it is the same from every working
    directory."""
    names = ", ".join(dict.fromkeys(map(os.path.basename, files)))
    return f"# joined by multibot from {names}\n{yaml.serialize(root, width=inf)}".encode()


def spliced(document: YamlText, splices: Iterable[Splice]) -> str:
    """The text with the splices made; they do not overlap."""
    parts = []
    at = 0
    for start, end, new in sorted(splices):
        parts += [document.text[at:start], new]
        at = end
    return document.bom + "".join([*parts, document.text[at:]])
