# SPDX-License-Identifier: Apache-2.0
"""Parameters that a node asks for and that have no default: ``required`` in the tables of knowledge."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import yaml

from multibot_rewrite.base.findings.finding import WARNING, Finding
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.knowledge.declared import Declared
from multibot_rewrite.producers.evidence.claims import TYPE
from multibot_rewrite.rules.declaration import remark_at
from multibot_rewrite.rules.files.demands import demands, value_of
from multibot_rewrite.rules.files.parameter_files import of_release
from multibot_rewrite.rules.files.section_facts import Section, is_set_beside, sections


def missing_parameters(file: NamedFile) -> Iterator[Finding]:
    """What a node asks for and has no default: by itself, in a block, or with another parameter."""
    for section in sections(file):
        yield from _missing(file, section)
    for it in demands(file, "needs"):
        # A value that only a launch file fills in is there, too.
        if it.given.value is True and it.section.at + it.words[0] not in it.section.whole:
            message = f"{it.section.title}: {it.given.name} is true without {it.words[0]}"
            yield remark_at(it.given.key, message, f"add it, or set this to false; see {it.source}")


def _missing(file: NamedFile, section: Section) -> Iterator[Finding]:
    facts = of_release(section.facts, file.context.distro)
    needed = [(it, words) for it in facts for check, words in it.checks if check == "required"]
    found = [it for fact, words in needed for it in _required(file, section, fact, words)]
    # What a controller has under another name is misspelt, or it is of another class that is called the
    # same; a section with nothing of it adds to one of another file.
    unknown = [it for it, known in section.known if not known and it.name != TYPE]
    is_whole = len(unknown) < len(found) < len(needed)
    controller = section.node is not None and bool(section.node.types)
    yield from found if is_whole or not controller else ()
    for fact in facts:
        for words in (words for check, words in fact.checks if check == "required_or"):
            yield from _required_or(file, section, fact, words.split())


def _required(file: NamedFile, section: Section, fact: Declared, words: str) -> Iterator[Finding]:
    listed = value_of(section, words) if words else None
    for block, first in _blocks(section, fact.path):
        _, _, word = block.rpartition(".")
        name = f"{block}.{fact.path.rpartition('.')[2]}" if block else fact.path
        there = f"{section.at}{name}" in section.whole
        there = there or is_set_beside(file, section.title, f"{section.at}{name}")
        if not there and (listed is None or (isinstance(listed, list) and word in listed)):
            message = f"{section.title}: {name} is missing"
            yield remark_at(first, message, f"the node asks for it; see {fact.source}", WARNING)


def _required_or(
    file: NamedFile, section: Section, fact: Declared, others: Sequence[str]
) -> Iterator[Finding]:
    names = (fact.path, *others)
    there = any(it in section.whole or is_set_beside(file, section.title, it) for it in names)
    if section.given and not there:
        message = f"{section.title}: there is none of {', '.join(names)}"
        yield remark_at(section.given[0].key, message, f"add one; see {fact.source}", WARNING)


def _blocks(section: Section, path: str) -> Iterator[tuple[str, yaml.ScalarNode]]:
    """Each block of a file that a path is in, with a key; of a path of the node itself one without a
    name."""
    above = path.rpartition(".")[0]
    if "<" not in path:
        if section.given:
            yield above, section.given[0].key
        return
    found: dict[str, yaml.ScalarNode] = {}
    pattern = above.split(".")
    for it in section.given:
        parts = it.name.split(".")
        pairs = zip(pattern, parts, strict=False)
        fits = all(want.startswith("<") or want == got for want, got in pairs)
        if fits and len(parts) > len(pattern):
            found.setdefault(".".join(parts[: len(pattern)]), it.key)
    yield from found.items()
