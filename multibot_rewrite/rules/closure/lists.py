"""Words of a list that have no parameters, while parameters of a likely name are in no list.

Nodes read ``NAME.type``, ``NAME.topic`` or ``NAME.plugin`` for each NAME of a list: sources, layers,
plugins, filters, docks. What is not listed is not read.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from multibot_rewrite.base.nearest import nearest
from multibot_rewrite.producers.evidence.records import Given, GivenNode
from multibot_rewrite.rules.closure.gap import Gap
from multibot_rewrite.system.records import Place

LISTED = "listed"
_DIGITS = str.maketrans("", "", "0123456789")


def list_gaps(given: Iterable[GivenNode]) -> Iterator[Gap]:
    """Listed names without parameters; ``near`` is the name that has some."""
    for node in given:
        bodies = _bodies(node.values)
        used = {word for it in node.values.values() for word in _words(it)}
        for parameter, value in node.values.items() if bodies else ():
            above = parameter.rpartition(".")[0]
            own = bodies.get(above, {})
            left = [it for it in own if it not in used]
            for number, word in enumerate(_words(value) if left else ()):
                near = nearest(word, left) if word not in own else ""
                if near and near.translate(_DIGITS) != word.translate(_DIGITS):
                    key = (LISTED, node.known, parameter, str(number))
                    name = f"{word} in {parameter}"
                    yield Gap(LISTED, name, node.name, key, value.place, near, own[near])


def _bodies(values: Mapping[str, Given]) -> dict[str, dict[str, Place]]:
    """Below each parameter the names that have parameters of their own, with the place of the first."""
    found: dict[str, dict[str, Place]] = {}
    for name, given in values.items():
        parts = name.split(".")
        for depth in range(len(parts) - 1):
            above = ".".join(parts[:depth])
            found.setdefault(above, {}).setdefault(parts[depth], given.place)
    return found


def _words(given: Given) -> list[str]:
    """The names of a list; some lists are texts of words."""
    value = given.value
    words = value if isinstance(value, list) else [value]
    return [part for it in words if isinstance(it, str) for part in it.split()]
