# SPDX-License-Identifier: Apache-2.0
"""What is known about a line of a xacro file: the values that it makes, and which pieces make them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from multibot_rewrite.base.findings.finding import locate
from multibot_rewrite.description.reports.explain import Explanation
from multibot_rewrite.description.sources.access import BOUNDED, TRUSTED
from multibot_rewrite.description.sources.expand import Expansion, expand_traced
from multibot_rewrite.description.sources.pieces import EXPRESSION, GIVEN, LITERAL, Piece
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.description.steps.document import Document, tag_end


def explain_source(
    path: str,
    arguments: Mapping[str, str],
    trust: bool,
    document: Document,
    line: int,
    explain: Callable[[int], list[Explanation]],
) -> list[Explanation]:
    """The values of the elements that are written on ``line`` of the file ``path``; ``explain`` says
    what is on a line of the ``document`` that it expands to. Raises InputError."""
    reach = TRUSTED if trust else BOUNDED
    read = expand_traced(path, read_file(path), arguments, None, reach, True)
    found = []
    for number, start in enumerate(document.starts):
        origin = read.origins.of(number)
        if origin is None or origin.file != path:
            continue
        source = read.sources[path]
        first, column = locate(source, origin.start)
        if first <= line <= locate(source, tag_end(source, origin.start))[0]:
            found += [
                it._replace(line=first, column=column, made_of=_made_of(read, number, it))
                for it in explain(locate(document.source, start)[0])
            ]
    return list(dict.fromkeys(found))


def _made_of(read: Expansion, number: int, it: Explanation) -> tuple[str, ...]:
    """The pieces of a value, in words; () for one that stands in the element as it is."""
    _, at, attribute = it.path.rpartition("@")
    pieces = read.pieces.of(number, attribute if at else "", it.value)
    plain = len(pieces) < 2 and all(one.kind == LITERAL for one in pieces)
    return () if plain else tuple(_words(read, pieces))


def _words(read: Expansion, pieces: tuple[Piece, ...]) -> Iterator[str]:
    """Each piece, what wrote it, and where."""
    for piece in pieces:
        if piece.kind == GIVEN:
            yield f"{piece.text!r} (argument {piece.file} that was given)"
            continue
        source = read.sources.get(piece.file, b"")
        where = ":".join(map(str, (piece.file, *locate(source, piece.start))))
        made = source[piece.start : piece.end].decode() if piece.kind == EXPRESSION else piece.kind
        yield f"{piece.text!r} ({made}, {where})"
