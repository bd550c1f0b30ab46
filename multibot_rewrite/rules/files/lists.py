"""Words of a list that have no parameters, while parameters of a likely name are in no list.

Nodes read ``NAME.type``, ``NAME.topic`` or ``NAME.plugin`` for each NAME of a list: sources, layers,
plugins, filters, docks. What is not listed is not read.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from multibot_rewrite.base.findings.finding import WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.nearest import nearest
from multibot_rewrite.companions.kinds import PARAMS
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.producers.evidence.records import Given
from multibot_rewrite.rules.files.examples import a_section
from multibot_rewrite.rules.files.given import did_you_mean_at, given_in, is_in
from multibot_rewrite.rules.files.records import Remark
from multibot_rewrite.system.records import Place

_DIGITS = str.maketrans("", "", "0123456789")


def _sources(name: str) -> str:
    lines = f"observation_sources: [{name}]\n    front: {{type: scan, topic: scan}}"
    return a_section("collision_monitor", lines)


@rule(
    "MB877",
    "listed-name-without-parameters",
    WARNING,
    what="A list of a node (sources, plugins, layers, filters) has a name without parameters, and "
    "parameters of nearly that name are in no list.",
    why="The node reads the parameters of the names in its list: it uses defaults, or does not start.",
    fix="Write the name alike in both places.",
    bad=_sources("frnt"),
    good=_sources("front"),
    line=3,
    formats=(PARAMS,),
)
def listed_without_parameters(file: NamedFile) -> Iterator[Remark]:
    """Each list of each node."""
    for node in given_in(file):
        bodies = _bodies(node.values)
        used = {word for it in node.values.values() for word in _words(it)}
        for parameter, value in node.values.items() if bodies else ():
            own = bodies.get(parameter.rpartition(".")[0], {})
            left = [it for it in own if it not in used]
            for word in _words(value) if left and is_in(file, value.place) else ():
                near = nearest(word, left) if word not in own else ""
                if near and near.translate(_DIGITS) != word.translate(_DIGITS):
                    message = f"{node.name} has {word} in {parameter}, without parameters"
                    hint = did_you_mean_at(near, own[near])
                    yield Remark(value.place.line, 1, message, hint)


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
