# SPDX-License-Identifier: Apache-2.0
"""The configurations of a xacro: its arguments as they are by default, and one of them otherwise.

A switch is turned; an argument that an expression compares with a word gets that word, under whatever
name a property or a macro has it. Several at a time are not tried."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from itertools import chain, islice

from lxml.etree import _Element

from multibot_rewrite.base.model import InputError
from multibot_rewrite.description.rewriters.tree import Tree
from multibot_rewrite.description.steps.collect import Inventory
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.refactor.package import Description, Expanding, inventory_of, read_text

# So many are tried of one xacro.
MOST = 32
_TURNED = {"true": "false", "false": "true", "True": "False", "False": "True", "1": "0", "0": "1"}
# What an attribute has under another name: an argument or property alone.
_ALONE = re.compile(r"\s*(?:\$\(arg ([\w-]+)\)|\$\{\s*(\w+)\s*\})\s*")
# A name, as it is or in its argument, beside the words that it is compared with.
_NAME = r"(?:\$\(arg\s+)?(?<![\w-])([\w-]+)\)?['\"]?\s*"
_COMPARED = re.compile(_NAME + r"(?:[!=]=\s*(['\"][^'\"$]*['\"])|in\s*[\[(]([^\])]*))")
_BEHIND = re.compile(r"(['\"][^'\"$]*['\"])\s*[!=]=\s*['\"]?" + _NAME)
_WORD = re.compile(r"['\"]([^'\"]*)['\"]")


def configurations(
    it: Description, how: Expanding, tree: Tree, urdfs: Sequence[Inventory], unread: dict[str, str]
) -> Iterator[Description]:
    """The other configurations of a xacro that make another text; those that do not expand are noted in
    ``unread``."""
    assert it.read is not None
    known = {it.inventory.document.source}
    for name, value in islice(_values(it.read.sources, how.arguments), MOST):
        given = Expanding(how.reach, {**how.arguments, name: value})
        try:
            data, read = read_text(it.path, given)
            if data not in known:
                inventory = inventory_of(data, it.path, tree, urdfs)
                yield Description(it.path, inventory, read, {name: value})
        except InputError as error:
            unread[f"{it.path} {name}:={value}"] = f"with {name}:={value}: {error}"
            continue
        known.add(data)


def _values(sources: Mapping[str, bytes], given: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    """Arguments that are not given, with values that they do not have by default."""
    roots = [read_document(data, it).root for it, data in sources.items() if b"<robot" in data]
    elements = [it for root in roots for it in root.iter("*")]
    others = list(_others(elements))
    words = set(chain.from_iterable(_compared(str(it)) for one in elements for it in one.values()))
    for name, default in _defaults(elements).items():
        if name in given:
            continue
        names = _with_others(name, others)
        found = {_TURNED[default]} if default in _TURNED else set()
        found |= {word for one, word in words if one in names}
        yield from ((name, it) for it in sorted(found - {"", default}))


def _defaults(elements: Iterable[_Element]) -> dict[str, str]:
    """The arguments with their defaults; the first one counts."""
    found: dict[str, str] = {}
    for it in elements:
        if str(it.tag).endswith("xacro}arg"):
            found.setdefault(it.get("name", ""), it.get("default", ""))
    return found


def _others(elements: Iterable[_Element]) -> Iterator[tuple[str, str]]:
    """A name, and another one under which its value is known."""
    for element in elements:
        is_property = str(element.tag).endswith("xacro}property")
        for key, value in element.items():
            if found := _ALONE.fullmatch(str(value)):
                yield found[1] or found[2], element.get("name", "") if is_property else str(key)


def _with_others(name: str, others: Collection[tuple[str, str]]) -> list[str]:
    found = [name]
    for it in found:  # grows
        found += {other for one, other in others if one == it} - set(found)
    return found


def _compared(text: str) -> Iterator[tuple[str, str]]:
    """Names with the words that an expression compares them with."""
    for it in _COMPARED.finditer(text):
        yield from ((it[1], word[1]) for word in _WORD.finditer(it[2] or it[3]))
    yield from ((it[2], it[1][1:-1]) for it in _BEHIND.finditer(text))
