# SPDX-License-Identifier: Apache-2.0
"""Keys that are repeated, overridden or without a value, and words of a list without parameters.

Nodes read ``NAME.type``, ``NAME.topic`` or ``NAME.plugin`` for each NAME of a list: sources, layers,
plugins, filters, docks. What is not listed is not read.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from multibot_rewrite.base.findings.finding import WARNING, Finding
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.nearest import nearest
from multibot_rewrite.companions.kinds import MOVEIT, PARAMS
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.companions.params.sections import ParamSection, flattened, is_for
from multibot_rewrite.companions.yaml_text import line_of
from multibot_rewrite.rules.files.given import did_you_mean_at, given_in, is_in
from multibot_rewrite.rules.places import remark, remark_at
from multibot_rewrite.spelling.records import Given
from multibot_rewrite.system.records import Place


@rule("MB859", "repeated-key", WARNING, formats=(PARAMS, MOVEIT))
def repeated_key(file: NamedFile) -> Iterator[Finding]:
    """Every key that is there before in the same map."""
    for site in file.twice:
        message = f"{site.text!r} is set twice; the later value counts"
        yield remark(site, message, "remove one of them")


@rule("MB866", "repeated-section", WARNING, formats=(PARAMS,))
def repeated_section(file: NamedFile) -> Iterator[Finding]:
    """Every section of a node but its first."""
    first: dict[str, ParamSection] = {}
    for section, _ in file.pages:
        earlier = first.setdefault(section.path, section)
        if earlier is not section:
            line = line_of(earlier.keys[-1])
            message = f"section {section.path} is repeated; the first is in line {line}"
            hint = "rcl merges the two, PyYAML keeps only the last; merge them into one"
            yield remark_at(section.keys[-1], message, hint)


@rule("MB867", "wildcard-overrides-section", WARNING, formats=(PARAMS,))
def overridden(file: NamedFile) -> Iterator[Finding]:
    """What a wildcard section sets after the section of a node that it matches."""
    sections = [section for section, _ in file.pages]
    for at, section in enumerate(sections):
        if not section.wild:
            continue
        here = dict(flattened(section.body))
        for earlier in sections[:at]:
            if earlier.wild or not is_for(section.full, earlier.full):
                continue
            for name in here.keys() & dict(flattened(earlier.body)).keys():
                message = (
                    f"{name} of {earlier.path} is overridden by the later section {section.path}"
                )
                yield remark_at(here[name], message, "put wildcard sections first")


@rule("MB868", "parameter-without-value", WARNING, formats=(PARAMS,))
def no_value(file: NamedFile) -> Iterator[Finding]:
    """Keys of parameters without a value."""
    for _, names in file.pages:
        for key in names.empty:
            message = f"{key.value!r} has no value"
            yield remark_at(key, message, 'rcl rejects the whole file; write a value, or ""')


_DIGITS = str.maketrans("", "", "0123456789")


@rule("MB877", "listed-name-without-parameters", WARNING, formats=(PARAMS,))
def listed_without_parameters(file: NamedFile) -> Iterator[Finding]:
    """Each list of each node."""
    for node in given_in(file):
        bodies = _bodies(node.values)
        used = {word for it in node.values.values() for word in _words(it)}
        for parameter, value in node.values.items() if bodies else ():
            own = bodies.get(parameter.rpartition(".")[0], {}) if _is_list(parameter, value) else {}
            left = [it for it in own if it not in used]
            for word in _words(value) if left and is_in(file, value.place) else ():
                # A word with a dot has its parameters below several names.
                near = nearest(word, left) if word.partition(".")[0] not in own else ""
                if near and near.translate(_DIGITS) != word.translate(_DIGITS):
                    message = f"{node.node} has {word} in {parameter}, without parameters"
                    hint = did_you_mean_at(near, own[near])
                    yield remark(value.place._replace(column=1), message, hint)


def _is_list(parameter: str, given: Given) -> bool:
    """Are these names? A text is a list in ``observation_sources``, a joint of a controller is not."""
    return isinstance(given.value, list) or parameter.endswith(("s", "plugin"))


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
