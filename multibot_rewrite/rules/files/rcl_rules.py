# SPDX-License-Identifier: Apache-2.0
"""What rcl rejects or skips in any parameter file, whatever node it is for.

Also keys that are repeated, overridden or without a value, and words of a list without parameters.
Nodes read ``NAME.type``, ``NAME.topic`` or ``NAME.plugin`` for each NAME of a list: sources,
layers, plugins, filters, docks. What is not listed is not read.

Source: rcl_yaml_param_parser parse.c (``parse_value``: a sequence is of one type and of single
values; ``PARAMS_KEY`` is ``ros__parameters``; what is above it is a name; ``parse_file_events``:
"Cannot have a value before ros__parameters")."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator

import yaml

from multibot_rewrite.base.conventions import PLACEHOLDER
from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding, rule
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.nearest import differ_in_numbers, nearest, slip_of
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.knowledge.conditions import word_of
from multibot_rewrite.planning.records import Given
from multibot_rewrite.related_files.named_file import MOVEIT, PARAMS, NamedFile
from multibot_rewrite.related_files.params.rcl_parameters import typed, value_of
from multibot_rewrite.related_files.params.sections import (
    ANY,
    PARAMETERS,
    ParamSection,
    flattened,
    is_for,
    scalars,
)
from multibot_rewrite.related_files.yaml_text import line_of, pairs
from multibot_rewrite.rules.declaration import remark, remark_at
from multibot_rewrite.rules.files.section_facts import did_you_mean_at, given_in, is_in
from multibot_rewrite.system.records import Place

_PLACE = lazy_compile(r"^.*?:\d+(?::\d+)?: ")
_NEARLY = lazy_compile(r"_*ros_*param(?:eter)?s?_*", re.IGNORECASE)
_DEEP = 4
# What a launch file or a template puts something in place of; a brace alone begins a map.
_FILLED_IN = lazy_compile(r"[<$%]|\{\{")
_TIME = "use_sim_time"


def rejected_values(file: NamedFile) -> Iterator[Finding]:
    """Yield the values that rcl rejects: lists of several types, of lists or of maps."""
    document = file.document
    if document is None:
        return
    for section, _ in file.pages:
        for node in filter(_is_read, _lists(section.body)):
            if _FILLED_IN.search(document.text[node.start_mark.index : node.end_mark.index]):
                continue
            try:
                value_of(document, node)
            except InputError as error:
                message = _PLACE.sub("", str(error))
                yield remark_at(node, f"rcl rejects the file: {message}", "", ERROR)


def outside_of_marks(file: NamedFile) -> Iterator[Finding]:
    """Report values that are below no ``ros__parameters``: the first one of each top key."""
    for key, below in pairs(file.document.root if file.document else None):
        value = None if file.kind != PARAMS else next(_keys_outside(key, below), None)
        if value:
            message = f"rcl rejects the file: {key.value} has values that are below no {PARAMETERS}"
            hint = f"write {PARAMETERS}: above them, or take them out of the file"
            yield remark_at(value, message, hint, ERROR)


def _keys_outside(key: yaml.ScalarNode, node: yaml.Node) -> Iterator[yaml.ScalarNode]:
    """Yield the keys of values outside of ``ros__parameters``; a misspelt mark has its own finding."""
    if key.value == PARAMETERS or _is_nearly_mark(key):
        return
    if not isinstance(node, yaml.MappingNode):
        yield key
    for inner, below in pairs(node):
        yield from _keys_outside(inner, below)


def _lists(node: yaml.Node) -> Iterator[yaml.Node]:
    for _, value in pairs(node):
        if isinstance(value, yaml.SequenceNode):
            yield value
        else:
            yield from _lists(value)


def _is_read(node: yaml.Node) -> bool:
    """Return whether rcl reads a list; 9.2 takes ``- key: [a]``, and no maps of two keys."""
    maps = [it for it in node.value if isinstance(it, yaml.MappingNode)]
    return not maps or any(len(it.value) > 1 for it in maps)


def misspelt_marks(file: NamedFile) -> Iterator[Finding]:
    """Report keys that are nearly ``ros__parameters``: no node reads what is below them."""
    root = file.document.root if file.document else None
    for key in _keys_down_to(root, _DEEP):
        if key.value != PARAMETERS and _is_nearly_mark(key):
            message = f"{key.value!r} is no {PARAMETERS}: no node gets what is below it"
            yield remark_at(key, message, f"write {PARAMETERS}, with two underscores", ERROR)
    for section, _ in file.pages:
        for key in _keys_down_to(section.body, _DEEP):
            if key.value == PARAMETERS:
                message = f"a section below the {PARAMETERS} of {section.path}: no node reads it"
                yield remark_at(key, message, "move it out, to where that section begins", WARNING)


def _is_nearly_mark(key: yaml.ScalarNode) -> bool:
    word = str(key.value)
    return bool(_NEARLY.fullmatch(word) or slip_of(word, (PARAMETERS,)))


def _keys_down_to(node: yaml.Node | None, deep: int) -> Iterator[yaml.ScalarNode]:
    """Yield the keys below a node, ``deep`` levels down, not those of parameters."""
    for key, value in pairs(node):
        yield key
        if deep and key.value != PARAMETERS:
            yield from _keys_down_to(value, deep - 1)


def mixed_clocks(file: NamedFile) -> Iterator[Finding]:
    """Report nodes of one file of which some are on simulated time and some say they are not."""
    found: list[tuple[str, yaml.Node, bool]] = []
    for section, _ in file.pages:
        # Not for those of no one node, and for helper nodes of old releases.
        wild = any(it in ANY for it in section.path.split("/"))
        if wild or section.inner or PLACEHOLDER.search(section.path):
            continue
        for key, value in scalars(section.body):
            given = typed(value.value) if not value.style else ""
            if key.value == _TIME and isinstance(given, bool):
                found.append((section.path, value, given))
    counted = Counter(given for *_, given in found)
    if len(counted) < 2:
        return
    most = counted.most_common(1)[0][0]
    others = [(path, node) for path, node, given in found if given != most]
    first = next(path for path, _, value in found if value == most)
    names = shorten(path for path, _ in others)
    message = f"{_TIME} is {word_of(not most)} for {names}, and {word_of(most)} for {first}"
    hint = "set it alike in all nodes of a robot: tf compares times"
    yield remark_at(others[0][1], message, hint)


@rule("MB859", "repeated-key", WARNING, formats=(PARAMS, MOVEIT))
def repeated_key(file: NamedFile) -> Iterator[Finding]:
    """Report every key that occurs before in the same map."""
    for site in file.twice:
        message = f"{site.text!r} is set twice; the later value counts"
        yield remark(site, message, "remove one of them")


@rule("MB866", "repeated-section", WARNING, formats=(PARAMS,))
def repeated_section(file: NamedFile) -> Iterator[Finding]:
    """Report every section of a node but its first."""
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
    """Yield the values that a later wildcard section overrides in a section that it matches."""
    sections = [section for section, _ in file.pages]
    for at, section in enumerate(sections):
        if not section.wild:
            continue
        here = dict(flattened(section.body))
        for earlier in sections[:at]:
            if earlier.wild or not is_for(section.full, earlier.full):
                continue
            for name in here.keys() & dict(flattened(earlier.body)).keys():
                later = f"the later section {section.path}"
                message = f"{name} of {earlier.path} is overridden by {later}"
                yield remark_at(here[name], message, "put wildcard sections first")


@rule("MB868", "parameter-without-value", WARNING, formats=(PARAMS,))
def no_value(file: NamedFile) -> Iterator[Finding]:
    """Report keys of parameters without a value."""
    for _, names in file.pages:
        for key in names.empty:
            message = f"{key.value!r} has no value"
            yield remark_at(key, message, 'rcl rejects the whole file; write a value, or ""')


@rule("MB877", "listed-name-without-parameters", WARNING, formats=(PARAMS,))
def listed_without_parameters(file: NamedFile) -> Iterator[Finding]:
    """Report names in lists of a node without parameters, but like one there that no list has."""
    for node in given_in(file):
        # Below each parameter the names with parameters of their own, each at its first place.
        bodies: dict[str, dict[str, Place]] = {}
        for name, given in node.values.items():
            parts = name.split(".")
            for depth in range(len(parts) - 1):
                above = ".".join(parts[:depth])
                bodies.setdefault(above, {}).setdefault(parts[depth], given.place)
        used = {word for it in node.values.values() for word in _names_of_list(it)}
        for parameter, value in node.values.items() if bodies else ():
            # A text is a list in ``observation_sources``, a joint of a controller is not.
            is_list = isinstance(value.value, list) or parameter.endswith(("s", "plugin"))
            own = bodies.get(parameter.rpartition(".")[0], {}) if is_list else {}
            left = [it for it in own if it not in used]
            for word in _names_of_list(value) if left and is_in(file, value.place) else ():
                # A word with a dot has its parameters below several names.
                near = nearest(word, left) if word.partition(".")[0] not in own else ""
                if near and not differ_in_numbers(near, word):
                    message = f"{node.node} has {word} in {parameter}, without parameters"
                    hint = did_you_mean_at(near, own[near])
                    yield remark(value.place._replace(column=1), message, hint)


def _names_of_list(given: Given) -> list[str]:
    """Return the names of a list; some lists are texts of words."""
    value = given.value
    words = value if isinstance(value, list) else [value]
    return [part for it in words if isinstance(it, str) for part in it.split()]
