# SPDX-License-Identifier: Apache-2.0
"""The new argument in the sources: a name that is free, and where it is declared.

A file that is included has the argument's property as well, empty where nobody has set it: packages
that are not looked at include it, too. Source: xacro README (``default`` of a property)."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.description.steps.document import read_document, tag_end
from multibot_rewrite.refactor.package import Description
from multibot_rewrite.refactor.source_edits import SourceEdit

NAMES = ("prefix", "robot_prefix", "tf_prefix", "name_prefix")
SPACES = ("namespace", "robot_namespace", "ros_namespace")
_SPACE = b' xmlns:xacro="http://www.ros.org/wiki/xacro"'


def free_name(
    found: Iterable[Description],
    names: Sequence[str] = NAMES,
    known: Collection[str] | None = None,
) -> str:
    """Return a name that no argument, property or parameter of a macro has; where properties are
    ``known`` to take the argument, those may have it, and parameters."""
    taken: set[str] = set()
    sources = {file: data for it in found for file, data in it.sources.items()}
    # YAML that an expression loads is among them.
    for file, data in ((file, data) for file, data in sources.items() if b"<robot" in data):
        for element in read_document(data, file).root.iter("{*}arg", "{*}property", "{*}macro"):
            is_argument = str(element.tag).endswith("}arg")
            own = {element.get("name", "")}
            words = element.get("params", "").replace(":=", " ").replace("=", " ").split()
            taken |= own.union(words) if known is None else own - set(() if is_argument else known)
    free = next((name for name in names if name not in taken), None)
    if free is None:
        raise UsageError(f"{', '.join(names)} are all names of its arguments or properties")
    return free


def declared(
    tops: Iterable[Description],
    texts: Mapping[str, bytes],
    using: Collection[str],
    argument: str,
) -> Iterator[SourceEdit]:
    """Yield the argument in the descriptions' own files. Where a file is ``using`` its property, that
    too: with the argument's value in those, otherwise empty. ``texts`` are the bytes by real path."""
    value = f'<xacro:property name="{argument}" value="$(arg {argument})"/>'
    lines: dict[str, list[str]] = {}
    for it in tops:
        known = any(b'arg name="%s"' % argument.encode() in data for data in it.sources.values())
        argued = [f'<xacro:arg name="{argument}" default=""/>'] * bool(using or not known)
        lines[os.path.realpath(it.path)] = argued + [value] * bool(using)
    for path in using:
        lines.setdefault(path, [f'<xacro:property name="{argument}" default=""/>'])
    for path, own in lines.items():
        yield from _first(path, texts[path], own, argument) if b"<robot" in texts[path] else ()


def _first(path: str, source: bytes, lines: Iterable[str], argument: str) -> Iterator[SourceEdit]:
    """Yield the edits for missing lines, first in the root element or behind the argument."""
    document = read_document(source, path)
    start = document.starts[0]
    every = zip(document.elements, document.starts, strict=True)
    there = {str(it.tag).rpartition("}")[2]: at for it, at in every if it.get("name") == argument}
    text = "".join(f"\n  {it}" for it in lines if it[7:].split()[0] not in there)
    if b"xmlns:xacro" not in source[start : tag_end(source, start)]:
        at = start + len(b"<robot")
        yield SourceEdit(path, at, at, _SPACE)
    if text:
        end = tag_end(source, there.get("arg", start))
        yield SourceEdit(path, end, end, text.encode())
