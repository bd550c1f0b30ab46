# SPDX-License-Identifier: Apache-2.0
"""The functions of ``fleet.launch.py``: one for robots that run the same, called with what differs.

What a robot runs is written with its own names first. Then its name in a text becomes ``{name}``, and
a text in which robots still differ becomes a parameter of the function: whatever is taken for the name
of a robot, the values of a call are those that were written.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence

from multibot_rewrite.base.markup import STRING
from multibot_rewrite.base.record import NamedTuple

_TEXT = re.compile(STRING)
# What these say is no robot's.
_OF_PROGRAMS = ("package=", "executable=", "plugin=", "#")
_POSE = {
    **{f"-{it}": it for it in "xyz"},
    **{f"--{it}": it for it in ("x", "y", "z", "roll", "pitch", "yaw")},
    **{"-R": "roll", "-P": "pitch", "-Y": "yaw"},
}
# More than this would be no function for one kind of robot.
_MOST = 12
_NAME = "name"


class Written(NamedTuple):
    """What one robot runs: its name, what it is, the name of its description, and the lines that start
    it."""

    name: str
    about: str
    kind: str
    lines: Sequence[str]


class Parameter(NamedTuple):
    """What differs: its name in the function, and the value of each robot as Python has it."""

    name: str
    values: tuple[str, ...]

    @property
    def is_number(self) -> bool:
        """Are all of them numbers?"""
        return all(not it.startswith('"') for it in self.values)


class Function(NamedTuple):
    """A function that starts robots, and the calls: each robot's name and call."""

    lines: tuple[str, ...]
    calls: tuple[tuple[str, str], ...]


def functions(robots: Sequence[Written]) -> list[Function]:
    """The functions for these robots, in the order in which their first ones come."""
    groups: dict[tuple[str, ...], list[Written]] = {}
    for it in robots:
        groups.setdefault(tuple(_TEXT.sub('""', line) for line in _templates(it)), []).append(it)
    kinds = [own for group in groups.values() for own in _alike(group)]
    used: list[str] = []
    return [_function(group, _unique(_title(group, len(kinds)), used)) for group in kinds]


def _alike(group: list[Written]) -> list[list[Written]]:
    """The group, or each robot alone where too much differs."""
    return [group] if len(_parameters(group)) <= _MOST else [[it] for it in group]


def _title(group: Sequence[Written], kinds: int) -> str:
    if len(group) == 1:
        return f"start_{group[0].name}"
    return "start" if kinds == 1 else f"start_{re.sub(r'[^0-9a-zA-Z_]', '_', group[0].kind)}"


def _unique(name: str, used: list[str]) -> str:
    count = used.count(name)
    used.append(name)
    return f"{name}_{count + 1}" if count else name


def _function(group: Sequence[Written], title: str) -> Function:
    first = group[0]
    if len(group) == 1:
        head = (f"def {title}():", f'    """Start {first.about}."""')
        return Function((*head, *first.lines), ((first.name, title),))
    given = _parameters(group)
    names = list(dict.fromkeys(it.name for it in given.values()))
    about = _of_any(first.about, first.name, "<name>")
    head = (f"def {title}({', '.join((_NAME, *names))}):", f'    """Start {about}."""')
    body = (_with(line, at, given) for at, line in enumerate(_templates(first)))
    values = {it.name: it.values for it in given.values()}
    calls = []
    for number, it in enumerate(group):
        words = [f"{key}={own[number]}" for key, own in values.items()]
        told = ", ".join((title, f'"{it.name}"', *words))
        calls.append((it.name, f"partial({told})"))
    return Function((*head, *body), tuple(calls))


def _templates(it: Written) -> list[str]:
    """The lines with the robot's name as a parameter."""
    return [_template(line, it.name) for line in it.lines]


def _template(line: str, robot: str) -> str:
    if line.lstrip().startswith(_OF_PROGRAMS):
        return _of_any(line, robot, "<name>") if line.lstrip().startswith("#") else line
    return _TEXT.sub(lambda found: _named(found[0], robot), line)


def _named(text: str, robot: str) -> str:
    """A text with the name in it, as an f-string; the name alone is the parameter."""
    if text == f'"{robot}"':
        return f'f"{{{_NAME}}}"'
    own = _of_any(text.replace("{", "{{").replace("}", "}}"), robot, f"{{{_NAME}}}")
    return f"f{own}" if f"{{{_NAME}}}" in own and own != text else text


def _of_any(text: str, robot: str, word: str) -> str:
    return re.sub(rf"(?<![A-Za-z0-9]){re.escape(robot)}(?![A-Za-z0-9])", lambda _: word, text)


def _parameters(group: Sequence[Written]) -> dict[tuple[int, int], Parameter]:
    """Return the texts that differ besides the robot's name, by line and number of the text in it.

    The values of a parameter are the texts that each robot has, not their templates.
    """
    found: dict[tuple[int, int], Parameter] = {}
    templates = zip(*map(_templates, group), strict=True)
    for at, (lines, own) in enumerate(
        zip(templates, zip(*(it.lines for it in group), strict=True), strict=True)
    ):
        for number, texts in enumerate(zip(*map(_TEXT.findall, lines), strict=True)):
            if len(set(texts)) > 1:
                values = tuple(_TEXT.findall(it)[number] for it in own)
                found[at, number] = _parameter(lines[0], number, values, found.values())
    return found


def _parameter(
    line: str, number: int, texts: tuple[str, ...], known: Iterable[Parameter]
) -> Parameter:
    """One that is known has the same values and would have the same name."""
    name = _called(line, number)
    values = tuple(map(_as_number, texts))
    whole = values if all(values) else texts
    taken = {it.name: it.values for it in known}
    unused = (it for it in _names(name) if taken.get(it, whole) == whole)
    return Parameter(next(unused), whole)


def _names(name: str) -> Iterator[str]:
    yield name
    yield from (f"{name}_{number}" for number in range(2, 10_000))


def _as_number(text: str) -> str:
    """The number that a text is and that gives this text again; else nothing."""
    word = text.strip('"')
    try:
        return word if str(float(word)) == word else ""
    except ValueError:
        return ""


def _called(line: str, number: int) -> str:
    """By the flag before the text, else by the keyword or key of its line."""
    texts = list(_TEXT.finditer(line))
    before = texts[number - 1][0].strip('"') if number else ""
    if before in _POSE:
        return _POSE[before]
    keyword = re.match(r"\s*(\w+)=", line)
    word = keyword[1] if keyword and not before.startswith("-") else before
    word = "model" if word == "-name" else word
    word = re.sub(r"\W", "_", word).strip("_").lower()
    return word if word.isidentifier() and word != _NAME else "value"


def _with(line: str, at: int, given: dict[tuple[int, int], Parameter]) -> str:
    """The line with its parameters in the place of the texts that differ."""
    numbers = iter(range(line.count('"')))

    def one(found: re.Match[str]) -> str:
        parameter = given.get((at, next(numbers)))
        if parameter is None:
            return found[0]
        return f"str({parameter.name})" if parameter.is_number else parameter.name

    return re.sub(rf"f?{STRING}", one, line).replace(f'f"{{{_NAME}}}"', _NAME)
