# SPDX-License-Identifier: Apache-2.0
"""What a name stands for where a function runs; of one that may stand for two texts nothing is known.

What is left in <> is not known; ``<@topic>`` is the value of a parameter.
"""

import re
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping
from typing import NamedTuple, TypeVar

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.producers.sources.expressions import last
from multibot_rewrite.producers.sources.records import (
    ANY,
    Alias,
    Call,
    Class,
    Constructor,
    Source,
    Value,
    braced,
    parameter_in,
)

DEEPEST = 12
_PART = re.compile(r"<([^<>]*)>")
_BRACED = re.compile(r"\{([^{}]*)\}")
_ROS_TYPE = re.compile(r"\b(\w+)(?:::|/|\.)(msg|srv|action)(?:::|/|\.)(?:_\w+\.)?(\w+)")
FRAMES = ("header.frame_id", "child_frame_id")
# A list of words, and a loop over one.
LIST, EACH = "list:", "each "
FLAGS = ("<True>", "<False>", "<true>", "<false>")
# What a variable has before it is set.
_NOTHING = ("", "<None>", "<nullptr>")
_AS_IT_IS = ("new ", "Node:", "this", LIST)
Item = TypeVar("Item")
Key = TypeVar("Key", bound=Hashable)
NO_WORDS: Mapping[str, str] = {}


class Names(NamedTuple):
    """What was read of a program, by the names that it is looked up by."""

    classes: Mapping[str, tuple[Class, ...]]
    calls: Mapping[tuple[str, str], tuple[Call, ...]]
    takers: Mapping[tuple[str, str], tuple[Constructor, ...]]
    setting: Mapping[tuple[str, str, str], tuple[Value, ...]]
    members: Mapping[tuple[str, str], tuple[Value, ...]]
    constants: Mapping[str, tuple[Value, ...]]
    aliases: Mapping[str, tuple[Alias, ...]]
    frames: Mapping[tuple[str, str], tuple[Value, ...]]


class Made(NamedTuple):
    """An object: class, known bases, arguments of their constructors, template types, other bases."""

    chain: tuple[Class, ...]
    given: Mapping[str, Mapping[str, str]]
    types: Mapping[str, str]
    beyond: tuple[str, ...] = ()

    @property
    def owners(self) -> tuple[str, ...]:
        """The names of its classes."""
        return tuple(it.name for it in self.chain)


NOBODY = Made((), {}, {})


class Spot(NamedTuple):
    """A function that runs: its object and class, arguments, conditions, file and callers."""

    made: Made
    owner: str
    function: str
    given: Mapping[str, str]
    asked: str
    path: str
    trail: tuple[tuple[str, str, str], ...] = ()


def names_of(source: Source) -> Names:
    """Return the look-ups for what was read of a program."""
    outside = (it for it in source.values if not it.function and not it.variable.startswith("@"))
    return Names(
        _grouped(source.classes, lambda it: it.name),
        _grouped(source.calls, lambda it: (it.owner, it.function)),
        _grouped(source.constructors, lambda it: (it.owner, it.function)),
        _grouped(source.values, lambda it: (it.owner, it.function, it.variable)),
        _grouped(source.values, lambda it: (it.owner, it.variable)),
        _grouped(outside, lambda it: it.variable.removeprefix("self.")),
        _grouped(source.aliases, lambda it: it.name),
        _grouped((it for it in source.values if frame_in(it)), lambda it: (it.owner, it.function)),
    )


def frame_in(it: Value) -> str:
    """Return the last part of a variable that is a frame of a message; empty for another one."""
    return next((end for end in FRAMES if it.variable.endswith(end)), "")


def _grouped(items: Iterable[Item], key: Callable[[Item], Key]) -> dict[Key, tuple[Item, ...]]:
    found = lists_by_key((key(item), item) for item in items)
    return {name: tuple(rows) for name, rows in found.items()}


def text_in(names: Names, spot: Spot, text: str, without: str = "", depth: int = 0) -> str:
    """Return a text with the values of its names; ``without`` is a parameter that is not looked up."""
    if depth > DEEPEST:
        return ANY
    return _PART.sub(lambda it: _text_of_name(names, spot, it[1], without, depth + 1), text)


def _text_of_name(names: Names, spot: Spot, name: str, without: str, depth: int) -> str:
    """Return the text that a name stands for at a spot; the name in <> if that is unknown."""
    if name.isdigit():
        return name
    if name.startswith("@"):

        def braced_value(found: re.Match[str]) -> str:
            return braced(text_in(names, spot, f"<{found[1]}>", "", depth))

        return f"<{_BRACED.sub(braced_value, name)}>"
    if name.startswith(EACH):
        over = name.removeprefix(EACH)
        text = text_in(names, spot, f"<{over}>", without, depth)
        return f"<{EACH}{text[1:-1]}>" if text.startswith(f"<{LIST}") else f"<{over}>"
    if name.startswith(_AS_IT_IS):
        return f"<{name}>"
    rows = [*_candidates(names, spot, name, depth)]
    own = f"<@{without}>"
    found = {
        text_in(names, at, it, without, depth) for at, it in rows if it not in (f"<{name}>", own)
    }
    found = {it for it in found if it not in _NOTHING} or found
    of_parameters = {it for it in found if parameter_in(it)}
    rest = found - of_parameters
    if len(of_parameters) == 1 and all("<" not in it or it in FLAGS for it in rest):
        # A variable has the default until it is told the parameter.
        return of_parameters.pop()
    only = found.pop() if len(found) == 1 else ANY
    return only if only != ANY else f"<{name}>"


def _candidates(names: Names, spot: Spot, name: str, depth: int) -> Iterator[tuple[Spot, str]]:
    """Yield (spot, text) for each value that a name is set to, and where that is read."""
    if name in spot.given:
        yield spot._replace(given=NO_WORDS), spot.given[name]
    inside = _rows_inside(names, spot, name)
    if not _is_member(spot.made, name):
        yield from ((spot, it.text) for it in inside)
        if inside or name in spot.given:
            return
    taken = [it for it in names.takers.get((spot.owner, spot.function), ()) if name in it.names]
    if taken:
        defaults = {text for it in taken for word, text in it.defaults if word == name}
        yield from ((spot, it) for it in defaults or {ANY})
        return
    for owner in spot.made.owners:
        rows = names.members.get((owner, name), ()) if _is_member(spot.made, name) else ()
        yield from ((_spot_of(spot, it), it.text) for it in rows)
        if rows:
            return
    # What is set outside of functions, in the same file or once in all.
    word = name.rpartition(".")[2]
    every = [it for it in names.constants.get(word, ()) if it.text]
    near = [it for it in every if it.place.path == spot.path]
    if not near and ("." in name) and not word.isupper():
        return
    for it in near or every:
        yield (
            spot._replace(owner=it.owner, function="", given=NO_WORDS, path=it.place.path),
            it.text,
        )


def _rows_inside(names: Names, spot: Spot, name: str) -> tuple[Value, ...]:
    """Return what the function sets the name to, or the function around it."""
    function = spot.function
    while function:
        rows = names.setting.get((spot.owner, function, name), ())
        rows = rows if spot.owner else tuple(it for it in rows if it.place.path == spot.path)
        if rows:
            return rows
        function = function.rpartition(".")[0]
    return ()


def _is_member(made: Made, name: str) -> bool:
    head = name.partition(".")[0]
    return head == "self" or any(head in it.members for it in made.chain)


def _spot_of(spot: Spot, row: Value) -> Spot:
    """Return the place of the function that sets a member; of a constructor with known arguments."""
    makes = row.function in ("__init__", row.owner)
    given = spot.made.given.get(row.owner, NO_WORDS) if makes else NO_WORDS
    return spot._replace(owner=row.owner, function=row.function, given=given, path=row.place.path)


def default_of(names: Names, spot: Spot, parameter: str) -> str | None:
    """Return the default of a parameter; None if it is unknown."""
    wanted = f"@{parameter}"
    for owner in (*spot.made.owners, ""):
        rows = names.members.get((owner, wanted), ())
        found = {text_in(names, _spot_of(spot, it), it.text, parameter) for it in rows}
        if found:
            only = found.pop()
            number = only[1:-1].replace(".", "", 1).lstrip("-")
            is_value = only in FLAGS or (number.isdigit() and only[:1] == "<")
            return only if not found and ("<" not in only or is_value) else None
    return None


def type_in(names: Names, spot: Spot, type_: str) -> str:
    """Return a type as ROS writes it, by the names that it has where it is used; empty for others."""
    if type_.isidentifier():
        # A type may be given, as a name may.
        type_ = text_in(names, spot, f"<{type_}>").strip("<>") or type_
    for _ in range(DEEPEST):
        ros = _ROS_TYPE.search(type_)
        if ros:
            return "/".join(ros.groups())
        head, point, rest = type_.partition(".")
        if point:
            type_ = f"{_type_of_alias(names, spot, head)}::{rest}"
            continue
        name = last(type_.removeprefix("typename "))
        known = spot.made.types.get(name, "")
        near = known if known and known != type_ else _type_of_alias(names, spot, name)
        if not near or near == type_:
            return ""
        type_ = near
    return ""


def _type_of_alias(names: Names, spot: Spot, name: str) -> str:
    """Return the one type that an alias stands for; otherwise empty."""
    rows = names.aliases.get(name, ())
    own = {it.type for it in rows if it.owner in spot.made.owners}
    found = own or {it.type for it in rows}
    return found.pop() if len(found) == 1 else ""
