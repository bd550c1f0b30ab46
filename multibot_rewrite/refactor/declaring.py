# SPDX-License-Identifier: Apache-2.0
"""The new argument in the sources: a name that is free, and where it is declared.

A file that is included has the argument's property as well, empty where nobody has set it: packages
that are not read include it, too. Source: xacro README (``default`` of a property)."""

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


def free_name(found: Iterable[Description], names: Sequence[str] = NAMES) -> str:
    """Return a name that no argument, property or parameter of a macro has."""
    taken: set[str] = set()
    sources = {file: data for it in found for file, data in it.sources.items()}
    # YAML that an expression loads is among them.
    for file, data in ((file, data) for file, data in sources.items() if b"<robot" in data):
        for element in read_document(data, file).root.iter("{*}arg", "{*}property", "{*}macro"):
            words = element.get("params", "").replace(":=", " ").replace("=", " ").split()
            taken |= {element.get("name", ""), *words}
    free = next((name for name in names if name not in taken), None)
    if free is None:
        raise UsageError(f"{', '.join(names)} are all names of its arguments or properties")
    return free


def declared(
    found: Sequence[Description],
    texts: Mapping[str, bytes],
    changed: Collection[str],
    argument: str,
) -> Iterator[SourceEdit]:
    """Yield the argument and its property in the descriptions' own files, and the property in other
    files that are ``changed``; ``texts`` are the bytes of all, by real path."""
    own = {os.path.realpath(it.path) for it in found}
    argued = f'\n  <xacro:arg name="{argument}" default=""/>'
    value = f'\n  <xacro:property name="{argument}" value="$(arg {argument})"/>'
    for path in own:
        yield from _first(path, texts[path], argued + value)
    for path in {*changed} - own:
        if b"<robot" in texts[path]:
            text = f'\n  <xacro:property name="{argument}" default=""/>'
            yield from _first(path, texts[path], text)


def _first(path: str, source: bytes, text: str) -> Iterator[SourceEdit]:
    """Yield the edits that put a text first in the root element."""
    start = read_document(source, path).starts[0]
    end = tag_end(source, start)
    if b"xmlns:xacro" not in source[start:end]:
        at = start + len(b"<robot")
        yield SourceEdit(path, at, at, _SPACE)
    yield SourceEdit(path, end, end, text.encode())
