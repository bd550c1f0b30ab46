"""Files that a build writes -> the values in them, and the source line of each line."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache

import yaml
from lxml import etree

from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.companions.yaml_text import line_of, pairs, read_yaml
from multibot_rewrite.description.sources.read import read_file

# Text for people and for shells.
_LINES = (".md", ".py", ".sh")


class OutputText(NamedTuple):
    """A file of the output: its path below the folder, its text, what it was made from."""

    path: str
    text: str
    sources: tuple[str, ...]


class OutputValue(NamedTuple):
    """One value of a file; ``key`` is its key or attribute; a key is its own key."""

    text: str
    key: str
    is_key: bool
    line: int


def values_in(file: OutputText) -> Iterator[OutputValue]:
    """Every scalar of YAML, every attribute and text of XML, else every line."""
    if file.path.endswith(_LINES):
        yield from _of_lines(file)
    elif file.text.lstrip("\ufeff \t\r\n").startswith("<"):
        yield from _of_xml(file)
    else:
        root = read_yaml(file.text.encode(), file.path).root
        yield from _of_yaml(root, "") if root else ()


def _of_lines(file: OutputText) -> Iterator[OutputValue]:
    for at, it in enumerate(file.text.splitlines(), 1):
        yield OutputValue(it, "", False, at)


def _of_xml(file: OutputText) -> Iterator[OutputValue]:
    parser = etree.XMLParser(resolve_entities=False, huge_tree=True)
    try:
        root = etree.fromstring(file.text.encode(), parser)
    except etree.XMLSyntaxError:
        # A text of Lua or YAML may begin as XML does.
        yield from _of_lines(file)
        return
    for element in root.iter(etree.Element):
        line = int(str(element.sourceline or 1))
        for key, text in element.attrib.items():
            yield OutputValue(str(text), str(key), False, line)
        if element.text and element.text.strip():
            yield OutputValue(element.text.strip(), str(element.tag), False, line)


def _of_yaml(node: yaml.Node, key: str) -> Iterator[OutputValue]:
    if isinstance(node, yaml.ScalarNode):
        yield OutputValue(node.value, key, False, line_of(node))
    elif isinstance(node, yaml.SequenceNode):
        for item in node.value:
            yield from _of_yaml(item, key)
    for name, value in pairs(node):
        yield OutputValue(name.value, name.value, True, line_of(name))
        yield from _of_yaml(value, name.value)


def line_in_source(file: OutputText, line: int) -> tuple[str, int]:
    """The source of a file, and its line that a line of the file was made from."""
    for start, end, first, last in _changes(file):
        if first < line <= last:
            return file.sources[0], max(1, min(start + line - first, end))
    return file.sources[0], 1


@lru_cache(maxsize=16)
def _changes(file: OutputText) -> tuple[tuple[int, int, int, int], ...]:
    """The lines of the source, and those of the file that were made from them, piece by piece."""
    from difflib import SequenceMatcher

    try:
        old = read_file(file.sources[0]).decode("utf-8", "replace").splitlines()
    except InputError:
        return ()
    codes = SequenceMatcher(None, old, file.text.splitlines(), False).get_opcodes()
    return tuple(it[1:] for it in codes)
