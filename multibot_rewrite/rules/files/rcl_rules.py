"""What rcl rejects in any parameter file, whatever node it is for, and what makes it skip a section.

Source: rcl_yaml_param_parser parse.c (``parse_value``: a sequence is of one type and of single values;
``PARAMS_KEY`` is ``ros__parameters``; what is above it is a name).
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator

import yaml

from multibot_rewrite.base.conventions import PLACEHOLDER
from multibot_rewrite.base.findings.finding import ERROR
from multibot_rewrite.base.model import InputError
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.companions.params.rcl_parameters import typed, value_of
from multibot_rewrite.companions.params.sections import ANY, PARAMETERS, scalars
from multibot_rewrite.companions.yaml_text import pairs
from multibot_rewrite.rules.files.records import Remark, remark_at

_PLACE = re.compile(r"^.*?:\d+(?::\d+)?: ")
_NEARLY = re.compile(r"_*ros_*param(?:eter)?s?_*", re.IGNORECASE)
_DEEP = 4
_TIME = "use_sim_time"


def rejected_values(file: NamedFile) -> Iterator[Remark]:
    """Lists of several types, of lists or of maps."""
    document = file.document
    if document is None:
        return
    for section, _ in file.pages:
        for node in _lists(section.body):
            if PLACEHOLDER.search(document.text[node.start_mark.index : node.end_mark.index]):
                continue
            try:
                value_of(document, node)
            except InputError as error:
                message = _PLACE.sub("", str(error))
                yield remark_at(node, f"rcl rejects the file: {message}", "", ERROR)


def _lists(node: yaml.Node) -> Iterator[yaml.Node]:
    for _, value in pairs(node):
        if isinstance(value, yaml.SequenceNode):
            yield value
        else:
            yield from _lists(value)


def misspelt_marks(file: NamedFile) -> Iterator[Remark]:
    """Keys that are nearly ``ros__parameters``: what is below is part of a name, and no parameter."""
    root = file.document.root if file.document else None
    for key in _keys(root, _DEEP):
        if key.value != PARAMETERS and _NEARLY.fullmatch(str(key.value)):
            message = f"{key.value!r} is no {PARAMETERS}: no node gets what is below it"
            yield remark_at(key, message, f"write {PARAMETERS}, with two underscores", ERROR)


def _keys(node: yaml.Node | None, deep: int) -> Iterator[yaml.ScalarNode]:
    for key, value in pairs(node):
        yield key
        if deep and key.value != PARAMETERS:
            yield from _keys(value, deep - 1)


def mixed_clocks(file: NamedFile) -> Iterator[Remark]:
    """Nodes of one file of which some are on simulated time and some say that they are not."""
    found: list[tuple[str, yaml.Node, bool]] = []
    for section, _ in file.pages:
        for key, value in scalars(section.body):
            given = typed(value.value) if not value.style else ""
            if key.value == _TIME and isinstance(given, bool) and not _is_wild(section.path):
                found.append((section.path, value, given))
    counted = Counter(given for *_, given in found)
    if len(counted) < 2:
        return
    most = counted.most_common(1)[0][0]
    for path, node, given in found:
        if given != most:
            other = next(it for it, _, value in found if value == most)
            message = f"{path} has {_TIME}: {_word(given)}, and {other} {_word(most)}"
            yield remark_at(
                node, message, "set it alike in all nodes of a robot: tf compares times"
            )


def _is_wild(path: str) -> bool:
    return bool(PLACEHOLDER.search(path)) or any(it in ANY for it in path.split("/"))


def _word(value: bool) -> str:
    return str(value).lower()
