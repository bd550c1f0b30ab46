# SPDX-License-Identifier: Apache-2.0
"""What rcl rejects in any parameter file, whatever node it is for, and what makes it skip a section.

Source: rcl_yaml_param_parser parse.c (``parse_value``: a sequence is of one type and of single values;
``PARAMS_KEY`` is ``ros__parameters``; what is above it is a name; ``parse_file_events``: "Cannot have a
value before ros__parameters").
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator

import yaml

from multibot_rewrite.base.conventions import PLACEHOLDER
from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.nearest import slip_of
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.companions.kinds import PARAMS
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.companions.params.rcl_parameters import typed, value_of
from multibot_rewrite.companions.params.sections import ANY, PARAMETERS, ParamSection, scalars
from multibot_rewrite.companions.yaml_text import pairs
from multibot_rewrite.rules.places import remark_at

_PLACE = lazy_compile(r"^.*?:\d+(?::\d+)?: ")
_NEARLY = lazy_compile(r"_*ros_*param(?:eter)?s?_*", re.IGNORECASE)
_DEEP = 4
# What a launch file or a template puts something in place of; a brace alone begins a map.
_FILLED_IN = lazy_compile(r"[<$%]|\{\{")
_TIME = "use_sim_time"


def rejected_values(file: NamedFile) -> Iterator[Finding]:
    """Lists of several types, of lists or of maps."""
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
    """Values that are below no ``ros__parameters``: the first one of each top key."""
    for key, below in pairs(file.document.root if file.document else None):
        value = None if file.kind != PARAMS else next(_outside(key, below), None)
        if value:
            message = f"rcl rejects the file: {key.value} has values that are below no {PARAMETERS}"
            hint = f"write {PARAMETERS}: above them, or take them out of the file"
            yield remark_at(value, message, hint, ERROR)


def _outside(key: yaml.ScalarNode, node: yaml.Node) -> Iterator[yaml.ScalarNode]:
    """The keys of such values; what is below another spelling of the mark is told there."""
    if key.value == PARAMETERS or _is_nearly_mark(key):
        return
    if not isinstance(node, yaml.MappingNode):
        yield key
    for inner, below in pairs(node):
        yield from _outside(inner, below)


def _lists(node: yaml.Node) -> Iterator[yaml.Node]:
    for _, value in pairs(node):
        if isinstance(value, yaml.SequenceNode):
            yield value
        else:
            yield from _lists(value)


def _is_read(node: yaml.Node) -> bool:
    """Is it one of values? rcl 9.2 takes ``- key: [a]``, and rejects maps of two keys."""
    maps = [it for it in node.value if isinstance(it, yaml.MappingNode)]
    return not maps or any(len(it.value) > 1 for it in maps)


def misspelt_marks(file: NamedFile) -> Iterator[Finding]:
    """Keys that are nearly ``ros__parameters``: what is below is part of a name, and no parameter."""
    root = file.document.root if file.document else None
    for key in _keys(root, _DEEP):
        if key.value != PARAMETERS and _is_nearly_mark(key):
            message = f"{key.value!r} is no {PARAMETERS}: no node gets what is below it"
            yield remark_at(key, message, f"write {PARAMETERS}, with two underscores", ERROR)
    for section, _ in file.pages:
        for key in _keys(section.body, _DEEP):
            if key.value == PARAMETERS:
                message = f"a section below the {PARAMETERS} of {section.path}: no node reads it"
                yield remark_at(key, message, "move it out, to where that section begins", WARNING)


def _is_nearly_mark(key: yaml.ScalarNode) -> bool:
    word = str(key.value)
    return bool(_NEARLY.fullmatch(word) or slip_of(word, (PARAMETERS,)))


def _keys(node: yaml.Node | None, deep: int) -> Iterator[yaml.ScalarNode]:
    for key, value in pairs(node):
        yield key
        if deep and key.value != PARAMETERS:
            yield from _keys(value, deep - 1)


def mixed_clocks(file: NamedFile) -> Iterator[Finding]:
    """Nodes of one file of which some are on simulated time and some say that they are not."""
    found: list[tuple[str, yaml.Node, bool]] = []
    for section, _ in file.pages:
        for key, value in scalars(section.body):
            given = typed(value.value) if not value.style else ""
            if key.value == _TIME and isinstance(given, bool) and not _is_left_out(section):
                found.append((section.path, value, given))
    counted = Counter(given for *_, given in found)
    if len(counted) < 2:
        return
    most = counted.most_common(1)[0][0]
    others = [(path, node) for path, node, given in found if given != most]
    first = next(path for path, _, value in found if value == most)
    names = shorten(path for path, _ in others)
    message = f"{_TIME} is {_word(not most)} for {names}, and {_word(most)} for {first}"
    yield remark_at(
        others[0][1], message, "set it alike in all nodes of a robot: tf compares times"
    )


def _is_left_out(section: ParamSection) -> bool:
    """Is it for no one node, or for a helper node of old releases?"""
    wild = any(it in ANY for it in section.path.split("/"))
    return wild or section.inner or PLACEHOLDER.search(section.path) is not None


def _word(value: bool) -> str:
    return str(value).lower()
