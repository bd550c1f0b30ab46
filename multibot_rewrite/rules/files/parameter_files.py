# SPDX-License-Identifier: Apache-2.0
"""Parameters that generate_parameter_library makes of a YAML file.

Source: https://github.com/PickNikRobotics/generate_parameter_library (README, "YAML Syntax").
"""

from __future__ import annotations

from collections.abc import Iterator

import yaml

from multibot_rewrite.base.bounded import compose_yaml
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.companions.yaml_text import pairs

# The types of parameters; an array may have a length behind it: double_array_fixed_6.
_TYPES = ("bool", "double", "int", "string", "none")
_MAP = "__map_"
NO_DEFAULT = ""
EMPTY = '""'


class FileParameter(NamedTuple):
    """A parameter of such a file; ``owner`` is the file's top key."""

    owner: str
    path: str
    type: str
    default: str
    bounds: str
    read_only: str
    line: int


def file_parameters(text: str) -> tuple[FileParameter, ...]:
    """The parameters of a file; none if it is another kind of YAML."""
    try:
        root = compose_yaml(text, "")
    except InputError:
        return ()
    found = [
        found
        for owner, below in pairs(root)
        for found in _parameters(owner.value, below, ())
        if found.path
    ]
    return tuple(found)


def _parameters(owner: str, node: yaml.Node, path: tuple[str, ...]) -> Iterator[FileParameter]:
    keys = {key.value: value for key, value in pairs(node)}
    if _is_type(keys.get("type")):
        yield _parameter(owner, node, path, keys)
        return
    for key, below in pairs(node):
        yield from _parameters(owner, below, (*path, _segment(key.value)))


def _is_type(node: yaml.Node | None) -> bool:
    if not isinstance(node, yaml.ScalarNode):
        return False
    return node.value.partition("_")[0] in _TYPES


def _segment(word: str) -> str:
    """``__map_joints`` stands for each of the names in the parameter ``joints``."""
    return f"<{word.removeprefix(_MAP)}>" if word.startswith(_MAP) else word


def _parameter(
    owner: str, node: yaml.Node, path: tuple[str, ...], keys: dict[str, yaml.Node]
) -> FileParameter:
    given = {key: _value(value) for key, value in keys.items()}
    return FileParameter(
        owner,
        ".".join(path),
        str(given["type"]),
        text_of(given.get("default_value")),
        _bounds(given.get("validation")),
        "read_only" if given.get("read_only") is True else "",
        node.start_mark.line + 1,
    )


def _value(node: yaml.Node) -> object:
    loader = yaml.SafeLoader("")
    return loader.construct_object(node, deep=True)


def _bounds(validation: object) -> str:
    """``gt_eq(0.0) size_lt([5])``: each check with its arguments."""
    if not isinstance(validation, dict):
        return ""
    words = (f"{str(name).removesuffix('<>')}({text_of(it)})" for name, it in validation.items())
    return " ".join(sorted(words))


def text_of(value: object) -> str:
    """A default as it is written in tables."""
    if value is None:
        return NO_DEFAULT
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, list | tuple):
        return f"[{', '.join(text_of(it) for it in value)}]"
    text = " ".join(str(value).split())
    return text or EMPTY
