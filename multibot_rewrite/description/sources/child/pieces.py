# SPDX-License-Identifier: Apache-2.0
"""Texts that know where they were written: what xacro makes of them, piece by piece.

A value of an expansion is put together from what is in an element, a property, the call of a macro,
an argument or a YAML file. While xacro runs, each of these is a ``PiecedText``: a str with its
pieces. What an expression makes in any other way is a piece that has only the place of the
expression.

Source: xacro 2.1.1 __init__.py (``eval_text``, ``grab_macro``, ``load_yaml``), substitution_args.py.
"""

from __future__ import annotations

from array import array
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple, SupportsIndex
from xml.dom import Node

from multibot_rewrite.description.sources.child.frames import NUMBER

GIVEN = -1
# What holds a text that is no attribute, by the number of its text node.
TEXT_NODE = "#"


class Spot(NamedTuple):
    """The place of a piece: numbers of file (or GIVEN) and element, attribute, character offset.

    ``attribute`` is ``#0`` for the first text in the element; ``length`` is that of an
    expression with this result, else 0."""

    file: int
    element: int
    attribute: str
    at: int
    length: int = 0


class Piece(NamedTuple):
    """A number of characters of a text, and their place."""

    length: int
    place: Spot | None


class PiecedText(str):
    """A text with its pieces."""

    __slots__ = ("pieces",)
    pieces: tuple[Piece, ...]

    def __new__(cls, text: str, pieces: Iterable[Piece]) -> PiecedText:
        """Return the text with its pieces."""
        self = super().__new__(cls, text)
        self.pieces = tuple(pieces)
        return self

    def __str__(self) -> str:
        return self

    def __deepcopy__(self, _: object) -> PiecedText:
        return self

    def __add__(self, other: str) -> PiecedText:
        return joined((self, other))

    def __radd__(self, other: str) -> PiecedText:
        return joined((other, self))

    def __getitem__(self, key: SupportsIndex | slice) -> PiecedText:
        text = str.__getitem__(self, key)
        index = range(len(self))[key]
        if isinstance(index, int):
            index = range(index, index + 1)
        if index.step != 1:
            return PiecedText(text, pieces_of(text))
        return PiecedText(text, _cut_pieces(self.pieces, index.start, index.stop))


def pieces_of(text: str) -> tuple[Piece, ...]:
    """Return the pieces of a text, one without a place if none are known."""
    if isinstance(text, PiecedText):
        return text.pieces
    return (Piece(len(text), None),) if text else ()


def joined(texts: Sequence[str]) -> PiecedText:
    """Return several texts as one."""
    pieces = (piece for text in texts for piece in pieces_of(text))
    return PiecedText("".join(texts), _merged_pieces(pieces))


def placed(text: str, place: Spot) -> PiecedText:
    """Return a text that knows it is copied from a place in a file."""
    return PiecedText(text, [Piece(len(text), place)] if text else ())


def _cut_pieces(pieces: Iterable[Piece], start: int, end: int) -> Iterator[Piece]:
    """Yield the pieces, or parts of them, between two characters."""
    at = 0
    for piece in pieces:
        first, last = max(at, start), min(at + piece.length, end)
        if first < last:
            yield Piece(last - first, _moved(piece.place, first - at))
        at += piece.length


def _moved(place: Spot | None, by: int) -> Spot | None:
    """Return the place after so many characters of a piece; an expression has one place."""
    return place._replace(at=place.at + by) if place and not place.length else place


def _merged_pieces(pieces: Iterable[Piece]) -> Iterator[Piece]:
    last = None
    for piece in pieces:
        if last and piece.place == _moved(last.place, last.length):
            last = Piece(last.length + piece.length, last.place)
            continue
        if last:
            yield last
        last = piece
    if last:
        yield last


def tracking(
    xacro: Any, arguments: Mapping[str, str], number: Callable[[str], int]
) -> dict[str, str]:
    """Let ``xacro`` keep pieces; return the caller's ``arguments`` with theirs."""
    # A file that was read and is no XML has its number from ``number``.
    import yaml

    xacro.eval_text = _evaluator(xacro)
    xacro.parse_macro_arg = _macro_parser(xacro.parse_macro_arg)
    scalar = yaml.SafeLoader.construct_scalar

    def construct(loader: Any, node: Any) -> str:
        """Return a scalar of a YAML file, with its place there."""
        at = node.start_mark.index + (node.style in ("'", '"'))
        return placed(scalar(loader, node), Spot(number(xacro.filestack[-1]), 0, "", at))

    yaml.SafeLoader.add_constructor("tag:yaml.org,2002:str", construct)
    return {name: placed(text, Spot(GIVEN, 0, name, 0)) for name, text in arguments.items()}


def note(document: Any, number: int) -> None:
    """Give the texts of a file that was just parsed their places; ``number`` is that of the file."""
    for at, element in enumerate(document.getElementsByTagName("*")):
        for name, value in element.attributes.items():
            element.getAttributeNode(name).value = placed(value, Spot(number, at, name, 0))
        texts = [it for it in element.childNodes if it.nodeType == Node.TEXT_NODE]
        for which, it in enumerate(texts):
            it.data = placed(it.data, Spot(number, at, f"{TEXT_NODE}{which}", 0))


def _evaluator(xacro: Any) -> Callable[[str, Any], Any]:
    """Return xacro's ``eval_text``, whose result knows its pieces."""
    lexer = xacro.LEXER

    def expression(text: str, symbols: Any) -> Any:
        """Return the value of ``${...}``; raises XacroException."""
        try:
            return xacro.safe_eval(evaluated(text, symbols), symbols)
        except Exception as error:  # an expression of the file may raise anything
            suffix = f"\nwhen evaluating expression '{text}'"
            raise xacro.XacroException(exc=error, suffix=suffix) from error

    def extension(text: str, symbols: Any) -> str:
        """Return the text of ``$(...)``, with the pieces of an argument."""
        said = str(evaluated(text, symbols))
        found = xacro.eval_extension(f"$({said})")
        words = said.split()
        known = xacro.substitution_args_context["arg"].get(words[-1]) if words else None
        return str(known if words[:1] == ["arg"] and known == found else found)

    def result(kind: int, part: str, symbols: Any) -> Any:
        """Return what xacro makes of a token, with its place."""
        if kind == lexer.EXPR:
            return _with_places(expression(part[2:-1], symbols), part)
        if kind == lexer.EXTENSION:
            return _with_places(extension(part[2:-1], symbols), part)
        return part[1:] if kind == lexer.DOLLAR_DOLLAR_BRACE else part

    def evaluated(text: str, symbols: Any) -> Any:
        """Return the value of a text: one result as it is, several as a text with pieces."""
        results, at = [], 0
        lex = xacro.QuickLexer(lexer)
        lex.lex(str.__str__(text))
        while lex.peek():
            kind, token = lex.next()
            part = text[at : at + len(token)]
            at += len(token)
            results.append((result(kind, part, symbols), part))
        if len(results) == 1:
            return results[0][0]
        return joined([_as_pieced_text(*it) for it in results])

    return evaluated


def _as_pieced_text(value: object, part: str) -> str:
    text = str(value)
    return (
        text
        if isinstance(text, PiecedText)
        else PiecedText(text, [Piece(len(text), _place_copied_from(part))])
    )


def _with_places(value: Any, part: str) -> Any:
    """Return a result of the expression ``part`` with its place, or that of a quoted word in it."""
    if not isinstance(value, str):
        return value
    pieces, at = [], 0
    for piece in pieces_of(value):
        text = str.__getitem__(value, slice(at, at + piece.length))
        place = piece.place or _place_in_quotes(text, part) or _place_copied_from(part)
        pieces.append(Piece(piece.length, place))
        at += piece.length
    return PiecedText(value, pieces)


def _place_in_quotes(text: str, part: str) -> Spot | None:
    """Return where a part is in quotes in a text; None if nowhere or in several places."""
    found = [
        part.find(f"{quote}{text}{quote}")
        for quote in "'\""
        if part.count(f"{quote}{text}{quote}") == 1
    ]
    place = _place_copied_from(part)
    if len(found) != 1 or not place:
        return None
    return place._replace(at=place.at + found[0] + 1, length=0)


def _place_copied_from(part: str) -> Spot | None:
    """Return the place in a file of a text that is copied from there, or None."""
    pieces = pieces_of(part)
    whole = len(pieces) == 1 and pieces[0].place
    return whole._replace(length=len(part)) if whole and not whole.length else None


def _macro_parser(parse: Callable[[str], Any]) -> Callable[[str], Any]:
    """Return xacro's parser of macro parameters, with defaults that know where they are written."""

    def parsed(text: str) -> Any:
        """Return (parameter, default with its place, rest of the text)."""
        param, value, rest = parse(text)
        start = len(text) - len(rest)
        if value is not None and value[1]:
            at = text.rfind(value[1], 0, start)
            value = (value[0], text[at : at + len(value[1])])
        return param, value, text[start:]

    return parsed


def numbers(document: Any, words: list[str]) -> array[int]:
    """Return the pieces of all values of an expanded document, eight numbers each.

    They are element, attribute, length, file, element, attribute, offset, length of an
    expression; attributes by their number in ``words``."""
    known: dict[str, int] = {}

    def number(word: str) -> int:
        if word not in known:
            known[word] = len(words)
            words.append(word)
        return known[word]

    found = array(NUMBER)
    for at, element in enumerate(document.getElementsByTagName("*")):
        for name, value in _values(element):
            for length, place in pieces_of(value):
                if place:
                    file, source, attribute, offset, whole = place
                    where = (file, source, number(attribute), offset, whole)
                else:
                    where = (GIVEN, 0, number(""), 0, 0)
                found.extend((at, number(name), length, *where))
    return found


def _values(element: Any) -> Iterator[tuple[str, str]]:
    """Yield the attributes, and the text of an element that has nothing else in it."""
    yield from element.attributes.items()
    inside = element.childNodes
    if len(inside) == 1 and inside[0].nodeType == Node.TEXT_NODE:
        yield TEXT_NODE, inside[0].data
