# SPDX-License-Identifier: Apache-2.0
"""Where inside a value the names are: one function per ``form=`` word of the plugin definitions.

A form maps a value to its parts. Because a part is a position and not a new text, lists, scopes
and remap rules need no writer of their own.
"""

from collections.abc import Callable, Iterator, Mapping
from typing import NamedTuple

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import Claim
from multibot_rewrite.base.rosnames import split_remap

Declared = Mapping[str, Mapping[str, Claim]]
Kinds = tuple[str, ...]
_WORD = lazy_compile(r"[^\s(),;\"]+")
# Of a path through nested models, or a pattern; looking for names in it costs its length squared.
LONGEST = 4096
_OWNED = lazy_compile(r"::|/")
# Not a letter of it means more than itself.
_LITERAL = lazy_compile(r"[\w /:-]*")


class NamePart(NamedTuple):
    """One name inside a value: its text, where it starts, and the kinds it may be.

    ``closed`` tells that the file itself must declare it, whatever the kind; ``matched`` is the
    kind of the declared names that it matches, being a pattern.
    """

    at: int
    text: str
    kinds: Kinds
    closed: bool = False
    matched: Kinds = ()


# The consumer puts what they find in front of names: a postfix cannot be there.
IN_FRONT = ("prefix", "lettered")
Form = Callable[[str, Kinds, Declared], tuple[NamePart, ...]]


def whole(value: str, kinds: Kinds, declared: Declared) -> tuple[NamePart, ...]:
    """Return the value as one name, without white space around it."""
    name = value.strip()
    return (NamePart(value.index(name), name, kinds),) if name else ()


def prefixed(value: str, kinds: Kinds, declared: Declared) -> tuple[NamePart, ...]:
    """Return the prefix that the consumer puts before names; it may be empty."""
    name = value.strip()
    return (NamePart(value.index(name), name, kinds, False, kinds[:1]),)


def lettered(value: str, kinds: Kinds, declared: Declared) -> tuple[NamePart, ...]:
    """Return a prefix after a letter that the consumer drops."""
    name = value.strip()
    at = value.index(name) + 1
    return (NamePart(at, name[1:], kinds, False, kinds[:1]),) if name else ()


def listed(value: str, kinds: Kinds, declared: Declared) -> tuple[NamePart, ...]:
    """Return the names of a list separated by commas or white space."""
    parts = []
    at = 0
    for name in value.replace(",", " ").split():
        at = value.index(name, at)
        parts.append(NamePart(at, name, kinds))
        at += len(name)
    return tuple(parts)


def scoped(value: str, kinds: Kinds, declared: Declared) -> tuple[NamePart, ...]:
    """Return the parts of SDF's ``model::link``: models, and the name as the last piece."""
    # No parts where the first model is not of this file, and none behind an included model: their
    # names are declared elsewhere. A link may be called ``a::b``: SDF 1.7 is flattened so.
    scopes: list[NamePart] = []
    for at, name in _names_with_starts(value):
        rest = value[at:].rstrip()
        if rest == name or any(rest in declared.get(kind, ()) for kind in kinds):
            return (*scopes, NamePart(at, rest, kinds, True))
        if not scopes and name not in declared["model"]:
            return ()
        scopes.append(NamePart(at, name, ("model",), True))
        if is_included(name, declared):
            break
    return tuple(scopes)


def is_included(model: str, declared: Declared) -> bool:
    """Return whether another file describes this model. Its ``<include>`` only names it."""
    claim = declared["model"].get(model)
    return claim is not None and not claim.attribute


def _names_with_starts(value: str) -> Iterator[tuple[int, str]]:
    """Yield (offset, name) of each part between ``::``."""
    at = len(value) - len(value.lstrip())
    for name in value.strip().split("::"):
        if name:
            yield at, name
        at += len(name) + 2


def words(value: str, kinds: Kinds, declared: Declared) -> tuple[NamePart, ...]:
    """Return the declared names in a text such as ``(key value ...)``."""
    found = ((word.start(), word[0]) for word in _WORD.finditer(value))
    known = ((at, text, [k for k in kinds if text in declared.get(k, ())]) for at, text in found)
    return tuple(NamePart(at, text, tuple(of), True) for at, text, of in known if of)


def suffixed(value: str, kinds: Kinds, declared: Declared) -> tuple[NamePart, ...]:
    """Return the parts of ``link/light``: a name of the first kind, the rest if it is declared."""
    parts, at = _owner(value, kinds[:1], declared)
    name = value[at:].rstrip()
    known = tuple(kind for kind in kinds[1:] if name in declared.get(kind, ()))
    return (*parts, NamePart(at, name, known, True)) if known else tuple(parts)


def member(value: str, kinds: Kinds, declared: Declared) -> tuple[NamePart, ...]:
    """Return the parts of ``link::sensor``, ``world::model::link::sensor`` or ``link/sensor``."""
    # If none of the names before the last one is a link, the first must be a model of the file.
    if not _OWNED.search(value):
        return whole(value, kinds, declared)
    scopes, at = _owner(value, ("link",), declared)
    name = value[at:].rstrip()
    if name and scopes and scopes[-1].text in declared["link"]:
        return (*scopes, NamePart(at, name, kinds))
    (start, model), *below = _names_with_starts(value)
    inside = member(value[below[0][0] :], kinds, declared) if below[1:] else ()
    moved = (part._replace(at=part.at + below[0][0]) for part in inside)
    return (NamePart(start, model, ("model",), True), *moved) if inside else ()


def _owner(value: str, kinds: Kinds, declared: Declared) -> tuple[list[NamePart], int]:
    """Return the models before ``::`` and the longest declared name; and where the rest starts."""
    # Text before the first declared model is a world.
    at = len(value) - len(value.lstrip())
    parts = []
    pieces = list(_names_with_starts(value))
    for start, name in pieces[:-1]:
        if name in declared["model"] and not any(name in declared.get(k, ()) for k in kinds):
            parts.append(NamePart(start, name, ("model",), True))
            at = start + len(name) + 2
    text = value[at:].rstrip()
    cuts = [found.start() for found in _OWNED.finditer(text)]
    ends = [len(text), *reversed(cuts)]
    known = (end for end in ends if any(text[:end] in declared.get(kind, ()) for kind in kinds))
    end = next(known, cuts[0] if cuts else len(text))
    if end:
        parts.append(NamePart(at, text[:end], kinds))
    behind = _OWNED.match(text, end)
    return parts, at + (behind.end() if behind else end)


def regex(value: str, kinds: Kinds, declared: Declared) -> tuple[NamePart, ...]:
    """Return the alternatives of a regular expression for whole names, each inside its anchors."""
    found = ((at, text, _matched(text, kinds, declared)) for at, text in _alternatives(value))
    return tuple(
        NamePart(at, text, kinds, True, matched[:1]) for at, text, matched in found if text
    )


def _alternatives(value: str) -> Iterator[tuple[int, str]]:
    """Yield (offset, text) of the pieces between top-level bars, without anchors and blanks."""
    depth, begin = 0, 0
    bars = []
    from multibot_rewrite.description.rewriters.patterns import pieces_of  # few values are patterns

    for piece in pieces_of(value):
        depth += piece[0].startswith("(") - (piece[0] == ")")
        if piece[0] == "|" and depth == 0:
            bars.append(piece.start())
    for end in (*bars, len(value)):
        text = value[begin:end]
        lead = len(text) - len(text.lstrip().removeprefix("^"))
        yield begin + lead, text[lead:].rstrip().removesuffix("$")
        begin = end + 1


def _matched(pattern: str, kinds: Kinds, declared: Declared) -> tuple[str, ...]:
    """Return the kinds with a name that the pattern matches: none if it is not understood."""
    if _LITERAL.fullmatch(pattern):
        return tuple(kind for kind in kinds if pattern in declared.get(kind, ()))
    from multibot_rewrite.description.rewriters.patterns import Pattern, PatternError

    try:
        matches = Pattern(pattern).matches
    except PatternError:
        return ()
    return tuple(kind for kind in kinds if any(map(matches, declared.get(kind, ()))))


def transport(value: str, kinds: Kinds, declared: Declared) -> tuple[NamePart, ...]:
    """Return the names in a topic of Gazebo Classic: ``~/`` is the world, ``~/model/`` a model."""
    name = value.strip()
    at = value.index(name)
    world = 2 if name.startswith("~/") else 0
    model = name[world:].partition("/")[0]
    if world and model in declared["model"]:
        return (NamePart(at + world, model, ("model",), True),)
    return (NamePart(at + world, name[world:], kinds),) if name[world:] else ()


def remap(value: str, kinds: Kinds, declared: Declared) -> tuple[NamePart, ...]:
    """Return the parts of ``[node:]from:=to``: ``to`` is in the graph; ``remap_rules`` has ``from``."""
    lead = len(value) - len(value.lstrip())
    rule = split_remap(value.strip())
    if rule is None:
        return ()
    parts = [NamePart(lead, rule.node, ("node",))] if rule.node else []
    special = {"__node": ("node",), "__name": ("node",), "__ns": ("namespace",)}
    parts.append(NamePart(lead + rule.target_at, rule.target, special.get(rule.source, kinds)))
    return tuple(parts)


def below(value: str, kinds: Kinds, declared: Declared) -> tuple[NamePart, ...]:
    """Return the namespace of an absolute name, ``/robot/description``; nothing for a relative one."""
    name = value.strip()
    above = name.rpartition("/")[0] if name[:1] == "/" else ""
    return (NamePart(value.index(name), above, kinds),) if above else ()


def of_names(form: Form) -> Form:
    """Return the form for values as long as names are; a longer one is an undeclared name."""

    def bounded(value: str, kinds: Kinds, declared: Declared) -> tuple[NamePart, ...]:
        """Return the names that ``form`` finds; one undeclared name for a value that is too long."""
        if len(value) > LONGEST:
            return tuple(it._replace(closed=True) for it in whole(value, kinds, declared))
        return form(value, kinds, declared)

    return bounded


def nothing(value: str, kinds: Kinds, declared: Declared) -> tuple[NamePart, ...]:
    """Return no names: contact collisions are handled by code of their own."""
    return ()


FORMS: dict[str, Form] = {
    "whole": whole,
    "own": whole,
    "list": listed,
    "scoped": of_names(scoped),
    "words": words,
    "suffixed": of_names(suffixed),
    "member": of_names(member),
    "transport": transport,
    "regex": of_names(regex),
    "prefix": prefixed,
    "lettered": lettered,
    "remap": remap,
    "argument": remap,
    "below": below,
    "collision": nothing,
}
