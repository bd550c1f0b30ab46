# SPDX-License-Identifier: Apache-2.0
"""The interfaces that a controller claims, from templates of its node's table and its parameters.

A template is a name with parameters in <>: ``<joints>/<command_interfaces>`` stands for every joint
with every interface. ``<a|b>`` is the first of them that is set, ``<a=x>`` is ``x`` where it is not,
``<a+_>`` is its value and ``_``. ``[0..17]`` counts, ``[x,y]`` is each word. ``{a}`` in the name of a
parameter, or in the condition, is what stands for ``<a>``. A parameter that is not set and has no
default makes no name. ``<type>`` is the type of the controller.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.knowledge.conditions import Values, holds
from multibot_rewrite.knowledge.records import Claim
from multibot_rewrite.spelling.records import Given, Run
from multibot_rewrite.system.records import Place

TYPE, COMMAND = "type", "command"
_PART = re.compile(
    r"<(?P<names>[^<>=+]+)(?:\+(?P<after>[^<>=]*))?(?P<default>=[^<>]*)?>"
    r"|\[(?P<first>\d+)\.\.(?P<last>\d+)\]|\[(?P<words>[^\[\]]+)\]"
)


class Claimed(NamedTuple):
    """An interface that a controller claims: ``kind`` is command or state; ``place`` is where the
    parameters name it, None where only defaults do."""

    kind: str
    name: str
    place: Place | None


class _Made(NamedTuple):
    """The beginning of a name, the condition with what was chosen, and where that is written."""

    text: str
    condition: str
    place: Place | None


def claims_of(claims: Iterable[Claim], node: Run) -> Iterator[Claimed]:
    """The interfaces that a controller claims with its parameters, each once."""
    yield from claimed(claims, {**node.values, TYPE: Given(node.program, node.place)})


def claimed(claims: Iterable[Claim], values: Mapping[str, Given]) -> Iterator[Claimed]:
    """The interfaces that these claims make with these parameters, each once."""
    found: dict[tuple[str, str], Claimed] = {}
    for claim in claims:
        for made in _names(claim.template, _Made("", claim.condition, None), values):
            if made.text and holds(made.condition, _lookup(values)):
                found.setdefault(
                    (claim.kind, made.text), Claimed(claim.kind, made.text, made.place)
                )
    yield from found.values()


def claimed_twice(claims: Iterable[Claim], node: Run) -> Iterator[tuple[Claimed, Place]]:
    """Command interfaces that two parameters of a controller name; the second with the place of the
    first."""
    values, first = {**node.values, TYPE: Given(node.program, node.place)}, dict[str, Place]()
    for claim in (it for it in claims if it.kind == COMMAND):
        for made in _names(claim.template, _Made("", claim.condition, None), values):
            if made.place and holds(made.condition, _lookup(values)):
                other = first.setdefault(made.text, made.place)
                if other != made.place:
                    yield Claimed(claim.kind, made.text, made.place), other


def _lookup(values: Mapping[str, Given]) -> Values:
    return lambda name: values[name].value if name in values else None


def _names(template: str, made: _Made, values: Mapping[str, Given]) -> Iterator[_Made]:
    part = _PART.search(template)
    if part is None:
        yield made._replace(text=made.text + template)
        return
    slot, before, rest = f"{{{part['names']}}}", template[: part.start()], template[part.end() :]
    for word, place in _choices(part, values):
        text = f"{made.text}{before}{word}{(part['after'] or '') if word else ''}"
        found = _Made(text, made.condition.replace(slot, word), made.place or place)
        yield from _names(rest.replace(slot, word), found, values)


def _choices(
    part: re.Match[str], values: Mapping[str, Given]
) -> Iterator[tuple[str, Place | None]]:
    if not part["names"]:
        yield from ((it, None) for it in _counted(part))
        return
    given = next((values[it] for it in part["names"].split("|") if _is_set(values.get(it))), None)
    if given is not None:
        many = given.value if isinstance(given.value, list) else [given.value]
        yield from ((str(it), given.place) for it in many)
    elif part["default"] is not None:
        empty = next((values[it] for it in part["names"].split("|") if it in values), None)
        # An empty text in a file is the value; an empty list makes no name.
        words = part["default"][1:].split(",") if empty is None else [""] * (empty.value == "")
        yield from ((it, None) for it in words)


def _counted(part: re.Match[str]) -> list[str]:
    if part["words"]:
        return part["words"].split(",")
    return [str(it) for it in range(int(part["first"]), int(part["last"]) + 1)]


def _is_set(given: Given | None) -> bool:
    return given is not None and given.value not in ("", [])
