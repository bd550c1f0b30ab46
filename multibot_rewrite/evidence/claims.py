"""The interfaces that a controller claims, from templates of nodes.yaml and its parameters.

A template is a name with parameters in <>: ``<joints>/<command_interfaces>`` stands for every joint
with every interface. ``<a|b>`` is the first of them that is set, ``<a=x>`` is ``x`` where it is not,
``[0..17]`` counts. A parameter that is not set and has no default makes no name.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from itertools import product
from typing import NamedTuple

from multibot_rewrite.evidence.records import Given, Place
from multibot_rewrite.remap.conditions import holds
from multibot_rewrite.remap.records import Claim

_PART = re.compile(r"<(?P<names>[^<>=]+)(?P<default>=[^<>]*)?>|\[(?P<first>\d+)\.\.(?P<last>\d+)\]")


class Claimed(NamedTuple):
    """An interface that a controller claims: ``kind`` is command or state; ``place`` is where the
    parameters name it, None where only defaults do."""

    kind: str
    name: str
    place: Place | None


def claimed(claims: tuple[Claim, ...], values: Mapping[str, Given]) -> Iterator[Claimed]:
    """The interfaces that a controller with these parameters claims, each once."""
    found: dict[tuple[str, str], Claimed] = {}
    for claim in claims:
        if holds(claim.condition, lambda name: values[name].value if name in values else None):
            for name, place in _names(claim.template, values):
                found.setdefault((claim.kind, name), Claimed(claim.kind, name, place))
    yield from found.values()


def _names(template: str, values: Mapping[str, Given]) -> Iterator[tuple[str, Place | None]]:
    parts = list(_PART.finditer(template))
    fixed = _PART.split(template)[:: _PART.groups + 1]
    choices = [list(_choices(part, values)) for part in parts]
    for chosen in product(*choices):
        words = (text + word for text, (word, _) in zip(fixed, chosen, strict=False))
        places = [place for _, place in chosen if place]
        yield "".join(words) + fixed[-1], places[0] if places else None


def _choices(
    part: re.Match[str], values: Mapping[str, Given]
) -> Iterator[tuple[str, Place | None]]:
    if part["first"]:
        yield from ((str(it), None) for it in range(int(part["first"]), int(part["last"]) + 1))
        return
    given = next((values[it] for it in part["names"].split("|") if _is_set(values.get(it))), None)
    if given is not None:
        many = given.value if isinstance(given.value, list) else [given.value]
        yield from ((str(it), given.place) for it in many)
    elif part["default"] is not None:
        yield from ((it, None) for it in part["default"][1:].split(","))


def _is_set(given: Given | None) -> bool:
    return given is not None and given.value not in ("", [])
