# SPDX-License-Identifier: Apache-2.0
"""The proof that runs on every join: it reads the joined bytes again.

Each part that is taken out is, byte by byte, what went in; and a second reader finds all of it.
"""

from __future__ import annotations

from collections.abc import Sequence

from multibot_rewrite.base.model import InputError, ProofError
from multibot_rewrite.description import pipeline
from multibot_rewrite.description.joining.kept import KeptText, is_joined_whole, sections
from multibot_rewrite.description.joining.materials import bare, word_of
from multibot_rewrite.description.joining.part import in_one_line, prefixing
from multibot_rewrite.description.joining.second_reading import Mounted, check_read
from multibot_rewrite.description.readback.xml import read_xml
from multibot_rewrite.description.rewriters.tree import Tree


def taken_out(it: KeptText, file: str, tree: Tree) -> bytes:
    """A part of a joined text as it was before; raises InputError where the text
    was edited by hand."""
    word = word_of(it.name, it.prefix)
    text = bare(it.text, file, word, it.materials) if it.materials else it.text
    if not it.prefix:
        return text
    with in_one_line():
        return pipeline.strip(text, file, it.prefix, prefixing(), tree)


def split_text(data: bytes, file: str, tree: Tree) -> dict[str, bytes]:
    """The parts of a joined description by name, as they were."""
    return {it.name: taken_out(it, file, tree) for it in sections(data, file)}


def prove(data: bytes, parts: Sequence[Mounted], tree: Tree) -> None:
    """Raise ProofError unless ``data`` is these parts and nothing else."""
    try:
        _same_parts(data, parts, tree)
        check_read(read_xml(data, "the joined description"), parts)
    except InputError as error:
        raise ProofError(f"the joined description cannot be read: {error}") from None


def _same_parts(data: bytes, parts: Sequence[Mounted], tree: Tree) -> None:
    found = split_text(data, "the joined description", tree)
    first = parts[0].part
    before = split_text(first.data, first.file, tree) if is_joined_whole(first.data) else {}
    wanted = before or {first.name: first.data}
    wanted |= {it.part.name: it.part.data for it in parts[1:]}
    for name, text in wanted.items():
        if found.get(name) != text:
            raise ProofError(f"part {name!r} cannot be taken out again as it was")
    if list(found) != list(wanted):
        raise ProofError(f"{len(wanted)} parts went in, {len(found)} come out")
