# SPDX-License-Identifier: Apache-2.0
"""Robots that start the same but for some texts -> what one function starts, and its calls.

The records of the robots are compared value by value, before anything is printed. A text that all of
them have stays as it is, whatever it says. A text that is the same but for the robot's name becomes an
f-string, if it gives the text of every robot. Any other text becomes a parameter of the function.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from itertools import count
from keyword import iskeyword
from typing import Any, NamedTuple

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.fleet.launch.starts import RobotStarts
from multibot_rewrite.planning.start import Start

FLAG = re.compile(r"-{1,2}[A-Za-z][\w-]*")
_POSE = {
    **{f"-{it}": it for it in "xyz"},
    **{f"--{it}": it for it in ("x", "y", "z", "roll", "pitch", "yaw")},
    **{"-R": "roll", "-P": "pitch", "-Y": "yaw"},
}
# Robots in which more differs are not of one kind.
_MOST = 12
_NAME = "name"
# What a launch file calls otherwise in its functions.
_TAKEN = frozenset((_NAME, "file", "text", "params", "str", "if_installed", "brought_up"))
# What is printed of a robot, but for people.
_VALUES = ("files", "starts", "not_bridged")
# Robots are of one kind only if they start the same programs.
_OF_PROGRAMS = frozenset(("package", "executable", "plugin", "condition", "needs"))


class Code(str):
    """Python that stands for a text which differs between robots."""

    __slots__ = ()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Code) and str.__eq__(self, other)

    __hash__ = str.__hash__


class Function(NamedTuple):
    """A function that starts robots; ``calls`` are the values of its parameters by robot."""

    title: str
    parameters: tuple[str, ...]
    starts: RobotStarts
    calls: Mapping[str, tuple[str, ...]]


def functions(robots: Sequence[RobotStarts]) -> list[Function]:
    """Return the functions for these robots, in the order of the first robot of each."""
    groups = lists_by_key((_common_shape(it), it) for it in robots)
    found = [one for group in groups.values() for one in _functions(group)]
    if len(found) == 1 and len(robots) > 1:
        return [found[0]._replace(title="start")]
    titles: list[str] = []
    for own in found:
        every = (own.title if number == 1 else f"{own.title}_{number}" for number in count(1))
        titles.append(next(it for it in every if it not in titles))
    return [own._replace(title=title) for own, title in zip(found, titles, strict=True)]


def of_any(text: str, robot: str) -> str:
    """Return a text for people with ``<name>`` in the place of the robot's name."""
    return "<name>".join(_split_at_name(text, robot))


def _common_shape(it: RobotStarts) -> object:
    """Return what robots of one function share: all but the texts of its own."""
    left = tuple((name, of_any(why, it.name)) for name, why in it.left)
    return left, it.clock, _without_texts([getattr(it, field) for field in _VALUES])


def _without_texts(it: Any, field: str = "") -> object:
    """Return a key of a value: its shape, with the texts that all robots share."""
    if isinstance(it, str):
        return it if field in _OF_PROGRAMS or FLAG.fullmatch(it) else ""
    if isinstance(it, Mapping):
        return tuple((_without_texts(key), _without_texts(one)) for key, one in it.items())
    if isinstance(it, tuple | list):
        return (type(it), *(_without_texts(one, name) for name, one in _items_with_fields(it)))
    return type(it), it


def _items_with_fields(it: Sequence[Any]) -> Iterator[tuple[str, Any]]:
    """Yield (field, item) for each item; the field of a program's argument is the flag before it."""
    if fields := getattr(it, "_fields", None):
        yield from zip(fields, it, strict=True)
        return
    before = ""
    for one in it:
        yield before, one
        before = one if isinstance(one, str) and FLAG.fullmatch(one) else ""


def _functions(group: Sequence[RobotStarts]) -> list[Function]:
    """Return the function of a group, or one for each robot where too much differs."""
    if len(group) > 1:
        merging = _Merging(tuple(it.name for it in group), {})
        starts = merging.starts(group)
        given = merging.parameters
        if len(given) <= _MOST:
            values = zip(*given.values(), strict=True) if given else iter([()] * len(group))
            calls = dict(zip(merging.names, values, strict=True))
            title = _function_name(group[0].description.partition(".")[0])
            return [Function(title, tuple(given), starts, calls)]
    return [Function(_function_name(it.name), (), it, {it.name: ()}) for it in group]


class _Merging(NamedTuple):
    """Names of robots of one kind, and the parameters known so far: each robot's value by name."""

    names: tuple[str, ...]
    parameters: dict[str, tuple[str, ...]]

    def starts(self, group: Sequence[RobotStarts]) -> RobotStarts:
        """Return what all robots of a group start, with parameters where they differ."""
        first = group[0]
        values = {it: self.one([getattr(own, it) for own in group], it) for it in _VALUES}
        left = tuple((name, of_any(why, first.name)) for name, why in first.left)
        return first._replace(
            description=_any_of([it.description for it in group], "description"),
            where=_any_of([of_any(it.where, it.name) for it in group], "namespace"),
            left=left,
            **values,
        )

    def one(self, values: Sequence[Any], label: str) -> Any:
        """Return one expression for the values of all robots, which have the same shape."""
        first = values[0]
        if isinstance(first, str):
            return self.text(values, label)
        if isinstance(first, Mapping):
            every = zip(*(it.items() for it in values), strict=True)
            return dict(self.pair(pairs) for pairs in every)
        if isinstance(first, tuple | list):
            labels = (name or label for name, _ in _items_with_fields(first))
            columns = zip(labels, zip(*values, strict=True), strict=True)
            own = [self.one(column, self.label(first, name, label)) for name, column in columns]
            return type(first)(*own) if hasattr(first, "_fields") else type(first)(own)
        return first

    def label(self, owner: Any, field: str, above: str) -> str:
        """Return a variable's name for a value: without the robot's name, a path's by its role."""
        if isinstance(owner, Start):
            return "node_name" if field == _NAME else field
        return above if field == "path" else field

    def pair(self, pairs: Sequence[tuple[str, Any]]) -> tuple[str, Any]:
        """Return a key and its value for those of all robots."""
        keys, values = zip(*pairs, strict=True)
        return self.text(keys, "key"), self.one(values, keys[0])

    def text(self, values: Sequence[str], label: str) -> str:
        """Return the text of all robots, or Python that gives the text of each."""
        if len(set(values)) == 1:
            return values[0]
        for value, name in zip(values, self.names, strict=True):
            parts = _split_at_name(value, name)
            if len(parts) > 1 and all(
                one.join(parts) == other for one, other in zip(self.names, values, strict=True)
            ):
                braced = (it.replace("{", "{{").replace("}", "}}") for it in parts)
                made = f"{{{_NAME}}}".join(braced)
                return Code(_NAME if parts == ["", ""] else f"f{made!r}")
        return self.parameter(values, label)

    def parameter(self, values: Sequence[str], label: str) -> Code:
        """Return a parameter of the function; one of the same values may be there already."""
        numbers = all(map(_is_number, values))
        given = tuple(values if numbers else map(repr, values))
        name = _parameter_name(label)
        every = (name if number == 1 else f"{name}_{number}" for number in count(1))
        own = next(it for it in every if self.parameters.get(it, given) == given)
        self.parameters[own] = given
        return Code(f"str({own})" if numbers else own)


def _split_at_name(text: str, robot: str) -> list[str]:
    """Return a text split at each occurrence of the robot's name."""
    return re.split(rf"(?<![A-Za-z0-9]){re.escape(robot)}(?![A-Za-z0-9])", text)


def _is_number(text: str) -> bool:
    """Return whether a text is a number that Python writes in the same way."""
    try:
        return str(float(text)) == text and text.strip("-")[0].isdigit()
    except ValueError:
        return False


def _parameter_name(label: str) -> str:
    """Return a name for a parameter, by the flag, keyword or key before its value."""
    word = "model" if label == "-name" else _POSE.get(label, label)
    word = re.sub(r"\W", "_", word, flags=re.ASCII).strip("_").lower()
    return word if word.isidentifier() and not iskeyword(word) and word not in _TAKEN else "value"


def _any_of(texts: Sequence[str], what: str) -> str:
    """Return the text of all robots for a comment, or that they have several."""
    return texts[0] if len(set(texts)) == 1 else f"its own {what}"


def _function_name(word: str) -> str:
    return f"start_{re.sub(r'[^0-9a-zA-Z_]', '_', word)}"
